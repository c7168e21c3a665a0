//! What a few independent estimates say together.

/// How many independent lattices there are at least.
pub(super) const REPLICATES: usize = 16;

/// The 97.5 % quantile of Student's t with 15 degrees of freedom.
pub(super) const T_QUANTILE: f64 = 2.131_449_545_559_323;

/// Fewer rays than this that meet the solid, in any replicate, and the spread between
/// replicates says nothing about the error.
pub(super) const ENOUGH_HITS: u64 = 10;

/// The mean of the replicates' estimates and the half width of its 95 % interval, for which
/// the spread is that of the first [`REPLICATES`].
pub(super) fn student(estimates: &[f64]) -> (f64, f64) {
    let first = &estimates[..REPLICATES];
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let of_first = mean(first);
    let squares: f64 = first.iter().map(|x| (x - of_first) * (x - of_first)).sum();
    let variance = squares / (REPLICATES - 1) as f64;
    (mean(estimates), T_QUANTILE * (variance / estimates.len() as f64).sqrt())
}

/// A number that the expected count exceeds with less than 5 % probability when `hits` were
/// counted: at least the exact bound for Poisson counts, which is 3.0 for none.
pub(super) fn most_hits(hits: u64) -> f64 {
    let k = hits as f64;
    k + 1.645 * k.sqrt() + 3.0
}

/// The same with some other probability than 5 %, by the bound of Chernoff: fewer than k events
/// of λ expected have a probability of at most exp(k − λ + k ln(λ/k)), if k < λ.
pub(super) fn most_hits_but(hits: u64, probability: f64) -> f64 {
    let (k, log) = (hits as f64, -probability.ln());
    let excess = |x: f64| if k > 0.0 { x - k - k * (x / k).ln() - log } else { x - log };
    /// Halvings until nothing is left but rounding.
    const HALVINGS: usize = 50;
    // There it is less than that: ln(1 + y) is at most y − y² / (2 + 2 y).
    let mut above = k + log + (log * log + 2.0 * k * log).sqrt();
    let mut below = k;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (below + above);
        if excess(middle) > 0.0 { above = middle } else { below = middle }
    }
    above
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bounds are such that what they say has the probability they say, or less: by adding up
    /// Poisson's distribution.
    #[test]
    fn so_few_hits_are_as_unlikely_as_is_said() {
        for hits in [0, 1, 2, 5, 10, 50, 200] {
            for probability in [0.025, 1e-3] {
                let most = most_hits_but(hits, probability);
                let mut term = (-most).exp();
                let mut sum = term;
                for k in 1..=hits {
                    term *= most / k as f64;
                    sum += term;
                }
                assert!(sum <= probability * (1.0 + 1e-9), "{hits} {most} {sum}");
                assert!(sum > 0.05 * probability, "{hits} {most} {sum}");
            }
        }
    }
}
