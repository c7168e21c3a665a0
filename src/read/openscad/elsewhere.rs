//! Nodes that are not evaluated here: the installed OpenSCAD does it, with facets.
//!
//! It gets the text of the node alone and gives a mesh, or for a plane shape an `.svg` of straight
//! lines.

use std::fmt::Write as _;

use glam::DVec2;

use super::super::Warning;
use super::super::error::{Located, ReadErrorKind};
use super::super::faces::Faces;
use super::super::off;
use super::super::outline::Outline;
use super::super::program::{self, Fault};
use super::evaluate::Reading;
use super::file;
use super::node::Shape;
use super::value::{Document, Value};
use crate::solid::{Place, Solid, Tag};

/// The nodes of OpenSCAD that are known, but not made here.
const NODES: &[&str] = &["fill", "roof"];

/// Whether a node is one that OpenSCAD can make.
pub(super) fn is_known(name: &str) -> bool {
    NODES.contains(&name)
}

/// What OpenSCAD makes of a statement; `what` is why it is asked.
pub(super) fn evaluated(
    document: &Document<'_>,
    statement: usize,
    what: String,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let place = document.statements[statement].place;
    let text = text(document, statement, reading)?;
    let shape = match reading.elsewhere.get(&text) {
        Some(shape) => shape.clone(),
        None => {
            let made = made(&text, &what, place, reading);
            let shape = made.map_err(|error| error.or_at(place))?;
            reading.elsewhere.insert(text, shape.clone());
            shape
        }
    };
    reading.model.counts.elsewhere += 1;
    if !reading.asked.contains(&what) {
        reading.warn(place, format!("{what} is left to OpenSCAD, which makes facets"));
        reading.asked.push(what);
    }
    Ok(match shape {
        Shape::Empty => Shape::Empty,
        Shape::Flat(outline) => Shape::Flat(outline.tagged(Tag::Place(place))),
        Shape::Solid(solid) => Shape::Solid(solid.placed(place)),
    })
}

fn made(
    text: &str,
    what: &str,
    place: Place,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let fault = |kind| Located::nowhere(kind);
    let io = |error| fault(ReadErrorKind::Io(error));
    let folder = tempfile::tempdir().map_err(io)?;
    let source = folder.path().join("node.csg");
    std::fs::write(&source, text).map_err(io)?;
    let mut export = |name: &str| {
        let file = folder.path().join(name);
        let done = program::run(&file, source.as_os_str(), reading.options, |_| Ok(()));
        let done = done.map_err(|error| match error {
            Fault::Missing { program } => {
                let what = what.to_owned();
                fault(ReadErrorKind::OpenscadMissingFor { what, program })
            }
            Fault::Other(kind) => fault(kind),
        })?;
        let said = &done.said;
        for line in said.lines().filter(|line| line.starts_with("WARNING")) {
            let (place, message) = (Some(place), format!("openscad: {line}"));
            let warning = Warning { place, message };
            // A plane shape is asked for twice.
            if !reading.model.warnings.contains(&warning) {
                reading.model.warnings.push(warning);
            }
        }
        let failed = |status: String| {
            let stderr = said.clone();
            Err(fault(ReadErrorKind::OpenscadFailed { status, stderr }))
        };
        match done.status {
            _ if said.contains("Can't open") => failed("a file is missing".to_owned()),
            _ if said.contains("Ignoring unknown module") => {
                failed("it does not know the node".to_owned())
            }
            status if status.success() => {
                Ok(Some(reading.budget.load(&file).map_err(fault)?))
            }
            _ if said.contains("object is empty") => Ok(None),
            _ if said.contains("not a 3D object") => Ok(Some(Vec::new())),
            status => failed(status.to_string()),
        }
    };
    let Some(mesh) = export("node.off")? else { return Ok(Shape::Empty) };
    if !mesh.is_empty() {
        // Places in that file mean nothing in this one.
        let built = off::read(&mesh).and_then(Faces::build).map_err(|e| fault(e.kind))?;
        return Ok(Shape::Solid(Solid::mesh(built.mesh)));
    }
    let Some(picture) = export("node.svg")? else { return Ok(Shape::Empty) };
    let paths = lines(&String::from_utf8_lossy(&picture));
    if paths.is_empty() {
        let status = "its drawing has no lines".to_owned();
        return Err(fault(ReadErrorKind::OpenscadFailed {
            status,
            stderr: String::new(),
        }));
    }
    Ok(Shape::Flat(Outline::paths(paths)))
}

