//! Where a line passes a triangle of a mesh, such that it goes in as often as it comes out.
//!
//! # Why every list is balanced
//!
//! One shear per line maps the line to the third axis, and every point is mapped once, by
//! the same operations whichever face asks: the faces, slightly deformed by rounding,
//! remain a closed mesh. Whether the line passes a face is then a question about three
//! two-dimensional orientations with exact signs (J. R. Shewchuk, "Adaptive Precision
//! Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997). A zero is
//! decided as if the line were moved by (ε, ε², ε³) in the world (H. Edelsbrunner,
//! E. P. Mücke, "Simulation of Simplicity", 1990), to the side to which it also counts as
//! moved within a face of a box, so the line is in general position to the deformed mesh, and
//! goes in as often as it comes out. The shear is that of S. Woop, C. Benthin, I. Wald,
//! "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013, whose inclusive edge tests
//! suffice for first hits but not for this.

use glam::{DMat3, DVec2, DVec3};
use robust::{Coord, orient2d};

use super::line::inverse_power_of_two;
use crate::ray::Sense;

/// The map that takes a line to the third axis.
pub(super) struct Shear<'a> {
    /// A power of two that brings all coordinates seen from the origin to 1 or less.
    scale: f64,
    origin: DVec3,
    /// Which axes become the first, second and third: the third is the one along which the
    /// line is steepest, and the first two follow it in turn, whichever way the line runs,
    /// so that a line and its reverse are moved to the same side.
    pub(super) axes: [usize; 3],
    pub(super) shift: DVec2,
    /// How fast the line runs along the third axis; negative if it runs against it.
    speed: f64,
    /// What a place along the line must be multiplied by to count in its directions.
    step: f64,
    /// The directions of the world's axes.
    world: &'a DMat3,
}

/// A point seen along the line: how far beside it, and where along it.
#[derive(Clone, Copy)]
struct Corner {
    beside: DVec2,
    along: f64,
}

impl<'a> Shear<'a> {
    /// The scale is that of the mesh.
    #[inline(always)]
    pub(super) fn new(scale: f64, origin: DVec3, dir: DVec3, world: &'a DMat3) -> Self {
        let scale = scale.min(inverse_power_of_two(origin.abs().max_element()));
        let step = (inverse_power_of_two(dir.abs().max_element()) / scale).min(f64::MAX);
        let dir = level(dir);
        let z = dir.abs().max_position();
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        let shift = DVec2::new(dir[x], dir[y]) / dir[z];
        let (axes, origin) = ([x, y, z], scale * origin);
        Self { scale, origin, axes, shift, speed: dir[z], step, world }
    }

    /// Where a point is seen, and where along the third axis.
    #[inline(always)]
    fn seen(&self, point: DVec3) -> (DVec2, f64) {
        let p = self.scale * point - self.origin;
        let (across, along) = match self.axes[2] {
            0 => (DVec2::new(p.y, p.z), p.x),
            1 => (DVec2::new(p.z, p.x), p.y),
            _ => (DVec2::new(p.x, p.y), p.z),
        };
        (flushed(across - self.shift * along), along)
    }

    /// Where the moved line is seen: by each world axis, the first before the others, and
    /// by both axes of the plane should rounding have made those parallel.
    #[cold]
    fn moves(&self) -> [DVec2; 5] {
        let [x, y, z] = self.axes;
        let axes = [self.world.x_axis, self.world.y_axis, self.world.z_axis];
        let [first, second, third] =
            axes.map(level).map(|m| flushed(DVec2::new(m[x], m[y]) - self.shift * m[z]));
        [first, second, third, DVec2::X, DVec2::Y]
    }
}

/// A vector times the power of two that makes it about 1 long.
#[inline(always)]
pub(super) fn level(v: DVec3) -> DVec3 {
    v * inverse_power_of_two(v.abs().max_element())
}

/// Smaller coordinates count as zero.
pub(super) const LEAST: f64 = 1e-144;

/// Zero for coordinates whose products have no room for all their digits. It deforms the
/// mesh like any other rounding.
#[inline(always)]
fn flushed(p: DVec2) -> DVec2 {
    p.map(|x| if x.abs() < LEAST { 0.0 } else { x })
}

