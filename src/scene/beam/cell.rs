//! A tile of rays, divided into cells.

use std::ops::Range;

use glam::DVec3;
use pulp::Arch;

use super::known::{Known, Place};
use super::packet::{BLOCK, Block, Slot, slots_of};
use super::walk::{Candidate, Ends, FEW, NO_ENDS, Outcome, Table, first};
use crate::fan::Fan;
use crate::ray::{Crossing, Ray, Sense};
use crate::scene::trace::Change;
use crate::scene::{Scene, Tracer};
use crate::shape::{ALL, Region, Side, face_of};

/// The side of a tile, in rays.
pub(crate) const SIDE: usize = 32;

/// The side of a block.
const BLOCK_SIDE: usize = 8;

/// How many blocks a tile has.
const BLOCKS: usize = (SIDE / BLOCK_SIDE) * (SIDE / BLOCK_SIDE);

/// No more leaves than this, and a cell is not divided in depth.
const ENOUGH: usize = 3;

/// A cell is divided in depth if it is longer than it is wide by this much.
const LONG: f64 = 2.0;

/// Rays of a fan in rows and columns.
#[derive(Clone, Copy)]
pub(crate) struct Tile<'a> {
    pub(crate) fan: &'a Fan,
    /// How many columns and rows, at most [`SIDE`] each.
    pub(crate) size: [usize; 2],
    /// Where in the fan the ray in a column and a row is: farther to one side the larger the
    /// column, and the row.
    pub(crate) at: &'a dyn Fn(usize, usize) -> [f64; 2],
}

/// Scratch memory for tiles of rays through a scene; one for each thread.
#[derive(Debug)]
pub(crate) struct TileTracer<'a> {
    scene: &'a Scene,
    arch: Arch,
    known: Known<'a>,
    /// For rays of which a tile is not sure.
    alone: Tracer<'a>,
    /// For blocks with many leaves or with stretches that end together.
    many: Tracer<'a>,
    blocks: Vec<Block>,
    /// Which rays of each block are to be traced still.
    open: [u64; BLOCKS],
    /// Which blocks have lines.
    has_lines: u32,
    hits: Vec<Option<Crossing>>,
    /// The leaves that matter in the cells that are being looked at, one list on the other.
    candidates: Vec<Candidate>,
    /// What became of the leaves of a list, one for each.
    sides: Vec<Side>,
    /// With which of the candidates each slot belongs together.
    slots: Vec<(Slot, u32)>,
    ends: Ends,
}

/// How rays of a tile lie in space.
#[derive(Clone, Copy)]
struct Sight<'a> {
    tile: &'a Tile<'a>,
    /// Between which `t ≥ 0` of the rays the solid is.
    depth: [f64; 2],
    /// No coordinate is larger.
    reach: f64,
}

/// Some blocks of a tile between two depths.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// The first block, and how many blocks each way.
    block: usize,
    side: usize,
    depth: [f64; 2],
}

