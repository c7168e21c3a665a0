//! What is known of the cells of a scene.
//!
//! The box of a scene is divided as tiles of rays are (`beam`): of each leaf it is known to be
//! all around, or far away, for a whole region, until few leaves are left. What is then to be
//! computed for a point of the region is a plan. Cells that are alike have one plan together.
//!
//! That takes time for each leaf, but is done once. To find the plan for a point takes no
//! more than rounding its coordinates.

use std::ops::Range;

use super::Room;
use super::grid::{Grid, Part};
use super::plan::{Planner, Plans};
use super::raster::{Passed, Raster};
use crate::aabb::Aabb;
use crate::scene::Scene;
use crate::scene::beam::{Known, Place};
use crate::shape::{ALL, Equation, Polyhedron, Shape};

/// What is known of a cell: all is outside of the solid,
pub(super) const OUT: u32 = 0;
/// or inside,
pub(super) const IN: u32 = 1;
/// or points ask one by one,
pub(super) const ALONE: u32 = 2;

/// Regions with no more faces than this are not divided any further: points that are computed
/// together are more then.
const FEW: usize = 2;

/// A region is divided into so many halves of halves before it is looked at.
const HALVINGS: usize = 3;

/// A plan with more faces than this costs more than a line.
const MOST: usize = 256;

/// So many cells are made for each leaf
const PER_LEAF: usize = 1;
/// and each triangle,
const PER_TRIANGLE: usize = 4;
/// but no fewer halvings than this
const LEAST_HALVINGS: usize = 12;
/// and no more.
const MOST_HALVINGS: usize = 21;

/// Faces in plans, for each leaf,
const STEPS: usize = 24;
/// each triangle,
const STEPS_OF_TRIANGLE: usize = 2;
/// and in addition. Where more would be, cells are larger.
const MORE_STEPS: usize = 1 << 17;

/// What cells are to meshes is kept for so many meshes around each cell, on average.
const RASTERS: usize = 8;

/// To make a plan, walking past so many nodes counts as a face.
const NODES: usize = 64;

/// A scene with no more leaves is computed as a whole.
const SMALL: usize = 8;

/// The cells of a scene, and what is to be computed for the points in each.
#[derive(Debug)]
pub(in super::super) struct Cells {
    pub(super) room: Room,
    pub(super) grid: Grid,
    /// [`OUT`], [`IN`] or the number of a plan plus two for each cell, and for what is not in
    /// any.
    pub(super) places: Vec<u32>,
    pub(super) plans: Plans,
    pub(super) equations: Vec<Equation>,
}

impl Cells {
    /// Those of a scene, if it has room for them.
    pub(in super::super) fn new(scene: &Scene) -> Option<Self> {
        let room = Room::of(scene)?;
        let halvings = if is_small(scene) {
            0
        } else {
            let cells = PER_LEAF * scene.leaf_count() + PER_TRIANGLE * triangles(scene);
            let halvings = cells.next_power_of_two().ilog2() as usize;
            halvings.clamp(LEAST_HALVINGS, MOST_HALVINGS)
        };
        let faces = Faces::new(scene, &room);
        let most = STEPS * scene.leaf_count()
            + STEPS_OF_TRIANGLE * triangles(scene)
            + MORE_STEPS;
        (0..=halvings)
            .rev()
            .step_by(3)
            .find_map(|halvings| {
                let grid = Grid::new(&room, halvings);
                Division::new(scene, &faces, grid)?.all(most)
            })
            .map(|(grid, places, plans)| {
                let equations = faces.equations;
                Self { room, grid, places, plans, equations }
            })
    }

    /// Whether points need not be sorted.
    pub(super) fn is_one(&self) -> bool {
        self.grid.len() == 1
    }

    /// How much memory they take.
    #[cfg(test)]
    pub(in super::super) fn bytes(&self) -> usize {
        size_of_val(&*self.places) + size_of_val(&*self.equations) + self.plans.bytes()
    }
}

/// How many triangles meshes have.
fn triangles(scene: &Scene) -> usize {
    scene.shapes.iter().filter_map(mesh).map(Polyhedron::face_count).sum()
}

/// The mesh that a leaf is.
fn mesh(shape: &Shape) -> Option<&Polyhedron> {
    if let Shape::Polyhedron(mesh) = shape { Some(mesh) } else { None }
}

/// How many points take about as long one by one as it takes to make cells.
pub(super) fn price(scene: &Scene) -> usize {
    (1 << 13) + 4 * scene.leaf_count() + triangles(scene) / 16
}

