//! Which solids share volume: how much, how deep, and where.

use glam::DVec3;

use super::beam::Beam;
use super::estimate::Estimate;
use super::lattice::Sampling;
use super::volume::{is_nothing, volume_with};
use crate::aabb::Aabb;
use crate::progress::Watch;
use crate::ray::{Ray, Span};
use crate::scene::{CompileError, CompileOptions, Scene, Tracer};
use crate::solid::Solid;

/// Volume that two solids share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// Which of those that were given.
    pub pair: [usize; 2],
    /// How much they share, in cubic model units; where this is not resolved its interval ends at a
    /// bound.
    pub volume: Estimate,
    /// Where they share most, and how deep that is; nothing where no ray has found any of it.
    pub deepest: Option<Deepest>,
}

/// A place within what two solids share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deepest {
    /// The place.
    pub at: DVec3,
    /// The shortest of the three stretches along the axes through the place that both solids
    /// share, in model units: the larger solid must be moved at least about half of that for
    /// the place to be free.
    pub depth: f64,
}

/// What is shared by each two of some solids whose bounds have volume in common, in the order
/// of their numbers. Pairs that only touch are not among them; pairs whose rays find nothing are,
/// with a bound, if that is more than `sampling.abs_tol`.
///
/// # Errors
///
/// If a solid, or what two of them share, cannot be compiled.
pub fn overlaps(
    solids: &[Solid],
    options: &CompileOptions,
    sampling: &Sampling,
    watch: Watch<'_>,
) -> Result<Vec<Overlap>, CompileError> {
    let bounds = |solid| Ok(Scene::compile_with(solid, options)?.bounds());
    let bounds: Vec<Aabb> = solids.iter().map(bounds).collect::<Result<_, _>>()?;
    let mut found = Vec::new();
    for [a, b] in meeting(&bounds) {
        if watch(0).is_break() {
            break;
        }
        let both = solids[a].clone() & solids[b].clone();
        let scene = Scene::compile_with(&both, options)?;
        if is_nothing(&scene) {
            continue;
        }
        let volume = volume_with(&scene, sampling, watch);
        if volume.value > 0.0 || volume.interval[1] > sampling.abs_tol {
            found.push(Overlap { pair: [a, b], volume, deepest: deepest(&scene) });
        }
    }
    Ok(found)
}

/// The pairs of boxes that have volume in common, found along the first axis.
fn meeting(bounds: &[Aabb]) -> Vec<[usize; 2]> {
    let mut order: Vec<usize> =
        (0..bounds.len()).filter(|&i| !bounds[i].is_empty()).collect();
    order.sort_by(|&a, &b| bounds[a].min.x.total_cmp(&bounds[b].min.x));
    let (mut pairs, mut open): (_, Vec<usize>) = (Vec::new(), Vec::new());
    for next in order {
        open.retain(|&other| bounds[other].max.x > bounds[next].min.x);
        let meets = |&&other: &&usize| bounds[other].gap(&bounds[next]) < 0.0;
        pairs.extend(open.iter().filter(meets).map(|&o| [o.min(next), o.max(next)]));
        open.push(next);
    }
    pairs.sort_unstable();
    pairs
}

/// The deepest of the middles of some chords.
fn deepest(scene: &Scene) -> Option<Deepest> {
    /// How many rays look for it along each axis.
    const RAYS: u32 = 1000;
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let mut tracer = scene.tracer();
    let mut best: Option<Deepest> = None;
    for axis in 0..3 {
        let beam = Beam::along(scene.bounds(), axis);
        for i in 0..RAYS {
            // Multiples of the golden ratio are even in any number.
            let right = (f64::from(i) + 0.5) / f64::from(RAYS);
            let up = (f64::from(i) * GOLDEN).fract();
            let ray = beam.fan.ray(right - 0.5, up - 0.5);
            let longest = |a: &&Span, b: &&Span| a.length().total_cmp(&b.length());
            let Some(span) = tracer.spans(&ray).iter().max_by(longest).copied() else {
                continue;
            };
            let length = span.length() * ray.speed();
            if best.is_some_and(|best| best.depth >= length) {
                continue;
            }
            let at = ray.at(0.5 * (span.enter.t + span.exit.t));
            let depth = depth(&mut tracer, at);
            if best.is_none_or(|best| best.depth < depth) {
                best = Some(Deepest { at, depth });
            }
        }
    }
    best
}

/// The shortest of the stretches along the axes that hold a point; zero if rounding has it
/// outside of one.
fn depth(tracer: &mut Tracer<'_>, at: DVec3) -> f64 {
    let along = |axis: DVec3| {
        let spans = tracer.spans(&Ray::new(at, axis));
        let holds = |span: &&Span| span.enter.t <= 0.0 && span.exit.t >= 0.0;
        spans.iter().find(holds).map_or(0.0, Span::length)
    };
    DVec3::AXES.map(along).into_iter().fold(f64::INFINITY, f64::min)
}
