//! Integrals over a solid and its surface, chord by chord.

use glam::{DMat3, DVec3};

/// How many integrals there are.
pub(super) const COUNT: usize = 11;

/// Over a solid: 1, then x, y, z, then x², y², z², xy, yz, zx; and over its surface: 1.
/// Coordinates count from a centre that is the same for all that is added up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Integrals(pub(super) [f64; COUNT]);

/// The number of the integral of 1 over the surface.
const AREA: usize = 10;

/// The axes of the products of two coordinates.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]];

impl Integrals {
    /// Those along a chord that begins at a place, `length` steps long.
    ///
    /// A product of two coordinates is a polynomial of degree two along a line, whose integral
    /// is that at the middle and a twelfth of what the ends are apart.
    #[inline]
    pub(super) fn add_chord(&mut self, begin: DVec3, step: DVec3, length: f64) {
        let (way, sums) = (length * step, &mut self.0);
        let middle = begin + 0.5 * way;
        sums[0] += length;
        for axis in 0..3 {
            sums[1 + axis] += length * middle[axis];
        }
        for (sum, [i, j]) in sums[4..].iter_mut().zip(PAIRS) {
            *sum += length * (middle[i] * middle[j] + way[i] * way[j] / 12.0);
        }
    }

    pub(super) fn add_area(&mut self, area: f64) {
        self.0[AREA] += area;
    }

    /// What is inside times one factor, and the surface times another.
    #[must_use]
    pub(super) fn scaled(mut self, inside: f64, surface: f64) -> Self {
        for sum in &mut self.0[..AREA] {
            *sum *= inside;
        }
        self.0[AREA] *= surface;
        self
    }

    pub(super) fn add(&mut self, other: &Self) {
        for (sum, other) in self.0.iter_mut().zip(other.0) {
            *sum += other;
        }
    }

    /// The same integrals with coordinates that count from elsewhere: from where the old centre
    /// is at `center`.
    #[must_use]
    pub(super) fn seen_from(&self, center: DVec3) -> Self {
        let mut seen = *self;
        let first = self.first() + center * self.volume();
        let second = self.second_about(-center);
        seen.0[1..4].copy_from_slice(&first.to_array());
        for (x, [i, j]) in seen.0[4..AREA].iter_mut().zip(PAIRS) {
            *x = second.col(j)[i];
        }
        seen
    }

    pub(super) fn volume(&self) -> f64 {
        self.0[0]
    }

    /// The integrals of x, y and z.
    pub(super) fn first(&self) -> DVec3 {
        DVec3::new(self.0[1], self.0[2], self.0[3])
    }

    /// The integrals of the products of two coordinates.
    pub(super) fn second(&self) -> DMat3 {
        let mut matrix = DMat3::ZERO;
        for (x, [i, j]) in self.0[4..].iter().zip(PAIRS) {
            matrix.col_mut(i)[j] = *x;
            matrix.col_mut(j)[i] = *x;
        }
        matrix
    }

    /// The same products seen from another point.
    pub(super) fn second_about(&self, point: DVec3) -> DMat3 {
        let (first, second) = (self.first(), self.second());
        let outer = |a: DVec3, b: DVec3| DMat3::from_cols(b.x * a, b.y * a, b.z * a);
        second - outer(first, point) - outer(point, first)
            + outer(point, point) * self.volume()
    }

    pub(super) fn area(&self) -> f64 {
        self.0[AREA]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    /// A chord from (1, 2, 3) to (3, 2, −1), by antiderivatives.
    #[test]
    fn chords_integrate_products_exactly() {
        let mut sums = Integrals::default();
        sums.add_chord(dvec3(1.0, 2.0, 3.0), dvec3(0.5, 0.0, -1.0), 4.0);
        let expected = [
            4.0,
            8.0,
            8.0,
            4.0,
            4.0 * (1.0 + 3.0 + 9.0) / 3.0,
            16.0,
            4.0 * 7.0 / 3.0,
            16.0,
            8.0,
            16.0 / 3.0,
            0.0,
        ];
        for (sum, expected) in sums.0.into_iter().zip(expected) {
            assert!((sum - expected).abs() < 1e-14, "{sum} {expected}");
        }
        let about = sums.second_about(dvec3(2.0, 2.0, 1.0));
        let expected =
            [[4.0 / 3.0, 0.0, -8.0 / 3.0], [0.0; 3], [-8.0 / 3.0, 0.0, 16.0 / 3.0]];
        for (i, row) in expected.into_iter().enumerate() {
            for (j, expected) in row.into_iter().enumerate() {
                assert!((about.col(j)[i] - expected).abs() < 1e-13, "{i} {j}: {about}");
            }
        }
    }
}
