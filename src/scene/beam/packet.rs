//! A block of rays and the few leaves that matter to it.

use glam::DVec3;
use pulp::Arch;

use super::block::{Block, Slot, slots_of};
use super::bunch::Chords;
use super::chord::{Lengths, MOST_CUTS};
use super::flat::{Firsts, is_simple};
use super::known::Known;
use super::survey::Candidate;
use super::walk::{Ends, FEW, Logic, Step, Walk};
use super::work::Work;
use crate::ray::{Crossing, Sense};
use crate::scene::program::Combine;
use crate::scene::trace::is_within;
use crate::scene::{Scene, Tracer};
use crate::shape::{ALL, Event, Line, Shape, Sink, face_of};

/// Where the rays of a block are inside each of some leaves.
#[derive(Debug)]
pub(super) struct Packet {
    pub(super) arch: Arch,
    candidates: Vec<Candidate>,
    /// Those that are used now, and others that can be used again.
    slots: Vec<Slot>,
    used: usize,
    /// The leaves that are crossed any number of times.
    meshes: Vec<u32>,
    logic: Option<Logic>,
    /// Whether rays have to be inside of leaves that they come out of once and outside of few.
    is_flat: bool,
    ends: Ends,
    firsts: Box<Firsts>,
    lengths: Box<Lengths>,
    pub(super) work: Work,
}

impl Packet {
    pub(super) fn new(arch: Arch) -> Self {
        Self {
            arch,
            candidates: Vec::new(),
            slots: Vec::new(),
            used: 0,
            meshes: Vec::new(),
            logic: None,
            is_flat: false,
            ends: Vec::new(),
            firsts: Box::new(Firsts::EMPTY),
            lengths: Box::new(Lengths::EMPTY),
            work: Work::default(),
        }
    }

    /// Takes leaves to meet, in about the order in which rays in a direction do.
    pub(super) fn choose(
        &mut self,
        scene: &Scene,
        known: &mut Known<'_>,
        candidates: &[Candidate],
        along: DVec3,
    ) {
        self.candidates.clear();
        self.candidates.extend_from_slice(candidates);
        let depth = |c: &Candidate| scene.clipped[c.leaf as usize].center().dot(along);
        self.candidates.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
        self.meshes.clear();
        for &Candidate { leaf, .. } in candidates {
            if let Shape::Polyhedron(_) = scene.shapes[leaf as usize] {
                self.meshes.push(leaf);
            }
        }
        self.logic = if self.meshes.is_empty() { self.logic(scene, known) } else { None };
        self.is_flat =
            matches!(self.logic, Some(Logic::All { .. })) && self.is_flat(scene);
    }

    /// Whether rays come once at most out of leaves that they have to be inside of, and are
    /// not often inside of others.
    fn is_flat(&self, scene: &Scene) -> bool {
        let mut cuts = 0;
        for &Candidate { leaf, faces } in &self.candidates {
            let slots = slots_of(&scene.shapes[leaf as usize], faces);
            if scene.literals[leaf as usize].complement {
                cuts += slots;
            } else if slots != 1 {
                return false;
            }
        }
        cuts <= MOST_CUTS
    }

    /// The same where it is going to be added where rays are inside of meshes.
    pub(super) fn choose_with_meshes(
        &mut self,
        scene: &Scene,
        known: &mut Known<'_>,
        candidates: &[Candidate],
        along: DVec3,
    ) {
        self.choose(scene, known, candidates, along);
        self.meshes.clear();
        self.logic = self.logic(scene, known);
    }

