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

use super::beam::Samples;
use super::column::{Column, usize_of};
use super::spread::REPLICATES;
use super::strata::Stratum;
use crate::lanes::whole;
use crate::progress::Watch;
use crate::sampling::{Fibonacci, hash, unit};

/// The size of the first lattices.
pub(super) const FIRST: u64 = 233;

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

    /// Whether any ray met the solid.
    fn has_hits(&self) -> bool;
}

/// What each lattice of one round found in one stratum.
pub(super) struct Round<T> {
    pub(super) replicates: Vec<T>,
    /// How many rays each lattice has; none if not even the first round was finished.
    pub(super) size: u64,
    /// How many rays each beam has had in all rounds.
    pub(super) spent: u64,
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

/// What is wanted of all strata after a round.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Next {
    /// No more.
    Nothing,
    /// As many lattices of the same sizes, in all.
    Lattices(usize),
    /// Lattices so many times as large in place of some strata's; what there is of the others
    /// stays.
    Larger(Vec<Option<f64>>),
}

impl From<Wanted> for Next {
    /// Of the one stratum that there is.
    fn from(wanted: Wanted) -> Self {
        match wanted {
            Wanted::Nothing => Self::Nothing,
            Wanted::Lattices(count) => Self::Lattices(count),
            Wanted::Larger(factor) => Self::Larger(vec![Some(factor)]),
        }
    }
}

/// Rounds of ever larger lattices, or of more of them, until they are enough or a limit is
/// reached. Returns the last round of each stratum that was finished and the number of rays of
/// all that were.
///
/// `scratch` makes what a thread needs, `sample` adds rays to the tallies of their lattices.
/// A lattice is one of each beam of a stratum, all of them of the same size. All strata have as
/// many beams, and as many lattices.
pub(super) fn rounds<S, T: Tally>(
    strata: &[Stratum],
    sampling: &Sampling,
    watch: Watch<'_>,
    scratch: impl Fn() -> S + Sync + Send,
    sample: impl Fn(&mut S, &Samples<'_>, &mut [T]) + Sync + Send,
    mut wanted: impl FnMut(&[Round<T>], u64) -> Next,
) -> (Vec<Round<T>>, u64) {
    let start = Instant::now();
    let deadline = sampling.time_limit.and_then(|limit| start.checked_add(limit));
    let beams = strata.first().map_or(1, |stratum| stratum.beams.len() as u64);
    let mut rounds: Vec<Round<T>> = Vec::new();
    rounds.resize_with(strata.len(), || {
        let mut replicates = Vec::new();
        replicates.resize_with(REPLICATES, T::default);
        Round { replicates, size: 0, spent: 0 }
    });
    let mut parts = vec![Part::first(Fibonacci::at_least(FIRST)); strata.len()];
    let mut rays = 0;
    loop {
        let before = start.elapsed();
        let mut found = Vec::new();
        let mut first_beam = 0;
        for (number, (stratum, part)) in strata.iter().zip(&parts).enumerate() {
            let task = Task { number, stratum, part, seed: sampling.seed, first_beam };
            let limits = Limits { deadline, watch };
            let Some(tallies) = sampled(&task, &limits, &scratch, &sample) else {
                return (rounds, rays);
            };
            found.push(tallies);
            first_beam += stratum.beams.len();
        }
        let mut taken = 0;
        for ((round, part), found) in rounds.iter_mut().zip(&parts).zip(found) {
            taken += part.rays() * beams;
            round.spent += part.rays();
            if part.is_first() {
                round.replicates.clear();
                round.size = part.lattice.len();
            }
            round.replicates.extend(found);
        }
        rays += taken;
        let took = (start.elapsed() - before).as_secs_f64();
        let left = sampling.time_limit.map_or(f64::INFINITY, |limit| {
            limit.saturating_sub(start.elapsed()).as_secs_f64()
        });
        let most = (left / took * taken as f64)
            .min(sampling.max_rays.saturating_sub(rays) as f64)
            / beams as f64;
        let following = match wanted(&rounds, rays) {
            Next::Nothing => {
                confirmed(&rounds).and_then(|factors| larger(&parts, &factors, most))
            }
            Next::Lattices(count) => more(&parts, count, most),
            Next::Larger(factors) => larger(&parts, &factors, most),
        };
        let Some(following) = following else { return (rounds, rays) };
        for (round, part) in rounds.iter_mut().zip(&following) {
            // Of those that stay others need not have as many.
            if following.iter().any(Part::is_first) && !part.is_first() {
                round.replicates.truncate(REPLICATES);
            }
        }
        parts = following;
    }
}

/// What is still to be made larger before an answer is given: no answer rests on the smallest
/// lattices. Something periodic can meet all of them alike, however they are shifted, in which case
/// they agree without being right; the next larger ones have other periods.
fn confirmed<T: Tally>(rounds: &[Round<T>]) -> Option<Vec<Option<f64>>> {
    /// To the next number of Fibonacci.
    const LARGER: f64 = 1.5;
    let first = Fibonacci::at_least(FIRST).len();
    let is_smallest = |round: &Round<T>| {
        round.size == first && round.replicates.iter().any(Tally::has_hits)
    };
    let factors: Vec<Option<f64>> =
        rounds.iter().map(|round| is_smallest(round).then_some(LARGER)).collect();
    factors.iter().any(Option::is_some).then_some(factors)
}

/// More lattices of each stratum, so that there are `count` of them, with at most `most` rays of
/// each of their beams.
fn more(parts: &[Part], count: usize, most: f64) -> Option<Vec<Part>> {
    let each: u64 = parts.iter().map(|part| part.lattice.len()).sum();
    let more = |part: &Part| part.more(count, each, most);
    parts.iter().map(more).collect()
}

/// Larger lattices of some strata, if possible by these factors, with at most `most` rays of each
/// of their beams.
fn larger(parts: &[Part], factors: &[Option<f64>], most: f64) -> Option<Vec<Part>> {
    /// If it is not possible then by so much less, and again.
    const LESS: f64 = 0.8;
    if let ([part], [factor]) = (parts, factors) {
        return Some(vec![part.larger((*factor)?, most)?]);
    }
    let largest = factors.iter().flatten().copied().fold(0.0, f64::max);
    let mut scale = 1.0;
    while scale * largest > 1.0 {
        let next = parts.iter().zip(factors).map(|(part, factor)| match factor {
            Some(factor) => part.replaced(scale * factor),
            None => part.kept(),
        });
        let next: Vec<Part> = next.collect();
        let grows = next
            .iter()
            .zip(parts)
            .any(|(new, old)| new.lattice.len() > old.lattice.len());
        let rays: u64 = next.iter().map(Part::rays).sum();
        if grows && rays as f64 <= most {
            return Some(next);
        }
        scale *= LESS;
    }
    None
}

/// Some of the lattices of a round of one stratum.
#[derive(Clone, Debug)]
struct Part {
    lattice: Fibonacci,
    /// How often there were others of the same size before.
    again: u64,
    numbers: Range<usize>,
}

impl Part {
    /// The lattices that a round begins with.
    fn first(lattice: Fibonacci) -> Self {
        Self { lattice, again: 0, numbers: 0..REPLICATES }
    }

    fn is_first(&self) -> bool {
        self.numbers.start == 0
    }

    fn rays(&self) -> u64 {
        self.lattice.len() * self.numbers.len() as u64
    }

    /// More lattices after these, so that there are `count` of them, with at most `most` rays,
    /// where it takes `each` for one of all strata.
    fn more(&self, count: usize, each: u64, most: f64) -> Option<Self> {
        let from = self.numbers.end;
        let room = usize_of(whole(most / each as f64));
        let to = count.min(from.saturating_add(room));
        (to > from).then_some(Self { numbers: from..to, ..*self })
    }

    /// Lattices that are larger, if possible by a factor, with at most `most` rays.
    fn larger(&self, factor: f64, most: f64) -> Option<Self> {
        let most = most / (self.lattice.len() * REPLICATES as u64) as f64;
        self.lattice.grown(factor, most).map(Self::first)
    }

    /// Other lattices, larger by a factor if that is more than one.
    fn replaced(&self, factor: f64) -> Self {
        let larger =
            if factor > 1.0 { self.lattice.grown(factor, f64::INFINITY) } else { None };
        larger.map_or_else(
            || Self { again: self.again + 1, ..Self::first(self.lattice) },
            Self::first,
        )
    }

    /// No more of these, of which there will be as many as a round begins with.
    fn kept(&self) -> Self {
        Self { numbers: REPLICATES..REPLICATES, ..*self }
    }
}

/// What is to be sampled: a part of a round of the stratum with this number.
struct Task<'a> {
    number: usize,
    stratum: &'a Stratum,
    part: &'a Part,
    seed: u64,
    /// How many beams the strata before it have.
    first_beam: usize,
}

