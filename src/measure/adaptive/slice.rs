//! The area of the solid in a plane u = constant, by rays along w.
//!
//! In the plane every surface is a conic or a line. What rays have inside is an analytic
//! function of v but where they touch a conic or pass a corner, and all such places are roots
//! of polynomials of degree four or less. Those are kept at which the solid does have a side
//! or a corner, which is asked of the equations, not of rays.

use glam::{DMat3, DVec3};

use super::body::{Body, Set, numbers};
use super::conic::Conic;
use super::polynomial::roots_between;
use super::rule::{Rest, Rule, error};
use crate::ray::{Ray, Span};
use crate::sampling::hash;
use crate::scene::Tracer;

/// What does not change from slice to slice.
#[derive(Debug)]
pub(super) struct Stack<'a> {
    pub(super) body: &'a Body<'a>,
    /// Which surfaces meet each one at edges of the solid; it is among them if it matters at
    /// all.
    pub(super) meets: Vec<Set>,
    /// From u, v and w to the world.
    pub(super) origin: DVec3,
    pub(super) map: DMat3,
    /// All v and w are between this and its negative.
    pub(super) reach: f64,
    /// At most how far rounding moves the ends of chords, as a rule.
    pub(super) rounding: f64,
    /// What is tried one after the other, each with twice as many nodes.
    pub(super) rules: Vec<Rule>,
}

/// Scratch memory, one for each thread.
#[derive(Debug)]
pub(super) struct Scratch<'a> {
    tracer: Tracer<'a>,
    counts: Vec<u32>,
    roots: Vec<f64>,
    conics: Vec<Conic>,
    /// Between these v the chords are analytic.
    breaks: Vec<f64>,
    /// All places where rays touch conics, whether the solid has a side there or not.
    sides: Vec<f64>,
    /// The surfaces that meet at each corner.
    corners: Vec<[usize; 2]>,
}

impl<'a> Scratch<'a> {
    pub(super) fn new(tracer: Tracer<'a>) -> Self {
        Self {
            tracer,
            counts: Vec::new(),
            roots: Vec::new(),
            conics: Vec::new(),
            breaks: Vec::new(),
            sides: Vec::new(),
            corners: Vec::new(),
        }
    }
}

/// A number found from rays.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum {
    pub(super) value: f64,
    /// How wrong it is, as far as two rules tell that.
    pub(super) error: f64,
    /// The same integral of the number of ends of spans, each of which is rounded.
    pub(super) ends: f64,
    pub(super) rays: u64,
    pub(super) spans: u64,
    pub(super) uncertain: u64,
}

impl Sum {
    pub(super) fn add(&mut self, other: &Self, weight: f64) {
        self.value += weight * other.value;
        self.error += weight * other.error;
        self.ends += weight * other.ends;
        self.rays += other.rays;
        self.spans += other.spans;
        self.uncertain += other.uncertain;
    }
}

/// How wrong a number may be: by this much, or by this part of itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub(super) error: f64,
    pub(super) part: f64,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slice {
    /// Its area.
    pub(super) sum: Sum,
    /// A number that tells slices apart which have other corners.
    pub(super) corners: u64,
}

/// Points count as being on a surface if its form, with coefficients of length 1, has no
/// larger value there.
pub(super) const NEAR: f64 = 1e-9;

/// Where two conics only touch, a point on both is found to the root of the rounding.
const NEAR_TOUCHING: f64 = 1e-7;

/// Surfaces that cross at a smaller angle do not count as corners that make slices differ:
/// rounding decides whether they are there.
const SLIGHT: f64 = 1e-5;

/// A part of a slice between two breaks is not cut in two more often than this.
const MOST_CUTS: usize = 64;

