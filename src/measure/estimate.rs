//! Numbers with error bars.

/// A measured number and where the true one lies with 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The best guess, in model units to the power that fits.
    pub value: f64,
    /// The 95 % interval, or a certain one: [`Method`] says which.
    pub interval: [f64; 2],
    /// How many rays were spent, those of earlier rounds included; or points, or cells.
    pub rays: u64,
    /// How it was measured.
    pub method: Method,
    /// Whether the interval is as narrow as was asked for.
    pub target_met: bool,
    /// Whether enough rays met the solid for `value` to mean anything. If not, the end of
    /// `interval` is a one-sided bound, and it begins at zero or with what is known of some
    /// of the solid.
    pub resolved: bool,
    /// How many stretches of rays inside the solid the value was found from.
    pub spans: u64,
    /// How many of them, and of the gaps between them, are so short that rounding decides
    /// whether they are there; see [`Tracer::uncertain`](crate::Tracer::uncertain).
    pub uncertain: u64,
}

/// How a number was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// By a formula, without rays: the interval is that of rounding.
    Exact,
    /// From randomly shifted Fibonacci lattices of parallel rays.
    Lattice,
    /// From rays in slices between the places where the slices change; see
    /// [`adaptive`](super::adaptive).
    Adaptive,
    /// From random points.
    Points,
    /// From cells that are certainly inside or outside: the interval is certain.
    Bracket,
}

impl Method {
    /// Its name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Lattice => "lattice",
            Self::Adaptive => "adaptive",
            Self::Points => "points",
            Self::Bracket => "bracket",
        }
    }
}

impl Estimate {
    /// A number known without rays.
    pub(super) const fn exact(value: f64) -> Self {
        Self {
            value,
            interval: [value; 2],
            rays: 0,
            method: Method::Exact,
            target_met: true,
            resolved: true,
            spans: 0,
            uncertain: 0,
        }
    }

    /// Half the width of the interval.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.interval[1] - self.interval[0])
    }
}
