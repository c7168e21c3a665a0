//! How much two solids differ, and where most.

use glam::DVec3;

use super::beam::{Beam, Samples};
use super::estimate::Estimate;
use super::lattice::{Round, Sampling, Tally, Wanted, rounds};
use super::spread::student;
use super::strata::Stratum;
use super::volume::{Sum, distance, estimate, is_nothing, wanted};
use crate::progress::Watch;
use crate::scene::{BunchTracer, Chords, CompileError, CompileOptions, Scene};
use crate::solid::Solid;

/// Two solids side by side. Volumes are in cubic model units.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The volume of the first.
    pub a: Estimate,
    /// The volume of the second.
    pub b: Estimate,
    /// The volume of what only the first has.
    pub a_minus_b: Estimate,
    /// The volume of what only the second has.
    pub b_minus_a: Estimate,
    /// The volume of what only one of them has.
    pub difference: Estimate,
    /// Intersection over union: 1 for equal solids, and for two empty ones.
    pub iou: Estimate,
    /// The longest stretch of any ray that is in one of them only, if there was one.
    pub worst: Option<Worst>,
    /// Whether `difference` is at most the tolerance times the larger volume.
    pub verdict: Verdict,
}

/// A stretch of a ray that is in one solid only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Its length, in model units.
    pub length: f64,
    /// Where it begins.
    pub from: DVec3,
    /// Where it ends.
    pub to: DVec3,
    /// Whether it is in the first solid rather than in the second.
    pub in_a: bool,
}

/// Whether two solids are equal within a tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The whole interval of the difference is within the tolerance.
    Same,
    /// The whole interval is beyond it.
    Different,
    /// The limit of rays or time was reached before either could be said.
    Undecided,
}

/// The chords of the four solids that a comparison measures.
#[derive(Default)]
struct Tallies {
    sums: [Sum; 4],
    difference: Sum,
    worst: Option<Worst>,
}

impl Tally for Tallies {
    fn add(&mut self, later: Self) {
        for (sum, later) in self.sums.iter_mut().zip(later.sums) {
            sum.add(later);
        }
        self.difference.add(later.difference);
        self.worst = longer(self.worst, later.worst);
    }

    fn has_hits(&self) -> bool {
        self.sums.iter().any(Tally::has_hits)
    }
}

/// Measures the two solids, A − B and B − A with the same rays, until the verdict is clear
/// and both volumes are within `sampling.rel_tol`.
///
/// The differences are compiled as solids, so that surfaces which both have cancel.
///
/// # Errors
///
/// If one of them cannot be compiled.
pub fn compare(
    a: &Solid,
    b: &Solid,
    tolerance: f64,
    sampling: &Sampling,
    watch: Watch<'_>,
) -> Result<Comparison, CompileError> {
    compare_with(a, b, tolerance, sampling, &CompileOptions::default(), watch)
}

/// Compares as [`compare`] does two solids that are compiled in another way.
///
/// # Errors
///
/// If one of them, or a difference, cannot be compiled.
pub fn compare_with(
    a: &Solid,
    b: &Solid,
    tolerance: f64,
    sampling: &Sampling,
    options: &CompileOptions,
    watch: Watch<'_>,
) -> Result<Comparison, CompileError> {
    let scenes = [
        Scene::compile_with(a, options)?,
        Scene::compile_with(b, options)?,
        Scene::compile_with(&(a.clone() - b.clone()), options)?,
        Scene::compile_with(&(b.clone() - a.clone()), options)?,
    ];
    let bounds = scenes[0].bounds().hull(scenes[1].bounds());
    let nothing = scenes.each_ref().map(is_nothing);
    if nothing[0] && nothing[1] {
        return Ok(both_empty());
    }
    let beam = Beam::new(bounds);
    let comparison = |round: &Round<Tallies>, rays| {
        summary(&beam, round, rays, nothing, tolerance, sampling)
    };
    let whole = Stratum::whole(bounds, vec![Beam::new(bounds)]);
    let (rounds, rays) = rounds(
        std::slice::from_ref(&whole),
        sampling,
        watch,
        || (scenes.each_ref().map(Scene::bunch_tracer), Vec::new()),
        |(tracers, only_one), samples, tallies| {
            sample(tracers, only_one, samples, tallies);
        },
        |rounds, rays| {
            let round = &rounds[0];
            let (now, lattices) = (comparison(round, rays), round.replicates.len());
            let wanted = |e: &Estimate| {
                let is_known = e.value == 0.0;
                if is_known {
                    Wanted::Nothing
                } else {
                    wanted(distance(e, sampling), lattices)
                }
            };
            let undecided = now.verdict == Verdict::Undecided;
            let undecided =
                if undecided { Wanted::Larger(MORE) } else { Wanted::Nothing };
            undecided.and(wanted(&now.a)).and(wanted(&now.b)).into()
        },
    );
    Ok(comparison(&rounds[0], rays))
}

/// How many times as many rays are tried where a verdict is not clear.
const MORE: f64 = 2.0;

