//! Volume.

use super::beam::Beam;
use super::column::usize_of;
use super::estimate::{Estimate, Method};
use super::lattice::{Next, Round, Sampling, Tally, Wanted, rounds};
use super::several::Parts;
use super::shares::next;
use super::spread::{ENOUGH_HITS, most_hits, student};
use super::strata::Stratum;
use crate::lanes::whole;
use crate::progress::{Watch, unwatched};
use crate::scene::{Chords, Scene};

/// The chords that many rays have in one solid.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum {
    pub(super) chords: Chords,
    /// How many rays have any.
    pub(super) hits: u64,
}

impl From<Chords> for Sum {
    /// Those of one ray.
    fn from(chords: Chords) -> Self {
        Self { chords, hits: u64::from(chords.spans > 0) }
    }
}

impl Tally for Sum {
    fn add(&mut self, later: Self) {
        self.chords.length += later.chords.length;
        self.chords.spans += later.chords.spans;
        self.chords.uncertain += later.chords.uncertain;
        self.hits += later.hits;
    }

    fn has_hits(&self) -> bool {
        self.hits > 0
    }
}

/// The volume, in cubic model units, by lattices of rays all but parallel to the longest
/// edge of the bounds.
///
/// Where fewer than ten rays of some lattice meet the solid the answer is *not resolved*:
/// an upper bound instead of a spread that would be too small, or zero. Where no ray does, a
/// sixteenth of `max_rays` is enough to say so.
///
/// Operands of unions that are far apart, or much smaller than others, are measured in boxes of
/// their own, up to 64 of them, by as many rays each as it takes: a screw in a hall is found. Where
/// one of these boxes is not resolved, the end of the interval is larger by what may be in it.
/// If that is little of what is allowed, the answer is resolved all the same.
///
/// ```
/// use solidray::{Scene, Solid, measure};
///
/// let ball = Scene::compile(&Solid::ball(3.0))?;
/// let volume = measure::volume(&ball, &measure::Sampling::default());
/// assert!((volume.value - 36.0 * std::f64::consts::PI).abs() < 1e-3 * volume.value);
/// # Ok::<(), solidray::CompileError>(())
/// ```
pub fn volume(scene: &Scene, sampling: &Sampling) -> Estimate {
    volume_with(scene, sampling, &unwatched)
}

/// [`volume`], which tells how it gets on and can be stopped.
pub fn volume_with(scene: &Scene, sampling: &Sampling, watch: Watch<'_>) -> Estimate {
    if is_nothing(scene) {
        return Estimate::exact(0.0);
    }
    let strata = Stratum::divide(scene, sampling, |bounds| vec![Beam::new(bounds)]);
    match &strata[..] {
        [one] => of_one(scene, one, sampling, watch),
        _ => of_several(scene, &strata, sampling, watch),
    }
}

/// The volume of what is in several strata, together.
pub(super) fn of_several(
    scene: &Scene,
    strata: &[Stratum],
    sampling: &Sampling,
    watch: Watch<'_>,
) -> Estimate {
    let (rounds, rays) = rounds(
        strata,
        sampling,
        watch,
        || (scene.bunch_tracer(), Vec::new()),
        |(tracer, kept), samples, sums: &mut [Sum]| {
            let stratum = &strata[samples.stratum];
            tracer.spans(&samples.bunch, |i, ray, tracer| {
                let mut chords = Chords::default();
                stratum.clip(ray, tracer.spans_found(), kept, |stretch| {
                    chords.length += stretch.to - stretch.from;
                    chords.spans += 1;
                });
                if chords.spans > 0 {
                    chords.uncertain = tracer.uncertain(ray);
                }
                sums[usize::from(samples.replicates[i])].add(chords.into());
            });
        },
        |rounds, rays| {
            let found = Parts::new(strata, rounds);
            let now = found.estimate(rays, sampling);
            if now.target_met {
                return Next::Nothing;
            }
            next(found.ratio(sampling), &found.shares(rounds, sampling), rounds)
        },
    );
    if rounds.iter().any(|round| round.size == 0) {
        let bounds = scene.bounds();
        return nothing_known(bounds.size().element_product(), rays);
    }
    Parts::new(strata, &rounds).estimate(rays, sampling)
}

