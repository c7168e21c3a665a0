//! Text in, solid out: OpenSCAD's `.csg` and `.scad`, and meshes as `.obj`, `.stl`, `.off` and
//! `.3mf`.
//!
//! [`file()`] and [`bytes()`] are the doors. What a file says goes into a [`Model`]; what is
//! wrong with it into a [`ReadError`] that names file, line and column. No bytes make a
//! reader panic or use the stack in proportion to the input.
//!
//! To add a format: its reader in a file here; a variant and its endings in [`Format`];
//! arms in [`file()`], [`bytes()`] and, for a mesh, `mesh()`; the list of known endings in
//! [`ReadErrorKind::UnknownFormat`]; a value of `--format`, and the help, in
//! `cli/input.rs`; and what models may import, in `openscad/import.rs`. The compiler only
//! asks for the arms.

mod dxf;
mod error;
mod faces;
mod fineness;
mod hull;
mod load;
mod model;
mod obj;
mod off;
mod openscad;
mod options;
mod outline;
mod program;
mod scad;
mod stl;
mod svg;
mod threemf;
mod turn;
mod words;
mod xml;

use std::path::Path;

use crate::solid::Solid;

pub use error::{ReadError, ReadErrorKind};
pub use model::{Counts, Marks, Model, Warning};
pub use options::{Curves, Format, Imports, ReadOptions, Rules};

use error::Located;
use faces::Faces;
use load::Budget;

/// Reads a file.
///
/// ```no_run
/// use solidray::read::{self, ReadOptions};
///
/// let model = read::file("part.csg".as_ref(), &ReadOptions::default())?;
/// for warning in &model.warnings {
///     eprintln!("{warning}");
/// }
/// # Ok::<(), read::ReadError>(())
/// ```
///
/// # Errors
///
/// What is wrong with the file, and where.
pub fn file(path: &Path, options: &ReadOptions) -> Result<Model, ReadError> {
    let named = |kind| Located::nowhere(kind).named(path);
    let format = options.format.or_else(|| Format::of(path));
    let format = format.ok_or_else(|| named(ReadErrorKind::UnknownFormat))?;
    let load = || Budget::new(options.max_bytes).load(path).map_err(named);
    match format {
        Format::Scad => scad::file(path, options),
        Format::Csg => bytes(&load()?, path, format, options),
        Format::ThreeMf => {
            let mut budget = Budget::new(options.max_bytes);
            let archive = budget.load(path).map_err(named)?;
            threemf::model(&archive, &mut budget).map_err(|error| error.named(path))
        }
        Format::Obj | Format::Stl | Format::Off => {
            // The text is not kept while the mesh is built.
            let faces = mesh(&load()?, format);
            built(faces, path)
        }
    }
}

/// Reads what somebody else has loaded, such as standard input. The path is for messages,
/// and what the text imports is looked for in its folder.
///
/// # Errors
///
/// What is wrong with the text, and where.
pub fn bytes(
    bytes: &[u8],
    path: &Path,
    format: Format,
    options: &ReadOptions,
) -> Result<Model, ReadError> {
    let mut budget = Budget::new(options.max_bytes);
    let fits = budget.spend(bytes);
    fits.map_err(|kind| Located::nowhere(kind).named(path))?;
    match format {
        Format::Csg => openscad::read(bytes, path, options),
        Format::Scad => scad::bytes(bytes, path, options),
        Format::ThreeMf => {
            threemf::model(bytes, &mut budget).map_err(|error| error.named(path))
        }
        Format::Obj | Format::Stl | Format::Off => built(mesh(bytes, format), path),
    }
}

/// The model of a mesh file.
fn built(faces: Result<Faces, Located>, path: &Path) -> Result<Model, ReadError> {
    let built = faces.and_then(Faces::build).map_err(|error| error.named(path))?;
    let mut model = Model { solid: Solid::mesh(built.mesh), ..Model::default() };
    if built.turned {
        model.counts.turned = 1;
        model.warnings.push(Warning { place: None, message: faces::TURNED.to_owned() });
    }
    Ok(model)
}

/// The points and faces of a mesh file.
fn mesh(bytes: &[u8], format: Format) -> Result<Faces, Located> {
    match format {
        Format::Obj => obj::read(bytes),
        Format::Stl => stl::read(bytes),
        Format::Off => off::read(bytes),
        Format::Csg | Format::Scad | Format::ThreeMf => {
            Err(Located::nowhere(ReadErrorKind::UnknownFormat))
        }
    }
}
