//! Where a line really enters and leaves a convex solid: the same questions in numbers of
//! 200 bits.

use glam::DVec3;
use solidray::Ray;

use crate::real::{Real, Vector};

/// The points with `Σ squareᵢ pᵢ² + 2 slope · p + constant ≤ 0`: a quadric or a half-space.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    square: DVec3,
    slope: Vector,
    constant: Real,
}

impl Surface {
    /// `x² + y² ≤ a z² + 2 b z + c`
    pub(crate) fn revolved(a: f64, b: f64, c: f64) -> Self {
        let slope = Vector::exact(DVec3::new(0.0, 0.0, -b));
        Self { square: DVec3::new(1.0, 1.0, -a), slope, constant: Real::exact(-c) }
    }

    /// `normal · p ≤ normal · point`
    pub(crate) fn plane(normal: DVec3, point: DVec3) -> Self {
        let normal = Vector::exact(normal);
        let constant = -normal.dot(&Vector::exact(point));
        Self { square: DVec3::ZERO, slope: normal.times(&Real::exact(0.5)), constant }
    }

    /// Where a line is inside. It is assumed to go in and out, and half-spaces either.
    fn inside(&self, origin: &Vector, dir: &Vector) -> [Option<Real>; 2] {
        let square = Vector::exact(self.square);
        let weigh = |v: &Vector| Vector(std::array::from_fn(|i| &square.0[i] * &v.0[i]));
        let a = weigh(dir).dot(dir);
        let b = weigh(origin).dot(dir) + self.slope.dot(dir);
        let two = Real::exact(2.0);
        let c = weigh(origin).dot(origin) + two * self.slope.dot(origin) + &self.constant;
        if a.is_zero() {
            if b.is_zero() {
                return [None, None];
            }
            let root = -(c / (Real::exact(2.0) * &b));
            return if b.is_negative() { [Some(root), None] } else { [None, Some(root)] };
        }
        let root = (b.squared() - &a * c).sqrt();
        [Some((-b.clone() - &root) / &a), Some((-b + &root) / &a)]
    }
}

/// Where a line enters and leaves what is inside all of some surfaces, which are scaled and then moved.
pub(crate) fn ends(
    surfaces: &[Surface],
    scale: DVec3,
    offset: DVec3,
    ray: &Ray,
) -> [Real; 2] {
    let back = |v: Vector| {
        Vector(std::array::from_fn(|i| v.0[i].clone() / Real::exact(scale[i])))
    };
    let origin = back(Vector::exact(ray.origin).minus(&Vector::exact(offset)));
    let dir = back(Vector::exact(ray.dir));
    let all: Vec<[Option<Real>; 2]> =
        surfaces.iter().map(|surface| surface.inside(&origin, &dir)).collect();
    let larger = |a: Real, b: Real| if b > a { b } else { a };
    let smaller = |a: Real, b: Real| if b < a { b } else { a };
    let enter = all.iter().filter_map(|[enter, _]| enter.clone()).reduce(larger);
    let exit = all.iter().filter_map(|[_, exit]| exit.clone()).reduce(smaller);
    [enter, exit].map(|end| end.expect("the solid is bounded"))
}
