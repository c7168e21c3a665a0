//! Integration over parallel rays by randomly shifted lattices.
//!
//! A chord length is a function of two variables that is smoother than the solid itself:
//! its Fourier coefficients fall like |k|⁻² for curved silhouettes, so lattices reach an
//! error of order 1/N where random rays reach 1/√N. Sixteen lattices, each shifted at
//! random, are sixteen independent unbiased estimates, and Student's t makes an interval of
//! them (P. L'Ecuyer, C. Lemieux, "Variance Reduction via Lattice Rules", Management
//! Science 46(9), 2000).
//!
//! Where that is not quite narrow enough, the spread of the sixteen says how many lattices
//! more make it so. To go on until the interval looks narrow would favour spreads that are
//! too small by chance; so the spread remains that of the sixteen, as in C. Stein, "A
//! Two-Sample Test for a Linear Hypothesis Whose Power is Independent of the Variance",
//! Annals of Mathematical Statistics 16(3), 1945. What is left of that comes from rounds that
//! are far from narrow enough and give way to larger lattices: with normal errors that fall
//! like 1/N, 94.3 % of the intervals hold.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use glam::DVec2;

use super::beam::{Beam, Samples};
use super::column::{Column, usize_of};
use super::spread::REPLICATES;
use crate::lanes::whole;
use crate::progress::Watch;
use crate::sampling::{Fibonacci, hash, unit};

/// The size of the first lattices.
const FIRST: u64 = 233;

/// How far to go, and where to start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// The half width of the interval to reach, as a fraction of the value.
    pub rel_tol: f64,
    /// The same in the units of the value; the wider of the two is enough.
    pub abs_tol: f64,
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
        Self { rel_tol: 1e-4, abs_tol: 0.0, max_rays: 1 << 26, time_limit: None, seed: 0 }
    }
}

impl Sampling {
    /// The same with other random numbers for each of several solids that are measured to be
    /// added up: with the same ones their errors would be alike. The seed has 53 bits at most, as
    /// many as readers of JSON keep.
    #[must_use]
    pub fn for_part(self, number: u64) -> Self {
        Self { seed: hash(self.seed, &[number]) >> 11, ..self }
    }

    /// The half width to reach for a value.
    pub(super) fn allowed(&self, value: f64) -> f64 {
        (self.rel_tol * value).max(self.abs_tol)
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

/// What is wanted after a round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Wanted {
    /// No more.
    Nothing,
    /// As many lattices of the same size, in all.
    Lattices(usize),
    /// Lattices so many times as large, in place of these.
    Larger(f64),
}

impl Wanted {
    /// What two want together.
    pub(super) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Larger(a), Self::Larger(b)) => Self::Larger(a.max(b)),
            (Self::Lattices(a), Self::Lattices(b)) => Self::Lattices(a.max(b)),
            (Self::Nothing, wanted)
            | (wanted @ Self::Larger(_), _)
            | (Self::Lattices(_), wanted @ Self::Larger(_))
            | (wanted, Self::Nothing) => wanted,
        }
    }
}

