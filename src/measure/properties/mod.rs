//! Volume, surface, centroid, inertia and mass from the same rays.

mod integrals;
mod principal;
mod quantity;
mod run;
mod several;
mod summed;

use glam::DVec3;
use thiserror::Error;

use super::estimate::Method;
use super::lattice::Sampling;
use crate::aabb::Aabb;
use crate::progress::Watch;
use crate::scene::Scene;
pub use quantity::Quantity;
pub use run::{Missed, Replicate, Run, run};
use summed::Summed;

/// What rays find out about a solid. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub struct Properties {
    /// The volume. Where it is not resolved the end of its interval is a one-sided bound, and it
    /// begins at zero or with what is known of some of it.
    pub volume: Quantity,
    /// The area of the surface; cavities have one, too. No bound above where the volume is not
    /// resolved.
    pub area: Quantity,
    /// The centre of the volume, and the inertia; nothing where the volume is not resolved or
    /// zero.
    pub body: Option<Body>,
    /// A box around all ends of chords that were found: the solid reaches at least so far.
    pub reached: Aabb,
    /// A box that holds the solid.
    pub bounds: Aabb,
    /// How many rays were spent, those of earlier rounds included.
    pub rays: u64,
    /// How it was measured.
    pub method: Method,
    /// Whether enough rays met the solid for the numbers to mean anything.
    pub resolved: bool,
    /// How many stretches of rays inside the solid the numbers were found from.
    pub spans: u64,
    /// How many of them, and of the gaps between them, are so short that rounding decides
    /// whether they are there.
    pub uncertain: u64,
}

/// How a solid of density 1 behaves when it is moved.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The centre of the volume. Its target is a fraction of the radius of gyration.
    pub centroid: [Quantity; 3],
    /// The inertia tensor about the centroid: ∫ (r² δᵢⱼ − xᵢ xⱼ) dV, in model units to the fifth
    /// power. The target of all entries is a fraction of the mean of the diagonal.
    pub inertia: [[Quantity; 3]; 3],
    /// The principal moments about the centroid and their axes, the smallest moment first; the
    /// axes are right-handed.
    pub principal: [Principal; 3],
}

/// A principal moment of inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principal {
    /// The moment about the axis.
    pub moment: Quantity,
    /// A unit vector, either way.
    pub axis: DVec3,
    /// By how much the axis may be turned, in radians, with 95 % confidence; π/2 where moments
    /// are so nearly equal that nothing can be said.
    pub angle: f64,
}

impl Properties {
    /// Whether all intervals are as narrow as was asked for.
    pub fn target_met(&self) -> bool {
        self.resolved && self.quantities().iter().all(Quantity::target_met)
    }

    /// All numbers with a target.
    fn quantities(&self) -> Vec<Quantity> {
        quantities(self.volume, self.area, self.body.as_ref())
    }

    /// How many times as wide as it was to be the widest interval is; no number where there is
    /// no telling.
    fn distance(&self) -> f64 {
        if self.resolved { widest(self.quantities()) } else { f64::NAN }
    }
}

fn quantities(volume: Quantity, area: Quantity, body: Option<&Body>) -> Vec<Quantity> {
    let mut all = vec![volume, area];
    if let Some(Body { centroid, inertia, principal }) = body {
        all.extend(centroid);
        all.extend(inertia.iter().flatten());
        all.extend(principal.iter().map(|p| p.moment));
    }
    all
}

/// How many times as wide as it was to be the widest interval is.
fn widest(quantities: Vec<Quantity>) -> f64 {
    let uncertain = quantities.into_iter().filter(|q| q.half_width() > 0.0);
    uncertain.map(|q| q.half_width() / q.target).fold(0.0, f64::max)
}

/// Why runs cannot be combined.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum MergeError {
    /// There are none.
    #[error("there is nothing to merge")]
    Nothing,
    /// They covered different boxes, so they cannot have measured the same solid.
    #[error("the runs measured different solids: they covered different boxes")]
    DifferentSolids,
    /// Two had the same random numbers, so they are no independent evidence.
    #[error("two runs have the same seed {0}, so they are not independent")]
    SameSeed(u64),
    /// A run has fewer than 16 lattices, or counts that no run can have.
    #[error("a run is not complete: it was cut short or altered")]
    Incomplete,
}