/// Whether a scene is computed as a whole. Points that are not near a mesh must not ask it.
pub(super) fn is_small(scene: &Scene) -> bool {
    scene.leaf_count() <= SMALL && scene.shapes.iter().all(|shape| mesh(shape).is_none())
}

/// The equations of all leaves, for all points in the room.
#[derive(Debug)]
struct Faces {
    equations: Vec<Equation>,
    /// Where those of each leaf end.
    ends: Vec<u32>,
}

impl Faces {
    fn new(scene: &Scene, room: &Room) -> Self {
        let within = room.bounds.grown(2.0 * room.pad);
        let mut faces = Self { equations: Vec::new(), ends: Vec::new() };
        for (shape, literal) in scene.shapes.iter().zip(&scene.literals) {
            shape.equations(ALL, &within, room.pad, |equation| {
                let negated = equation.negated();
                faces.equations.push(if literal.complement { negated } else { equation });
            });
            let end = u32::try_from(faces.equations.len()).unwrap_or(u32::MAX);
            faces.ends.push(end);
        }
        faces.equations.shrink_to_fit();
        faces
    }

    fn first(&self, leaf: u32) -> u32 {
        leaf.checked_sub(1).map_or(0, |before| self.ends[before as usize])
    }

    /// The faces of a leaf whose bits are set.
    fn of(&self, candidate: Candidate) -> impl Iterator<Item = u32> + use<> {
        let first = self.first(candidate.leaf);
        (first..self.ends[candidate.leaf as usize])
            .filter(move |face| candidate.faces >> (face - first) & 1 == 1)
    }

    /// What a leaf is to a box.
    fn side(&self, scene: &Scene, candidate: Candidate, around: &Aabb) -> Side {
        let complement = scene.literals[candidate.leaf as usize].complement;
        let first = self.first(candidate.leaf);
        let mut open = 0;
        for face in self.of(candidate) {
            let [low, high] = self.equations[face as usize].over(around);
            let [low, high] = if complement { [-high, -low] } else { [low, high] };
            if low > 2.0 {
                return Side::Out;
            }
            // What is not a number decides nothing.
            open |= u32::from(high.is_nan() || high >= -2.0) << (face - first);
        }
        if open == 0 { Side::In } else { Side::Open(open) }
    }
}

/// A leaf that matters, and which of its faces do.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    leaf: u32,
    faces: u32,
}

/// What a leaf is to a region: inside of some of its faces is all of it.
enum Side {
    In,
    Out,
    Open(u32),
}

/// The division of a scene's box.
struct Division<'a> {
    scene: &'a Scene,
    faces: &'a Faces,
    grid: Grid,
    known: Known<'a>,
    planner: Planner<'a>,
    places: Vec<u32>,
    /// Of leaves that are meshes.
    rasters: Vec<(u32, Raster)>,
    /// The leaves that matter in the regions that are looked at, one list on the other.
    candidates: Vec<Candidate>,
    /// The leaves that are all around one of these regions, and were not before.
    within: Vec<u32>,
    /// How many faces plans have.
    steps: usize,
}

/// What a look at a region has found.
enum Look {
    /// It is inside or outside.
    Decided(bool),
    /// The candidates that matter there.
    Open(Range<usize>),
}

impl<'a> Division<'a> {
    /// Nothing if meshes lie over one another so much that there would be no room for what
    /// cells are to all of them.
    fn new(scene: &'a Scene, faces: &'a Faces, grid: Grid) -> Option<Self> {
        let meshes = (0..).zip(&scene.shapes).zip(&scene.clipped);
        let meshes = meshes
            .filter(|(_, bounds)| !bounds.is_empty())
            .filter_map(|((leaf, shape), _)| Some((leaf, mesh(shape)?)));
        let mut room = RASTERS * grid.len();
        let mut rasters = Vec::new();
        for (leaf, mesh) in meshes {
            let raster = Raster::new(scene, &grid, leaf, mesh);
            room = room.checked_sub(raster.len())?;
            rasters.push((leaf, raster));
        }
        let places = vec![ALONE; grid.len() + 1];
        Some(Self {
            scene,
            faces,
            grid,
            known: Known::new(scene),
            planner: Planner::new(scene),
            places,
            rasters,
            candidates: Vec::new(),
            within: Vec::new(),
            steps: 0,
        })
    }

    /// Divides everything; nothing if plans have more faces than this.
    fn all(mut self, most: usize) -> Option<(Grid, Vec<u32>, Plans)> {
        self.planner.nothing();
        let leaves = (0..).zip(&self.scene.clipped).filter(|(_, b)| !b.is_empty());
        self.candidates.extend(leaves.map(|(leaf, _)| Candidate { leaf, faces: ALL }));
        let all = 0..self.candidates.len();
        let is_last = self.grid.len() == 1;
        let fits = self.divide(&self.grid.whole(), all, most);
        (fits || is_last).then(|| (self.grid, self.places, self.planner.finish()))
    }

