//! Meshes in single precision.

use std::collections::HashMap;

use glam::DVec3;

use super::WriteError;
use crate::mesh::Mesh;

/// The mesh with coordinates rounded to single precision, and no two points the same.
///
/// It is closed still: a triangle that became a line runs along its edges both ways, and so do
/// two that cover each other. Triangles that are thin for other reasons stay, for without
/// them the mesh would not be closed.
pub(super) fn rounded(mesh: &Mesh) -> Result<Mesh, WriteError> {
    let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
    let mut points = Vec::new();
    let mut place = Vec::with_capacity(mesh.points().len());
    for point in mesh.points() {
        let mut near = [0.0_f32; 3];
        for (near, x) in near.iter_mut().zip(point.to_array()) {
            *near = nearest(x);
            if !near.is_finite() {
                return Err(WriteError::OutOfRange(x));
            }
        }
        place.push(*numbers.entry(near.map(f32::to_bits)).or_insert_with(|| {
            points.push(DVec3::from_array(near.map(f64::from)));
            u32::try_from(points.len() - 1).unwrap_or(u32::MAX)
        }));
    }
    let faces = mesh.faces().iter().map(|face| face.map(|i| place[i as usize]));
    let faces = without_opposites(
        faces.filter(|&[a, b, c]| a != b && b != c && c != a).collect(),
    );
    Mesh::new(points, faces).map_err(WriteError::Rounded)
}

/// The nearest number of single precision; zero has one sign.
fn nearest(x: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "it is what rounding means")]
    let near = x as f32;
    near + 0.0
}

/// Faces without those that look the other way on the same corners as another.
fn without_opposites(mut faces: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    let mut sums: HashMap<[u32; 3], i64> = HashMap::with_capacity(faces.len());
    for face in &faces {
        *sums.entry(corners(face)).or_default() += turn(face);
    }
    faces.retain(|face| {
        let Some(sum) = sums.get_mut(&corners(face)) else { return false };
        let is_left = *sum * turn(face) > 0;
        if is_left {
            *sum -= turn(face);
        }
        is_left
    });
    faces
}

/// The corners in order of their numbers.
fn corners(face: &[u32; 3]) -> [u32; 3] {
    let mut corners = *face;
    corners.sort_unstable();
    corners
}

/// One if the numbers of the corners go up once and down twice around the face, or minus one.
fn turn([a, b, c]: &[u32; 3]) -> i64 {
    let ups = [a < b, b < c, c < a].into_iter().filter(|&up| up).count();
    if ups == 1 { 1 } else { -1 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Solid;

    fn at(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    /// A pyramid whose top has two corners that are one in single precision.
    #[test]
    fn points_that_become_equal_are_one() {
        let points = vec![
            at(0.0, 0.0, 0.0),
            at(1.0, 0.0, 0.0),
            at(0.0, 1.0, 0.0),
            at(0.25, 0.25, 1.0),
            at(0.25 + 1e-12, 0.25, 1.0),
        ];
        let faces = [[0, 2, 1], [0, 1, 3], [3, 1, 4], [1, 2, 4], [2, 3, 4], [2, 0, 3]];
        let mesh = Mesh::new(points, faces.to_vec()).expect("a closed mesh");
        let found = rounded(&mesh).expect("a pyramid");
        assert_eq!((found.points().len(), found.faces().len()), (4, 4));
        assert!((found.volume() - 1.0 / 6.0).abs() < 1e-12);
        assert_eq!(rounded(&found).as_ref(), Ok(&found), "once is enough");
    }

    /// A wall that is thinner than rounding is two walls that cover each other.
    #[test]
    fn walls_without_thickness_are_nothing() {
        let cube = |min: DVec3, max: DVec3| {
            let solid = Solid::cuboid_between(min, max);
            crate::facets::surface(&solid, 1.0, 100, &crate::unwatched)
                .expect("a box has facets")
                .expect("it is not empty")
        };
        let wall = cube(at(0.0, 0.0, 1.0), at(1.0, 1.0, 1.0 + 1e-12));
        assert!(matches!(rounded(&wall), Err(WriteError::Rounded(_))));
        let far = cube(DVec3::ZERO, DVec3::splat(1e39));
        assert_eq!(rounded(&far), Err(WriteError::OutOfRange(1e39)));
    }
}