fn both_empty() -> Comparison {
    let nothing = Estimate::exact(0.0);
    Comparison {
        a: nothing,
        b: nothing,
        a_minus_b: nothing,
        b_minus_a: nothing,
        difference: nothing,
        iou: Estimate::exact(1.0),
        worst: None,
        verdict: Verdict::Same,
    }
}

/// Adds rays to the tallies of their lattices. What was in `only_one` does not matter: it
/// takes what each ray finds of both differences.
fn sample(
    tracers: &mut [BunchTracer<'_>; 4],
    only_one: &mut Vec<Sum>,
    samples: &Samples<'_>,
    tallies: &mut [Tallies],
) {
    let tally_of = |i: usize| usize::from(samples.replicates[i]);
    only_one.clear();
    only_one.resize(samples.replicates.len(), Sum::default());
    for (solid, tracer) in tracers.iter_mut().enumerate() {
        if solid < 2 {
            tracer.chords(&samples.bunch, |i, chords| {
                tallies[tally_of(i)].sums[solid].add(chords.into());
            });
            continue;
        }
        tracer.spans(&samples.bunch, |i, ray, tracer| {
            let (tally, sum) = (&mut tallies[tally_of(i)], Chords::found(tracer, ray));
            tally.sums[solid].add(sum.into());
            only_one[i].add(sum.into());
            let longest = tracer
                .spans_found()
                .iter()
                .max_by(|s, t| s.length().total_cmp(&t.length()));
            let found = longest.map(|span| Worst {
                length: span.length() * ray.speed(),
                from: ray.at(span.enter.t),
                to: ray.at(span.exit.t),
                in_a: solid == 2,
            });
            tally.worst = longer(tally.worst, found);
        });
    }
    for (i, sum) in only_one.iter().enumerate() {
        let hits = sum.hits.min(1);
        tallies[tally_of(i)].difference.add(Sum { hits, ..*sum });
    }
}

/// The longer of two stretches, the first if they are equally long.
fn longer(first: Option<Worst>, second: Option<Worst>) -> Option<Worst> {
    match (first, second) {
        (Some(a), Some(b)) => Some(if b.length > a.length { b } else { a }),
        (found, None) | (None, found) => found,
    }
}

fn summary(
    beam: &Beam,
    round: &Round<Tallies>,
    rays: u64,
    nothing: [bool; 4],
    tolerance: f64,
    sampling: &Sampling,
) -> Comparison {
    let [a, b, a_minus_b, b_minus_a] = std::array::from_fn(|i| {
        if nothing[i] {
            Estimate::exact(0.0)
        } else {
            estimate(beam, round, rays, sampling, |t| t.sums[i])
        }
    });
    let difference = estimate(beam, round, rays, sampling, |t| t.difference);
    let allowed = tolerance * a.value.max(b.value);
    let verdict = if difference.interval[1] <= allowed {
        Verdict::Same
    } else if difference.interval[0] > allowed {
        Verdict::Different
    } else {
        Verdict::Undecided
    };
    Comparison {
        a,
        b,
        a_minus_b,
        b_minus_a,
        difference,
        iou: overlap(beam, round, rays, &difference, sampling),
        worst: round.replicates.iter().fold(None, |w, t| longer(w, t.worst)),
        verdict,
    }
}

/// Intersection over union, lattice by lattice. Where the difference is not resolved the
/// interval is that of the difference: 1 − difference / union.
fn overlap(
    beam: &Beam,
    round: &Round<Tallies>,
    rays: u64,
    difference: &Estimate,
    sampling: &Sampling,
) -> Estimate {
    let ratio = |t: &Tallies| {
        let [a, b, a_minus_b, b_minus_a] = t.sums.map(|s| s.chords.length);
        let (common, all) = (
            0.5 * (a + b - a_minus_b - b_minus_a),
            0.5 * (a + b + a_minus_b + b_minus_a),
        );
        if all > 0.0 { (common / all).clamp(0.0, 1.0) } else { 1.0 }
    };
    let ratios: Vec<f64> = round.replicates.iter().map(ratio).collect();
    let (value, half_width) = student(&ratios);
    let union = estimate(beam, round, rays, sampling, |t| {
        let [a, b, ..] = t.sums;
        let (all, difference) = ([a, b].map(|sum| sum.chords), t.difference.chords);
        let chords = Chords {
            length: 0.5 * (all[0].length + all[1].length + difference.length),
            spans: all[0].spans + all[1].spans,
            uncertain: all[0].uncertain + all[1].uncertain,
        };
        Sum { chords, hits: a.hits.max(b.hits) }
    });
    let interval = if difference.resolved {
        [(value - half_width).max(0.0), (value + half_width).min(1.0)]
    } else {
        [(1.0 - difference.interval[1] / union.value).max(0.0), 1.0]
    };
    let target_met =
        union.resolved && interval[1] - interval[0] <= 2.0 * sampling.rel_tol;
    Estimate { value, interval, target_met, ..union }
}
