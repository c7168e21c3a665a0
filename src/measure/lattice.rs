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

use glam::DVec2;

use super::beam::{Beam, Samples};
use super::column::{Column, usize_of};
use super::spread::REPLICATES;
use crate::progress::Progress;
use crate::sampling::{Fibonacci, hash, unit};

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

/// Rounds of ever larger lattices until one is enough or a limit is reached. Returns the
/// last round that was finished and the number of rays of all that were.
///
/// `growth` says of a round how many times as many rays are wanted, 1 or less if it is enough.
/// `scratch` makes what a thread needs, `sample` adds rays to the tallies of their lattices.
pub(super) fn rounds<S, T: Tally>(
    beam: &Beam,
    sampling: &Sampling,
    progress: Progress<'_>,
    scratch: impl Fn() -> S + Sync + Send,
    sample: impl Fn(&mut S, &Samples<'_>, &mut [T; REPLICATES]) + Sync + Send,
    mut growth: impl FnMut(&Round<T>, u64) -> f64,
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
        let wanted = growth(&round, rays);
        if wanted <= 1.0 {
            return (round, rays);
        }
        last = round;
        let took = (start.elapsed() - before).as_secs_f64();
        let left = sampling.time_limit.map_or(f64::INFINITY, |limit| {
            limit.saturating_sub(start.elapsed()).as_secs_f64()
        });
        let most = (left / took).min(
            (sampling.max_rays.saturating_sub(rays)) as f64
                / (lattice.len() * REPLICATES as u64) as f64,
        );
        let Some(next) = lattice.grown(wanted, most) else {
            return (last, rays);
        };
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
    sample: &(impl Fn(&mut S, &Samples<'_>, &mut [T; REPLICATES]) + Sync + Send),
) -> Option<Round<T>> {
    let size = lattice.len();
    let shifts: [DVec2; REPLICATES] = std::array::from_fn(|replicate| {
        let part = |axis| unit(hash(seed, &[size, replicate as u64, axis]));
        DVec2::new(part(0), part(1))
    });
    let grid @ [columns, _] = beam.grid(size * REPLICATES as u64);
    let late = AtomicBool::new(false);
    let is_late = || {
        if deadline.is_some_and(|deadline| Instant::now() > deadline) {
            late.store(true, Ordering::Relaxed);
        }
        late.load(Ordering::Relaxed)
    };
    let scratch = || (scratch(), Column::default());
    let partial = |(scratch, column): &mut (S, Column), number: u64| {
        let mut tallies = std::array::from_fn(|_| T::default());
        if is_late() {
            return tallies;
        }
        column.fill(lattice, &shifts, grid, number);
        for bunch in column.bunches(beam, grid, number) {
            if is_late() {
                break;
            }
            sample(scratch, &bunch, &mut tallies);
        }
        progress(column.places.len() as u64);
        tallies
    };
    let partials = in_order(columns, &scratch, partial);
    if late.load(Ordering::Relaxed) {
        return None;
    }
    let mut replicates: Vec<T> = (0..REPLICATES).map(|_| T::default()).collect();
    for tallies in partials {
        replicates.iter_mut().zip(tallies).for_each(|(total, part)| total.add(part));
    }
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
