//! What a scene is to boxes within boxes: all inside, all outside, or between which bounds.
//!
//! As in `beam`, but for volumes. What is said is certain: rounding, and how far the surfaces
//! lie beside those that were said, included.

use std::ops::Range;

use glam::DVec3;

use super::Scene;
use super::beam::{Known, Place};
use super::points::is_inside;
use crate::aabb::Aabb;
use crate::shape::{ALL, Block, Region, Shape, Side, U};

/// A leaf that matters, and which of its faces do.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    leaf: u32,
    faces: u32,
}

/// Boxes within boxes, of which one is looked at after the other.
#[derive(Debug)]
pub(crate) struct Blocks<'a> {
    scene: &'a Scene,
    known: Known<'a>,
    /// No coordinate of any box is larger.
    reach: f64,
    /// One list on the other.
    candidates: Vec<Candidate>,
    /// What the leaves of the lists are to the boxes for which they were looked at.
    places: Vec<Place>,
}

/// The leaves that matter in a box.
#[derive(Clone, Debug)]
pub(crate) struct Leaves {
    range: Range<usize>,
    /// What they all are to the box around.
    before: Place,
}

/// What a scene is to a box.
#[derive(Clone, Debug)]
pub(crate) enum Found {
    /// All of it is inside, or none.
    Decided(bool),
    /// At least and at most these parts of it are, and these leaves matter.
    Between([f64; 2], Leaves),
}

impl Scene {
    /// A box around the solid as it was said: with room for rounding, and for how far the
    /// surfaces lie beside those that were said.
    pub(crate) fn bounds_of_true_solid(&self) -> Aabb {
        let bounds = self.bounds();
        bounds.grown(4.0 * self.worst_slack + 64.0 * U * bounds.reach())
    }
}

/// A box in which more leaves matter is not looked at more closely.
const FEW: usize = 4;

impl<'a> Blocks<'a> {
    /// For boxes within another.
    pub(crate) fn new(scene: &'a Scene, bounds: &Aabb) -> Self {
        let (candidates, places) = (Vec::new(), Vec::new());
        let reach = bounds.reach().max(bounds.size().max_element());
        Self { scene, known: Known::new(scene), reach, candidates, places }
    }

    fn region(&self, center: DVec3, half: DVec3) -> Region {
        let [x, y, z] = [0, 1, 2].map(|axis| half[axis] * DVec3::AXES[axis]);
        Region::new(center, x, [y, z], self.reach)
    }

    /// The leaves that a box may meet, the first of all that are looked at.
    pub(crate) fn leaves(&mut self, center: DVec3, half: DVec3) -> Leaves {
        let region = self.region(center, half);
        let Self { scene, candidates, .. } = self;
        candidates.clear();
        scene.hierarchy.meeting(
            |bounds| region.meets(bounds),
            |leaf| candidates.push(Candidate { leaf, faces: ALL }),
        );
        Leaves { range: 0..candidates.len(), before: Place::Out }
    }

    /// Looks at a box; all leaves that matter are in a list. To be followed by
    /// [`Blocks::leave`] with the same list.
    pub(crate) fn enter(&mut self, center: DVec3, half: DVec3, leaves: &Leaves) -> Found {
        let region = self.region(center, half);
        let first_place = self.places.len();
        let first = self.candidates.len();
        for i in leaves.range.clone() {
            let Candidate { leaf, faces } = self.candidates[i];
            let (place, open) = match self.side(&region, center, leaf) {
                Side::Crossing(open) if open & faces == 0 => (Place::In, 0),
                Side::Crossing(open) => (Place::Open, open & faces),
                Side::In => (Place::In, 0),
                Side::Out => (Place::Out, 0),
            };
            self.known.learn(leaf, leaves.before, place);
            self.places.push(place);
            if place == Place::Open {
                self.candidates.push(Candidate { leaf, faces: open });
            }
        }
        debug_assert_eq!(self.places.len() - first_place, leaves.range.len());
        if let Some(inside) = self.known.root() {
            return Found::Decided(inside);
        }
        self.known.next_region();
        let mut end = first;
        for i in first..self.candidates.len() {
            if self.known.matters(self.candidates[i].leaf) {
                self.candidates[end] = self.candidates[i];
                end += 1;
            }
        }
        self.candidates.truncate(end);
        let share = self.share(center, half, first..end);
        Found::Between(share, Leaves { range: first..end, before: Place::Open })
    }

    /// Forgets what was learned of a box.
    pub(crate) fn leave(&mut self, leaves: &Leaves) {
        let first_place = self.places.len() - leaves.range.len();
        for (i, k) in leaves.range.clone().zip(first_place..) {
            let leaf = self.candidates[i].leaf;
            self.known.learn(leaf, self.places[k], leaves.before);
        }
        self.places.truncate(first_place);
        self.candidates.truncate(leaves.range.end);
    }

