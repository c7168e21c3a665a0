//! Where samples lie: rank-1 lattices in the plane and random shifts of them.

use glam::DVec2;
use pulp::Simd;

use crate::lanes::{Lanes, Vector, whole};

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

    /// The numbers of the points that, moved by `shift` on the torus, have a first coordinate
    /// between two numbers from 0 to 1, and of some more: the first one and how many there are.
    pub(crate) fn between(&self, from: f64, to: f64, shift: DVec2) -> (u64, u64) {
        let n = self.n as f64;
        let first = ((from - shift.x) * n).floor() - 2.0;
        let count = ((to - from) * n).ceil() + 5.0;
        let [first, count] = [first.rem_euclid(n), count.min(n)].map(whole);
        (first % self.n, count)
    }
}

/// The points of a lattice, moved on the torus: as many at once as the machine computes, one
/// lot after the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Points<S: Simd> {
    /// For each coordinate a whole number, to be divided by how many points there are.
    numbers: [Vector<S>; 2],
    step: [Vector<S>; 2],
    n: Vector<S>,
    shift: [Vector<S>; 2],
}

/// The most numbers that a machine computes at once.
pub(crate) const MOST_LANES: usize = 8;

impl<S: Simd> Points<S> {
    /// From the point with some number on.
    #[inline(always)]
    pub(crate) fn new(simd: S, lattice: &Fibonacci, first: u64, shift: DVec2) -> Self {
        let Fibonacci { n, generator } = *lattice;
        let mut starts = [[0.0; MOST_LANES]; 2];
        let [x, y] = &mut starts;
        for ((x, y), number) in x.iter_mut().zip(y).zip(first..) {
            let number = number % n;
            (*x, *y) = (number as f64, (number * generator % n) as f64);
        }
        let step = S::F64_LANES as u64 % n;
        let same = |x: f64| Vector(simd, simd.splat_f64s(x));
        Self {
            numbers: starts.each_ref().map(|s| Vector(simd, S::as_simd_f64s(s).0[0])),
            step: [same(step as f64), same((step * generator % n) as f64)],
            n: same(n as f64),
            shift: [same(shift.x), same(shift.y)],
        }
    }

    /// The next ones.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> [Vector<S>; 2] {
        let Self { numbers: [x, y], step, n, shift } = *self;
        let one = n.same(1.0);
        self.numbers = [less_if_reached(x + step[0], n), less_if_reached(y + step[1], n)];
        [less_if_reached(x / n + shift[0], one), less_if_reached(y / n + shift[1], one)]
    }
}

/// Numbers that are less than twice some limit, less that if they reach it.
#[inline(always)]
fn less_if_reached<L: Lanes>(x: L, limit: L) -> L {
    x - L::select(x.less(limit), x.same(0.0), limit)
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
    use pulp::{Arch, WithSimd};

    use super::*;

    struct Find {
        lattice: Fibonacci,
        first: u64,
        count: usize,
        shift: DVec2,
    }

    impl WithSimd for Find {
        type Output = Vec<DVec2>;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Vec<DVec2> {
            let mut points = Points::new(simd, &self.lattice, self.first, self.shift);
            let mut found = Vec::new();
            while found.len() < self.count {
                let [x, y] = points.next();
                let mut numbers = [[0.0; MOST_LANES]; 2];
                for (numbers, lot) in numbers.iter_mut().zip([x, y]) {
                    S::as_mut_simd_f64s(numbers).0[0] = lot.1;
                }
                let [x, y] = numbers;
                found.extend((0..S::F64_LANES).map(|k| DVec2::new(x[k], y[k])));
            }
            found.truncate(self.count);
            found
        }
    }

    fn points(
        arch: Arch,
        lattice: Fibonacci,
        (first, count): (u64, u64),
        shift: DVec2,
    ) -> Vec<DVec2> {
        let count = usize::try_from(count).unwrap();
        arch.dispatch(Find { lattice, first, count, shift })
    }

    #[test]
    fn the_lattice_has_every_row_and_column_once() {
        let lattice = Fibonacci::at_least(100);
        assert_eq!(lattice.len(), 144);
        let range = lattice.between(0.0, 1.0, DVec2::ZERO);
        let points = points(Arch::new(), lattice, range, DVec2::ZERO);
        assert_eq!(points.len(), 144);
        for axis in 0..2 {
            let mut places: Vec<f64> = points.iter().map(|p| p[axis]).collect();
            places.sort_by(f64::total_cmp);
            for (i, place) in places.into_iter().enumerate() {
                assert!((place - i as f64 / 144.0).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn the_largest_lattice_does_not_overflow() {
        let lattice = Fibonacci::at_least(u64::MAX);
        let last = 1.0 - 1.0 / lattice.len() as f64;
        let (first, _) = lattice.between(last, 1.0, DVec2::ZERO);
        for p in points(Arch::new(), lattice, (first, 3), DVec2::ZERO) {
            assert!(p.min_element() > 0.0 && p.max_element() < 1.0, "{p}");
        }
    }

    /// Side by side, one by one, and as the definition has them, from lattices with fewer points
    /// than a machine computes at once to the largest.
    #[test]
    fn points_are_the_same_side_by_side() {
        for least in [2, 3, 5, 233, 1_000_000, u64::MAX] {
            let lattice = Fibonacci::at_least(least);
            let (n, shift) = (lattice.len(), DVec2::new(0.731, 0.25));
            for first in [0, n / 3, n - 1] {
                let expected: Vec<DVec2> = (0..100)
                    .map(|k| {
                        let number = (first + k) % n;
                        let second = number * lattice.generator % n;
                        let point = DVec2::new(number as f64, second as f64) / n as f64;
                        let point = point + shift;
                        point
                            - DVec2::select(
                                point.cmpge(DVec2::ONE),
                                DVec2::ONE,
                                DVec2::ZERO,
                            )
                    })
                    .collect();
                for arch in [Arch::new(), Arch::Scalar] {
                    assert_eq!(points(arch, lattice, (first, 100), shift), expected);
                }
            }
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
