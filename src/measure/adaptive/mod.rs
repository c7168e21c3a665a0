//! Volume to many digits, for scenes with few surfaces.
//!
//! The volume is an integral over parallel slices of their areas, and an area one over parallel
//! rays of their chords. Both are functions that are analytic but at some places, and between
//! two such places Gauss's rule finds the integral to nearly all digits from a few dozen
//! values. All depends on no place being missed: adaptive rules that look for them by samples
//! converge to wrong numbers. So they are found from the equations of the surfaces.
//!
//! * A slice is critical at the height of a corner, of the extremum of an edge or a surface,
//!   or of an apex (`critical`): common zeros of three polynomials of degree two, all of which
//!   are found by enclosures (`system`).
//! * Within a slice (`slice`) chords break at corners and at the sides of conics: roots of
//!   polynomials of degree four.
//!
//! Slices are cut at an angle to the axes that depends on the seed. Models are full of faces
//! along the axes, for which the places degenerate into lines and planes: along the axes a cube
//! has no critical point at all, neither has a cylinder.
//!
//! That nothing was missed all the same is checked by as many rays on random lattices, whose
//! error is known.

mod body;
mod cells;
mod conic;
mod critical;
mod form;
mod polynomial;
mod rule;
mod slice;
mod system;

use std::time::{Duration, Instant};

use glam::{DMat3, DVec3};

use super::estimate::{Estimate, Method};
use super::lattice::Sampling;
use super::spread::T_QUANTILE;
use super::volume::{is_nothing, volume_with};
use crate::aabb::Aabb;
use crate::progress::{Watch, unwatched};
use crate::sampling::{hash, unit};
use crate::scene::{MOST_SURFACES, NotFew, Scene};
use body::Body;
use cells::{Budget, Integral, Whole};
use critical::Critical;
use rule::Rule;
use slice::Stack;

/// Why [`adaptive`] does not suit a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Unsuited {
    /// There is a mesh: its edges and corners are too many.
    #[error("leaf {leaf} is a mesh, not a primitive")]
    Mesh {
        /// The number of the leaf.
        leaf: u32,
    },
    /// The leaves lie on too many surfaces: three of them can meet in ever so many ways.
    #[error("the leaves lie on more than {MOST_SURFACES} different surfaces")]
    TooManySurfaces,
}

/// The volume, in cubic model units, of a scene with few primitives, to many digits.
///
/// A solid of sixteen surfaces takes a million rays to nine digits, and three to twelve.
/// The interval is no confidence interval: it is made of the differences between rules of
/// Gauss with more and fewer nodes, and of the rounding of the scene as it was compiled.
///
/// The value is compared to that of as many rays on lattices, as [`volume`](super::volume())
/// has them. Where the two differ by more than four standard errors the lattices' estimate
/// is returned, with [`Method::Lattice`] and a target that is not met; and also where the
/// limits do not suffice for the slices, in which case the target may be met. So the method of the
/// estimate says how the value was found.
///
/// ```
/// use solidray::{Scene, Solid, measure};
///
/// let ball = Scene::compile(&Solid::ball(3.0))?;
/// let sampling = measure::Sampling { rel_tol: 1e-12, ..Default::default() };
/// let volume = measure::adaptive(&ball, &sampling)?;
/// assert!((volume.value - 36.0 * std::f64::consts::PI).abs() < 1e-12 * volume.value);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// Where there is a mesh, or more than 64 different surfaces.
pub fn adaptive(scene: &Scene, sampling: &Sampling) -> Result<Estimate, Unsuited> {
    adaptive_with(scene, sampling, &unwatched)
}