    /// What a leaf is to a region. A mesh no triangle of which touches it is all around it, or
    /// nowhere, as a line through its middle says.
    fn side(&self, region: &Region, center: DVec3, leaf: u32) -> Side {
        let Scene { shapes, clipped, slacks, .. } = self.scene;
        let i = leaf as usize;
        let side = region.side(&shapes[i], &clipped[i], slacks[i]);
        match (&shapes[i], side) {
            (Shape::Polyhedron(mesh), Side::Crossing(_))
                if self.has_lines_through(center)
                    && !mesh.touches(region, self.pad(leaf)) =>
            {
                if is_inside(self.scene, leaf, center) { Side::In } else { Side::Out }
            }
            (_, side) => side,
        }
    }

    /// Whether a line through a point counts.
    fn has_lines_through(&self, p: DVec3) -> bool {
        let bounds = self.scene.bounds();
        p.cmpge(bounds.min).all() && p.cmple(bounds.max).all()
    }

    /// By how much more than a leaf's slack a box is in doubt: as in [`Region::side`].
    fn pad(&self, leaf: u32) -> f64 {
        4.0 * self.scene.slacks[leaf as usize] + 64.0 * U * self.reach
    }

    /// At least and at most what part of a box is inside.
    fn share(&mut self, center: DVec3, half: DVec3, open: Range<usize>) -> [f64; 2] {
        if open.len() > FEW {
            return [0.0, 1.0];
        }
        let mut shares = [[0.0, 1.0]; FEW];
        for (share, i) in shares.iter_mut().zip(open.clone()) {
            let Candidate { leaf, faces } = self.candidates[i];
            let shape = &self.scene.shapes[leaf as usize];
            if matches!(shape, Shape::Polyhedron(_)) {
                return [0.0, 1.0];
            }
            let pad = self.pad(leaf);
            *share = Block { center, half, pad }.share(shape, faces);
        }
        let shares = &shares[..open.len()];
        let of_one = self.beside_one_surface(shares, open.clone());
        of_one.unwrap_or_else(|| self.among_surfaces(shares, open))
    }

    /// The expression has no complements but at its leaves, and is open: so it is false where
    /// all open leaves are, and true where all are (M. Fréchet, "Généralisation du théorème
    /// des probabilités totales", Fundamenta Mathematicae 25, 1935).
    fn among_surfaces(&self, shares: &[[f64; 2]], open: Range<usize>) -> [f64; 2] {
        let (mut missing, mut most) = (0.0, 0.0);
        for (&[low, high], Candidate { leaf, .. }) in
            shares.iter().zip(&self.candidates[open])
        {
            let complement = self.scene.literals[*leaf as usize].complement;
            let [low, high] =
                if complement { [1.0 - high, 1.0 - low] } else { [low, high] };
            missing += 1.0 - low;
            most += high;
        }
        [(1.0 - missing - ROUNDING).max(0.0), (most + ROUNDING).min(1.0)]
    }

    /// Where the faces of all open leaves are of one surface, the solid is the same on each
    /// side of it: the surfaces that were said part no more of the box than the doubt in each.
    fn beside_one_surface(
        &mut self,
        shares: &[[f64; 2]],
        open: Range<usize>,
    ) -> Option<[f64; 2]> {
        let mut first = None;
        let (mut low, mut high) = (1.0_f64, 0.0_f64);
        // Which leaves are on the side where the first is not.
        let mut across = [false; FEW];
        for ((&[least, most], candidate), across) in
            shares.iter().zip(&self.candidates[open.clone()]).zip(&mut across)
        {
            let Candidate { leaf, faces } = *candidate;
            if faces.count_ones() != 1 {
                return None;
            }
            let shape = &self.scene.shapes[leaf as usize];
            let (surface, above) = shape.identity(faces.trailing_zeros());
            let (known, side) = *first.get_or_insert((surface, above));
            if known != surface {
                return None;
            }
            *across = side != above;
            let [least, most] =
                if *across { [1.0 - most, 1.0 - least] } else { [least, most] };
            (low, high) = (low.min(least), high.max(most));
        }
        let mut root_where = |is_in: bool| {
            let place =
                |across: bool| if is_in == across { Place::Out } else { Place::In };
            let leaves = || self.candidates[open.clone()].iter().zip(across);
            for (candidate, across) in leaves() {
                self.known.learn(candidate.leaf, Place::Open, place(across));
            }
            let root = self.known.root();
            for (candidate, across) in leaves() {
                self.known.learn(candidate.leaf, place(across), Place::Open);
            }
            root
        };
        let (inside, outside) = (root_where(true)?, root_where(false)?);
        let certain = |holds: bool, part: f64| if holds { part } else { 0.0 };
        let least = certain(inside, low) + certain(outside, 1.0 - high);
        let most = least + (high - low);
        Some([(least - ROUNDING).max(0.0), (most + ROUNDING).min(1.0)])
    }
}

/// A few sums of parts of 1 are rounded by no more than this.
const ROUNDING: f64 = 16.0 * U;
