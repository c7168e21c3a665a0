//! A block of rays and the few leaves that matter to it.

use pulp::Arch;

use super::block::{Block, Slot, slots_of};
use super::known::Known;
use super::survey::Candidate;
use super::walk::{Ends, FEW, NO_ENDS, Step, Table, Walk};
use crate::ray::{Crossing, Sense};
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
    table: Option<Table>,
    ends: Ends,
}

impl Packet {
    pub(super) fn new() -> Self {
        Self {
            arch: Arch::new(),
            candidates: Vec::new(),
            slots: Vec::new(),
            used: 0,
            meshes: Vec::new(),
            table: None,
            ends: NO_ENDS,
        }
    }

    /// Takes leaves to meet.
    pub(super) fn choose(&mut self, scene: &Scene, candidates: &[Candidate]) {
        self.candidates.clear();
        self.candidates.extend_from_slice(candidates);
        self.meshes.clear();
        for &Candidate { leaf, .. } in candidates {
            if let Shape::Polyhedron(_) = scene.shapes[leaf as usize] {
                self.meshes.push(leaf);
            }
        }
    }

    /// Finds where the rays of a block are inside the leaves. Rays that are not wanted may be
    /// left out.
    pub(super) fn meet(&mut self, scene: &Scene, block: &Block, wanted: u64) {
        self.used = 0;
        for (number, &Candidate { leaf, faces }) in (0..).zip(&self.candidates) {
            let shape = &scene.shapes[leaf as usize];
            while self.slots.len() < self.used + 2 {
                self.slots.push(Slot::EMPTY);
            }
            if let [first, second] = &mut self.slots[self.used..self.used + 2] {
                first.candidate = number;
                second.candidate = number;
                block.stretches(self.arch, shape, faces, wanted, [first, second]);
            }
            self.used += slots_of(shape, faces);
        }
    }

    /// Makes a table of the solid for all states of the leaves, if there are few and no meshes.
    pub(super) fn make_table(&mut self, scene: &Scene, known: &mut Known<'_>) {
        self.table = None;
        let few = self.candidates.len();
        if few > FEW || !self.meshes.is_empty() {
            return;
        }
        let Scene { program, literals, .. } = scene;
        let counts = &mut known.counts;
        let mut inside = [false; FEW];
        let mut flip = |counts: &mut [u32], bit: usize| {
            let literal = literals[self.candidates[bit].leaf as usize];
            inside[bit] = !inside[bit];
            program.toggle(counts, literal.parent, inside[bit] != literal.complement);
        };
        let table = Table::new(few, |bit| {
            if bit < few {
                flip(counts, bit);
            }
            program.root(counts)
        });
        // The last number of a Gray code has one bit.
        if few > 0 {
            flip(counts, few - 1);
        }
        self.table = Some(table);
    }

    /// Along a ray by the table, if there is one.
    pub(super) fn walk(&mut self, ray: usize) -> Option<Walk<'_>> {
        let slots = &self.slots[..self.used];
        self.table.map(|table| Walk::new(table, slots, ray, &mut self.ends))
    }

    /// Has a tracer know the spans of a ray of a block by the table; says whether that was
    /// possible.
    pub(super) fn spans_by_table(
        &mut self,
        block: &Block,
        ray: usize,
        tracer: &mut Tracer<'_>,
    ) -> bool {
        let Some(table) = self.table else {
            return false;
        };
        tracer.clear();
        let mut entered = None;
        for step in Walk::new(table, &self.slots[..self.used], ray, &mut self.ends) {
            if step.tied {
                return false;
            }
            let crossing = crossing(&self.slots, &self.candidates, &step, block, ray);
            tracer.change(&mut entered, crossing);
        }
        true
    }

    /// What a step along a ray of a block is to the ray.
    pub(super) fn crossing(&self, step: &Step, block: &Block, ray: usize) -> Crossing {
        crossing(&self.slots, &self.candidates, step, block, ray)
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
            let leaf = self.candidates[slot.candidate as usize].leaf;
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

fn crossing(
    slots: &[Slot],
    candidates: &[Candidate],
    step: &Step,
    block: &Block,
    ray: usize,
) -> Crossing {
    let slot = &slots[step.end as usize / 2];
    let leaves = step.end % 2 == 1;
    let face = if leaves { slot.exit_face[ray] } else { slot.enter_face[ray] };
    Crossing {
        t: block.on_ray(ray, step.t),
        leaf: candidates[slot.candidate as usize].leaf,
        face: face_of(face),
        sense: if step.enters { Sense::Enter } else { Sense::Exit },
    }
}
