//! Meshes as text, `.obj` and `.off`: each number with as many digits as tell it from all others.

use std::fmt::Write;

use crate::mesh::Mesh;
use crate::shown::Shown;

/// Wavefront's format, which counts points from one.
pub(super) fn obj(mesh: &Mesh) -> Vec<u8> {
    let mut out = String::from("# solidray\n");
    points(&mut out, mesh, "v ");
    faces(&mut out, mesh, "f", 1);
    out.into_bytes()
}

/// Geomview's format, which counts points from zero.
pub(super) fn off(mesh: &Mesh) -> Vec<u8> {
    let mut out = format!("OFF\n{} {} 0\n", mesh.points().len(), mesh.faces().len());
    points(&mut out, mesh, "");
    faces(&mut out, mesh, "3", 0);
    out.into_bytes()
}

fn points(out: &mut String, mesh: &Mesh, start: &str) {
    for p in mesh.points() {
        let [x, y, z] = p.to_array().map(Shown);
        // Writing to a string does not fail.
        let _ = writeln!(out, "{start}{x} {y} {z}");
    }
}

fn faces(out: &mut String, mesh: &Mesh, start: &str, first: u64) {
    for face in mesh.faces() {
        let [a, b, c] = face.map(|i| u64::from(i) + first);
        let _ = writeln!(out, "{start} {a} {b} {c}");
    }
}
