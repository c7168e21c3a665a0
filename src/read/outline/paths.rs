//! Outlines as simple polygons.

use std::f64::consts::TAU;

use clipper2_rust::{
    FillRule, Path64, Paths64, Point64, difference_64, intersect_64, union_subjects_64,
};
use glam::{DAffine2, DVec2};

use super::{Fold, Outline, Shape, Within};
use crate::mesh::round;
use crate::op::Op;
use crate::solid::Tag;

/// Simple polygons that do not cross each other: outer ones counter-clockwise, holes clockwise.
pub(in crate::read) type Paths = Vec<Vec<DVec2>>;

/// Coordinates are whole numbers up to 2 to this power, so that their differences and the sums of
/// products of three are good to twelve digits.
const BITS: f64 = 40.0;

impl Outline {
    /// The polygons of the outline, circles with `segments` of their radius, none if it is empty.
    pub(in crate::read) fn polygons(&self, segments: &dyn Fn(f64) -> u32) -> Paths {
        let Ok(reach) = self.fold(&mut Reach);
        let Some(scale) = scale(reach) else { return Vec::new() };
        let mut clip = Clip { segments, scale };
        let Ok(paths) = self.fold(&mut clip);
        back(&union_subjects_64(&paths, FillRule::NonZero), scale)
    }

    /// The corners of the smallest box around an outline that is not empty and a union; `None` if
    /// something is subtracted or intersected.
    pub(in crate::read) fn bounds_of_union(&self) -> Option<[DVec2; 2]> {
        self.fold(&mut Bounds).ok()
    }
}

/// What closed paths wind around, as simple polygons.
pub(in crate::read) fn filled(paths: &Paths) -> Paths {
    filled_by(paths, FillRule::NonZero)
}

/// What closed paths enclose by a rule, as simple polygons.
pub(super) fn filled_by(paths: &Paths, rule: FillRule) -> Paths {
    let points = paths.iter().flatten();
    let reach = points.map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let Some(scale) = scale(reach) else { return Vec::new() };
    let rounded: Paths64 = paths
        .iter()
        .map(|path| path.iter().map(|&p| rounded(p, scale)).collect())
        .collect();
    back(&union_subjects_64(&rounded, rule), scale)
}

/// By what coordinates up to some size are multiplied; `None` if there are no sizes.
fn scale(reach: f64) -> Option<f64> {
    if reach <= 0.0 || !reach.is_finite() {
        return None;
    }
    Some((BITS - 1.0 - reach.log2().ceil().clamp(-900.0, 900.0)).exp2())
}

#[expect(clippy::cast_possible_truncation, reason = "the scale makes it small enough")]
fn rounded(p: DVec2, scale: f64) -> Point64 {
    let p = (p * scale).round();
    Point64::new(p.x as i64, p.y as i64)
}

fn back(paths: &Paths64, scale: f64) -> Paths {
    let point = |p: &Point64| DVec2::new(p.x as f64, p.y as f64) / scale;
    paths.iter().map(|path| path.iter().map(point).collect()).collect()
}

/// The box around unions.
struct Bounds;

impl Fold<[DVec2; 2], ()> for Bounds {
    fn shape(&mut self, shape: &Shape, within: &Within) -> Result<[DVec2; 2], ()> {
        let map = within.map;
        Ok(match shape {
            Shape::Square { min, max } => {
                let others = [DVec2::new(max.x, min.y), DVec2::new(min.x, max.y)];
                around([*min, *max].into_iter().chain(others), &map)
            }
            Shape::Circle { radius } => {
                let rows = map.matrix2.transpose();
                let side =
                    *radius * DVec2::new(rows.x_axis.length(), rows.y_axis.length());
                [map.translation - side, map.translation + side]
            }
            Shape::Paths(paths) => around(paths.iter().flatten().copied(), &map),
        })
    }

    fn boolean(&mut self, op: Op, parts: Vec<[DVec2; 2]>) -> Result<[DVec2; 2], ()> {
        if op != Op::Union && parts.len() > 1 {
            return Err(());
        }
        Ok(around(parts.into_iter().flatten(), &DAffine2::IDENTITY))
    }

