//! `linear_extrude`.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::super::Rules;
use super::super::error::{Located, ReadErrorKind};
use super::super::fineness::whole;
use super::super::outline::{self, Extrusion, Outline, Paths};
use super::arguments::Call;
use super::combine;
use super::curve::{self, Fineness};
use super::evaluate::Reading;
use super::node::Shape;
use super::solids::is_size;
use crate::angle::{cos_deg, sin_deg};
use crate::mesh::{Diagonal, Ends, MeshError, Quad, loft};
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
    let way = way(call)?;
    let height = way.z;
    let center = call.truth("center")?;
    let twist = call.number("twist")?.unwrap_or(0.0);
    let scale: [f64; 2] = call.sizes("scale")?.unwrap_or([1.0; 2]);
    // Negative scales are no mirrors in OpenSCAD.
    let scale = DVec2::from_array(scale).max(DVec2::ZERO);
    if !is_size(height) || !way.is_finite() {
        return Ok(Shape::Empty);
    }
    if call.value("file").is_some() {
        return Err(call.unsupported("`linear_extrude` with `file`"));
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
        let leaning = DMat3::from_cols(DVec3::X, DVec3::Y, way / height);
        let solid = match leaning == DMat3::IDENTITY {
            true => solid,
            false => solid.mapped(DAffine3::from_mat3(leaning)),
        };
        Shape::Solid(solid.placed(call.place()).as_outline())
    }))
}

/// From where to where it goes: straight up, but for `v`, which is the way itself, or only its
/// direction if there is a height too.
fn way(call: &Call<'_>) -> Result<DVec3, Located> {
    let height = match call.number("height")? {
        Some(height) => Some(height),
        None => call.number("h")?,
    };
    let Some(value) = call.value("v") else {
        return Ok(height.unwrap_or(100.0) * DVec3::Z);
    };
    let way = call.document.numbers(value).map(DVec3::from_array);
    let way = way.ok_or_else(|| call.wrong("v", "a vector of 3 numbers", value))?;
    Ok(height.map_or(way, |height| way.normalize_or_zero() * height))
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
        let mut paths =
            outline.polygons(&|radius| curve::fine(radius, tolerance, reading));
        let slices = match call.number("slices")? {
            Some(slices) => curve::part(1, slices),
            None => self.slices(&curve::fineness(call)?, &paths, reading.options.rules),
        };
        let most = match reading.options.rules {
            Rules::V2021 => 0,
            Rules::V2025 => most_edges(call)?,
        };
        let corners = paths.iter().map(|path| u64::from(most).max(path.len() as u64));
        let triangles = (2 * u64::from(slices)).saturating_mul(corners.sum());
        reading.count_facets(triangles, call.place())?;
        self.divide(&mut paths, slices, most, call)?;
        reading.model.counts.sliced += 1;
        let sections: Vec<DAffine3> = self.sections(slices).collect();
        let diagonal = |quad: &Quad| self.diagonal(quad, slices);
        Ok(match loft(&paths, &sections, Ends::Open, diagonal) {
            Ok(mesh) => Ok(Some(Solid::mesh(mesh))),
            Err(MeshError::NoFaces) => Ok(None),
            Err(error) => Err(error),
        })
    }

    /// Divides edges by `segments` or `$fn`, if there is one of them, or else by `$fs` as long as no
    /// path gets more of them than there may be.
    fn divide(
        &self,
        paths: &mut Paths,
        slices: u32,
        most: u32,
        call: &Call<'_>,
    ) -> Result<(), Located> {
        let Fineness { count, size, .. } = curve::fineness(call)?;
        let is_counted = call.value("segments").is_some() || count > 0.0;
        for path in paths.iter_mut().filter(|path| path.len() < most as usize) {
            let lengths = self.lengths(path, slices);
            let by_length = outline::by_length(&lengths, size.max(0.01));
            let sum: u64 = by_length.iter().copied().map(u64::from).sum();
            let pieces = match is_counted || sum >= u64::from(most) {
                true => outline::by_number(&lengths, most),
                false => by_length,
            };
            *path = outline::split(path, &pieces);
        }
        Ok(())
    }

    /// The shorter diagonal, or the one that goes with the twist; the other one below a top that is
    /// a line or a point.
    fn diagonal(&self, quad: &Quad, slices: u32) -> Diagonal {
        let with_twist = (self.twist > 0.0) != quad.is_hole;
        let or_equal = if with_twist { Diagonal::Forwards } else { Diagonal::Backwards };
        let chosen = quad.shorter().unwrap_or(or_equal);
        let is_below_tip =
            quad.before + 1 == slices as usize && self.scale.min_element() == 0.0;
        match (is_below_tip, chosen) {
            (false, chosen) => chosen,
            (true, Diagonal::Forwards) => Diagonal::Backwards,
            (true, Diagonal::Backwards) => Diagonal::Forwards,
        }
    }

    /// How long each edge of a path is where it is longest.
    fn lengths(&self, path: &[DVec2], slices: u32) -> Vec<f64> {
        let next = path.iter().cycle().skip(1);
        let edges = path.iter().zip(next).map(|(a, b)| *b - *a);
        if self.is_even() {
            return edges.map(|edge| edge.length() * self.scale.x.max(1.0)).collect();
        }
        let sections: Vec<DAffine3> = self.sections(slices).collect();
        let longest = |edge: DVec2| {
            let lengths = sections
                .iter()
                .map(|section| section.transform_vector3(edge.extend(0.0)).length());
            lengths.fold(0.0, f64::max)
        };
        edges.map(longest).collect()
    }

    /// Where the outline is at the ends of all slices.
    fn sections(&self, slices: u32) -> impl Iterator<Item = DAffine3> + '_ {
        (0..=slices).map(move |j| self.section(f64::from(j) / f64::from(slices)))
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

    /// How many slices OpenSCAD makes: enough for the helix of the corner that is farthest from the
    /// axis, and for the way that the farthest corner moves, which 2021.01 overlooks where there is
    /// a twist.
    fn slices(&self, fineness: &Fineness, paths: &[Vec<DVec2>], rules: Rules) -> u32 {
        let Self { height, scale, .. } = *self;
        let Fineness { count, angle, size } = *fineness;
        let (angle, size) = (angle.max(0.01), size.max(0.01));
        let farthest = |of: &dyn Fn(DVec2) -> f64| {
            paths.iter().flatten().map(|&p| of(p)).fold(0.0, f64::max)
        };
        let is_overlooked = rules == Rules::V2021 && self.twist != 0.0;
        let by_moving = if self.is_even() || is_overlooked {
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

/// The most edges that a path is divided into.
fn most_edges(call: &Call<'_>) -> Result<u32, Located> {
    let Fineness { count, angle, .. } = curve::fineness(call)?;
    let number = call.number("segments")?.or((count > 0.0).then_some(count));
    Ok(whole(number.unwrap_or((360.0 / angle.max(0.01)).ceil())))
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
