//! Wavefront `.obj`, through the crate tobj.
//!
//! It gets the lines that say where points and faces are, without comments and with
//! continued lines joined. Groups and materials do not change the solid and would only
//! split its points among several meshes; texture coordinates, normals, lines and
//! free-form curves are of no use here. Faces keep their corners: tobj would make fans of
//! them, which is wrong for concave ones.

use std::io::{BufRead, Read, Result};

use glam::DVec3;
use tobj::{LoadError, LoadOptions, Model};

use super::error::{Located, ReadErrorKind};
use super::faces::Faces;
use crate::solid::Place;

pub(super) fn read(text: &[u8]) -> std::result::Result<Faces, Located> {
    let mut lines = Lines { left: text, ready: Vec::new(), given: 0, at: 0 };
    let no_materials = |_: &std::path::Path| Err(LoadError::OpenFileFailed);
    let options = LoadOptions::default();
    match tobj::load_obj_buf(&mut lines, &options, no_materials) {
        Ok((models, _)) => collect(&models),
        // Found out when all lines have been taken.
        Err(LoadError::FaceVertexOutOfBounds) => {
            Err(Located::nowhere(ReadErrorKind::NoSuchPoint))
        }
        Err(error) => {
            let place = Place { line: lines.at.max(1), column: 1 };
            Err(Located::at(place, ReadErrorKind::Obj(error)))
        }
    }
}

/// The points and faces of all that tobj found.
fn collect(models: &[Model]) -> std::result::Result<Faces, Located> {
    let mut all = Faces::default();
    for mesh in models.iter().map(|model| &model.mesh) {
        let base = u32::try_from(all.points.len()).unwrap_or(u32::MAX);
        all.points.extend(mesh.positions.chunks_exact(3).map(DVec3::from_slice));
        let mut rest = mesh.indices.as_slice();
        let mut arities = mesh.face_arities.iter();
        while !rest.is_empty() {
            // Without arities all faces are triangles.
            let arity = arities.next().map_or(3, |&n| n as usize).clamp(1, rest.len());
            let (corners, others) = rest.split_at(arity);
            all.faces.push(corners.iter().map(|i| i.saturating_add(base)).collect());
            rest = others;
        }
    }
    Ok(all)
}

/// The lines that begin with `v` or `f`, and the number of the last one that was taken.
struct Lines<'a> {
    left: &'a [u8],
    /// The line being taken, and how much of it is.
    ready: Vec<u8>,
    given: usize,
    at: u32,
}

impl Lines<'_> {
    /// Makes the next line of interest ready, if there is one.
    fn advance(&mut self) {
        self.ready.clear();
        self.given = 0;
        while self.ready.is_empty() && !self.left.is_empty() {
            while self.take_line() {}
            let keyword =
                self.ready.split(u8::is_ascii_whitespace).find(|w| !w.is_empty());
            if !matches!(keyword, Some(b"v" | b"f")) {
                self.ready.clear();
            }
        }
        if !self.ready.is_empty() {
            self.ready.push(b'\n');
        }
    }

    /// Adds a line of the file to the one made ready; whether it is continued.
    fn take_line(&mut self) -> bool {
        let end = self.left.iter().position(|&b| b == b'\n').unwrap_or(self.left.len());
        let (line, rest) = self.left.split_at(end);
        self.left = rest.get(1..).unwrap_or_default();
        self.at = self.at.saturating_add(1);
        let text = line.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii_end();
        let continued =
            text.len() == line.trim_ascii_end().len() && text.ends_with(b"\\");
        self.ready.extend_from_slice(text.strip_suffix(b"\\").unwrap_or(text));
        continued && !self.left.is_empty()
    }
}

impl Read for Lines<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let ready = self.fill_buf()?;
        let n = ready.len().min(buffer.len());
        buffer[..n].copy_from_slice(&ready[..n]);
        self.consume(n);
        Ok(n)
    }
}

impl BufRead for Lines<'_> {
    fn fill_buf(&mut self) -> Result<&[u8]> {
        if self.given >= self.ready.len() {
            self.advance();
        }
        Ok(&self.ready[self.given..])
    }

    fn consume(&mut self, n: usize) {
        self.given = (self.given + n).min(self.ready.len());
    }
}
