//! Convex hulls, and sums of solids by Minkowski that are made of them.

use std::collections::HashMap;

use glam::DVec3;

use super::{FacetsError, quickhull};
use crate::mesh::{Mesh, MeshError};

/// The convex hull of points; `None` if they are flat.
///
/// # Errors
///
/// If a point is not finite.
pub(crate) fn hull(points: &[DVec3]) -> Result<Option<Mesh>, FacetsError> {
    let mut faces = quickhull::faces(points);
    if faces.is_empty() {
        return Ok(None);
    }
    // Points that are no corners are left out.
    let mut numbers: HashMap<u32, u32> = HashMap::new();
    let mut corners = Vec::new();
    for corner in faces.iter_mut().flatten() {
        *corner = *numbers.entry(*corner).or_insert_with(|| {
            corners.push(points[*corner as usize]);
            u32::try_from(corners.len() - 1).unwrap_or(u32::MAX)
        });
    }
    match Mesh::new(corners, faces) {
        Ok(mesh) => Ok(Some(mesh).filter(|mesh| mesh.volume() > 0.0)),
        // So thin that its volume is a rounding error.
        Err(MeshError::InsideOut { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// How many triangles the sum of two solids has, about.
pub(crate) fn triangles_of_sum(a: &Operand, b: &Operand) -> u64 {
    let [i, j] = [a, b].map(|o| o.mesh.faces().len() as u64);
    match (a.is_convex, b.is_convex) {
        (true, true) => i.saturating_mul(j),
        (false, true) => i.saturating_mul(2 * j + 12),
        (true, false) => j.saturating_mul(2 * i + 12),
        (false, false) => i.saturating_mul(j).saturating_mul(14),
    }
}

/// A mesh to be added.
#[derive(Debug)]
pub(crate) struct Operand {
    mesh: Mesh,
    is_convex: bool,
}

impl Operand {
    /// A mesh, reduced to its hull where it is convex.
    ///
    /// # Errors
    ///
    /// If a point is not finite.
    pub(crate) fn new(mesh: Mesh) -> Result<Self, FacetsError> {
        /// What rounding of points may take from the volume of a hull.
        const ROUNDING: f64 = 1e-9;
        let used: Vec<DVec3> = corners(&mesh).collect();
        let Some(hull) = hull(&used)? else {
            return Ok(Self { mesh, is_convex: false });
        };
        let is_convex = (hull.volume() - mesh.volume()).abs() <= ROUNDING * hull.volume();
        Ok(Self { mesh: if is_convex { hull } else { mesh }, is_convex })
    }
}

/// Meshes whose union is the sum of two solids by Minkowski: all points that are the sum of a
/// point of each.
///
/// A point p is of it where A meets p − B. There the surface of one meets that of the other,
/// or a piece of one lies within the other. So where both are not convex, the sum is that of the
/// surfaces, triangle by triangle, and of each solid with a point of every piece of the other.
/// A convex solid has one piece, and its sum with a triangle is a hull, filled and all.
///
/// (Manifold's own sum adds one solid where it is, which is right only if the other has the origin
/// inside.)
///
/// # Errors
///
/// If a point is not finite.
pub(crate) fn sum(a: &Operand, b: &Operand) -> Result<Vec<Mesh>, FacetsError> {
    match (a.is_convex, b.is_convex) {
        (true, true) => {
            Ok(hull_of_sums(a.mesh.points(), b.mesh.points())?.into_iter().collect())
        }
        (false, true) => swept(&a.mesh, &b.mesh),
        (true, false) => swept(&b.mesh, &a.mesh),
        (false, false) => {
            let mut found = Vec::new();
            for i in 0..a.mesh.faces().len() {
                for j in 0..b.mesh.faces().len() {
                    let [p, q] = [a.mesh.corners(i), b.mesh.corners(j)];
                    found.extend(hull_of_sums(&p, &q)?);
                }
            }
            found.extend(translates(&a.mesh, &one_of_each_piece(&b.mesh))?);
            found.extend(translates(&b.mesh, &one_of_each_piece(&a.mesh))?);
            Ok(found)
        }
    }
}

/// The sum of any solid and a convex one.
fn swept(any: &Mesh, convex: &Mesh) -> Result<Vec<Mesh>, FacetsError> {
    let mut found = translates(any, &convex.points()[..1])?;
    for i in 0..any.faces().len() {
        found.extend(hull_of_sums(&any.corners(i), convex.points())?);
    }
    Ok(found)
}

fn hull_of_sums(a: &[DVec3], b: &[DVec3]) -> Result<Option<Mesh>, FacetsError> {
    let sums: Vec<DVec3> = a.iter().flat_map(|p| b.iter().map(move |q| p + q)).collect();
    hull(&sums)
}

fn translates(mesh: &Mesh, by: &[DVec3]) -> Result<Vec<Mesh>, FacetsError> {
    let moved = |offset: &DVec3| {
        let points = mesh.points().iter().map(|p| p + offset).collect();
        Ok(Mesh::new(points, mesh.faces().to_vec())?)
    };
    by.iter().map(moved).collect()
}

/// The corners of faces.
fn corners(mesh: &Mesh) -> impl Iterator<Item = DVec3> {
    let mut is_used = vec![false; mesh.points().len()];
    mesh.faces().iter().flatten().for_each(|&i| is_used[i as usize] = true);
    mesh.points().iter().zip(is_used).filter(|(_, used)| *used).map(|(p, _)| *p)
}

/// A corner of every set of faces that hang together.
fn one_of_each_piece(mesh: &Mesh) -> Vec<DVec3> {
    let mut above: Vec<u32> = (0..).take(mesh.points().len()).collect();
    let root = |above: &mut Vec<u32>, mut i: u32| {
        while above[i as usize] != i {
            above[i as usize] = above[above[i as usize] as usize];
            i = above[i as usize];
        }
        i
    };
    for &[a, b, c] in mesh.faces() {
        for other in [b, c] {
            let (i, j) = (root(&mut above, a), root(&mut above, other));
            above[i.max(j) as usize] = i.min(j);
        }
    }
    let mut roots: Vec<u32> =
        mesh.faces().iter().map(|face| root(&mut above, face[0])).collect();
    roots.sort_unstable();
    roots.dedup();
    roots.into_iter().map(|i| mesh.points()[i as usize]).collect()
}
