//! A Boolean expression of few leaves as arithmetic on the points of a block.

use glam::DVec3;
use pulp::{Arch, Simd, WithSimd};

use crate::aabb::Aabb;
use crate::lanes::{Lanes, Vec3, Vector};
use crate::scene::Scene;
use crate::scene::program::Combine;
use crate::shape::Equation;

/// How many points a block has.
pub(super) const BLOCK: usize = 128;

/// One number for each point of a block.
pub(super) type Numbers = [f64; BLOCK];

/// A leaf that matters, and which of its faces do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) leaf: u32,
    pub(super) faces: u32,
}

/// How a number is put with the one that a slot has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Join {
    /// It is the first.
    Set,
    /// Union.
    Min,
    /// Intersection.
    Max,
}

#[derive(Clone, Copy, Debug)]
enum Step {
    Face { equation: Equation, to: usize, join: Join },
    Slot { from: usize, to: usize, join: Join },
}

/// What is to be computed for points of a region. Numbers are negative inside, and certain
/// beyond ±1 (`shape/point.rs`).
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    steps: Vec<Step>,
    /// Which slots have a number already.
    is_set: Vec<bool>,
    /// The nodes that have slots, and which.
    nodes: Vec<(u32, usize)>,
    /// For each node of the program the plan for which it got its slot, and the slot.
    slots: Vec<(u32, usize)>,
    number: u32,
    faces: Vec<Equation>,
}

/// The slot of the program's root.
const ROOT: usize = 0;

/// The slot for a leaf that is combined otherwise than the node above it.
const LEAF: usize = 1;

impl Plan {
    /// Makes the plan for points in a box, where some leaves are open, with all nodes above
    /// them, and everything else is decided.
    pub(super) fn make(
        &mut self,
        scene: &Scene,
        list: &[Candidate],
        within: &Aabb,
        pad: f64,
    ) {
        self.start(scene);
        for &Candidate { leaf, faces } in list {
            let literal = scene.literals[leaf as usize];
            let shape = &scene.shapes[leaf as usize];
            let of_faces = if literal.complement { Join::Min } else { Join::Max };
            let mut equations = std::mem::take(&mut self.faces);
            shape.equations(faces, within, pad, |equation| {
                let negated = equation.negated();
                equations.push(if literal.complement { negated } else { equation });
            });
            let (to, of_node) = self.slot(scene, literal.parent);
            if equations.len() == 1 || of_faces == of_node {
                for equation in equations.drain(..) {
                    self.face(equation, to, of_node);
                }
            } else {
                self.is_set[LEAF] = false;
                for equation in equations.drain(..) {
                    self.face(equation, LEAF, of_faces);
                }
                self.merge(LEAF, to, of_node);
            }
            self.faces = equations;
        }
        // Parents have smaller numbers than their children.
        self.nodes.sort_unstable_by_key(|&(node, _)| std::cmp::Reverse(node));
        for i in 0..self.nodes.len() {
            let (node, from) = self.nodes[i];
            if node > 0 {
                let (to, join) = self.slot(scene, scene.program.parent(node));
                self.merge(from, to, join);
            }
        }
    }

    fn start(&mut self, scene: &Scene) {
        self.slots.resize(scene.program.len(), (0, 0));
        self.number = self.number.wrapping_add(1);
        if self.number == 0 {
            self.slots.fill((0, 0));
            self.number = 1;
        }
        self.steps.clear();
        self.nodes.clear();
        self.is_set.clear();
        self.is_set.resize(2, false);
        self.nodes.push((0, ROOT));
        self.slots[0] = (self.number, ROOT);
    }

    /// The slot of a node, and how its children are put together. Nodes above get slots too.
    fn slot(&mut self, scene: &Scene, node: u32) -> (usize, Join) {
        let mut at = node;
        while self.slots[at as usize].0 != self.number {
            let slot = self.is_set.len();
            self.is_set.push(false);
            self.slots[at as usize] = (self.number, slot);
            self.nodes.push((at, slot));
            at = scene.program.parent(at);
        }
        let join = match scene.program.combine(node) {
            Combine::All => Join::Max,
            Combine::Any => Join::Min,
        };
        (self.slots[node as usize].1, join)
    }

