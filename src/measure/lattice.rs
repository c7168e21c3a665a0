//! Integration over parallel rays by randomly shifted lattices.
//!
//! A chord length is a function of two variables that is smoother than the solid itself:
//! its Fourier coefficients fall like |k|⁻² for curved silhouettes, so lattices reach an
//! error of order 1/N where random rays reach 1/√N. Sixteen lattices, each shifted at
//! random, are sixteen independent unbiased estimates, and Student's t makes an interval of
//! them (P. L'Ecuyer, C. Lemieux, "Variance Reduction via Lattice Rules", Management
//! Science 46(9), 2000).

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use glam::{DVec2, DVec3};

use crate::aabb::Aabb;
use crate::progress::Progress;
use crate::ray::Ray;
use crate::sampling::{Fibonacci, hash, unit};

/// How many independent lattices.
pub(super) const REPLICATES: usize = 16;

/// The 97.5 % quantile of Student's t with 15 degrees of freedom.
const T_QUANTILE: f64 = 2.131_449_545_559_323;

/// Fewer rays than this that meet the solid, in any replicate, and the spread between
/// replicates says nothing about the error.
pub(super) const ENOUGH_HITS: u64 = 10;

/// How many rays one task takes. Sums are formed by tasks and added in their order, so this
/// number is part of the answer's last bits, and the number of threads is not.
const TASK: u64 = 1024;

/// The size of the first lattices.
const FIRST: u64 = 233;

/// How far to go, and where to start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// The half width of the interval to reach, as a fraction of the value.
    pub rel_tol: f64,
    /// No more rays than this, but at least one round of 16 lattices of 233.
    pub max_rays: u64,
    /// No round is begun that would probably end later than this, and one that does is given
    /// up.
    pub time_limit: Option<Duration>,
    /// Which random shifts. Equal seeds give equal answers, bit by bit, on any number of
    /// threads, unless a time limit cuts one short.
    pub seed: u64,
}

impl Default for Sampling {
    /// One part in ten thousand, with at most 2²⁶ rays.
    fn default() -> Self {
        Self { rel_tol: 1e-4, max_rays: 1 << 26, time_limit: None, seed: 0 }
    }
}

/// Something that adds up over rays.
pub(super) trait Tally: Default + Send {
    /// Adds what later rays found.
    fn add(&mut self, later: Self);
}

/// What each lattice of one round found.
pub(super) struct Round<T> {
    pub(super) replicates: Vec<T>,
    /// How many rays each lattice has; none if not even the first round was finished.
    pub(super) size: u64,
}

/// Parallel rays that cover a box, all but along its longest edge.
///
/// They lean a little. Models are full of faces and cylinders along the axes, and seen
/// exactly along one of them the length of a chord jumps at such a silhouette, which costs
/// a lattice a quarter of an order (error N^-3/4); seen at an angle it rises steadily.
pub(super) struct Beam {
    bounds: Aabb,
    /// The axes along and across the rays.
    axes: [usize; 3],
}

/// How far a ray leans on its way through the box, in widths of the box.
const LEAN: DVec2 = DVec2::new(0.31, 0.23);

impl Beam {
    pub(super) fn new(bounds: Aabb) -> Self {
        let axis = bounds.size().max_position();
        Self { bounds, axes: [axis, (axis + 1) % 3, (axis + 2) % 3] }
    }

    /// The area that the rays cross at right angles to the longest edge: with room for those
    /// that lean into the box from the side.
    pub(super) fn area(&self) -> f64 {
        let [_, u, v] = self.axes;
        let (size, room) = (self.bounds.size(), DVec2::ONE + LEAN);
        size[u] * room.x * size[v] * room.y
    }

    /// How far the rays go through the box, in steps of their direction.
    pub(super) fn depth(&self) -> f64 {
        self.bounds.size()[self.axes[0]]
    }

    /// The ray at a place in the unit square; it advances by one along the longest edge for
    /// each step of its direction, so the volume is the mean chord in steps times the area.
    fn ray(&self, at: DVec2) -> Ray {
        let [w, u, v] = self.axes;
        let (size, mut origin) = (self.bounds.size(), self.bounds.center());
        let mut dir = DVec3::AXES[w];
        for (axis, at, lean) in [(u, at.x, LEAN.x), (v, at.y, LEAN.y)] {
            origin[axis] += (at - 0.5) * (1.0 + lean) * size[axis];
            dir[axis] = lean * size[axis] / size[w];
        }
        Ray::new(origin, dir)
    }
}

