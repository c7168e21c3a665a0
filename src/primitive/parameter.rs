//! Sizes that make a solid.

/// A parameter out of its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BadParameter {
    /// Its name.
    pub parameter: &'static str,
    /// Its value.
    pub value: f64,
}

pub(super) fn finite(parameter: &'static str, value: f64) -> Result<(), BadParameter> {
    if value.is_finite() { Ok(()) } else { Err(BadParameter { parameter, value }) }
}

/// The smallest and the largest size of what is not a box: squares and quotients of these are
/// numbers still.
const SIZES: std::ops::RangeInclusive<f64> = 1e-140..=1e140;

/// A size of which squares or quotients are taken. Others have to be [`positive`] alone.
pub(super) fn size(parameter: &'static str, value: f64) -> Result<(), BadParameter> {
    if SIZES.contains(&value) { Ok(()) } else { Err(BadParameter { parameter, value }) }
}

pub(super) fn positive(parameter: &'static str, value: f64) -> Result<(), BadParameter> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(BadParameter { parameter, value })
    }
}

pub(super) fn not_negative(
    parameter: &'static str,
    value: f64,
) -> Result<(), BadParameter> {
    if value.is_finite() && value >= 0.0 {
        Ok(())
    } else {
        Err(BadParameter { parameter, value })
    }
}