/// Where the line passes through a triangle, and whether it goes in or out.
///
/// A triangle that is counter-clockwise seen from where the third axis goes faces away from
/// where it comes from, so a line along it comes out there.
#[inline(always)]
pub(super) fn crossing(corners: [DVec3; 3], shear: &Shear<'_>) -> Option<(f64, Sense)> {
    let [a, b, c] = corners;
    let ((a, a_z), (b, b_z), (c, c_z)) = (shear.seen(a), shear.seen(b), shear.seen(c));
    let bc = turn(b, c);
    let is_left = shear.is_left_turn(bc, b, c)?;
    let ca = turn(c, a);
    if shear.is_left_turn(ca, c, a)? != is_left {
        return None;
    }
    let ab = turn(a, b);
    if shear.is_left_turn(ab, a, b)? != is_left {
        return None;
    }
    let corner = |beside, z| Corner { beside, along: z / shear.speed };
    let corners = [corner(a, a_z), corner(b, b_z), corner(c, c_z)];
    let t = along(corners, [bc, ca, ab]) * shear.step;
    Some((t, if is_left == (shear.speed > 0.0) { Sense::Exit } else { Sense::Enter }))
}

/// Twice the signed area of the triangle of the line, `a` and `b`; its sign is exact.
///
/// Rounding never puts two products in the other order, so the sign is certain where they have
/// not become the same number. Only then are all digits needed (J. R. Shewchuk, as above).
#[inline(always)]
fn turn(a: DVec2, b: DVec2) -> f64 {
    let turn = a.x * b.y - a.y * b.x;
    if turn == 0.0 { exact_turn(a, b) } else { turn }
}

#[cold]
fn exact_turn(a: DVec2, b: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), Coord { x: 0.0, y: 0.0 })
}

impl Shear<'_> {
    /// Whether the triangle of the line, `a` and `b`, of which `turn` is the area, turns
    /// left when the line is moved; `None` for two corners in the same place.
    ///
    /// A move by m adds m × (a − b) to the area. Where the area is zero, a and b are in one
    /// line with the origin, so a − b is a multiple of either: the sign of the product with
    /// that one is exact, that of the product with a rounded difference would not be.
    #[inline(always)]
    fn is_left_turn(&self, turn_of_edge: f64, a: DVec2, b: DVec2) -> Option<bool> {
        if turn_of_edge == 0.0 {
            return self.is_left_turn_when_moved(a, b);
        }
        Some(turn_of_edge > 0.0)
    }

    #[cold]
    fn is_left_turn_when_moved(&self, a: DVec2, b: DVec2) -> Option<bool> {
        let step = a - b;
        let along = if a == DVec2::ZERO { b } else { a };
        let axis = along.abs().max_position();
        if step[axis] == 0.0 {
            return None;
        }
        let reversed = (step[axis] > 0.0) != (along[axis] > 0.0);
        let sides = self.moves().map(|m| turn(m, along));
        sides.into_iter().find(|&side| side != 0.0).map(|side| (side > 0.0) != reversed)
    }
}

/// Where along the line the triangle is passed, given the areas opposite its corners.
///
/// On an edge or a corner the answer comes from that edge or corner alone, so that all
/// faces around it give the same bits. It does not depend on which corner a face lists first.
#[inline(always)]
fn along(corners: [Corner; 3], areas: [f64; 3]) -> f64 {
    let [a, b, c] = areas;
    if a != 0.0 && b != 0.0 && c != 0.0 {
        along_face(corners)
    } else {
        along_border(corners, areas)
    }
}

#[cold]
fn along_border([a, b, c]: [Corner; 3], areas: [f64; 3]) -> f64 {
    match areas.map(|x| x == 0.0) {
        [true, false, false] => along_edge(b, c),
        [false, true, false] => along_edge(c, a),
        [false, false, true] => along_edge(a, b),
        [false, true, true] => a.along,
        [true, false, true] => b.along,
        [true, true, false] => c.along,
        [true, true, true] | [false, false, false] => along_face([a, b, c]),
    }
}

