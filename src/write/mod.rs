//! Meshes as text and bytes for other programs.
//!
//! A format rounds coordinates as far as it must. [`rounded`] is what is left of a mesh then,
//! closed like any other, so that what is measured of it is true of the file.
//!
//! # To add a format
//!
//! Write its file, and add it to [`Format`] and to the matches in [`Format::of`], [`rounded`] and
//! [`bytes`].

mod single;
mod stl;
mod text;
mod threemf;

use std::path::Path;

use thiserror::Error;

use crate::mesh::{Mesh, MeshError};
use crate::parts::Part;

/// The formats that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Stereolithography, binary: coordinates in single precision, 7 digits.
    Stl,
    /// Wavefront's mesh format, with all digits.
    Obj,
    /// The object file format of Geomview, with all digits.
    Off,
    /// 3MF, with all digits, in millimetres. [`archive`] writes several objects.
    ThreeMf,
}

impl Format {
    /// The format that the ending of a file's name stands for.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "stl" => Some(Self::Stl),
            "obj" => Some(Self::Obj),
            "off" => Some(Self::Off),
            "3mf" => Some(Self::ThreeMf),
            _ => None,
        }
    }
}

/// Why a mesh has no place in a file.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum WriteError {
    /// A coordinate beyond what single precision can hold.
    #[error("{0:e} is too large for a number of an STL file")]
    OutOfRange(f64),
    /// What rounding leaves is not the surface of a solid.
    #[error("rounded to the 7 digits of an STL file there is no solid left: {0}")]
    Rounded(MeshError),
    /// There is no archive of this.
    #[error("a .3mf archive could not be made: {0}")]
    Archive(String),
}

/// The mesh that a file will hold. With the format's digits points can become equal: they are
/// made one, and triangles that are lines then, or that cover each other, are left out.
///
/// # Errors
///
/// If coordinates are too large or nothing is left.
pub fn rounded(mesh: &Mesh, format: Format) -> Result<Mesh, WriteError> {
    match format {
        Format::Stl => single::rounded(mesh),
        Format::Obj | Format::Off | Format::ThreeMf => Ok(mesh.clone()),
    }
}

/// A file with a mesh, which is that of [`rounded`].
///
/// # Errors
///
/// If coordinates are too large or nothing is left.
pub fn bytes(mesh: &Mesh, format: Format) -> Result<Vec<u8>, WriteError> {
    match format {
        Format::Stl => Ok(stl::bytes(&single::rounded(mesh)?)),
        Format::Obj => Ok(text::obj(mesh)),
        Format::Off => Ok(text::off(mesh)),
        Format::ThreeMf => archive(&[(Part::default(), mesh)]),
    }
}

/// A `.3mf` archive with an object for each part. If there are several, one object more has
/// all of them as its components, and is what is built.
///
/// ```
/// use solidray::read::{self, Format, ReadOptions};
/// use solidray::{Color, Part, Solid, facets, unwatched, write};
///
/// let mesh = facets::surface(&Solid::ball(5.0), 0.01, 100_000, &unwatched)?.expect("a ball");
/// let part = Part { name: Some("knob".into()), color: Some(Color::rgb(1.0, 0.0, 0.0)) };
/// let bytes = write::archive(&[(part.clone(), &mesh)])?;
///
/// let read = read::bytes(&bytes, "knob.3mf".as_ref(), Format::ThreeMf, &ReadOptions::default())?;
/// assert_eq!(read.solid.parts()[0].0, part);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// If the archive would be too large.
pub fn archive(objects: &[(Part, &Mesh)]) -> Result<Vec<u8>, WriteError> {
    threemf::bytes(objects)
}
