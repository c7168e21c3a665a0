//! How likely something is that was counted.
//!
//! Where few were counted, or few were not, the interval is that of C. J. Clopper, E. S.
//! Pearson, "The Use of Confidence or Fiducial Limits Illustrated in the Case of the
//! Binomial", Biometrika 26(4), 1934: it holds with 95 % at least, whatever the truth. From
//! a hundred of each on it is that of E. B. Wilson, "Probable Inference, the Law of
//! Succession, and Statistical Inference", JASA 22(158), 1927: there it is as good, it is
//! narrower, and takes no sums. Wilson's alone would hold in 84 % of cases only where 0.2 are
//! expected.

/// From this many on counts are all but normal.
const MANY: u64 = 100;

/// The 97.5 % quantile of the normal distribution.
const QUANTILE: f64 = 1.959_963_984_540_054;

/// Between which probabilities what was counted so often in so many trials is, with 95 %. If
/// it never was, or always, the interval is one-sided.
pub(super) fn interval(hits: u64, trials: u64) -> [f64; 2] {
    let misses = trials - hits;
    if trials == 0 {
        [0.0, 1.0]
    } else if hits.min(misses) >= MANY {
        wilson(hits as f64, trials as f64)
    } else if hits <= misses {
        few(hits, trials)
    } else {
        let [low, high] = few(misses, trials);
        [1.0 - high, 1.0 - low]
    }
}

fn wilson(hits: f64, trials: f64) -> [f64; 2] {
    let (p, z) = (hits / trials, QUANTILE);
    let share = z * z / trials;
    let middle = (p + 0.5 * share) / (1.0 + share);
    let spread = z / (1.0 + share) * ((p * (1.0 - p) + 0.25 * share) / trials).sqrt();
    [(middle - spread).max(0.0), (middle + spread).min(1.0)]
}

/// Clopper's and Pearson's: at the ends what was counted, and what is farther away, has 2.5 %.
fn few(hits: u64, trials: u64) -> [f64; 2] {
    const TAIL: f64 = 0.025;
    if hits == 0 {
        // (1 − p)ⁿ is the tail. It is not 5 %, though nothing is less than zero: with intervals
        // for other counts that begin above the truth, more than 5 % would be wrong.
        return [0.0, -(TAIL.ln() / trials as f64).exp_m1()];
    }
    let low = root(|p| 1.0 - at_most(hits - 1, trials, p) < TAIL);
    let high = root(|p| at_most(hits, trials, p) > TAIL);
    [low, high]
}

/// The largest probability for which something holds that holds for small ones.
fn root(holds: impl Fn(f64) -> bool) -> f64 {
    // Halved in the logarithm, for the root can be small.
    let (mut low, mut high) = (-64.0_f64, 0.0_f64);
    for _ in 0..64 {
        let middle = f64::midpoint(low, high);
        if holds(middle.exp2()) {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high).exp2()
}

/// How likely at most so many hits are.
fn at_most(hits: u64, trials: u64, p: f64) -> f64 {
    let n = trials as f64;
    let odds = p / (1.0 - p);
    let mut term = (n * (-p).ln_1p()).exp();
    let mut sum = term;
    for k in 0..hits {
        let k = k as f64;
        term *= (n - k) / (k + 1.0) * odds;
        sum += term;
    }
    // Where the first is too small to be a number all are small, as far as it matters here.
    if sum.is_nan() { 0.0 } else { sum.min(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From tables.
    #[test]
    fn intervals_are_those_of_tables() {
        let close = |[a, b]: [f64; 2], [c, d]: [f64; 2]| {
            assert!((a - c).abs() < 1e-4 && (b - d).abs() < 1e-4, "{a} {b}");
        };
        close(interval(0, 10), [0.0, 0.3085]);
        close(interval(1, 10), [0.0025, 0.4450]);
        close(interval(5, 10), [0.1871, 0.8129]);
        close(interval(10, 10), [0.6915, 1.0]);
        close(interval(99, 1_000_000), [8.05e-5, 1.205e-4]);
        close(interval(0, 0), [0.0, 1.0]);
    }

    /// The exact probability that the interval holds.
    #[test]
    fn intervals_hold_for_rare_things_too() {
        let n = 1000;
        for p in [1e-4, 2e-4, 1e-3, 3e-3, 0.01, 0.03, 0.09, 0.11, 0.3, 0.5] {
            let mut held = 0.0;
            let mut before = 0.0;
            for hits in 0..=n {
                let until = at_most(hits, n, p);
                let [low, high] = interval(hits, n);
                if low <= p && p <= high {
                    held += until - before;
                }
                before = until;
            }
            assert!(held > 0.94, "{p}: {held}");
        }
    }
}
