//! What equations are over whole boxes (interval arithmetic).
//!
//! Without products of coordinates, bounds are sharp; with them they are of second order in
//! the size of the box.
//!
//! Equations are divided by tolerances of at least 512 roundings of their terms
//! (`point.rs`), so rounding here is far less than 1: a bound beyond ±2 holds for what is
//! beyond ±1 for certain.

use glam::DVec3;

use super::point::Equation;
use crate::aabb::Aabb;

impl Equation {
    /// Between which numbers its values are for points of a box.
    pub(crate) fn over(&self, b: &Aabb) -> [f64; 2] {
        let (center, half) = (b.center(), 0.5 * b.size());
        match *self {
            Self::Unknown => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Side { axis, offset, scale } => {
                around((center[axis] - offset) * scale, half[axis] * scale.abs())
            }
            Self::Slab { axis, middle, half: to_side, scale } => {
                let [near, far] = away(center[axis] - middle, half[axis]);
                ordered((near - to_side) * scale, (far - to_side) * scale)
            }
            Self::Plane { normal, offset } => {
                around(normal.dot(center) - offset, normal.abs().dot(half))
            }
            Self::Band { normal, middle, half: to_side, scale } => {
                let reach = normal.abs().dot(half);
                let [near, far] = away(normal.dot(center) - middle, reach);
                ordered(near * scale - to_side, far * scale - to_side)
            }
            Self::Level { origin, squares, constant } => {
                of_squares(squares, center - origin, half, constant)
            }
            Self::Round { origin, square, constant } => {
                of_squares(DVec3::splat(square), center - origin, half, constant)
            }
            Self::Disc { axis, origin, square, constant } => {
                let mut squares = DVec3::splat(square);
                squares[axis] = 0.0;
                of_squares(squares, center - origin, half, constant)
            }
            Self::Cuboid { middle, half: to_side, scale } => {
                let ([x, y, z], d) = ([0, 1, 2], center - middle);
                let [near, far] = [x, y, z]
                    .map(|axis| away(d[axis], half[axis]).map(|x| x - to_side[axis]))
                    .into_iter()
                    .fold([f64::NEG_INFINITY; 2], |[a, b], [c, d]| [a.max(c), b.max(d)]);
                ordered(near * scale, far * scale)
            }
            Self::Quadric { origin, squares, products, linear, constant } => {
                let d = center - origin;
                let turned = |m: DVec3, v: DVec3| {
                    DVec3::new(
                        m.z * v.y + m.y * v.z,
                        m.x * v.z + m.z * v.x,
                        m.y * v.x + m.x * v.y,
                    )
                };
                // Each product is counted twice.
                let mixed = turned(products, d);
                let value = (squares * d + 0.5 * mixed + linear).dot(d) - constant;
                let gradient = 2.0 * squares * d + mixed + linear;
                let [low, high] = around(value, gradient.abs().dot(half));
                let h = half * half;
                let rest = 0.5 * turned(products.abs(), half).dot(half);
                [
                    low + squares.min(DVec3::ZERO).dot(h) - rest,
                    high + squares.max(DVec3::ZERO).dot(h) + rest,
                ]
            }
        }
    }
}

fn around(middle: f64, reach: f64) -> [f64; 2] {
    [middle - reach, middle + reach]
}

fn ordered(a: f64, b: f64) -> [f64; 2] {
    if a < b { [a, b] } else { [b, a] }
}

/// How small and how large `|x|` is for `x` no farther from `middle` than `reach`.
fn away(middle: f64, reach: f64) -> [f64; 2] {
    let middle = middle.abs();
    [(middle - reach).max(0.0), middle + reach]
}

fn of_squares(squares: DVec3, d: DVec3, half: DVec3, constant: f64) -> [f64; 2] {
    (0..3).fold([-constant; 2], |[low, high], axis| {
        let [near, far] = away(d[axis], half[axis]).map(|x| x * x * squares[axis]);
        let [least, most] = ordered(near, far);
        [low + least, high + most]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    /// Values at points of boxes are within the bounds, and the bounds of points are values.
    #[test]
    fn values_are_within_bounds() {
        let mut state = 1_u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / (1_u64 << 23) as f64 - 1.0
        };
        for _ in 0..2000 {
            let mut vector = || dvec3(number(), number(), number());
            let (origin, squares, products) = (vector(), 3.0 * vector(), 3.0 * vector());
            let (linear, normal, sides) = (vector(), vector(), vector().abs());
            let b = Aabb::around([2.0 * vector(), 2.0 * vector()]);
            let steps: Vec<DVec3> = (0..20).map(|_| vector()).collect();
            let [offset, half, scale] = vector().to_array();
            let half_width = half.abs();
            let mut equations = vec![
                Equation::Unknown,
                Equation::Plane { normal, offset },
                Equation::Band { normal, middle: offset, half, scale },
                Equation::Level { origin, squares, constant: offset },
                Equation::Round { origin, square: scale, constant: offset },
                Equation::Cuboid { middle: origin, half: sides, scale },
                Equation::Quadric { origin, squares, products, linear, constant: half },
            ];
            for axis in 0..3 {
                equations.extend([
                    Equation::Side { axis, offset, scale },
                    Equation::Slab { axis, middle: offset, half: half_width, scale },
                    Equation::Disc { axis, origin, square: scale, constant: offset },
                ]);
            }
            for equation in equations {
                let [low, high] = equation.over(&b);
                for step in &steps {
                    let p = b.center() + 0.5 * b.size() * *step;
                    let value = equation.at(p.into());
                    assert!(low - 1e-9 <= value && value <= high + 1e-9, "{equation:?}");
                    let [least, most] = equation.over(&Aabb::new(p, p));
                    let is_unknown = matches!(equation, Equation::Unknown);
                    assert!(is_unknown || (least - value).abs() < 1e-9, "{equation:?}");
                    assert!(is_unknown || (most - value).abs() < 1e-9, "{equation:?}");
                }
            }
        }
    }
}
