//! Convex hulls of balls. Points are balls of radius zero.
//!
//! The surface of a hull of balls is made of parts of spheres, of parts of the cones around two
//! balls, and of plane facets that touch three balls or more. The facets' corners are where they
//! touch. Let Q be the convex hull of all these corners and of the points. Then the hull is the
//! union of Q, of the balls and of the frusta between the circles where cones touch their balls:
//!
//! - None of them reaches beyond the hull.
//! - All facets are in Q, all parts of cones in the frusta, all parts of spheres in the balls.
//! - Where a cone's wall lies between two facets, both meet it in lines through the cone's apex, so
//!   that the four corners on them are in a plane, and the quadrilateral between them in the frustum.
//!   The corners on one sphere have chords within its ball. So what is between these faces of Q
//!   and the surface of the hull is in the frusta and balls too.
//!
//! Directions in which a plane touches both of two balls make a circle. Every other ball stands out
//! over these planes on an arc of it; if something is left, its ends are normals of facets.
//!
//! Nothing that is added can reach beyond the hull, so in doubt it is added: a ball stands out
//! only where it does so by more than rounding.

use glam::DVec3;

use super::cone::{Cone, Left};
use super::leaves::Leaf;
use crate::facets::{self, FacetsError};
use crate::op::Op;
use crate::solid::Solid;

/// The most tests of a ball against a cone, which take a second or two.
const MOST_TESTS: usize = 30_000_000;

/// The angle in radians at which an arc of radius r stands out from its chord by r 2⁻⁵³, and an arc
/// of half of it from its tangent: no more than r is rounded by.
const FLAT: f64 = 1.0 / (1_u32 << 25) as f64;

/// A ball, or a point if its radius is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ball {
    pub(super) center: DVec3,
    pub(super) radius: f64,
}

/// The leaves as balls, if they are.
pub(super) fn of(leaves: &[Leaf]) -> Option<Vec<Ball>> {
    let mut balls = Vec::new();
    for leaf in leaves {
        match leaf {
            Leaf::Ball(ball) => balls.push(*ball),
            Leaf::Points(points) => balls.extend(points.iter().map(|&p| point(p))),
            Leaf::Cylinder { .. } => return None,
        }
    }
    Some(balls)
}

fn point(center: DVec3) -> Ball {
    Ball { center, radius: 0.0 }
}

/// The convex hull; `None` if there are too many balls, or some are not finite.
///
/// # Errors
///
/// If the hull of the points is no mesh.
pub(super) fn hull(all: Vec<Ball>) -> Result<Option<Solid>, FacetsError> {
    /// By what part of the size a distance can be wrong: the sums and products that make one of
    /// coordinates are some 30, each rounded by 2⁻⁵³.
    const ROUNDING: f64 = 128.0 * f64::EPSILON * 0.5;
    let reach = |ball: &Ball| ball.center.abs().max_element() + ball.radius;
    let slack = ROUNDING * all.iter().map(reach).fold(0.0, f64::max);
    if !slack.is_finite() || all.iter().any(|ball| !ball.center.is_finite()) {
        return Ok(None);
    }
    let (mut balls, points): (Vec<_>, Vec<_>) =
        all.into_iter().partition(|ball| ball.radius > 0.0);
    let round = balls.len();
    balls.extend(outermost(&points)?);
    let tests = round.saturating_mul(balls.len()).saturating_mul(balls.len());
    if tests > MOST_TESTS {
        return Ok(None);
    }
    let surface = Surface::new(apart(balls, slack), slack);
    surface.solid().map(Some)
}

/// The corners of the hull of points; all of them if they are in a plane.
fn outermost(points: &[Ball]) -> Result<Vec<Ball>, FacetsError> {
    let centers: Vec<DVec3> = points.iter().map(|ball| ball.center).collect();
    Ok(match facets::hull(&centers)? {
        Some(mesh) => mesh.points().iter().map(|&p| point(p)).collect(),
        None => points.to_vec(),
    })
}

