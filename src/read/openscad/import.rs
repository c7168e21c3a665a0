//! `import` of meshes and drawings.

use std::path::Path;

use glam::DVec2;

use super::super::dxf;
use super::super::error::{Located, ReadErrorKind};
use super::super::faces::{Faces, TURNED};
use super::super::options::{Curves, Format};
use super::super::outline::Outline;
use super::super::svg;
use super::super::threemf;
use super::arguments::Call;
use super::curve;
use super::evaluate::Reading;
use super::file;
use super::node::Shape;
use crate::mesh::round;
use crate::solid::{Solid, Tag};

/// A mesh or drawing from a file, looked for in the folder of the `.csg`. One that is not there is
/// left out with a warning, as by OpenSCAD; it is an error if nothing else is left.
pub(super) fn import(
    call: &Call<'_>,
    _: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let Some(name) = call.text("file")? else { return Ok(Shape::Empty) };
    let path = file::path(&name, reading.folder, reading.options)
        .map_err(|kind| Located::at(call.place(), kind));
    match path.and_then(|path| imported(&path, call, reading)) {
        Err(error) if name.is_empty() || is_missing(&error) => {
            reading.leave_out(error, call.place());
            Ok(Shape::Empty)
        }
        shape => shape,
    }
}

/// Whether a file is not there.
pub(super) fn is_missing(error: &Located) -> bool {
    let ReadErrorKind::Import(error) = &error.kind else { return false };
    matches!(&error.kind, ReadErrorKind::Io(e) if e.kind() == std::io::ErrorKind::NotFound)
}

fn imported(
    path: &Path,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let is = |ending| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
    if is("dxf") {
        return drawing(path, call, reading);
    }
    if is("svg") {
        return picture(path, call, reading);
    }
    let format = Format::of(path);
    let Some(format @ (Format::Obj | Format::Stl | Format::Off | Format::ThreeMf)) =
        format
    else {
        return Err(left(path, call));
    };
    let solid = match reading.imports.get(path) {
        Some(solid) => solid.clone(),
        None => {
            let import = |error: Located| {
                let error = ReadErrorKind::Import(Box::new(error.named(path)));
                Located::at(call.place(), error)
            };
            let read = if format == Format::ThreeMf {
                archive(path, call, reading)
            } else {
                mesh(path, format, call, reading)
            };
            let solid = read.map_err(import)?;
            reading.imports.insert(path.to_owned(), solid.clone());
            solid
        }
    };
    Ok(Shape::Solid(solid.placed(call.place())))
}

/// The mesh of a file.
fn mesh(
    path: &Path,
    format: Format,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Solid, Located> {
    let bytes = reading.budget.load(path).map_err(Located::nowhere)?;
    let faces = super::super::mesh(&bytes, format);
    drop(bytes);
    let built = faces.and_then(Faces::build)?;
    if built.turned {
        reading.model.counts.turned += 1;
        reading.warn(call.place(), format!("{}: {TURNED}", path.display()));
    }
    Ok(Solid::mesh(built.mesh))
}

/// The meshes of an archive, as they are written: OpenSCAD 2021.01 looks neither at where the
/// build has them nor at the unit.
fn archive(
    path: &Path,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Solid, Located> {
    let bytes = reading.budget.load(path).map_err(Located::nowhere)?;
    let contents = threemf::read(&bytes, &mut reading.budget)?;
    let moved = contents.is_moved.then(|| {
        "meshes are taken as they are written, as by OpenSCAD, without their places and units"
            .to_owned()
    });
    for message in contents.warnings.into_iter().chain(moved) {
        reading.warn(call.place(), format!("{}: {message}", path.display()));
    }
    reading.model.counts.turned += contents.turned;
    Ok(threemf::union(contents.meshes))
}

/// That a file is one that only OpenSCAD reads, or none that can be read.
fn left(path: &Path, call: &Call<'_>) -> Located {
    /// What OpenSCAD imports, but is not read here.
    const ENDINGS: [&str; 2] = ["amf", "nef3"];
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let ending = ending.to_ascii_lowercase();
    if !ENDINGS.contains(&ending.as_str()) {
        let known =
            "a file that ends in .stl, .off, .obj, .dxf, .svg, .3mf, .amf or .nef3";
        let value = call.value("file").unwrap_or_default();
        return call.wrong("file", known, value);
    }
    match std::fs::metadata(path) {
        Ok(_) => call.unsupported(format!("import of `.{ending}` files")),
        Err(error) => {
            let error = Located::nowhere(ReadErrorKind::Io(error)).named(path);
            Located::at(call.place(), ReadErrorKind::Import(Box::new(error)))
        }
    }
}

/// A fault in a drawing. What cannot be read here, OpenSCAD may read.
fn in_drawing(path: &Path, call: &Call<'_>, error: Located) -> Located {
    if matches!(error.kind, ReadErrorKind::Unsupported(_)) {
        return Located::at(call.place(), error.kind);
    }
    let error = Box::new(error.named(path));
    Located::at(call.place(), ReadErrorKind::Import(error))
}

/// The shapes of an `.svg`. OpenSCAD 2021.01 takes neither layer, origin nor scale, nor how fine
/// curves are to be.
fn picture(
    path: &Path,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    /// The units in an inch unless another number is given that is not too small.
    const DPI: f64 = 72.0;
    let dpi = call.number("dpi")?.filter(|dpi| *dpi >= 0.001).unwrap_or(DPI);
    let tolerance = match reading.options.curves {
        Curves::Faceted => None,
        Curves::Auto | Curves::Exact => Some(reading.options.facet_tolerance),
    };
    let import = svg::Import { dpi, center: call.truth("center")?, tolerance };
    let loaded = reading.budget.load(path).map_err(Located::nowhere);
    let bytes = loaded.map_err(|error| in_drawing(path, call, error))?;
    let mut count = |lines| reading.count_facets(2 * lines as u64, call.place());
    let outline = svg::read(&bytes, &import, &mut count)
        .map_err(|error| in_drawing(path, call, error))?;
    Ok(match outline {
        Some(outline) => Shape::Flat(outline.tagged(Tag::Place(call.place()))),
        None => Shape::Empty,
    })
}

/// The closed lines of a `.dxf`.
fn drawing(
    path: &Path,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let layer = call.text("layer")?.unwrap_or_default();
    let origin = DVec2::from_array(call.sizes("origin")?.unwrap_or([0.0; 2]));
    let scale = call.number("scale")?.unwrap_or(1.0);
    let named = |error| in_drawing(path, call, error);
    let loaded = reading.budget.load(path).map_err(Located::nowhere);
    let bytes = loaded.map_err(named)?;
    let tolerance = reading.options.facet_tolerance;
    let mut segments = |radius: f64| {
        let segments = curve::segments(radius, call, reading)?;
        let segments =
            segments.unwrap_or_else(|| curve::fine(radius, tolerance, reading));
        reading.count_facets(round::frustum_triangles(segments), call.place())?;
        Ok(segments)
    };
    let mut paths = dxf::read(&bytes, &layer, &mut segments).map_err(named)?;
    let points = paths.iter_mut().flatten();
    points.for_each(|p| *p = scale * (*p - origin));
    if paths.is_empty() || scale == 0.0 {
        return Ok(Shape::Empty);
    }
    Ok(Shape::Flat(Outline::paths(paths).tagged(Tag::Place(call.place()))))
}
