//! Products of maps, and how far rounding has moved them.

use glam::{DAffine3, DMat3, DVec3};

use super::doubt::U;

/// The product of the maps from the root of a tree to a subtree.
///
/// Beside the rounded product stand bounds on what rounding has done to it: for exact maps
/// `A`, `B` and their rounded product, the error of an entry is at most 4 u times the same
/// product of absolute values (N. J. Higham, "Accuracy and Stability of Numerical
/// Algorithms", 2002, §3.5), and errors of the factors are carried along. Factors that leave the
/// linear part as it is, the frequent translations, round nothing there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chain {
    /// The product.
    pub(crate) map: DAffine3,
    /// At most the Frobenius norm of the error of its linear part.
    linear: f64,
    /// At most the length of the error of its translation.
    translation: f64,
}

impl Chain {
    /// The product of nothing.
    pub(crate) const NOTHING: Self =
        Self { map: DAffine3::IDENTITY, linear: 0.0, translation: 0.0 };

    /// This product times one more map, which is exact.
    pub(crate) fn then(&self, inner: &DAffine3) -> Self {
        let (a, b) = (norm(&self.map.matrix3), norm(&inner.matrix3));
        let is_identity = |m: &DMat3| *m == DMat3::IDENTITY;
        let rounds = !is_identity(&self.map.matrix3) && !is_identity(&inner.matrix3);
        let moved = inner.translation.length();
        let exact = inner.translation == DVec3::ZERO;
        let map = self.map * *inner;
        let product = if rounds { 4.0 * U * a * b } else { 0.0 };
        let sum =
            if exact { 0.0 } else { 4.0 * U * (a * moved + map.translation.length()) };
        Self {
            map,
            linear: self.linear * b + product,
            translation: self.linear * moved + self.translation + sum,
        }
    }

    /// At most the Frobenius norm of the error of the linear part.
    pub(crate) fn linear_error(&self) -> f64 {
        self.linear
    }

    /// At most how far rounding has moved the image of a point this far from the origin.
    pub(crate) fn error(&self, distance: f64) -> f64 {
        self.linear * distance + self.translation
    }
}

/// The Frobenius norm.
pub(crate) fn norm(matrix: &DMat3) -> f64 {
    let largest = matrix.abs().to_cols_array().into_iter().fold(0.0, f64::max);
    if largest == 0.0 {
        return 0.0;
    }
    largest
        * matrix.to_cols_array().iter().map(|x| (x / largest).powi(2)).sum::<f64>().sqrt()
}
