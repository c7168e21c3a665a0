//! `.scad` files, evaluated by the installed OpenSCAD.

use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use super::error::{Located, ReadError, ReadErrorKind};
use super::load::Budget;
use super::{Model, ReadOptions, Warning, openscad};

/// Reads a file. Places in messages are those of the `.csg` that OpenSCAD makes of it.
pub(super) fn file(path: &Path, options: &ReadOptions) -> Result<Model, ReadError> {
    // OpenSCAD's own message about a missing file is easily overlooked.
    std::fs::metadata(path)
        .map_err(|e| Located::nowhere(ReadErrorKind::Io(e)).named(path))?;
    converted(path, options, |command| command.arg(path).output())
}

/// Reads a text; what it includes or imports is looked for in the folder of the path.
pub(super) fn bytes(
    text: &[u8],
    path: &Path,
    options: &ReadOptions,
) -> Result<Model, ReadError> {
    converted(path, options, |command| {
        let folder = path.parent().filter(|f| !f.as_os_str().is_empty());
        command.arg("-").current_dir(folder.unwrap_or(Path::new(".")));
        let mut child = command.stdin(Stdio::piped()).spawn()?;
        // OpenSCAD reads everything before it says much, so no pipe can fill up.
        let written = child.stdin.take().map_or(Ok(()), |mut pipe| pipe.write_all(text));
        let output = child.wait_with_output()?;
        // A program that ends without reading has said why; that matters more.
        if output.status.success() { written.map(|()| output) } else { Ok(output) }
    })
}

fn converted(
    path: &Path,
    options: &ReadOptions,
    run: impl FnOnce(&mut Command) -> io::Result<Output>,
) -> Result<Model, ReadError> {
    let fault = |kind| Located::nowhere(kind).named(path);
    let folder = tempfile::tempdir().map_err(|e| fault(ReadErrorKind::Io(e)))?;
    let csg = folder.path().join("model.csg");
    let program = options.openscad.clone().unwrap_or_else(|| PathBuf::from("openscad"));

    let mut command = Command::new(&program);
    // Without --render, $preview is true and many models leave parts out.
    command.arg("--render=1").arg("-o").arg(&csg);
    for definition in &options.definitions {
        command.arg("-D").arg(definition);
    }
    if let Some((file, set)) = &options.parameters {
        // The program may be run in another folder.
        let file = std::path::absolute(file).map_err(|e| fault(ReadErrorKind::Io(e)))?;
        command.arg("-p").arg(file).arg("-P").arg(set);
    }
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let output = match run(&mut command) {
        Ok(output) => output,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Err(fault(ReadErrorKind::OpenscadMissing { program }));
        }
        Err(error) => return Err(fault(ReadErrorKind::Io(error))),
    };
    let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
    if !output.status.success() {
        let status = output.status.to_string();
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
    let mut model = openscad::read(&text, &path.with_file_name(name), options)?;
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
