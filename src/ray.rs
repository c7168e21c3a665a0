//! Rays, crossings and spans: the words in which every query is asked and answered.

use glam::DVec3;

/// A whole line with an origin and a direction; the point at `t` is
/// `origin + t · dir`.
///
/// The direction is never normalised, so `t` counts multiples of `dir` and names the
/// same point before and after any affine map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point at `t = 0`.
    pub origin: DVec3,
    /// The step from `t` to `t + 1`; any length but zero.
    pub dir: DVec3,
}

impl Ray {
    /// The line through `origin` along `dir`.
    pub const fn new(origin: DVec3, dir: DVec3) -> Self {
        Self { origin, dir }
    }

    /// The point at `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.dir
    }

    /// The length of the direction: how far a step of `t` goes. Right for directions so long
    /// or short that their squares are no numbers.
    pub fn speed(&self) -> f64 {
        let largest = self.dir.abs().max_element();
        if largest > 0.0 { largest * (self.dir / largest).length() } else { 0.0 }
    }

    /// Whether all components are finite and the direction is not zero. A ray that is
    /// not valid meets nothing.
    pub fn is_valid(&self) -> bool {
        self.origin.is_finite() && self.dir.is_finite() && self.dir != DVec3::ZERO
    }
}

/// Which way a ray passes through the boundary of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sense {
    /// From outside to inside.
    Enter,
    /// From inside to outside.
    Exit,
}

impl Sense {
    /// The other way.
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::Enter => Self::Exit,
            Self::Exit => Self::Enter,
        }
    }
}

/// A place where a ray passes through the boundary of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Where on the ray, in multiples of its direction.
    pub t: f64,
    /// Which leaf of the scene owns the surface; see [`Scene::leaf`](crate::Scene::leaf).
    pub leaf: u32,
    /// Which face of the leaf.
    pub face: u32,
    /// Whether the ray goes in or out there.
    pub sense: Sense,
}

/// A stretch of a ray inside a solid, with `enter.t < exit.t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Where the ray goes in.
    pub enter: Crossing,
    /// Where it comes out.
    pub exit: Crossing,
}

impl Span {
    /// The length in multiples of the ray's direction.
    pub fn length(&self) -> f64 {
        self.exit.t - self.enter.t
    }
}
