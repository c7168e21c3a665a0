//! How far rounding can have moved a crossing.
//!
//! # The bound
//!
//! Near a place on a line every face is the zero of a function `F`, linear or quadratic in
//! `t`. The kernel finds a zero of a function that differs from the true one by at most ε
//! there; ε is the sum of what each rounding on the way can have done, to first order in
//! u = 2⁻⁵³ with constants that leave room for the rest:
//!
//! - of the maps multiplied out, of their inverse, of planes and of surfaces that were
//!   made one: a displacement of the surface found when the scene is compiled (`slack`);
//! - of the line: its origin was moved to a reference point;
//! - of the point seen from the leaf: the inverse map times a difference;
//! - of the coefficients of `F` along the line and its root.
//!
//! With slope s and half second derivative A at the place, the true zero is then at most
//!
//! ```text
//! 2 E / (s + √(s² − 4 A E))        E = |F| + ε
//! ```
//!
//! away: ε / s where the line runs steeply into the face. Where `s² ≤ 4 A E` the line grazes
//! it; the zeros on both sides of the vertex of the parabola, if it has any, are within
//! `(s + √(s² + 4 A E)) / 2 A`: of the order √(ε / A). (The forward error from the backward
//! error: N. J. Higham, "Accuracy and Stability of Numerical Algorithms", 2002, §1.6.)
//!
//! At an edge of a leaf it may be the neighbouring face that the true line passes; so the
//! bound of a crossing is the largest of all faces of the leaf that are as near as rounding.

use super::Line;
pub(crate) use crate::rounded::U;

/// A place on a line from which the faces of a leaf are looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot<'a> {
    pub(crate) line: &'a Line,
    pub(crate) t: f64,
    /// At most how far the surfaces of the leaf lie beside the true ones.
    pub(crate) slack: f64,
}

/// The function of which a face is the zero, at a place on a line: positive outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local {
    pub(crate) value: f64,
    /// At most how far the true value is from this one, ε.
    pub(crate) rounding: f64,
    /// The derivative along the line.
    pub(crate) slope: f64,
    pub(crate) slope_rounding: f64,
    /// Half the second derivative.
    pub(crate) bend: f64,
    pub(crate) bend_rounding: f64,
}

impl Local {
    /// Whether the place may be on the face.
    pub(crate) fn is_near(&self) -> bool {
        self.value.abs() <= ROOM * self.rounding
    }

    /// Whether the place is certainly outside.
    pub(crate) fn is_outside(&self) -> bool {
        self.value > ROOM * self.rounding
    }

    /// At most how far along the line the true zero is.
    pub(crate) fn reach(&self) -> f64 {
        let error = self.value.abs() + self.rounding;
        let steep = (self.slope.abs() - self.slope_rounding).max(0.0);
        let bend = self.bend.abs() + self.bend_rounding;
        let discriminant = steep * steep - 4.0 * bend * error;
        if discriminant > 0.0 {
            return 2.0 * error / (steep + discriminant.sqrt());
        }
        let steep = self.slope.abs() + self.slope_rounding;
        let bend = (self.bend.abs() - self.bend_rounding).max(0.0);
        if bend == 0.0 {
            // A line within rounding of a plane and along it.
            return f64::INFINITY;
        }
        (steep + (steep * steep + 4.0 * bend * error).sqrt()) / (2.0 * bend)
    }
}

/// A place that a line finds on one side of a face can be on the other if it is as near as
/// the error of the crossing times the slope there, which is 2 ε at most and not 1: both ends
/// of the way are rounded.
const ROOM: f64 = 4.0;