/// The volume of all in one stratum.
fn of_one(
    scene: &Scene,
    stratum: &Stratum,
    sampling: &Sampling,
    watch: Watch<'_>,
) -> Estimate {
    let beam = &stratum.beams[0];
    let (rounds, rays) = rounds(
        std::slice::from_ref(stratum),
        sampling,
        watch,
        || scene.bunch_tracer(),
        |tracer, samples, sums: &mut [Sum]| {
            tracer.chords(&samples.bunch, |i, chords| {
                sums[usize::from(samples.replicates[i])].add(chords.into());
            });
        },
        |rounds, rays| {
            let round = &rounds[0];
            let hopeless = rays >= sampling.max_rays / PATIENCE
                && round.replicates.iter().all(|sum| sum.hits == 0);
            let now = estimate(beam, round, rays, sampling, |sum| *sum);
            if hopeless || !now.value.is_finite() {
                Next::Nothing
            } else {
                wanted(distance(&now, sampling), round.replicates.len()).into()
            }
        },
    );
    estimate(beam, &rounds[0], rays, sampling, |sum| *sum)
}

/// Where not even the first round was finished.
fn nothing_known(whole_box: f64, rays: u64) -> Estimate {
    Estimate {
        interval: [0.0, whole_box],
        rays,
        method: Method::Lattice,
        target_met: false,
        resolved: false,
        ..Estimate::exact(0.0)
    }
}

/// How many times as wide as it should be the interval is; no number where there is no telling.
pub(super) fn distance(estimate: &Estimate, sampling: &Sampling) -> f64 {
    if estimate.target_met {
        0.0
    } else if estimate.resolved {
        estimate.half_width() / sampling.allowed(estimate.value)
    } else {
        f64::NAN
    }
}

/// What it takes to make an interval from some lattices narrower by a factor. The error falls
/// like the square root of their number, and like their size to some power between 1 and 1½.
pub(super) fn wanted(ratio: f64, lattices: usize) -> Wanted {
    /// With more than these larger ones are cheaper.
    const MOST: f64 = 64.0;
    /// Bounds for what the spread of a small round can promise.
    const GROWTH: [f64; 2] = [1.5, 64.0];
    /// Where it promises nothing.
    const UNKNOWN: f64 = 4.0;
    const POWER: f64 = 1.5;
    let count = lattices as f64 * ratio * ratio;
    if ratio <= 1.0 {
        Wanted::Nothing
    } else if !ratio.is_finite() {
        Wanted::Larger(UNKNOWN)
    } else if count <= MOST {
        Wanted::Lattices(usize_of(whole(count.ceil())).max(lattices + 1))
    } else {
        let [least, most] = GROWTH;
        Wanted::Larger(ratio.powf(1.0 / POWER).clamp(least, most))
    }
}

/// When no ray has met the solid after this part of the allowed rays, it is given up: the
/// bound would only become a little smaller.
pub(super) const PATIENCE: u64 = 16;

/// Whether the bounds alone say that there is no volume.
pub(super) fn is_nothing(scene: &Scene) -> bool {
    scene.bounds().size().min_element() == 0.0
}

/// The volume that goes with some of a round's chords.
pub(super) fn estimate<T>(
    beam: &Beam,
    round: &Round<T>,
    rays: u64,
    sampling: &Sampling,
    sum: impl Fn(&T) -> Sum,
) -> Estimate {
    let whole_box = beam.depth() * beam.area();
    if round.size == 0 {
        return nothing_known(whole_box, rays);
    }
    let sums: Vec<Sum> = round.replicates.iter().map(sum).collect();
    let per_ray = beam.area() / round.size as f64;
    let volumes: Vec<f64> = sums.iter().map(|s| s.chords.length * per_ray).collect();
    let (value, half_width) = student(&volumes);
    let resolved = sums.iter().all(|s| s.hits >= ENOUGH_HITS);
    let interval = if resolved {
        [(value - half_width).max(0.0), value + half_width]
    } else {
        let hits = most_hits(sums.iter().map(|s| s.hits).sum());
        let bound = beam.depth() * per_ray * hits / sums.len() as f64;
        [0.0, bound.min(whole_box)]
    };
    let target_met = resolved && half_width <= sampling.allowed(value);
    let count = |of: fn(&Chords) -> u64| sums.iter().map(|s| of(&s.chords)).sum();
    Estimate {
        value,
        interval,
        rays,
        method: Method::Lattice,
        target_met,
        resolved,
        spans: count(|c| c.spans),
        uncertain: count(|c| c.uncertain),
    }
}
