//! Meshes from polygons, and outlines as prisms.

use glam::{DAffine3, DVec2, DVec3};

use super::{Ends, Mesh, MeshError, Quad, loft, polygon};

impl Mesh {
    /// A mesh of points and faces with three or more corners, each face the indices of
    /// points counter-clockwise seen from outside.
    ///
    /// Faces may be concave and need not be planar; what a face that is not planar means
    /// between its edges is not unique. Faces that touch or cross themselves still close
    /// the mesh.
    ///
    /// ```
    /// use glam::dvec3;
    /// use solidray::Mesh;
    ///
    /// let points = vec![
    ///     dvec3(0.0, 0.0, 0.0), dvec3(3.0, 0.0, 0.0), dvec3(3.0, 3.0, 0.0),
    ///     dvec3(0.0, 3.0, 0.0), dvec3(0.0, 0.0, 2.0),
    /// ];
    /// let pyramid = [vec![3, 2, 1, 0], vec![0, 1, 4], vec![1, 2, 4], vec![2, 3, 4], vec![3, 0, 4]];
    /// assert_eq!(Mesh::from_polygons(points, &pyramid)?.volume(), 6.0);
    /// # Ok::<(), solidray::MeshError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The first fault found, in the order in which [`MeshError`] lists them.
    pub fn from_polygons<F: AsRef<[u32]>>(
        points: Vec<DVec3>,
        faces: &[F],
    ) -> Result<Self, MeshError> {
        let triangles = triangulated(&points, faces.iter().map(AsRef::as_ref))?;
        Self::new(points, triangles)
    }

    /// The prism over an outline between two heights, `bottom` < `top`.
    ///
    /// Paths close themselves. A point belongs to the outline when it is within an odd
    /// number of paths, whichever way they run: a path within another is a hole, a path
    /// in that an island, a path drawn twice is nothing.
    ///
    /// # Errors
    ///
    /// [`MeshError::NoFaces`] when the outline is empty, [`MeshError::NotFinite`], and
    /// [`MeshError::Tangled`] when paths cross too often to be told apart.
    pub fn prism(paths: &[Vec<DVec2>], bottom: f64, top: f64) -> Result<Self, MeshError> {
        Self::tapered(paths, [bottom, top], [1.0; 2])
    }

    /// The same where the outline is scaled about the origin on the way from the bottom to the top,
    /// by numbers that are not below zero.
    pub(crate) fn tapered(
        paths: &[Vec<DVec2>],
        heights: [f64; 2],
        scales: [f64; 2],
    ) -> Result<Self, MeshError> {
        let section = |i: usize| {
            let mut map = DAffine3::from_scale(DVec3::new(scales[i], scales[i], 1.0));
            map.translation.z = heights[i];
            map
        };
        // Its sides are plane.
        loft(paths, &[0, 1].map(section), Ends::Open, Quad::short)
    }
}

/// The triangles of faces with three or more corners.
pub(crate) fn triangulated<'a>(
    points: &[DVec3],
    faces: impl Iterator<Item = &'a [u32]>,
) -> Result<Vec<[u32; 3]>, MeshError> {
    let mut triangles = Vec::with_capacity(faces.size_hint().0);
    for (face, corners) in faces.enumerate() {
        if let Some(&index) = corners.iter().find(|&&i| i as usize >= points.len()) {
            let (index, count) = (u64::from(index), points.len());
            return Err(MeshError::NoSuchPoint { face, index, count });
        }
        if corners.len() < 3 {
            return Err(MeshError::TooFewCorners { face, corners: corners.len() });
        }
        triangles.extend(polygon::triangles(points, corners));
    }
    Ok(triangles)
}
