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
///
/// Volumes of what is 10⁻¹⁰⁰ wide have fewer digits than other numbers; the last of them is in doubt,
/// too. What is no number is off by any amount.
pub(super) fn student(estimates: &[f64]) -> (f64, f64) {
    /// A few times the least number.
    const LEAST: f64 = 1e-322;
    let first = &estimates[..REPLICATES];
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let (all, of_first) = (mean(estimates), mean(first));
    if !all.is_finite() || !of_first.is_finite() {
        return (all, f64::INFINITY);
    }
    let degrees = ((REPLICATES - 1) as f64, estimates.len() as f64);
    let spread = root_of_squares(first.iter().map(|x| x - of_first), degrees);
    (all, T_QUANTILE * spread + LEAST)
}

/// The root of a sum of squares, divided by two numbers before; in units of about the largest, a power
/// of two, for squares of volumes leave the range of numbers long before volumes do.
pub(super) fn root_of_squares(
    numbers: impl Iterator<Item = f64> + Clone,
    (a, b): (f64, f64),
) -> f64 {
    let largest = numbers.clone().fold(0.0_f64, |most, x| most.max(x.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    // A number, and one that has an inverse.
    let unit = largest.log2().floor().clamp(-1000.0, 1023.0).exp2();
    let squares: f64 = numbers.map(|x| (x / unit) * (x / unit)).sum();
    unit * (squares / a / b).sqrt()
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

    #[test]
    fn spreads_are_known_as_far_as_numbers_go() {
        let estimates: Vec<f64> =
            (0..20).map(|i| 5.0 + (0.3 * f64::from(i)).sin()).collect();
        let (mean, half_width) = student(&estimates);
        assert!(half_width > 0.1 && half_width < 1.0, "{half_width}");
        for power in [-1000, -600, -100, 100, 600, 1000] {
            let factor = 2.0_f64.powi(power);
            let scaled: Vec<f64> = estimates.iter().map(|x| factor * x).collect();
            assert_eq!(student(&scaled), (factor * mean, factor * half_width), "{power}");
        }
        let least: Vec<f64> = estimates.iter().map(|x| 1e-322 * x).collect();
        let (mean, half_width) = student(&least);
        assert!(half_width > 0.1 * mean, "{mean:e} {half_width:e}");
        let huge: Vec<f64> = estimates.iter().map(|x| 1e308 * x).collect();
        assert_eq!(student(&huge), (f64::INFINITY, f64::INFINITY));
        assert!(student(&[1.0; 16]).1 < 1e-300);
    }

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
