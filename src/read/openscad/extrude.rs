//! `linear_extrude`.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::super::error::{Located, ReadErrorKind};
use super::super::outline::{Extrusion, Outline};
use super::arguments::Call;
use super::combine;
use super::curve;
use super::evaluate::Reading;
use super::node::Shape;
use super::solids::is_size;
use crate::angle::{cos_deg, sin_deg};
use crate::mesh::{Ends, MeshError, loft};
use crate::solid::Solid;

pub(super) const PARAMETERS: &[&str] = &[
    "height",
    "center",
    "convexity",
    "twist",
    "slices",
    "scale",
    "segments",
    "v",
    "h",
    "file",
    "layer",
    "origin",
    "timestamp",
];

/// The solid over the plane children. A height that is not positive makes nothing.
pub(super) fn linear_extrude(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let height = match call.number("height")? {
        Some(height) => height,
        None => call.number("h")?.unwrap_or(100.0),
    };
    let center = call.truth("center")?;
    let twist = call.number("twist")?.unwrap_or(0.0);
    let scale: [f64; 2] = call.sizes("scale")?.unwrap_or([1.0; 2]);
    // Negative scales are no mirrors in OpenSCAD.
    let scale = DVec2::from_array(scale).max(DVec2::ZERO);
    if !is_size(height) {
        return Ok(Shape::Empty);
    }
    for (bad, what) in
        [(call.value("v").is_some(), "v"), (call.value("file").is_some(), "file")]
    {
        if bad {
            return Err(call.unsupported(format!("`linear_extrude` with `{what}`")));
        }
    }
    let Some(outline) = flat_children(call, children, reading)? else {
        return Ok(Shape::Empty);
    };
    let bottom = if center { -0.5 * height } else { 0.0 };
    let fault = |error| Located::at(call.place(), ReadErrorKind::Mesh(error));
    let solid = if twist == 0.0 && scale.x == scale.y {
        let extrusion = Extrusion { bottom, top: bottom + height, scale: scale.x };
        outline.extruded(extrusion).map_err(fault)?
    } else {
        let tolerance = reading.options.facet_tolerance;
        let paths = outline.polygons(&|radius| curve::fine(radius, tolerance));
        let reach = paths.iter().flatten().map(|p| p.length()).fold(0.0, f64::max);
        let slices = match call.number("slices")? {
            Some(slices) => curve::part(1, slices),
            None => slices(call, &paths, reach, height, twist, scale)?,
        };
        let corners: usize = paths.iter().map(Vec::len).sum();
        let triangles = 2 * corners as u64 * u64::from(slices);
        reading.count_facets(triangles, call.place())?;
        let section = |j: u32| {
            let part = f64::from(j) / f64::from(slices);
            let (sin, cos) = (sin_deg(-twist * part), cos_deg(-twist * part));
            let scale = DVec2::ONE - (DVec2::ONE - scale) * part;
            DAffine3 {
                matrix3: DMat3::from_cols(
                    (scale * DVec2::new(cos, sin)).extend(0.0),
                    (scale * DVec2::new(-sin, cos)).extend(0.0),
                    DVec3::Z,
                ),
                translation: (bottom + height * part) * DVec3::Z,
            }
        };
        let sections: Vec<DAffine3> = (0..=slices).map(section).collect();
        match loft(&paths, &sections, Ends::Open) {
            Ok(mesh) => Solid::mesh(mesh),
            Err(MeshError::NoFaces) => return Ok(Shape::Empty),
            Err(error) => return Err(fault(error)),
        }
    };
    Ok(Shape::Solid(solid.placed(call.place()).as_outline()))
}

/// The union of the plane children; solid ones are ignored, with a warning.
pub(super) fn flat_children(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Option<Outline>, Located> {
    let mut flat = children;
    let before = flat.len();
    flat.retain(|child| !matches!(child, Shape::Solid(_)));
    if flat.len() < before {
        let message = format!("`{}` ignores three-dimensional children", call.name());
        reading.warn(call.place(), message);
    }
    Ok(match combine::union(call, flat, reading)? {
        Shape::Flat(outline) => Some(outline),
        Shape::Empty | Shape::Solid(_) => None,
    })
}

/// How many slices OpenSCAD 2021.01 makes: enough for the helices of the corner that is farthest
/// from the axis, or for the way that the farthest corner moves.
fn slices(
    call: &Call<'_>,
    paths: &[Vec<DVec2>],
    reach: f64,
    height: f64,
    twist: f64,
    scale: DVec2,
) -> Result<u32, Located> {
    let curve::Fineness { count, angle, size } = curve::fineness(call)?;
    let (angle, size) = (angle.max(0.01), size.max(0.01));
    let moved = |p: &DVec2| (*p * (scale - DVec2::ONE)).length_squared();
    let far = paths.iter().flatten().map(moved).fold(0.0, f64::max);
    let by_moving =
        if count > 0.0 { count } else { ((far + height * height).sqrt() / size).ceil() };
    if twist == 0.0 {
        return Ok(curve::part(1, by_moving));
    }
    let is_even = scale.x == scale.y;
    let turned = twist.abs();
    let least = (turned / 120.0).ceil().max(1.0);
    let slices = if count > 0.0 {
        (turned * count / 360.0).ceil()
    } else {
        let radians = turned.to_radians();
        let length = if is_even && scale.x != 1.0 {
            // A spiral of Archimedes that ends where the radius would be zero.
            let end = radians / (1.0 - scale.x).abs() * scale.x.max(1.0);
            let along = |t: f64| 0.5 * reach / end * (t * t.hypot(1.0) + t.asinh());
            (along(end) - along(end - radians)).hypot(height)
        } else {
            (reach * radians).hypot(height)
        };
        (turned / angle).ceil().min((length / size).ceil())
    };
    let by_moving = if is_even { 0.0 } else { by_moving };
    Ok(curve::part(1, slices.max(least).max(by_moving)))
}
