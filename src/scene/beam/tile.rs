//! A tile of rays, divided into cells.

use pulp::Arch;

use super::block::{BLOCK, Block};
use super::flat::Firsts;
use super::meshes::Sightings;
use super::packet::Packet;
use super::sight::Sight;
use super::survey::{List, Survey};
use super::walk::{Outcome, first};
#[cfg(test)]
use super::work::Work;
use crate::fan::Fan;
use crate::ray::{Crossing, Ray};
use crate::scene::trace::Change;
use crate::scene::{Scene, Tracer};
use crate::shape::Region;

/// The side of a tile, in rays.
pub(crate) const SIDE: u32 = 32;

/// The side of a block.
const BLOCK_SIDE: usize = 8;

/// How many blocks are side by side in a tile.
const BLOCKS_WIDE: usize = SIDE as usize / BLOCK_SIDE;

/// How many blocks a tile has.
pub(super) const BLOCKS: usize = BLOCKS_WIDE * BLOCKS_WIDE;

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
    /// column, and the row. How far to the right does not depend on the row, nor how far up on the
    /// column.
    pub(crate) at: &'a dyn Fn(usize, usize) -> [f64; 2],
}

/// Scratch memory for tiles of rays through a scene; one for each thread.
#[derive(Debug)]
pub(crate) struct TileTracer<'a> {
    pub(super) scene: &'a Scene,
    pub(super) survey: Survey<'a>,
    pub(super) blocks: Vec<Block>,
    /// Which rays of each block are to be traced still.
    pub(super) open: [u64; BLOCKS],
    /// Which blocks have lines.
    has_lines: u32,
    pub(super) hits: Vec<Option<Crossing>>,
    pub(super) packet: Packet,
    pub(super) sightings: Sightings,
    /// For blocks with many leaves or with stretches that end together.
    pub(super) many: Tracer<'a>,
    /// For rays of which a tile is not sure.
    pub(super) alone: Tracer<'a>,
}

/// Some blocks of a tile between two depths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// The first block, and how many blocks each way.
    pub(super) block: usize,
    pub(super) side: usize,
    pub(super) depth: [f64; 2],
}

impl Cell {
    /// All blocks of a tile, at no depth.
    pub(super) const WHOLE: Self = Self { block: 0, side: BLOCKS_WIDE, depth: [0.0; 2] };
}