/// Where the line passes an edge that it meets exactly, the same whichever end is first.
fn along_edge(a: Corner, b: Corner) -> f64 {
    let (a, b) = if b.is_before(&a) { (b, a) } else { (a, b) };
    let is_wide = (b.beside - a.beside).abs().max_position() == 0;
    let [_, along] = passed(a.facing(is_wide), b.facing(is_wide));
    along
}

/// Where the line passes the inside of a triangle: between the two edges that pass it in
/// front and behind, as it is seen along its longer side.
///
/// A triangle that is almost parallel to the line is seen as a sliver whose areas are
/// nothing but rounding. Still both edges are passed where they should be, so an answer
/// between them is near the triangle.
#[inline(always)]
fn along_face([a, b, c]: [Corner; 3]) -> f64 {
    let most = a.beside.max(b.beside).max(c.beside);
    let least = a.beside.min(b.beside).min(c.beside);
    let is_wide = (most - least).max_position() == 0;
    let (a, b) = sorted(a.facing(is_wide), b.facing(is_wide));
    let (b, high) = sorted(b, c.facing(is_wide));
    let (low, middle) = sorted(a, b);
    let [y, along] = passed(low, high);
    let [other_y, other_along] =
        if middle.beside.x > 0.0 { passed(low, middle) } else { passed(middle, high) };
    between(along, other_along, part(y, other_y))
}

impl Corner {
    /// With the longer side first.
    #[inline(always)]
    fn facing(self, is_wide: bool) -> Self {
        let DVec2 { x, y } = self.beside;
        let beside = if is_wide { self.beside } else { DVec2::new(y, x) };
        Self { beside, ..self }
    }

    #[inline(always)]
    #[expect(clippy::float_cmp, reason = "one place is one number")]
    fn is_before(&self, other: &Self) -> bool {
        let (a, b) = (self.beside, other.beside);
        if a.x != b.x {
            a.x < b.x
        } else if a.y != b.y {
            a.y < b.y
        } else {
            self.along < other.along
        }
    }
}

/// The one that comes first on the first axis, and the other.
#[inline(always)]
fn sorted(a: Corner, b: Corner) -> (Corner, Corner) {
    if b.is_before(&a) { (b, a) } else { (a, b) }
}

/// The place between two where the first coordinate is zero, or one of them where it never is:
/// the second coordinate, and how far along.
#[inline(always)]
fn passed(from: Corner, to: Corner) -> [f64; 2] {
    let part = part(from.beside.x, to.beside.x);
    [between(from.beside.y, to.beside.y, part), between(from.along, to.along, part)]
}

/// Which part of the way between two numbers zero is, or nothing of it.
#[inline(always)]
fn part(from: f64, to: f64) -> f64 {
    let part = -from / (to - from);
    if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 }
}

/// A number that is a part of the way between two.
#[inline(always)]
fn between(a: f64, b: f64, part: f64) -> f64 {
    (a + part * (b - a)).max(a.min(b)).min(a.max(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::U;
    use proptest::prelude::*;

    /// A coordinate with few digits, or with many and a few units of rounding more.
    fn coordinate() -> impl Strategy<Value = f64> {
        let small = (-8..=8_i32).prop_map(|i| 0.125 * f64::from(i));
        prop_oneof![small, -1.0..1.0_f64]
    }

    proptest! {
        /// Points on one line with the origin, but for rounding: there the filter has to hand
        /// over to exact arithmetic.
        #[test]
        fn turns_have_exact_signs(
            a in [coordinate(), coordinate()],
            factor in coordinate(),
            ulps in [-3..=3_i32, -3..=3_i32],
        ) {
            let a = DVec2::from_array(a);
            let off = |x: f64, n: i32| x + f64::from(n) * U * x;
            let b = factor * a;
            let b = DVec2::new(off(b.x, ulps[0]), off(b.y, ulps[1]));
            let exact = exact_turn(a, b);
            let sign = |x: f64| x.partial_cmp(&0.0);
            prop_assert_eq!(sign(turn(a, b)), sign(exact), "{} {}", a, b);
            prop_assert_eq!(sign(turn(b, a)), sign(-exact));
        }
    }
}
