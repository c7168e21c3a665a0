//! Volumes of meshes that are proven not to pass through themselves.
//!
//! The divergence theorem counts space as often as a mesh winds around it, and a solid counts
//! it once. The two are the same where all faces are seen from their inner side from one
//! point, or edge-on, and the solid angles add up to one sphere: then almost every ray from
//! that point goes through one face, and the mesh winds once around what comes before it.

use glam::DVec3;
use robust::{Coord3D, orient3d};

use crate::aabb::Aabb;
use crate::mesh::Mesh;
use crate::rounded::{Rounded, Sum};
use crate::shape::U;

/// Sizes between which products of three coordinates are exact enough for the predicate.
const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// The volume of a mesh that is star-shaped as seen from the middle of its box or from its
/// centroid, which is inside every mesh that is convex.
pub(super) fn volume(mesh: &Mesh) -> Option<Rounded> {
    let bounds = mesh.bounds();
    if bounds.is_empty() {
        return Some(Rounded::ZERO);
    }
    let middle = bounds.center();
    seen_from(mesh, middle, &bounds)
        .or_else(|| seen_from(mesh, centroid(mesh, middle), &bounds))
}

/// The centroid of what a mesh encloses, more or less.
fn centroid(mesh: &Mesh, origin: DVec3) -> DVec3 {
    let (mut sum, mut volume) = (DVec3::ZERO, 0.0);
    for face in 0..mesh.faces().len() {
        let [a, b, c] = mesh.corners(face).map(|p| p - origin);
        let sixth = a.dot(b.cross(c));
        sum += 0.25 * sixth * (a + b + c);
        volume += sixth;
    }
    origin + sum / volume
}

/// The volume of a mesh if it is star-shaped as seen from a point.
fn seen_from(mesh: &Mesh, center: DVec3, bounds: &Aabb) -> Option<Rounded> {
    let is_fit = SIZES.contains(&bounds.size().min_element())
        && SIZES.contains(&bounds.size().max_element())
        && bounds.reach() < *SIZES.end();
    let (mut sixth, mut angle) = (Sum::default(), 0.0);
    for face in 0..mesh.faces().len() {
        let corners = mesh.corners(face);
        let [a, b, c] = corners.map(coord);
        // Positive where the last is on the inner side.
        if !is_fit || orient3d(a, b, c, coord(center)) < 0.0 {
            return None;
        }
        let [a, b, c] = corners.map(|p| p - center);
        sixth.add(tetrahedron(a, b, c));
        angle += solid_angle(a, b, c);
    }
    let winding = angle / (4.0 * std::f64::consts::PI);
    let sixth_part = Rounded { value: 1.0 / 6.0, error: U };
    // It is a whole number but for rounding.
    ((winding - 1.0).abs() < 0.1).then(|| sixth.total() * sixth_part)
}

fn coord(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}

/// Six times the volume between the origin and a triangle, whose corners are rounded
/// differences.
///
/// Differences, products and sums are rounded at most ten times on the way of each of the six
/// products.
fn tetrahedron(a: DVec3, b: DVec3, c: DVec3) -> Rounded {
    let (x, y) = (b.abs(), c.abs());
    let products =
        DVec3::new(x.y * y.z + x.z * y.y, x.z * y.x + x.x * y.z, x.x * y.y + x.y * y.x);
    let error = 16.0 * U * a.abs().dot(products) + f64::MIN_POSITIVE;
    Rounded { value: a.dot(b.cross(c)), error }
}

/// The solid angle of a triangle as seen from the origin (A. van Oosterom, J. Strackee, "The
/// Solid Angle of a Plane Triangle", IEEE Transactions on Biomedical Engineering 30(2), 1983);
/// zero at a corner.
fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let [a, b, c] = [a, b, c].map(DVec3::normalize_or_zero);
    let rest = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
    2.0 * a.dot(b.cross(c)).atan2(rest)
}
