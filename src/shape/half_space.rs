//! Half-spaces.

use glam::DVec3;

use super::place::Frame;
use super::slab::one_form;
use super::{Line, Sink, Surface};
use crate::aabb::Aabb;

/// The points on one side of a plane, which is face 0.
#[derive(Clone, Debug)]
pub(crate) struct HalfSpace {
    normal: DVec3,
    offset: f64,
    /// Whether inside is where `normal · p` is larger than `offset`.
    above: bool,
}

impl HalfSpace {
    pub(crate) fn new(frame: &Frame, normal: DVec3, offset: f64) -> Self {
        let foot = frame.point(normal * (offset / normal.length_squared()));
        let (normal, above) = one_form(frame.normal(normal));
        Self { normal, offset: normal.dot(foot), above }
    }

    /// Bounded on one side if the plane is square to an axis.
    pub(crate) fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::ALL;
        let others = |axis: usize| (1..3).all(|k| self.normal[(axis + k) % 3] == 0.0);
        if let Some(axis) = (0..3).find(|&axis| others(axis)) {
            let side = if self.above { &mut bounds.min } else { &mut bounds.max };
            side[axis] = self.offset;
        }
        bounds
    }
}

impl Surface for HalfSpace {
    /// A line within the plane is inside if it would be after a small move along the
    /// normal, as for a slab.
    fn crossings(&self, line: &Line, sink: &mut Sink<'_>) {
        let speed = self.normal.dot(line.dir);
        let height = self.offset - self.normal.dot(line.origin);
        let (start, end) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
        if speed == 0.0 {
            if (height <= 0.0) == self.above {
                sink.stretch(start, end);
            }
            return;
        }
        let at = (height / speed, 0);
        if (speed > 0.0) == self.above {
            sink.stretch(at, end);
        } else {
            sink.stretch(start, at);
        }
    }

    fn normal(&self, _point: DVec3, _face: u32) -> DVec3 {
        if self.above { -self.normal } else { self.normal }
    }

    fn faces(&self) -> u32 {
        1
    }
}
