//! Walks the statements and makes shapes from the leaves up.

use std::cell::Cell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::error::{Located, ReadErrorKind};
use super::super::load::Budget;
use super::super::outline::Extrusion;
use super::super::words::quoted;
use super::super::{Model, ReadOptions, Warning};
use super::arguments::Call;
use super::combine;
use super::curve::Key;
use super::elsewhere;
use super::node::{Node, Shape, node};
use super::value::Document;
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

    pub(super) fn warn(&mut self, place: Place, message: impl Into<String>) {
        let message = message.into();
        self.model.warnings.push(Warning { place: Some(place), message });
    }
}

/// A statement whose braces are open.
struct Frame {
    node: Node,
    statement: usize,
    children: Vec<Shape>,
    /// Whether only the hull of its children matters.
    hulls: bool,
    /// Whether its children become polygons or polyhedra.
    facets: bool,
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
        is_hulled: false,
        is_fine: Cell::new(false),
        is_faceted: false,
    };
    let (next, end) = content(document);
    let shapes = shapes(document, next, end, &mut reading)?;
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

/// The shapes of the outermost statements in a range.
fn shapes(
    document: &Document<'_>,
    mut next: usize,
    end: usize,
    reading: &mut Reading<'_>,
) -> Result<Vec<Shape>, Located> {
    let mut outermost = Vec::new();
    let mut open: Vec<Frame> = Vec::new();
    loop {
        let ends = |f: &mut Frame| document.statements[f.statement].end as usize <= next;
        while let Some(frame) = open.pop_if(ends) {
            let statement = &document.statements[frame.statement];
            let parameters = frame.node.parameters;
            let call = Call { document, statement, parameters };
            call.warn_of_unknown(reading);
            reading.is_hulled = open.last().is_some_and(|frame| frame.hulls);
            reading.is_faceted = open.last().is_some_and(|frame| frame.facets);
            let shape = match (frame.node.make)(&call, frame.children, reading) {
                Err(Located { kind: ReadErrorKind::Unsupported(what), .. }) => {
                    elsewhere::evaluated(document, frame.statement, what, reading)?
                }
                made => made?,
            };
            reading.model.counts.fine += usize::from(reading.is_fine.take());
            let outer = open.last_mut().map_or(&mut outermost, |f| &mut f.children);
            outer.push(shape);
        }
        if next >= end {
            return Ok(outermost);
        }
        let statement = &document.statements[next];
        // What takes no part in the model may be anything, even what cannot be read.
        if statement.modifiers.disabled || statement.modifiers.background {
            next = statement.end as usize;
            continue;
        }
        let Some(node) = node(statement.name) else {
            if elsewhere::is_known(statement.name) {
                let what = quoted(statement.name.as_bytes());
                let shape = elsewhere::evaluated(document, next, what, reading)?;
                let outer = open.last_mut().map_or(&mut outermost, |f| &mut f.children);
                outer.push(shape);
                next = statement.end as usize;
                continue;
            }
            let kind = ReadErrorKind::Unsupported(quoted(statement.name.as_bytes()));
            return Err(Located::at(statement.place, kind));
        };
        let hulls = match statement.name {
            "hull" => true,
            "group" | "union" | "multmatrix" | "color" | "render" => {
                open.last().is_some_and(|frame| frame.hulls)
            }
            _ => false,
        };
        let facets = match statement.name {
            "minkowski" | "offset" | "projection" => true,
            _ => open.last().is_some_and(|frame| frame.facets),
        };
        open.push(Frame { node, statement: next, children: Vec::new(), hulls, facets });
        next += 1;
    }
}
