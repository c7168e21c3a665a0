//! Where a leaf is: its affine map, both ways.

use glam::{DAffine3, DMat3, DVec3};

use super::Line;
use super::chain::norm;
use super::doubt::U;
use crate::aabb::Aabb;
use crate::primitive::Extent;

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
        match inverse(&world_from_local.matrix3) {
            Some(back) if world_from_local.is_finite() && inverse(&back).is_some() => {
                Ok(Self { world_from_local, inverse: back })
            }
            _ => Err(world_from_local.matrix3.determinant()),
        }
    }

    /// The condition number of the linear part, from its Frobenius norm and that of its
    /// inverse: 1 for rotations and uniform scales.
    pub(crate) fn condition(&self) -> f64 {
        norm(&self.world_from_local.matrix3) * norm(&self.inverse) / 3.0
    }

    /// At most how far in the world the surfaces of a leaf, as they are kept, lie beside those that this
    /// map makes of it. No point of the leaf is farther than `radius` from the local origin.
    ///
    /// With `X` for the rounded inverse of `M` and `w = M p`, a surface `f(M⁻¹ w) = 0` is
    /// kept as `f(X w) = 0`: it is moved by `(I − M X) w`. The residual is computed, its own
    /// rounding being at most 4 u |M| |X|. Then there are the roundings of planes and of sizes given
    /// otherwise than they are kept: a few, each of at most u times a length at hand, for
    /// which 32 leaves room.
    pub(crate) fn slack(&self, radius: f64) -> f64 {
        let (m, x) = (self.world_from_local.matrix3, self.inverse);
        let residual =
            norm(&(DMat3::IDENTITY - m * x)) + 4.0 * U * norm(&(m.abs() * x.abs()));
        let reach = norm(&m) * radius;
        (residual + 32.0 * U) * reach
    }

    /// The same for the planes of a leaf, whose offsets are kept in the world.
    pub(crate) fn slack_of_planes(&self, radius: f64) -> f64 {
        self.slack(radius) + 32.0 * U * self.world_from_local.translation.length()
    }

    /// The radius about the local origin of all that is within a box in the world.
    pub(crate) fn radius_of(&self, world: &Aabb) -> f64 {
        let away = world.center() - self.world_from_local.translation;
        norm(&self.inverse) * (away.length() + 0.5 * world.size().length())
    }

    /// At most the largest coordinate in the world of local points whose coordinates are no
    /// larger than these.
    pub(crate) fn reach(&self, local: DVec3) -> f64 {
        let DAffine3 { matrix3, translation } = self.world_from_local;
        (matrix3.abs() * local + translation.abs()).max_element()
    }

    /// The local origin in the world.
    pub(crate) fn origin(&self) -> DVec3 {
        self.world_from_local.translation
    }

    /// A local point in the world.
    pub(crate) fn point(&self, local: DVec3) -> DVec3 {
        self.world_from_local.transform_point3(local)
    }

    /// The image of a local normal, of any length.
    pub(crate) fn normal(&self, local: DVec3) -> DVec3 {
        self.inverse.transpose() * local
    }

    /// The box around what is within a local extent.
    pub(crate) fn bounds(&self, local: &Extent) -> Aabb {
        local.mapped(&self.world_from_local)
    }

    /// The way into the local frame.
    pub(crate) fn to_local(self) -> ToLocal {
        self.to_local_in_units_of(1.0)
    }

    /// The way into the local frame, where lengths are counted in a power of two.
    pub(crate) fn to_local_in_units_of(self, unit: f64) -> ToLocal {
        let linear = self.inverse * (1.0 / unit);
        ToLocal { origin: self.world_from_local.translation, linear }
    }
}

/// The inverse of a matrix that has one in finite numbers.
///
/// Columns are brought to size 1 first, for a determinant is a product of three sizes,
/// which leaves the range of numbers long before the sizes do. Powers of two round nothing,
/// so that where this is not needed it changes no bit.
pub(crate) fn inverse(matrix: &DMat3) -> Option<DMat3> {
    let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let scales = axes.map(|axis| {
        let exponent = axis.abs().max_element().log2().floor();
        (-exponent.clamp(-1000.0, 1000.0)).exp2()
    });
    let [x, y, z] = [0, 1, 2].map(|i| axes[i] * scales[i]);
    let level = DMat3::from_cols(x, y, z);
    let determinant = level.determinant();
    if !determinant.is_finite() || determinant == 0.0 {
        return None;
    }
    let inverse = DMat3::from_diagonal(DVec3::from_array(scales)) * level.inverse();
    inverse.is_finite().then_some(inverse)
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

    /// The origin of a line.
    #[inline(always)]
    pub(super) fn origin_of(&self, line: &Line) -> DVec3 {
        self.linear * ((line.origin - self.origin) + line.rest)
    }

    #[inline(always)]
    pub(crate) fn direction(&self, world: DVec3) -> DVec3 {
        self.linear * world
    }

    /// The linear part of the way back, which [`Frame::new`] has found to exist.
    pub(crate) fn linear_to_world(&self) -> DMat3 {
        inverse(&self.linear).unwrap_or(DMat3::ZERO)
    }

    /// A local normal back in the world, of any length.
    pub(crate) fn normal_to_world(&self, local: DVec3) -> DVec3 {
        self.linear.transpose() * local
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sizes whose cubes are no numbers any more.
    #[test]
    fn tiny_and_huge_maps_are_inverted() {
        let turn = DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(1.1);
        for scales in [
            DVec3::splat(1e-120),
            DVec3::splat(1e120),
            DVec3::new(1e-120, 4e-120, 3e-121),
            DVec3::new(3.0, 5.0, 0.7),
        ] {
            let matrix = turn * DMat3::from_diagonal(scales);
            let map = DAffine3 { matrix3: matrix, translation: DVec3::ONE };
            let frame = Frame::new(map).unwrap();
            let one = frame.inverse * matrix;
            let error = one * DVec3::ONE - DVec3::ONE;
            assert!(error.abs().max_element() < 1e-14, "{scales}: {error}");
        }
        let uneven = DVec3::new(1e-200, 1.0, 1e-200);
        let inverted = inverse(&DMat3::from_diagonal(uneven)).unwrap() * uneven;
        assert!((inverted - DVec3::ONE).abs().max_element() < 1e-15, "{inverted}");
        let plain = turn * DMat3::from_diagonal(DVec3::new(3.0, 5.0, 0.7));
        assert_eq!(inverse(&plain), Some(plain.inverse()));
        for scales in [DVec3::new(1.0, 0.0, 1.0), DVec3::splat(f64::NAN)] {
            assert!(Frame::new(DAffine3::from_scale(scales)).is_err());
        }
    }
}
