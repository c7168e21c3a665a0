//! `square`, `circle` and `polygon`.

use glam::DVec2;

use super::super::error::Located;
use super::super::outline::{self, Outline};
use super::arguments::Call;
use super::curve;
use super::evaluate::Reading;
use super::node::Shape;
use super::polyhedron::{chosen, warn_of_dropped};
use super::solids::{is_size, radius};
use crate::solid::Tag;

pub(super) fn square(
    call: &Call<'_>,
    _: Vec<Shape>,
    _: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let size = DVec2::from_array(call.sizes("size")?.unwrap_or([1.0; 2]));
    let center = call.truth("center")?;
    if !size.to_array().into_iter().all(is_size) {
        return Ok(Shape::Empty);
    }
    let min = if center { -0.5 * size } else { DVec2::ZERO };
    let max = if center { 0.5 * size } else { size };
    Ok(flat(Outline::shape(outline::Shape::Square { min, max }), call))
}

pub(super) fn circle(
    call: &Call<'_>,
    _: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let radius = radius(call, ["r", "d"])?.unwrap_or(1.0);
    if !is_size(radius) {
        return Ok(Shape::Empty);
    }
    Ok(flat(curve::circle(radius, call, reading)?, call))
}

/// The even-odd fill of all paths; without paths, of one path through all points. An
/// empty list of paths is none at all.
pub(super) fn polygon(
    call: &Call<'_>,
    _: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let mut points = Vec::new();
    for value in call.vector("points")?.unwrap_or_default() {
        let point = call.document.numbers(value).map(DVec2::from_array);
        let point = point.filter(|p| p.is_finite());
        points.push(
            point
                .ok_or_else(|| call.wrong("points", "pairs of finite numbers", value))?,
        );
    }
    let mut dropped = 0;
    let lists = call.vector("paths")?.filter(|lists| !lists.is_empty());
    let paths = match lists {
        None => vec![points],
        Some(lists) => {
            let mut paths = Vec::with_capacity(lists.len());
            for list in lists {
                let (path, others) = chosen(call, "paths", list, points.len())?;
                dropped += others;
                paths.push(path.into_iter().map(|i| points[i as usize]).collect());
            }
            paths
        }
    };
    warn_of_dropped(call, dropped, reading);
    count(&paths, call, reading)?;
    if paths.iter().all(|path| path.len() < 3) {
        return Ok(Shape::Empty);
    }
    Ok(flat(Outline::paths(paths), call))
}

/// Counts the triangles of the prism over a polygon.
fn count(
    paths: &[Vec<DVec2>],
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<(), Located> {
    let triangles = paths.iter().map(|path| 4 * path.len().saturating_sub(1) as u64);
    reading.count_facets(triangles.sum(), call.place())
}

fn flat(outline: Outline, call: &Call<'_>) -> Shape {
    Shape::Flat(outline.tagged(Tag::Place(call.place())))
}
