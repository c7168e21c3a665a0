//! How far a measurement goes.

use std::time::Duration;

use anyhow::bail;
use clap::Args;
use solidray::Aabb;
use solidray::measure::Sampling;

/// The limits that commands which measure share.
#[derive(Args, Clone, Debug)]
pub(super) struct SamplingArgs {
    /// Go on until the half width of the 95 % interval is this fraction of the value
    #[arg(long, value_name = "T", default_value = "1e-4", value_parser = positive, help_heading = "Sampling")]
    rel_tol: f64,
    /// The same in the units of the value; the wider of the two is enough
    #[arg(long, value_name = "T", default_value = "0", value_parser = not_negative, help_heading = "Sampling")]
    abs_tol: f64,
    /// Stop at this many rays though the tolerance is not met; the first round takes 3728
    #[arg(long, value_name = "N", default_value_t = Sampling::default().max_rays, value_parser = clap::value_parser!(u64).range(1..), help_heading = "Sampling")]
    max_rays: u64,
    /// Stop before this many seconds though the tolerance is not met
    #[arg(long, value_name = "S", value_parser = positive, help_heading = "Sampling")]
    time_limit: Option<f64>,
    /// Which random numbers: equal seeds give equal answers, bit by bit
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = "Sampling")]
    seed: u64,
}

impl SamplingArgs {
    pub(super) fn meant(&self) -> Sampling {
        Sampling {
            rel_tol: self.rel_tol,
            abs_tol: self.abs_tol,
            max_rays: self.max_rays,
            time_limit: self
                .time_limit
                .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()),
            seed: self.seed,
        }
    }
}

/// Refuses what is so large or so small that its volume, times a power of its width, is no number.
pub(super) fn check_range(bounds: &Aabb, power: f64, what: &str) -> anyhow::Result<()> {
    /// Numbers go from 1e-308 to 1e308; sums need some room.
    const DIGITS: f64 = 300.0;
    let (size, width) = (bounds.size(), bounds.size().max_element());
    let digits = |x: f64| x.log10();
    let of_volume: f64 = size.to_array().into_iter().map(digits).sum();
    // Of what has no inside, or no bounds, something else is said.
    let most = of_volume + power * digits(width);
    if most.is_finite() && most.abs() > DIGITS {
        bail!(
            "the model is {width:e} wide: {what} of it are beyond numbers, which go from 1e-{DIGITS} to 1e{DIGITS} here. Scale it"
        );
    }
    Ok(())
}

/// A finite number that is not below zero.
fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        Ok(_) | Err(_) => Err(format!("`{text}` is not a finite number of at least 0")),
    }
}

/// A finite number above zero.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        Ok(_) | Err(_) => Err(format!("`{text}` is not a finite number above zero")),
    }
}
