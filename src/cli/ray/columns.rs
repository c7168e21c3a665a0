//! The table of spans: what it may have, and how its lines are written.
//!
//! To add a column: a row in [`COLUMNS`].

use std::borrow::Cow;
use std::io::Write;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use serde::ser::{Serialize, SerializeMap, Serializer};
use solidray::{Crossing, Ray, Scene, Span};

use super::super::output;
use super::super::pieces;

/// What a line of the table is about.
pub(super) struct Row<'a> {
    scene: &'a Scene,
    ray: &'a Ray,
    span: &'a Span,
    /// Which ray, from 0.
    number: u64,
    /// Which of its spans, from 0.
    span_number: u64,
}

/// What stands in a place of the table.
enum Cell<'a> {
    Count(u64),
    Number(f64),
    Text(Cow<'a, str>),
    /// Nothing is known, or there is no such number.
    Nothing,
}

/// A column: its name, what it says, and how it is found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column {
    name: &'static str,
    help: &'static str,
    cell: for<'a> fn(&Row<'a>) -> Cell<'a>,
}

const fn column(
    name: &'static str,
    help: &'static str,
    cell: for<'a> fn(&Row<'a>) -> Cell<'a>,
) -> Column {
    Column { name, help, cell }
}

const COLUMNS: &[Column] = &[
    column("ray", "the number of the ray, from 0", |r| Cell::Count(r.number)),
    column("span", "the number of the stretch on its ray, from 0", |r| {
        Cell::Count(r.span_number)
    }),
    column("ox", "the ray's origin", |r| number(r.ray.origin.x)),
    column("oy", "", |r| number(r.ray.origin.y)),
    column("oz", "", |r| number(r.ray.origin.z)),
    column("dx", "the ray's direction", |r| number(r.ray.dir.x)),
    column("dy", "", |r| number(r.ray.dir.y)),
    column("dz", "", |r| number(r.ray.dir.z)),
    column("t_in", "where it goes in, in multiples of the direction", |r| {
        number(r.span.enter.t)
    }),
    column("t_out", "where it comes out", |r| number(r.span.exit.t)),
    column("length", "how long the stretch is, in model units", |r| {
        number(r.span.length() * r.ray.speed())
    }),
    column("x_in", "the point where it goes in", |r| number(r.ray.at(r.span.enter.t).x)),
    column("y_in", "", |r| number(r.ray.at(r.span.enter.t).y)),
    column("z_in", "", |r| number(r.ray.at(r.span.enter.t).z)),
    column("x_out", "the point where it comes out", |r| {
        number(r.ray.at(r.span.exit.t).x)
    }),
    column("y_out", "", |r| number(r.ray.at(r.span.exit.t).y)),
    column("z_out", "", |r| number(r.ray.at(r.span.exit.t).z)),
    column("nx_in", "the outward unit normal where it goes in", |r| {
        number(r.scene.normal_at(r.ray, &r.span.enter).x)
    }),
    column("ny_in", "", |r| number(r.scene.normal_at(r.ray, &r.span.enter).y)),
    column("nz_in", "", |r| number(r.scene.normal_at(r.ray, &r.span.enter).z)),
    column("nx_out", "the outward unit normal where it comes out", |r| {
        number(r.scene.normal_at(r.ray, &r.span.exit).x)
    }),
    column("ny_out", "", |r| number(r.scene.normal_at(r.ray, &r.span.exit).y)),
    column("nz_out", "", |r| number(r.scene.normal_at(r.ray, &r.span.exit).z)),
    column(
        "error_in",
        "how far t_in is off at most; nothing if that is not bounded",
        |r| error(r, &r.span.enter),
    ),
    column("error_out", "the same of t_out", |r| error(r, &r.span.exit)),
    column("leaf_in", "which leaf's surface it goes in by", |r| {
        Cell::Count(r.span.enter.leaf.into())
    }),
    column("leaf_out", "which it comes out by", |r| Cell::Count(r.span.exit.leaf.into())),
    column("face_in", "which face of the leaf", |r| {
        Cell::Count(r.span.enter.face.into())
    }),
    column("face_out", "", |r| Cell::Count(r.span.exit.face.into())),
    column("kind_in", "what shape the leaf has", |r| {
        Cell::Text(r.scene.leaf(r.span.enter.leaf).kind.into())
    }),
    column("kind_out", "", |r| Cell::Text(r.scene.leaf(r.span.exit.leaf).kind.into())),
    column("part_in", "the name or colour of the leaf, whose surface it is", |r| {
        part(r, &r.span.enter)
    }),
    column("part_out", "", |r| part(r, &r.span.exit)),
    column(
        "place_in",
        "line:column of the leaf in its file, of a .scad in its .csg",
        |r| place(r, &r.span.enter),
    ),
    column("place_out", "", |r| place(r, &r.span.exit)),
];

