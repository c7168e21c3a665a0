//! Numbers with an interval and a target.

/// A measured number and its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// The best guess.
    pub value: f64,
    /// Where the true one lies with 95 % confidence.
    pub interval: [f64; 2],
    /// How wide half the interval was to be at most.
    pub target: f64,
}

impl Quantity {
    /// Half the width of the interval.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.interval[1] - self.interval[0])
    }

    /// Whether the interval is as narrow as was asked for.
    pub fn target_met(&self) -> bool {
        self.half_width() <= self.target
    }

    /// The same of something that cannot be below zero.
    pub(super) fn not_negative(mut self) -> Self {
        self.interval[0] = self.interval[0].max(0.0);
        self
    }

    /// The same where there may be so much more.
    pub(super) fn and_more(mut self, most: f64) -> Self {
        self.interval[1] += most;
        self
    }

    /// A number known without rays.
    pub(super) fn exact(value: f64) -> Self {
        Self { value, interval: [value; 2], target: 0.0 }
    }
}
