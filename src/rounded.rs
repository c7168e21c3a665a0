//! Numbers that know how far rounding can have moved them.

use std::ops::{Add, Mul, Sub};

/// The unit of rounding, 2⁻⁵³.
pub(crate) const U: f64 = 0.5 * f64::EPSILON;

/// A number, and at most how far the true one is from it.
///
/// Arithmetic of middles and radii (S. M. Rump, "Fast and Parallel Interval Arithmetic", BIT
/// 39(3), 1999): each operation adds what its own rounding can do. The errors themselves are
/// sums and products of positive numbers, each rounded by at most 4 u, for which
/// [`Rounded::with`] leaves room; and for products too small to be normal numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rounded {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

impl Rounded {
    pub(crate) const ZERO: Self = Self::exact(0.0);

    /// π is off by less than half a unit in its last place.
    pub(crate) const PI: Self = Self { value: std::f64::consts::PI, error: f64::EPSILON };

    /// A sixth.
    pub(crate) const SIXTH: Self = Self { value: 1.0 / 6.0, error: f64::EPSILON };

    /// A number without error.
    pub(crate) const fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// A number that a few operations have made of what was said.
    pub(crate) fn nearly(value: f64) -> Self {
        Self { value, error: 8.0 * U * value.abs() }
    }

    /// What an operation has made, before its own rounding counts.
    fn with(value: f64, error: f64) -> Self {
        let rounding = U * value.abs() + f64::MIN_POSITIVE;
        Self { value, error: (error + rounding) * (1.0 + 8.0 * U) }
    }

    /// Where the true number is.
    pub(crate) fn interval(self) -> [f64; 2] {
        [(self.value - self.error).next_down(), (self.value + self.error).next_up()]
    }
}

impl Add for Rounded {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::with(self.value + other.value, self.error + other.error)
    }
}

impl Sub for Rounded {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::with(self.value - other.value, self.error + other.error)
    }
}

impl Mul for Rounded {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let error = self.value.abs() * other.error
            + self.error * other.value.abs()
            + self.error * other.error;
        Self::with(self.value * other.value, error)
    }
}

/// A sum of many numbers, of which it does not matter how many they are.
///
/// What each addition loses is added up beside (A. Neumaier, "Rundungsfehleranalyse einiger
/// Verfahren zur Summation endlicher Summen", ZAMM 54, 1974). For n numbers the error is at
/// most u times the sum and 2 (n u)² times the sum of absolute values (T. Ogita, S. M. Rump,
/// S. Oishi, "Accurate Sum and Dot Product", SIAM Journal on Scientific Computing 26(6),
/// 2005).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sum {
    value: f64,
    lost: f64,
    absolute: f64,
    error: f64,
    count: f64,
}

impl Sum {
    pub(crate) fn add(&mut self, term: Rounded) {
        let (x, sum) = (term.value, self.value + term.value);
        self.lost += if self.value.abs() < x.abs() {
            (x - sum) + self.value
        } else {
            (self.value - sum) + x
        };
        self.value = sum;
        self.absolute += x.abs();
        self.error += term.error;
        self.count += 1.0;
    }

    /// The sum. There is room for the rounding of the sums of errors and of absolute values,
    /// which is at most a thousandth for 2⁴⁰ terms.
    pub(crate) fn total(&self) -> Rounded {
        let part = U * self.count;
        let rounding = 2.0 * U * self.value.abs() + 4.0 * part * part * self.absolute;
        Rounded::with(self.value + self.lost, 1.001 * self.error + rounding)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_hold_what_is_lost() {
        let mut sum = Sum::default();
        for term in [1.0, 1e100, 1.0, -1e100] {
            sum.add(Rounded::exact(term));
        }
        let [low, high] = sum.total().interval();
        assert!(low <= 2.0 && 2.0 <= high);
        let third = Rounded::nearly(1.0 / 3.0);
        let one = third + third + third;
        assert!(one.error < 1e-14 && (one.value - 1.0).abs() <= one.error);
    }
}