/// The closed lines of an `.svg` that OpenSCAD writes: all in one path of `M`, `L` and `z`, with
/// y downwards.
fn lines(picture: &str) -> Vec<Vec<DVec2>> {
    let mut paths: Vec<Vec<DVec2>> = Vec::new();
    for path in picture.split("<path d=\"").skip(1) {
        for word in path.split('"').next().unwrap_or_default().split_ascii_whitespace() {
            if word == "M" {
                paths.push(Vec::new());
            }
            let numbers = word.split_once(',');
            let point = numbers.and_then(|(x, y)| {
                Some(DVec2::new(x.parse().ok()?, -y.parse::<f64>().ok()?))
            });
            if let (Some(point), Some(path)) = (point, paths.last_mut()) {
                path.push(point);
            }
        }
    }
    paths
}

/// The text of a statement and what is in its braces, with the files it names by their whole
/// paths.
fn text(
    document: &Document<'_>,
    statement: usize,
    reading: &Reading<'_>,
) -> Result<String, Located> {
    let mut text = String::new();
    let mut open: Vec<usize> = Vec::new();
    let end = document.statements[statement].end as usize;
    for (i, statement) in document.statements[..end].iter().enumerate().skip(statement) {
        while open.pop_if(|end| *end <= i).is_some() {
            text.push('}');
        }
        let modifiers = statement.modifiers;
        if modifiers.disabled || modifiers.background {
            text.push(if modifiers.disabled { '*' } else { '%' });
        }
        text.push_str(statement.name);
        text.push('(');
        for index in statement.arguments.clone() {
            let argument = &document.arguments[index as usize];
            comma(&mut text);
            if let Some(name) = argument.name {
                let _ = write!(text, "{name}=");
            }
            let named = match argument.name {
                Some("file" | "filename") => document.string(argument.value),
                // Old nodes take files where others take numbers.
                None if !matches!(statement.name, "text" | "color") => {
                    document.string(argument.value)
                }
                _ => None,
            };
            match named {
                Some(name) => {
                    let path = file::path(&name, reading.folder, reading.options);
                    let path = path.map_err(|kind| Located::at(statement.place, kind))?;
                    let whole = std::path::absolute(path);
                    let whole = whole.unwrap_or_default().to_string_lossy().into_owned();
                    let whole = whole.replace('\\', "\\\\").replace('"', "\\\"");
                    let _ = write!(text, "\"{whole}\"");
                }
                None => value(document, argument.value as usize, &mut text),
            }
        }
        text.push(')');
        if statement.end as usize > i + 1 {
            text.push('{');
            open.push(statement.end as usize);
        } else {
            text.push_str(";\n");
        }
    }
    text.extend(open.iter().map(|_| '}'));
    Ok(text)
}

/// The text of a value and all that is in it.
fn value(document: &Document<'_>, value: usize, text: &mut String) {
    let mut open: Vec<usize> = Vec::new();
    let end = match document.values[value] {
        Value::Vector { end } => end as usize,
        Value::Undef | Value::Bool(_) | Value::Number(_) | Value::Text { .. } => {
            value + 1
        }
    };
    for i in value..end {
        while open.pop_if(|end| *end <= i).is_some() {
            text.push(']');
        }
        if i > value {
            comma(text);
        }
        match document.values[i] {
            Value::Vector { end } => {
                text.push('[');
                open.push(end as usize);
                continue;
            }
            Value::Undef => text.push_str("undef"),
            Value::Bool(truth) => text.push_str(if truth { "true" } else { "false" }),
            Value::Number(x) if x.is_finite() => {
                let _ = write!(text, "{x:e}");
            }
            // There is no literal for others.
            Value::Number(_) => text.push_str("(0/0)"),
            Value::Text { start, end } => {
                let raw = &document.text[start as usize..end as usize];
                let _ = write!(text, "\"{}\"", String::from_utf8_lossy(raw));
            }
        }
    }
    text.extend(open.iter().map(|_| ']'));
}

/// What separates an argument or element from the one before.
fn comma(text: &mut String) {
    if !text.ends_with(['(', '[']) {
        text.push(',');
    }
}
