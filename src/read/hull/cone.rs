//! The cone that touches two balls from outside.
//!
//! ```text
//!              touches      u · (b − a) = rₐ − r_b, u of length 1:
//!         u ╲ ╱‾‾‾‾---___        u = sine · axis + cosine · (x cos φ + y sin φ)
//!        ╱   ╳           ‾‾‾‾╲ u
//!       │    a ───axis────►  b ╲
//! ```

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::arcs::{Arc, Gap, Positive, gaps, positive};
use super::balls::Ball;
use crate::solid::Solid;

/// A cone around two balls, or a cylinder.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    /// The larger one first, none within the other.
    balls: [Ball; 2],
    distance: f64,
    axis: DVec3,
    /// The directions x and y.
    across: [DVec3; 2],
    sine: f64,
    cosine: f64,
}

/// Which lines of a cone are on a hull.
#[derive(Clone, Debug)]
pub(super) enum Left {
    All,
    /// None if there are no gaps.
    Between(Vec<Gap>),
}

impl Cone {
    pub(super) fn new([a, b]: [Ball; 2]) -> Self {
        let between = b.center - a.center;
        let distance = between.length();
        let axis = between / distance;
        let sine = (a.radius - b.radius) / distance;
        let cosine = ((1.0 - sine) * (1.0 + sine)).max(0.0).sqrt();
        let across = axis.any_orthonormal_pair().into();
        Self { balls: [a, b], distance, axis, across, sine, cosine }
    }

    /// A normal, of length 1; outward.
    pub(super) fn normal(&self, direction: DVec2) -> DVec3 {
        let [x, y] = self.across;
        let across = direction.x * x + direction.y * y;
        self.sine * self.axis + self.cosine * across
    }

    /// What is left of the lines that touch both balls over which other balls do not stand out by
    /// more than `slack`.
    pub(super) fn left<'a>(
        &self,
        others: impl Iterator<Item = &'a Ball>,
        slack: f64,
    ) -> Left {
        let mut arcs: Vec<Arc> = Vec::new();
        for other in others {
            match self.hidden(other, slack) {
                Positive::Nowhere => {}
                Positive::Everywhere => return Left::Between(Vec::new()),
                Positive::On(arc) => arcs.push(arc),
            }
        }
        if arcs.is_empty() { Left::All } else { Left::Between(gaps(arcs)) }
    }

    /// Where a ball stands out over the cone. It does so everywhere if it touches it all around
    /// beyond the two balls: then the cone of the outer ones does for all three. (What is said to
    /// touch stands out so little that those between cannot be said to stand out over the longer
    /// cone.)
    fn hidden(&self, other: &Ball, slack: f64) -> Positive {
        let [a, _] = self.balls;
        let offset = other.center - a.center;
        let along = offset.dot(self.axis);
        let across = DVec2::from_array(self.across.map(|axis| offset.dot(axis)));
        let height = self.sine * along + (other.radius - a.radius);
        let amplitude = self.cosine * across;
        if amplitude.length() + height.abs() <= 0.25 * slack {
            return match along < -slack || along > self.distance + slack {
                true => Positive::Everywhere,
                false => Positive::Nowhere,
            };
        }
        positive(amplitude, height, slack)
    }

    /// What is between the circles where it touches.
    pub(super) fn solid(&self) -> Solid {
        let [a, b] = self.balls;
        let [x, y] = self.across;
        let height = self.distance * (self.cosine * self.cosine);
        let radii = [a, b].map(|ball| self.cosine * ball.radius);
        Solid::frustum_between(radii[0], radii[1], 0.0, height).mapped(DAffine3 {
            matrix3: DMat3::from_cols(x, y, self.axis),
            translation: a.center + self.sine * a.radius * self.axis,
        })
    }
}
