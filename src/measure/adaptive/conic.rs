//! What is left of a surface in a slice.

use super::form::Form;
use super::polynomial::{Polynomial, product};

/// A conic or a line, `a w² + b(v) w + c(v) = 0`, where b is of degree one and c of degree two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conic {
    a: f64,
    b: [f64; 2],
    c: [f64; 3],
}

/// A coefficient that is no larger than this in a form with coefficients of length 1 is zero
/// but for rounding.
const NOTHING: f64 = 1e-14;

impl Conic {
    /// The slice of a form at a height u.
    pub(super) fn new(form: &Form, u: f64) -> Self {
        let Form { square: m, linear: l, constant } = form;
        Self {
            a: m.z_axis.z,
            b: [2.0 * m.x_axis.z * u + l.z, 2.0 * m.y_axis.z],
            c: [
                (m.x_axis.x * u + l.x) * u + constant,
                2.0 * m.x_axis.y * u + l.y,
                m.y_axis.y,
            ],
        }
    }

    /// Zero at the places v where two conics meet: the resultant of both as polynomials in w
    /// (D. Cox, J. Little, D. O'Shea, "Ideals, Varieties, and Algorithms", Springer, section 3.6).
    pub(super) fn resultant(&self, other: &Self) -> Polynomial {
        let (p, q) = (self, other);
        let minus = |x: Polynomial, y: Polynomial| -> Polynomial {
            std::array::from_fn(|i| x[i] - y[i])
        };
        let bc = minus(product(&p.b, &q.c), product(&p.c, &q.b));
        if p.a == 0.0 && q.a == 0.0 {
            return bc;
        }
        let ac = minus(product(&[p.a], &q.c), product(&p.c, &[q.a]));
        let ab = minus(product(&[p.a], &q.b), product(&p.b, &[q.a]));
        minus(product(&ac[..3], &ac[..3]), product(&ab[..2], &bc[..4]))
    }

    /// The w of the points at v, the same twice where there is one; where there is none
    /// the real part of both. Nothing at a line along w.
    pub(super) fn heights(&self, v: f64) -> Option<[f64; 2]> {
        let Self { a, b, c } = *self;
        let b = b[0] + v * b[1];
        let c = c[0] + v * (c[1] + v * c[2]);
        if a.abs() <= NOTHING {
            return Some([-c / b; 2]).filter(|w| w[0].is_finite());
        }
        let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
        let q = -0.5 * (b + root.copysign(b));
        let one = q / a;
        let other = if q == 0.0 { one } else { c / q };
        Some([one, other]).filter(|w| w.iter().all(|w| w.is_finite()))
    }

    /// The places v where lines along w touch the conic, none for a line. Where such a place is
    /// complex, as beside the waist of a hyperbola, it is the real part, twice.
    pub(super) fn sides(&self) -> Option<[f64; 2]> {
        let Self { a, b, c } = *self;
        if a.abs() <= NOTHING {
            return None;
        }
        // b² − 4 a c as r v² + 2 s v + t.
        let r = b[1] * b[1] - 4.0 * a * c[2];
        let s = b[0] * b[1] - 2.0 * a * c[1];
        let t = b[0] * b[0] - 4.0 * a * c[0];
        let discriminant = s * s - r * t;
        if discriminant <= 0.0 {
            return Some([-s / r; 2]);
        }
        let q = -(s + discriminant.sqrt().copysign(s));
        Some([q / r, t / q])
    }
}