/// The balls that are not within another, from the largest to the smallest.
fn apart(mut balls: Vec<Ball>, slack: f64) -> Vec<Ball> {
    balls.sort_by(|a, b| b.radius.total_cmp(&a.radius));
    let mut apart: Vec<Ball> = Vec::new();
    for ball in balls {
        let holds = |other: &Ball| {
            let distance = ball.center.distance(other.center);
            distance + ball.radius <= other.radius + slack
        };
        if !apart.iter().any(holds) {
            apart.push(ball);
        }
    }
    apart
}

/// What the surface of a hull is made of.
struct Surface {
    balls: Vec<Ball>,
    /// Whether a cone touches them; no others are on the surface, unless one is alone.
    touched: Vec<bool>,
    /// The normals of the facets that touch each ball.
    normals: Vec<Vec<DVec3>>,
    cones: Vec<Cone>,
}

impl Surface {
    /// The surface around balls, the largest first, none within another.
    fn new(balls: Vec<Ball>, slack: f64) -> Self {
        let count = balls.len();
        let round = balls.iter().filter(|ball| ball.radius > 0.0).count();
        let mut surface = Self {
            touched: vec![count == 1; count],
            normals: vec![Vec::new(); count],
            cones: Vec::new(),
            balls,
        };
        for i in 0..round {
            for j in i + 1..count {
                surface.join(i, j, slack);
            }
        }
        surface
    }

    /// Adds the cone of two balls and the facets beside it.
    fn join(&mut self, i: usize, j: usize, slack: f64) {
        let cone = Cone::new([self.balls[i], self.balls[j]]);
        let others = self.balls.iter().enumerate();
        let others = others.filter(|(k, _)| *k != i && *k != j).map(|(_, ball)| ball);
        let is_seen = match cone.left(others, slack) {
            Left::All => true,
            Left::Between(gaps) if gaps.is_empty() => return,
            Left::Between(gaps) => {
                for end in gaps.iter().flat_map(|gap| [gap.from, gap.to]) {
                    let normal = cone.normal(end.direction);
                    self.touch(i, normal);
                    self.touch(j, normal);
                }
                // Of others Q has all but what rounding takes.
                gaps.iter().any(|gap| gap.angle() > FLAT)
            }
        };
        self.touched[i] = true;
        self.touched[j] = true;
        if is_seen {
            self.cones.push(cone);
        }
    }

    /// Adds a facet that touches a ball, but once of those that differ so little that where one
    /// touches is within rounding of the plane of the other.
    fn touch(&mut self, ball: usize, normal: DVec3) {
        let known = &mut self.normals[ball];
        if known.iter().all(|other| other.distance(normal) > 0.5 * FLAT) {
            known.push(normal);
        }
    }

    fn solid(&self) -> Result<Solid, FacetsError> {
        let touching = |(ball, normals): (&Ball, &Vec<DVec3>)| -> Vec<DVec3> {
            if ball.radius > 0.0 {
                normals.iter().map(|n| ball.center + ball.radius * n).collect()
            } else {
                vec![ball.center]
            }
        };
        let corners = self.balls.iter().zip(&self.normals).flat_map(touching);
        let inner = facets::hull(&corners.collect::<Vec<_>>())?;
        let mut parts: Vec<Solid> = inner.into_iter().map(Solid::mesh).collect();
        parts.extend(self.cones.iter().map(Cone::solid));
        let on_it = self.balls.iter().zip(&self.touched);
        let on_it = on_it.filter(|(ball, touched)| **touched && ball.radius > 0.0);
        parts.extend(on_it.map(|(b, _)| Solid::ball(b.radius).translated(b.center)));
        Ok(match parts.len() {
            1 => parts.swap_remove(0),
            _ => Solid::boolean(Op::Union, parts),
        })
    }
}
