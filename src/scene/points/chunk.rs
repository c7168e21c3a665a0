//! Many points.

use std::ops::Range;

use glam::DVec3;
use pulp::Arch;

use super::Room;
use super::grid::Grid;
use super::plan::{BLOCK, Block, Candidate, Plan};
use crate::aabb::Aabb;
use crate::scene::beam::{Known, Place};
use crate::scene::{Scene, Tracer};
use crate::shape::{ALL, Region, Shape, Side};

/// A scene with no more leaves is computed as a whole, without sorting points.
const FEW: usize = 8;

/// About so many points are in a cell: to look at what a leaf is to a cell costs as much as
/// to compute it for some dozens of points.
const PER_CELL: usize = 96;

/// No fewer points are divided.
const ENOUGH: usize = 192;

/// Nor are these for the sake of one leaf.
const ENOUGH_FOR_ONE: usize = 1024;

/// A region is divided into so many halves of halves at once: into 2³.
const HALVINGS: usize = 3;

/// Coarse cells are made by so many halvings.
const COARSE: usize = 8;

/// Scratch memory for many points in a scene; one for each thread.
pub(super) struct Chunks<'a> {
    scene: &'a Scene,
    arch: Arch,
    tracer: Tracer<'a>,
    known: Known<'a>,
    /// The plan for the whole scene, if it is small.
    whole: Option<Whole>,
    plan: Plan,
    block: Block,
    /// The cell of each point.
    cells: Vec<u32>,
    coarse: Sorted,
    fine: Sorted,
    /// The leaves that matter in the regions that are looked at, one list on the other.
    candidates: Vec<Candidate>,
    /// The leaves that are all around one of these regions, and were not before.
    within: Vec<u32>,
}

/// A small scene.
enum Whole {
    /// No point within the bounds is in doubt.
    Decided(bool),
    Plan(Plan),
}

/// A point and its number.
#[derive(Clone, Copy, Debug, Default)]
struct Record {
    point: [f64; 3],
    number: u32,
    cell: u32,
}

/// Points in the order of their cells.
#[derive(Debug, Default)]
struct Sorted {
    records: Vec<Record>,
    /// Where in that order each cell ends; those that follow one after the other.
    ends: Vec<u32>,
}

impl Sorted {
    /// From how many points there are in each cell to where each begins.
    fn count(&mut self, cells: usize, of_points: impl Iterator<Item = u32>) {
        self.ends.clear();
        self.ends.resize(cells, 0);
        of_points.for_each(|cell| self.ends[cell as usize] += 1);
        let (mut sum, ends) = (0, &mut self.ends);
        for end in ends {
            sum += std::mem::replace(end, sum);
        }
        self.records.resize(self.records.len().max(sum as usize), Record::default());
    }

    /// Puts a point behind those of its cell.
    fn put(&mut self, cell: u32, record: Record) {
        let end = &mut self.ends[cell as usize];
        self.records[*end as usize] = record;
        *end += 1;
    }

    /// Where the points of some cells are in the order.
    fn range(&self, first: u32, count: u32) -> Range<usize> {
        let start = first.checked_sub(1).map_or(0, |before| self.ends[before as usize]);
        start as usize..self.ends[(first + count) as usize - 1] as usize
    }
}

/// Some cells of a grid.
#[derive(Clone, Copy, Debug)]
struct Part {
    prefix: u32,
    halvings: usize,
}