    fn face(&mut self, equation: Equation, to: usize, join: Join) {
        let join = self.first_or(to, join);
        self.steps.push(Step::Face { equation, to, join });
    }

    fn merge(&mut self, from: usize, to: usize, join: Join) {
        let join = self.first_or(to, join);
        self.steps.push(Step::Slot { from, to, join });
    }

    fn first_or(&mut self, to: usize, join: Join) -> Join {
        let is_set = std::mem::replace(&mut self.is_set[to], true);
        if is_set { join } else { Join::Set }
    }
}

/// Points side by side, and what was computed for them.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub(super) points: [Numbers; 3],
    slots: Vec<Numbers>,
}

impl Block {
    pub(super) fn new() -> Self {
        Self { points: [[0.0; BLOCK]; 3], slots: Vec::new() }
    }

    /// Takes points as they come. Says whether all are in the bounds.
    pub(super) fn load(&mut self, arch: Arch, bounds: &Aabb, points: &[DVec3]) -> bool {
        arch.dispatch(Load { block: self, bounds, points })
    }

    /// Writes for each point whether it is inside, as far as is certain. Says whether that is so
    /// of all.
    pub(super) fn answer(&self, arch: Arch, inside: &mut [bool]) -> bool {
        arch.dispatch(Answer { block: self, inside })
    }

    /// Computes a plan for the first points.
    pub(super) fn compute(&mut self, arch: Arch, plan: &Plan, count: usize) {
        if self.slots.len() < plan.is_set.len() {
            self.slots.resize(plan.is_set.len(), [0.0; BLOCK]);
        }
        arch.dispatch(Compute { block: self, plan, count });
    }

    /// What was computed for the solid.
    pub(super) fn found(&self) -> &Numbers {
        &self.slots[ROOT]
    }
}

struct Load<'a> {
    block: &'a mut Block,
    bounds: &'a Aabb,
    points: &'a [DVec3],
}

impl WithSimd for Load<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Self { block: Block { points: [x, y, z], .. }, bounds, points } = self;
        for (((p, x), y), z) in points.iter().zip(&mut *x).zip(&mut *y).zip(&mut *z) {
            (*x, *y, *z) = (p.x, p.y, p.z);
        }
        let vectors = points.len().div_ceil(S::F64_LANES);
        if let Some(last) = points.last() {
            // No point that is not asked about is outside.
            let rest = points.len()..vectors * S::F64_LANES;
            x[rest.clone()].fill(last.x);
            y[rest.clone()].fill(last.y);
            z[rest].fill(last.z);
        }
        let mut least = Vector(simd, simd.splat_f64s(1.0));
        least = holding(simd, x, [bounds.min.x, bounds.max.x], least, vectors);
        least = holding(simd, y, [bounds.min.y, bounds.max.y], least, vectors);
        least = holding(simd, z, [bounds.min.z, bounds.max.z], least, vectors);
        simd.reduce_min_f64s(least.1) > 0.0
    }
}

/// `least`, or zero where a coordinate is not within bounds, or no number.
#[inline(always)]
fn holding<S: Simd>(
    simd: S,
    numbers: &Numbers,
    [min, max]: [f64; 2],
    least: Vector<S>,
    vectors: usize,
) -> Vector<S> {
    // A number that is not smaller is larger than the one before.
    let (below, above) = (least.same(min.next_down()), least.same(max.next_up()));
    let (mut least, zero) = (least, least.same(0.0));
    for &number in S::as_simd_f64s(numbers).0.iter().take(vectors) {
        let number = Vector(simd, number);
        least = Vector::select(below.less(number) & number.less(above), least, zero);
    }
    least
}

struct Answer<'a> {
    block: &'a Block,
    inside: &'a mut [bool],
}

