//! Outlines grown and shrunk.
//!
//! Every edge is moved along its normal, and every corner that this tears open is closed by a
//! join; what the closed lines run around counter-clockwise is the result. The joins are those of
//! OpenSCAD 2021.01, which are not those of the clipping library here: that one cuts arcs into more
//! pieces.

use std::f64::consts::{PI, TAU};

use clipper2_rust::FillRule;
use glam::{DAffine2, DVec2};

use super::paths::filled_by;
use super::{Kind, Outline, Paths, Shape};
use crate::angle::cos_deg;
use crate::op::Op;

/// What closes a corner.
#[derive(Clone, Copy, Debug)]
pub(in crate::read) enum Join {
    /// The edges go on until they meet, but not farther than so many times the distance.
    Mitre { limit: f64 },
    /// An edge across, at the distance from the corner.
    Chamfer,
    /// Pieces of an arc, so many to a turn.
    Round { pieces: f64 },
}

impl Join {
    /// The join that OpenSCAD makes where a circle of the distance as radius would have so many
    /// segments. It asks for them by way of how far they may be from the arc, in units of its grid
    /// and at most a quarter of the radius. So 7.5 pieces are never quite as many, but 7.
    pub(in crate::read) fn round(distance: f64, segments: u32) -> Self {
        const GRID: f64 = 65536.0;
        let radius = distance.abs() * GRID;
        let sagitta = (radius * (1.0 - cos_deg(180.0 / f64::from(segments)))).ceil();
        let part = (sagitta / radius).min(0.25);
        Self::Round { pieces: PI / (1.0 - part).acos() }
    }
}

impl Outline {
    /// The center and radius of an outline that is one circle.
    pub(in crate::read) fn as_circle(&self) -> Option<(DVec2, f64)> {
        let (mut outline, mut map) = (self, DAffine2::IDENTITY);
        loop {
            match &outline.0.kind {
                Kind::Shape(Shape::Circle { radius }) => {
                    let [x, y] = [map.matrix2.x_axis, map.matrix2.y_axis];
                    let is_even = x == y.perp() || x == -y.perp();
                    return is_even.then(|| (map.translation, radius * x.length()));
                }
                Kind::Shape(Shape::Square { .. } | Shape::Paths(_))
                | Kind::Boolean(_) => {
                    return None;
                }
                Kind::Mapped(next) => map *= *next,
                Kind::Tagged(_) => {}
            }
            outline = outline.0.children.first()?;
        }
    }
}

/// Polygons grown by a distance, or shrunk if it is negative.
pub(in crate::read) fn offset(paths: &Paths, distance: f64, join: Join) -> Paths {
    let moved: Paths = paths.iter().map(|path| moved(path, distance, |_| join)).collect();
    filled_by(&moved, FillRule::Positive)
}

/// What is within a distance of a line, with caps at its ends: a chamfer makes them square, a
/// round with one piece flat. A point alone has a square around it.
pub(in crate::read) fn stroke(
    line: &[DVec2],
    distance: f64,
    join: Join,
    cap: Join,
) -> Paths {
    if let &[point] = line {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        return vec![corners.map(|c| point + distance * DVec2::from_array(c)).to_vec()];
    }
    let back = line.iter().rev().skip(1).take(line.len().saturating_sub(2));
    let around: Vec<DVec2> = line.iter().chain(back).copied().collect();
    let ends = [0, line.len().saturating_sub(1)];
    let joins = |i| if ends.contains(&i) { cap } else { join };
    filled_by(&vec![moved(&around, distance, joins)], FillRule::Positive)
}

/// Polygons grown or shrunk, with true arcs at all corners where facets would be farther from
/// them than the tolerance; nothing if there are more such corners than are wanted.
pub(in crate::read) fn offset_with_arcs(
    paths: &Paths,
    distance: f64,
    tolerance: f64,
    most: usize,
) -> Option<Outline> {
    let is_torn = |(_, [n, m]): &(DVec2, [DVec2; 2])| {
        let is_flat =
            distance.abs() * (1.0 - (0.5 * (1.0 + n.dot(*m))).sqrt()) <= tolerance;
        distance * n.perp_dot(*m) > 0.0 && !is_flat
    };
    let arcs: Vec<DVec2> = paths
        .iter()
        .flat_map(|path| corners(path))
        .filter(is_torn)
        .map(|(p, _)| p)
        .collect();
    if arcs.len() > most {
        return None;
    }
    // With chords for arcs; discs around the corners fill up what is missing.
    let chords = offset(paths, distance, Join::Round { pieces: 1.0 });
    let disc = |center: DVec2| {
        let circle = Outline::shape(Shape::Circle { radius: distance.abs() });
        circle.mapped(DAffine2::from_translation(center))
    };
    let mut parts = vec![Outline::paths(chords)];
    parts.extend(arcs.into_iter().map(disc));
    Some(Outline::boolean(if distance > 0.0 { Op::Union } else { Op::Difference }, parts))
}

/// The corners of a polygon with the outer normals of the edges to and from each.
fn corners(path: &[DVec2]) -> impl Iterator<Item = (DVec2, [DVec2; 2])> + '_ {
    let normal = |a: DVec2, b: DVec2| -(b - a).perp().normalize_or_zero();
    let count = path.len();
    (0..count).map(move |i| {
        let [before, at, after] =
            [path[(i + count - 1) % count], path[i], path[(i + 1) % count]];
        (at, [normal(before, at), normal(at, after)])
    })
}

fn moved(path: &[DVec2], distance: f64, join: impl Fn(usize) -> Join) -> Vec<DVec2> {
    let mut moved = Vec::with_capacity(2 * path.len());
    for (i, (corner, [n, m])) in corners(path).enumerate() {
        // Adding zero makes −0 and 0 one number: at ends of lines, half a turn is to the left.
        let (sin, cos) = (n.perp_dot(m) + 0.0, n.dot(m));
        let ends = [corner + distance * n, corner + distance * m];
        if sin.abs() < 1e-12 && cos > 0.0 {
            moved.push(ends[0]);
        } else if sin * distance < 0.0 {
            // The lines cross here; what they enclose beyond runs clockwise.
            moved.extend([ends[0], corner, ends[1]]);
        } else {
            match join(i) {
                Join::Mitre { limit } if 1.0 + cos >= 2.0 / (limit * limit) => {
                    moved.push(corner + distance / (1.0 + cos) * (n + m));
                }
                Join::Mitre { .. } | Join::Chamfer => {
                    let along = (0.25 * sin.atan2(cos)).tan();
                    moved.push(corner + distance * (n + n.perp() * along));
                    moved.push(corner + distance * (m - m.perp() * along));
                }
                Join::Round { pieces } => {
                    let step = (TAU / pieces).copysign(distance);
                    let angle = sin.atan2(cos).abs();
                    let steps =
                        crate::read::fineness::whole((angle / step.abs()).round()).max(1);
                    moved.extend((0..steps).map(|i| {
                        corner
                            + distance * DVec2::from_angle(step * f64::from(i)).rotate(n)
                    }));
                    moved.push(ends[1]);
                }
            }
        }
    }
    moved
}
