//! What is known of a solid in a region: true, false, or open.

use crate::scene::Scene;
use crate::shape::Side;

/// For each node how many children are true for certain, and how many may be.
///
/// Everything is counted as outside of all leaves until [`Known::learn`] says otherwise,
/// and learning is undone by unlearning, so that regions within regions cost what differs.
#[derive(Debug)]
pub(in crate::scene) struct Known<'a> {
    scene: &'a Scene,
    least: Vec<u32>,
    most: Vec<u32>,
    /// As `least`, where what is open counts as outside.
    pub(in crate::scene) counts: Vec<u32>,
    /// Whether a node was found to be open in the region with this number.
    seen: Vec<(u32, bool)>,
    region: u32,
    path: Vec<u32>,
}

/// What a leaf is to a region, for the expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::scene) enum Place {
    Out,
    In,
    Open,
}

impl From<Side> for Place {
    fn from(side: Side) -> Self {
        match side {
            Side::In => Self::In,
            Side::Out => Self::Out,
            Side::Crossing(_) => Self::Open,
        }
    }
}

impl<'a> Known<'a> {
    pub(in crate::scene) fn new(scene: &'a Scene) -> Self {
        let counts = scene.far_away.clone();
        Self {
            scene,
            least: counts.clone(),
            most: counts.clone(),
            seen: vec![(0, false); counts.len()],
            counts,
            region: 0,
            path: Vec::new(),
        }
    }

    /// A leaf that was one thing to a region is another to the region within.
    pub(in crate::scene) fn learn(&mut self, leaf: u32, before: Place, after: Place) {
        let Scene { program, literals, .. } = self.scene;
        let literal = literals[leaf as usize];
        let (is, may_be, counts_as) = values(before, literal.complement);
        let (is_now, may_be_now, counts_as_now) = values(after, literal.complement);
        if is != is_now {
            program.toggle(&mut self.least, literal.parent, is_now);
        }
        if may_be != may_be_now {
            program.toggle(&mut self.most, literal.parent, may_be_now);
        }
        if counts_as != counts_as_now {
            program.toggle(&mut self.counts, literal.parent, counts_as_now);
        }
    }

    /// Whether the solid is all of the region or none; nothing if that is open.
    pub(in crate::scene) fn root(&self) -> Option<bool> {
        let program = &self.scene.program;
        let is = program.root(&self.least);
        (is == program.root(&self.most)).then_some(is)
    }

    /// Forgets which nodes are open: another region is looked at.
    pub(in crate::scene) fn next_region(&mut self) {
        self.region = self.region.wrapping_add(1);
        if self.region == 0 {
            self.seen.fill((0, false));
            self.region = 1;
        }
    }

    /// Whether all nodes above a leaf are open, so that it can matter.
    pub(in crate::scene) fn matters(&mut self, leaf: u32) -> bool {
        let program = &self.scene.program;
        let mut at = self.scene.literals[leaf as usize].parent;
        self.path.clear();
        let open = loop {
            let (region, open) = self.seen[at as usize];
            if region == self.region {
                break open;
            }
            self.path.push(at);
            let is = program.is_true(&self.least, at);
            if is == program.is_true(&self.most, at) {
                break false;
            }
            if at == 0 {
                break true;
            }
            at = program.parent(at);
        };
        for &node in &self.path {
            self.seen[node as usize] = (self.region, open);
        }
        open
    }
}

/// Whether a leaf's literal is true for certain, whether it may be, and as what it counts.
fn values(place: Place, complement: bool) -> (bool, bool, bool) {
    match place {
        Place::Out => (complement, complement, complement),
        Place::In => (!complement, !complement, !complement),
        Place::Open => (false, true, complement),
    }
}