    fn tagged(&mut self, _: &Tag, part: [DVec2; 2]) -> [DVec2; 2] {
        part
    }
}

fn around(points: impl Iterator<Item = DVec2>, map: &DAffine2) -> [DVec2; 2] {
    points
        .map(|p| map.transform_point2(p))
        .fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], p| {
            [low.min(p), high.max(p)]
        })
}

/// A polygon with so many corners that has the area of a circle: every other corner would do for
/// the eye, but then volumes would be too small.
fn fine_circle(radius: f64, segments: u32) -> Vec<DVec2> {
    let sector = TAU / f64::from(segments);
    round::circle(segments, radius * (sector / sector.sin()).sqrt())
}

/// How far an outline reaches from the origin along an axis, at most.
struct Reach;

impl Fold<f64, std::convert::Infallible> for Reach {
    fn shape(
        &mut self,
        shape: &Shape,
        within: &Within,
    ) -> Result<f64, std::convert::Infallible> {
        let far = |p: DVec2| within.map.transform_point2(p).abs().max_element();
        Ok(match shape {
            Shape::Square { min, max } => {
                let corners =
                    [*min, *max, DVec2::new(min.x, max.y), DVec2::new(max.x, min.y)];
                corners.map(far).into_iter().fold(0.0, f64::max)
            }
            // Fine polygons reach a little farther than circles.
            Shape::Circle { radius } => [-1.5, 1.5]
                .into_iter()
                .flat_map(|x| [-1.5, 1.5].map(|y| far(*radius * DVec2::new(x, y))))
                .fold(0.0, f64::max),
            Shape::Paths(paths) => {
                paths.iter().flatten().map(|&p| far(p)).fold(0.0, f64::max)
            }
        })
    }

    fn boolean(
        &mut self,
        _: Op,
        parts: Vec<f64>,
    ) -> Result<f64, std::convert::Infallible> {
        Ok(parts.into_iter().fold(0.0, f64::max))
    }

    fn tagged(&mut self, _: &Tag, part: f64) -> f64 {
        part
    }
}

/// Clipping in whole numbers.
struct Clip<'a> {
    segments: &'a dyn Fn(f64) -> u32,
    scale: f64,
}

impl Clip<'_> {
    fn path(&self, points: &[DVec2], within: &Within) -> Path64 {
        let place = |&p: &DVec2| rounded(within.map.transform_point2(p), self.scale);
        points.iter().map(place).collect()
    }
}

impl Fold<Paths64, std::convert::Infallible> for Clip<'_> {
    fn shape(
        &mut self,
        shape: &Shape,
        within: &Within,
    ) -> Result<Paths64, std::convert::Infallible> {
        let paths: Paths64 = match shape {
            Shape::Square { min, max } => {
                let (right, left) = (DVec2::new(max.x, min.y), DVec2::new(min.x, max.y));
                vec![self.path(&[*min, right, *max, left], within)]
            }
            Shape::Circle { radius } => {
                let circle = fine_circle(*radius, (self.segments)(*radius));
                vec![self.path(&circle, within)]
            }
            Shape::Paths(paths) => {
                paths.iter().map(|path| self.path(path, within)).collect()
            }
        };
        Ok(union_subjects_64(&paths, FillRule::EvenOdd))
    }

    fn boolean(
        &mut self,
        op: Op,
        parts: Vec<Paths64>,
    ) -> Result<Paths64, std::convert::Infallible> {
        let mut parts = parts.into_iter();
        Ok(match op {
            Op::Union => {
                let all: Paths64 = parts.flatten().collect();
                union_subjects_64(&all, FillRule::NonZero)
            }
            Op::Intersection => {
                let first = parts.next().unwrap_or_default();
                parts.fold(first, |a, b| intersect_64(&a, &b, FillRule::NonZero))
            }
            Op::Difference => {
                let first = parts.next().unwrap_or_default();
                let rest: Paths64 = parts.flatten().collect();
                difference_64(&first, &rest, FillRule::NonZero)
            }
        })
    }

    fn tagged(&mut self, _: &Tag, part: Paths64) -> Paths64 {
        part
    }
}