impl WithSimd for Answer<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        let Self { block: Block { slots, .. }, inside } = self;
        let mut certain = true;
        for (value, inside) in slots[ROOT].iter().zip(inside) {
            *inside = *value < 0.0;
            certain &= value.abs() > 1.0;
        }
        certain
    }
}

struct Compute<'a> {
    block: &'a mut Block,
    plan: &'a Plan,
    count: usize,
}

impl WithSimd for Compute<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { block: Block { points, slots, .. }, plan, count } = self;
        let vectors = count.div_ceil(S::F64_LANES);
        for step in &plan.steps {
            match *step {
                Step::Face { equation, to, join } => {
                    face(simd, &equation, join, points, &mut slots[to], vectors);
                }
                Step::Slot { from, to, join } => {
                    let [from, to] = match slots.get_disjoint_mut([from, to]) {
                        Ok(slots) => slots,
                        Err(_) => continue,
                    };
                    slot(simd, join, from, to, vectors);
                }
            }
        }
    }
}

#[inline(always)]
fn slot<S: Simd>(simd: S, join: Join, from: &Numbers, to: &mut Numbers, vectors: usize) {
    let (from, to) = (S::as_simd_f64s(from).0, S::as_mut_simd_f64s(to).0);
    for (&from, to) in from.iter().zip(to).take(vectors) {
        let (a, b) = (Vector(simd, from), Vector(simd, *to));
        *to = match join {
            Join::Set => a.1,
            Join::Min => simd.min_f64s(a.1, b.1),
            Join::Max => simd.max_f64s(a.1, b.1),
        };
    }
}

/// One loop for each kind of equation, in which it is known what kind that is.
#[inline(always)]
fn face<S: Simd>(
    simd: S,
    equation: &Equation,
    join: Join,
    points: &[Numbers; 3],
    to: &mut Numbers,
    vectors: usize,
) {
    macro_rules! kinds {
        ($($kind:pat),* $(,)?) => {
            match *equation {
                $(e @ $kind => joined(simd, &e, join, points, to, vectors),)*
                // Axes are numbered 0 to 2.
                e => joined(simd, &e, join, points, to, vectors),
            }
        };
    }
    kinds!(
        Equation::Level { .. },
        Equation::Round { .. },
        Equation::Cuboid { .. },
        Equation::Quadric { .. },
        Equation::Plane { .. },
        Equation::Band { .. },
        Equation::Unknown,
        Equation::Side { axis: 0, .. },
        Equation::Side { axis: 1, .. },
        Equation::Side { axis: 2, .. },
        Equation::Slab { axis: 0, .. },
        Equation::Slab { axis: 1, .. },
        Equation::Slab { axis: 2, .. },
        Equation::Disc { axis: 0, .. },
        Equation::Disc { axis: 1, .. },
        Equation::Disc { axis: 2, .. },
    );
}

#[inline(always)]
fn joined<S: Simd>(
    simd: S,
    equation: &Equation,
    join: Join,
    points: &[Numbers; 3],
    to: &mut Numbers,
    vectors: usize,
) {
    let [x, y, z] = points;
    let (x, y, z) = (S::as_simd_f64s(x).0, S::as_simd_f64s(y).0, S::as_simd_f64s(z).0);
    let to = S::as_mut_simd_f64s(to).0;
    let points = x.iter().zip(y).zip(z).zip(to).take(vectors);
    match join {
        Join::Set => {
            for (((&x, &y), &z), to) in points {
                *to = equation.at(at(simd, x, y, z)).1;
            }
        }
        Join::Min => {
            for (((&x, &y), &z), to) in points {
                *to = simd.min_f64s(equation.at(at(simd, x, y, z)).1, *to);
            }
        }
        Join::Max => {
            for (((&x, &y), &z), to) in points {
                *to = simd.max_f64s(equation.at(at(simd, x, y, z)).1, *to);
            }
        }
    }
}

#[inline(always)]
fn at<S: Simd>(simd: S, x: S::f64s, y: S::f64s, z: S::f64s) -> Vec3<Vector<S>> {
    Vec3 { x: Vector(simd, x), y: Vector(simd, y), z: Vector(simd, z) }
}
