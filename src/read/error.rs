//! What can be wrong with a file.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::facets::FacetsError;
use crate::mesh::MeshError;
use crate::solid::Place;

/// Why a file could not be read, and where in it.
#[derive(Debug, Error)]
#[error("{}{}: {kind}", .path.display(), Colons(*.place))]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// The place in it, where there is one.
    pub place: Option<Place>,
    /// What is wrong.
    pub kind: ReadErrorKind,
}

/// What is wrong.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadErrorKind {
    /// The file cannot be opened or read.
    #[error("cannot be read: {0}")]
    Io(io::Error),
    /// The name of the file does not tell its format.
    #[error("the format is unknown; known are .csg, .scad, .obj, .stl, .off and .3mf")]
    UnknownFormat,
    /// The text is longer than places in it can be counted.
    #[error("the text has {0} bytes; at most 4294967295 are read")]
    TooLong(usize),
    /// The file, or the file and what it imports, is longer than
    /// [`ReadOptions::max_bytes`](super::ReadOptions::max_bytes).
    #[error(
        "there are more bytes to read than the limit of {limit}; --max-bytes raises it"
    )]
    TooManyBytes {
        /// The limit.
        limit: u64,
    },
    /// The text breaks the grammar.
    #[error("expected {expected}, found {found}")]
    Syntax {
        /// What may stand here.
        expected: String,
        /// What does.
        found: String,
    },
    /// Something that is understood but not implemented.
    #[error("{0} is not supported yet")]
    Unsupported(String),
    /// An argument of the wrong kind.
    #[error("`{argument}` of `{node}` must be {expected}, not {found}")]
    Argument {
        /// What has the argument.
        node: Box<str>,
        /// The argument.
        argument: Box<str>,
        /// What it may be.
        expected: Box<str>,
        /// What it is.
        found: Box<str>,
    },
    /// A line of an `.obj` breaks its grammar.
    #[error("{}", obj_advice(.0))]
    Obj(tobj::LoadError),
    /// A face of an `.obj` names a point that is not in the file.
    #[error(
        "a face names a point that is not in the file; the first `v` is 1, and -1 the last one before the face"
    )]
    NoSuchPoint,
    /// An archive that cannot be opened, or a part of it that cannot be unpacked.
    #[error("not a sound zip archive: {0}")]
    Archive(String),
    /// An archive lacks a part.
    #[error("the archive has no part `{0}`")]
    NoPart(Box<str>),
    /// A part of an archive is at fault.
    #[error("{0}")]
    Part(Box<ReadError>),
    /// A text breaks the rules of XML.
    #[error("not sound XML: {0}")]
    Xml(String),
    /// A text that has to be UTF-8 is not.
    #[error("the text is not UTF-8")]
    NotUtf8,
    /// An object of an archive is at fault.
    #[error("{name}: {error}")]
    Object {
        /// Its number, and its name if it has one.
        name: Box<str>,
        /// What is wrong with it.
        error: Box<Self>,
    },
    /// The points and faces do not bound a solid.
    #[error("{0}")]
    Mesh(MeshError),
    /// There are no facets where some are needed.
    #[error("{0}")]
    Facets(FacetsError),
    /// Curves and polygons would have more triangles than
    /// [`ReadOptions::max_facets`](super::ReadOptions::max_facets).
    #[error(
        "with this one, curves and polygons have {count} triangles, which is more than the limit of {limit}; --max-facets raises it"
    )]
    TooManyFacets {
        /// How many there would be.
        count: u64,
        /// The limit.
        limit: u64,
    },
    /// A binary file that ends before it should.
    #[error("the file declares {declared} triangles, but has bytes for {present}")]
    Truncated {
        /// How many triangles the file says it has.
        declared: u64,
        /// How many fit in it.
        present: u64,
    },
    /// The whole model is flat.
    #[error(
        "the model is two-dimensional; --plate THICKNESS or linear_extrude gives it a thickness"
    )]
    TwoDimensional,
    /// A model names a file that is not in its folder.
    #[error(
        "{} is outside of the folder of the model; --allow-outside reads it all the same",
        .0.display()
    )]
    Outside(PathBuf),
    /// A model names something that is no file with an end.
    #[error("{} is no regular file", .0.display())]
    NoFile(PathBuf),
    /// An imported file is at fault.
    #[error("import: {0}")]
    Import(Box<ReadError>),
    /// There is no font to write a text with.
    #[error(
        "there is no font to write `text` with; install one such as Liberation Sans (`apt install fonts-liberation`)"
    )]
    NoFont,
    /// There is no program to evaluate what is not supported here.
    #[error("{what} is left to `{}`, which was not found; install OpenSCAD (openscad.org, or `apt install openscad`)", .program.display())]
    OpenscadMissingFor {
        /// What is not supported.
        what: String,
        /// The program that was looked for.
        program: PathBuf,
    },
    /// There is no program to convert `.scad`.
    #[error("`{}` is needed to read .scad files, but was not found; install OpenSCAD (openscad.org, or `apt install openscad`) or export a .csg with it elsewhere", .program.display())]
    OpenscadMissing {
        /// The program that was looked for.
        program: PathBuf,
    },
    /// OpenSCAD took longer than
    /// [`ReadOptions::openscad_limit`](super::ReadOptions::openscad_limit).
    #[error(
        "openscad was stopped after {seconds} seconds; --openscad-limit gives it more"
    )]
    OpenscadSlow {
        /// The limit.
        seconds: f64,
    },
    /// OpenSCAD refused the file.
    #[error("openscad could not convert it ({status}): {stderr}")]
    OpenscadFailed {
        /// How it ended.
        status: String,
        /// What it said.
        stderr: String,
    },
}

