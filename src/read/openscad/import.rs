//! `import` of meshes.

use std::path::Path;
use std::sync::Arc;

use super::super::error::{Located, ReadError, ReadErrorKind};
use super::super::faces::{Faces, TURNED};
use super::super::load::Budget;
use super::super::options::Format;
use super::super::words::quoted;
use super::arguments::Call;
use super::evaluate::Reading;
use super::node::Shape;
use crate::mesh::Mesh;
use crate::solid::Solid;

/// A mesh from a file, looked for in the folder of the `.csg`. A file that is missing is
/// an error here, though OpenSCAD goes on without it.
pub(super) fn import(
    call: &Call<'_>,
    _: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let Some(name) = call.text("file")? else { return Ok(Shape::Empty) };
    let path = reading.folder.join(&name);
    let format = Format::of(&path);
    let Some(format @ (Format::Obj | Format::Stl | Format::Off)) = format else {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let ending = quoted(format!(".{ending}").as_bytes());
        return Err(call.unsupported(format!("import of {ending} files")));
    };
    let mesh = match reading.imports.get(&path) {
        Some(mesh) => mesh.clone(),
        None => {
            let (mesh, turned) =
                load(&path, format, &mut reading.budget).map_err(|error| {
                    Located::at(call.place(), ReadErrorKind::Import(Box::new(error)))
                })?;
            if turned {
                reading.model.counts.turned += 1;
                reading.warn(call.place(), format!("{}: {TURNED}", path.display()));
            }
            reading.imports.insert(path, mesh.clone());
            mesh
        }
    };
    Ok(Shape::Solid(Solid::mesh(mesh).placed(call.place())))
}

fn load(
    path: &Path,
    format: Format,
    budget: &mut Budget,
) -> Result<(Arc<Mesh>, bool), ReadError> {
    let mut read = || {
        let bytes = budget.load(path).map_err(Located::nowhere)?;
        let faces = super::super::mesh(&bytes, format);
        drop(bytes);
        let built = faces.and_then(Faces::build)?;
        Ok((Arc::new(built.mesh), built.turned))
    };
    read().map_err(|error: Located| error.named(path))
}
