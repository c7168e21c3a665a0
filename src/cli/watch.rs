//! Work that is done again whenever a model changes.
//!
//! Times of change are asked for a few times a second. That finds changes on network drives
//! too, and files that editors put in the place of others, of which the notices of an operating
//! system tell nothing or too much; a folder of models is small.

use std::collections::hash_map::DefaultHasher;
use std::ffi::OsStr;
use std::fs::Metadata;
use std::hash::{Hash, Hasher};
use std::path::Path;
use std::time::Duration;

use anyhow::Context;

use super::{is_broken_pipe, report};

/// How often files are looked at.
const PAUSE: Duration = Duration::from_millis(200);

/// How the names of files end that models are made of. Pictures are not among them, so that
/// what is drawn into the folder does not count as a change.
const ENDINGS: [&str; 11] =
    ["csg", "scad", "obj", "stl", "off", "amf", "3mf", "dxf", "svg", "dat", "json"];

/// Does work now, and again whenever the file changes, or something in its folder that models
/// are made of. Errors are printed, and it goes on; it ends when nobody reads the output any
/// more, or at once if the file is not there to begin with.
pub(super) fn watch<T>(
    file: &Path,
    mut work: impl FnMut() -> anyhow::Result<()>,
) -> anyhow::Result<T> {
    std::fs::metadata(file).with_context(|| file.display().to_string())?;
    loop {
        // Looked at before: what changes during the work counts.
        let before = state(file);
        match work() {
            Err(error) if is_broken_pipe(&error) => return Err(error),
            Err(error) => report::error(&error),
            Ok(()) => {}
        }
        let mut now = state(file);
        while now == before {
            std::thread::sleep(PAUSE);
            now = state(file);
        }
        // Many programs write a file in several steps.
        loop {
            std::thread::sleep(PAUSE);
            let next = state(file);
            if next == std::mem::replace(&mut now, next) {
                break;
            }
        }
    }
}

/// A number that changes with the file and what is in its folder. It takes no memory, however
/// many files there are, and does not depend on the order in which they are listed.
fn state(file: &Path) -> u64 {
    let mut sum = of_file(file.as_os_str(), std::fs::metadata(file).ok());
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    let Ok(entries) = std::fs::read_dir(folder.unwrap_or(Path::new("."))) else {
        return sum;
    };
    for entry in entries.flatten() {
        let path = entry.path();
        let ending = path.extension().map(OsStr::to_ascii_lowercase);
        if ending.is_some_and(|ending| ENDINGS.iter().any(|known| ending == *known)) {
            // Of what a link points to, not of the link.
            let now = of_file(&entry.file_name(), std::fs::metadata(&path).ok());
            sum = sum.wrapping_add(now);
        }
    }
    sum
}

/// A number for a file as it is now; one that is not there has one too.
fn of_file(name: &OsStr, found: Option<Metadata>) -> u64 {
    let mut hasher = DefaultHasher::new();
    name.hash(&mut hasher);
    let now = found.map(|metadata| (metadata.len(), metadata.modified().ok()));
    now.hash(&mut hasher);
    hasher.finish()
}
