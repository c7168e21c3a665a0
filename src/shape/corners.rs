//! The corners of the faces of a mesh, pack by pack.
//!
//! Rays that meet a face of a pack have a mesh's memory looked at in one place here, where a
//! mesh has its points and faces in the order in which they were given, which can be any.

use glam::DVec3;

use crate::eight::EIGHT;
use crate::mesh::Mesh;

/// The corners of the faces of each pack.
#[derive(Debug, Default)]
pub(super) struct Corners {
    /// Those of one pack after those of another, each once in a pack.
    points: Vec<DVec3>,
    packs: Vec<OfPack>,
}

/// The corners of the faces of a pack.
#[derive(Clone, Copy, Debug)]
struct OfPack {
    first: usize,
    /// Counted from the first.
    faces: [[u8; 3]; EIGHT],
}

impl Corners {
    /// Adds the next pack.
    pub(super) fn add(&mut self, mesh: &Mesh, faces: &[u32]) {
        let mut of_pack = OfPack { first: self.points.len(), faces: [[0; 3]; EIGHT] };
        let mut known = [0; 3 * EIGHT];
        let mut count: u8 = 0;
        for (corners, &face) in of_pack.faces.iter_mut().zip(faces) {
            for (corner, point) in corners.iter_mut().zip(mesh.faces()[face as usize]) {
                let all = (0..).zip(&known[..usize::from(count)]);
                let place = all.into_iter().find(|(_, other)| **other == point);
                *corner = place.map_or(count, |(place, _)| place);
                if *corner == count {
                    known[usize::from(count)] = point;
                    self.points.push(mesh.points()[point as usize]);
                    count += 1;
                }
            }
        }
        self.packs.push(of_pack);
    }

    /// After the last one.
    pub(super) fn shrink(&mut self) {
        self.points.shrink_to_fit();
        self.packs.shrink_to_fit();
    }

    /// Those of a face of a pack, by the number of its bit.
    #[inline]
    pub(super) fn of(&self, pack: u32, bit: usize) -> [DVec3; 3] {
        let OfPack { first, faces } = &self.packs[pack as usize];
        let points = &self.points[*first..];
        faces[bit].map(|corner| points[usize::from(corner)])
    }

    /// How much memory they take.
    #[cfg(test)]
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.points) + size_of_val(&*self.packs)
    }
}
