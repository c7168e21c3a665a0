//! Planes and quadrics in numbers of 200 bits.

use super::real::{Real, Vector};
use crate::support::leaf::{Leaf, Number};

/// The points p of a leaf's frame with `Σ squareᵢ pᵢ² + 2 slope · p + constant ≤ 0`.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    square: [f64; 3],
    /// What the square of z is multiplied with, apart from `square`.
    steepness: Option<Real>,
    slope: Vector,
    constant: Real,
}

/// The polynomial `a t² + 2 b t + c` that a surface is along a line.
#[derive(Clone, Debug)]
pub(crate) struct Polynomial {
    pub(crate) a: Real,
    pub(crate) b: Real,
    pub(crate) c: Real,
}

impl Number for Real {
    fn of(x: f64) -> Self {
        Self::exact(x)
    }
}

fn exact(x: f64) -> Real {
    Real::exact(x)
}

impl Surface {
    /// The points with `normal · p ≤ offset`.
    fn plane(normal: [f64; 3], offset: f64) -> Self {
        Self {
            square: [0.0; 3],
            steepness: None,
            slope: Vector(normal.map(|x| exact(0.5 * x))),
            constant: exact(-offset),
        }
    }

    /// The points with `x² + y² ≤ a z² + 2 b z + c`.
    fn revolved([a, b, c]: [Real; 3]) -> Self {
        Self {
            square: [1.0, 1.0, 0.0],
            steepness: Some(-a),
            slope: Vector([exact(0.0), exact(0.0), -b]),
            constant: -c,
        }
    }

    /// The image of a direction under the matrix of the squares.
    pub(crate) fn weighed(&self, p: &Vector) -> Vector {
        let [x, y, z] = &p.0;
        let z = self.steepness.as_ref().map_or(exact(0.0), |factor| factor * z);
        Vector([exact(self.square[0]) * x, exact(self.square[1]) * y, z])
    }

    /// Half the gradient at a point.
    pub(crate) fn half_gradient(&self, p: &Vector) -> Vector {
        if self.steepness.is_none() {
            return self.slope.clone();
        }
        self.weighed(p).plus(&self.slope)
    }

    /// What it is along a line.
    pub(crate) fn along(&self, origin: &Vector, dir: &Vector) -> Polynomial {
        let (to_origin, b) = (self.slope.dot(origin), self.slope.dot(dir));
        let c = &to_origin + &to_origin + &self.constant;
        if self.steepness.is_none() {
            return Polynomial { a: exact(0.0), b, c };
        }
        let (o, d) = (self.weighed(origin), self.weighed(dir));
        Polynomial { a: d.dot(dir), b: o.dot(dir) + b, c: o.dot(origin) + c }
    }
}

/// The surfaces of which a leaf is the common inside; meshes are compared with whole numbers.
pub(crate) fn surfaces(leaf: &Leaf) -> Vec<Surface> {
    let wall = leaf.wall().map(Surface::revolved);
    let planes = leaf.planes().into_iter();
    let planes = planes.map(|(normal, offset)| Surface::plane(normal.to_array(), offset));
    let all: Vec<Surface> = wall.into_iter().chain(planes).collect();
    assert!(!all.is_empty(), "{leaf:?} has no equations");
    all
}
