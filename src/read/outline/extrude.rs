//! Outlines as solids of the height between two planes, circles as cylinders and cones.
//!
//! Extrusion distributes over the operators: at every height the solid of a difference is the
//! difference of the solids. What is subtracted reaches farther at both ends, and what is
//! subtracted within that farther still, so that no end of anything subtracted lies in the
//! plane of another end, and the ends of the whole are those of what is not subtracted.

use glam::{DAffine2, DAffine3, DMat3, DVec2};

use super::{Fold, Outline, Shape, Within};
use crate::mesh::{Mesh, MeshError};
use crate::op::Op;
use crate::solid::{Solid, Tag};

/// Between which heights an outline stands, and what it is scaled by on the way.
#[derive(Clone, Copy, Debug)]
pub(in crate::read) struct Extrusion {
    pub(in crate::read) bottom: f64,
    pub(in crate::read) top: f64,
    /// At the top, about the origin; 1 at the bottom.
    pub(in crate::read) scale: f64,
}

impl Outline {
    /// The solid over the outline.
    ///
    /// # Errors
    ///
    /// If paths are too tangled to be filled.
    pub(in crate::read) fn extruded(
        &self,
        mut extrusion: Extrusion,
    ) -> Result<Solid, MeshError> {
        self.fold(&mut extrusion)
    }
}

impl Extrusion {
    /// The scale at a height is the first number plus height times the second.
    fn factors(&self) -> [f64; 2] {
        let slope = (self.scale - 1.0) / (self.top - self.bottom);
        [1.0 - slope * self.bottom, slope]
    }

    /// From where to where something reaches that is subtracted within so many differences: one
    /// height more at each end for each of them, but never to where the scale is zero.
    fn reach(&self, level: u32) -> [f64; 2] {
        let (height, level) = (self.top - self.bottom, f64::from(level));
        let free = level * height;
        let part = level / (level + 1.0);
        let scale = self.scale;
        let below = if scale > 1.0 { part * height / (scale - 1.0) } else { free };
        let above =
            if scale < 1.0 { part * height * scale / (1.0 - scale) } else { free };
        [self.bottom - below.min(free), self.top + above.min(free)]
    }
}

impl Fold<Solid, MeshError> for Extrusion {
    fn shape(&mut self, shape: &Shape, within: &Within) -> Result<Solid, MeshError> {
        let heights @ [low, high] = self.reach(within.level);
        let [start, slope] = self.factors();
        let is_straight = slope == 0.0;
        // What rounding takes below zero is the tip.
        let scales = heights.map(|z| (start + slope * z).max(0.0));
        let solid = match shape {
            Shape::Square { min, max } if is_straight => {
                Solid::cuboid_between(min.extend(low), max.extend(high))
            }
            Shape::Square { min, max } => {
                let (right, left) = (DVec2::new(max.x, min.y), DVec2::new(min.x, max.y));
                let path = vec![*min, right, *max, left];
                Solid::mesh(Mesh::tapered(&[path], heights, scales)?)
            }
            Shape::Circle { radius } => {
                let [a, b] = scales.map(|scale| radius * scale);
                Solid::frustum_between(a, b, low, high)
            }
            Shape::Paths(paths) => match Mesh::tapered(paths, heights, scales) {
                Ok(mesh) => Solid::mesh(mesh),
                Err(MeshError::NoFaces) => Solid::empty(),
                Err(error) => return Err(error),
            },
        };
        let map = lifted(&within.map, [start, slope]);
        Ok(if map == DAffine3::IDENTITY { solid } else { solid.mapped(map) })
    }

    fn boolean(&mut self, op: Op, parts: Vec<Solid>) -> Result<Solid, MeshError> {
        Ok(Solid::boolean(op, parts))
    }

    fn tagged(&mut self, tag: &Tag, part: Solid) -> Solid {
        part.tagged(tag.clone())
    }
}

/// A plane map at every height, for shapes that are scaled about the origin of their own frames:
/// p ↦ A p + f(z) b, as f(z) (A q + b) = A (f(z) q) + f(z) b.
fn lifted(map: &DAffine2, [start, slope]: [f64; 2]) -> DAffine3 {
    let DAffine2 { matrix2, translation } = *map;
    DAffine3 {
        matrix3: DMat3::from_cols(
            matrix2.x_axis.extend(0.0),
            matrix2.y_axis.extend(0.0),
            (slope * translation).extend(1.0),
        ),
        translation: (start * translation).extend(0.0),
    }
}
