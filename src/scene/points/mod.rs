//! Which points are inside.
//!
//! The answer is that of [`Tracer::spans`] for the line through the point along [`PROBE`]; but
//! that line is only asked where the point is within rounding of a surface that matters.
//! Elsewhere the equations of the leaves have signs (why that is the same answer is said
//! in `shape/point.rs`), and the Boolean expression of those is the answer. Lines along PROBE
//! meet the solid's bounds if they go through a point in them, so there the line
//! is one that counts.
//!
//! Where many points are asked about, the box of the scene is divided into cells, once
//! (`cells`). For each it is known what is to be computed there: nothing where all is
//! inside or outside, else the equations of the few leaves that matter (`plan`). Points
//! are sorted by that, and those that have it in common are computed side by side.

mod alone;
mod block;
mod cells;
mod chunk;
mod grid;
mod plan;
mod raster;

use glam::DVec3;

use super::{Scene, Tracer};
use crate::aabb::Aabb;
use crate::ray::Ray;
use crate::shape::U;
pub(super) use alone::Around;
pub(super) use cells::Cells;
use chunk::Chunks;
pub(super) use raster::is_inside;

#[cfg(doc)]
use super::trace::PROBE;

/// At most this many points are sorted at once: 12 bytes each, one chunk a thread.
const MOST: usize = 1 << 20;

/// Fewer are not worth a chunk of their own.
const LEAST: usize = 1 << 12;

/// Where in a scene points can be told from surfaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// In which every line along PROBE counts.
    bounds: Aabb,
    /// Outside of which there is nothing.
    around: Aabb,
    /// What is farther from a surface is on one side of it for certain.
    pad: f64,
}

impl Room {
    /// That of a scene; none if it has no points inside, or a size whose squares are no
    /// numbers.
    ///
    /// The pad is 16 times the doubt in any leaf's surfaces, and 2⁻⁴⁰ of the largest
    /// coordinate for lines: that is 8192 roundings, of which a line and a leaf together have
    /// some dozens, more where a map has a large condition number.
    pub(super) fn of(scene: &Scene) -> Option<Self> {
        let bounds = scene.stage.bounds;
        let leaves = scene.hierarchy.bounds();
        if !bounds.is_bounded() || !leaves.is_bounded() {
            return None;
        }
        let all = bounds.hull(leaves);
        let reach = all.reach();
        let relative = 8192.0 * U + 64.0 * U * scene.worst_condition;
        let pad = 64.0 * scene.worst_slack + relative * reach;
        let size = bounds.size().max_element();
        let is_fit = (1e-90..1e90).contains(&size) && reach < 1e90 && pad < 0.01 * size;
        is_fit.then(|| Self { bounds, around: leaves.grown(2.0 * pad), pad })
    }

    /// Whether the line through a point counts.
    fn holds(&self, p: DVec3) -> bool {
        p.cmpge(self.bounds.min).all() && p.cmple(self.bounds.max).all()
    }

    /// Whether a point is so far away that it is outside of all leaves that reach the solid.
    ///
    /// A leaf's box is cut at the reach of the solid, beyond which nothing is inside, whatever
    /// complements are: so a point outside of all boxes is outside of a leaf or outside of the
    /// reach.
    fn is_beyond(&self, p: DVec3) -> bool {
        p.cmplt(self.around.min).any() || p.cmpgt(self.around.max).any()
    }
}

impl Scene {
    /// Which of many points are inside: for each what [`Tracer::contains`] says.
    ///
    /// Points may be anywhere and in any order; one that is not finite is outside. With the
    /// `parallel` feature all threads take part; answers do not depend on how many there
    /// are, nor on what other points are asked about. It takes some 12 bytes for each of
    /// at most 2²⁰ points at a time, on each thread.
    ///
    /// The first time so many points are asked about that it is worth it, several for each
    /// leaf, the scene learns which leaves matter where, and keeps that.
    ///
    /// ```
    /// use glam::dvec3;
    /// use solidray::{Scene, Solid};
    ///
    /// let ball = Scene::compile(&Solid::ball(1.0))?;
    /// let points = [dvec3(0.0, 0.0, 0.5), dvec3(0.9, 0.9, 0.0)];
    /// assert_eq!(ball.contains_all(&points), [true, false]);
    /// # Ok::<(), solidray::CompileError>(())
    /// ```
    pub fn contains_all(&self, points: &[DVec3]) -> Vec<bool> {
        let mut inside = vec![false; points.len()];
        let cells = self.cells_for(points.len());
        let len = points.len().div_ceil(2 * threads()).clamp(LEAST, MOST);
        for_each(points, &mut inside, len, || Chunks::new(self, cells));
        inside
    }

