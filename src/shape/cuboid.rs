//! Boxes under any affine map: six planes.

use glam::DVec3;

use super::Surface;
use super::doubt::{Local, Spot};
use super::line::Rays;
use super::place::Frame;
use super::plane::Plane;
use super::stretch::Stretch;
use crate::aabb::Aabb;
use crate::lanes::{Lanes, Vec3};

/// A parallelepiped. Faces 0 to 5 are −x, +x, −y, +y, −z, +z of the box in its own frame.
#[derive(Clone, Debug)]
pub(crate) struct Cuboid {
    pub(super) planes: [Plane; 6],
}

impl Cuboid {
    pub(crate) fn new(frame: &Frame, min: DVec3, max: DVec3) -> Self {
        let planes = std::array::from_fn(|face| {
            let axis = DVec3::AXES[face / 2];
            if face % 2 == 0 {
                Plane::new(frame, -axis, -min[face / 2], axis * min)
            } else {
                Plane::new(frame, axis, max[face / 2], axis * max)
            }
        });
        Self { planes }
    }

    /// Where lines are inside, as far as some of the faces say.
    #[inline(always)]
    pub(crate) fn stretch<L: Lanes>(
        &self,
        faces: u32,
        rays: &Rays<L>,
        speeds: &[L; 6],
    ) -> Stretch<L> {
        Plane::stretch(&self.planes, faces, rays, speeds)
    }

    /// What depends on the direction of lines alone.
    #[inline(always)]
    pub(crate) fn speeds<L: Lanes>(&self, dir: Vec3<L>) -> [L; 6] {
        let [a, b, c, d, e, f] = &self.planes;
        [
            a.speed(dir),
            b.speed(dir),
            c.speed(dir),
            d.speed(dir),
            e.speed(dir),
            f.speed(dir),
        ]
    }

    pub(crate) fn bounds(frame: &Frame, min: DVec3, max: DVec3) -> Aabb {
        frame.bounds(&Aabb::new(min, max))
    }
}

impl Surface for Cuboid {
    fn normal(&self, _point: DVec3, face: u32) -> DVec3 {
        self.planes[face as usize % 6].outward()
    }

    fn local(&self, spot: &Spot<'_>, face: u32) -> Local {
        self.planes[face as usize % 6].local(spot)
    }

    fn faces(&self) -> u32 {
        6
    }
}
