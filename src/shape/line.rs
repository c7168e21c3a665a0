//! A ray made ready for leaves.

use glam::DVec3;

use super::doubt::U;
use crate::aabb::Aabb;
use crate::lanes::{Lanes, Vec3};
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
    #[inline(always)]
    pub(crate) fn new(ray: &Ray, stage: &Stage) -> Option<Self> {
        if !stage.is_bounded {
            return None;
        }
        let heading = Heading::new(ray.dir.into(), stage);
        let (line, met) = Lines::new(ray.origin.into(), &heading, stage);
        met.then(|| line.into())
    }

    /// A place on this line as a place on the ray.
    #[inline(always)]
    pub(crate) fn on_ray(&self, t: f64) -> f64 {
        (self.offset + t) * self.scale
    }

    /// A place on the ray as a place on this line.
    #[inline(always)]
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
}

/// The box around a scene, and what lines want to know of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stage {
    pub(crate) bounds: Aabb,
    pub(crate) is_bounded: bool,
    /// The power of two that is about the length of its longest edge.
    size: f64,
    /// The largest coordinate.
    reach: f64,
}

impl Stage {
    pub(crate) fn new(bounds: Aabb) -> Self {
        Self {
            bounds,
            is_bounded: bounds.is_bounded(),
            size: 1.0 / inverse_power_of_two(bounds.size().max_element()),
            reach: bounds.reach(),
        }
    }
}

/// A line that only touches the bounds counts as being inside for this part of a step:
/// else there would be no round number near, and planes that meet where it touches would be
/// crossed at different places. A millionth leaves a round number some 28 digits.
const LEAST_WIDTH: f64 = 1.0 / 1_048_576.0;

/// One [`Line`] or several.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lines<L> {
    pub(crate) rays: Rays<L>,
    pub(crate) offset: L,
    pub(crate) scale: L,
}

impl From<Lines<f64>> for Line {
    fn from(lines: Lines<f64>) -> Self {
        let Lines { rays: Rays { origin, rest, dir }, offset, scale } = lines;
        let [origin, rest, dir] = [origin, rest, dir].map(DVec3::from);
        Self { origin, rest, dir, offset, scale }
    }
}

/// What depends on the directions of rays and the bounds alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Heading<L: Lanes> {
    pub(crate) dir: Vec3<L>,
    scale: L,
    /// The halves of each coordinate of `dir`.
    halves: [[L; 2]; 3],
    inverse: Vec3<L>,
    is_valid: L::Mask,
    /// No coordinate of the bounds is larger.
    reach: L,
}

impl<L: Lanes> Heading<L> {
    /// Of rays that run these ways.
    #[inline(always)]
    pub(crate) fn new(dir: Vec3<L>, stage: &Stage) -> Self {
        let like = dir.x;
        let (zero, infinity) = (like.same(0.0), like.same(f64::INFINITY));
        let largest = dir.largest();
        let size = like.same(stage.size);
        let scale = largest.inverse_power_of_two();
        let is_finite = dir.is_finite();
        // One factor after the other: their product need not be a number.
        let (dir, scale) = (dir.scaled(scale).scaled(size), scale * size);
        let is_normal = !scale.less(like.same(f64::MIN_POSITIVE)) & scale.less(infinity);
        let is_valid = is_normal & zero.less(largest) & is_finite;
        let halves = [halves(dir.x), halves(dir.y), halves(dir.z)];
        let inverse = Vec3 { x: per_unit(dir.x), y: per_unit(dir.y), z: per_unit(dir.z) };
        Self { dir, scale, halves, inverse, is_valid, reach: like.same(stage.reach) }
    }
}

/// How many steps one unit of length takes; a finite number.
#[inline(always)]
fn per_unit<L: Lanes>(dir: L) -> L {
    let most = dir.same(f64::MAX);
    (dir.same(1.0) / dir).min(most).max(-most)
}

impl<L: Lanes> Lines<L> {
    /// Rays as lines, and which of them are valid and meet the bounds, which are bounded.
    #[inline(always)]
    pub(crate) fn new(
        origin: Vec3<L>,
        heading: &Heading<L>,
        stage: &Stage,
    ) -> (Self, L::Mask) {
        let like = origin.x;
        let Heading { dir, scale, is_valid, .. } = *heading;
        let is_valid = is_valid & origin.is_finite();
        let [near, far] = within(origin, heading, stage);
        // A range that is not finite belongs to a line too far away to be told apart.
        let meets = !far.less(near) & near.is_finite() & far.is_finite();
        let width = (far - near).max(like.same(LEAST_WIDTH));
        let offset = coarse(like.same(0.5) * (near + far), width);
        let [origin, rest] = advanced(origin, offset, heading);
        (Self { rays: Rays { origin, rest, dir }, offset, scale }, is_valid & meets)
    }
}