/// Rounds of ever larger lattices, or of more of them, until they are enough or a limit is
/// reached. Returns the last round that was finished and the number of rays of all that were.
///
/// `scratch` makes what a thread needs, `sample` adds rays to the tallies of their lattices.
/// A lattice is one of each beam, all of them of the same size.
pub(super) fn rounds<S, T: Tally>(
    beams: &[Beam],
    sampling: &Sampling,
    watch: Watch<'_>,
    scratch: impl Fn() -> S + Sync + Send,
    sample: impl Fn(&mut S, &Samples<'_>, &mut [T]) + Sync + Send,
    mut wanted: impl FnMut(&Round<T>, u64) -> Wanted,
) -> (Round<T>, u64) {
    let start = Instant::now();
    let deadline = sampling.time_limit.and_then(|limit| start.checked_add(limit));
    let mut round = Round { replicates: Vec::new(), size: 0 };
    round.replicates.resize_with(REPLICATES, T::default);
    let mut next = Part::first(Fibonacci::at_least(FIRST));
    let mut rays = 0;
    loop {
        let before = start.elapsed();
        let seed = sampling.seed;
        let found = part(beams, seed, &next, deadline, watch, &scratch, &sample);
        let Some(found) = found else { return (round, rays) };
        let taken = next.rays() * beams.len() as u64;
        rays += taken;
        if next.is_first() {
            round = Round { replicates: found, size: next.lattice.len() };
        } else {
            round.replicates.extend(found);
        }
        let took = (start.elapsed() - before).as_secs_f64();
        let left = sampling.time_limit.map_or(f64::INFINITY, |limit| {
            limit.saturating_sub(start.elapsed()).as_secs_f64()
        });
        let most = (left / took * taken as f64)
            .min(sampling.max_rays.saturating_sub(rays) as f64)
            / beams.len() as f64;
        let following = match wanted(&round, rays) {
            Wanted::Nothing => None,
            Wanted::Lattices(count) => next.more(count, most),
            Wanted::Larger(factor) => next.larger(factor, most),
        };
        let Some(part) = following else { return (round, rays) };
        next = part;
    }
}

/// Some of the lattices of a round.
#[derive(Clone, Debug)]
struct Part {
    lattice: Fibonacci,
    numbers: Range<usize>,
}

impl Part {
    /// The lattices that a round begins with.
    fn first(lattice: Fibonacci) -> Self {
        Self { lattice, numbers: 0..REPLICATES }
    }

    fn is_first(&self) -> bool {
        self.numbers.start == 0
    }

    fn rays(&self) -> u64 {
        self.lattice.len() * self.numbers.len() as u64
    }

    /// More lattices after these, so that there are `count` of them, with at most `most` rays.
    fn more(&self, count: usize, most: f64) -> Option<Self> {
        let from = self.numbers.end;
        let room = usize_of(whole(most / self.lattice.len() as f64));
        let to = count.min(from.saturating_add(room));
        (to > from).then_some(Self { lattice: self.lattice, numbers: from..to })
    }

    /// Lattices that are larger, if possible by a factor, with at most `most` rays.
    fn larger(&self, factor: f64, most: f64) -> Option<Self> {
        let most = most / (self.lattice.len() * REPLICATES as u64) as f64;
        self.lattice.grown(factor, most).map(Self::first)
    }
}

/// Samples a part of a round, unless the deadline comes first.
fn part<S, T: Tally>(
    beams: &[Beam],
    seed: u64,
    part: &Part,
    deadline: Option<Instant>,
    watch: Watch<'_>,
    scratch: &(impl Fn() -> S + Sync + Send),
    sample: &(impl Fn(&mut S, &Samples<'_>, &mut [T]) + Sync + Send),
) -> Option<Vec<T>> {
    let Part { lattice, numbers } = part;
    let shift = |beam: usize, number: usize| {
        let part = |axis| {
            let axis = (2 * beam + axis) as u64;
            unit(hash(seed, &[lattice.len(), number as u64, axis]))
        };
        DVec2::new(part(0), part(1))
    };
    let tallies = || -> Vec<T> { numbers.clone().map(|_| T::default()).collect() };
    let late = AtomicBool::new(false);
    let is_late = || {
        if deadline.is_some_and(|deadline| Instant::now() > deadline) {
            late.store(true, Ordering::Relaxed);
        }
        late.load(Ordering::Relaxed)
    };
    let scratch = || (scratch(), Column::new());
    let mut replicates = tallies();
    for (i, beam) in beams.iter().enumerate() {
        let shifts: Vec<DVec2> = numbers.clone().map(|number| shift(i, number)).collect();
        let grid @ [columns, _] = beam.grid(part.rays());
        let partial = |(scratch, column): &mut (S, Column), number: u64| {
            let mut tallies = tallies();
            if is_late() {
                return tallies;
            }
            column.fill(*lattice, &shifts, grid, number);
            for bunch in column.bunches(beam, grid, number) {
                if is_late() {
                    break;
                }
                sample(scratch, &bunch, &mut tallies);
            }
            if watch(column.len() as u64).is_break() {
                late.store(true, Ordering::Relaxed);
            }
            tallies
        };
        let partials = in_order(columns, &scratch, partial);
        if late.load(Ordering::Relaxed) {
            return None;
        }
        for tallies in partials {
            replicates.iter_mut().zip(tallies).for_each(|(total, part)| total.add(part));
        }
    }
    Some(replicates)
}

/// The results of tasks `0..count`, in order, from as many threads as there are.
#[cfg(feature = "parallel")]
pub(super) fn in_order<S, T: Send>(
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
pub(super) fn in_order<S, T: Send>(
    count: u64,
    scratch: &(impl Fn() -> S + Sync + Send),
    task: impl Fn(&mut S, u64) -> T + Sync + Send,
) -> Vec<T> {
    let mut scratch = scratch();
    (0..count).map(|i| task(&mut scratch, i)).collect()
}
