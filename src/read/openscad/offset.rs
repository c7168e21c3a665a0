//! `offset`.

use glam::DAffine2;

use super::super::error::Located;
use super::super::outline::{self, Join, Outline, Paths, Shape as Flat};
use super::arguments::Call;
use super::curve;
use super::evaluate::Reading;
use super::extrude::flat_children;
use super::node::Shape;
use crate::solid::Tag;

/// The most true arcs of one outline: each is a leaf of its own.
const MOST_ARCS: usize = 512;

/// The plane children grown by a distance, or shrunk by a negative one: with `r` round at the
/// corners, with `delta` mitred or chamfered.
pub(super) fn offset(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    /// Where OpenSCAD cuts mitres off.
    const LIMIT: f64 = 1e6;
    let (radius, delta) = (call.number("r")?, call.number("delta")?);
    let is_chamfered = call.truth("chamfer")?;
    let Some(outline) = flat_children(call, children, reading)? else {
        return Ok(Shape::Empty);
    };
    let distance = radius.or(delta).unwrap_or(1.0);
    if distance == 0.0 || !distance.is_finite() {
        return Ok(Shape::Flat(outline));
    }
    let tolerance = reading.options.facet_tolerance;
    let polygons = |reading: &Reading<'_>| {
        outline.polygons(&|radius| curve::fine(radius, tolerance, reading))
    };
    let grown = if radius.is_some() || delta.is_none() {
        let segments = curve::segments(distance.abs(), call, reading)?;
        match (segments, outline.as_circle()) {
            (None, Some((center, radius))) => {
                let radius = radius + distance;
                if radius <= 0.0 {
                    return Ok(Shape::Empty);
                }
                let circle = Outline::shape(Flat::Circle { radius });
                return Ok(flat(circle.mapped(DAffine2::from_translation(center)), call));
            }
            (None, None) => {
                let paths = polygons(reading);
                let arcs =
                    outline::offset_with_arcs(&paths, distance, tolerance, MOST_ARCS);
                match arcs {
                    Some(outline) => return Ok(flat(outline, call)),
                    None => {
                        let segments = curve::fine(distance.abs(), tolerance, reading);
                        rounded(&paths, distance, segments, call, reading)?
                    }
                }
            }
            (Some(segments), _) => {
                rounded(&polygons(reading), distance, segments, call, reading)?
            }
        }
    } else {
        let join =
            if is_chamfered { Join::Chamfer } else { Join::Mitre { limit: LIMIT } };
        outline::offset(&polygons(reading), distance, join)
    };
    if grown.is_empty() {
        return Ok(Shape::Empty);
    }
    Ok(flat(Outline::paths(grown), call))
}

/// Polygons offset with parts of a polygon for arcs, counted as if each corner were half a turn.
fn rounded(
    paths: &Paths,
    distance: f64,
    segments: u32,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Paths, Located> {
    let corners: usize = paths.iter().map(Vec::len).sum();
    let most = 2 * (u64::from(segments) + 2) * corners as u64;
    reading.count_facets(most, call.place())?;
    Ok(outline::offset(paths, distance, Join::round(distance, segments)))
}

fn flat(outline: Outline, call: &Call<'_>) -> Shape {
    Shape::Flat(outline.tagged(Tag::Place(call.place())))
}
