//! Quadratic polynomials of three variables: the equations of surfaces.

use glam::{DMat3, DVec3};

/// `p · M p + l · p + c`; the variables are called u, v and w.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Form {
    /// M, symmetric.
    pub(super) square: DMat3,
    /// l.
    pub(super) linear: DVec3,
    /// c.
    pub(super) constant: f64,
}

impl Form {
    /// From the coefficients of u², v², w², uv, vw, wu, u, v, w and 1.
    pub(super) fn new(coefficients: &[f64; 10]) -> Self {
        let [uu, vv, ww, uv, vw, wu, u, v, w, constant] = *coefficients;
        let square = DMat3::from_cols(
            DVec3::new(uu, 0.5 * uv, 0.5 * wu),
            DVec3::new(0.5 * uv, vv, 0.5 * vw),
            DVec3::new(0.5 * wu, 0.5 * vw, ww),
        );
        Self { square, linear: DVec3::new(u, v, w), constant }
    }

    /// An affine function as a form.
    fn affine(linear: DVec3, constant: f64) -> Self {
        Self { square: DMat3::ZERO, linear, constant }
    }

    pub(super) fn value(&self, p: DVec3) -> f64 {
        p.dot(self.square * p) + self.linear.dot(p) + self.constant
    }

    pub(super) fn gradient(&self, p: DVec3) -> DVec3 {
        2.0 * (self.square * p) + self.linear
    }

    /// The derivative along an axis, which is affine.
    pub(super) fn derivative(&self, axis: usize) -> Self {
        Self::affine(2.0 * self.square.col(axis), self.linear[axis])
    }

    /// The product of two affine functions.
    fn product(a: &Self, b: &Self) -> Self {
        let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
        Self {
            square: 0.5 * (outer(a.linear, b.linear) + outer(b.linear, a.linear)),
            linear: a.constant * b.linear + b.constant * a.linear,
            constant: a.constant * b.constant,
        }
    }

    /// Zero where slices u = constant of two surfaces are tangent to each other: the
    /// determinant of their derivatives along v and w.
    pub(super) fn tangency(a: &Self, b: &Self) -> Self {
        let [av, aw, bv, bw] =
            [(a, 1), (a, 2), (b, 1), (b, 2)].map(|(form, axis)| form.derivative(axis));
        Self::product(&av, &bw).plus(-1.0, &Self::product(&aw, &bv))
    }

    /// This and a multiple of another.
    pub(super) fn plus(&self, factor: f64, other: &Self) -> Self {
        Self {
            square: self.square + factor * other.square,
            linear: self.linear + factor * other.linear,
            constant: self.constant + factor * other.constant,
        }
    }

    /// The scalar product of the coefficients of two forms.
    pub(super) fn dot(&self, other: &Self) -> f64 {
        let squares: f64 =
            (0..3).map(|i| self.square.col(i).dot(other.square.col(i))).sum();
        squares + self.linear.dot(other.linear) + self.constant * other.constant
    }

    /// The multiple of which the coefficients have length 1; none of zero.
    pub(super) fn normalized(&self) -> Option<Self> {
        let largest = (0..3)
            .map(|i| self.square.col(i))
            .chain([self.linear, DVec3::splat(self.constant)])
            .fold(0.0, |m: f64, v| m.max(v.abs().max_element()));
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        let level = self.times(1.0 / largest);
        Some(level.times(1.0 / level.dot(&level).sqrt()))
    }

    fn times(&self, factor: f64) -> Self {
        Self {
            square: factor * self.square,
            linear: factor * self.linear,
            constant: factor * self.constant,
        }
    }
}
