//! What the rays of several strata find together.

use glam::DVec3;

use super::run::{Found, Missed, Replicate, Run, crossed, round_of};
use super::summed::Summed;
use crate::measure::beam::Beam;
use crate::measure::lattice::{Next, Round, Sampling};
use crate::measure::shares::{self, ROOM, Share, doubt, is_hopeless};
use crate::measure::spread::{ENOUGH_HITS, most_hits_but};
use crate::measure::strata::Stratum;

/// What to do after a round of several.
pub(super) fn next(
    run: &Run,
    strata: &[Stratum],
    rounds: &[Round<Found>],
    sampling: &Sampling,
) -> Next {
    let now = sum_of(run, strata, rounds);
    let unknown = rounds.iter().filter(|round| !is_known(round)).count();
    let summed = Summed::of(std::slice::from_ref(&now), sampling);
    let ratio = if unknown < rounds.len() { summed.distance(sampling) } else { f64::NAN };
    // What is asked for may be so much that all are infinitely far from it.
    let relative = Sampling { rel_tol: 1.0, abs_tol: 0.0, ..*sampling };
    let shares = strata.iter().zip(rounds).map(|(stratum, round)| {
        if is_known(round) {
            let rows = round_of(run, round).replicates;
            return Share::Known(summed.with_runs_of(&rows).distance(&relative));
        }
        let part = summed.room(bounds_of(stratum, round, unknown), sampling);
        let (like, hits) = (unknown as u64, hits_of(round));
        // Every ray counts, of all three beams.
        let is_enough = part * like as f64 <= ROOM
            || is_hopeless(3 * round.spent, hits, like, sampling);
        if is_enough { Share::Settled } else { Share::Unknown }
    });
    shares::next(ratio, &shares.collect::<Vec<_>>(), rounds)
}

fn is_known(round: &Round<Found>) -> bool {
    round.replicates.iter().all(|found| found.hits >= ENOUGH_HITS)
}

fn hits_of(round: &Round<Found>) -> u64 {
    round.replicates.iter().map(|found| found.hits).sum()
}

/// How much volume and area there is at most in a stratum that too few rays have met, of so many
/// like it.
fn bounds_of(stratum: &Stratum, round: &Round<Found>, unknown: usize) -> Missed {
    let rays = (round.size * round.replicates.len() as u64) as f64;
    let hits = most_hits_but(hits_of(round), doubt(unknown));
    let longest = |beam: &Beam| beam.depth() * beam.area() / 3.0;
    let most = stratum.beams.iter().map(longest).fold(0.0, f64::max);
    let area = |axis: DVec3| crossed(&stratum.beams, axis);
    let across = DVec3::AXES.map(area).into_iter().fold(0.0, f64::max);
    let volume = (hits * most / rays).min(stratum.bounds.size().element_product());
    Missed { volume, area: 2.0 * hits * across / rays }
}

/// What a round has found in all strata together.
pub(super) fn sum_of(run: &Run, strata: &[Stratum], rounds: &[Round<Found>]) -> Run {
    if rounds.iter().any(|round| round.size == 0) {
        return run.clone();
    }
    let unknown = rounds.iter().filter(|round| !is_known(round)).count();
    let lattices = rounds.iter().map(|round| round.replicates.len()).min();
    let mut all = Run {
        lattice: rounds.iter().map(|round| round.size).sum(),
        replicates: vec![Replicate::default(); lattices.unwrap_or(0)],
        ..run.clone()
    };
    for (stratum, round) in strata.iter().zip(rounds) {
        let found = round_of(run, round);
        all.reached = all.reached.hull(found.reached);
        if !is_known(round) {
            all.missed.add(1.0, bounds_of(stratum, round, unknown));
            continue;
        }
        for (sum, part) in all.replicates.iter_mut().zip(&found.replicates) {
            sum.integrals.iter_mut().zip(part.integrals).for_each(|(x, y)| *x += y);
            sum.hits += part.hits;
            sum.spans += part.spans;
            sum.uncertain += part.uncertain;
        }
    }
    all
}