impl Stack<'_> {
    /// The area of a slice.
    pub(super) fn area(
        &self,
        u: f64,
        wanted: Wanted,
        scratch: &mut Scratch<'_>,
    ) -> Slice {
        let corners = self.corners(u, scratch);
        graded(&mut scratch.breaks, &scratch.sides);
        let breaks = std::mem::take(&mut scratch.breaks);
        let mut sum = Sum::default();
        let error = wanted.error / breaks.len().max(1) as f64;
        for pair in breaks.windows(2) {
            let range = [pair[0], pair[1]];
            let part = self.integral(u, range, Wanted { error, ..wanted }, scratch);
            sum.add(&part, 1.0);
        }
        scratch.breaks = breaks;
        Slice { sum, corners }
    }

    /// A number that tells slices apart which have other corners.
    pub(super) fn corners(&self, u: f64, scratch: &mut Scratch<'_>) -> u64 {
        let Scratch { roots, conics, breaks, sides, corners, counts, .. } = scratch;
        conics.clear();
        conics.extend(self.body.forms.iter().map(|form| Conic::new(form, u)));
        breaks.clear();
        sides.clear();
        corners.clear();
        for (i, conic) in conics.iter().enumerate() {
            for j in numbers(self.meets[i]).filter(|&j| j >= i) {
                if i == j {
                    sides.extend(conic.sides().into_iter().flatten());
                    self.add_sides(u, i, conic, breaks, counts);
                    continue;
                }
                let resultant = conic.resultant(&conics[j]);
                roots_between(&resultant, [-self.reach, self.reach], roots);
                for &v in &*roots {
                    for w in conic.heights(v).into_iter().flatten() {
                        let start = DVec3::new(u, v, w);
                        let Some(point) = self.crossing([i, j], start, counts) else {
                            continue;
                        };
                        breaks.push(point.y);
                        if self.angle([i, j], point) > SLIGHT {
                            corners.push([i, j]);
                        }
                    }
                }
            }
        }
        breaks.sort_unstable_by(f64::total_cmp);
        breaks.dedup_by(|b, a| *b - *a <= 4.0 * f64::EPSILON);
        corners.sort_unstable();
        corners.iter().fold(0, |all, &[i, j]| hash(all, &[i as u64, j as u64]))
    }

    /// Adds where rays touch a conic, if the solid has a side there.
    fn add_sides(
        &self,
        u: f64,
        i: usize,
        conic: &Conic,
        breaks: &mut Vec<f64>,
        counts: &mut Vec<u32>,
    ) {
        for v in conic.sides().into_iter().flatten() {
            let heights = conic.heights(v).filter(|_| v.abs() <= self.reach);
            let matters = |w: f64| {
                let point = DVec3::new(u, v, w);
                self.body.matter(point, 1 << i, NEAR, counts) >> i & 1 == 1
            };
            if heights.into_iter().flatten().any(matters) {
                breaks.push(v);
            }
        }
    }

    /// The point where two conics cross, near one, if the solid has a corner there.
    fn crossing(
        &self,
        pair @ [i, j]: [usize; 2],
        start: DVec3,
        counts: &mut Vec<u32>,
    ) -> Option<DVec3> {
        let point = self.polished(pair, start);
        let is_on = |i: usize| self.body.forms[i].value(point).abs() <= NEAR_TOUCHING;
        let on = 1 << i | 1 << j;
        let matters =
            is_on(i) && is_on(j) && self.body.matter(point, on, NEAR, counts) & on == on;
        matters.then_some(point)
    }

    /// A point nearer to where two conics cross, by Newton's method.
    fn polished(&self, pair: [usize; 2], start: DVec3) -> DVec3 {
        /// The root of the resultant is good to half the digits at least.
        const STEPS: usize = 3;
        /// Where conics only touch Newton's method may go astray.
        const FAR: f64 = 1e-4;
        let [f, g] = pair.map(|i| &self.body.forms[i]);
        let mut point = start;
        for _ in 0..STEPS {
            let (a, b) = (f.gradient(point), g.gradient(point));
            let [fp, gp] = [f.value(point), g.value(point)];
            let determinant = a.y * b.z - a.z * b.y;
            let step = DVec3::new(0.0, fp * b.z - gp * a.z, gp * a.y - fp * b.y);
            let step = step / determinant;
            if !step.is_finite() {
                break;
            }
            point -= step;
        }
        if (point - start).length() < FAR { point } else { start }
    }

    /// The sine of the angle at which two conics cross.
    fn angle(&self, pair: [usize; 2], point: DVec3) -> f64 {
        let normal = |i: usize| self.body.forms[i].gradient(point).with_x(0.0);
        let [a, b] = pair.map(|i| normal(i).normalize_or_zero());
        (a.y * b.z - a.z * b.y).abs()
    }

    /// The area between two breaks.
    fn integral(
        &self,
        u: f64,
        range: [f64; 2],
        wanted: Wanted,
        scratch: &mut Scratch<'_>,
    ) -> Sum {
        let mut sum = Sum::default();
        let mut open = vec![range];
        let mut cuts = 0;
        while let Some([from, to]) = open.pop() {
            let mut best: Option<Sum> = None;
            let mut enough = false;
            for rule in &self.rules {
                let (mut now, left) = self.by_rule(u, [from, to], rule, scratch);
                if let Some(before) = best {
                    now.rays += before.rays;
                    now.spans += before.spans;
                    now.uncertain += before.uncertain;
                    now.error = error(before.value, now.value, left);
                    let floor = 2.0 * self.rounding * now.ends;
                    let wanted = wanted.error.max(wanted.part * now.value);
                    enough = now.error <= wanted.max(floor);
                }
                best = Some(now);
                if enough {
                    break;
                }
            }
            let Some(best) = best else { break };
            let middle = 0.5 * (from + to);
            if enough || cuts >= MOST_CUTS {
                sum.add(&best, 1.0);
            } else {
                cuts += 1;
                open.extend([[middle, to], [from, middle]]);
                // What was spent remains so.
                let Sum { rays, spans, uncertain, .. } = best;
                sum.add(&Sum { rays, spans, uncertain, ..Sum::default() }, 0.0);
            }
        }
        sum
    }

    /// The same by one rule, and what it leaves out.
    fn by_rule(
        &self,
        u: f64,
        [from, to]: [f64; 2],
        rule: &Rule,
        scratch: &mut Scratch<'_>,
    ) -> (Sum, f64) {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut sum = Sum::default();
        let mut rest = Rest::default();
        for node in &rule.nodes {
            let place = DVec3::new(u, middle + half * node.x, 0.0);
            let ray = Ray::new(self.origin + self.map * place, self.map.z_axis);
            let spans = scratch.tracer.spans(&ray);
            let count = spans.len() as u64;
            let chord = Sum {
                value: spans.iter().map(Span::length).sum(),
                error: 0.0,
                ends: 2.0 * count as f64,
                rays: 1,
                spans: count,
                uncertain: scratch.tracer.uncertain(&ray),
            };
            sum.add(&chord, half * node.weight);
            rest.add(node, chord.value);
        }
        (sum, half * rest.largest())
    }
}