impl<'a> TileTracer<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Self {
        Self::on(Arch::new(), scene)
    }

    /// On a machine with some vectors.
    pub(super) fn on(arch: Arch, scene: &'a Scene) -> Self {
        Self {
            scene,
            survey: Survey::new(scene),
            blocks: vec![Block::EMPTY; BLOCKS],
            open: [0; BLOCKS],
            has_lines: 0,
            hits: vec![None; BLOCKS * BLOCK],
            packet: Packet::new(arch),
            sightings: Sightings::new(),
            many: scene.tracer(),
            alone: scene.tracer(),
        }
    }

    /// What has been done so far.
    #[cfg(test)]
    pub(super) fn work(&self) -> Work {
        let mut work = self.survey.work;
        work += self.packet.work;
        work
    }

    /// What [`Tracer::first_hit`] says of each ray of a tile, by column and row.
    pub(crate) fn first_hits(
        &mut self,
        tile: &Tile<'_>,
        mut found: impl FnMut(usize, usize, Option<Crossing>),
    ) {
        self.hits.fill(None);
        self.sightings.clear();
        self.has_lines = 0;
        self.open = [0; BLOCKS];
        for j in 0..tile.size[1] {
            for i in 0..tile.size[0] {
                let place = place(i, j);
                self.open[place / BLOCK] |= 1 << (place % BLOCK);
            }
        }
        if self.scene.stage.is_bounded {
            self.look_at(tile);
        }
        for j in 0..tile.size[1] {
            for i in 0..tile.size[0] {
                found(i, j, self.hits[place(i, j)]);
            }
        }
    }

    /// Makes lines of the rays of a block when they are first needed.
    pub(super) fn make_lines(&mut self, tile: &Tile<'_>, block: usize) {
        if self.has_lines & 1 << block == 0 {
            self.has_lines |= 1 << block;
            let wanted = self.open[block];
            for ray in (0..BLOCK).filter(|ray| wanted >> ray & 1 == 1) {
                self.blocks[block].set_place(ray, tile.place_of(block, ray));
            }
            let (arch, stage) = (self.packet.arch, &self.scene.stage);
            let valid = self.blocks[block].make_lines(arch, tile.fan, BLOCK, stage);
            self.open[block] &= valid;
        }
    }

    /// Finds the leaves that the tile may meet, and divides it.
    fn look_at(&mut self, tile: &Tile<'_>) {
        let sight =
            Sight::new(tile.fan, tile.corners(0, BLOCKS_WIDE * BLOCK_SIDE), self.scene);
        let [near, far] = sight.depth;
        let whole = Cell { depth: [near.max(0.0), far], ..Cell::WHOLE };
        if whole.depth[0] >= far || self.is_done(&whole) {
            return;
        }
        let around = whole.region(tile, &sight);
        let all = self.survey.all(&around);
        self.divide(&Part { tile, sight: &sight, cell: whole }, &all);
    }

    /// Looks at a cell; all leaves that matter are in a list.
    fn divide(&mut self, part: &Part<'_>, list: &List) {
        let region = part.cell.region(part.tile, part.sight);
        if let Some(inner) = self.survey.enter(&region, list) {
            self.look_into(part, &region, &inner);
        }
        self.survey.leave(list);
    }

    /// Divides a cell in which something is open, or traces its rays.
    fn look_into(&mut self, part: &Part<'_>, region: &Region, list: &List) {
        let [long, wide] = region.lengths();
        let Cell { block, side, depth: [near, far] } = part.cell;
        let middle = 0.5 * (near + far);
        if list.len() > ENOUGH && long > LONG * wide && near < middle && middle < far {
            for depth in [[near, middle], [middle, far]] {
                if !self.is_done(&part.cell) {
                    let cell = Cell { depth, ..part.cell };
                    self.divide(&Part { cell, ..*part }, list);
                }
            }
        } else if side > 1 {
            let side = side / 2;
            for quarter in 0..4 {
                let block = block + quarter * side * side;
                let cell = Cell { block, side, ..part.cell };
                if !self.is_done(&cell) {
                    self.divide(&Part { cell, ..*part }, list);
                }
            }
        } else {
            self.trace(part, list);
        }
    }

    fn is_done(&self, cell: &Cell) -> bool {
        self.open[cell.block..cell.block + cell.side * cell.side].iter().all(|&b| b == 0)
    }

    /// Traces the rays of a block between two depths.
    fn trace(&mut self, part: &Part<'_>, list: &List) {
        let Part { tile, cell, .. } = part;
        let open = self.trace_meshes(part, list).unwrap_or_else(|| {
            self.make_lines(tile, cell.block);
            let (open, block) = (self.open[cell.block], &self.blocks[cell.block]);
            let (known, leaves) = self.survey.found(list);
            self.packet.choose(self.scene, known, leaves, tile.fan.dir.middle);
            self.packet.meet(self.scene, block, open);
            open
        });
        let mut open = self.enter_at_once(cell, open);
        self.packet.work.walks += u64::from(open.count_ones());
        while open != 0 {
            let ray = open.trailing_zeros() as usize;
            open &= open - 1;
            let block = &self.blocks[cell.block];
            let outcome = match self.packet.walk(ray) {
                Some(walk) => first(walk, cell.depth, |t| block.on_ray(ray, t)),
                None => Outcome::Tied,
            };
            let hit = match outcome {
                Outcome::Nothing => continue,
                Outcome::Crossed(step) => Some(self.packet.crossing(&step, block, ray)),
                Outcome::Tied => {
                    let (line, counts) = (block.line(ray), &mut self.survey.known.counts);
                    let Self { scene, packet, many, .. } = self;
                    let fill =
                        |events: &mut _| packet.add_events(scene, &line, ray, events);
                    match many.first_change(counts, &line, fill, cell.depth) {
                        Change::None => continue,
                        Change::First(crossing) => Some(crossing),
                        Change::Collapsed => {
                            self.packet.work.searches += 1;
                            self.alone.first_hit(&tile.ray_of(cell.block, ray))
                        }
                    }
                }
                Outcome::Collapsed => {
                    self.packet.work.searches += 1;
                    self.alone.first_hit(&tile.ray_of(cell.block, ray))
                }
            };
            self.hits[cell.block * BLOCK + ray] = hit;
            self.open[cell.block] &= !(1 << ray);
        }
    }
}

