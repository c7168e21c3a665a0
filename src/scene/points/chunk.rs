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
    /// The points in the order of their cells.
    sorted: Vec<Record>,
    /// The cell of each point.
    cells: Vec<u32>,
    /// Where in that order each cell ends.
    ends: Vec<u32>,
    /// The leaves that matter in the regions that are looked at, one list on the other.
    candidates: Vec<Candidate>,
    /// What became of the leaves of a list, one for each.
    sides: Vec<Side>,
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
            sorted: Vec::new(),
            cells: Vec::new(),
            ends: Vec::new(),
            candidates: Vec::new(),
            sides: Vec::new(),
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
        let list = self.look(&within, all.clone(), Place::Out);
        let whole = match self.known.root() {
            Some(inside) => Whole::Decided(inside),
            None => {
                let mut plan = Plan::default();
                plan.make(self.scene, &self.candidates[list], &within, room.pad);
                Whole::Plan(plan)
            }
        };
        self.forget(all, 0, Place::Out);
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
            self.block.load(self.arch, &room.bounds, points);
            self.block.compute(self.arch, plan, points.len());
            let certain = self.block.answer(self.arch, inside);
            if !certain {
                for (i, point) in points.iter().enumerate() {
                    if self.block.is_unsure(i) {
                        inside[i] = self.tracer.contains(*point);
                    }
                }
            }
        }
    }

    fn sort(&mut self, room: &Room, points: &[DVec3], inside: &mut [bool]) {
        let cells = points.len() / PER_CELL;
        let grid = Grid::new(room, cells.checked_ilog2().unwrap_or(0) as usize);
        let outside = 1_u32 << grid.halvings();
        self.ends.clear();
        self.ends.resize(outside as usize + 1, 0);
        self.cells.clear();
        for point in points {
            let cell = if room.holds(*point) { grid.cell(*point) } else { outside };
            self.ends[cell as usize] += 1;
            self.cells.push(cell);
        }
        let mut sum = 0;
        for end in &mut self.ends {
            sum += std::mem::replace(end, sum);
        }
        self.sorted.resize(points.len(), Record::default());
        for ((number, point), &cell) in (0..).zip(points).zip(&self.cells) {
            let end = &mut self.ends[cell as usize];
            self.sorted[*end as usize] = Record { point: point.to_array(), number };
            *end += 1;
        }
        for i in self.records(outside, 1) {
            let Record { point, number } = self.sorted[i];
            inside[number as usize] = self.tracer.contains(point.into());
        }
        let all = self.all_leaves();
        self.divide(
            room,
            &grid,
            Part { prefix: 0, halvings: 0 },
            all,
            Place::Out,
            inside,
        );
    }

    /// Where the points of some cells are in the order.
    fn records(&self, first: u32, count: u32) -> Range<usize> {
        let start = first.checked_sub(1).map_or(0, |before| self.ends[before as usize]);
        start as usize..self.ends[(first + count) as usize - 1] as usize
    }

    fn all_leaves(&mut self) -> Range<usize> {
        self.candidates.clear();
        let leaves = (0..).zip(&self.scene.clipped).filter(|(_, b)| !b.is_empty());
        self.candidates.extend(leaves.map(|(leaf, _)| Candidate { leaf, faces: ALL }));
        0..self.candidates.len()
    }

    /// Learns what the leaves of a list are to a box, and lists those that matter there still,
    /// if anything is open.
    fn look(&mut self, around: &Aabb, list: Range<usize>, before: Place) -> Range<usize> {
        let reach = around.min.abs().max(around.max.abs()).max_element();
        let region = Region::of_box(around, reach);
        let first_side = self.sides.len();
        for i in list.clone() {
            let Candidate { leaf, faces } = self.candidates[i];
            let bounds = &self.scene.clipped[leaf as usize];
            let slack = self.scene.slacks[leaf as usize];
            let side = if around.intersection(*bounds).is_empty() {
                Side::Out
            } else {
                match region.side(&self.scene.shapes[leaf as usize], bounds, slack) {
                    Side::Crossing(open) if open & faces == 0 => Side::In,
                    Side::Crossing(open) => Side::Crossing(open & faces),
                    side @ (Side::In | Side::Out) => side,
                }
            };
            self.known.learn(leaf, before, side.into());
            self.sides.push(side);
        }
        let first = self.candidates.len();
        if self.known.root().is_none() {
            self.known.next_region();
            for (i, k) in list.zip(first_side..) {
                let leaf = self.candidates[i].leaf;
                if let Side::Crossing(faces) = self.sides[k]
                    && self.known.matters(leaf)
                {
                    self.candidates.push(Candidate { leaf, faces });
                }
            }
        }
        first..self.candidates.len()
    }

    /// Forgets what was learned of the leaves of a list, which is on top then.
    fn forget(&mut self, list: Range<usize>, sides: usize, before: Place) {
        self.candidates.truncate(list.end);
        for (i, k) in list.zip(sides..) {
            self.known.learn(self.candidates[i].leaf, self.sides[k].into(), before);
        }
        self.sides.truncate(sides);
    }

    /// Answers for the points of some cells.
    fn divide(
        &mut self,
        room: &Room,
        grid: &Grid,
        part: Part,
        list: Range<usize>,
        before: Place,
        inside: &mut [bool],
    ) {
        let left = grid.halvings() - part.halvings;
        let records = self.records(part.prefix << left, 1 << left);
        if records.is_empty() {
            return;
        }
        let around = grid.around(part.prefix, part.halvings);
        let sides = self.sides.len();
        let open = self.look(&around, list.clone(), before);
        if let Some(decided) = self.known.root() {
            for record in &self.sorted[records] {
                inside[record.number as usize] = decided;
            }
        } else {
            let enough = if open.len() > 1 { ENOUGH } else { ENOUGH_FOR_ONE };
            if left == 0 || records.len() <= enough {
                self.compute(room, &around, open, records, inside);
            } else {
                let more = left.min(HALVINGS);
                for i in 0..1 << more {
                    let part = Part {
                        prefix: part.prefix << more | i,
                        halvings: part.halvings + more,
                    };
                    self.divide(room, grid, part, open.clone(), Place::Open, inside);
                }
            }
        }
        self.forget(list, sides, before);
    }

    /// Computes the leaves of a list for points in a box.
    fn compute(
        &mut self,
        room: &Room,
        around: &Aabb,
        list: Range<usize>,
        records: Range<usize>,
        inside: &mut [bool],
    ) {
        let Self { scene, arch, tracer, plan, block, sorted, candidates, .. } = self;
        plan.make(scene, &candidates[list], around, room.pad);
        for records in sorted[records].chunks(BLOCK) {
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