    /// Adds where rays of a block are inside of a mesh, which `fill` knows, in some slots.
    pub(super) fn add_mesh(
        &mut self,
        scene: &Scene,
        leaf: u32,
        count: usize,
        fill: impl FnOnce(&mut [Slot]),
    ) {
        let number = self.candidates.iter().position(|c| c.leaf == leaf);
        let complement = scene.literals[leaf as usize].complement;
        let weight = self
            .logic
            .zip(number)
            .map_or(0, |(logic, number)| logic.weight(number, complement));
        let end = self.used + count;
        if self.slots.len() < end {
            self.slots.resize(end, Slot::EMPTY);
        }
        let slots = &mut self.slots[self.used..end];
        for slot in &mut *slots {
            (slot.leaf, slot.weight, slot.is_alone) = (leaf, weight, count == 1);
        }
        fill(slots);
        self.used = end;
    }

    /// The solid as a function of the leaves, if they are few, or all below one node.
    ///
    /// All nodes above leaves that matter are open. If there is but one above all leaves, the
    /// nodes above it have its value: what else is below them makes no difference, or they would
    /// be decided.
    fn logic(&self, scene: &Scene, known: &mut Known<'_>) -> Option<Logic> {
        let Scene { program, literals, .. } = scene;
        let literal = |c: &Candidate| literals[c.leaf as usize];
        let parent = literal(self.candidates.first()?).parent;
        if self.candidates.iter().all(|c| literal(c).parent == parent) {
            let holding =
                self.candidates.iter().filter(|c| literal(c).complement).count();
            let count = self.candidates.len();
            return Some(match program.combine(parent) {
                Combine::Any if count > 1 => Logic::Any { start: holding as u64 },
                Combine::All | Combine::Any => {
                    Logic::All { start: (count - holding) as u64 }
                }
            });
        }
        let few = self.candidates.len();
        if few > FEW {
            return None;
        }
        let mut inside = [false; FEW];
        let mut flip = |counts: &mut [u32], bit: usize| {
            let literal = literal(&self.candidates[bit]);
            inside[bit] = !inside[bit];
            program.toggle(counts, literal.parent, inside[bit] != literal.complement);
        };
        let counts = &mut known.counts;
        let table = Logic::table(few, |bit| {
            if bit < few {
                flip(counts, bit);
            }
            program.root(counts)
        });
        // The last number of a Gray code has one bit.
        flip(counts, few - 1);
        Some(table)
    }

    /// Finds where the rays of a block are inside the leaves. Rays that are not wanted may be
    /// left out.
    pub(super) fn meet(&mut self, scene: &Scene, block: &Block, wanted: u64) {
        self.used = 0;
        self.work.meetings +=
            self.candidates.len() as u64 * u64::from(wanted.count_ones());
        for (number, &Candidate { leaf, faces }) in self.candidates.iter().enumerate() {
            let shape = &scene.shapes[leaf as usize];
            let complement = scene.literals[leaf as usize].complement;
            let weight = self.logic.map_or(0, |logic| logic.weight(number, complement));
            while self.slots.len() < self.used + 2 {
                self.slots.push(Slot::EMPTY);
            }
            if let [first, second] = &mut self.slots[self.used..self.used + 2] {
                for slot in [&mut *first, &mut *second] {
                    (slot.leaf, slot.weight) = (leaf, weight);
                    slot.is_alone = slots_of(shape, faces) == 1;
                }
                block.stretches(self.arch, shape, faces, wanted, [first, second]);
            }
            self.used += slots_of(shape, faces);
        }
    }

    /// Where rays of a block come into the solid between two depths, if it is simple.
    pub(super) fn firsts(
        &mut self,
        block: &Block,
        wanted: u64,
        depth: [f64; 2],
    ) -> Option<&Firsts> {
        let slots = &self.slots[..self.used];
        let is_simple = matches!(self.logic, Some(Logic::All { .. })) && is_simple(slots);
        is_simple.then(|| {
            self.firsts.find(self.arch, block, slots, wanted, depth);
            &*self.firsts
        })
    }

    /// Where a ray comes into the solid, as [`Packet::firsts`] has just found.
    pub(super) fn entered(&self, block: &Block, ray: usize) -> Crossing {
        let (t, end) = (self.firsts.t[ray], face_of(self.firsts.end[ray]));
        let step = Step { t, end, tied: false, enters: true };
        crossing(&self.slots, &step, block, ray)
    }

