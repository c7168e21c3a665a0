//! Volume by random points: the method that everybody knows.

use std::time::Instant;

use glam::DVec3;

use super::binomial;
use super::column::usize_of;
use super::estimate::{Estimate, Method};
use super::lattice::Sampling;
use super::volume::is_nothing;
use crate::aabb::Aabb;
use crate::lanes::whole;
use crate::progress::Watch;
use crate::sampling::{hash, unit};
use crate::scene::Scene;

/// How many points there are in the first batch.
const FIRST: u64 = 1 << 12;

/// The most points that are held at once: 6 MiB.
const AT_ONCE: u64 = 1 << 18;

/// The volume, in cubic model units, as the part of random points in the bounds that are
/// inside. Its error falls like the root of their number: for a digit more it takes a
/// hundred times as many.
///
/// `max_rays` is how many points there are at most. Point i depends on the seed and i alone.
/// The interval is binomial, and holds for rare solids as well; where no point is inside the
/// answer is *not resolved*, and the interval ends at a one-sided bound.
///
/// ```
/// use solidray::{Scene, Solid, measure, unwatched};
///
/// let ball = Scene::compile(&Solid::ball(3.0))?;
/// let sampling = measure::Sampling { rel_tol: 1e-2, ..measure::Sampling::default() };
/// let volume = measure::points(&ball, &sampling, &unwatched);
/// assert!((volume.value - 36.0 * std::f64::consts::PI).abs() < 0.03 * volume.value);
/// # Ok::<(), solidray::CompileError>(())
/// ```
pub fn points(scene: &Scene, sampling: &Sampling, watch: Watch<'_>) -> Estimate {
    if is_nothing(scene) {
        return Estimate::exact(0.0);
    }
    let start = Instant::now();
    let is_late = || sampling.time_limit.is_some_and(|limit| start.elapsed() > limit);
    let bounds = scene.bounds();
    let (mut hits, mut trials) = (0, 0);
    let mut goal = FIRST.min(sampling.max_rays);
    let mut places = Vec::new();
    loop {
        while trials < goal {
            let count = AT_ONCE.min(goal - trials);
            places.resize(usize_of(count), DVec3::ZERO);
            fill(&mut places, &|i| place(&bounds, sampling.seed, trials + i));
            let inside = scene.contains_all(&places);
            hits += inside.iter().filter(|&&inside| inside).count() as u64;
            trials += count;
            if watch(count).is_break() || is_late() {
                return estimate(&bounds, hits, trials, sampling);
            }
        }
        let now = estimate(&bounds, hits, trials, sampling);
        let ratio = now.half_width() / sampling.allowed(now.value);
        if ratio <= 1.0 || trials >= sampling.max_rays {
            return now;
        }
        goal = larger(trials, ratio).min(sampling.max_rays);
    }
}

/// How many points make an interval narrower by a factor.
fn larger(trials: u64, ratio: f64) -> u64 {
    /// Bounds for what few points can promise.
    const GROWTH: [f64; 2] = [1.1, 8.0];
    let [least, most] = GROWTH;
    let factor = (ratio * ratio).clamp(least, most);
    let factor = if factor.is_nan() { most } else { factor };
    whole((trials as f64 * factor).ceil()).max(trials + 1)
}

/// A point of the box.
fn place(bounds: &Aabb, seed: u64, number: u64) -> DVec3 {
    let parts = [0, 1, 2].map(|axis| unit(hash(seed, &[number, axis])));
    let part = DVec3::from_array(parts);
    bounds.min * (1.0 - part) + bounds.max * part
}

fn estimate(bounds: &Aabb, hits: u64, trials: u64, sampling: &Sampling) -> Estimate {
    let volume = bounds.size().element_product();
    let value = if trials == 0 { 0.0 } else { volume * (hits as f64 / trials as f64) };
    let interval = binomial::interval(hits, trials).map(|part| volume * part);
    let half_width = 0.5 * (interval[1] - interval[0]);
    let resolved = hits > 0;
    Estimate {
        interval,
        rays: trials,
        method: Method::Points,
        target_met: resolved && half_width <= sampling.allowed(value),
        resolved,
        ..Estimate::exact(value)
    }
}

/// Makes points of their numbers.
#[cfg(feature = "parallel")]
fn fill(places: &mut [DVec3], place: &(impl Fn(u64) -> DVec3 + Sync)) {
    use rayon::prelude::*;

    /// So many are worth a thread.
    const LEAST: usize = 1 << 12;
    places.par_chunks_mut(LEAST).enumerate().for_each(|(chunk, places)| {
        for (i, p) in places.iter_mut().enumerate() {
            *p = place((chunk * LEAST + i) as u64);
        }
    });
}

/// Makes points of their numbers.
#[cfg(not(feature = "parallel"))]
fn fill(places: &mut [DVec3], place: &(impl Fn(u64) -> DVec3 + Sync)) {
    for (i, p) in places.iter_mut().enumerate() {
        *p = place(i as u64);
    }
}