impl<'a> TileTracer<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            arch: Arch::new(),
            known: Known::new(scene),
            alone: scene.tracer(),
            many: scene.tracer(),
            blocks: vec![Block::EMPTY; BLOCKS],
            open: [0; BLOCKS],
            has_lines: 0,
            hits: vec![None; BLOCKS * BLOCK],
            candidates: Vec::new(),
            sides: Vec::new(),
            slots: Vec::new(),
            ends: NO_ENDS,
        }
    }

    /// What [`Tracer::first_hit`] says of each ray of a tile, by column and row.
    pub(crate) fn first_hits(
        &mut self,
        tile: &Tile<'_>,
        mut found: impl FnMut(usize, usize, Option<Crossing>),
    ) {
        self.hits.fill(None);
        self.has_lines = 0;
        self.open = [0; BLOCKS];
        for j in 0..tile.size[1] {
            for i in 0..tile.size[0] {
                let place = place(i, j);
                self.open[place / BLOCK] |= 1 << (place % BLOCK);
            }
        }
        if self.scene.bounds.is_bounded() {
            self.survey(&Sight::new(tile, self.scene));
        }
        for j in 0..tile.size[1] {
            for i in 0..tile.size[0] {
                found(i, j, self.hits[place(i, j)]);
            }
        }
    }

    /// Makes lines of the rays of a block when they are first needed.
    fn make_lines(&mut self, sight: &Sight<'_>, block: usize) {
        if self.has_lines & 1 << block == 0 {
            self.has_lines |= 1 << block;
            let wanted = self.open[block];
            for ray in (0..BLOCK).filter(|ray| wanted >> ray & 1 == 1) {
                self.blocks[block].set_ray(ray, &sight.ray(block, ray));
            }
            let valid = self.blocks[block].make_lines(self.arch, &self.scene.bounds);
            self.open[block] &= valid;
        }
    }

    /// Finds the leaves that the tile may meet, and divides it.
    fn survey(&mut self, sight: &Sight<'_>) {
        let [near, far] = sight.depth;
        let whole = Cell { block: 0, side: SIDE / BLOCK_SIDE, depth: sight.depth };
        if near >= far || self.is_done(&whole) {
            return;
        }
        let region = sight.region(&whole);
        let Self { scene, candidates, .. } = self;
        candidates.clear();
        scene.hierarchy.meeting(
            |bounds| region.meets(bounds),
            |leaf| candidates.push(Candidate { leaf, faces: ALL }),
        );
        let list = 0..candidates.len();
        self.divide(sight, &whole, list, Place::Out);
    }

    /// Looks at a cell, of which all leaves that matter are in a list and are one thing to the
    /// cell around it.
    fn divide(
        &mut self,
        sight: &Sight<'_>,
        cell: &Cell,
        list: Range<usize>,
        before: Place,
    ) {
        let region = sight.region(cell);
        let sides = self.sides.len();
        for i in list.clone() {
            let Candidate { leaf, faces } = self.candidates[i];
            let leaf_bounds = &self.scene.clipped[leaf as usize];
            let slack = self.scene.slacks[leaf as usize];
            let shape = &self.scene.shapes[leaf as usize];
            let side = match region.side(shape, leaf_bounds, slack) {
                Side::Crossing(open) if open & faces == 0 => Side::In,
                Side::Crossing(open) => Side::Crossing(open & faces),
                side @ (Side::In | Side::Out) => side,
            };
            self.known.learn(leaf, before, side.into());
            self.sides.push(side);
        }
        if self.known.root().is_none() {
            let first = self.candidates.len();
            self.known.next_region();
            for (i, k) in list.clone().zip(sides..) {
                let leaf = self.candidates[i].leaf;
                if let Side::Crossing(faces) = self.sides[k]
                    && self.known.matters(leaf)
                {
                    self.candidates.push(Candidate { leaf, faces });
                }
            }
            let list = first..self.candidates.len();
            self.look_into(sight, cell, &region, list);
            self.candidates.truncate(first);
        }
        for (i, k) in list.zip(sides..) {
            self.known.learn(self.candidates[i].leaf, self.sides[k].into(), before);
        }
        self.sides.truncate(sides);
    }

    /// Divides a cell of which something is open, or traces its rays.
    fn look_into(
        &mut self,
        sight: &Sight<'_>,
        cell: &Cell,
        region: &Region,
        list: Range<usize>,
    ) {
        let [long, wide] = region.lengths();
        let Cell { block, side, depth: [near, far] } = *cell;
        let middle = 0.5 * (near + far);
        if list.len() > ENOUGH && long > LONG * wide && near < middle && middle < far {
            for depth in [[near, middle], [middle, far]] {
                if !self.is_done(cell) {
                    let part = Cell { depth, ..*cell };
                    self.divide(sight, &part, list.clone(), Place::Open);
                }
            }
        } else if side > 1 {
            let side = side / 2;
            for part in 0..4 {
                let part = Cell { block: block + part * side * side, side, ..*cell };
                if !self.is_done(&part) {
                    self.divide(sight, &part, list.clone(), Place::Open);
                }
            }
        } else {
            self.trace(sight, cell, list);
        }
    }

    fn is_done(&self, cell: &Cell) -> bool {
        self.open[cell.block..cell.block + cell.side * cell.side].iter().all(|&b| b == 0)
    }

    /// Traces the rays of a block between two depths.
    fn trace(&mut self, sight: &Sight<'_>, cell: &Cell, list: Range<usize>) {
        self.make_lines(sight, cell.block);
        let slots = if list.len() <= FEW { self.fill_slots(cell.block, &list) } else { None };
        let table = slots.map(|slots| (self.table(&list), slots));
        let mut open = self.open[cell.block];
        while open != 0 {
            let ray = open.trailing_zeros() as usize;
            open &= open - 1;
            let block = &self.blocks[cell.block];
            let outcome = table.map_or(Outcome::Tied, |(table, slots)| {
                let slots = &self.slots[..slots];
                let on_ray = |t| block.on_ray(ray, t);
                first(table, slots, ray, cell.depth, on_ray, &mut self.ends)
            });
            let hit = match outcome {
                Outcome::Nothing => continue,
                Outcome::Crossed { t, end, after } => {
                    let (slot, candidate) = &self.slots[end as usize / 2];
                    let leaves = end % 2 == 1;
                    let face = if leaves { slot.exit_face } else { slot.enter_face }[ray];
                    Some(Crossing {
                        t: block.on_ray(ray, t),
                        leaf: self.candidates[list.start + *candidate as usize].leaf,
                        face: face_of(face),
                        sense: if after { Sense::Enter } else { Sense::Exit },
                    })
                }
                Outcome::Tied => match self.among_many(cell, &list, ray) {
                    Change::None => continue,
                    Change::First(crossing) => Some(crossing),
                    Change::Collapsed => {
                        self.alone.first_hit(&sight.ray(cell.block, ray))
                    }
                },
                Outcome::Collapsed => self.alone.first_hit(&sight.ray(cell.block, ray)),
            };
            self.hits[cell.block * BLOCK + ray] = hit;
            self.open[cell.block] &= !(1 << ray);
        }
    }

    /// Where the rays of a block are inside leaves, and in how many slots that is; nothing if
    /// slots cannot tell.
    fn fill_slots(&mut self, block: usize, list: &Range<usize>) -> Option<usize> {
        let mut filled = 0;
        for (number, i) in (0..).zip(list.clone()) {
            let Candidate { leaf, faces } = self.candidates[i];
            let shape = &self.scene.shapes[leaf as usize];
            let needed = slots_of(shape, faces);
            if needed == 0 {
                return None;
            }
            while self.slots.len() < filled + 2 {
                self.slots.push((Slot::EMPTY, 0));
            }
            let [first, second] = &mut self.slots[filled..filled + 2] else {
                return None;
            };
            first.1 = number;
            second.1 = number;
            let slots = [&mut first.0, &mut second.0];
            self.blocks[block].stretches(
                self.arch,
                shape,
                faces,
                self.open[block],
                slots,
            );
            filled += needed;
        }
        Some(filled)
    }

    fn table(&mut self, list: &Range<usize>) -> Table {
        let Self { scene, known, candidates, .. } = self;
        let Scene { program, literals, .. } = scene;
        let counts = &mut known.counts;
        let mut inside = [false; FEW];
        let mut flip = |counts: &mut [u32], bit: usize| {
            let literal = literals[candidates[list.start + bit].leaf as usize];
            inside[bit] = !inside[bit];
            program.toggle(counts, literal.parent, inside[bit] != literal.complement);
        };
        let table = Table::new(list.len(), |bit| {
            if bit < list.len() {
                flip(counts, bit);
            }
            program.root(counts)
        });
        // The last number of a Gray code has one bit.
        if !list.is_empty() {
            flip(counts, list.len() - 1);
        }
        table
    }

    /// The first change of the solid in a cell, from a sorted list of everything there.
    fn among_many(&mut self, cell: &Cell, list: &Range<usize>, ray: usize) -> Change {
        let line = self.blocks[cell.block].line(ray);
        let leaves = self.candidates[list.clone()].iter().map(|c| (c.leaf, c.faces));
        self.many.first_change(&mut self.known.counts, &line, leaves, cell.depth)
    }
}