impl<'a> Chunks<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let mut chunks = Self {
            scene,
            arch: Arch::new(),
            tracer: scene.tracer(),
            known: Known::new(scene),
            whole: None,
            plan: Plan::default(),
            block: Block::new(),
            cells: Vec::new(),
            coarse: Sorted::default(),
            fine: Sorted::default(),
            candidates: Vec::new(),
            within: Vec::new(),
        };
        // Points that are not near a mesh must not ask it.
        let has_mesh =
            || scene.shapes.iter().any(|shape| matches!(shape, Shape::Polyhedron(_)));
        if let Some(room) = chunks.tracer.room
            && scene.leaf_count() <= FEW
            && !has_mesh()
        {
            chunks.whole = Some(chunks.plan_whole(&room));
        }
        chunks
    }

    fn plan_whole(&mut self, room: &Room) -> Whole {
        let within = Grid::new(room, 0).around(0, 0);
        let all = self.all_leaves();
        let whole = match self.look(&within, all) {
            Look::Decided(inside) => Whole::Decided(inside),
            Look::Open(list) => {
                let mut plan = Plan::default();
                plan.make(self.scene, &self.candidates[list], &within, room.pad);
                Whole::Plan(plan)
            }
        };
        self.forget(0);
        whole
    }

    /// What [`Tracer::contains`] says of points, at most 2³² of them.
    pub(super) fn answer(&mut self, points: &[DVec3], inside: &mut [bool]) {
        match (self.tracer.room, self.whole.take()) {
            (Some(room), Some(whole)) => {
                match &whole {
                    Whole::Decided(decided) => {
                        for (point, inside) in points.iter().zip(inside) {
                            let here = room.holds(*point);
                            *inside = if here {
                                *decided
                            } else {
                                self.tracer.contains(*point)
                            };
                        }
                    }
                    Whole::Plan(plan) => self.in_order(&room, plan, points, inside),
                }
                self.whole = Some(whole);
            }
            (Some(room), None) if points.len() > self.scene.leaf_count().max(ENOUGH) => {
                self.sort(&room, points, inside);
            }
            _ => {
                for (point, inside) in points.iter().zip(inside) {
                    *inside = self.tracer.contains(*point);
                }
            }
        }
    }

    /// Computes a plan for points as they come.
    fn in_order(
        &mut self,
        room: &Room,
        plan: &Plan,
        points: &[DVec3],
        inside: &mut [bool],
    ) {
        for (points, inside) in points.chunks(BLOCK).zip(inside.chunks_mut(BLOCK)) {
            let all_here = self.block.load(self.arch, &room.bounds, points);
            self.block.compute(self.arch, plan, points.len());
            let all_certain = self.block.answer(self.arch, inside);
            if all_here && all_certain {
                continue;
            }
            for (i, point) in points.iter().enumerate() {
                if self.block.found()[i].abs() <= 1.0 || !room.holds(*point) {
                    inside[i] = self.tracer.contains(*point);
                }
            }
        }
    }

    /// Sorts points into cells, and those of many cells together first: as many as
    /// there are places for in a processor's tables of memory.
    fn sort(&mut self, room: &Room, points: &[DVec3], inside: &mut [bool]) {
        let cells = points.len() / PER_CELL;
        let grid = Grid::new(room, cells.checked_ilog2().unwrap_or(0) as usize);
        let fine = grid.halvings().saturating_sub(COARSE);
        let outside = 1_u32 << grid.halvings();
        self.cells.clear();
        self.cells.extend(
            points.iter().map(
                |&point| {
                    if room.holds(point) { grid.cell(point) } else { outside }
                },
            ),
        );
        let Self { cells, coarse, tracer, .. } = self;
        let outside = outside >> fine;
        coarse.count(outside as usize + 1, cells.iter().map(|cell| cell >> fine));
        for ((number, point), &cell) in (0..).zip(points).zip(&*cells) {
            coarse.put(cell >> fine, Record { point: point.to_array(), number, cell });
        }
        for record in &coarse.records[coarse.range(outside, 1)] {
            inside[record.number as usize] = tracer.contains(record.point.into());
        }
        let all = self.all_leaves();
        let sorting = Sorting { room, grid: &grid, fine };
        self.divide(&sorting, Part { prefix: 0, halvings: 0 }, all, inside);
    }

    fn all_leaves(&mut self) -> Range<usize> {
        self.candidates.clear();
        let leaves = (0..).zip(&self.scene.clipped).filter(|(_, b)| !b.is_empty());
        self.candidates.extend(leaves.map(|(leaf, _)| Candidate { leaf, faces: ALL }));
        0..self.candidates.len()
    }

    /// Learns which leaves of a list are all around a box, and lists on top of it those that
    /// matter there still. The others count as outside.
    fn look(&mut self, around: &Aabb, list: Range<usize>) -> Look {
        let Self { scene, known, candidates, within, .. } = self;
        let reach = around.min.abs().max(around.max.abs()).max_element();
        let region = Region::of_box(around, reach);
        let first = candidates.len();
        for i in list {
            let Candidate { leaf, faces } = candidates[i];
            let bounds = &scene.clipped[leaf as usize];
            if around.intersection(*bounds).is_empty() {
                continue;
            }
            let slack = scene.slacks[leaf as usize];
            match region.side(&scene.shapes[leaf as usize], bounds, slack) {
                Side::Out => {}
                Side::Crossing(open) if open & faces != 0 => {
                    known.learn(leaf, Place::Out, Place::Open);
                    candidates.push(Candidate { leaf, faces: open & faces });
                }
                Side::In | Side::Crossing(_) => {
                    known.learn(leaf, Place::Out, Place::In);
                    within.push(leaf);
                }
            }
        }
        let decided = known.root();
        if decided.is_none() {
            known.next_region();
            for candidate in &mut candidates[first..] {
                if !known.matters(candidate.leaf) {
                    candidate.faces = 0;
                }
            }
        }
        let mut open = first;
        for i in first..candidates.len() {
            known.learn(candidates[i].leaf, Place::Open, Place::Out);
            if candidates[i].faces != 0 {
                candidates[open] = candidates[i];
                open += 1;
            }
        }
        match decided {
            Some(inside) => {
                candidates.truncate(first);
                Look::Decided(inside)
            }
            None => {
                candidates.truncate(open);
                Look::Open(first..open)
            }
        }
    }

    /// Forgets which leaves are all around a region.
    fn forget(&mut self, from: usize) {
        for leaf in self.within.drain(from..) {
            self.known.learn(leaf, Place::In, Place::Out);
        }
    }

    /// Answers for the points of some cells.
    fn divide(
        &mut self,
        sorting: &Sorting<'_>,
        part: Part,
        list: Range<usize>,
        inside: &mut [bool],
    ) {
        let (left, is_fine) = sorting.left(part);
        let records = if is_fine {
            self.fine.range((part.prefix << left) & ((1 << sorting.fine) - 1), 1 << left)
        } else {
            self.coarse.range(part.prefix << left, 1 << left)
        };
        if records.is_empty() {
            return;
        }
        let around = sorting.grid.around(part.prefix, part.halvings);
        let (first, within) = (self.candidates.len(), self.within.len());
        match self.look(&around, list) {
            Look::Decided(decided) => {
                let sorted = if is_fine { &self.fine } else { &self.coarse };
                for record in &sorted.records[records] {
                    inside[record.number as usize] = decided;
                }
            }
            Look::Open(open) => {
                let enough = if open.len() > 1 { ENOUGH } else { ENOUGH_FOR_ONE };
                let is_last = part.halvings == sorting.grid.halvings();
                if is_last || records.len() <= enough {
                    self.compute(sorting.room, &around, open, is_fine, records, inside);
                } else {
                    if left == 0 {
                        self.sort_finely(sorting.fine, records);
                    }
                    let left = if left == 0 { sorting.fine } else { left };
                    for part in part.divided(left.min(HALVINGS)) {
                        self.divide(sorting, part, open.clone(), inside);
                    }
                }
            }
        }
        self.candidates.truncate(first);
        self.forget(within);
    }

    /// Sorts the points of a coarse cell into cells.
    fn sort_finely(&mut self, halvings: usize, records: Range<usize>) {
        let Self { coarse, fine, .. } = self;
        let records = &coarse.records[records];
        let last_bits = (1_u32 << halvings) - 1;
        fine.count(1 << halvings, records.iter().map(|record| record.cell & last_bits));
        for record in records {
            fine.put(record.cell & last_bits, *record);
        }
    }

    /// Computes the leaves of a list for points in a box.
    fn compute(
        &mut self,
        room: &Room,
        around: &Aabb,
        list: Range<usize>,
        is_fine: bool,
        records: Range<usize>,
        inside: &mut [bool],
    ) {
        let Self { scene, arch, tracer, plan, block, coarse, fine, candidates, .. } =
            self;
        let sorted = if is_fine { fine } else { coarse };
        plan.make(scene, &candidates[list], around, room.pad);
        for records in sorted.records[records].chunks(BLOCK) {
            for (i, record) in records.iter().enumerate() {
                let [x, y, z] = record.point;
                block.points[0][i] = x;
                block.points[1][i] = y;
                block.points[2][i] = z;
            }
            block.compute(*arch, plan, records.len());
            for (record, &value) in records.iter().zip(block.found()) {
                let certain = value.abs() > 1.0;
                inside[record.number as usize] = if certain {
                    value < 0.0
                } else {
                    tracer.contains(record.point.into())
                };
            }
        }
    }
}

/// What a look at a region has found.
enum Look {
    /// It is inside or outside.
    Decided(bool),
    /// The candidates that matter there.
    Open(Range<usize>),
}

/// How points are sorted.
struct Sorting<'a> {
    room: &'a Room,
    grid: &'a Grid,
    /// Into how many cells coarse ones are divided, in halvings.
    fine: usize,
}

impl Sorting<'_> {
    /// How often a part is still to be halved, until its points are cells of the order in which
    /// they are; and whether that is the fine one.
    fn left(&self, part: Part) -> (usize, bool) {
        let all = self.grid.halvings();
        match (all - self.fine).checked_sub(part.halvings) {
            Some(left) => (left, false),
            None => (all - part.halvings, true),
        }
    }
}

impl Part {
    /// Its parts.
    fn divided(self, halvings: usize) -> impl Iterator<Item = Self> {
        let Self { prefix, halvings: before } = self;
        (0..1 << halvings).map(move |i| Self {
            prefix: prefix << halvings | i,
            halvings: before + halvings,
        })
    }
}
