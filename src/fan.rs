//! Rays in two dimensions of parameters: those of a camera, or of an integral.

use glam::DVec3;

use crate::lanes::{Lanes, Vec3};
use crate::ray::Ray;

/// Rays whose origins and directions depend linearly on two numbers: how far to the right and
/// how far up. Either the origins or the directions differ, always the same way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fan {
    pub(crate) origin: Linear,
    pub(crate) dir: Linear,
}

/// A vector that depends linearly on two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Linear {
    pub(crate) middle: DVec3,
    /// What one to the right adds.
    pub(crate) right: DVec3,
    /// What one up adds.
    pub(crate) up: DVec3,
}

impl Fan {
    /// The ray at a place.
    pub(crate) fn ray(&self, right: f64, up: f64) -> Ray {
        Ray::new(self.origin.at(right, up), self.dir.at(right, up))
    }

    /// The direction of all rays, if they have the same.
    pub(crate) fn common_dir(&self) -> Option<DVec3> {
        self.is_parallel().then(|| self.ray(0.0, 0.0).dir)
    }

    /// Whether all rays run the same way.
    pub(crate) fn is_parallel(&self) -> bool {
        self.dir.right == DVec3::ZERO && self.dir.up == DVec3::ZERO
    }
}

impl Linear {
    /// The same vector everywhere.
    pub(crate) const fn constant(middle: DVec3) -> Self {
        Self { middle, right: DVec3::ZERO, up: DVec3::ZERO }
    }

    pub(crate) fn at(&self, right: f64, up: f64) -> DVec3 {
        self.middle + right * self.right + up * self.up
    }

    /// [`Linear::at`] for several places at once.
    #[inline(always)]
    pub(crate) fn at_places<L: Lanes>(&self, right: L, up: L) -> Vec3<L> {
        let Self { middle, right: r, up: u } = *self;
        let [middle, r, u] =
            [Vec3::same(up, middle), Vec3::same(up, r), Vec3::same(up, u)];
        middle + r.scaled(right) + u.scaled(up)
    }

    /// At least the largest coordinate between the middle and there.
    pub(crate) fn largest(&self, right: f64, up: f64) -> f64 {
        let Self { middle, right: r, up: u } = *self;
        (middle.abs() + (right * r).abs() + (up * u).abs()).max_element()
    }
}