/// A fault at a place in a text whose name is known further up.
#[derive(Debug)]
pub(super) struct Located {
    pub(super) place: Option<Place>,
    pub(super) kind: ReadErrorKind,
}

impl Located {
    pub(super) fn at(place: Place, kind: ReadErrorKind) -> Self {
        Self { place: Some(place), kind }
    }

    pub(super) fn nowhere(kind: ReadErrorKind) -> Self {
        Self { place: None, kind }
    }

    pub(super) fn syntax(
        place: Place,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> Self {
        let (expected, found) = (expected.into(), found.into());
        Self::at(place, ReadErrorKind::Syntax { expected, found })
    }

    /// The fault, at a place if it has none.
    pub(super) fn or_at(self, place: Place) -> Self {
        Self { place: self.place.or(Some(place)), ..self }
    }

    /// The fault, in a part of an archive, if it has a place there.
    pub(super) fn within(self, part: &str) -> Self {
        if self.place.is_none() {
            return self;
        }
        Self::nowhere(ReadErrorKind::Part(Box::new(self.named(Path::new(part)))))
    }

    pub(super) fn named(self, path: &Path) -> ReadError {
        ReadError { path: path.to_owned(), place: self.place, kind: self.kind }
    }
}

/// What a line of an `.obj` should be.
fn obj_advice(error: &tobj::LoadError) -> String {
    if matches!(error, tobj::LoadError::PositionParseError) {
        "expected `v` and three numbers, as in `v 1 0.5 -2`".to_owned()
    } else if matches!(error, tobj::LoadError::FaceParseError) {
        "expected `f` and the numbers of points, as in `f 1 2 3` or `f 1/1/1 2/2/2 3/3/3`"
            .to_owned()
    } else {
        format!("no line of an .obj file: {error}")
    }
}

/// A place as `:line:column`, or nothing.
struct Colons(Option<Place>);

impl fmt::Display for Colons {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(Place { line, column }) => write!(f, ":{line}:{column}"),
            None => Ok(()),
        }
    }
}
