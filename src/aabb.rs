//! Axis-aligned boxes.

use glam::{DAffine3, DVec3};

/// The closed box of points `p` with `min ≤ p ≤ max` on every axis.
///
/// It is empty when `min > max` on any axis. Bounds may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: DVec3,
    /// The corner with the largest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// The box without points: the neutral element of [`Aabb::hull`].
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// All of space: the neutral element of [`Aabb::intersection`].
    pub const ALL: Self = Self { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };

    /// The box with these two corners.
    pub const fn new(min: DVec3, max: DVec3) -> Self {
        Self { min, max }
    }

    /// The smallest box around some points.
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self::new(b.min.min(p), b.max.max(p)))
    }

    /// The smallest box around two boxes.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self::new(self.min.min(other.min), self.max.max(other.max))
    }

    /// The box with its faces this much farther out.
    #[must_use]
    pub(crate) fn grown(self, by: f64) -> Self {
        Self::new(self.min - by, self.max + by)
    }

    /// The largest coordinate of any of its points, whichever sign it has.
    pub(crate) fn reach(&self) -> f64 {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// By how much two boxes are apart on the axis on which they are farthest; negative if
    /// they overlap.
    pub(crate) fn gap(&self, other: &Self) -> f64 {
        (self.min - other.max).max(other.min - self.max).max_element()
    }

    /// What two boxes have in common.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        Self::new(self.min.max(other.min), self.max.min(other.max))
    }

    /// A box around what is left when some boxes are taken away: smaller where one of them
    /// cuts off an end straight across.
    #[must_use]
    pub(crate) fn trimmed(mut self, cutters: &[Self]) -> Self {
        /// One cut can make way for another, but a few rounds are enough for what people
        /// build.
        const ROUNDS: usize = 8;
        for _ in 0..ROUNDS {
            let before = self;
            cutters.iter().for_each(|cutter| self.trim(cutter));
            if self == before {
                break;
            }
        }
        self
    }

    fn trim(&mut self, cutter: &Self) {
        let (starts_before, ends_behind) =
            (cutter.min.cmple(self.min), cutter.max.cmpge(self.max));
        for axis in 0..3 {
            let across = (1..3)
                .map(|k| (axis + k) % 3)
                .all(|k| starts_before.test(k) && ends_behind.test(k));
            if !across {
                continue;
            }
            if starts_before.test(axis) && cutter.max[axis] > self.min[axis] {
                self.min[axis] = cutter.max[axis];
            } else if ends_behind.test(axis) && cutter.min[axis] < self.max[axis] {
                self.max[axis] = cutter.min[axis];
            }
        }
    }

    /// Whether no point lies inside.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Whether all six bounds are finite; true of no empty box.
    pub fn is_bounded(&self) -> bool {
        !self.is_empty() && self.min.is_finite() && self.max.is_finite()
    }

    /// The lengths of the edges; zero for an empty box.
    pub fn size(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { self.max - self.min }
    }

    /// Half the area of the surface; zero for an empty box.
    pub(crate) fn half_area(&self) -> f64 {
        let DVec3 { x, y, z } = self.size();
        x * y + y * z + z * x
    }

    /// The middle of a bounded box.
    pub fn center(&self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// The eight corners.
    pub fn corners(&self) -> [DVec3; 8] {
        let Self { min, max } = *self;
        std::array::from_fn(|i| {
            let pick = |bit: usize, lo: f64, hi: f64| if i & bit == 0 { lo } else { hi };
            DVec3::new(
                pick(1, min.x, max.x),
                pick(2, min.y, max.y),
                pick(4, min.z, max.z),
            )
        })
    }

    /// The smallest box around the image of a bounded box under an affine map.
    #[must_use]
    pub fn mapped(&self, map: &DAffine3) -> Self {
        Self::around(self.corners().map(|p| map.transform_point3(p)))
    }
}
