//! Numbers as messages show them.

use std::fmt;

/// A number with a power of ten where it would be a long row of zeros without.
pub(crate) struct Shown(pub(crate) f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(x) = *self;
        if x == 0.0 || !x.is_finite() || (1e-6..1e16).contains(&x.abs()) {
            write!(f, "{x}")
        } else {
            write!(f, "{x:e}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_rows_of_zeros_are_not_shown() {
        for (x, text) in [
            (0.0, "0"),
            (6.0, "6"),
            (-0.1, "-0.1"),
            (1e15, "1000000000000000"),
            (1.5e300, "1.5e300"),
            (-1e-300, "-1e-300"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(Shown(x).to_string(), text);
        }
    }
}
