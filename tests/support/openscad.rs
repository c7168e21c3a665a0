//! The installed OpenSCAD, and what it makes of files.

#[path = "program.rs"]
pub(crate) mod program;

use std::path::Path;
use std::process::Command;

use solidray::facets::{boundary, faceted};
use solidray::read::{self, ReadOptions};
use solidray::{Solid, unwatched};

/// Whether there is one; what is done without it is said. Where it must be there, its absence is
/// a failure.
pub(crate) fn is_installed(without: &str) -> bool {
    program::is_installed("openscad", "--version", "SOLIDRAY_REQUIRE_OPENSCAD", without)
}

/// The volume that it gives a file; nothing is 0.
pub(crate) fn volume_of(file: &Path) -> f64 {
    made_of(file).map_or(0.0, |solid| enclosed(&solid))
}

/// What it makes of a file, if that is anything.
pub(crate) fn made_of(file: &Path) -> Option<Solid> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mesh = folder.path().join("made.off");
    let done = Command::new("openscad").arg("-o").args([&mesh, file]).output();
    let done = done.expect("it starts");
    let said = String::from_utf8_lossy(&done.stderr);
    if said.contains("object is empty") {
        return None;
    }
    assert!(done.status.success(), "{}: {said}", file.display());
    Some(read::file(&mesh, &ReadOptions::default()).expect("a closed mesh").solid)
}

/// The volume that the surface of a solid of meshes encloses, which Manifold finds.
pub(crate) fn enclosed(solid: &Solid) -> f64 {
    let faceted = faceted(solid, 3, 1 << 22).expect("it has facets");
    assert_eq!(faceted.curves, 0);
    let surface = boundary(&faceted, &unwatched).expect("Manifold takes it");
    surface.map_or(0.0, |mesh| mesh.volume())
}