/// Volume, surface, centroid and inertia, by lattices of rays along three axes, until all of them
/// are as exact as `sampling` asks.
///
/// What is far apart, or much smaller than the rest, is measured in boxes of its own, as by
/// [`volume`](super::volume()).
///
/// ```
/// use glam::dvec3;
/// use solidray::{Scene, Solid, measure, unwatched};
///
/// let brick = Scene::compile(&Solid::cuboid(dvec3(1.0, 2.0, 3.0)))?;
/// let sampling = measure::Sampling { rel_tol: 1e-3, ..Default::default() };
/// let found = measure::properties(&brick, &sampling, &unwatched);
/// assert!((found.area.value - 22.0).abs() < 0.03);
/// # Ok::<(), solidray::CompileError>(())
/// ```
pub fn properties(scene: &Scene, sampling: &Sampling, watch: Watch<'_>) -> Properties {
    let run = run(scene, sampling, watch);
    summary(&[run], sampling)
}

/// Several runs of one solid with different seeds as one. It does not matter in which order they
/// are given, nor on which machines they were made.
///
/// # Errors
///
/// If they are of different solids or not independent.
pub fn merge(runs: &[Run], sampling: &Sampling) -> Result<Properties, MergeError> {
    Ok(summary(&in_order(runs)?, sampling))
}

/// The runs of one solid by their seeds, if they can be combined.
fn in_order(runs: &[Run]) -> Result<Vec<Run>, MergeError> {
    let [first, ..] = runs else { return Err(MergeError::Nothing) };
    let mut sorted = runs.to_vec();
    sorted.sort_by_key(|run| run.seed);
    if let Some(pair) = sorted.windows(2).find(|pair| pair[0].seed == pair[1].seed) {
        return Err(MergeError::SameSeed(pair[0].seed));
    }
    if sorted.iter().any(|run| run.bounds != first.bounds) {
        return Err(MergeError::DifferentSolids);
    }
    if !sorted.iter().all(Run::is_complete) {
        return Err(MergeError::Incomplete);
    }
    Ok(sorted)
}

/// What the runs of one solid say together.
fn summary(runs: &[Run], sampling: &Sampling) -> Properties {
    let bounds = runs[0].bounds;
    let replicates = || runs.iter().flat_map(|run| &run.replicates);
    let count = |of: fn(&Replicate) -> u64| replicates().map(of).sum();
    let summed = Summed::of(runs, sampling);
    Properties {
        volume: summed.volume(sampling),
        area: summed.area(sampling),
        body: summed.body(sampling.rel_tol),
        reached: runs.iter().fold(Aabb::EMPTY, |b, run| b.hull(run.reached)),
        bounds,
        rays: runs.iter().map(|run| run.rays).sum(),
        method: if summed.is_nothing { Method::Exact } else { Method::Lattice },
        resolved: summed.is_resolved,
        spans: count(|r| r.spans),
        uncertain: count(|r| r.uncertain),
    }
}

/// The mass of some parts together.
#[derive(Clone, Debug, PartialEq)]
pub struct Mass {
    /// Volumes times densities. Where some part is not resolved the end of the interval is a
    /// one-sided bound, and it begins at zero or with what is known.
    pub mass: Quantity,
    /// The centre of mass, and the inertia; nothing where some part is not resolved, or all are
    /// nothing.
    pub body: Option<Body>,
}

/// The mass of parts with their densities, each given by runs that were made with other seeds
/// than those of the other parts. Where parts overlap their densities add up.
///
/// # Errors
///
/// If the runs of a part cannot be combined, or there are no parts.
pub fn mass(parts: &[(f64, &[Run])], sampling: &Sampling) -> Result<Mass, MergeError> {
    let mut all: Option<Summed> = None;
    for &(density, runs) in parts {
        let part = Summed::of(&in_order(runs)?, sampling).times(density);
        all = Some(match all {
            None => part,
            Some(all) => all.and(part),
        });
    }
    let all = all.ok_or(MergeError::Nothing)?;
    let mass = all.volume(sampling);
    Ok(Mass { mass, body: all.body(sampling.rel_tol) })
}
