//! A line made ready for the boxes of a tree.

use std::ops::Range;

use glam::DVec3;

use super::{Slabs, Unit, rounded_down};
use crate::lanes::Lanes;

/// A line in the frame of a tree, its origin near the middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probe {
    pub(super) axes: [OnAxis; 3],
    /// The point of the line that is nearest to the middle.
    pub(crate) origin: DVec3,
    /// At most how far rounding has put the line or a point beside where they should be, in
    /// single and in double precision; too much to sort anything out if it is [`ANYWHERE`].
    pub(crate) pad: f64,
    dir: DVec3,
    /// Where the origin of the line that was given is, and how far it goes in a step.
    middle: f64,
    along: f64,
    /// From where to where on the line.
    pub(super) part: [f32; 2],
}

/// So large that it is more than all else, but its square is no number of single precision.
const ANYWHERE: f64 = 1e30;

#[derive(Clone, Copy, Debug)]
pub(super) struct OnAxis {
    pub(super) inverse: f32,
    /// Whether the high plane comes first.
    pub(super) runs_down: bool,
    /// The origin seen from near and from far planes: on the sides that put these apart.
    pub(super) origins: [f32; 2],
}

impl Probe {
    /// With `e = 2⁻²⁴` and coordinates of at most 1 for boxes and 1.8 for the origin, a plane
    /// is off by at most `10.3 e`, and by 64 u (|box| + |origin|) in double precision: half
    /// of it for the nearest point, for the rest see [`Slabs::new`].
    #[inline(always)]
    pub(super) fn new(unit: &Unit, slabs: &Slabs) -> Self {
        const SINGLE: f64 = 16.0 / 16_777_216.0;
        /// Powers of two whose inverses and products with others are numbers.
        const LEVELS: Range<f64> = 1e-200..1e200;
        let rounding = 4.0 * slabs.pad.x * unit.scale;
        let level = slabs.dir.abs().max_element().inverse_power_of_two();
        let dir = slabs.dir * level;
        let from = unit.point(slabs.origin);
        let middle = from.dot(dir) / dir.length_squared();
        let nearest = from - middle * dir;
        let is_level = LEVELS.contains(&level);
        let (origin, pad) = if rounding < 0.1 && nearest.is_finite() && is_level {
            (nearest, SINGLE + 1.001 * rounding)
        } else {
            (DVec3::ZERO, ANYWHERE)
        };
        let size = 1.0 / level;
        let inverse = slabs.inverse * size;
        let axes = [
            OnAxis::new(origin.x, inverse.x, pad),
            OnAxis::new(origin.y, inverse.y, pad),
            OnAxis::new(origin.z, inverse.z, pad),
        ];
        let part = [f32::NEG_INFINITY, f32::INFINITY];
        Self { axes, origin, pad, dir, middle, along: unit.scale * size, part }
    }

    /// The same for boxes as far beside the line, and not farther along it than to `t` = −1 and
    /// 1, give or take a thousandth and what rounding does.
    #[expect(clippy::cast_possible_truncation, reason = "there is room for rounding")]
    pub(super) fn widened(mut self, unit: &Unit, breadth: DVec3) -> Self {
        // Single precision rounds what is wide more than the origin, which is near.
        let pad = self.pad + 1.001 * unit.scale * breadth;
        if !pad.is_finite() || pad.max_element() >= ANYWHERE {
            self.axes = [OnAxis::new(0.0, 1.0, ANYWHERE); 3];
            return self;
        }
        self.axes = std::array::from_fn(|k| {
            OnAxis::new(self.origin[k], 1.0 / self.dir[k], pad[k])
        });
        let steps = self.dir.length_squared();
        let (middle, along) = (self.middle, self.along);
        let room = 1.001 * along + 4.0 * (self.pad + 1e-6 * middle.abs()) / steps.sqrt();
        if self.pad < ANYWHERE {
            self.part = [(middle - room) as f32, (middle + room) as f32];
        }
        self
    }

    /// Leaves out what comes before a place of the line that was given.
    #[inline(always)]
    pub(crate) fn starting(mut self, t: f64) -> Self {
        if let Some([place, room]) = self.place(t) {
            self.part[0] = rounded_down(place - room);
        }
        self
    }

    /// The limit behind which no box holds a crossing at a place of the line that was given,
    /// and how much farther than that all crossings are in boxes behind the limit.
    #[inline(always)]
    pub(crate) fn limit(&self, t: f64) -> Option<(f32, f64)> {
        let [place, room] = self.place(t)?;
        Some((-rounded_down(-place - room), 0.5 * room / self.along))
    }

    /// A place of the line that was given, and more than it can differ from where boxes
    /// around a crossing there begin or end: twice what puts planes apart, and some for rounding
    /// where the middle is far away. Nothing if there is no telling.
    #[inline(always)]
    fn place(&self, t: f64) -> Option<[f64; 2]> {
        let place = self.middle + self.along * t;
        let room = 4.0 * (self.pad + 1e-6 * self.middle.abs());
        let is_clear = room < 1.0 && self.along.is_normal() && place.is_finite();
        is_clear.then_some([place, room])
    }
}

impl OnAxis {
    #[expect(clippy::cast_possible_truncation, reason = "there is room for rounding")]
    #[inline(always)]
    fn new(origin: f64, inverse: f64, pad: f64) -> Self {
        // A line parallel to a plane has a quotient too large, not an infinite one: the
        // difference of coordinates may be zero, and 0 · ∞ is no number.
        let inverse = inverse.clamp(-ANYWHERE, ANYWHERE);
        let pad = pad.copysign(inverse);
        Self {
            inverse: inverse as f32,
            runs_down: inverse < 0.0,
            origins: [(origin + pad) as f32, (origin - pad) as f32],
        }
    }
}
