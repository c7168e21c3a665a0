//! Where samples lie: rank-1 lattices in the plane and random shifts of them.

use glam::DVec2;

use crate::lanes::whole;

/// A Fibonacci lattice: `n` points of the unit square, `n` a Fibonacci number and the
/// generator the one before it.
///
/// Of all rank-1 lattices in the plane it is the most even (S. K. Zaremba, "Good lattice
/// points, discrepancy, and numerical integration", Annali di Matematica 73, 1966).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fibonacci {
    n: u64,
    generator: u64,
}

/// The largest Fibonacci number whose products with its points fit 64 bits.
const LAST: u64 = 4_807_526_976;

impl Fibonacci {
    /// The lattice with at least this many points, up to 4 807 526 976 of them.
    pub(crate) fn at_least(points: u64) -> Self {
        let (mut generator, mut n) = (1, 2);
        while n < points && n < LAST {
            (generator, n) = (n, generator + n);
        }
        Self { n, generator }
    }

    /// A larger lattice: if possible at least `wanted` times as large, and at most `most`
    /// times.
    pub(crate) fn grown(&self, wanted: f64, most: f64) -> Option<Self> {
        let n = self.n as f64;
        let mut grown = None;
        let mut next = *self;
        while next.n < LAST {
            next = Self { n: next.generator + next.n, generator: next.n };
            let factor = next.n as f64 / n;
            if factor > most {
                break;
            }
            grown = Some(next);
            if factor >= wanted {
                break;
            }
        }
        grown
    }

    /// How many points it has.
    pub(crate) fn len(&self) -> u64 {
        self.n
    }

    /// The points, moved by `shift` on the torus, of which the first coordinate is between two
    /// numbers from 0 to 1; and some more.
    pub(crate) fn between(
        &self,
        from: f64,
        to: f64,
        shift: DVec2,
    ) -> impl Iterator<Item = DVec2> {
        let n = self.n as f64;
        let first = ((from - shift.x) * n).floor() - 2.0;
        let count = ((to - from) * n).ceil() + 5.0;
        let [first, count] = [first.rem_euclid(n), count.min(n)].map(whole);
        let first = first % self.n;
        let second = first * self.generator % self.n;
        // Whole numbers, which need not be made ones of this kind at each point.
        let mut numbers = DVec2::new(first as f64, second as f64);
        let step = DVec2::new(1.0, self.generator as f64);
        (0..count).map(move |_| {
            let point = numbers / n + shift;
            numbers = less_if_reached(numbers + step, n);
            less_if_reached(point, 1.0)
        })
    }
}

/// Numbers that are less than twice some limit, less that if they reach it.
fn less_if_reached(v: DVec2, limit: f64) -> DVec2 {
    v - DVec2::select(v.cmpge(DVec2::splat(limit)), DVec2::splat(limit), DVec2::ZERO)
}

/// A number that looks random and depends on the seed and the indices alone: `SplitMix64`
/// (G. L. Steele, D. Lea, C. H. Flood, "Fast Splittable Pseudorandom Number Generators",
/// OOPSLA 2014), fed with one after the other.
pub(crate) fn hash(seed: u64, indices: &[u64]) -> u64 {
    indices.iter().fold(mix(seed), |h, &i| mix(h ^ mix(i)))
}

fn mix(x: u64) -> u64 {
    let z = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// A number in [0, 1) of 53 bits.
pub(crate) fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lattice_has_every_row_and_column_once() {
        let lattice = Fibonacci::at_least(100);
        assert_eq!(lattice.len(), 144);
        let mut rows: Vec<f64> =
            lattice.between(0.0, 1.0, DVec2::ZERO).map(|p| p.y).collect();
        assert_eq!(rows.len(), 144);
        rows.sort_by(f64::total_cmp);
        for (i, y) in rows.into_iter().enumerate() {
            assert!((y - i as f64 / 144.0).abs() < 1e-15);
        }
    }

    #[test]
    fn the_largest_lattice_does_not_overflow() {
        let lattice = Fibonacci::at_least(u64::MAX);
        let last = 1.0 - 1.0 / lattice.len() as f64;
        for p in lattice.between(last, 1.0, DVec2::ZERO).take(3) {
            assert!(p.min_element() > 0.0 && p.max_element() < 1.0, "{p}");
        }
    }

    #[test]
    fn units_are_in_range_and_differ() {
        let units: Vec<f64> = (0..1000).map(|i| unit(hash(7, &[i, 3]))).collect();
        assert!(units.iter().all(|u| (0.0..1.0).contains(u)));
        let mean = units.iter().sum::<f64>() / 1000.0;
        assert!((mean - 0.5).abs() < 0.05, "{mean}");
    }
}
