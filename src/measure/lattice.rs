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
use crate::fan::{Fan, Linear};
use crate::lanes::whole;
use crate::progress::Progress;
use crate::sampling::{Fibonacci, hash, unit};
use crate::scene::Bunch;

/// How many independent lattices.
pub(super) const REPLICATES: usize = 16;

/// The 97.5 % quantile of Student's t with 15 degrees of freedom.
const T_QUANTILE: f64 = 2.131_449_545_559_323;

/// Fewer rays than this that meet the solid, in any replicate, and the spread between
/// replicates says nothing about the error.
pub(super) const ENOUGH_HITS: u64 = 10;

/// How many rays a bunch has on average. Rays near each other are traced together, and sums
/// are formed by bunches and added in their order; so this number is part of the answer's last
/// bits, and the number of threads is not.
const BUNCH: u64 = 192;

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
    /// The rays, at places from −½ to ½.
    fan: Fan,
}

/// How far a ray leans on its way through the box, in widths of the box.
const LEAN: DVec2 = DVec2::new(0.31, 0.23);

impl Beam {
    pub(super) fn new(bounds: Aabb) -> Self {
        let size = bounds.size();
        let w = size.max_position();
        let axes @ [_, u, v] = [w, (w + 1) % 3, (w + 2) % 3];
        // A ray advances by one along the longest edge for each step of its direction.
        let mut dir = DVec3::AXES[w];
        dir[u] = LEAN.x * size[u] / size[w];
        dir[v] = LEAN.y * size[v] / size[w];
        let origin = Linear {
            middle: bounds.center(),
            right: (1.0 + LEAN.x) * size[u] * DVec3::AXES[u],
            up: (1.0 + LEAN.y) * size[v] * DVec3::AXES[v],
        };
        Self { bounds, axes, fan: Fan { origin, dir: Linear::constant(dir) } }
    }

    /// The area that the rays cross at right angles to the longest edge: with room for those
    /// that lean into the box from the side.
    pub(super) fn area(&self) -> f64 {
        let [_, u, v] = self.axes;
        let (size, room) = (self.bounds.size(), DVec2::ONE + LEAN);
        size[u] * room.x * size[v] * room.y
    }

    /// How far the rays go through the box, in steps of their direction; so the volume is
    /// the mean chord in steps times the area.
    pub(super) fn depth(&self) -> f64 {
        self.bounds.size()[self.axes[0]]
    }

    /// How many columns and rows of bunches some rays make, about as wide as high.
    fn grid(&self, rays: u64) -> [u64; 2] {
        let [_, u, v] = self.axes;
        let (size, bunches) = (self.bounds.size(), (rays / BUNCH).max(1) as f64);
        let aspect = (size[u] / size[v]).clamp(1.0 / bunches, bunches);
        let columns = (bunches * aspect).sqrt().round().max(1.0);
        let rows = (bunches / columns).round().max(1.0);
        [columns, rows].map(whole)
    }
}

/// Rays near each other, and which lattices they are of.
pub(super) struct Samples<'a> {
    pub(super) bunch: Bunch<'a>,
    pub(super) replicates: &'a [u8],
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
    let shifts = std::array::from_fn(|replicate| {
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

/// The points of all lattices in one column of a grid, row by row.
#[derive(Debug, Default)]
struct Column {
    found: Vec<(u64, u8, [f64; 2])>,
    /// Where the rows begin, and the last one ends.
    rows: Vec<usize>,
    places: Vec<[f64; 2]>,
    replicates: Vec<u8>,
}

impl Column {
    /// Finds the points of a column.
    fn fill(
        &mut self,
        lattice: Fibonacci,
        shifts: &[DVec2; REPLICATES],
        [columns, rows]: [u64; 2],
        number: u64,
    ) {
        let cell = |x: f64, count: u64| whole(x * count as f64).min(count - 1);
        self.found.clear();
        self.rows.clear();
        self.rows.resize(usize_of(rows) + 1, 0);
        let [from, to] = [number, number + 1].map(|i| i as f64 / columns as f64);
        for (replicate, &shift) in (0..).zip(shifts) {
            for p in lattice.between(from, to, shift) {
                if cell(p.x, columns) == number {
                    let row = cell(p.y, rows);
                    self.rows[usize_of(row) + 1] += 1;
                    self.found.push((row, replicate, [p.x - 0.5, p.y - 0.5]));
                }
            }
        }
        for row in 1..self.rows.len() {
            self.rows[row] += self.rows[row - 1];
        }
        // Points are put in the order of their rows, those of a row as they were found.
        let mut next = self.rows.clone();
        self.places.resize(self.found.len(), [0.0; 2]);
        self.replicates.resize(self.found.len(), 0);
        for &(row, replicate, place) in &self.found {
            let next = &mut next[usize_of(row)];
            self.places[*next] = place;
            self.replicates[*next] = replicate;
            *next += 1;
        }
    }

    /// The bunches of the column that was filled last.
    fn bunches<'a>(
        &'a self,
        beam: &'a Beam,
        [columns, rows]: [u64; 2],
        number: u64,
    ) -> impl Iterator<Item = Samples<'a>> {
        let edge = |i: u64, count: u64| i as f64 / count as f64 - 0.5;
        let [left, right] = [number, number + 1].map(|i| edge(i, columns));
        (0..).zip(self.rows.windows(2)).filter(|(_, range)| range[0] < range[1]).map(
            move |(row, range)| {
                let corners = [[left, edge(row, rows)], [right, edge(row + 1, rows)]];
                let (fan, places) = (&beam.fan, &self.places[range[0]..range[1]]);
                Samples {
                    bunch: Bunch { fan, corners, places },
                    replicates: &self.replicates[range[0]..range[1]],
                }
            },
        )
    }
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
