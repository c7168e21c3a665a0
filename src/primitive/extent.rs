//! Where a primitive is, in its own frame.

use glam::{DAffine3, DVec3};

use crate::aabb::Aabb;

/// What a primitive is within, as tightly as need be.
#[derive(Clone, Debug)]
pub(crate) enum Extent {
    /// There is no end to it but its planes.
    Unbounded,
    /// The hull of its corners.
    Corners(Vec<DVec3>),
    /// The ball around the origin.
    Ball { radius: f64 },
    /// The hull of discs about the z-axis at two heights.
    Discs { radii: [f64; 2], ends: [f64; 2] },
}

impl Extent {
    /// No point is farther than this from the local origin.
    pub(crate) fn radius(&self) -> f64 {
        match *self {
            Self::Unbounded => f64::INFINITY,
            Self::Corners(ref corners) => {
                corners.iter().map(|p| p.length()).fold(0.0, f64::max)
            }
            Self::Ball { radius } => radius.hypot(radius),
            Self::Discs { radii: [a, b], ends: [bottom, top] } => {
                a.max(b).hypot(bottom.abs().max(top.abs()))
            }
        }
    }

    /// No coordinate is larger.
    pub(crate) fn coordinates(&self) -> DVec3 {
        match *self {
            Self::Unbounded => DVec3::INFINITY,
            Self::Corners(ref corners) => {
                corners.iter().fold(DVec3::ZERO, |most, p| most.max(p.abs()))
            }
            Self::Ball { .. } | Self::Discs { .. } => DVec3::splat(self.radius()),
        }
    }

    /// The box around it under a map.
    pub(crate) fn mapped(&self, map: &DAffine3) -> Aabb {
        let m = map.matrix3;
        let rows = [m.row(0), m.row(1), m.row(2)];
        match *self {
            Self::Unbounded => Aabb::ALL,
            Self::Corners(ref corners) => {
                Aabb::around(corners.iter().map(|&p| map.transform_point3(p)))
            }
            Self::Ball { radius } => {
                let reach = radius * DVec3::from_array(rows.map(DVec3::length));
                Aabb::new(map.translation - reach, map.translation + reach)
            }
            Self::Discs { radii, ends } => {
                let reach = DVec3::from_array(rows.map(|row| row.truncate().length()));
                radii.into_iter().zip(ends).fold(Aabb::EMPTY, |b, (radius, height)| {
                    let center = map.transform_point3(DVec3::new(0.0, 0.0, height));
                    b.hull(Aabb::new(center - radius * reach, center + radius * reach))
                })
            }
        }
    }
}
