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
