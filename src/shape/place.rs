//! Where a leaf is: its affine map, both ways.

use glam::{DAffine3, DMat3, DVec3};

use crate::aabb::Aabb;

/// The affine map of a leaf and its inverse.
///
/// Points go through the inverse, directions through its linear part, and normals through
/// its transpose; no direction is ever normalised, so `t` names the same point in every
/// frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    world_from_local: DAffine3,
    inverse: DMat3,
}

impl Frame {
    /// The frame of an affine map, or the map's determinant if it cannot be inverted.
    pub(crate) fn new(world_from_local: DAffine3) -> Result<Self, f64> {
        let linear = world_from_local.matrix3;
        let determinant = linear.determinant();
        let finite = world_from_local.is_finite() && determinant.is_finite();
        if !finite || determinant == 0.0 {
            return Err(determinant);
        }
        let inverse = linear.inverse();
        if inverse.is_finite() {
            Ok(Self { world_from_local, inverse })
        } else {
            Err(determinant)
        }
    }

    /// The condition number of the linear part, from its Frobenius norm and that of its
    /// inverse: 1 for rotations and uniform scales.
    pub(crate) fn condition(&self) -> f64 {
        let norm =
            |m: &DMat3| m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
        norm(&self.world_from_local.matrix3) * norm(&self.inverse) / 3.0
    }

    /// A local point in the world.
    pub(crate) fn point(&self, local: DVec3) -> DVec3 {
        self.world_from_local.transform_point3(local)
    }

    /// The image of a local normal, of any length.
    pub(crate) fn normal(&self, local: DVec3) -> DVec3 {
        self.inverse.transpose() * local
    }

    /// The box around a local box.
    pub(crate) fn bounds(&self, local: &Aabb) -> Aabb {
        local.mapped(&self.world_from_local)
    }

    /// The box around discs of these radii about the local z-axis at these heights.
    pub(crate) fn bounds_of_discs(&self, discs: [(f64, f64); 2]) -> Aabb {
        let m = self.world_from_local.matrix3;
        let reach = DVec3::new(
            m.row(0).truncate().length(),
            m.row(1).truncate().length(),
            m.row(2).truncate().length(),
        );
        discs.into_iter().fold(Aabb::EMPTY, |b, (height, radius)| {
            let center = self.point(DVec3::new(0.0, 0.0, height));
            b.hull(Aabb::new(center - radius * reach, center + radius * reach))
        })
    }

    /// The box around the ball of this radius about the local origin.
    pub(crate) fn bounds_of_ball(&self, radius: f64) -> Aabb {
        let m = self.world_from_local.matrix3;
        let reach = DVec3::new(m.row(0).length(), m.row(1).length(), m.row(2).length());
        let center = self.world_from_local.translation;
        Aabb::new(center - radius * reach, center + radius * reach)
    }

    /// The way into the local frame.
    pub(crate) fn to_local(self) -> ToLocal {
        ToLocal { origin: self.world_from_local.translation, linear: self.inverse }
    }
}

/// The way from the world into a leaf's frame. The translation is taken off first: that
/// rounds less than the inverse of the whole map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ToLocal {
    pub(crate) origin: DVec3,
    pub(crate) linear: DMat3,
}

impl ToLocal {
    pub(crate) fn point(&self, world: DVec3) -> DVec3 {
        self.linear * (world - self.origin)
    }

    pub(crate) fn direction(&self, world: DVec3) -> DVec3 {
        self.linear * world
    }

    /// A local normal back in the world, of any length.
    pub(crate) fn normal_to_world(&self, local: DVec3) -> DVec3 {
        self.linear.transpose() * local
    }
}
