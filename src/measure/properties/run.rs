//! What the rays of one seed find: sums over chords and their ends.
//!
//! Three beams look along the three axes, all but. Each gives the integrals over the solid,
//! and their mean counts. A piece of the surface is met by each beam in proportion to how
//! squarely it faces it; every crossing is divided by the sum of the three, which is nowhere
//! zero, so the sum over all crossings is the area, whichever way the surface faces: a
//! variant of the formulas of Cauchy and Crofton whose weights are bounded (one beam alone
//! would have weights without bound, and would miss faces along it).

use glam::DVec3;

use super::integrals::{COUNT, Integrals};
use super::{several, summary};
use crate::aabb::Aabb;
use crate::measure::beam::{Beam, Samples};
use crate::measure::lattice::{Next, Round, Sampling, Tally, rounds};
use crate::measure::strata::{Clipped, Stratum};
use crate::measure::volume::{PATIENCE, is_nothing, wanted};
use crate::progress::Watch;
use crate::ray::Ray;
use crate::scene::{Scene, Tracer};

/// What the rays of one seed found: all that it takes to combine it with what other seeds
/// found, on other machines perhaps.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Which random shifts.
    pub seed: u64,
    /// The box that the rays covered. Coordinates count from its middle.
    pub bounds: Aabb,
    /// How many rays a lattice has along each axis; none if there is nothing to measure or no
    /// round was finished in time.
    pub lattice: u64,
    /// How many rays were spent, those of earlier rounds included.
    pub rays: u64,
    /// What each lattice found.
    pub replicates: Vec<Replicate>,
    /// A box around all ends of chords.
    pub reached: Aabb,
    /// What there may be where few rays met the solid or none, in boxes that were measured by
    /// themselves.
    pub missed: Missed,
}

/// Bounds for what there is in boxes that too few rays met: all of it, for what was found there is
/// not in the integrals, nor does it count as hits. Zero where everything was measured together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Missed {
    /// Of the volume.
    pub volume: f64,
    /// Of the area, if rays cross twice what they have not met.
    pub area: f64,
}

impl Missed {
    pub(super) const NOTHING: Self = Self { volume: 0.0, area: 0.0 };

    /// So many times as much more.
    pub(super) fn add(&mut self, times: f64, other: Self) {
        self.volume += times * other.volume;
        self.area += times * other.area;
    }
}

/// What one lattice of rays found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Replicate {
    /// Estimates of the integrals over the solid of 1, x, y, z, x², y², z², xy, yz, zx, and of the
    /// area.
    pub integrals: [f64; COUNT],
    /// How many rays met the solid.
    pub hits: u64,
    /// How many stretches they had inside it.
    pub spans: u64,
    /// How many of these, and of gaps, are shorter than rounding.
    pub uncertain: u64,
}

impl Run {
    /// Whether the bounds alone say that there is nothing.
    pub(super) fn is_nothing(&self) -> bool {
        self.bounds.size().min_element() == 0.0
    }

    /// Whether it can have come from [`run`].
    pub(super) fn is_complete(&self) -> bool {
        let is_unfinished = self.replicates.is_empty() && self.lattice == 0;
        let all_finite =
            || self.replicates.iter().flat_map(|r| r.integrals).all(f64::is_finite);
        let is_bound = |bound: f64| bound.is_finite() && bound >= 0.0;
        let is_finished =
            || self.lattice > 0 && self.replicates.len() >= 16 && all_finite();
        [self.missed.volume, self.missed.area].into_iter().all(is_bound)
            && (is_unfinished || is_finished())
    }
}

/// What [`properties`](fn@crate::measure::properties) has found, so that it can be combined with
/// what other seeds find.
pub fn run(scene: &Scene, sampling: &Sampling, watch: Watch<'_>) -> Run {
    let bounds = scene.bounds();
    let run = Run {
        seed: sampling.seed,
        bounds,
        lattice: 0,
        rays: 0,
        replicates: Vec::new(),
        reached: Aabb::EMPTY,
        missed: Missed::NOTHING,
    };
    if is_nothing(scene) {
        return run;
    }
    let beams = |bounds| [0, 1, 2].map(|axis| Beam::along(bounds, axis)).into();
    let strata = Stratum::divide(scene, sampling, beams);
    let look = Look { scene, strata: &strata, center: bounds.center() };
    let (rounds, rays) = rounds(
        &strata,
        sampling,
        watch,
        || (scene.bunch_tracer(), Vec::new()),
        |(tracer, kept), samples, tallies: &mut [Found]| {
            tracer.spans(&samples.bunch, |i, ray, tracer| {
                let tally = &mut tallies[usize::from(samples.replicates[i])];
                look.add(samples, ray, tracer, kept, tally);
            });
        },
        |rounds, rays| match rounds {
            [round] => next_of_one(&Run { rays, ..round_of(&run, round) }, sampling),
            _ => several::next(&run, &strata, rounds, sampling),
        },
    );
    let found = match &rounds[..] {
        [round] => round_of(&run, round),
        _ => several::sum_of(&run, &strata, &rounds),
    };
    Run { rays, ..found }
}