/// The columns of a table for which none were chosen.
const USUAL: &[&str] = &[
    "ray", "t_in", "t_out", "length", "x_in", "y_in", "z_in", "x_out", "y_out", "z_out",
    "leaf_in", "leaf_out",
];

/// Added to zero: there is no minus in front of nothing.
fn number(x: f64) -> Cell<'static> {
    if x.is_finite() { Cell::Number(x + 0.0) } else { Cell::Nothing }
}

fn error(row: &Row<'_>, crossing: &Crossing) -> Cell<'static> {
    number(row.scene.error_at(row.ray, crossing))
}

fn part<'a>(row: &Row<'a>, crossing: &Crossing) -> Cell<'a> {
    Cell::Text(pieces::label(row.scene.leaf(crossing.leaf).part).into())
}

fn place(row: &Row<'_>, crossing: &Crossing) -> Cell<'static> {
    match row.scene.leaf(crossing.leaf).place {
        Some(place) => Cell::Text(format!("{}:{}", place.line, place.column).into()),
        None => Cell::Nothing,
    }
}

/// The columns of a table for which none were chosen.
pub(super) fn usual() -> Vec<Column> {
    USUAL.iter().filter_map(|name| named(name)).collect()
}

fn named(name: &str) -> Option<Column> {
    COLUMNS.iter().find(|column| column.name == name).copied()
}

/// Reads the name of a column; `--help` lists them.
pub(super) fn parser() -> impl TypedValueParser<Value = Column> {
    let values = COLUMNS.iter().map(|column| {
        let value = PossibleValue::new(column.name);
        if column.help.is_empty() { value } else { value.help(column.help) }
    });
    PossibleValuesParser::new(values)
        .try_map(|name| named(&name).ok_or("there is no such column"))
}

/// What the table says of the spans of a ray.
pub(super) fn rows<'a>(
    scene: &'a Scene,
    number: u64,
    ray: &'a Ray,
    spans: &'a [Span],
) -> impl Iterator<Item = Row<'a>> {
    let row = move |(span_number, span)| Row { scene, ray, span, number, span_number };
    (0..).zip(spans).map(row)
}

/// The line of names.
pub(super) fn heading(out: &mut dyn Write, columns: &[Column]) -> anyhow::Result<()> {
    let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
    Ok(writeln!(out, "{}", names.join(","))?)
}

/// A line of values.
pub(super) fn csv(
    out: &mut dyn Write,
    columns: &[Column],
    row: &Row<'_>,
) -> anyhow::Result<()> {
    for (i, column) in columns.iter().enumerate() {
        let comma = if i == 0 { "" } else { "," };
        match (column.cell)(row) {
            Cell::Count(n) => write!(out, "{comma}{n}")?,
            // As many digits as read back the same number, and no row of zeros.
            Cell::Number(x) => write!(out, "{comma}{x:?}")?,
            Cell::Text(text) => write!(out, "{comma}{}", quoted(&text))?,
            Cell::Nothing => write!(out, "{comma}")?,
        }
    }
    Ok(writeln!(out)?)
}

/// A text as a value of a table: in quotes where it has to be (RFC 4180).
fn quoted(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\"")).into()
    } else {
        text.into()
    }
}

/// An object on a line of its own.
pub(super) fn json(
    out: &mut dyn Write,
    columns: &[Column],
    row: &Row<'_>,
) -> anyhow::Result<()> {
    output::json(out, RowJson { columns, row })
}

struct RowJson<'a> {
    columns: &'a [Column],
    row: &'a Row<'a>,
}

impl Serialize for RowJson<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.columns.len()))?;
        for column in self.columns {
            match (column.cell)(self.row) {
                Cell::Count(n) => map.serialize_entry(column.name, &n)?,
                Cell::Number(x) => map.serialize_entry(column.name, &x)?,
                Cell::Text(text) => map.serialize_entry(column.name, &text)?,
                Cell::Nothing => map.serialize_entry(column.name, &())?,
            }
        }
        map.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_told_apart_and_found() {
        for (i, column) in COLUMNS.iter().enumerate() {
            let others = &COLUMNS[i + 1..];
            assert!(others.iter().all(|other| other.name != column.name), "{column:?}");
        }
        assert_eq!(usual().len(), USUAL.len());
    }

    #[test]
    fn texts_are_quoted_where_they_must_be() {
        assert_eq!(quoted("#ff0000"), "#ff0000");
        assert_eq!(quoted("lid, \"upper\""), "\"lid, \"\"upper\"\"\"");
    }
}