/// Rounds of ever larger lattices until `enough` says so or a limit is reached. Returns the
/// last round that was finished and the number of rays of all that were.
///
/// `scratch` makes what a thread needs, `sample` adds one ray to a tally.
pub(super) fn rounds<S, T: Tally>(
    beam: &Beam,
    sampling: &Sampling,
    progress: Progress<'_>,
    scratch: impl Fn() -> S + Sync + Send,
    sample: impl Fn(&mut S, &Ray, &mut T) + Sync + Send,
    mut enough: impl FnMut(&Round<T>, u64) -> bool,
) -> (Round<T>, u64) {
    let start = Instant::now();
    let deadline = sampling.time_limit.and_then(|limit| start.checked_add(limit));
    let (mut lattice, mut rays) = (Fibonacci::at_least(FIRST), 0);
    let mut last = Round { replicates: Vec::new(), size: 0 };
    last.replicates.resize_with(REPLICATES, T::default);
    loop {
        let before = start.elapsed();
        let seed = sampling.seed;
        let found = round(beam, seed, lattice, deadline, progress, &scratch, &sample);
        let Some(round) = found else { return (last, rays) };
        rays += lattice.len() * REPLICATES as u64;
        if enough(&round, rays) {
            return (round, rays);
        }
        last = round;
        let next = Fibonacci::at_least(2 * lattice.len());
        let growth = next.len() as f64 / lattice.len() as f64;
        let took = start.elapsed() - before;
        let late = sampling
            .time_limit
            .is_some_and(|limit| start.elapsed() + took.mul_f64(growth) > limit);
        let more = next.len() * REPLICATES as u64;
        if late || rays + more > sampling.max_rays || next.len() == lattice.len() {
            return (last, rays);
        }
        lattice = next;
    }
}

/// One round, unless the deadline comes first.
fn round<S, T: Tally>(
    beam: &Beam,
    seed: u64,
    lattice: Fibonacci,
    deadline: Option<Instant>,
    progress: Progress<'_>,
    scratch: &(impl Fn() -> S + Sync + Send),
    sample: &(impl Fn(&mut S, &Ray, &mut T) + Sync + Send),
) -> Option<Round<T>> {
    let size = lattice.len();
    let shift = |replicate: u64| {
        let part = |axis| unit(hash(seed, &[size, replicate, axis]));
        DVec2::new(part(0), part(1))
    };
    let tasks_each = size.div_ceil(TASK);
    let tasks = tasks_each * REPLICATES as u64;
    let late = AtomicBool::new(false);
    let partial = |scratch: &mut S, task: u64| {
        let (replicate, part) = (task / tasks_each, task % tasks_each);
        let (shift, mut tally) = (shift(replicate), T::default());
        let range = part * TASK..((part + 1) * TASK).min(size);
        progress(range.end - range.start);
        for i in range {
            // Looking at the clock costs less than a ray, but not nothing.
            if i % 64 == 0 && deadline.is_some_and(|deadline| Instant::now() > deadline) {
                late.store(true, Ordering::Relaxed);
            }
            if late.load(Ordering::Relaxed) {
                break;
            }
            sample(scratch, &beam.ray(lattice.point(i, shift)), &mut tally);
        }
        tally
    };
    let mut partials = in_order(tasks, scratch, partial).into_iter();
    if late.load(Ordering::Relaxed) {
        return None;
    }
    let replicates = (0..REPLICATES)
        .map(|_| {
            let mut total = T::default();
            partials.by_ref().take(usize_of(tasks_each)).for_each(|part| total.add(part));
            total
        })
        .collect();
    Some(Round { replicates, size })
}

/// The results of tasks `0..count`, in order, from as many threads as there are.
#[cfg(feature = "parallel")]
fn in_order<S, T: Send>(
    count: u64,
    scratch: &(impl Fn() -> S + Sync + Send),
    task: impl Fn(&mut S, u64) -> T + Sync + Send,
) -> Vec<T> {
    use rayon::prelude::*;
    (0..usize_of(count))
        .into_par_iter()
        .map_init(scratch, |scratch, i| task(scratch, i as u64))
        .collect()
}

/// The results of tasks `0..count`, in order.
#[cfg(not(feature = "parallel"))]
fn in_order<S, T: Send>(
    count: u64,
    scratch: &(impl Fn() -> S + Sync + Send),
    task: impl Fn(&mut S, u64) -> T + Sync + Send,
) -> Vec<T> {
    let mut scratch = scratch();
    (0..count).map(|i| task(&mut scratch, i)).collect()
}

fn usize_of(count: u64) -> usize {
    usize::try_from(count).expect("partial sums of one round fit the memory")
}

/// The mean of the replicates' estimates and the half width of its 95 % interval.
pub(super) fn student(estimates: &[f64]) -> (f64, f64) {
    let n = estimates.len() as f64;
    let mean = estimates.iter().sum::<f64>() / n;
    let squares: f64 = estimates.iter().map(|x| (x - mean) * (x - mean)).sum();
    (mean, T_QUANTILE * (squares / (n - 1.0) / n).sqrt())
}

/// A number that the expected count exceeds with less than 5 % probability when `hits` were
/// counted: at least the exact bound for Poisson counts, which is 3.0 for none.
pub(super) fn most_hits(hits: u64) -> f64 {
    let k = hits as f64;
    k + 1.645 * k.sqrt() + 3.0
}
