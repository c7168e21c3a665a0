//! Planes and quadrics in numbers of 200 bits.

use super::real::{Real, Vector};
use crate::support::model::Leaf;

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

/// The surfaces of which a leaf is the common inside.
pub(crate) fn surfaces(leaf: &Leaf) -> Vec<Surface> {
    let zero = || exact(0.0);
    let square = |x: f64| exact(x).squared();
    match *leaf {
        Leaf::Cuboid { min, max } => (0..3)
            .flat_map(|axis| {
                let mut normal = [0.0; 3];
                normal[axis] = 1.0;
                let above = Surface::plane(normal.map(|x| -x), -min[axis]);
                [above, Surface::plane(normal, max[axis])]
            })
            .collect(),
        Leaf::HalfSpace { normal, offset } => {
            vec![Surface::plane(normal.to_array(), offset)]
        }
        Leaf::Ball { radius } => {
            vec![Surface::revolved([exact(-1.0), zero(), square(radius)])]
        }
        Leaf::Cylinder { radius, height } => {
            cut(Surface::revolved([zero(), zero(), square(radius)]), [0.0, height])
        }
        Leaf::Frustum { bottom, top, height } => {
            let slope = (exact(top) - exact(bottom)) / exact(height);
            let wall = [slope.squared(), exact(bottom) * &slope, square(bottom)];
            cut(Surface::revolved(wall), [0.0, height])
        }
        Leaf::Paraboloid { radius, height } => {
            let growth = square(radius) / (exact(2.0) * exact(height));
            cut(Surface::revolved([zero(), growth, zero()]), [0.0, height])
        }
        Leaf::OneSheet { waist, radius, height } => {
            let half = exact(0.5 * height);
            let growth = (square(radius) - square(waist)) / half.squared();
            let wall = Surface::revolved([growth, zero(), square(waist)]);
            cut(wall, [-0.5 * height, 0.5 * height])
        }
        Leaf::TwoSheets { vertex, slope, height } => {
            let least = -(square(slope) * square(vertex));
            let wall = Surface::revolved([square(slope), zero(), least]);
            cut(wall, [-0.5 * height, 0.5 * height])
        }
        Leaf::Mesh(_) => unreachable!("meshes are compared with whole numbers"),
    }
}

/// A wall between two heights.
fn cut(wall: Surface, [bottom, top]: [f64; 2]) -> Vec<Surface> {
    let above = Surface::plane([0.0, 0.0, -1.0], -bottom);
    vec![wall, above, Surface::plane([0.0, 0.0, 1.0], top)]
}
