//! Boxes.

use glam::DVec3;

use super::parameter::positive;
use super::{BadParameter, Describe, Extent, Facets, Flat};
use crate::aabb::Aabb;
use crate::rounded::Rounded;

/// The points with `min ≤ p ≤ max` on every axis. Its faces 0 to 5 are −x, +x, −y, +y, −z, +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// The corner with the smallest coordinates.
    pub min: DVec3,
    /// The corner with the largest coordinates.
    pub max: DVec3,
}

/// By the bits of a corner's number: whether it is on +x, +y and +z.
const FACES: [[u32; 3]; 12] = [
    [0, 2, 1],
    [1, 2, 3],
    [4, 5, 6],
    [5, 7, 6],
    [0, 1, 4],
    [1, 5, 4],
    [2, 6, 3],
    [3, 6, 7],
    [0, 4, 2],
    [2, 4, 6],
    [1, 3, 5],
    [3, 7, 5],
];

impl Cuboid {
    fn corners(&self) -> Vec<DVec3> {
        Aabb::new(self.min, self.max).corners().to_vec()
    }
}

impl Describe for Cuboid {
    fn name(&self) -> &'static str {
        "cuboid"
    }

    fn check(&self) -> Result<(), BadParameter> {
        let Self { min, max } = *self;
        ["width", "depth", "height"]
            .into_iter()
            .zip((max - min).to_array())
            .try_for_each(|(parameter, size)| positive(parameter, size))
    }

    fn planes(&self) -> Vec<Flat> {
        let Self { min, max } = *self;
        (0..6)
            .map(|face| {
                let axis = DVec3::AXES[face / 2];
                if face % 2 == 0 {
                    Flat { normal: -axis, offset: -min[face / 2], point: axis * min }
                } else {
                    Flat { normal: axis, offset: max[face / 2], point: axis * max }
                }
            })
            .collect()
    }

    fn extent(&self) -> Extent {
        Extent::Corners(self.corners())
    }

    fn facets(&self) -> Facets {
        Facets::Polyhedron { points: self.corners(), faces: FACES.to_vec() }
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn volume(&self) -> Option<Rounded> {
        let Self { min, max } = *self;
        let [x, y, z] =
            [0, 1, 2].map(|i| Rounded::exact(max[i]) - Rounded::exact(min[i]));
        Some(x * y * z)
    }

    fn lengths(&self) -> [Vec<f64>; 3] {
        let Self { min, max } = *self;
        [0, 1, 2].map(|i| vec![min[i], max[i], max[i] - min[i]])
    }
}
