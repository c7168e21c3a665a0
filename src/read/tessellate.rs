//! Circles, cylinders and spheres with the vertices of OpenSCAD 2021.01.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::angle::{cos_deg, sin_deg};
use crate::mesh::{Mesh, MeshError};

/// OpenSCAD's `$fn`, `$fa` and `$fs`, which say how fine a curve is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fineness {
    /// `$fn`: the number of segments; 0 or less leaves it to the other two.
    pub(super) count: f64,
    /// `$fa`: the smallest angle of a segment, in degrees.
    pub(super) angle: f64,
    /// `$fs`: the smallest length of a segment.
    pub(super) size: f64,
}

impl Fineness {
    /// How many segments a circle gets.
    pub(super) fn segments(&self, radius: f64) -> u32 {
        /// The grid below which OpenSCAD takes points as equal.
        const GRID: f64 = 1.0 / (1_u32 << 20) as f64;
        if radius < GRID || !self.count.is_finite() {
            return 3;
        }
        if self.count > 0.0 {
            return whole(self.count.max(3.0));
        }
        let by_angle = 360.0 / self.angle.max(0.01);
        let by_size = TAU * radius / self.size.max(0.01);
        whole(by_angle.min(by_size).max(5.0).ceil())
    }

    /// The segments of a polygon that the author asked for: an explicit `$fn` up to 8.
    pub(super) fn polygon(&self, radius: f64) -> Option<u32> {
        let explicit = self.count > 0.0 && self.count < 9.0;
        explicit.then(|| self.segments(radius))
    }
}

/// The whole part of a number that is not negative.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "conversion saturates, which is as good as any number too large to build"
)]
fn whole(x: f64) -> u32 {
    x as u32
}

/// Triangles of [`frustum`].
pub(super) fn frustum_triangles(segments: u32) -> u64 {
    4 * u64::from(segments)
}

/// Triangles of [`ball`].
pub(super) fn ball_triangles(segments: u32) -> u64 {
    2 * u64::from(segments) * u64::from(rings(segments))
}

/// The frustum of a pyramid about the z-axis with corners on circles of these radii; one
/// may be zero, which makes a point.
pub(super) fn frustum(
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
pub(super) fn ball(segments: u32, radius: f64) -> Result<Mesh, MeshError> {
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

/// Adds the corners on a circle, the first on +x; one point when the radius is zero.
fn ring(points: &mut Vec<DVec3>, segments: u32, radius: f64, z: f64) -> Vec<u32> {
    let count = if radius > 0.0 { segments } else { 1 };
    (0..count)
        .map(|i| {
            let angle = 360.0 * f64::from(i) / f64::from(segments);
            let (x, y) = (radius * cos_deg(angle), radius * sin_deg(angle));
            points.push(DVec3::new(x, y, z));
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