impl Task<'_> {
    /// How a lattice of a beam is shifted.
    fn shift(&self, beam: usize, number: usize) -> DVec2 {
        let Part { lattice, again, .. } = self.part;
        let part = |axis| {
            let axis = (2 * (self.first_beam + beam) + axis) as u64;
            let indices = [lattice.len(), number as u64, axis, *again];
            // Numbers depend on the last index only where there is something to tell apart.
            let count = if *again == 0 { 3 } else { 4 };
            unit(hash(self.seed, &indices[..count]))
        };
        DVec2::new(part(0), part(1))
    }
}

/// What ends sampling.
struct Limits<'a> {
    deadline: Option<Instant>,
    watch: Watch<'a>,
}

/// Samples a part of a round, unless the deadline comes first.
fn sampled<S, T: Tally>(
    task: &Task<'_>,
    limits: &Limits<'_>,
    scratch: &(impl Fn() -> S + Sync + Send),
    sample: &(impl Fn(&mut S, &Samples<'_>, &mut [T]) + Sync + Send),
) -> Option<Vec<T>> {
    let &Limits { deadline, watch } = limits;
    let Part { lattice, numbers, .. } = task.part;
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
    if numbers.is_empty() {
        return Some(replicates);
    }
    for (i, beam) in task.stratum.beams.iter().enumerate() {
        let shifts: Vec<DVec2> =
            numbers.clone().map(|number| task.shift(i, number)).collect();
        let grid @ [columns, _] = beam.grid(task.part.rays());
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
                let samples = Samples { stratum: task.number, ..bunch };
                sample(scratch, &samples, &mut tallies);
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
