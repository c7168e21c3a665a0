//! What surfaces of leaves have in common when it is asked which of them coincide.

use glam::DVec3;

use crate::aabb::Aabb;
use crate::primitive::Profile;
use crate::shape::{Plane, Polyhedron, Wall};

/// How far rounding moves a surface, in units of the largest coordinate of its leaf times
/// the condition number of its map.
///
/// A product of two maps rounds by at most 4 u in each entry, u = 2⁻⁵³, the inverse and the
/// plane's equation by some 16 u more; this leaves room for a dozen nested maps.
const ROUNDING: f64 = 64.0 * 0.5 * f64::EPSILON;

/// The same in units of the bound that goes with a leaf, where that says less: under a map
/// that stretches one way the condition number says nothing of the other. How far two
/// surfaces are apart is estimated from their distance and their angle, each of which may be
/// as large as the bound allows, and the angle counts for the whole leaf though a face may be
/// a small part of it.
const BOUNDS: f64 = 8.0;

/// A leaf that rounding may have moved by more than this part of its size shares only what
/// is the same to the bit: any plane near it would pass for any of its own, whichever way it
/// faces. Where its map flattens it, its planes are that much closer to being parallel.
const LOST: f64 = 64.0;

/// What a leaf says of its own size and precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) center: DVec3,
    pub(super) radius: f64,
    pub(super) rounding: f64,
}

impl Extent {
    /// Of a leaf within `bounds`, or within `scene` if it has no bounds itself, whose surfaces
    /// are moved by rounding by no more than `slack`.
    pub(super) fn new(bounds: &Aabb, scene: &Aabb, condition: f64, slack: f64) -> Self {
        let near = if bounds.is_bounded() { *bounds } else { *scene };
        let far = near.reach();
        let radius = 0.5 * near.size().length();
        let rounding = (ROUNDING * condition * far).min(BOUNDS * slack);
        let is_lost = rounding * condition * LOST > radius;
        Self {
            center: near.center(),
            radius,
            rounding: if is_lost { 0.0 } else { rounding },
        }
    }
}

/// A plane, a curved wall, or all of a mesh.
pub(super) trait Sheet: Clone {
    /// Only surfaces of one class can coincide.
    fn class(&self) -> usize {
        0
    }

    /// A number that differs little between surfaces that differ little; `scale` is the
    /// largest coordinate of the scene.
    fn key(&self, scale: f64) -> f64;

    /// By how much the key can change when the surface moves by as much as `moved` on its
    /// leaf.
    fn key_width(&self, moved: f64, extent: &Extent, scale: f64) -> f64;

    /// At most how far from another surface this one is, anywhere on its leaf.
    fn distance(&self, other: &Self, extent: &Extent) -> f64;

    /// The numbers that describe it, and give surfaces an order.
    fn numbers(&self) -> [f64; 15];
}

/// No direction in which models have many surfaces: √0.3, √0.1, √0.6.
const MIXED: DVec3 = DVec3::new(
    0.547_722_557_505_166_1,
    0.316_227_766_016_837_94,
    0.774_596_669_241_483_4,
);

/// The point of a plane closest to a given one: it is the same whichever side is meant.
pub(super) fn foot(plane: &Plane, from: DVec3) -> DVec3 {
    let length = plane.normal.length();
    let height = plane.normal.dot(from) / length - plane.offset / length;
    from - height / length * plane.normal
}

/// A point outside a scene with this largest coordinate: seen from there every plane has a
/// foot of its own.
pub(super) fn outside(scale: f64) -> DVec3 {
    -2.0 * scale * MIXED
}

impl Sheet for Plane {
    fn key(&self, scale: f64) -> f64 {
        foot(self, outside(scale)).dot(MIXED) / scale
    }

    /// A turn by an angle moves the plane by that times the radius of the leaf, and the foot
    /// by that times twice the distance to where it is seen from.
    fn key_width(&self, moved: f64, extent: &Extent, scale: f64) -> f64 {
        8.0 * moved * (1.0 / extent.radius + 1.0 / scale)
    }

    fn distance(&self, other: &Self, extent: &Extent) -> f64 {
        let foot = foot(self, extent.center);
        let apart = (other.normal.dot(foot) - other.offset).abs() / other.normal.length();
        let (ours, theirs) = (self.normal.normalize(), other.normal.normalize());
        let turned = (ours - theirs).length().min((ours + theirs).length());
        // A face is at most two radii wide, however far from it the middle of the leaf is.
        apart + 2.0 * turned * extent.radius
    }

    fn numbers(&self) -> [f64; 15] {
        let mut numbers = [0.0; 15];
        numbers[..3].copy_from_slice(&self.normal.to_array());
        numbers[3] = self.offset;
        numbers
    }
}

/// How wide a wall is that has the same width on every part of it; zero for others.
pub(super) fn width(wall: &Wall) -> f64 {
    let m = wall.to_local.linear_to_world();
    match wall.profile {
        Profile::Ball { radius } => {
            let squares = m.col(0).length_squared()
                + m.col(1).length_squared()
                + m.col(2).length_squared();
            radius * (squares / 3.0).sqrt()
        }
        Profile::Cylinder { radius } => {
            let across = |v: DVec3| v.reject_from(m.z_axis).length_squared();
            radius * (0.5 * (across(m.x_axis) + across(m.y_axis))).sqrt()
        }
        Profile::Cone { .. }
        | Profile::Paraboloid { .. }
        | Profile::OneSheet { .. }
        | Profile::TwoSheets { .. } => 0.0,
    }
}

impl Sheet for Wall {
    fn key(&self, scale: f64) -> f64 {
        (self.landmark(DVec3::ZERO).dot(MIXED) + width(self)) / scale
    }

    /// The landmark of a slender wall moves more than the wall itself.
    fn key_width(&self, moved: f64, _extent: &Extent, scale: f64) -> f64 {
        8.0 * moved * self.slenderness() / scale
    }

    fn distance(&self, other: &Self, _extent: &Extent) -> f64 {
        self.distance(other)
    }

    fn numbers(&self) -> [f64; 15] {
        self.numbers()
    }
}

impl Sheet for Polyhedron {
    fn class(&self) -> usize {
        self.mesh_address()
    }

    fn key(&self, scale: f64) -> f64 {
        self.middle().dot(MIXED) / scale
    }

    fn key_width(&self, moved: f64, _extent: &Extent, scale: f64) -> f64 {
        8.0 * moved / scale
    }

    fn distance(&self, other: &Self, _extent: &Extent) -> f64 {
        self.distance(other)
    }

    fn numbers(&self) -> [f64; 15] {
        let mut numbers = [0.0; 15];
        numbers[..9].copy_from_slice(&self.to_local.linear.to_cols_array());
        numbers[9..12].copy_from_slice(&self.to_local.origin.to_array());
        numbers
    }
}
