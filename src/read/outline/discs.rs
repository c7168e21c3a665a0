//! Convex hulls of discs and polygons, exact: discs, and the polygon of the points where tangents
//! touch them.
//!
//! Corners of polygons are discs of radius zero. A line that touches two discs is a side of the hull
//! if no other disc stands out over it. All that is made lies in the hull, since tangents touch
//! discs within them, so a tangent too many does no harm. One too few would cut a side off:
//! a disc stands out only where it does so by more than rounding.

use glam::{DAffine2, DVec2};

use super::{Kind, Outline, Shape, hull};
use crate::op::Op;
use crate::similar::plane_scale;

/// The most tests of a disc against a tangent, which take a second or so.
const MOST_TESTS: usize = 100_000_000;

/// A disc, or a point if its radius is zero.
#[derive(Clone, Copy, Debug)]
pub(in crate::read) struct Disc {
    pub(in crate::read) center: DVec2,
    pub(in crate::read) radius: f64,
}

impl Disc {
    pub(in crate::read) fn point(center: DVec2) -> Self {
        Self { center, radius: 0.0 }
    }
}

/// The convex hull of outlines with circles; `None` if there are no circles, or some that are
/// stretched or take part in a difference or an intersection.
pub(in crate::read) fn exact_hull(outlines: &[Outline]) -> Option<Outline> {
    let discs = discs(outlines)?;
    let has_circles = discs.iter().any(|disc| disc.radius > 0.0);
    if has_circles { hull_of_discs(discs) } else { None }
}

/// The convex hull of discs; `None` if there are too many.
pub(in crate::read) fn hull_of_discs(all: Vec<Disc>) -> Option<Outline> {
    let (mut discs, points): (Vec<_>, Vec<_>) =
        all.into_iter().partition(|disc| disc.radius > 0.0);
    let points: Vec<DVec2> = points.into_iter().map(|point| point.center).collect();
    let polygon = hull(points.iter().copied());
    let points = if polygon.is_empty() { points } else { polygon };
    let round = discs.len();
    discs.extend(points.into_iter().map(Disc::point));
    let tests = round.saturating_mul(discs.len()).saturating_mul(discs.len());
    if tests > MOST_TESTS {
        return None;
    }
    let sides = Sides::of(discs)?;
    let mut parts = sides.discs_on_it();
    let polygon = hull(sides.corners());
    if !polygon.is_empty() {
        parts.push(Outline::paths(vec![polygon]));
    }
    Some(Outline::boolean(Op::Union, parts))
}

/// The tangents of a hull.
struct Sides {
    /// From the largest to the smallest, none within another.
    discs: Vec<Disc>,
    /// Which of them a tangent touches.
    touched: Vec<bool>,
    /// Where tangents touch discs.
    touching: Vec<DVec2>,
    /// What a disc has to stand out by.
    slack: f64,
}

impl Sides {
    /// The tangents of discs; `None` if these are not finite.
    fn of(mut discs: Vec<Disc>) -> Option<Self> {
        /// By what part of the size a distance can be wrong: the sums and products that make one of
        /// coordinates are some 20, each rounded by 2⁻⁵³.
        const ROUNDING: f64 = 128.0 * f64::EPSILON * 0.5;
        let reach = |disc: &Disc| disc.center.abs().max_element() + disc.radius;
        let slack = ROUNDING * discs.iter().map(reach).fold(0.0, f64::max);
        if !slack.is_finite() {
            return None;
        }
        discs.sort_by(|a, b| b.radius.total_cmp(&a.radius));
        let mut apart: Vec<Disc> = Vec::new();
        for disc in discs {
            let holds = |other: &Disc| {
                let distance = disc.center.distance(other.center);
                distance + disc.radius <= other.radius + slack
            };
            if !apart.iter().any(holds) {
                apart.push(disc);
            }
        }
        let touched = vec![false; apart.len()];
        let mut sides = Self { discs: apart, touched, touching: Vec::new(), slack };
        let round = sides.discs.iter().filter(|disc| disc.radius > 0.0).count();
        for i in 0..round {
            for j in i + 1..sides.discs.len() {
                sides.join(i, j);
            }
        }
        Some(sides)
    }