/// [`adaptive`], which tells how it gets on and can be stopped: then by a few lattices.
///
/// # Errors
///
/// As [`adaptive`].
pub fn adaptive_with(
    scene: &Scene,
    sampling: &Sampling,
    watch: Watch<'_>,
) -> Result<Estimate, Unsuited> {
    if is_nothing(scene) {
        return Ok(Estimate::exact(0.0));
    }
    let limits = Limits { sampling, start: Instant::now(), watch };
    let frame = Frame::new(&scene.bounds(), sampling.seed);
    let equations =
        scene.equations(frame.origin, frame.map).map_err(|why| match why {
            NotFew::Mesh(leaf) => Unsuited::Mesh { leaf },
            NotFew::Surfaces => Unsuited::TooManySurfaces,
        })?;
    let whole = frame.integral(scene, &Body::new(equations), &limits);
    Ok(checked(scene, &frame, &whole, &limits))
}

/// The coordinates u, v and w: along no axis, and so that the bounds are a cube of edge 2
/// before it is turned.
#[derive(Clone, Copy, Debug)]
struct Frame {
    bounds: Aabb,
    turn: DMat3,
    origin: DVec3,
    map: DMat3,
}

/// No coordinate of the turned cube is larger than √3.
const REACH: f64 = 1.75;

/// The numbers of nodes of the rules for curved solids, tried one after the other.
const NODES: [u32; 4] = [10, 20, 40, 80];

/// The same for solids with flat faces: chords are linear between two breaks, areas quadratic.
const NODES_OF_FLAT: [u32; 2] = [2, 4];

impl Frame {
    fn new(bounds: &Aabb, seed: u64) -> Self {
        /// Angles that are not special, nor are those near them.
        const ANGLES: [f64; 3] = [0.7, 0.4, 1.1];
        const SPREAD: f64 = 0.1;
        let angle = |i: usize| ANGLES[i] + SPREAD * (unit(hash(seed, &[i as u64])) - 0.5);
        let turn = DMat3::from_rotation_x(angle(0))
            * DMat3::from_rotation_y(angle(1))
            * DMat3::from_rotation_z(angle(2));
        let map = DMat3::from_diagonal(0.5 * bounds.size()) * turn;
        Self { bounds: *bounds, turn, origin: bounds.center(), map }
    }

    /// The volume of a unit of u, v and w.
    fn unit(&self) -> f64 {
        (0.5 * self.bounds.size()).element_product()
    }

    /// At most how far rounding moves a surface, in units of u, v and w, as a rule: as much
    /// as it moves coordinates of the world, and those of the cube.
    fn rounding(&self) -> f64 {
        let reach = self.bounds.min.abs().max(self.bounds.max.abs());
        f64::EPSILON * (1.0 + (reach / (0.5 * self.bounds.size())).max_element())
    }

    /// Whether some points of a box may be in the bounds.
    fn may_hold(&self, part: &Aabb) -> bool {
        /// Nothing on the bounds is to be lost by rounding.
        const MARGIN: f64 = 1e-6;
        let (center, half) = (part.center(), 0.5 * part.size());
        let most = self.turn.abs() * half + (1.0 + MARGIN);
        (self.turn * center).abs().cmple(most).all()
    }

    /// The volume in units of u, v and w.
    fn integral(&self, scene: &Scene, body: &Body<'_>, limits: &Limits<'_>) -> Whole {
        let within = Aabb::new(DVec3::splat(-REACH), DVec3::splat(REACH));
        let budget = limits.budget();
        let may_hold = |part: &Aabb| self.may_hold(part);
        let critical = Critical::find(body, &within, may_hold, budget.deadline);
        let Some(Critical { heights, meets }) = critical else {
            return Whole::default();
        };
        let is_flat = body.forms.iter().all(|form| form.square == DMat3::ZERO);
        let rules = if is_flat {
            NODES_OF_FLAT.map(|count| Rule::new(count, 0)).to_vec()
        } else {
            NODES.map(|count| Rule::new(count, 1)).to_vec()
        };
        let stack = Stack {
            body,
            meets,
            origin: self.origin,
            map: self.map,
            reach: REACH,
            rounding: self.rounding(),
            rules,
        };
        Integral::new(&stack, scene, &heights, budget).found()
    }
}

/// How far to go.
#[derive(Clone, Copy)]
struct Limits<'a> {
    sampling: &'a Sampling,
    start: Instant,
    watch: Watch<'a>,
}