    /// The cells of the scene if they are there, or so many points are worth making them.
    fn cells_for(&self, points: usize) -> Option<&Cells> {
        if let Some(cells) = self.cells.get() {
            return cells.as_ref();
        }
        let is_worth_it = cells::is_small(self) || points >= cells::price(self);
        is_worth_it.then(|| self.cells.get_or_init(|| Cells::new(self)).as_ref())?
    }
}

impl Tracer<'_> {
    /// Whether a point is inside: whether `t = 0` is in a span of a line through it, ends
    /// at which the line enters included.
    pub fn contains(&mut self, point: DVec3) -> bool {
        self.certain(point).unwrap_or_else(|| self.probe(point))
    }

    /// The answer of the line.
    pub(super) fn probe(&mut self, point: DVec3) -> bool {
        let spans = self.spans(&Ray::new(point, super::trace::PROBE));
        spans.iter().any(|span| span.enter.t <= 0.0 && 0.0 < span.exit.t)
    }
}

#[cfg(feature = "parallel")]
fn threads() -> usize {
    rayon::current_num_threads()
}

#[cfg(not(feature = "parallel"))]
const fn threads() -> usize {
    1
}

/// Answers chunk by chunk.
#[cfg(feature = "parallel")]
fn for_each<'a>(
    points: &[DVec3],
    inside: &mut [bool],
    len: usize,
    chunks: impl Fn() -> Chunks<'a> + Sync + Send,
) {
    use rayon::prelude::*;

    points
        .par_chunks(len)
        .zip(inside.par_chunks_mut(len))
        .for_each_init(chunks, |chunks, (points, inside)| chunks.answer(points, inside));
}

/// Answers chunk by chunk.
#[cfg(not(feature = "parallel"))]
fn for_each<'a>(
    points: &[DVec3],
    inside: &mut [bool],
    len: usize,
    chunks: impl Fn() -> Chunks<'a>,
) {
    let mut state = chunks();
    for (points, inside) in points.chunks(len).zip(inside.chunks_mut(len)) {
        state.answer(points, inside);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::op::Op;
    use crate::solid::Solid;
    use glam::dvec3;

    /// Where leaves around a point are all certain, lines and their neighbours say the same.
    #[test]
    fn certain_points_are_classified_as_lines_classify_them() {
        let mut state = 1_u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        let mut point = || 4.0 * dvec3(number(), number(), number());
        let kinds = [
            Solid::ball(0.6),
            Solid::cuboid(dvec3(0.5, 1.0, 1.5)),
            Solid::frustum(0.7, 0.2, 1.0),
            Solid::cylinder(0.5, 2.0),
        ];
        let leaves = (0..24).map(|i| {
            let (axis, at) = (point() - 2.0, point());
            let straight = kinds[i % 4].clone().translated((2.0 * at).round() / 2.0);
            let turned = kinds[i % 4].clone().rotated(axis.normalize_or(DVec3::X), 1.0);
            if i % 2 == 0 { straight } else { turned.translated(at) }
        });
        let solid = leaves.enumerate().fold(Solid::ball(1.0), |solid, (i, leaf)| {
            let op = if i % 3 == 2 { Op::Difference } else { Op::Union };
            Solid::boolean(op, [solid, leaf])
        });
        let scene = Scene::compile(&solid).expect("the solid is right");
        let (mut tracer, mut lines) = (scene.tracer(), scene.tracer());
        lines.room = None;
        for i in 0..20_000 {
            let p = point();
            // Every other one of the lattice on which leaves are.
            let p = if i % 2 == 0 { (4.0 * p).round() / 4.0 } else { p };
            assert_eq!(tracer.classify(p), lines.classify(p), "{p}");
            assert_eq!(tracer.contains(p), lines.contains(p), "{p}");
        }
    }
}
