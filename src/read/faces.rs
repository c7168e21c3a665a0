//! From points and faces as files give them to a mesh.

use std::collections::HashMap;

use glam::DVec3;

use super::error::{Located, ReadErrorKind};
use crate::mesh::{Mesh, MeshError};

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
    /// Whether all faces had to be reversed.
    pub(super) turned: bool,
}

impl Faces {
    /// The mesh, put right where what is meant is plain: points listed several times are
    /// welded if the mesh is open without, and an inside-out mesh is turned.
    ///
    /// Only points with equal coordinates are welded; a tolerance could close what was
    /// meant to be apart.
    pub(super) fn build(mut self) -> Result<Built, Located> {
        let mut made = Mesh::from_polygons(self.points.clone(), &self.faces);
        if matches!(made, Err(MeshError::OpenEdges { .. })) && self.weld() {
            made = Mesh::from_polygons(self.points.clone(), &self.faces);
        }
        let turned = matches!(made, Err(MeshError::InsideOut { .. }));
        if turned {
            for face in &mut self.faces {
                face.reverse();
            }
            made = Mesh::from_polygons(self.points, &self.faces);
        }
        match made {
            Ok(mesh) => Ok(Built { mesh, turned }),
            Err(error) => Err(Located::nowhere(ReadErrorKind::Mesh(error))),
        }
    }

    /// Makes faces name the first of equal points, and drops faces that this leaves
    /// without area. Whether any points were equal.
    fn weld(&mut self) -> bool {
        let mut first: HashMap<[u64; 3], u32> = HashMap::new();
        let mut same = Vec::with_capacity(self.points.len());
        for (index, p) in (0_u32..).zip(&self.points) {
            // Adding zero makes −0 and 0 one number.
            let bits = (*p + DVec3::ZERO).to_array().map(f64::to_bits);
            same.push(*first.entry(bits).or_insert(index));
        }
        if first.len() == self.points.len() {
            return false;
        }
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
