//! Volume between bounds that are certain.
//!
//! Cells of an octree are inside, outside, or cut, of which interval arithmetic is certain
//! (`scene/blocks.rs`; the first to find volumes of CSG models so were Y. T. Lee and A. A. G.
//! Requicha, "Algorithms for Computing the Volume and Other Integral Properties of Solids. II.
//! A Family of Algorithms Based on Representation Conversion and Cellular Approximation",
//! Communications of the ACM 25(9), 1982). Of a cut cell that few faces pass it is also known
//! what part is inside at least and at most (`shape/share.rs`): that is of second order, so
//! that the width falls like 1/N for N cells where N^-1/2 is usual; cells that meshes pass
//! have nothing of the kind.
//!
//! A round divides the cells whose bounds are farther apart than a threshold, and the next
//! one begins anew with a smaller one. So no cell is kept, and the work is that of the last
//! round and half as much.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use glam::DVec3;

use super::estimate::{Estimate, Method};
use super::lattice::{Sampling, in_order};
use super::volume::is_nothing;
use crate::aabb::Aabb;
use crate::progress::Watch;
use crate::scene::{Blocks, Found, Leaves, Scene};
use crate::shape::U;

/// Certain bounds for the volume, in cubic model units; the value is the middle between them.
///
/// `max_rays` is how many cells are looked at, at most. Bounds hold for the solid as it was
/// said, sizes and maps taken for exact numbers, where a scene is compiled without a weld.
///
/// ```
/// use solidray::{Scene, Solid, measure, unwatched};
///
/// let ball = Scene::compile(&Solid::ball(3.0))?;
/// let sampling = measure::Sampling { rel_tol: 1e-2, ..measure::Sampling::default() };
/// let volume = measure::bracket(&ball, &sampling, &unwatched);
/// let [low, high] = volume.interval;
/// let exact = 36.0 * std::f64::consts::PI;
/// assert!(low <= exact && exact <= high && high - low <= 0.02 * volume.value);
/// # Ok::<(), solidray::CompileError>(())
/// ```
pub fn bracket(scene: &Scene, sampling: &Sampling, watch: Watch<'_>) -> Estimate {
    if scene.bounds().is_empty() {
        return Estimate { method: Method::Bracket, ..Estimate::exact(0.0) };
    }
    let bounds = scene.bounds_of_true_solid();
    let mut found = Bounds { low: 0.0, high: 1.0 };
    let mut cells = 0;
    if is_nothing(scene) {
        return estimate(&bounds, found, cells, sampling);
    }
    let start = Instant::now();
    let mut threshold = FIRST;
    loop {
        let before = start.elapsed();
        let limits = Limits {
            start,
            sampling,
            watch,
            most: sampling.max_rays - cells,
            cells: AtomicU64::new(0),
            is_over: AtomicBool::new(false),
        };
        let Some(round) = round(scene, &bounds, threshold, &limits) else { break };
        let count = limits.cells.into_inner();
        cells += count;
        found = found.and(round);
        let now = estimate(&bounds, found, cells, sampling);
        let ratio = now.half_width() / sampling.allowed(now.value);
        if ratio <= 1.0 || threshold < LAST {
            break;
        }
        let took = (start.elapsed() - before).as_secs_f64();
        let left = sampling.time_limit.map_or(f64::INFINITY, |limit| {
            limit.saturating_sub(start.elapsed()).as_secs_f64()
        });
        let room = (left / took).min((sampling.max_rays - cells) as f64 / count as f64);
        let Some(factor) = smaller(ratio, room) else { break };
        threshold /= factor;
    }
    estimate(&bounds, found, cells, sampling)
}

/// The first threshold, as part of the box; those of the last rounds are of the order of what
/// rounding leaves in doubt.
const FIRST: f64 = 1.0 / 64.0;
const LAST: f64 = 1.0 / (1_u64 << 60) as f64;

/// By what factor to divide the threshold when bounds are some times as far apart as they
/// should be, and there is room for some times as many cells.
///
/// A threshold of h⁴ or h³ makes about h⁻² cells.
fn smaller(ratio: f64, room: f64) -> Option<f64> {
    const FACTORS: [f64; 2] = [2.0, 8.0];
    let [least, most] = FACTORS;
    let wanted = if ratio.is_nan() { most } else { (ratio * ratio).clamp(least, most) };
    let factor = wanted.min(room.powf(1.5));
    (factor >= 1.5).then_some(factor)
}

/// Bounds as parts of the box.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: f64,
    high: f64,
}

impl Bounds {
    /// What two bounds say together.
    fn and(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high) }
    }
}

/// When to give a round up.
struct Limits<'a> {
    start: Instant,
    sampling: &'a Sampling,
    watch: Watch<'a>,
    most: u64,
    cells: AtomicU64,
    is_over: AtomicBool,
}

impl Limits<'_> {
    /// Counts cells. A round is over when there are too many, which does not depend on who
    /// counts when.
    fn count(&self, cells: u64) {
        let before = self.cells.fetch_add(cells, Ordering::Relaxed);
        let late = || {
            let limit = self.sampling.time_limit;
            limit.is_some_and(|limit| self.start.elapsed() > limit)
        };
        if before + cells > self.most || (self.watch)(cells).is_break() || late() {
            self.is_over.store(true, Ordering::Relaxed);
        }
    }

    fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }
}

/// A box by parts of the whole one. All its numbers are exact: multiples of powers of two.
#[derive(Clone, Copy, Debug)]
struct Cell {
    middle: DVec3,
    half: DVec3,
}