/// Adds breaks near those beside which, outside, there is a side that the solid has not got,
/// hidden behind a corner.
///
/// A chord that ends like the root of x + δ has an error of the order δ^3/2 by rules whose first
/// node is farther from the end than δ, and that with all numbers of nodes alike. So cells
/// are made whose sizes grow with the distance from the side.
fn graded(breaks: &mut Vec<f64>, sides: &[f64]) {
    /// Rules see what is farther away than this part of a cell.
    const SEEN: f64 = 1e-3;
    /// The first cell in distances of the side, and how much larger the next ones are.
    const FIRST: f64 = 8.0;
    const GROWTH: f64 = 64.0;
    let count = breaks.len();
    for i in 1..count {
        let (from, to) = (breaks[i - 1], breaks[i]);
        for &side in sides {
            let (end, away) =
                if side < from { (from, from - side) } else { (to, to - side) };
            let size = to - from;
            let is_outside = side < from || side > to;
            if !is_outside || away.abs() > SEEN * size || away.abs() < SMALLEST_GRADE {
                continue;
            }
            let mut step = FIRST * away;
            while step.abs() < SEEN * FIRST * size {
                breaks.push(end + step);
                step *= GROWTH;
            }
        }
    }
    breaks.sort_unstable_by(f64::total_cmp);
}

/// Sides that are closer to a break are that break, but for rounding.
const SMALLEST_GRADE: f64 = 1e-12;
