//! Cells of a tile in which there are meshes.

use super::block::{BLOCK, bits};
use super::mesh::{Asked, Facing, First};
use super::sighting::Grid;
use super::survey::{Candidate, List};
use super::tile::{Part, TileTracer};
use super::trial::Trials;
use crate::ray::{Crossing, Sense};
use crate::scene::Scene;
use crate::scene::trace::Change;
use crate::shape::{Event, Polyhedron, Shape, Sink};

/// What the rays of a tile see of meshes.
#[derive(Debug)]
pub(super) struct Sightings {
    grid: Option<Grid>,
    /// Leaves that are meshes, and their faces that the tile may meet: those of this tile, and
    /// others whose memory can be used again.
    facing: Vec<(u32, Facing)>,
    used: usize,
    /// The leaves of the cell that is being looked at, and which of those each is.
    leaves: Vec<(Candidate, Option<usize>)>,
    trials: Box<Trials>,
    events: Vec<Event>,
}

impl Sightings {
    pub(super) fn new() -> Self {
        Self {
            grid: None,
            facing: Vec::new(),
            used: 0,
            leaves: Vec::new(),
            trials: Box::new(Trials::EMPTY),
            events: Vec::new(),
        }
    }

    /// Before another tile.
    pub(super) fn clear(&mut self) {
        self.grid = None;
        self.used = 0;
    }

    /// Which of the meshes that the tile sees a leaf is; nothing if that are too many already.
    fn number_of(
        &mut self,
        part: &Part<'_>,
        leaf: u32,
        mesh: &Polyhedron,
    ) -> Option<usize> {
        /// Where there are more, each is met by a few rays, which do better alone.
        const MOST: usize = 64;
        let Self { grid, facing, used, .. } = self;
        if let Some(k) = facing[..*used].iter().position(|&(other, _)| other == leaf) {
            return Some(k);
        }
        if *used == MOST {
            return None;
        }
        let grid = grid.get_or_insert_with(|| Grid::new(part.tile));
        if *used == facing.len() {
            facing.push((leaf, Facing::default()));
        }
        let (other, facing) = &mut facing[*used];
        *other = leaf;
        facing.see(mesh, part.tile, part.sight, grid);
        *used += 1;
        Some(*used - 1)
    }
}

impl TileTracer<'_> {
    /// Traces the rays of a block between two depths where there are meshes. Says which have to
    /// be walked along; nothing if there are none, or they cannot be looked at by tiles.
    pub(super) fn trace_meshes(&mut self, part: &Part<'_>, list: &List) -> Option<u64> {
        let Self { scene, survey, sightings, .. } = self;
        let (_, leaves) = survey.found(list);
        if !leaves.iter().any(|c| mesh_of(scene, c).is_some()) {
            return None;
        }
        sightings.leaves.clear();
        for &candidate in leaves {
            let number = match mesh_of(scene, &candidate) {
                Some(mesh) => {
                    let k = sightings.number_of(part, candidate.leaf, mesh)?;
                    Some(k).filter(|&k| sightings.facing[k].1.is_seen())?;
                    Some(k)
                }
                None => None,
            };
            sightings.leaves.push((candidate, number));
        }
        if let [(candidate, Some(k))] = self.sightings.leaves[..]
            && let Some(mesh) = mesh_of(self.scene, &candidate)
        {
            self.trace_mesh(part, candidate.leaf, mesh, k);
            return Some(0);
        }
        let Self { scene, sightings, .. } = self;
        for &(candidate, number) in &sightings.leaves {
            if let Some(k) = number
                && let Some(mesh) = mesh_of(scene, &candidate)
                && let Some(grid) = &sightings.grid
            {
                let facing = &mut sightings.facing[k].1;
                while facing.horizon() < part.cell.depth[1]
                    && facing.go_on(mesh, part, grid, &self.open)
                {}
            }
        }
        self.make_lines(part.tile, part.cell.block);
        Some(self.meet_among_meshes(part, list))
    }

    /// Traces the rays of a block between two depths where there is one mesh, the k-th, and
    /// nothing else.
    fn trace_mesh(&mut self, part: &Part<'_>, leaf: u32, mesh: &Polyhedron, k: usize) {
        let Part { tile, cell, .. } = part;
        loop {
            let facing = &self.sightings.facing[k].1;
            if facing.rays(cell.block * BLOCK, self.open[cell.block]) != 0 {
                self.make_lines(tile, cell.block);
                self.trace_shown(part, leaf, mesh, k);
            }
            let Sightings { facing, grid, .. } = &mut self.sightings;
            let facing = &mut facing[k].1;
            let is_done = self.open[cell.block] == 0 || facing.horizon() >= cell.depth[1];
            let Some(grid) = grid.as_ref().filter(|_| !is_done) else { break };
            if !facing.go_on(mesh, part, grid, &self.open) {
                break;
            }
        }
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
        let (mut all, first) = (0, cell.block * BLOCK);
        for (candidate, number) in leaves {
            if let Some(k) = *number
                && let Some(mesh) = mesh_of(scene, candidate)
            {
                let (arch, facing) = (packet.arch, &mut facing[k].1);
                let asked = Asked { arch, mesh, block, first, open: open & !all };
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

    /// Traces those of its rays that may meet faces that have been shown.
    fn trace_shown(&mut self, part: &Part<'_>, leaf: u32, mesh: &Polyhedron, k: usize) {
        let cell = &part.cell;
        let complement = self.scene.literals[leaf as usize].complement;
        let sense_of =
            |is_in| if is_in == complement { Sense::Exit } else { Sense::Enter };
        let [low, high] = cell.depth;
        let open = self.open[cell.block];
        let Self { sightings, packet, blocks, hits, .. } = self;
        let Sightings { facing, trials, .. } = sightings;
        let (first, block) = (cell.block * BLOCK, &blocks[cell.block]);
        let asked = Asked { arch: packet.arch, mesh, block, first, open };
        let mut entered = 0;
        let doubt = facing[k].1.enter(&asked, trials, low, |ray, t, face| {
            if t < high {
                let hit = Crossing { t, leaf, face, sense: sense_of(true) };
                hits[first + ray] = Some(hit);
                entered |= 1 << ray;
            }
        });
        self.open[cell.block] &= !entered;
        for ray in bits(doubt) {
            let line = self.blocks[cell.block].line(ray);
            let Sightings { facing, events, .. } = &mut self.sightings;
            let facing = &facing[k].1;
            let (in_tile, depth) = (first + ray, cell.depth);
            let hit = match facing.first(mesh, leaf, in_tile, &line, depth, events) {
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
        let Sightings { leaves, facing, .. } = sightings;
        let in_tile = cell.block * BLOCK + ray;
        let fill = |events: &mut Vec<Event>| {
            for &(Candidate { leaf, faces }, number) in &*leaves {
                let shape = &scene.shapes[leaf as usize];
                if let (Shape::Polyhedron(mesh), Some(k)) = (shape, number) {
                    facing[k].1.crossings(mesh, leaf, in_tile, &line, events);
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
    scene.shapes[candidate.leaf as usize].polyhedron()
}
