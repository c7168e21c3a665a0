//! Lines through triangles, several side by side, each through its own.
//!
//! What is computed for one line in [`Polyhedron`](super::Polyhedron) is computed here by the
//! same operations in the same order, so that the numbers are the same. Only the sign of an
//! area that rounding has made zero is left to that: then there is doubt.

use super::shear::LEAST;
use crate::lanes::{Lanes, Vec3};

/// Maps that take lines to the third axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheared<L> {
    pub(crate) scale: L,
    pub(crate) origin: Vec3<L>,
    pub(crate) shift: [L; 2],
    pub(crate) speed: L,
    pub(crate) step: L,
}

/// Where lines pass triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passed<L: Lanes> {
    pub(crate) t: L,
    /// Which lines pass them at all.
    pub(crate) is_met: L::Mask,
    /// Which of them come out there.
    pub(crate) is_exit: L::Mask,
    /// Of which this is not known.
    pub(crate) doubt: L::Mask,
}

/// A point seen along a line: how far beside it, and where along it.
#[derive(Clone, Copy)]
struct Corner<L> {
    x: L,
    y: L,
    along: L,
}

impl<L: Lanes> Sheared<L> {
    /// For lines whose direction, which is not zero, is the longest on the last of three axes,
    /// in the frame of a mesh that has a scale; see [`Shear`](super::polyhedron).
    #[inline(always)]
    pub(crate) fn new(
        scale: f64,
        origin: Vec3<L>,
        dir: Vec3<L>,
        axes: [usize; 3],
    ) -> Self {
        let scale = origin.x.same(scale).min(origin.largest().inverse_power_of_two());
        let steps = dir.largest().inverse_power_of_two();
        let step = (steps / scale).min(scale.same(f64::MAX));
        let dir = turned(dir.scaled(steps), axes);
        let origin = turned(origin.scaled(scale), axes);
        let shift = [dir.x / dir.z, dir.y / dir.z];
        Self { scale, origin, shift, speed: dir.z, step }
    }

    /// Where each line passes the triangle with these corners, their axes in the order of the
    /// lines'.
    #[inline(always)]
    pub(crate) fn crossing(&self, [a, b, c]: [Vec3<L>; 3]) -> Passed<L> {
        let (a, b, c) = (self.seen(a), self.seen(b), self.seen(c));
        let zero = self.scale.same(0.0);
        let (left_bc, right_bc) = turn(b, c);
        let (left_ca, right_ca) = turn(c, a);
        let (left_ab, right_ab) = turn(a, b);
        let left = left_bc & left_ca & left_ab;
        let right = right_bc & right_ca & right_ab;
        let beside = (left_bc | left_ca | left_ab) & (right_bc | right_ca | right_ab);
        let is_met = left | right;
        let t = self.along([a, b, c]) * self.step;
        // Zero has two signs, of which this may have found the other.
        let doubt = !(is_met | beside) | (is_met & t.equal(zero));
        let is_forward = zero.less(self.speed);
        let is_exit = (left & is_forward) | (!left & !is_forward);
        Passed { t, is_met: is_met & !doubt, is_exit, doubt }
    }

    #[inline(always)]
    fn seen(&self, point: Vec3<L>) -> Corner<L> {
        let p = point.scaled(self.scale) - self.origin;
        let [x, y] = self.shift;
        Corner { x: flushed(p.x - x * p.z), y: flushed(p.y - y * p.z), along: p.z }
    }

    /// Where along the lines the insides of triangles are passed.
    #[inline(always)]
    fn along(&self, [a, b, c]: [Corner<L>; 3]) -> L {
        let width = a.x.max(b.x).max(c.x) - a.x.min(b.x).min(c.x);
        let height = a.y.max(b.y).max(c.y) - a.y.min(b.y).min(c.y);
        let is_wide = !width.less(height);
        let (a, b) = (self.facing(is_wide, a), self.facing(is_wide, b));
        let c = self.facing(is_wide, c);
        let (a, b) = sorted(a, b);
        let (b, high) = sorted(b, c);
        let (low, middle) = sorted(a, b);
        let [y, along] = passed(low, high);
        let is_past = low.x.same(0.0).less(middle.x);
        let from = select(is_past, low, middle);
        let to = select(is_past, middle, high);
        let [other_y, other_along] = passed(from, to);
        between(along, other_along, part(y, other_y))
    }

    /// With the longer side first.
    #[inline(always)]
    fn facing(&self, is_wide: L::Mask, corner: Corner<L>) -> Corner<L> {
        Corner {
            x: L::select(is_wide, corner.x, corner.y),
            y: L::select(is_wide, corner.y, corner.x),
            along: corner.along / self.speed,
        }
    }
}

/// Which of the triangles of lines and two points certainly turn left, and which right: those
/// whose areas rounding has not made zero.
#[inline(always)]
fn turn<L: Lanes>(a: Corner<L>, b: Corner<L>) -> (L::Mask, L::Mask) {
    let (p, q) = (a.x * b.y, a.y * b.x);
    (q.less(p), p.less(q))
}

/// The one that comes first on the first axis, and the other.
#[inline(always)]
fn sorted<L: Lanes>(a: Corner<L>, b: Corner<L>) -> (Corner<L>, Corner<L>) {
    let is_before = b.along.less(a.along);
    let is_before = b.y.less(a.y) | (b.y.equal(a.y) & is_before);
    let is_before = b.x.less(a.x) | (b.x.equal(a.x) & is_before);
    (select(is_before, b, a), select(is_before, a, b))
}

/// The place between two where the first coordinate is zero: the second, and how far along.
#[inline(always)]
fn passed<L: Lanes>(from: Corner<L>, to: Corner<L>) -> [L; 2] {
    let part = part(from.x, to.x);
    [between(from.y, to.y, part), between(from.along, to.along, part)]
}

/// Which part of the way between two numbers zero is, or nothing of it.
#[inline(always)]
fn part<L: Lanes>(from: L, to: L) -> L {
    let (zero, one) = (from.same(0.0), from.same(1.0));
    let part = -from / (to - from);
    let is_finite = part.is_finite();
    let part = L::select(part.less(zero), zero, part);
    let part = L::select(one.less(part), one, part);
    L::select(is_finite, part, zero)
}

/// A number that is a part of the way between two.
#[inline(always)]
fn between<L: Lanes>(a: L, b: L, part: L) -> L {
    (a + part * (b - a)).max(a.min(b)).min(a.max(b))
}

#[inline(always)]
fn select<L: Lanes>(mask: L::Mask, yes: Corner<L>, no: Corner<L>) -> Corner<L> {
    Corner {
        x: L::select(mask, yes.x, no.x),
        y: L::select(mask, yes.y, no.y),
        along: L::select(mask, yes.along, no.along),
    }
}

/// Zero for numbers whose products have no room for all their digits.
#[inline(always)]
fn flushed<L: Lanes>(x: L) -> L {
    L::select(x.abs().less(x.same(LEAST)), x.same(0.0), x)
}

/// The axes of vectors in another order.
#[inline(always)]
fn turned<L: Lanes>(v: Vec3<L>, axes: [usize; 3]) -> Vec3<L> {
    let all = [v.x, v.y, v.z];
    let [x, y, z] = axes;
    Vec3 { x: all[x], y: all[y], z: all[z] }
}
