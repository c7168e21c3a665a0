//! Stereolithography `.stl`, as text and binary.
//!
//! Every triangle lists its corners anew. They are made one as they are read, which takes
//! half a point a triangle instead of three.
//!
//! The crate `stl_io` is not used: it rounds the 17 digits of text to f32, and takes binary
//! files whose header starts with `solid` for text.

use glam::DVec3;

use super::error::{Located, ReadErrorKind};
use super::faces::{Faces, Points};
use super::words::Words;

/// Bytes before the first triangle: a header without meaning, and the count.
const HEAD: usize = 84;
/// Bytes of a triangle: normal, three points, a number without meaning.
const TRIANGLE: usize = 50;

pub(super) fn read(bytes: &[u8]) -> Result<Faces, Located> {
    // Many programs write `solid` into the header of binary files, so the length decides
    // first.
    let fits = declared(bytes).is_some_and(|n| bytes.len() as u64 == size(n));
    if !fits && is_text(bytes) { text(bytes) } else { binary(bytes) }
}

/// How many triangles the head of a binary file declares.
fn declared(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEAD - 4..HEAD)?.try_into().ok()?;
    Some(u64::from(u32::from_le_bytes(count)))
}

fn size(triangles: u64) -> u64 {
    HEAD as u64 + TRIANGLE as u64 * triangles
}

fn is_text(bytes: &[u8]) -> bool {
    let word = Words::new(bytes, None).next();
    word.is_some_and(|w| w.text.eq_ignore_ascii_case(b"solid"))
}

fn binary(bytes: &[u8]) -> Result<Faces, Located> {
    let Some(declared) = declared(bytes) else {
        let kind = ReadErrorKind::Syntax {
            expected: "`solid` or the head of a binary file".to_owned(),
            found: format!("{} bytes", bytes.len()),
        };
        return Err(Located::nowhere(kind));
    };
    let triangles = bytes[HEAD..].chunks_exact(TRIANGLE);
    let present = triangles.len() as u64;
    if present < declared {
        return Err(Located::nowhere(ReadErrorKind::Truncated { declared, present }));
    }
    let mut read = Soup::default();
    let count = usize::try_from(declared).unwrap_or(usize::MAX);
    for triangle in triangles.take(count) {
        let number = |at: usize| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| triangle[at + i]);
            f64::from(f32::from_le_bytes([a, b, c, d]))
        };
        let corners =
            [12, 24, 36].map(|at| DVec3::new(number(at), number(at + 4), number(at + 8)));
        read.push(&corners)?;
    }
    Ok(read.finish())
}

/// The words of text files are loose in practice: case and line breaks vary, normals are
/// missing. What counts is the vertices of each loop.
fn text(bytes: &[u8]) -> Result<Faces, Located> {
    let mut words = Words::new(bytes, None);
    let (mut read, mut corners) = (Soup::default(), Vec::new());
    while let Some(word) = words.next() {
        match word.text.to_ascii_lowercase().as_slice() {
            b"solid" | b"endsolid" => words.skip_line(),
            b"vertex" => {
                let point = [words.number()?, words.number()?, words.number()?];
                corners.push(DVec3::from_array(point));
            }
            b"endloop" if corners.len() < 3 => {
                return Err(word.unexpected("a third `vertex`"));
            }
            b"endloop" => {
                read.push(&corners)?;
                corners.clear();
            }
            b"facet" | b"outer" | b"loop" | b"endfacet" => {}
            b"normal" => {
                // Flat triangles have normals that are no numbers, such as `-nan(ind)`.
                for _ in 0..3 {
                    words.next().ok_or_else(|| words.ended("a normal"))?;
                }
            }
            _ => return Err(word.unexpected("`facet`, `vertex` or `endsolid`")),
        }
    }
    if corners.is_empty() { Ok(read.finish()) } else { Err(words.ended("`endloop`")) }
}

/// The faces read so far.
#[derive(Default)]
struct Soup {
    points: Points,
    faces: Faces,
    /// The corners of the face being added.
    face: Vec<u32>,
}

impl Soup {
    /// Adds a face, unless it has no area because two of its three corners are equal.
    fn push(&mut self, corners: &[DVec3]) -> Result<(), Located> {
        if let [a, b, c] = corners
            && (a == b || b == c || c == a)
        {
            return Ok(());
        }
        self.face.clear();
        for &corner in corners {
            self.face.push(self.points.add(corner)?);
        }
        self.faces.push(self.face.iter().copied());
        Ok(())
    }

    fn finish(mut self) -> Faces {
        self.faces.points = self.points.finish();
        self.faces
    }
}
