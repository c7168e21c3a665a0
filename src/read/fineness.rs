//! OpenSCAD's rules for how many segments a curve gets.

use std::f64::consts::TAU;

/// OpenSCAD's `$fn`, `$fa` and `$fs`, which say how fine a curve is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fineness {
    /// `$fn`: the number of segments; 0 or less leaves it to the other two.
    pub(super) count: f64,
    /// `$fa`: the smallest angle of a segment, in degrees.
    pub(super) angle: f64,
    /// `$fs`: the smallest length of a segment.
    pub(super) size: f64,
}

impl Fineness {
    /// How many segments a circle gets.
    pub(super) fn segments(&self, radius: f64) -> u32 {
        /// The grid below which OpenSCAD takes points as equal.
        const GRID: f64 = 1.0 / (1_u32 << 20) as f64;
        if radius < GRID || !self.count.is_finite() {
            return 3;
        }
        if self.count > 0.0 {
            return whole(self.count.max(3.0));
        }
        let by_angle = 360.0 / self.angle.max(0.01);
        let by_size = TAU * radius / self.size.max(0.01);
        whole(by_angle.min(by_size).max(5.0).ceil())
    }

    /// The segments of a polygon that the author asked for: an explicit `$fn` up to 8.
    pub(super) fn polygon(&self, radius: f64) -> Option<u32> {
        let explicit = self.count > 0.0 && self.count < 9.0;
        explicit.then(|| self.segments(radius))
    }
}

/// The whole part of a number that is not negative.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "conversion saturates, which is as good as any number too large to build"
)]
pub(super) fn whole(x: f64) -> u32 {
    x as u32
}