impl TileTracer<'_> {
    /// Finds where rays of a block come into the solid, if it is simple; says which rays have to
    /// be walked along.
    fn enter_at_once(&mut self, cell: &Cell, wanted: u64) -> u64 {
        let block = &self.blocks[cell.block];
        let Some(firsts) = self.packet.firsts(block, wanted, cell.depth) else {
            return wanted;
        };
        let (mut doubt, mut entered) = (0, 0);
        for (ray, &answer) in firsts.answer.iter().enumerate() {
            doubt |= u64::from(answer >= Firsts::DOUBT) << ray;
            entered |= u64::from(answer >= Firsts::ENTERED) << ray;
        }
        let mut open = wanted & entered & !doubt;
        self.open[cell.block] &= !open;
        while open != 0 {
            let ray = open.trailing_zeros() as usize;
            open &= open - 1;
            let hit = self.packet.entered(block, ray);
            self.hits[cell.block * BLOCK + ray] = Some(hit);
        }
        wanted & doubt
    }
}

impl Tile<'_> {
    /// A ray of a block.
    pub(super) fn ray_of(&self, block: usize, ray: usize) -> Ray {
        let [right, up] = self.place_of(block, ray);
        self.fan.ray(right, up)
    }

    /// Where in the fan a ray of a block is.
    pub(super) fn place_of(&self, block: usize, ray: usize) -> [f64; 2] {
        let [i, j] = block_place(block);
        (self.at)(i + ray % BLOCK_SIDE, j + ray / BLOCK_SIDE)
    }

    /// The places of the first and the last of some rays, counted from a block.
    fn corners(&self, block: usize, side: usize) -> [[f64; 2]; 2] {
        let [i, j] = block_place(block);
        let last =
            |first: usize, size: usize| (first + side).min(size).max(first + 1) - 1;
        let [width, height] = self.size;
        [(self.at)(i, j), (self.at)(last(i, width), last(j, height))]
    }
}

impl Cell {
    /// The rays of the cell between its depths, and some more.
    pub(super) fn region(&self, tile: &Tile<'_>, sight: &Sight<'_>) -> Region {
        sight.region(tile.corners(self.block, self.side * BLOCK_SIDE), self.depth)
    }
}

/// A cell of a tile.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    pub(super) tile: &'a Tile<'a>,
    pub(super) sight: &'a Sight<'a>,
    pub(super) cell: Cell,
}

/// The number of a ray in its tile. Blocks are numbered so that those of a quarter follow
/// one another (G. M. Morton's order, 1966).
fn place(i: usize, j: usize) -> usize {
    let [x, y] = [i / BLOCK_SIDE, j / BLOCK_SIDE];
    let block = (x & 1) | (y & 1) << 1 | (x & 2) << 1 | (y & 2) << 2;
    block * BLOCK + j % BLOCK_SIDE * BLOCK_SIDE + i % BLOCK_SIDE
}

/// The number of the first ray of those in a part of a row, as wide as a block.
#[inline]
pub(super) fn first_of_row(part: usize, row: usize) -> usize {
    place(part * BLOCK_SIDE, row)
}

/// The first ray of a block.
fn block_place(block: usize) -> [usize; 2] {
    let x = (block & 1) | (block >> 1 & 2);
    let y = (block >> 1 & 1) | (block >> 2 & 2);
    [x * BLOCK_SIDE, y * BLOCK_SIDE]
}
