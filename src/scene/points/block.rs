//! Points side by side.

use std::ops::Range;

use glam::DVec3;
use pulp::Simd;

use super::plan::{Join, Plan, Step};
use crate::aabb::Aabb;
use crate::lanes::{Lanes, Vec3, Vector};
use crate::shape::Equation;

/// How many points a block has.
pub(super) const BLOCK: usize = 256;

/// No machine computes more numbers at once.
const WIDEST: usize = 8;

/// For more vectors than this it is worth a loop to know what kind an equation is of.
const SOME: usize = 3;

/// One number for each point of a block, and room for a vector that begins at the last one.
pub(super) type Numbers = [f64; BLOCK + WIDEST];

/// Points side by side, and what was computed for them.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub(super) points: [Numbers; 3],
    slots: Vec<Numbers>,
}

impl Block {
    /// With so many slots.
    pub(super) fn new(slots: usize) -> Self {
        Self {
            points: [[0.0; BLOCK + WIDEST]; 3],
            slots: vec![[0.0; BLOCK + WIDEST]; slots],
        }
    }

    /// Takes points as they come, and repeats the last one to fill a vector. Says how many
    /// vectors they are.
    #[inline(always)]
    pub(super) fn load<S: Simd>(&mut self, _: S, points: &[DVec3]) -> usize {
        let [x, y, z] = &mut self.points;
        for (((p, x), y), z) in points.iter().zip(&mut *x).zip(&mut *y).zip(&mut *z) {
            (*x, *y, *z) = (p.x, p.y, p.z);
        }
        let vectors = points.len().div_ceil(S::F64_LANES);
        if let Some(last) = points.last() {
            let rest = points.len()..vectors * S::F64_LANES;
            x[rest.clone()].fill(last.x);
            y[rest.clone()].fill(last.y);
            z[rest].fill(last.z);
        }
        vectors
    }

    /// Takes some of many points. They are all asked for before the first one is needed, since
    /// they come from far away.
    #[inline(always)]
    pub(super) fn gather(&mut self, points: &[DVec3], numbers: &[u32]) {
        let [x, y, z] = &mut self.points;
        for (((&i, x), y), z) in numbers.iter().zip(&mut *x).zip(&mut *y).zip(&mut *z) {
            let p = points[i as usize];
            (*x, *y, *z) = (p.x, p.y, p.z);
        }
    }

    /// Whether all points are within bounds.
    #[inline(always)]
    pub(super) fn is_within<S: Simd>(
        &self,
        simd: S,
        bounds: &Aabb,
        vectors: usize,
    ) -> bool {
        let [x, y, z] = &self.points;
        let Aabb { min, max } = bounds;
        let mut least = Vector(simd, simd.splat_f64s(1.0));
        least = holding(simd, x, [min.x, max.x], least, vectors);
        least = holding(simd, y, [min.y, max.y], least, vectors);
        least = holding(simd, z, [min.z, max.z], least, vectors);
        simd.reduce_min_f64s(least.1) > 0.0
    }

    /// Computes a plan for some of the points. Says what was found for the first of them and those
    /// that follow.
    #[inline(always)]
    pub(super) fn compute<S: Simd>(
        &mut self,
        simd: S,
        plan: Plan<'_>,
        equations: &[Equation],
        range: Range<usize>,
    ) -> &Numbers {
        let Self { points: [x, y, z], slots } = self;
        let points = [&x[range.start..], &y[range.start..], &z[range.start..]]
            .map(|numbers| S::as_simd_f64s(numbers).0);
        let vectors = range.len().div_ceil(S::F64_LANES);
        if vectors > SOME {
            step_by_step(simd, plan.steps, equations, points, slots, vectors);
        } else {
            let [x, y, z] = points;
            for (i, ((&x, &y), &z)) in x.iter().zip(y).zip(z).take(vectors).enumerate() {
                let p = at(simd, x, y, z);
                if plan.is_single {
                    let to = &mut S::as_mut_simd_f64s(&mut slots[0]).0[i];
                    *to = all_faces(simd, plan.steps, equations, p);
                } else {
                    all_steps(simd, plan.steps, equations, p, slots, i);
                }
            }
        }
        &slots[usize::from(plan.root)]
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

/// Computes all steps of a plan that has one slot.
#[inline(always)]
fn all_faces<S: Simd>(
    simd: S,
    steps: &[Step],
    equations: &[Equation],
    p: Vec3<Vector<S>>,
) -> S::f64s {
    let mut found = simd.splat_f64s(0.0);
    for step in steps {
        if let Step::Face { equation, join, .. } = *step {
            let value = equations[equation as usize].at(p).1;
            found = match join {
                Join::Set => value,
                Join::Min => simd.min_f64s(value, found),
                Join::Max => simd.max_f64s(value, found),
            };
        }
    }
    found
}

/// Computes all steps for the vector with a number.
#[inline(always)]
fn all_steps<S: Simd>(
    simd: S,
    steps: &[Step],
    equations: &[Equation],
    p: Vec3<Vector<S>>,
    slots: &mut [Numbers],
    i: usize,
) {
    for step in steps {
        let (value, to, join) = match *step {
            Step::Face { equation, to, join } => {
                (equations[equation as usize].at(p).1, to, join)
            }
            Step::Slot { from, to, join } => {
                (S::as_simd_f64s(&slots[usize::from(from)]).0[i], to, join)
            }
        };
        let slot = &mut S::as_mut_simd_f64s(&mut slots[usize::from(to)]).0[i];
        *slot = match join {
            Join::Set => value,
            Join::Min => simd.min_f64s(value, *slot),
            Join::Max => simd.max_f64s(value, *slot),
        };
    }
}

/// Computes each step for all vectors before the next one.
#[inline(always)]
fn step_by_step<S: Simd>(
    simd: S,
    steps: &[Step],
    equations: &[Equation],
    points: [&[S::f64s]; 3],
    slots: &mut [Numbers],
    vectors: usize,
) {
    for step in steps {
        match *step {
            Step::Face { equation, to, join } => {
                let equation = &equations[equation as usize];
                face(simd, equation, join, points, &mut slots[usize::from(to)], vectors);
            }
            Step::Slot { from, to, join } => {
                let pair = [usize::from(from), usize::from(to)];
                let Ok([from, to]) = slots.get_disjoint_mut(pair) else { continue };
                slot(simd, join, from, to, vectors);
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
    points: [&[S::f64s]; 3],
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
    [x, y, z]: [&[S::f64s]; 3],
    to: &mut Numbers,
    vectors: usize,
) {
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
