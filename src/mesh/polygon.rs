//! Faces with more than three corners, as triangles.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

use super::fill;

/// The triangles of one face, as indices of points; its corners must exist.
///
/// The face is seen along the axis nearest to its normal (M. Newell's normal, whose
/// components are the areas of the three projections; I. Sutherland, R. Sproull, R.
/// Schumacker, "A characterization of ten hidden-surface algorithms", 1974). When it is a
/// simple polygon there, its triangles cover it once; a face that is not planar gets one
/// of several surfaces that end in its edges.
///
/// A face that touches or crosses itself, or is seen as a line, becomes a fan. The
/// boundary of a fan is the loop of the face, as with any other choice of triangles, so
/// the mesh stays closed, and winding numbers still count what such a face encloses.
pub(super) fn triangles(points: &[DVec3], face: &[u32]) -> Vec<[u32; 3]> {
    let mut ring = face.to_vec();
    ring.dedup();
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    if let [a, b, c] = ring[..] {
        return vec![[a, b, c]];
    }
    let seen = projected(points, &ring);
    let local = if sees_all(&seen) { None } else { simple(seen) };
    let local = local.unwrap_or_else(|| fan(ring.len()));
    local
        .into_iter()
        .map(|t| t.map(|i| ring[i as usize]))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect()
}

/// The triangles between the first corner and each edge.
fn fan(corners: usize) -> Vec<[u32; 3]> {
    let last = u32::try_from(corners).unwrap_or(u32::MAX);
    (2..last).map(|i| [0, i - 1, i]).collect()
}

/// The corners on the coordinate plane where their polygon has the largest area, turned
/// so that it is counter-clockwise.
fn projected(points: &[DVec3], ring: &[u32]) -> Vec<DVec2> {
    let corner = |i: &u32| points[*i as usize];
    let base = ring.first().map_or(DVec3::ZERO, corner);
    let next = ring.iter().cycle().skip(1);
    let normal: DVec3 = ring
        .iter()
        .zip(next)
        .map(|(a, b)| (corner(a) - base).cross(corner(b) - base))
        .sum();
    let size = normal.abs();
    let axis = if size.x > size.y && size.x > size.z {
        0
    } else if size.y > size.z {
        1
    } else {
        2
    };
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let (u, v) = if normal[axis] < 0.0 { (v, u) } else { (u, v) };
    ring.iter().map(corner).map(|p| DVec2::new(p[u], p[v])).collect()
}

/// Whether the first corner sees all others in counter-clockwise order within half a
/// turn, so that the fan covers the polygon once. True of strictly convex polygons.
fn sees_all(p: &[DVec2]) -> bool {
    let left = |a: DVec2, b: DVec2, c: DVec2| {
        let [a, b, c] = [a, b, c].map(|p| Coord { x: p.x, y: p.y });
        orient2d(a, b, c) > 0.0
    };
    (2..p.len()).all(|i| left(p[0], p[i - 1], p[i]) && left(p[0], p[1], p[i]))
}

/// The triangles of a simple counter-clockwise polygon; none for any other.
fn simple(ring: Vec<DVec2>) -> Option<Vec<[u32; 3]>> {
    let corners = ring.len();
    let fill = fill::without_crossings(ring).ok()?;
    // The fill is bounded by the ring itself exactly if the ring is simple.
    let is_side = |[a, b]: &[u32; 2]| (*a as usize + 1) % corners == *b as usize;
    let is_ring = fill.boundary.len() == corners && fill.boundary.iter().all(is_side);
    (is_ring && fill.points.len() == corners).then_some(fill.triangles)
}
