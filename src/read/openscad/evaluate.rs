//! From a document to a model, and what is gathered on the way.

use std::cell::Cell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::error::{Located, ReadErrorKind};
use super::super::load::Budget;
use super::super::outline::Extrusion;
use super::super::{Model, ReadOptions, Warning};
use super::combine;
use super::curve::Key;
use super::marks::Aside;
use super::node::Shape;
use super::value::Document;
use super::walk::shapes;
use crate::mesh::Mesh;
use crate::solid::{Place, Solid};

/// What evaluation needs to know and gathers.
#[derive(Debug)]
pub(super) struct Reading<'a> {
    pub(super) options: &'a ReadOptions,
    /// The folder of the file, where imports are looked for.
    pub(super) folder: &'a Path,
    /// What was read so far, but for the solid.
    pub(super) model: Model,
    /// The faceted curves made so far, because models repeat their screws.
    pub(super) curves: HashMap<Key, Arc<Mesh>>,
    /// The triangles in them and in polygons.
    facets: u64,
    /// The files imported so far.
    pub(super) imports: HashMap<PathBuf, Solid>,
    /// What OpenSCAD has made so far, by the texts it was given.
    pub(super) elsewhere: HashMap<String, Shape>,
    /// What it was asked for.
    pub(super) asked: Vec<String>,
    /// The installed fonts, once one was needed.
    pub(super) fonts: Option<fontdb::Database>,
    /// How much may still be imported.
    pub(super) budget: Budget,
    /// Why the first was left out of those polyhedra that bound no solid, and of files that are
    /// not there.
    left_out: Option<Located>,
    /// What is being made after `%`.
    pub(super) aside: Option<Aside>,
    /// Whether only the hull of what is being made matters.
    pub(super) is_hulled: bool,
    /// Whether facets stand for curves in what is being made.
    pub(super) is_fine: Cell<bool>,
    /// Whether what is being made becomes polygons or polyhedra by a node around it, so that it had
    /// better be one of them from the start.
    pub(super) is_faceted: bool,
}

impl Reading<'_> {
    /// Counts triangles that a curve or polygon at this place is made of.
    pub(super) fn count_facets(&mut self, more: u64, at: Place) -> Result<(), Located> {
        self.facets = self.facets.saturating_add(more);
        let (count, limit) = (self.facets, self.options.max_facets);
        if count > limit {
            return Err(Located::at(at, ReadErrorKind::TooManyFacets { count, limit }));
        }
        Ok(())
    }

    /// Leaves out a polyhedron that bounds no solid, or a file that is not there, with a warning.
    pub(super) fn leave_out(&mut self, error: Located, at: Place) {
        self.warn(at, format!("{}; it is left out, as by OpenSCAD", error.kind));
        self.left_out.get_or_insert(error);
    }

    /// What is to be as it was once a statement after `%` is made.
    pub(super) fn set_aside(&mut self, statement: usize) -> Aside {
        Aside {
            statement,
            counts: self.model.counts,
            facets: self.facets,
            budget: self.budget,
            asked: self.asked.len(),
            left_out: self.left_out.take(),
        }
    }

    pub(super) fn put_back(&mut self, aside: Aside) {
        self.model.counts = aside.counts;
        self.facets = aside.facets;
        self.budget = aside.budget;
        self.asked.truncate(aside.asked);
        self.left_out = aside.left_out;
        self.is_fine.set(false);
    }

    pub(super) fn warn(&mut self, place: Place, message: impl Into<String>) {
        let message = message.into();
        self.model.warnings.push(Warning { place: Some(place), message });
    }
}

/// The model that a document describes.
pub(super) fn model(
    document: &Document<'_>,
    path: &Path,
    options: &ReadOptions,
) -> Result<Model, Located> {
    let mut budget = Budget::new(options.max_bytes);
    budget.spend(document.text).map_err(Located::nowhere)?;
    let mut reading = Reading {
        options,
        folder: path.parent().unwrap_or(Path::new("")),
        model: Model::default(),
        curves: HashMap::new(),
        facets: 0,
        imports: HashMap::new(),
        elsewhere: HashMap::new(),
        asked: Vec::new(),
        fonts: None,
        budget,
        left_out: None,
        aside: None,
        is_hulled: false,
        is_fine: Cell::new(false),
        is_faceted: false,
    };
    let (next, end) = content(document);
    let (shapes, marked) = shapes(document, next, end, &mut reading)?;
    reading.model.marks = marked.into_marks();
    let start = Place { line: 1, column: 1 };
    reading.model.solid = match combine::all(shapes, "the file", start, &mut reading) {
        Shape::Solid(solid) => solid,
        Shape::Flat(outline) => {
            let Some(top) = options.plate else {
                return Err(Located::nowhere(ReadErrorKind::TwoDimensional));
            };
            let plate = outline.extruded(Extrusion { bottom: 0.0, top, scale: 1.0 });
            plate.map_err(|error| Located::nowhere(ReadErrorKind::Mesh(error)))?
        }
        // Nothing of what was meant is left.
        Shape::Empty => match reading.left_out {
            Some(error) => return Err(error),
            None => Solid::empty(),
        },
    };
    Ok(reading.model)
}

/// The statements to evaluate: all, or those of the first `!`.
fn content(document: &Document<'_>) -> (usize, usize) {
    let mut next = 0;
    while let Some(statement) = document.statements.get(next) {
        let end = statement.end as usize;
        if statement.modifiers.disabled {
            next = end;
        } else if statement.modifiers.root {
            return (next, end);
        } else {
            next += 1;
        }
    }
    (0, document.statements.len())
}
