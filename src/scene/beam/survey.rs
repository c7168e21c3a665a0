//! Which leaves matter in regions within regions.

use std::ops::Range;

use super::known::{Known, Place};
use super::work::Work;
use crate::scene::Scene;
use crate::shape::{ALL, Region, Side};

/// A leaf that matters in a region, and which of its faces do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) leaf: u32,
    pub(super) faces: u32,
}

/// What is known in the region that is being looked at, and in those around it.
#[derive(Debug)]
pub(super) struct Survey<'a> {
    scene: &'a Scene,
    pub(super) known: Known<'a>,
    /// One list on the other.
    candidates: Vec<Candidate>,
    /// What the leaves of the lists are to the regions for which they were looked at.
    sides: Vec<Side>,
    pub(super) work: Work,
}

/// A list of leaves that can matter.
#[derive(Clone, Debug)]
pub(super) struct List {
    leaves: Range<usize>,
    /// What they all are to the region around.
    before: Place,
}

impl List {
    pub(super) fn len(&self) -> usize {
        self.leaves.len()
    }
}

impl<'a> Survey<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let known = Known::new(scene);
        let (candidates, sides) = (Vec::new(), Vec::new());
        Self { scene, known, candidates, sides, work: Work::default() }
    }

    /// The leaves that a region may meet.
    pub(super) fn all(&mut self, region: &Region) -> List {
        let Self { scene, candidates, .. } = self;
        candidates.clear();
        scene.hierarchy.meeting(
            |bounds| region.meets(bounds),
            |leaf| candidates.push(Candidate { leaf, faces: ALL }),
        );
        List { leaves: 0..candidates.len(), before: Place::Out }
    }

    /// Looks at a region; all leaves that matter are in a list. Says which matter in it,
    /// unless the solid is all of the region or none. To be followed by [`Survey::leave`].
    pub(super) fn enter(&mut self, region: &Region, list: &List) -> Option<List> {
        let first_side = self.sides.len();
        self.work.regions += 1;
        self.work.sides += list.len() as u64;
        for i in list.leaves.clone() {
            let Candidate { leaf, faces } = self.candidates[i];
            let number = leaf as usize;
            let Scene { shapes, clipped, slacks, .. } = self.scene;
            let side = region.side(&shapes[number], &clipped[number], slacks[number]);
            let side = match side {
                Side::Crossing(open) if open & faces == 0 => Side::In,
                Side::Crossing(open) => Side::Crossing(open & faces),
                Side::In | Side::Out => side,
            };
            self.known.learn(leaf, list.before, side.into());
            self.sides.push(side);
        }
        if self.known.root().is_some() {
            return None;
        }
        let first = self.candidates.len();
        self.known.next_region();
        for (i, k) in list.leaves.clone().zip(first_side..) {
            let leaf = self.candidates[i].leaf;
            if let Side::Crossing(faces) = self.sides[k]
                && self.known.matters(leaf)
            {
                self.candidates.push(Candidate { leaf, faces });
            }
        }
        Some(List { leaves: first..self.candidates.len(), before: Place::Open })
    }

    /// Forgets what was learned of a region with a list.
    pub(super) fn leave(&mut self, list: &List) {
        let first_side = self.sides.len() - list.len();
        for (i, k) in list.leaves.clone().zip(first_side..) {
            let leaf = self.candidates[i].leaf;
            self.known.learn(leaf, self.sides[k].into(), list.before);
        }
        self.sides.truncate(first_side);
        self.candidates.truncate(list.leaves.end);
    }

    /// What is known in the region that was entered last, and the leaves that matter there.
    pub(super) fn found(&mut self, list: &List) -> (&mut Known<'a>, &[Candidate]) {
        (&mut self.known, &self.candidates[list.leaves.clone()])
    }
}
