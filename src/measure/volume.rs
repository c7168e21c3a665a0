//! Volume.

use super::estimate::{Estimate, Method};
use super::lattice::{
    Beam, ENOUGH_HITS, REPLICATES, Round, Sampling, Tally, most_hits, rounds, student,
};
use crate::progress::Progress;
use crate::ray::{Ray, Span};
use crate::scene::{Scene, Tracer};

/// Chords of one solid.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Chords {
    /// The sum of their lengths.
    pub(super) length: f64,
    /// How many rays have any.
    pub(super) hits: u64,
    /// How many there are.
    pub(super) spans: u64,
    /// How many of them, and of the gaps between them, are shorter than rounding.
    pub(super) uncertain: u64,
}

impl Tally for Chords {
    fn add(&mut self, later: Self) {
        self.length += later.length;
        self.hits += later.hits;
        self.spans += later.spans;
        self.uncertain += later.uncertain;
    }
}

impl Chords {
    /// Those of a ray whose spans a tracer has just found.
    pub(super) fn found(tracer: &Tracer<'_>, ray: &Ray) -> Self {
        let spans = tracer.spans_found();
        let length = spans.iter().map(Span::length).sum();
        Self {
            length,
            hits: u64::from(length > 0.0),
            spans: spans.len() as u64,
            uncertain: tracer.uncertain(ray),
        }
    }
}

/// The volume, in cubic model units, by lattices of rays all but parallel to the longest
/// edge of the bounds.
///
/// Where fewer than ten rays of some lattice meet the solid the answer is *not resolved*:
/// an upper bound instead of a spread that would be too small, or zero. Where no ray does, a
/// sixteenth of `max_rays` is enough to say so.
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
    volume_with(scene, sampling, &|_| {})
}

/// [`volume`], which tells how it gets on.
pub fn volume_with(
    scene: &Scene,
    sampling: &Sampling,
    progress: Progress<'_>,
) -> Estimate {
    if is_nothing(scene) {
        return Estimate::exact(0.0);
    }
    let beam = Beam::new(scene.bounds());
    let (round, rays) = rounds(
        &beam,
        sampling,
        progress,
        || scene.bunch_tracer(),
        |tracer, samples, chords: &mut [Chords; REPLICATES]| {
            tracer.spans(&samples.bunch, |i, ray, tracer| {
                let of = usize::from(samples.replicates[i]);
                chords[of].add(Chords::found(tracer, ray));
            });
        },
        |round, rays| {
            let hopeless = rays >= sampling.max_rays / PATIENCE
                && round.replicates.iter().all(|chords| chords.hits == 0);
            hopeless || estimate(&beam, round, rays, sampling.rel_tol, |c| *c).target_met
        },
    );
    estimate(&beam, &round, rays, sampling.rel_tol, |chords| *chords)
}

/// When no ray has met the solid after this part of the allowed rays, it is given up: the
/// bound would only become a little smaller.
const PATIENCE: u64 = 16;

/// Whether the bounds alone say that there is no volume.
pub(super) fn is_nothing(scene: &Scene) -> bool {
    scene.bounds().size().min_element() == 0.0
}

/// The volume that goes with some of a round's chords.
pub(super) fn estimate<T>(
    beam: &Beam,
    round: &Round<T>,
    rays: u64,
    rel_tol: f64,
    chords: impl Fn(&T) -> Chords,
) -> Estimate {
    let whole_box = beam.depth() * beam.area();
    if round.size == 0 {
        let interval = [0.0, whole_box];
        return Estimate {
            interval,
            rays,
            method: Method::Lattice,
            target_met: false,
            resolved: false,
            ..Estimate::exact(0.0)
        };
    }
    let chords: Vec<Chords> = round.replicates.iter().map(chords).collect();
    let per_ray = beam.area() / round.size as f64;
    let volumes: Vec<f64> = chords.iter().map(|c| c.length * per_ray).collect();
    let (value, half_width) = student(&volumes);
    let resolved = chords.iter().all(|c| c.hits >= ENOUGH_HITS);
    let interval = if resolved {
        [(value - half_width).max(0.0), value + half_width]
    } else {
        let hits = most_hits(chords.iter().map(|c| c.hits).sum());
        let bound = beam.depth() * per_ray * hits / chords.len() as f64;
        [0.0, bound.min(whole_box)]
    };
    let target_met = resolved && half_width <= rel_tol * value;
    let count = |of: fn(&Chords) -> u64| chords.iter().map(of).sum();
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
