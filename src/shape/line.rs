//! A ray made ready for leaves.

use glam::DVec3;

use super::doubt::U;
use crate::aabb::Aabb;
use crate::bvh::Slabs;
use crate::ray::Ray;

/// A line in the frame in which leaves compute: its origin is near the scene and its
/// direction about as long as the scene is large, so that `t` is about 1.
///
/// The origin is about the middle of the stretch inside the scene's bounds, so that no leaf sees
/// an origin farther away than the scene is large: the error of a crossing grows with that
/// distance (R. Haines, J. Günther, T. Akenine-Möller, "Precision Improvements for
/// Ray/Sphere Intersection", Ray Tracing Gems, ch. 7, 2019). It depends on the line and the
/// scene alone. It is a round number of steps along the direction: then it rounds nothing
/// either where coordinates have few digits, and planes at whole millimetres are crossed at
/// whole numbers. Elsewhere what rounding takes from the origin is kept beside it, so that
/// chords of small solids are found as exactly far from the world's origin, and by rays from afar, as
/// anywhere else. The direction is scaled by a power of two, which rounds nothing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// The point at `t = 0` of this line.
    pub(crate) origin: DVec3,
    /// What is to be added to the origin.
    pub(crate) rest: DVec3,
    /// The direction; its largest component is between a half and twice the size of the scene
    /// for all but denormal directions.
    pub(crate) dir: DVec3,
    /// Where the origin is on the ray, in multiples of `dir`.
    offset: f64,
    /// `dir` in multiples of the ray's direction: a power of two.
    scale: f64,
}

impl Line {
    /// The ray as a line, unless it passes by the bounds or is not valid.
    pub(crate) fn new(ray: &Ray, bounds: &Aabb) -> Option<Self> {
        if !ray.is_valid() || !bounds.is_bounded() {
            return None;
        }
        let scale = inverse_power_of_two(ray.dir.abs().max_element());
        let size = 1.0 / inverse_power_of_two(bounds.size().max_element());
        // One factor after the other: their product need not be a number.
        let (dir, scale) = (ray.dir * scale * size, scale * size);
        if !scale.is_normal() {
            return None;
        }
        let [near, far] = Slabs::new(ray.origin, dir, bounds).range(bounds);
        // A range that is not finite belongs to a line too far away to be told apart.
        if near > far || !near.is_finite() || !far.is_finite() {
            return None;
        }
        let width = (far - near).max(LEAST_WIDTH);
        let offset = coarse(0.5 * (near + far), width);
        let [origin, rest] = advanced(ray.origin, offset, dir);
        Some(Self { origin, rest, dir, offset, scale })
    }

    /// A place on this line as a place on the ray.
    pub(crate) fn on_ray(&self, t: f64) -> f64 {
        (self.offset + t) * self.scale
    }

    /// A place on the ray as a place on this line.
    pub(crate) fn on_line(&self, t: f64) -> f64 {
        t / self.scale - self.offset
    }

    /// At most how far the true origin of the line is from `origin + rest`, on each axis.
    pub(super) fn rounding(&self) -> DVec3 {
        4.0 * U * U * ((self.offset * self.dir).abs() + self.origin.abs())
    }

    /// A bound for a place `t` on this line as a bound for it on the ray.
    pub(crate) fn error_on_ray(&self, t: f64, error: f64) -> f64 {
        (error + 4.0 * U * (self.offset.abs() + t.abs())) * self.scale
    }

    /// Box tests along this line.
    pub(crate) fn slabs(&self, bounds: &Aabb) -> Slabs {
        Slabs::new(self.origin, self.dir, bounds)
    }
}

/// The point `origin + steps · dir` as a sum of two, the second smaller than the rounding of
/// the first (T. J. Dekker, "A Floating-Point Technique for Extending the Available
/// Precision", Numerische Mathematik 18, 1971; the sum is that of D. E. Knuth).
fn advanced(origin: DVec3, steps: f64, dir: DVec3) -> [DVec3; 2] {
    let way = steps * dir;
    let (high, [a, b]) = (halves(DVec3::splat(steps)), halves(dir));
    let lost_way = ((high[0] * a - way) + high[0] * b + high[1] * a) + high[1] * b;
    let sum = origin + way;
    let back = sum - origin;
    let lost = (origin - (sum - back)) + (way - back);
    let rest = lost + lost_way;
    // Numbers too large to be split have no rest.
    [sum, if rest.is_finite() { rest } else { DVec3::ZERO }]
}

/// Numbers as sums of two with half the digits.
fn halves(x: DVec3) -> [DVec3; 2] {
    let large = 134_217_729.0 * x;
    let high = large - (large - x);
    [high, x - high]
}

/// A line that only touches the bounds counts as being inside for this part of a step:
/// else there would be no round number near, and planes that meet where it touches would be
/// crossed at different places. A millionth leaves a round number some 28 digits.
const LEAST_WIDTH: f64 = 1.0 / 1_048_576.0;

/// A number that differs from `x` by at most 1/256 of `width` and has no more digits than
/// that takes.
fn coarse(x: f64, width: f64) -> f64 {
    let per_unit = 256.0 * inverse_power_of_two(width);
    let rounded = (x * per_unit).round() / per_unit;
    // Scenes as small as the smallest numbers have no room to round.
    if rounded.is_finite() { rounded } else { x }
}

/// The power of two that brings a positive number into 1..2, or as near as one factor goes
/// for denormal numbers and those above 2¹⁰²³, infinity among them.
pub(crate) fn inverse_power_of_two(x: f64) -> f64 {
    /// The exponent field of 1.0.
    const BIAS: u64 = 1023;
    // The field of 2⁻ᵉ is 2 BIAS minus that of 2ᵉ; both ends of its range are taken by
    // other kinds of numbers.
    let field = (2 * BIAS).saturating_sub(x.to_bits() >> 52).clamp(1, 2 * BIAS - 1);
    f64::from_bits(field << 52)
}
