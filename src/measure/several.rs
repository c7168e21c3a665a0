//! The volume of what is in several strata.

use super::estimate::{Estimate, Method};
use super::lattice::{Round, Sampling, Tally};
use super::shares::{ROOM, Share, doubt, is_hopeless};
use super::spread::{ENOUGH_HITS, most_hits_but, student};
use super::strata::Stratum;
use super::volume::Sum;
use crate::scene::Chords;

/// What lattices have found in several strata.
pub(super) struct Parts {
    /// For each stratum the volumes that its lattices say.
    volumes: Vec<Vec<f64>>,
    hits: Vec<u64>,
    /// For each that too few rays have met, what is in it at most.
    bounds: Vec<Option<f64>>,
    /// Of all strata that are resolved.
    value: f64,
    half_width: f64,
    /// What the others hold at most.
    missed: f64,
    /// What they hold as it seems.
    seen: f64,
    chords: Chords,
}

impl Parts {
    /// What a round has found that was finished.
    pub(super) fn new(strata: &[Stratum], rounds: &[Round<Sum>]) -> Self {
        let is_known =
            |round: &Round<Sum>| round.replicates.iter().all(|s| s.hits >= ENOUGH_HITS);
        let unknown = rounds.iter().filter(|round| !is_known(round)).count();
        let mut found = Self {
            volumes: Vec::new(),
            hits: Vec::new(),
            bounds: Vec::new(),
            value: 0.0,
            half_width: 0.0,
            missed: 0.0,
            seen: 0.0,
            chords: Chords::default(),
        };
        let mut known = vec![0.0; rounds.first().map_or(0, |r| r.replicates.len())];
        for (stratum, round) in strata.iter().zip(rounds) {
            let (beam, mut sum) = (&stratum.beams[0], Sum::default());
            round.replicates.iter().for_each(|one| sum.add(*one));
            let per_ray = beam.area() / round.size as f64;
            let volumes: Vec<f64> =
                round.replicates.iter().map(|s| s.chords.length * per_ray).collect();
            let bound = if is_known(round) {
                known.iter_mut().zip(&volumes).for_each(|(all, v)| *all += v);
                None
            } else {
                let hits = most_hits_but(sum.hits, doubt(unknown));
                let bound = beam.depth() * per_ray * hits / volumes.len() as f64;
                let bound = bound.min(stratum.bounds.size().element_product());
                found.missed += bound;
                found.seen += volumes.iter().sum::<f64>() / volumes.len() as f64;
                Some(bound)
            };
            found.chords.spans += sum.chords.spans;
            found.chords.uncertain += sum.chords.uncertain;
            found.volumes.push(volumes);
            found.hits.push(sum.hits);
            found.bounds.push(bound);
        }
        if unknown < rounds.len() {
            (found.value, found.half_width) = student(&known);
        }
        found
    }

    fn is_any_known(&self) -> bool {
        self.bounds.iter().any(Option::is_none)
    }

    /// What the half width may be of what is known.
    fn allowed(&self, sampling: &Sampling) -> f64 {
        sampling.allowed(self.value)
    }

    /// How many times as wide as it may be the interval of what is known is; no number if nothing
    /// is.
    pub(super) fn ratio(&self, sampling: &Sampling) -> f64 {
        let room = 1.0 - 0.5 * ROOM;
        if self.is_any_known() {
            self.half_width / (room * self.allowed(sampling))
        } else {
            f64::NAN
        }
    }

    pub(super) fn shares(
        &self,
        rounds: &[Round<Sum>],
        sampling: &Sampling,
    ) -> Vec<Share> {
        let unknown = self.bounds.iter().flatten().count() as u64;
        let enough = ROOM * self.allowed(sampling) / unknown as f64;
        let share = |i: usize| match self.bounds[i] {
            None => {
                let (_, half_width) = student(&self.volumes[i]);
                Share::Known(half_width)
            }
            Some(bound) if bound <= enough => Share::Settled,
            Some(_) if is_hopeless(rounds[i].spent, self.hits[i], unknown, sampling) => {
                Share::Settled
            }
            Some(_) => Share::Unknown,
        };
        (0..rounds.len()).map(share).collect()
    }

    /// The truth is below the interval with a probability of 2½ %, if what is known is; and above
    /// it with 5 % at most, if that is, or what is not known is above its bounds. As these are
    /// far from likely to be reached both are 5 % together.
    pub(super) fn estimate(&self, rays: u64, sampling: &Sampling) -> Estimate {
        let Self { value, half_width, missed, .. } = *self;
        let interval = [(value - half_width).max(0.0), value + half_width + missed];
        let allowed = self.allowed(sampling);
        let resolved = self.is_any_known() && missed <= ROOM * allowed;
        Estimate {
            value: value + self.seen,
            interval,
            rays,
            method: Method::Lattice,
            target_met: resolved && 0.5 * (interval[1] - interval[0]) <= allowed,
            resolved,
            spans: self.chords.spans,
            uncertain: self.chords.uncertain,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, dvec3};

    use super::*;
    use crate::aabb::Aabb;
    use crate::measure::beam::Beam;
    use crate::measure::volume::{of_several, volume};
    use crate::progress::unwatched;
    use crate::sampling::{hash, unit};
    use crate::scene::Scene;
    use crate::solid::Solid;

    /// It does not matter how space is divided, through whatever solid.
    #[test]
    fn parts_add_up_to_the_whole_of_any_division() {
        let solid = (Solid::ball(1.0) - Solid::cuboid(dvec3(0.8, 0.8, 3.0)))
            + Solid::cylinder(0.3, 2.0).rotated(DVec3::X, 1.0);
        let scene = Scene::compile(&solid).expect("it is a solid");
        let whole = volume(&scene, &Sampling::default());
        let mut missed = 0;
        for seed in 0..30 {
            let number = |i: u64| unit(hash(seed, &[i]));
            let point = |i: u64| {
                let at = dvec3(number(3 * i), number(3 * i + 1), number(3 * i + 2));
                4.0 * at - 2.0
            };
            let around = |i: u64| Aabb::around([point(2 * i), point(2 * i + 1)]);
            let mut boxes: Vec<Aabb> = (0..5).map(around).collect();
            boxes.push(scene.bounds().grown(0.1));
            let strata = Stratum::in_order(&boxes, |bounds| vec![Beam::new(bounds)]);
            let sampling = Sampling { rel_tol: 1e-3, seed, ..Sampling::default() };
            let found = of_several(&scene, &strata, &sampling, &unwatched);
            assert!(found.resolved && found.target_met, "{seed}: {found:?}");
            let [low, high] = found.interval;
            missed += u32::from(whole.value < low || high < whole.value);
        }
        assert!(missed <= 4, "{missed} of 30");
    }
}
