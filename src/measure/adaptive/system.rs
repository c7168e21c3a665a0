//! Where three surfaces meet: all common zeros of three quadratic polynomials in a box.
//!
//! Boxes are cut in halves until each is shown to hold no zero or is handed to Newton's
//! method. About the middle of a box a quadratic polynomial is *exactly* `f + g · d + d · M d`,
//! so every zero at a distance d satisfies `d = −J⁻¹ (f + d · M d)`, of which the right-hand
//! side is enclosed by absolute values: the box shrinks to that enclosure, is empty, or, where
//! the quadratic part is small against it, holds one zero at most (R. Krawczyk,
//! "Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken", Computing 4, 1969;
//! A. Neumaier, "Interval Methods for Systems of Equations", Cambridge 1990, ch. 5).

use glam::{DMat3, DVec3};

use super::form::Form;
use crate::aabb::Aabb;

/// Common zeros.
#[derive(Debug, Default)]
pub(super) struct Zeros {
    pub(super) points: Vec<Zero>,
    /// Whether the search was given up, which it is where there is a whole curve of zeros.
    pub(super) given_up: bool,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Zero {
    pub(super) point: DVec3,
    /// Whether the surfaces cross there, not only touch.
    pub(super) regular: bool,
}

/// Two thirds of all isolated zeros are found within a few dozen boxes; where surfaces touch
/// at a point it takes a thousand. A curve of zeros would take as many as are allowed.
const MOST_BOXES: usize = 4096;

/// Boxes that are smaller than this and can hold a zero are a zero: values are rounded by
/// about 1e-15, and where surfaces touch that hides distances of its square root.
const SMALLEST: f64 = 1.0 / 4_194_304.0;

/// More than the rounding of a value of a form with coefficients of length 1, at points with
/// coordinates up to 2.
const VALUE_ROUNDING: f64 = 1e-14;

/// What is left of a form when its part along another is taken off is nothing if it is not
/// longer than this: then both are one surface.
const SAME: f64 = 1e-12;

/// The common zeros in the part of a box that `is_wanted`, which may say yes too often of
/// the boxes that it is asked about.
pub(super) fn zeros(
    forms: [&Form; 3],
    within: &Aabb,
    is_wanted: impl Fn(&Aabb) -> bool,
) -> Zeros {
    let mut zeros = Zeros::default();
    let Some(forms) = orthonormal(forms) else { return zeros };
    let mut open = vec![(within.center(), 0.5 * within.size())];
    let mut boxes = 0;
    while let Some((center, half)) = open.pop() {
        boxes += 1;
        if boxes > MOST_BOXES {
            zeros.given_up = true;
            // Points of a curve are no more critical than others.
            zeros.points.retain(|zero| zero.regular);
            break;
        }
        if !is_wanted(&Aabb::new(center - half, center + half)) {
            continue;
        }
        match narrowed(&forms, center, half) {
            Narrowed::Empty => {}
            Narrowed::One(start) => {
                let point = newton(&forms, start);
                // A zero beside the box is that of the box beside.
                let is_here = (point - center).abs().cmple(1.001 * half).all();
                if is_here && zeros.is_new(point) {
                    zeros.points.push(Zero { point, regular: true });
                }
            }
            Narrowed::Box(center, half) if half.max_element() < SMALLEST => {
                let nearer = newton(&forms, center);
                let is_near = (nearer - center).length() < 64.0 * SMALLEST;
                let point = if is_near { nearer } else { center };
                if zeros.is_new(point) {
                    zeros.points.push(Zero { point, regular: false });
                }
            }
            Narrowed::Box(center, half) => {
                let mut quarter = DVec3::ZERO;
                quarter[half.max_position()] = 0.5 * half.max_element();
                let half = half - quarter;
                open.extend([(center - quarter, half), (center + quarter, half)]);
            }
        }
    }
    zeros
}

impl Zeros {
    fn is_new(&self, point: DVec3) -> bool {
        self.points.iter().all(|zero| (zero.point - point).length() > 8.0 * SMALLEST)
    }
}

/// Forms with the same common zeros, orthogonal to each other: two surfaces that are almost
/// the same become one of them and what sets them apart. None if there is nothing.
fn orthonormal(forms: [&Form; 3]) -> Option<[Form; 3]> {
    let [a, b, c] = forms;
    let a = a.normalized()?;
    let b = b.normalized()?;
    let without = |form: Form, other: &Form| form.plus(-form.dot(other), other);
    let rest =
        |form: Form| (form.dot(&form) > SAME * SAME).then(|| form.normalized()).flatten();
    let b = rest(without(b, &a))?;
    let b = rest(without(b, &a))?;
    let c = rest(without(without(c.normalized()?, &a), &b))?;
    let c = rest(without(without(c, &a), &b))?;
    Some([a, b, c])
}

enum Narrowed {
    Empty,
    /// All that can hold zeros.
    Box(DVec3, DVec3),
    /// There is one zero at most; Newton's method finds it from here.
    One(DVec3),
}

/// The inverse of the matrix with these rows; not finite if there is none.
fn inverse_of_rows(a: DVec3, b: DVec3, c: DVec3) -> DMat3 {
    DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b)) * (1.0 / a.cross(b).dot(c))
}

fn narrowed(forms: &[Form; 3], center: DVec3, half: DVec3) -> Narrowed {
    let (mut center, mut half) = (center, half);
    /// A box is narrowed again only if that made it smaller by half.
    const WORTH: f64 = 0.5;
    /// Cells shrink by half each time.
    const TIMES: usize = 64;
    for _ in 0..TIMES {
        let values = DVec3::from_array([0, 1, 2].map(|i| forms[i].value(center)));
        let gradients = [0, 1, 2].map(|i| forms[i].gradient(center));
        let bends = DVec3::from_array(
            [0, 1, 2].map(|i| half.dot(forms[i].square.abs() * half) + VALUE_ROUNDING),
        );
        let reach = DVec3::from_array([0, 1, 2].map(|i| gradients[i].abs().dot(half)));
        if values.abs().cmpgt(reach + bends).any() {
            return Narrowed::Empty;
        }
        let [a, b, c] = gradients;
        let inverse = inverse_of_rows(a, b, c);
        if !inverse.is_finite() {
            return Narrowed::Box(center, half);
        }
        let middle = -(inverse * values);
        let radius = inverse.abs() * bends;
        let low = (middle - radius).max(-half);
        let high = (middle + radius).min(half);
        if low.cmpgt(high).any() {
            return Narrowed::Empty;
        }
        if radius.cmple(0.25 * half).all() {
            return Narrowed::One(center + middle);
        }
        let before = half;
        center += 0.5 * (low + high);
        half = 0.5 * (high - low);
        if half.max_element() > WORTH * before.max_element() {
            break;
        }
        if half.max_element() < SMALLEST {
            break;
        }
    }
    Narrowed::Box(center, half)
}

/// A few of Newton's steps: quadratic convergence takes no more to all digits.
fn newton(forms: &[Form; 3], start: DVec3) -> DVec3 {
    const STEPS: usize = 6;
    let mut point = start;
    for _ in 0..STEPS {
        let values = DVec3::from_array([0, 1, 2].map(|i| forms[i].value(point)));
        let [a, b, c] = [0, 1, 2].map(|i| forms[i].gradient(point));
        let step = inverse_of_rows(a, b, c) * values;
        if !step.is_finite() {
            break;
        }
        point -= step;
    }
    point
}