    /// Finds the chords of rays of a block, which are between two places of each, if the
    /// solid is simple and they run the same way. Says for which rays that was not possible, or
    /// some thing may be no longer than the square root of `thin`.
    pub(super) fn find_chords(
        &mut self,
        scene: &Scene,
        block: &Block,
        wanted: u64,
        within: [f64; 2],
        thin: f64,
    ) -> u64 {
        if !self.is_flat || !block.is_parallel() {
            return wanted;
        }
        let Self { arch, lengths, candidates, .. } = self;
        lengths.start();
        for &Candidate { leaf, faces } in &*candidates {
            let shape = &scene.shapes[leaf as usize];
            if scene.literals[leaf as usize].complement {
                lengths.cut(*arch, block, shape, faces, wanted);
            } else {
                lengths.keep(*arch, block, shape, faces, wanted);
            }
        }
        lengths.find(*arch, block, wanted, within, thin)
    }

    /// The chords of a ray, as [`Packet::find_chords`] has just found.
    pub(super) fn chords(&self, ray: usize) -> Chords {
        self.lengths.chords(ray)
    }

    /// Along a ray, if the solid is a function of few leaves.
    pub(super) fn walk(&mut self, ray: usize) -> Option<Walk<'_>> {
        let slots = &self.slots[..self.used];
        self.logic.map(|logic| Walk::new(logic, slots, ray, &mut self.ends))
    }

    /// Has a tracer know the spans of a ray of a block, which are between two places of it, by
    /// walking along it; says whether that was possible.
    pub(super) fn spans_by_walk(
        &mut self,
        block: &Block,
        ray: usize,
        within: [f64; 2],
        tracer: &mut Tracer<'_>,
    ) -> bool {
        let Some(logic) = self.logic else {
            return false;
        };
        tracer.clear();
        let mut entered = None;
        for step in Walk::new(logic, &self.slots[..self.used], ray, &mut self.ends) {
            if step.tied {
                return false;
            }
            let crossing = crossing(&self.slots, &step, block, ray);
            if is_within(crossing.t, within) {
                tracer.change(&mut entered, crossing);
            }
        }
        true
    }

    /// What a step along a ray of a block is to the ray.
    pub(super) fn crossing(&self, step: &Step, block: &Block, ray: usize) -> Crossing {
        crossing(&self.slots, step, block, ray)
    }

    /// Adds all crossings of a ray with the leaves, in any order.
    pub(super) fn add_events(
        &self,
        scene: &Scene,
        line: &Line,
        ray: usize,
        events: &mut Vec<Event>,
    ) {
        for slot in &self.slots[..self.used] {
            let leaf = slot.leaf;
            let (t, face) = (slot.enter[ray], slot.enter_face[ray]);
            if t < slot.exit[ray] {
                let face = face_of(face);
                events.push(Event { t, leaf, face, sense: Sense::Enter });
                let (t, face) = (slot.exit[ray], face_of(slot.exit_face[ray]));
                events.push(Event { t, leaf, face, sense: Sense::Exit });
            }
        }
        for &leaf in &self.meshes {
            let sink = &mut Sink { events, leaf };
            scene.shapes[leaf as usize].crossings(ALL, line, sink);
        }
    }
}

fn crossing(slots: &[Slot], step: &Step, block: &Block, ray: usize) -> Crossing {
    let slot = &slots[step.end as usize / 2];
    let leaves = step.end % 2 == 1;
    let face = if leaves { slot.exit_face[ray] } else { slot.enter_face[ray] };
    Crossing {
        t: block.on_ray(ray, step.t),
        leaf: slot.leaf,
        face: face_of(face),
        sense: if step.enters { Sense::Enter } else { Sense::Exit },
    }
}
