//! From points and faces as files give them to a mesh.

use std::collections::HashMap;

use glam::DVec3;

use super::error::{Located, ReadErrorKind};
use super::turn::turn;
use crate::mesh::{self, Mesh, MeshError};

/// What a warning about a turned mesh says.
pub(super) const TURNED: &str = "the mesh was inside out and has been turned";

/// Points and faces, counter-clockwise seen from outside, not yet checked.
///
/// A list for each face would take twice as much memory as a whole mesh.
#[derive(Debug, Default)]
pub(super) struct Faces {
    pub(super) points: Vec<DVec3>,
    /// The corners of all faces, one face after the other.
    corners: Vec<u32>,
    /// Where each face ends.
    ends: Vec<usize>,
}

/// A mesh made of them.
#[derive(Debug)]
pub(super) struct Built {
    pub(super) mesh: Mesh,
    /// Whether some or all faces had to be reversed.
    pub(super) turned: bool,
}

impl Faces {
    /// Adds a face.
    pub(super) fn push(&mut self, corners: impl IntoIterator<Item = u32>) {
        self.corners.extend(corners);
        self.ends.push(self.corners.len());
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The corners of each face.
    fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let mut from = 0;
        self.ends.iter().map(move |&end| {
            let face = &self.corners[from..end];
            from = end;
            face
        })
    }

    /// The mesh, put right where what is meant is plain: points listed several times are
    /// welded if the mesh is open without, and bodies that are inside out are turned.
    ///
    /// Points with equal coordinates are welded; a tolerance could close what was meant to be
    /// apart. OpenSCAD has one in polyhedra, its `grid`; it is used where nothing else helps.
    pub(super) fn build(self) -> Result<Built, Located> {
        self.build_on_grid(None)
    }

    /// The same with points that are one on a grid of so wide cells, if the mesh is open without.
    pub(super) fn build_on_grid(mut self, grid: Option<f64>) -> Result<Built, Located> {
        let mut checked = self.triangles();
        let rounded = |p: DVec3| grid.map_or(p, |grid| (p / grid).round());
        for round in [&|p| p as DVec3, &rounded as &dyn Fn(DVec3) -> DVec3] {
            if matches!(checked, Err(MeshError::OpenEdges { .. })) && self.weld(round) {
                checked = self.triangles();
            }
        }
        let mut triangles =
            checked.map_err(|error| Located::nowhere(ReadErrorKind::Mesh(error)))?;
        let Self { points, .. } = self;
        let turned = turn(&points, &mut triangles);
        Ok(Built { mesh: Mesh::from_closed(points, triangles), turned })
    }

    /// The faces as triangles, which are closed.
    fn triangles(&self) -> Result<Vec<[u32; 3]>, MeshError> {
        let triangles = mesh::triangulated(&self.points, self.iter())?;
        mesh::check_closed(&self.points, &triangles)?;
        Ok(triangles)
    }

    /// Keeps the first of the points each that are equal when they are rounded, and drops faces
    /// that this leaves without area. Whether there were any.
    fn weld(&mut self, round: &dyn Fn(DVec3) -> DVec3) -> bool {
        let mut distinct = Points::default();
        let mut kept = Vec::new();
        let mut same = Vec::with_capacity(self.points.len());
        for &point in &self.points {
            let Ok(index) = distinct.add(round(point)) else { return false };
            if index as usize == kept.len() {
                kept.push(point);
            }
            same.push(index);
        }
        if kept.len() == self.points.len() {
            return false;
        }
        let mut welded = Self { points: kept, ..Self::default() };
        for face in self.iter() {
            let mut face: Vec<u32> = face.iter().map(|&i| same[i as usize]).collect();
            face.dedup();
            while face.len() > 1 && face.first() == face.last() {
                face.pop();
            }
            if face.len() > 2 {
                welded.push(face);
            }
        }
        *self = welded;
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
    /// The index of a point, unless there are more points than indices.
    pub(super) fn add(&mut self, point: DVec3) -> Result<u32, Located> {
        let count = self.points.len();
        let next = u32::try_from(count).map_err(|_| {
            let error = MeshError::TooLarge { count, limit: u32::MAX as usize };
            Located::nowhere(ReadErrorKind::Mesh(error))
        })?;
        // Adding zero makes −0 and 0 one number.
        let bits = (point + DVec3::ZERO).to_array().map(f64::to_bits);
        let index = *self.found.entry(bits).or_insert(next);
        if index == next {
            self.points.push(point);
        }
        Ok(index)
    }

    /// The points, without room for more.
    pub(super) fn finish(mut self) -> Vec<DVec3> {
        self.points.shrink_to_fit();
        self.points
    }
}
