//! One point.

use glam::DVec3;

use super::super::Tracer;
use crate::shape::Beside;

/// What is known of leaves around a point.
#[derive(Debug, Default)]
pub(in super::super) struct Around {
    inside: Vec<u32>,
    unsure: Vec<u32>,
}

impl Tracer<'_> {
    /// Whether a point is inside, if the leaves around it say so for certain.
    pub(in super::super) fn certain(&mut self, point: DVec3) -> Option<bool> {
        self.look_around(point)?;
        let mut around = std::mem::take(&mut self.around);
        // A union of everything is decided by one of it.
        let decided = around.inside.iter().any(|&leaf| {
            let literal = self.scene.literals[leaf as usize];
            literal.parent == 0 && !literal.complement
        });
        let answer = if decided { Some(true) } else { self.decide(&mut around) };
        self.around = around;
        answer
    }

    /// The same, if not even one leaf around the point is unsure.
    pub(in super::super) fn certain_of_all(&mut self, point: DVec3) -> Option<bool> {
        self.look_around(point)?;
        let mut around = std::mem::take(&mut self.around);
        let answer =
            if around.unsure.is_empty() { self.decide(&mut around) } else { None };
        self.around = around;
        answer
    }

    /// Looks for the leaves that are not far away for certain. Nothing if the point is not where
    /// that is an answer.
    fn look_around(&mut self, point: DVec3) -> Option<()> {
        let Self { scene, room, around, .. } = self;
        let room = (*room)?;
        around.inside.clear();
        around.unsure.clear();
        if room.is_beyond(point) {
            return Some(());
        }
        if !room.holds(point) {
            return None;
        }
        let (low, high) = (point - room.pad, point + room.pad);
        scene.hierarchy.holding(low, high, |leaf| {
            let bounds = &scene.clipped[leaf as usize];
            if low.cmpgt(bounds.max).any() || high.cmplt(bounds.min).any() {
                return;
            }
            match scene.shapes[leaf as usize].beside(point, room.pad) {
                Beside::In => around.inside.push(leaf),
                Beside::Out => {}
                Beside::Unsure => around.unsure.push(leaf),
            }
        });
        Some(())
    }

    /// Whether the solid is there, if that does not depend on the leaves that are unsure.
    fn decide(&mut self, around: &mut Around) -> Option<bool> {
        let Around { inside, unsure } = around;
        if inside.is_empty() && unsure.is_empty() {
            // Far away from everything.
            return Some(self.root());
        }
        inside.iter().for_each(|&leaf| self.flip(leaf, true));
        let answer = if unsure.is_empty() {
            Some(self.root())
        } else {
            // Nodes are true rather than false the more of their children are.
            let is = |tracer: &Self, leaf: u32| {
                tracer.scene.literals[leaf as usize].complement
            };
            let complements = unsure.iter().filter(|&&leaf| is(self, leaf));
            let complements: usize = complements.count();
            unsure.sort_unstable_by_key(|&leaf| !is(self, leaf));
            let (complements, others) = unsure.split_at(complements);
            let most = {
                others.iter().for_each(|&leaf| self.flip(leaf, true));
                let root = self.root();
                others.iter().for_each(|&leaf| self.flip(leaf, false));
                root
            };
            let least = {
                complements.iter().for_each(|&leaf| self.flip(leaf, true));
                let root = self.root();
                complements.iter().for_each(|&leaf| self.flip(leaf, false));
                root
            };
            (least == most).then_some(least)
        };
        inside.iter().for_each(|&leaf| self.flip(leaf, false));
        answer
    }
}