/// What to do after a round of the one stratum that there is.
fn next_of_one(now: &Run, sampling: &Sampling) -> Next {
    let hopeless = now.rays >= sampling.max_rays / PATIENCE
        && now.replicates.iter().all(|r| r.hits == 0);
    if hopeless {
        return Next::Nothing;
    }
    let found = summary(std::slice::from_ref(now), sampling);
    wanted(found.distance(), now.replicates.len()).into()
}

/// What a round has found in one stratum.
pub(super) fn round_of(run: &Run, round: &Round<Found>) -> Run {
    let replicate = |found: &Found| {
        let per_ray = 1.0 / round.size as f64;
        let Found { integrals, hits, spans, uncertain, .. } = *found;
        let integrals = integrals.scaled(per_ray, per_ray).0;
        Replicate { integrals, hits, spans, uncertain }
    };
    let reached = round.replicates.iter().fold(Aabb::EMPTY, |b, f| b.hull(f.reached.0));
    let replicates = if round.size == 0 { &[] } else { &round.replicates[..] };
    Run {
        lattice: round.size,
        replicates: replicates.iter().map(replicate).collect(),
        reached,
        ..run.clone()
    }
}

/// The area that a crossing stands for of a surface with this normal, for one ray of each beam.
pub(super) fn crossed(beams: &[Beam], normal: DVec3) -> f64 {
    let seen = |beam: &Beam| (normal.dot(beam.dir()) / beam.area()).abs();
    1.0 / beams.iter().map(seen).fold(0.0, |sum, seen| sum + seen)
}

/// How rays are looked at.
struct Look<'a> {
    scene: &'a Scene,
    strata: &'a [Stratum],
    center: DVec3,
}

impl Look<'_> {
    /// Adds what a ray has found in its stratum. A beam stands for a third of the volume, and for
    /// its part of each piece of the surface.
    fn add(
        &self,
        samples: &Samples<'_>,
        ray: &Ray,
        tracer: &Tracer<'_>,
        kept: &mut Vec<[f64; 2]>,
        found: &mut Found,
    ) {
        let stratum = &self.strata[samples.stratum];
        let (mut along, mut spans) = (Integrals::default(), 0);
        stratum.clip(ray, tracer.spans_found(), kept, |Clipped { from, to, ends }| {
            let begin = ray.at(from);
            along.add_chord(begin - self.center, ray.dir, to - from);
            found.reached.add(begin);
            found.reached.add(ray.at(to));
            for crossing in ends.iter().flatten() {
                let normal = self.scene.normal_at(ray, crossing);
                along.add_area(crossed(&stratum.beams, normal));
            }
            spans += 1;
        });
        found.integrals.add(&along.scaled(samples.beam.area() / 3.0, 1.0));
        found.hits += u64::from(spans > 0);
        found.spans += spans;
        if spans > 0 || self.strata.len() == 1 {
            found.uncertain += tracer.uncertain(ray);
        }
    }
}

/// What the rays of one lattice have found.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    integrals: Integrals,
    pub(super) hits: u64,
    spans: u64,
    uncertain: u64,
    reached: Reached,
}

/// A box around points, empty at first.
#[derive(Clone, Copy, Debug)]
struct Reached(Aabb);

impl Default for Reached {
    fn default() -> Self {
        Self(Aabb::EMPTY)
    }
}

impl Reached {
    fn add(&mut self, point: DVec3) {
        self.0 = self.0.hull(Aabb::new(point, point));
    }
}

impl Tally for Found {
    fn add(&mut self, later: Self) {
        self.integrals.add(&later.integrals);
        self.hits += later.hits;
        self.spans += later.spans;
        self.uncertain += later.uncertain;
        self.reached.0 = self.reached.0.hull(later.reached.0);
    }

    fn has_hits(&self) -> bool {
        self.hits > 0
    }
}