impl Tile<'_> {
    /// The ray in a column and a row.
    fn ray(&self, i: usize, j: usize) -> Ray {
        let [right, up] = (self.at)(i, j);
        self.fan.ray(right, up)
    }

    /// The places of the first and the last ray.
    fn corners(&self) -> [[f64; 2]; 2] {
        let [width, height] = self.size;
        [(self.at)(0, 0), (self.at)(width.max(1) - 1, height.max(1) - 1)]
    }
}

impl<'a> Sight<'a> {
    fn new(tile: &'a Tile<'a>, scene: &Scene) -> Self {
        let fan = tile.fan;
        let steps = if fan.is_parallel() { &fan.origin } else { &fan.dir };
        let across = steps.right.cross(steps.up);
        let axis = across / across.dot(fan.dir.middle);
        let bounds = &scene.bounds;
        let depths =
            bounds.corners().map(|corner| (corner - fan.origin.middle).dot(axis));
        let near = depths.into_iter().fold(f64::INFINITY, f64::min);
        let far = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
        // Crossings are a little beside the bounds where rounding has put them there.
        let room = 1e-6 * (far - near) + 16.0 * scene.worst_slack * axis.length();
        let depth = [(near - room).max(0.0), far + room];
        let all = scene.hierarchy.bounds();
        let largest = |v: DVec3| v.abs().max_element();
        let widest = tile.corners().map(|[right, up]| {
            fan.origin.largest(right, up) + depth[1].abs() * fan.dir.largest(right, up)
        });
        let reach = largest(all.min).max(largest(all.max))
            + widest.into_iter().fold(0.0, f64::max);
        Self { tile, depth, reach }
    }

