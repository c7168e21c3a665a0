//! Polyhedra for cylinders, cones and balls, with the vertices of OpenSCAD 2021.01.

use glam::{DVec2, DVec3};

use super::{Mesh, MeshError};
use crate::angle::{cos_deg, sin_deg};

/// Triangles of [`frustum`].
pub(crate) fn frustum_triangles(segments: u32) -> u64 {
    4 * u64::from(segments)
}

/// Triangles of [`ball`].
pub(crate) fn ball_triangles(segments: u32) -> u64 {
    2 * u64::from(segments) * u64::from(rings(segments))
}

/// The frustum of a pyramid about the z-axis with corners on circles of these radii; one
/// may be zero, which makes a point.
pub(crate) fn frustum(
    segments: u32,
    [bottom_radius, top_radius]: [f64; 2],
    [bottom, top]: [f64; 2],
) -> Result<Mesh, MeshError> {
    let mut points = Vec::new();
    let mut faces = Vec::new();
    let low = ring(&mut points, segments, bottom_radius, bottom);
    let high = ring(&mut points, segments, top_radius, top);
    cap(&mut faces, &low, Cap::Bottom);
    band(&mut faces, &low, &high);
    cap(&mut faces, &high, Cap::Top);
    Mesh::new(points, faces)
}

/// The polyhedron for a sphere: rings at the middles of equal angles from pole to pole,
/// so that its ends are flat and lie within the sphere.
pub(crate) fn ball(segments: u32, radius: f64) -> Result<Mesh, MeshError> {
    let mut points = Vec::new();
    let mut faces = Vec::new();
    let count = rings(segments);
    let rings: Vec<Vec<u32>> = (0..count)
        .rev()
        .map(|i| {
            let polar = 180.0 * (f64::from(i) + 0.5) / f64::from(count);
            let (z, r) = (radius * cos_deg(polar), radius * sin_deg(polar));
            ring(&mut points, segments, r, z)
        })
        .collect();
    if let [first, .., last] = &rings[..] {
        cap(&mut faces, first, Cap::Bottom);
        cap(&mut faces, last, Cap::Top);
    }
    for pair in rings.windows(2) {
        band(&mut faces, &pair[0], &pair[1]);
    }
    Mesh::new(points, faces)
}

fn rings(segments: u32) -> u32 {
    segments.div_ceil(2)
}

/// The corners of a polygon on a circle, the first on +x.
pub(crate) fn circle(segments: u32, radius: f64) -> Vec<DVec2> {
    let corner = |i: u32| {
        let angle = 360.0 * f64::from(i) / f64::from(segments);
        radius * DVec2::new(cos_deg(angle), sin_deg(angle))
    };
    (0..segments).map(corner).collect()
}

/// Adds the corners on a circle, the first on +x; one point when the radius is zero.
fn ring(points: &mut Vec<DVec3>, segments: u32, radius: f64, z: f64) -> Vec<u32> {
    let count = if radius > 0.0 { segments } else { 1 };
    circle(segments, radius)
        .into_iter()
        .take(count as usize)
        .map(|corner| {
            points.push(corner.extend(z));
            u32::try_from(points.len() - 1).unwrap_or(u32::MAX)
        })
        .collect()
}

#[derive(Clone, Copy)]
enum Cap {
    Bottom,
    Top,
}

fn cap(faces: &mut Vec<[u32; 3]>, ring: &[u32], cap: Cap) {
    for i in 2..ring.len() {
        let (a, b, c) = (ring[0], ring[i - 1], ring[i]);
        faces.push(match cap {
            Cap::Bottom => [a, c, b],
            Cap::Top => [a, b, c],
        });
    }
}

/// The sides between two rings, one of which may be a point.
fn band(faces: &mut Vec<[u32; 3]>, low: &[u32], high: &[u32]) {
    let count = low.len().max(high.len());
    for i in 0..count {
        let j = (i + 1) % count;
        let at = |ring: &[u32], i: usize| if ring.len() > 1 { ring[i] } else { ring[0] };
        if low.len() > 1 {
            faces.push([at(low, i), at(low, j), at(high, j)]);
        }
        if high.len() > 1 {
            faces.push([at(low, i), at(high, j), at(high, i)]);
        }
    }
}