    /// Adds the tangents of two discs that are sides.
    fn join(&mut self, i: usize, j: usize) {
        let [a, b] = [self.discs[i], self.discs[j]];
        let between = b.center - a.center;
        let distance = between.length();
        let along = between / distance;
        // Both stand out equally in a direction u with u · (b − a) = rₐ − r_b.
        let sine = (a.radius - b.radius) / distance;
        let cosine = ((1.0 - sine) * (1.0 + sine)).max(0.0).sqrt();
        for side in [along.perp(), -along.perp()] {
            let normal = sine * along + cosine * side;
            let hides = |k: usize| k != i && k != j && self.hides(k, [&a, &b], normal);
            if !(0..self.discs.len()).any(hides) {
                self.touched[i] = true;
                self.touched[j] = true;
                self.touching.extend([a, b].map(|d| d.center + d.radius * normal));
            }
        }
    }

    /// Whether a disc stands out over a tangent, or touches it beyond the two that it is of, so
    /// that the tangent of the outer ones does for all three. (What is said to touch stands out so
    /// little that those between cannot be said to stand out over the longer tangent.)
    fn hides(&self, k: usize, [a, b]: [&Disc; 2], normal: DVec2) -> bool {
        let other = &self.discs[k];
        let offset = other.center - a.center;
        let height = offset.dot(normal) + (other.radius - a.radius);
        if height.abs() > 0.25 * self.slack {
            return height > self.slack;
        }
        let length = (b.center - a.center).perp_dot(normal);
        let way = offset.perp_dot(normal) * length.signum();
        way < -self.slack || way > length.abs() + self.slack
    }

    /// Where tangents touch discs, and the points.
    fn corners(&self) -> impl Iterator<Item = DVec2> + '_ {
        let points = self.discs.iter().filter(|disc| disc.radius <= 0.0);
        points.map(|point| point.center).chain(self.touching.iter().copied())
    }

    /// The discs that tangents touch, or the one that there is.
    fn discs_on_it(&self) -> Vec<Outline> {
        let is_alone = self.discs.len() == 1;
        let on_it = |(disc, touched): (&Disc, &bool)| {
            ((*touched || is_alone) && disc.radius > 0.0).then(|| {
                let circle = Outline::shape(Shape::Circle { radius: disc.radius });
                circle.mapped(DAffine2::from_translation(disc.center))
            })
        };
        self.discs.iter().zip(&self.touched).filter_map(on_it).collect()
    }
}

/// The discs of unions of circles and polygons; `None` if circles are stretched or take part in
/// another operation.
fn discs(outlines: &[Outline]) -> Option<Vec<Disc>> {
    let mut found = Vec::new();
    let mut open: Vec<_> = outlines.iter().map(|o| (o, DAffine2::IDENTITY)).collect();
    while let Some((outline, map)) = open.pop() {
        let children = &outline.0.children;
        let mut points = |points: &mut dyn Iterator<Item = DVec2>| {
            found.extend(points.map(|p| Disc::point(map.transform_point2(p))));
        };
        match &outline.0.kind {
            Kind::Shape(Shape::Square { min, max }) => {
                let (right, left) = (DVec2::new(max.x, min.y), DVec2::new(min.x, max.y));
                points(&mut [*min, right, *max, left].into_iter());
            }
            Kind::Shape(Shape::Paths(paths)) => {
                points(&mut paths.iter().flatten().copied());
            }
            Kind::Shape(Shape::Circle { radius }) => {
                let radius = radius * plane_scale(&map.matrix2)?;
                found.push(Disc { center: map.translation, radius });
            }
            Kind::Boolean(op) if *op != Op::Union && children.len() > 1 => {
                if has_circles(outline) {
                    return None;
                }
                points(&mut outline.polygons(&|_| 3).into_iter().flatten());
            }
            Kind::Mapped(own) => {
                open.extend(children.iter().map(|child| (child, map * *own)));
            }
            Kind::Boolean(_) | Kind::Tagged(_) => {
                open.extend(children.iter().map(|child| (child, map)));
            }
        }
    }
    Some(found)
}

fn has_circles(outline: &Outline) -> bool {
    let mut open = vec![outline];
    while let Some(outline) = open.pop() {
        if matches!(outline.0.kind, Kind::Shape(Shape::Circle { .. })) {
            return true;
        }
        open.extend(&outline.0.children);
    }
    false
}