impl<'a> Limits<'a> {
    /// What the slices may take: half of all, the rest is for the check, or for what
    /// is done instead.
    fn budget(&self) -> Budget<'a> {
        let Sampling { rel_tol, max_rays, time_limit, .. } = *self.sampling;
        let half = time_limit.map(|limit| limit / 2);
        Budget {
            // Some is left for rounding.
            rel_tol: 0.9 / SAFETY * rel_tol,
            rays: max_rays / 2,
            deadline: half.and_then(|half| self.start.checked_add(half)),
            watch: self.watch,
        }
    }

    /// The estimate from lattices within what is left after some rays.
    fn lattice(&self, scene: &Scene, rel_tol: f64, rays: u64, spent: u64) -> Estimate {
        let left = |limit: Duration| limit.saturating_sub(self.start.elapsed());
        let is_stopped = (self.watch)(0).is_break();
        if is_stopped {
            // One round is soon done, and better than nothing.
            let sampling = Sampling { max_rays: 0, time_limit: None, ..*self.sampling };
            let found = volume_with(scene, &sampling, &unwatched);
            return Estimate { rays: found.rays + spent, ..found };
        }
        let sampling = Sampling {
            rel_tol,
            abs_tol: self.sampling.abs_tol,
            max_rays: rays.min(self.sampling.max_rays.saturating_sub(spent)),
            time_limit: self.sampling.time_limit.map(left),
            seed: self.sampling.seed,
        };
        let found = volume_with(scene, &sampling, self.watch);
        Estimate { rays: found.rays + spent, ..found }
    }
}

/// The interval is that many times as wide as the sum of the differences of rules. Of a thousand
/// errors, those of curved solids as in the tests seen from thirty directions each, none was larger
/// than a tenth of the interval.
const SAFETY: f64 = 2.0;

/// The lattices need not be better than this.
const CHECK: f64 = 1e-5;

/// So many standard errors apart two numbers are not the same: one time in a thousand by
/// chance, for Student's t with 15 degrees of freedom.
const APART: f64 = 4.0;

/// Where they are, more rays decide whether it was chance.
const MORE_RAYS: u64 = 16;

/// The estimate that the slices give, if lattices do not contradict; theirs otherwise.
fn checked(scene: &Scene, frame: &Frame, whole: &Whole, limits: &Limits<'_>) -> Estimate {
    let Whole { sum, finished } = whole;
    let Sampling { rel_tol, max_rays, .. } = *limits.sampling;
    let unit = frame.unit();
    let value = unit * sum.value;
    if !finished || !value.is_finite() {
        return limits.lattice(scene, rel_tol, max_rays, sum.rays);
    }
    let half_width = unit * (SAFETY * sum.error + frame.rounding() * sum.ends);
    let found = Estimate {
        value,
        interval: [(value - half_width).max(0.0), value + half_width],
        rays: sum.rays,
        method: Method::Adaptive,
        target_met: half_width <= limits.sampling.allowed(value),
        resolved: true,
        spans: sum.spans,
        uncertain: sum.uncertain,
    };
    let mut check = limits.lattice(scene, CHECK, sum.rays, sum.rays);
    if value > 0.0 && check.rays > sum.rays && !agree(&found, &check) {
        let more = sum.rays.saturating_mul(MORE_RAYS);
        check = limits.lattice(scene, CHECK, more, check.rays);
    }
    // Without a span there is nothing to be said but that it is small.
    if value > 0.0 && check.rays > sum.rays && agree(&found, &check) {
        Estimate { rays: check.rays, ..found }
    } else {
        Estimate { target_met: false, ..check }
    }
}

/// Whether a value may be what lattices estimate.
fn agree(found: &Estimate, check: &Estimate) -> bool {
    let room = found.half_width();
    if check.resolved {
        let standard_error = (check.interval[1] - check.value) / T_QUANTILE;
        (found.value - check.value).abs() <= APART * standard_error + room
    } else {
        found.value <= check.interval[1] + room
    }
}
