//! Closed, oriented triangle meshes.
//!
//! A [`Mesh`] that exists is the boundary of a solid: [`Mesh::new`] checks and explains.

mod build;
mod check;
mod error;
mod fill;
mod loft;
mod polygon;
pub(crate) mod round;

use std::fmt;

use glam::DVec3;

use crate::aabb::Aabb;
pub(crate) use build::triangulated;
pub use error::{MeshError, OpenEdge};
pub(crate) use loft::{Diagonal, Ends, Quad, loft};

/// A closed, oriented triangle mesh.
///
/// Every directed edge of a face is matched by a face that runs along it the other way,
/// so every line goes in as often as it comes out, however the mesh touches or passes
/// through itself. Faces are counter-clockwise seen from outside; inside is where the
/// winding number is positive.
#[derive(Clone, PartialEq)]
pub struct Mesh {
    points: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
}

impl Mesh {
    /// A mesh of points and faces, each face three indices of points.
    ///
    /// Faces may be degenerate, edges may belong to more than two faces and points may
    /// be used by no face.
    ///
    /// # Errors
    ///
    /// The first fault found, in the order in which [`MeshError`] lists them.
    pub fn new(points: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        check_closed(&points, &faces)?;
        let mesh = Self::from_closed(points, faces);
        let volume = mesh.volume();
        if volume < 0.0 { Err(MeshError::InsideOut { volume }) } else { Ok(mesh) }
    }

    /// A mesh of what [`check_closed`] has passed and is not inside out.
    pub(crate) fn from_closed(points: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Self {
        Self { points, faces }
    }

    /// The points.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The faces, as indices of points, counter-clockwise seen from outside.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// The corners of one face.
    pub(crate) fn corners(&self, face: usize) -> [DVec3; 3] {
        let [a, b, c] = self.faces[face];
        [self.points[a as usize], self.points[b as usize], self.points[c as usize]]
    }

    /// The smallest box around the points that faces use.
    pub fn bounds(&self) -> Aabb {
        Aabb::around(self.faces.iter().flatten().map(|&i| self.points[i as usize]))
    }

    /// The enclosed volume by the divergence theorem, each stretch of space counted as
    /// often as the mesh winds around it.
    ///
    /// Tetrahedra are measured from the centre of the bounds, so that a mesh far from the
    /// origin loses no digits.
    pub fn volume(&self) -> f64 {
        let center = self.bounds().center();
        let sixth: f64 = (0..self.faces.len())
            .map(|i| {
                let [a, b, c] = self.corners(i).map(|p| p - center);
                a.dot(b.cross(c))
            })
            .sum();
        sixth / 6.0
    }
}

/// Says how large the mesh is; it can be too large to print.
impl fmt::Debug for Mesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Mesh({} points, {} faces)", self.points.len(), self.faces.len())
    }
}

/// Whether faces are closed and oriented, one way or the other.
///
/// # Errors
///
/// The first fault found.
pub(crate) fn check_closed(
    points: &[DVec3],
    faces: &[[u32; 3]],
) -> Result<(), MeshError> {
    check::indices(points, faces)?;
    check::closed(points, faces)
}
