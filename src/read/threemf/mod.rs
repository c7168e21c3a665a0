//! `.3mf`: a zip archive of parts, one of them a text that names objects and where they stand.
//!
//! ```text
//!  zip ── package ──► text of a part ── part ──► objects ── book ──► Contents
//! ```
//!
//! The core specification (3MF Consortium, "3MF Core Specification" 1.3) is read, with objects in
//! other parts of the archive as the production extension (1.1) has them. An object may only use
//! objects that are before it, so there are no cycles, and it shares what it uses: a chain of
//! objects, each twice the one before, is a tree that is small until it is compiled.
//!
//! The crate `threemf2` is not used: it keeps the whole tree of elements, and inflates parts
//! without a limit. What the specification asks for beyond geometry (content types, thumbnails,
//! signatures) is not looked at.

mod book;
mod header;
mod package;
mod part;
mod value;

use glam::{DAffine3, DVec3};

use super::error::Located;
use super::load::Budget;
use super::model::{Model, Warning};
use crate::op::Op;
use crate::solid::Solid;
use book::Book;
use package::Package;

/// What an archive describes.
pub(super) struct Contents {
    /// The objects that its build lists, where it puts them, in millimetres.
    pub(super) built: Vec<Solid>,
    /// The meshes of all objects, as they are written.
    pub(super) meshes: Vec<Solid>,
    /// How many meshes were inside out and have been turned.
    pub(super) turned: usize,
    /// What there is to say about it.
    pub(super) warnings: Vec<String>,
    /// Whether the build has them in other places or other units.
    pub(super) is_moved: bool,
}

/// Reads an archive. What its parts take when they are inflated is counted.
pub(super) fn read(bytes: &[u8], budget: &mut Budget) -> Result<Contents, Located> {
    let mut package = Package::open(bytes)?;
    let start = package.start(budget)?;
    let start = start.strip_prefix('/').unwrap_or(&start);
    let mut book = Book::default();
    part::read(&mut package, start, true, budget, &mut book)?;
    let is_scaled = (book.unit - 1.0).abs() > 0.0;
    let scale = DAffine3::from_scale(DVec3::splat(book.unit));
    let in_millimetres =
        |solid: Solid| if is_scaled { solid.mapped(scale) } else { solid };
    Ok(Contents {
        turned: book.turned,
        warnings: book.warnings(),
        is_moved: book.is_moved || is_scaled,
        built: book.built.into_iter().map(in_millimetres).collect(),
        meshes: book.meshes,
    })
}

/// The model of an archive: what its build lists.
pub(super) fn model(bytes: &[u8], budget: &mut Budget) -> Result<Model, Located> {
    let contents = read(bytes, budget)?;
    let mut model = Model { solid: union(contents.built), ..Model::default() };
    model.counts.turned = contents.turned;
    let warning = |message| Warning { place: None, message };
    model.warnings = contents.warnings.into_iter().map(warning).collect();
    Ok(model)
}

/// One solid of all.
pub(super) fn union(mut solids: Vec<Solid>) -> Solid {
    match (solids.pop(), solids.is_empty()) {
        (Some(only), true) => only,
        (last, _) => Solid::boolean(Op::Union, solids.into_iter().chain(last)),
    }
}