    /// The rays of a cell between its depths, and some more.
    fn region(&self, cell: &Cell) -> Region {
        let Fan { origin, dir } = self.tile.fan;
        let [i, j] = block_place(cell.block);
        let last = |first: usize, size: usize| {
            (first + cell.side * BLOCK_SIDE).min(size).max(first + 1) - 1
        };
        let [width, height] = self.tile.size;
        let a = (self.tile.at)(i, j);
        let b = (self.tile.at)(last(i, width), last(j, height));
        let [near, far] = cell.depth;
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let [depth, half] = [0.5 * (near + far), 0.5 * (far - near)];
        let forward = dir.at(middle[0], middle[1]);
        let center = origin.at(middle[0], middle[1]) + depth * forward;
        let side = |steps: f64, o: DVec3, d: DVec3| {
            let [p, q] = [near, far].map(|t| 0.5 * steps * (o + t * d));
            if p.length_squared() > q.length_squared() { p } else { q }
        };
        let sides = [
            side(b[0] - a[0], origin.right, dir.right),
            side(b[1] - a[1], origin.up, dir.up),
        ];
        Region::new(center, half * forward, sides, self.reach)
    }

    /// A ray of a block.
    fn ray(&self, block: usize, ray: usize) -> Ray {
        let [i, j] = block_place(block);
        self.tile.ray(i + ray % BLOCK_SIDE, j + ray / BLOCK_SIDE)
    }
}

/// The number of a ray in its tile. Blocks are numbered so that those of a quarter follow
/// one another (G. M. Morton's order, 1966).
fn place(i: usize, j: usize) -> usize {
    let [x, y] = [i / BLOCK_SIDE, j / BLOCK_SIDE];
    let block = (x & 1) | (y & 1) << 1 | (x & 2) << 1 | (y & 2) << 2;
    block * BLOCK + j % BLOCK_SIDE * BLOCK_SIDE + i % BLOCK_SIDE
}

/// The first ray of a block.
fn block_place(block: usize) -> [usize; 2] {
    let x = (block & 1) | (block >> 1 & 2);
    let y = (block >> 1 & 1) | (block >> 2 & 2);
    [x * BLOCK_SIDE, y * BLOCK_SIDE]
}
