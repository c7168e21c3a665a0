//! Wavefront `.obj`, through the crate tobj.
//!
//! It gets the lines that say where points and faces are, without comments and with continued
//! lines joined. Points come without the colours that many programs write after their
//! coordinates: tobj wants a colour at every point or at none, and none of four parts. A
//! fourth word alone is a weight. Groups and materials do not change the solid and would only
//! split its points among several meshes; texture coordinates, normals, lines and free-form
//! curves are of no use here. Faces keep their corners: tobj would make fans of them, which
//! is wrong for concave ones.

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
            let place = stray_face(text);
            Err(Located { place, kind: ReadErrorKind::NoSuchPoint })
        }
        Err(error) => {
            let place = Place { line: lines.at.max(1), column: 1 };
            Err(Located::at(place, ReadErrorKind::Obj(error)))
        }
    }
}

/// Where the first face stands that names a point which is not in the file. Faces may name
/// points of later lines; numbers below zero count back from the face.
fn stray_face(text: &[u8]) -> Option<Place> {
    let mut lines = Lines { left: text, ready: Vec::new(), given: 0, at: 0 };
    let (mut points, mut highest) = (0_i64, Vec::new());
    loop {
        lines.advance();
        let mut words = words(&lines.ready).map(|at| &lines.ready[at]);
        match words.next() {
            None => break,
            Some(b"v") => points += 1,
            Some(_) => {
                let named = words.filter_map(|word| {
                    let digits = word.split(|&b| b == b'/').next()?;
                    std::str::from_utf8(digits).ok()?.parse::<i64>().ok()
                });
                let (least, most) =
                    named.fold((i64::MAX, i64::MIN), |(least, most), n| {
                        let back = n < 0 && n >= -points;
                        (if back { least } else { least.min(n) }, most.max(n))
                    });
                let most = if least < 1 { i64::MAX } else { most };
                // Only faces that name a higher point than those before can be the first.
                if highest.last().is_none_or(|&(before, _)| most > before) {
                    highest.push((most, lines.at));
                }
            }
        }
    }
    let (_, line) = highest.into_iter().find(|&(most, _)| most > points)?;
    Some(Place { line, column: 1 })
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
            all.push(corners.iter().map(|i| i.saturating_add(base)));
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
            self.ready.truncate(wanted(&self.ready));
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

/// How much of a line tobj gets.
fn wanted(line: &[u8]) -> usize {
    let mut words = words(line);
    match words.next().map(|at| &line[at]) {
        Some(b"f") => line.len(),
        Some(b"v") => {
            let ends: Vec<usize> = words.map(|at| at.end).collect();
            if let [_, _, z, _, _, ..] = ends[..] { z } else { line.len() }
        }
        _ => 0,
    }
}

/// Where the words of a line are.
fn words(line: &[u8]) -> impl Iterator<Item = std::ops::Range<usize>> {
    let mut from = 0;
    let ranges = line.split(u8::is_ascii_whitespace).map(move |word| {
        let at = from..from + word.len();
        from = at.end + 1;
        at
    });
    ranges.filter(|at| !at.is_empty())
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