/// The whole box.
const WHOLE: Cell = Cell { middle: DVec3::splat(0.5), half: DVec3::splat(0.5) };

/// Half the shortest edge that a cell can have, as part of the box: its middle is a number
/// still.
const SHORTEST: f64 = 1.0 / (1_u64 << 50) as f64;

impl Cell {
    /// The axes along which it is divided, so that cells come to be about as long as wide.
    fn divided(&self, size: DVec3) -> [bool; 3] {
        let edges = size * self.half;
        let longest = edges.max_element();
        [0, 1, 2].map(|axis| edges[axis] > 0.5 * longest)
    }

    /// Its parts, in order: two, four or eight.
    fn parts(self, divided: [bool; 3]) -> impl Iterator<Item = Self> {
        (0..8_usize).filter_map(move |corner| {
            let mut part = self;
            for (axis, &is_divided) in divided.iter().enumerate() {
                let is_upper = corner >> axis & 1 == 1;
                if is_divided {
                    part.half[axis] *= 0.5;
                    let step = part.half[axis];
                    part.middle[axis] += if is_upper { step } else { -step };
                } else if is_upper {
                    return None;
                }
            }
            Some(part)
        })
    }

    /// What part of the whole box it is.
    fn weight(&self) -> f64 {
        8.0 * self.half.element_product()
    }
}

/// Bounds from cells that are divided until theirs are no farther apart than a threshold,
/// unless it is given up.
fn round(
    scene: &Scene,
    bounds: &Aabb,
    threshold: f64,
    limits: &Limits<'_>,
) -> Option<Bounds> {
    /// The box is divided so often for the threads to share.
    const LEVELS: usize = 3;
    let size = bounds.size();
    let mut tasks = vec![WHOLE];
    for _ in 0..LEVELS {
        tasks = tasks.iter().flat_map(|cell| cell.parts(cell.divided(size))).collect();
    }
    let worker = || Worker {
        blocks: Blocks::new(scene, bounds),
        bounds: *bounds,
        size,
        threshold,
        limits,
        cells: 0,
    };
    let parts = in_order(tasks.len() as u64, &worker, |worker, number| {
        tasks.get(usize::try_from(number).unwrap_or(0)).map_or(Bounds::NOTHING, |cell| {
            let (center, half) = worker.place(cell);
            let leaves = worker.blocks.leaves(center, half);
            let found = worker.divide(*cell, &leaves);
            limits.count(std::mem::take(&mut worker.cells));
            found
        })
    });
    if limits.is_over() {
        return None;
    }
    let sum = parts.into_iter().fold(Bounds::NOTHING, Bounds::plus);
    // Eight sums on each of at most 150 levels, and those of the tasks, of parts of 1.
    let rounding = 4096.0 * U;
    Some(Bounds { low: sum.low - rounding, high: sum.high + rounding })
}

impl Bounds {
    const NOTHING: Self = Self { low: 0.0, high: 0.0 };

    fn plus(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }
}

/// What a thread needs.
struct Worker<'a> {
    blocks: Blocks<'a>,
    bounds: Aabb,
    size: DVec3,
    threshold: f64,
    limits: &'a Limits<'a>,
    /// Those that are not counted yet.
    cells: u64,
}

impl Worker<'_> {
    /// The middle of a cell and half its edges.
    fn place(&self, cell: &Cell) -> (DVec3, DVec3) {
        (self.bounds.min + cell.middle * self.size, cell.half * self.size)
    }

    /// Bounds for the part of the whole box that is inside and in a cell. Calls itself at most
    /// 150 times within itself: cells have a shortest edge.
    fn divide(&mut self, cell: Cell, leaves: &Leaves) -> Bounds {
        /// So many cells are counted at once.
        const LOT: u64 = 256;
        self.cells += 1;
        if self.cells == LOT {
            self.limits.count(std::mem::take(&mut self.cells));
        }
        let (center, half) = self.place(&cell);
        let weight = cell.weight();
        let found = match self.blocks.enter(center, half, leaves) {
            Found::Decided(true) => Bounds { low: weight, high: weight },
            Found::Decided(false) => Bounds::NOTHING,
            Found::Between([low, high], open) => {
                let own = Bounds { low: low * weight, high: high * weight };
                let is_done = own.high - own.low <= self.threshold
                    || cell.half.min_element() <= SHORTEST
                    || self.limits.is_over();
                if is_done {
                    own
                } else {
                    let divided = cell.divided(self.size);
                    let parts = cell.parts(divided);
                    let sum = parts.fold(Bounds::NOTHING, |sum, part| {
                        sum.plus(self.divide(part, &open))
                    });
                    own.and(sum)
                }
            }
        };
        self.blocks.leave(leaves);
        found
    }
}

/// The bounds in cubic units.
fn estimate(bounds: &Aabb, found: Bounds, cells: u64, sampling: &Sampling) -> Estimate {
    let volume = bounds.size().element_product();
    let low = (found.low.max(0.0) * volume * (1.0 - 16.0 * U)).next_down().max(0.0);
    let high = (found.high.min(1.0) * volume * (1.0 + 16.0 * U)).next_up();
    let value = if high.is_finite() { f64::midpoint(low, high) } else { low };
    let half_width = 0.5 * (high - low);
    Estimate {
        interval: [low, high],
        rays: cells,
        method: Method::Bracket,
        target_met: half_width <= sampling.allowed(value),
        resolved: low > 0.0,
        ..Estimate::exact(value)
    }
}
