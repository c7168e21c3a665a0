//! From points and faces as files give them to a mesh.

use std::collections::HashMap;

use glam::DVec3;

use super::error::{Located, ReadErrorKind};
use super::turn::turn;
use crate::mesh::{self, Mesh, MeshError};

/// What a warning about a turned mesh says.
pub(super) const TURNED: &str = "the mesh was inside out and has been turned";

/// Points and faces, counter-clockwise seen from outside, not yet checked.
#[derive(Debug, Default)]
pub(super) struct Faces {
    pub(super) points: Vec<DVec3>,
    pub(super) faces: Vec<Vec<u32>>,
}

/// A mesh made of them.
#[derive(Debug)]
pub(super) struct Built {
    pub(super) mesh: Mesh,
    /// Whether some or all faces had to be reversed.
    pub(super) turned: bool,
}

impl Faces {
    /// The mesh, put right where what is meant is plain: points listed several times are
    /// welded if the mesh is open without, and bodies that are inside out are turned.
    ///
    /// Only points with equal coordinates are welded; a tolerance could close what was
    /// meant to be apart.
    pub(super) fn build(mut self) -> Result<Built, Located> {
        let mut checked = self.triangles();
        if matches!(checked, Err(MeshError::OpenEdges { .. })) && self.weld() {
            checked = self.triangles();
        }
        let mut triangles =
            checked.map_err(|error| Located::nowhere(ReadErrorKind::Mesh(error)))?;
        let turned = turn(&self.points, &mut triangles);
        Ok(Built { mesh: Mesh::from_closed(self.points, triangles), turned })
    }

    /// The faces as triangles, which are closed.
    fn triangles(&self) -> Result<Vec<[u32; 3]>, MeshError> {
        let triangles = mesh::triangulated(&self.points, &self.faces)?;
        mesh::check_closed(&self.points, &triangles)?;
        Ok(triangles)
    }

    /// Keeps one of equal points each, and drops faces that this leaves without area.
    /// Whether any points were equal.
    fn weld(&mut self) -> bool {
        let mut distinct = Points::default();
        let mut same = Vec::with_capacity(self.points.len());
        for &point in &self.points {
            let Some(index) = distinct.add(point) else { return false };
            same.push(index);
        }
        if distinct.points.len() == self.points.len() {
            return false;
        }
        self.points = distinct.finish();
        for face in &mut self.faces {
            for index in face.iter_mut() {
                *index = same[*index as usize];
            }
            face.dedup();
            while face.len() > 1 && face.first() == face.last() {
                face.pop();
            }
        }
        self.faces.retain(|face| face.len() > 2);
        true
    }
}

/// Distinct points in the order in which they come.
#[derive(Debug, Default)]
pub(super) struct Points {
    points: Vec<DVec3>,
    found: HashMap<[u64; 3], u32>,
}

impl Points {
    /// The index of a point; none when there are more points than indices.
    pub(super) fn add(&mut self, point: DVec3) -> Option<u32> {
        let next = u32::try_from(self.points.len()).ok()?;
        // Adding zero makes −0 and 0 one number.
        let bits = (point + DVec3::ZERO).to_array().map(f64::to_bits);
        let index = *self.found.entry(bits).or_insert(next);
        if index == next {
            self.points.push(point);
        }
        Some(index)
    }

    /// The points, without room for more.
    pub(super) fn finish(mut self) -> Vec<DVec3> {
        self.points.shrink_to_fit();
        self.points
    }
}