/// From where to where lines are in a box, widened as [`Slabs::new`] has it.
#[inline(always)]
fn within<L: Lanes>(origin: Vec3<L>, heading: &Heading<L>, stage: &Stage) -> [L; 2] {
    let like = origin.x;
    let pad = like.same(8.0 * f64::EPSILON) * (heading.reach + origin.largest());
    let (Aabb { min, max }, inverse) = (stage.bounds, heading.inverse);
    let [x0, x1] = within_slab(origin.x, inverse.x, [min.x, max.x], pad);
    let [y0, y1] = within_slab(origin.y, inverse.y, [min.y, max.y], pad);
    let [z0, z1] = within_slab(origin.z, inverse.z, [min.z, max.z], pad);
    [x0.max(y0).max(z0), x1.min(y1).min(z1)]
}

/// The same on one axis.
#[inline(always)]
fn within_slab<L: Lanes>(origin: L, inverse: L, slab: [f64; 2], pad: L) -> [L; 2] {
    let low = ((origin.same(slab[0]) - pad) - origin) * inverse;
    let high = ((origin.same(slab[1]) + pad) - origin) * inverse;
    [low.min(high), low.max(high)]
}

/// The point `origin + steps · dir` as a sum of two, the second smaller than the rounding of
/// the first (T. J. Dekker, "A Floating-Point Technique for Extending the Available
/// Precision", Numerische Mathematik 18, 1971; the sum is that of D. E. Knuth).
#[inline(always)]
fn advanced<L: Lanes>(origin: Vec3<L>, steps: L, heading: &Heading<L>) -> [Vec3<L>; 2] {
    let (dir, [a, b, c], parts) = (heading.dir, heading.halves, halves(steps));
    let [x, x_rest] = advanced_on_axis(origin.x, steps * dir.x, parts, a);
    let [y, y_rest] = advanced_on_axis(origin.y, steps * dir.y, parts, b);
    let [z, z_rest] = advanced_on_axis(origin.z, steps * dir.z, parts, c);
    // Numbers too large to be split have no rest.
    let none = Vec3::same(steps, DVec3::ZERO);
    let has_rest = x_rest.is_finite() & y_rest.is_finite() & z_rest.is_finite();
    let rest = Vec3 {
        x: L::select(has_rest, x_rest, none.x),
        y: L::select(has_rest, y_rest, none.y),
        z: L::select(has_rest, z_rest, none.z),
    };
    [Vec3 { x, y, z }, rest]
}

/// The same for one coordinate: the way is the product of two numbers in halves.
#[inline(always)]
fn advanced_on_axis<L: Lanes>(
    origin: L,
    way: L,
    [high, low]: [L; 2],
    [a, b]: [L; 2],
) -> [L; 2] {
    let lost_way = ((high * a - way) + high * b + low * a) + low * b;
    let sum = origin + way;
    let back = sum - origin;
    let lost = (origin - (sum - back)) + (way - back);
    [sum, lost + lost_way]
}

/// Numbers as sums of two with half the digits.
#[inline(always)]
fn halves<L: Lanes>(x: L) -> [L; 2] {
    let large = x.same(134_217_729.0) * x;
    let high = large - (large - x);
    [high, x - high]
}

/// Numbers that differ from `x` by at most 1/256 of `width` and have no more digits than
/// that takes.
#[inline(always)]
fn coarse<L: Lanes>(x: L, width: L) -> L {
    let per_unit = x.same(256.0) * width.inverse_power_of_two();
    let rounded = (x * per_unit).round() / per_unit;
    // Scenes as small as the smallest numbers have no room to round.
    L::select(rounded.is_finite(), rounded, x)
}

/// [`Lanes::inverse_power_of_two`] of one number.
#[inline(always)]
pub(crate) fn inverse_power_of_two(x: f64) -> f64 {
    Lanes::inverse_power_of_two(x)
}

/// One line or several, as leaves see them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rays<L> {
    pub(crate) origin: Vec3<L>,
    pub(crate) rest: Vec3<L>,
    pub(crate) dir: Vec3<L>,
}

impl From<&Line> for Rays<f64> {
    #[inline(always)]
    fn from(line: &Line) -> Self {
        let Line { origin, rest, dir, .. } = *line;
        Self { origin: origin.into(), rest: rest.into(), dir: dir.into() }
    }
}
