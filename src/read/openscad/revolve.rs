//! `rotate_extrude`.

use glam::DVec2;

use super::super::Rules;
use super::super::error::{Located, ReadErrorKind};
use super::super::outline::{self, Paths};
use super::arguments::Call;
use super::curve;
use super::evaluate::Reading;
use super::extrude::flat_children;
use super::node::Shape;
use crate::mesh::Ends;
use crate::solid::Solid;

pub(super) const PARAMETERS: &[&str] =
    &["angle", "start", "convexity", "file", "layer", "origin", "scale", "timestamp"];

/// The solid of the plane children turned about the y-axis, which becomes the z-axis: true
/// circles, or the sections that OpenSCAD makes. An outline on both sides of the axis makes nothing,
/// with a warning.
pub(super) fn rotate_extrude(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let given = call.number("angle")?;
    let angle = given.unwrap_or(360.0);
    // OpenSCAD takes all that is no part of a turn for a full one.
    let is_full = !(-360.0 < angle && angle < 360.0);
    let rules = reading.options.rules;
    let starts_on_the_left = is_full && (rules == Rules::V2021 || given.is_none());
    let start = match call.number("start")? {
        Some(start) => start,
        None if starts_on_the_left => 180.0,
        None => 0.0,
    };
    if call.value("file").is_some() {
        return Err(call.unsupported("`rotate_extrude` with `file`"));
    }
    let Some(outline) = flat_children(call, children, reading)? else {
        return Ok(Shape::Empty);
    };
    let tolerance = reading.options.facet_tolerance;
    let paths = outline.polygons(&|radius| curve::fine(radius, tolerance, reading));
    let Some((paths, is_turned)) = on_the_right(paths) else {
        reading.warn(call.place(), "`rotate_extrude` crosses its axis and makes nothing");
        return Ok(Shape::Empty);
    };
    let radius = paths.iter().flatten().map(|p| p.x).fold(0.0, f64::max);
    if radius == 0.0 || angle == 0.0 {
        return Ok(Shape::Empty);
    }
    let from = if is_turned { start + 180.0 } else { start };
    let angles = [from + angle.min(0.0), from + angle.max(0.0)];
    let solid = match curve::segments(radius, call, reading)? {
        None if is_full => outline::revolved(&paths),
        None => outline::in_wedge(outline::revolved(&paths), angles),
        Some(segments) => {
            let corners: usize = paths.iter().map(Vec::len).sum();
            let triangles = 2 * corners as u64 * u64::from(segments);
            reading.count_facets(triangles, call.place())?;
            let mesh = if is_full {
                outline::turned(&paths, [from, from + 360.0], segments, Ends::Joined)
            } else {
                let sections = sections(segments, angle, rules);
                outline::turned(&paths, angles, sections, Ends::Open)
            };
            Solid::mesh(
                mesh.map_err(|e| Located::at(call.place(), ReadErrorKind::Mesh(e)))?,
            )
        }
    };
    Ok(Shape::Solid(solid.placed(call.place()).as_outline()))
}

/// How many sections a part of a turn has, if a whole one has so many segments.
fn sections(segments: u32, angle: f64, rules: Rules) -> u32 {
    let part = f64::from(segments) * angle.abs() / 360.0;
    curve::part(
        1,
        match rules {
            Rules::V2021 => part,
            Rules::V2025 => part.ceil(),
        },
    )
}

/// Polygons at x ≥ 0, and whether they were on the other side before; nothing if they are on both.
fn on_the_right(mut paths: Paths) -> Option<(Paths, bool)> {
    let points = || paths.iter().flatten();
    let [low, high] = [
        points().map(|p| p.x).fold(0.0, f64::min),
        points().map(|p| p.x).fold(0.0, f64::max),
    ];
    let reach = points().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    // What clipping has moved across the axis is on it.
    let room = reach * (-36.0_f64).exp2();
    let is_left = -low > high;
    if low.abs().min(high) > room {
        return None;
    }
    for path in &mut paths {
        let on_axis = |p: &DVec2| if is_left { -p.x } else { p.x }.max(0.0);
        path.iter_mut().for_each(|p| p.x = on_axis(p));
        if is_left {
            path.reverse();
        }
    }
    Some((paths, is_left))
}
