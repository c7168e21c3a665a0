//! What part of a box is on the inner side of a face, between certain bounds.
//!
//! Over a box a face is all but a plane: its equation is that of a plane through about the
//! same points, and what is left over, which is of second order in the size of the box, is
//! bounded. The part of a box beyond a plane has a formula. So the bounds are apart by the
//! square of the size, where those of interval arithmetic are by the size.

use glam::DVec3;

use super::Shape;
use super::doubt::U;
use super::plane::Plane;
use super::wall::Wall;

/// A box by its middle and half its edges, all of whose coordinates, and the numbers that
/// leaves see of it, are in doubt by less than `pad`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block {
    pub(crate) center: DVec3,
    pub(crate) half: DVec3,
    pub(crate) pad: f64,
}

/// The function `value + gradient · δ`, give or take some, for ways δ from the middle.
struct Slope {
    value: f64,
    gradient: DVec3,
    /// The least and the most that is to be added.
    rest: [f64; 2],
}

impl Block {
    /// The least and the most of the box that is inside of a leaf of which only the faces
    /// matter whose bits are set.
    pub(crate) fn share(&self, shape: &Shape, faces: u32) -> [f64; 2] {
        let (planes, wall) = shape.sides();
        let (mut missing, mut most) = (0.0, 1.0_f64);
        let mut add = |[low, high]: [f64; 2]| {
            missing += 1.0 - low;
            most = most.min(high);
        };
        let first = u32::from(wall.is_some());
        if let Some(wall) = wall.filter(|_| faces & 1 == 1) {
            add(self.slope_of_wall(wall).share(self.half));
        }
        for (face, plane) in (first..).zip(planes) {
            if faces >> face & 1 == 1 {
                add(self.slope_of_plane(plane).share(self.half));
            }
        }
        [(1.0 - missing - ROUNDING).max(0.0), most]
    }

    fn slope_of_plane(&self, plane: &Plane) -> Slope {
        let gradient = plane.outward();
        let offset = if plane.above { -plane.offset } else { plane.offset };
        let room = self.pad * gradient.abs().element_sum() + 16.0 * U * offset.abs();
        let value = gradient.dot(self.center) - offset;
        Slope { value, gradient, rest: [-room, room] }
    }

    /// As [`Region`](super::Region) has it, with the way from the middle for all of it.
    fn slope_of_wall(&self, wall: &Wall) -> Slope {
        let linear = &wall.to_local.linear;
        let [a, b, c] = wall.profile.coefficients();
        let weights = DVec3::new(1.0, 1.0, -a);
        let center = wall.to_local.point(self.center);
        let value = (weights * center).dot(center) - 2.0 * b * center.z - c;
        let inner = 2.0 * (weights * center - DVec3::new(0.0, 0.0, b));
        let gradient = linear.transpose() * inner;
        let room = linear.abs() * DVec3::splat(self.pad);
        let wide = linear.abs() * self.half + room;
        let squares = wide * wide;
        let bulge_out = squares.x + squares.y + (-a).max(0.0) * squares.z;
        let bulge_in = a.max(0.0) * squares.z;
        let reach = center.abs() + wide;
        let terms = weights.abs().dot(reach * reach) + 2.0 * b.abs() * reach.z + c.abs();
        let doubt = inner.abs().dot(room) + 64.0 * U * terms;
        Slope { value, gradient, rest: [-bulge_in - doubt, bulge_out + doubt] }
    }
}

/// A part of a box is a mean of means of a function whose slope is at most 3, so that it is
/// off by a few times the rounding of a coordinate: at most some 40 u, for which this leaves
/// room.
const ROUNDING: f64 = 256.0 * U;

impl Slope {
    /// The least and the most of a box of this size around the middle where the function is
    /// not positive.
    fn share(&self, half: DVec3) -> [f64; 2] {
        let reach = self.gradient.abs() * half;
        let all = reach.element_sum();
        let [least, most] = self.rest.map(|rest| self.value + rest);
        if !(all.is_finite() && least.is_finite() && most.is_finite()) {
            return [0.0, 1.0];
        }
        // Where the gradient is next to nothing quotients are no numbers.
        let part = |value: f64| {
            if value <= -all {
                1.0
            } else if value >= all {
                0.0
            } else {
                below((reach / all).to_array(), 0.5 - 0.5 * value / all)
            }
        };
        [(part(most) - ROUNDING).max(0.0), (part(least) + ROUNDING).min(1.0)]
    }
}

/// The part of the unit cube where a weighted sum of coordinates is at most `limit`; weights
/// are positive and 1 together.
///
/// It is the mean over the first coordinate of parts of a square, which are means of parts of
/// an edge: piecewise cubic, quadratic and linear functions of the limit. Each piece is
/// integrated by Simpson's rule, which is exact. So nothing cancels, as it does in the
/// expanded polynomials (R. Scardovelli, S. Zaleski, "Analytical Relations Connecting Linear
/// Interfaces and Volume Fractions in Rectangular Grids", Journal of Computational Physics
/// 164, 2000), and a weight can be zero.
fn below(mut weights: [f64; 3], limit: f64) -> f64 {
    weights.sort_by(f64::total_cmp);
    let [a, b, c] = weights;
    let edge = |limit: f64| (limit / c).clamp(0.0, 1.0);
    let square = |limit: f64| mean(b, limit, [0.0, c], edge);
    mean(a, limit, [0.0, b, c, b + c], square)
}

/// The mean of `f(limit − weight x)` for x from 0 to 1, for a function that is a polynomial of
/// at most the second degree between some places, in order.
fn mean<const N: usize>(
    weight: f64,
    limit: f64,
    places: [f64; N],
    f: impl Fn(f64) -> f64,
) -> f64 {
    let piece = |from: f64, to: f64| {
        let at = |x: f64| f(limit - weight * x);
        (to - from) / 6.0 * (at(from) + 4.0 * at(0.5 * (from + to)) + at(to))
    };
    let (mut from, mut sum) = (0.0, 0.0);
    // The limit falls, so the last place comes first.
    for place in places.into_iter().rev() {
        let to = (limit - place) / weight;
        if to > from && to < 1.0 {
            sum += piece(from, to);
            from = to;
        }
    }
    sum + piece(from, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the sum over corners, where that is well-behaved.
    #[test]
    fn parts_of_cubes_are_those_of_the_polynomial() {
        let mut state = 1_u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        for _ in 0..5000 {
            let raw = [number(), number(), number()].map(|x| x + 0.05);
            let sum: f64 = raw.iter().sum();
            let [a, b, c] = raw.map(|x| x / sum);
            let limit = number();
            let mut expected = 0.0;
            for corner in 0..8_u32 {
                let on = |bit: u32| f64::from(corner >> bit & 1);
                let rest = limit - on(0) * a - on(1) * b - on(2) * c;
                let is_even = corner.count_ones().is_multiple_of(2);
                let sign = if is_even { 1.0 } else { -1.0 };
                expected += sign * rest.max(0.0).powi(3) / (6.0 * a * b * c);
            }
            let found = below([a, b, c], limit);
            assert!((found - expected).abs() < 1e-10, "{a} {b} {c} {limit}");
        }
        for limit in [0.0, 0.1, 0.5, 1.0] {
            assert!((below([0.0, 0.0, 1.0], limit) - limit).abs() < 1e-15);
            assert!((below([1e-300, 1e-17, 1.0], limit) - limit).abs() < 1e-15);
        }
        assert!((below([0.5, 0.0, 0.5], 0.5) - 0.5).abs() < 1e-15);
    }
}
