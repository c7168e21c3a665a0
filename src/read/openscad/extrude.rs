//! `linear_extrude`.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::super::error::{Located, ReadErrorKind};
use super::super::outline::{Extrusion, Outline};
use super::arguments::Call;
use super::combine;
use super::curve::{self, Fineness};
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
    let sweep = Sweep { bottom, height, twist, scale };
    let solid = if twist == 0.0 && sweep.is_even() {
        let extrusion = Extrusion { bottom, top: bottom + height, scale: scale.x };
        outline.extruded(extrusion).map(Some)
    } else {
        sweep.sliced(&outline, call, reading)?
    };
    let solid =
        solid.map_err(|error| Located::at(call.place(), ReadErrorKind::Mesh(error)))?;
    Ok(solid.map_or(Shape::Empty, |solid| {
        Shape::Solid(solid.placed(call.place()).as_outline())
    }))
}

/// How an outline moves.
#[derive(Clone, Copy, Debug)]
struct Sweep {
    bottom: f64,
    height: f64,
    /// In degrees, clockwise as seen from the top.
    twist: f64,
    /// What it is scaled by at the top.
    scale: DVec2,
}

impl Sweep {
    fn is_even(&self) -> bool {
        self.scale.x - self.scale.y == 0.0
    }

    /// The polyhedron that OpenSCAD makes, of as many slices; nothing of an empty outline.
    fn sliced(
        &self,
        outline: &Outline,
        call: &Call<'_>,
        reading: &mut Reading<'_>,
    ) -> Result<Result<Option<Solid>, MeshError>, Located> {
        let tolerance = reading.options.facet_tolerance;
        let paths = outline.polygons(&|radius| curve::fine(radius, tolerance));
        let slices = match call.number("slices")? {
            Some(slices) => curve::part(1, slices),
            None => self.slices(&curve::fineness(call)?, &paths),
        };
        let corners: usize = paths.iter().map(Vec::len).sum();
        let triangles = 2 * corners as u64 * u64::from(slices);
        reading.count_facets(triangles, call.place())?;
        let sections: Vec<DAffine3> = (0..=slices)
            .map(|j| self.section(f64::from(j) / f64::from(slices)))
            .collect();
        Ok(match loft(&paths, &sections, Ends::Open) {
            Ok(mesh) => Ok(Some(Solid::mesh(mesh))),
            Err(MeshError::NoFaces) => Ok(None),
            Err(error) => Err(error),
        })
    }

    /// Where the outline is after a part of the way.
    fn section(&self, part: f64) -> DAffine3 {
        let (sin, cos) = (sin_deg(-self.twist * part), cos_deg(-self.twist * part));
        let scale = DVec2::ONE - (DVec2::ONE - self.scale) * part;
        DAffine3 {
            matrix3: DMat3::from_cols(
                (scale * DVec2::new(cos, sin)).extend(0.0),
                (scale * DVec2::new(-sin, cos)).extend(0.0),
                DVec3::Z,
            ),
            translation: (self.bottom + self.height * part) * DVec3::Z,
        }
    }

    /// How many slices OpenSCAD 2021.01 makes: enough for the helix of the corner that is
    /// farthest from the axis, and for the way that the farthest corner moves.
    fn slices(&self, fineness: &Fineness, paths: &[Vec<DVec2>]) -> u32 {
        let Self { height, scale, .. } = *self;
        let Fineness { count, angle, size } = *fineness;
        let (angle, size) = (angle.max(0.01), size.max(0.01));
        let farthest = |of: &dyn Fn(DVec2) -> f64| {
            paths.iter().flatten().map(|&p| of(p)).fold(0.0, f64::max)
        };
        let by_moving = if self.is_even() {
            1.0
        } else if count > 0.0 {
            count
        } else {
            let moved = farthest(&|p| (p * (scale - DVec2::ONE)).length());
            (moved.hypot(height) / size).ceil()
        };
        let twist = self.twist.abs();
        if twist == 0.0 {
            return curve::part(1, by_moving);
        }
        let by_twist = if count > 0.0 {
            (twist * count / 360.0).ceil()
        } else {
            let (reach, radians) = (farthest(&|p| p.length()), twist.to_radians());
            let shrinks = (1.0 - scale.x).abs();
            let way = if self.is_even() && shrinks > 0.0 {
                // A spiral of Archimedes that ends where the scale would be zero.
                let end = radians / shrinks * scale.x.max(1.0);
                let along = |t: f64| 0.5 * reach / end * (t * t.hypot(1.0) + t.asinh());
                along(end) - along(end - radians)
            } else {
                reach * radians
            };
            (twist / angle).ceil().min((way.hypot(height) / size).ceil())
        };
        let least = (twist / 120.0).ceil();
        curve::part(1, by_twist.max(least).max(by_moving))
    }
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
