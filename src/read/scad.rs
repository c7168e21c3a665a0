//! `.scad` files, evaluated by the installed OpenSCAD.

use std::ffi::OsStr;
use std::io;
use std::path::Path;
use std::process::Command;

use super::error::{Located, ReadError, ReadErrorKind};
use super::load::Budget;
use super::program::{self, Fault};
use super::{Imports, Model, ReadOptions, Warning, openscad};

/// Reads a file. Places in messages are those of the `.csg` that OpenSCAD makes of it.
pub(super) fn file(path: &Path, options: &ReadOptions) -> Result<Model, ReadError> {
    // OpenSCAD's own message about a missing file is easily overlooked.
    std::fs::metadata(path)
        .map_err(|e| Located::nowhere(ReadErrorKind::Io(e)).named(path))?;
    converted(path, path.as_os_str(), options, |_| Ok(()))
}

/// Reads a text; what it includes or imports is looked for in the folder of the path.
pub(super) fn bytes(
    text: &[u8],
    path: &Path,
    options: &ReadOptions,
) -> Result<Model, ReadError> {
    converted(path, OsStr::new("-"), options, |command| {
        let folder = path.parent().filter(|f| !f.as_os_str().is_empty());
        command.current_dir(folder.unwrap_or(Path::new(".")));
        command.stdin(program::input(text)?);
        Ok(())
    })
}

fn converted(
    path: &Path,
    source: &OsStr,
    options: &ReadOptions,
    more: impl FnOnce(&mut Command) -> io::Result<()>,
) -> Result<Model, ReadError> {
    let fault = |kind| Located::nowhere(kind).named(path);
    let folder = tempfile::tempdir().map_err(|e| fault(ReadErrorKind::Io(e)))?;
    let csg = folder.path().join("model.csg");
    let done = program::run(&csg, source, options, |command| {
        for definition in &options.definitions {
            command.arg("-D").arg(definition);
        }
        if let Some((file, set)) = &options.parameters {
            // The program may be run in another folder.
            command.arg("-p").arg(std::path::absolute(file)?).arg("-P").arg(set);
        }
        more(command)
    });
    let done = done.map_err(|error| match error {
        Fault::Missing { program } => fault(ReadErrorKind::OpenscadMissing { program }),
        Fault::Other(kind) => fault(kind),
    })?;
    let said = done.said;
    if !done.status.success() {
        let status = done.status.to_string();
        return Err(fault(ReadErrorKind::OpenscadFailed { status, stderr: said }));
    }
    let loaded = Budget::new(options.max_bytes).load(&csg);
    let text = loaded.map_err(|kind| {
        if !matches!(kind, ReadErrorKind::Io(_)) {
            return fault(kind);
        }
        let status = "it ended well, but wrote nothing".to_owned();
        fault(ReadErrorKind::OpenscadFailed { status, stderr: said.clone() })
    })?;

    // The name keeps the folder, where imports are, and tells that lines are not the
    // author's.
    let mut name = path.file_name().unwrap_or(OsStr::new("-")).to_owned();
    name.push(" as .csg");
    // What the model names, OpenSCAD has read or could have, wherever it is.
    let options = ReadOptions { imports: Imports::Anywhere, ..options.clone() };
    let mut model = openscad::read(&text, &path.with_file_name(name), &options)?;
    for warning in &mut model.warnings {
        // Nobody has seen that file: a place in it would be looked for in the author's.
        if let Some(place) = warning.place.take() {
            let line = format!(" (line {} of the .csg that openscad makes)", place.line);
            warning.message.push_str(&line);
        }
    }
    let lines = said.lines().filter(|l| !l.trim().is_empty());
    let warning = |l: &str| Warning { place: None, message: format!("openscad: {l}") };
    model.warnings.splice(0..0, lines.map(warning));
    Ok(model)
}
