//! The files that a model names.

use std::path::{Component, Path, PathBuf};

use super::super::error::ReadErrorKind;
use super::super::options::{Imports, ReadOptions};

/// Where a file is that a model in a folder names.
///
/// # Errors
///
/// That it is outside of that folder, by its name or by links, and may not be; or that it is a
/// folder, a pipe or a device. A file that is not there is found out when it is opened.
pub(super) fn path(
    name: &str,
    folder: &Path,
    options: &ReadOptions,
) -> Result<PathBuf, ReadErrorKind> {
    let path = folder.join(name);
    let is_outside = match options.imports {
        Imports::Anywhere => false,
        Imports::Folder => leaves(Path::new(name)) || links_away(&path, folder),
    };
    if is_outside {
        return Err(ReadErrorKind::Outside(path));
    }
    // A pipe would be waited for until somebody writes to it.
    if std::fs::metadata(&path).is_ok_and(|metadata| !metadata.is_file()) {
        return Err(ReadErrorKind::NoFile(path));
    }
    Ok(path)
}

/// Whether a name leads out of the folder that it starts from.
fn leaves(name: &Path) -> bool {
    let mut depth = 0_usize;
    for component in name.components() {
        match component {
            Component::Prefix(_) | Component::RootDir => return true,
            Component::CurDir => {}
            Component::Normal(_) => depth += 1,
            Component::ParentDir => match depth.checked_sub(1) {
                Some(up) => depth = up,
                None => return true,
            },
        }
    }
    false
}

/// Whether a file that is there is elsewhere, by symbolic links.
fn links_away(path: &Path, folder: &Path) -> bool {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    match (path.canonicalize(), folder.canonicalize()) {
        (Ok(path), Ok(folder)) => !path.starts_with(folder),
        _ => false,
    }
}
