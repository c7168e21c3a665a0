//! Cells of a tile in which there are meshes.

use super::block::{BLOCK, bits};
use super::mesh::{Asked, Facing, First, Points, Sighting};
use super::survey::{Candidate, List};
use super::tile::{Cell, Part, TileTracer};
use super::trial::Trials;
use crate::ray::{Crossing, Sense};
use crate::scene::Scene;
use crate::scene::trace::Change;
use crate::shape::{Event, Polyhedron, Shape, Sink};

/// What the rays of a block see of meshes.
#[derive(Debug)]
pub(super) struct Sightings {
    leaves: Vec<Candidate>,
    /// The faces of the meshes among the leaves that the block may meet.
    facing: Vec<Facing>,
    trials: Box<Trials>,
    events: Vec<Event>,
}

impl Default for Sightings {
    fn default() -> Self {
        Self {
            leaves: Vec::new(),
            facing: Vec::new(),
            trials: Box::new(Trials::EMPTY),
            events: Vec::new(),
        }
    }
}

impl TileTracer<'_> {
    /// Traces the rays of a block between two depths where there are meshes. Says which have to
    /// be walked along; nothing if there are none, or they cannot be looked at by blocks.
    pub(super) fn trace_meshes(&mut self, part: &Part<'_>, list: &List) -> Option<u64> {
        let (_, leaves) = self.survey.found(list);
        if !leaves.iter().any(|c| mesh_of(self.scene, c).is_some()) {
            return None;
        }
        self.sightings.leaves.clear();
        self.sightings.leaves.extend_from_slice(leaves);
        self.sightings.facing.resize_with(leaves.len(), Facing::default);
        let Part { tile, cell, .. } = part;
        let place = |ray| tile.place_of(cell.block, ray);
        let points = Points::new(self.open[cell.block], place);
        if let [candidate] = self.sightings.leaves[..]
            && let Some(mesh) = mesh_of(self.scene, &candidate)
        {
            let sighting = self.look_at_mesh(part, mesh, &points, 0)?;
            while self.sightings.facing[0].go_on(
                &sighting,
                &points,
                self.open[cell.block],
            ) {
                self.trace_mesh(part, candidate.leaf, mesh);
            }
            return Some(0);
        }
        for k in 0..self.sightings.leaves.len() {
            if let Some(mesh) = mesh_of(self.scene, &self.sightings.leaves[k]) {
                let sighting = self.look_at_mesh(part, mesh, &points, k)?;
                let (facing, open) =
                    (&mut self.sightings.facing[k], self.open[cell.block]);
                while facing.go_on(&sighting, &points, open) {}
            }
        }
        Some(self.meet_among_meshes(part, list))
    }

    /// Finds where the rays of a block are inside of leaves, meshes among them, whose faces have
    /// been shown. Traces those of which it is not sure, and says which are left.
    fn meet_among_meshes(&mut self, part: &Part<'_>, list: &List) -> u64 {
        let Part { tile, cell, .. } = part;
        let Self { scene, survey, packet, sightings, .. } = self;
        let (open, block) = (self.open[cell.block], &self.blocks[cell.block]);
        let (known, leaves) = survey.found(list);
        packet.choose_with_meshes(scene, known, leaves, tile.fan.dir.middle);
        packet.meet(scene, block, open);
        let Sightings { leaves, facing, trials, .. } = sightings;
        let mut all = 0;
        for (candidate, facing) in leaves.iter().zip(facing) {
            if let Some(mesh) = mesh_of(scene, candidate) {
                let asked = Asked { arch: packet.arch, mesh, block, open: open & !all };
                let (most, doubt) = facing.cross(&asked, trials);
                all |= doubt;
                // One slot at least says that no ray is inside.
                packet.add_mesh(scene, candidate.leaf, most.max(1), |slots| {
                    facing.fill(slots, asked.open & !doubt);
                });
            }
        }
        for ray in bits(all) {
            self.trace_among_meshes(part, ray);
        }
        open & !all
    }

    /// Looks up the faces of a mesh, the k-th leaf, that the rays of a block may cross up
    /// to the far end of a cell.
    fn look_at_mesh<'m>(
        &mut self,
        part: &Part<'_>,
        mesh: &'m Polyhedron,
        points: &Points,
        k: usize,
    ) -> Option<Sighting<'m>> {
        let Part { tile, sight, cell } = part;
        let sighting = Sighting::new(mesh, tile.fan, points, sight.reach)?;
        // From where the mesh begins, for it is outside of it that rays are known to be.
        let [near, far] = sighting.depth();
        let far = far.min(cell.depth[1]).max(near);
        let whole = Cell { depth: [near, far], ..*cell };
        let beam = whole.region(tile, sight).seen_from(&mesh.to_local);
        self.sightings.facing[k].look(&sighting, points, beam, far);
        Some(sighting)
    }

    /// Traces the rays of a block between two depths where there is one mesh and nothing else,
    /// as far as its faces have been shown.
    fn trace_mesh(&mut self, part: &Part<'_>, leaf: u32, mesh: &Polyhedron) {
        let cell = &part.cell;
        let complement = self.scene.literals[leaf as usize].complement;
        let sense_of =
            |is_in| if is_in == complement { Sense::Exit } else { Sense::Enter };
        let [low, high] = cell.depth;
        let open = self.open[cell.block];
        let Self { sightings, packet, blocks, hits, .. } = self;
        let Sightings { facing, trials, .. } = sightings;
        let asked = Asked { arch: packet.arch, mesh, block: &blocks[cell.block], open };
        let mut entered = 0;
        let doubt = facing[0].enter(&asked, trials, low, |ray, t, face| {
            if t < high {
                let hit = Crossing { t, leaf, face, sense: sense_of(true) };
                hits[cell.block * BLOCK + ray] = Some(hit);
                entered |= 1 << ray;
            }
        });
        self.open[cell.block] &= !entered;
        for ray in bits(doubt) {
            let line = self.blocks[cell.block].line(ray);
            let Sightings { facing, events, .. } = &mut self.sightings;
            let hit = match facing[0].first(mesh, leaf, ray, &line, cell.depth, events) {
                First::Nothing => continue,
                First::Crossed(Event { leaf, face, .. }, t, is_in) => {
                    Some(Crossing { t, leaf, face, sense: sense_of(is_in) })
                }
                First::Unsure => self.alone.first_hit(&part.tile.ray_of(cell.block, ray)),
            };
            self.hits[cell.block * BLOCK + ray] = hit;
            self.open[cell.block] &= !(1 << ray);
        }
    }

    /// Traces one ray between two depths by all crossings with the faces that have been shown
    /// and with the other leaves.
    fn trace_among_meshes(&mut self, part: &Part<'_>, ray: usize) {
        let cell = &part.cell;
        let line = self.blocks[cell.block].line(ray);
        let Self { scene, many, survey, sightings, .. } = self;
        let leaves = sightings.leaves.iter().zip(&sightings.facing);
        let fill = |events: &mut Vec<Event>| {
            for (&Candidate { leaf, faces }, facing) in leaves {
                let shape = &scene.shapes[leaf as usize];
                if let Shape::Polyhedron(mesh) = shape {
                    facing.crossings(mesh, leaf, ray, &line, events);
                } else {
                    shape.crossings(faces, &line, &mut Sink { events, leaf });
                }
            }
        };
        let counts = &mut survey.known.counts;
        let hit = match many.first_change(counts, &line, fill, cell.depth) {
            Change::None => return,
            Change::First(crossing) => Some(crossing),
            Change::Collapsed => self.alone.first_hit(&part.tile.ray_of(cell.block, ray)),
        };
        self.hits[cell.block * BLOCK + ray] = hit;
        self.open[cell.block] &= !(1 << ray);
    }
}

fn mesh_of<'a>(scene: &'a Scene, candidate: &Candidate) -> Option<&'a Polyhedron> {
    match &scene.shapes[candidate.leaf as usize] {
        Shape::Polyhedron(mesh) => Some(mesh),
        Shape::Cuboid(_) | Shape::HalfSpace(_) | Shape::Quadric(_) => None,
    }
}
