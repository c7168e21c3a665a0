//! OpenSCAD's `.csg`: the tree that OpenSCAD has made of a program.
//!
//! ```text
//!  bytes ── lex ── parse ──► Document ── evaluate ──► Shape ──► Model
//!                            (flat)      │ walk
//!                                        └─ node: which function makes which node
//! ```
//!
//! Neither stage recurses: statements and vectors are kept in flat lists in the order of
//! the text, each with the index where its subtree ends.
//!
//! To add a node: a function in one of the files of families ([`solids`], [`outlines`],
//! [`combine`] …) or in a new one, its line in the table of [`node`], and its `mod` line
//! here if the file is new.

mod arguments;
mod combine;
mod convex;
mod curve;
mod elsewhere;
mod evaluate;
mod extrude;
mod file;
mod import;
mod lex;
mod marks;
mod node;
mod offset;
mod outlines;
mod parse;
mod polyhedron;
mod project;
mod resize;
mod revolve;
mod solids;
mod surface;
#[cfg(test)]
mod tests;
mod text;
mod transform;
mod value;
mod walk;

use std::path::Path;

use super::error::{Located, ReadError, ReadErrorKind};
use super::{Model, ReadOptions};

/// Reads a `.csg`; imports are looked for in the folder of the path.
pub(super) fn read(
    bytes: &[u8],
    path: &Path,
    options: &ReadOptions,
) -> Result<Model, ReadError> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let model = || {
        // Offsets are kept as u32: 60 MB of points are 15 million of them.
        if u32::try_from(text.len()).is_err() {
            return Err(Located::nowhere(ReadErrorKind::TooLong(text.len())));
        }
        let document = parse::document(text)?;
        evaluate::model(&document, path, options)
    };
    model().map_err(|error| error.named(path))
}