    /// Fills in what is known of some cells. Says whether there was room for it.
    fn divide(&mut self, part: &Part, list: Range<usize>, most: usize) -> bool {
        let around = self.grid.around(&part.places);
        let (first, within) = (self.candidates.len(), self.within.len());
        let fits = match self.look(part, &around, list) {
            Look::Decided(inside) => {
                self.fill(part, if inside { IN } else { OUT });
                true
            }
            Look::Open(open) => {
                let is_few = self.count(open.clone()).is_some_and(|count| count <= FEW);
                if is_few || self.grid.is_cell(part) {
                    let plan = self.plan(open);
                    self.fill(part, plan);
                    self.steps <= most
                } else {
                    self.halve(part, open, HALVINGS, most)
                }
            }
        };
        self.candidates.truncate(first);
        for leaf in self.within.drain(within..) {
            self.known.learn(leaf, Place::In, Place::Out);
        }
        fits
    }

    /// Divides a part so many times before its parts are looked at: boxes tell what is far away
    /// from half of it soon.
    fn halve(
        &mut self,
        part: &Part,
        list: Range<usize>,
        left: usize,
        most: usize,
    ) -> bool {
        let Some((axis, halves)) = self.grid.halves(part).filter(|_| left > 0) else {
            return self.divide(part, list, most);
        };
        let first = self.candidates.len();
        halves.iter().all(|half| {
            let around = self.grid.around(&half.places);
            let (low, high) = (around.min[axis], around.max[axis]);
            for i in list.clone() {
                let candidate = self.candidates[i];
                let bounds = &self.scene.clipped[candidate.leaf as usize];
                if bounds.max[axis] >= low && bounds.min[axis] <= high {
                    self.candidates.push(candidate);
                }
            }
            let near = first..self.candidates.len();
            let fits = self.halve(half, near, left - 1, most);
            self.candidates.truncate(first);
            fits
        })
    }

    /// How many faces candidates have, if none is a mesh.
    fn count(&self, list: Range<usize>) -> Option<usize> {
        let of = |candidate: &Candidate| {
            let shape = &self.scene.shapes[candidate.leaf as usize];
            mesh(shape).is_none().then_some(candidate.faces.count_ones() as usize)
        };
        self.candidates[list].iter().map(of).sum()
    }

    /// The number for the plan of some candidates.
    fn plan(&mut self, list: Range<usize>) -> u32 {
        let Self { scene, faces, candidates, planner, .. } = self;
        let candidates = &candidates[list];
        let is_mesh = |c: &Candidate| mesh(&scene.shapes[c.leaf as usize]).is_some();
        let count: usize = candidates.iter().map(|&c| faces.of(c).count()).sum();
        if count > MOST || candidates.iter().all(is_mesh) {
            return ALONE;
        }
        let plan = planner.make(candidates.iter().map(|&c| (c.leaf, faces.of(c))));
        self.steps += count + planner.nodes() / NODES;
        u32::try_from(plan).map_or(ALONE, |plan| plan + ALONE)
    }

    fn fill(&mut self, part: &Part, place: u32) {
        let Self { grid, places, .. } = self;
        grid.rows(&part.places, |row| places[row].fill(place));
    }

    /// Learns which leaves of a list are all around a region, and lists on top of it those that
    /// matter there still. The others count as outside.
    fn look(&mut self, part: &Part, around: &Aabb, list: Range<usize>) -> Look {
        let Self { scene, faces, known, candidates, within, rasters, .. } = self;
        let first = candidates.len();
        for i in list {
            let candidate = candidates[i];
            let leaf = candidate.leaf;
            if around.intersection(scene.clipped[leaf as usize]).is_empty() {
                continue;
            }
            let side = match rasters.binary_search_by_key(&leaf, |(leaf, _)| *leaf) {
                Ok(raster) => match rasters[raster].1.side(&part.places) {
                    Passed::In => Side::In,
                    Passed::Out => Side::Out,
                    Passed::Open => Side::Open(candidate.faces),
                },
                Err(_) => faces.side(scene, candidate, around),
            };
            match side {
                Side::Out => {}
                Side::Open(faces) => {
                    known.learn(leaf, Place::Out, Place::Open);
                    candidates.push(Candidate { leaf, faces });
                }
                Side::In => {
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
}
