//! `square`, `circle` and `polygon`, each as the prism over it from z = 0 to 1.

use glam::{DVec2, DVec3};

use super::super::error::{Located, ReadErrorKind};
use super::arguments::Call;
use super::curve::Round;
use super::evaluate::Reading;
use super::node::Shape;
use super::polyhedron::{chosen, warn_of_dropped};
use super::solids::{is_size, radius};
use crate::mesh::{Mesh, MeshError};
use crate::solid::Solid;

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
    let prism = Solid::cuboid_between(min.extend(0.0), max.extend(1.0));
    Ok(Shape::Flat(prism.placed(call.place())))
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
    let prism = Round::Frustum { radii: [radius; 2], heights: [0.0, 1.0] };
    Ok(Shape::Flat(prism.solid(call, reading)?))
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
    match Mesh::prism(&paths, 0.0, 1.0) {
        Ok(mesh) => {
            reading.count_facets(mesh.faces().len() as u64, call.place())?;
            Ok(Shape::Flat(Solid::mesh(mesh).placed(call.place())))
        }
        Err(MeshError::NoFaces) => Ok(Shape::Empty),
        Err(error) => Err(Located::at(call.place(), ReadErrorKind::Mesh(error))),
    }
}

/// The map of the extrusion of such prisms between two heights.
pub(super) fn lifted(prism: Solid, [bottom, top]: [f64; 2]) -> Solid {
    let mut map = glam::DAffine3::from_scale(DVec3::new(1.0, 1.0, top - bottom));
    map.translation.z = bottom;
    prism.mapped(map)
}
