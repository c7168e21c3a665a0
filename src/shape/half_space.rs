//! Half-spaces.

use glam::DVec3;

use super::doubt::{Local, Spot};
use super::line::Rays;
use super::place::Frame;
use super::plane::Plane;
use super::stretch::Stretch;
use super::{ALL, Surface};
use crate::aabb::Aabb;
use crate::lanes::Lanes;

/// The points on one side of a plane, which is face 0.
#[derive(Clone, Debug)]
pub(crate) struct HalfSpace {
    pub(super) planes: [Plane; 1],
}

impl HalfSpace {
    pub(crate) fn new(frame: &Frame, normal: DVec3, offset: f64) -> Self {
        let foot = normal * (offset / normal.length_squared());
        Self { planes: [Plane::new(frame, normal, offset, foot)] }
    }

    /// Where lines are inside.
    #[inline(always)]
    pub(crate) fn stretch<L: Lanes>(&self, rays: &Rays<L>) -> Stretch<L> {
        let [plane] = &self.planes;
        Plane::stretch(&self.planes, ALL, rays, &[plane.speed(rays.dir)])
    }

    /// Bounded on one side if the plane is square to an axis.
    pub(crate) fn bounds(&self) -> Aabb {
        let [plane @ Plane { offset, above, .. }] = self.planes;
        let mut bounds = Aabb::ALL;
        if let Some(axis) = plane.axis() {
            let side = if above { &mut bounds.min } else { &mut bounds.max };
            side[axis] = offset;
        }
        bounds
    }
}

impl Surface for HalfSpace {
    fn normal(&self, _point: DVec3, _face: u32) -> DVec3 {
        self.planes[0].outward()
    }

    fn local(&self, spot: &Spot<'_>, _face: u32) -> Local {
        self.planes[0].local(spot)
    }

    fn faces(&self) -> u32 {
        1
    }
}
