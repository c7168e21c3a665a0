//! How many rays each stratum gets.

use super::lattice::{Next, Round, Sampling, Wanted};
use super::volume::wanted;

/// What is known of a stratum after a round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Share {
    /// Its part of the half width, in some unit that is the same for all.
    Known(f64),
    /// Too few rays have met the solid in it.
    Unknown,
    /// The same, and it is left at that.
    Settled,
}

/// Of what is allowed, bounds for strata that too few rays have met may take this much, all
/// together, for the whole to be resolved.
pub(super) const ROOM: f64 = 0.25;

/// How improbable it is to be that one of so many bounds is too small: all of them together as
/// improbable as that an interval with two ends is too low.
pub(super) fn doubt(bounds: usize) -> f64 {
    0.025 / bounds as f64
}

/// Whether a stratum that too few rays have met is given up, of so many strata like it. Where no ray
/// has met the solid less is enough to say so.
pub(super) fn is_hopeless(rays: u64, hits: u64, like: u64, sampling: &Sampling) -> bool {
    /// For next time it takes so many times as many.
    const NEXT: u64 = 5;
    let patience = if hits == 0 { super::volume::PATIENCE } else { 2 };
    rays.saturating_mul(NEXT) > sampling.max_rays / (patience * like)
}

/// What to do where the half width of all strata that are known is so many times what is
/// allowed.
///
/// If the error s of a stratum with n rays becomes s f^(−3/2) with f n of them, all of them together
/// become smaller by some factor with the fewest rays where f is in proportion to
/// (s² / n)^(1/4), by Lagrange's multipliers. What has been found decides about lattices that take
/// its place; where it stays it weighs next to nothing.
pub(super) fn next<T>(ratio: f64, shares: &[Share], rounds: &[Round<T>]) -> Next {
    /// Strata with more than twice as many rays as they need keep what they have found.
    const LEAST: f64 = 0.5;
    const MOST: f64 = 64.0;
    /// Where nothing is known.
    const UNKNOWN: f64 = 4.0;
    let is_any_unknown = shares.contains(&Share::Unknown);
    let lattices = rounds.iter().map(|round| round.replicates.len()).min();
    let growth = match (ratio.is_nan(), wanted(ratio, lattices.unwrap_or(0))) {
        (true, _) => None,
        (_, Wanted::Larger(factor)) => Some(factor),
        (_, wanted @ (Wanted::Nothing | Wanted::Lattices(_))) if !is_any_unknown => {
            return wanted.into();
        }
        (_, Wanted::Nothing | Wanted::Lattices(_)) => None,
    };
    let known = || {
        shares.iter().zip(rounds).filter_map(|(share, round)| match share {
            Share::Known(part) => Some((*part, round.size as f64)),
            Share::Unknown | Share::Settled => None,
        })
    };
    // In units of the largest, for squares of volumes are no numbers long before volumes are none.
    let unit = known().map(|(s, _)| s).fold(0.0, f64::max);
    let unit = if unit > 0.0 && unit.is_finite() { unit } else { 1.0 };
    let squares: f64 = known().map(|(s, _)| (s / unit) * (s / unit)).sum();
    let sum: f64 = known().map(|(s, n)| (s / unit).sqrt() * n.powf(0.75)).sum();
    let factor = |s: f64, n: f64| {
        let s = s / unit;
        let common = growth? * (sum / squares).cbrt();
        let factor = common * s.sqrt() * n.powf(-0.25);
        (factor > LEAST).then_some(factor.min(MOST))
    };
    let factors = shares.iter().zip(rounds).map(|(share, round)| match share {
        Share::Known(part) => factor(*part, round.size as f64),
        Share::Unknown => Some(UNKNOWN),
        Share::Settled => None,
    });
    let factors: Vec<Option<f64>> = factors.collect();
    if factors.iter().all(Option::is_none) {
        Next::Nothing
    } else {
        Next::Larger(factors)
    }
}
