//! Boxes under any affine map: three slabs.

use glam::DVec3;

use super::place::Frame;
use super::slab::Slab;
use super::{Line, Sink, Surface};
use crate::aabb::Aabb;

/// A parallelepiped. Faces 0 to 5 are −x, +x, −y, +y, −z, +z of the box in its own frame.
#[derive(Clone, Debug)]
pub(crate) struct Cuboid {
    slabs: [Slab; 3],
}

impl Cuboid {
    pub(crate) fn new(frame: &Frame, min: DVec3, max: DVec3) -> Self {
        Self { slabs: std::array::from_fn(|i| Slab::new(frame, i, min[i], max[i])) }
    }

    pub(crate) fn bounds(frame: &Frame, min: DVec3, max: DVec3) -> Aabb {
        frame.bounds(&Aabb::new(min, max))
    }
}

impl Surface for Cuboid {
    fn crossings(&self, line: &Line, sink: &mut Sink<'_>) {
        let (mut enter, mut exit) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
        for (slab, base) in self.slabs.iter().zip([0, 2, 4]) {
            let stretch = slab.stretch(line);
            if stretch.enter > enter.0 {
                enter = (stretch.enter, base + stretch.faces[0]);
            }
            if stretch.exit < exit.0 {
                exit = (stretch.exit, base + stretch.faces[1]);
            }
        }
        sink.stretch(enter, exit);
    }

    fn normal(&self, _point: DVec3, face: u32) -> DVec3 {
        self.slabs[(face / 2) as usize % 3].outward(face % 2)
    }

    fn faces(&self) -> u32 {
        6
    }
}
