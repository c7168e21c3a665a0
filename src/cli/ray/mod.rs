//! `solidray ray`

mod batch;
mod columns;
mod grid;
mod words;

use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;

use anyhow::bail;
use clap::Args;
use glam::DVec3;
use solidray::{Ray, Scene, Span};

use self::batch::Batch;
use self::columns::Column;
use self::grid::Grid;
use super::input::{Reading, lines_of_numbers};
use super::meter::Meter;
use super::numbers::Numbers;
use super::output;
use super::{Answer, Global};

/// List the stretches of rays inside the solid
///
/// The whole line counts, before its origin too; t is in multiples of the direction, which
/// may have any length. Without --origin and --dir, or --grid, rays are read from standard
/// input: six numbers on a line, origin and direction.
#[derive(Args, Debug)]
pub(super) struct Rays {
    /// The model
    file: PathBuf,
    /// Where the ray starts
    #[arg(long, value_name = "X,Y,Z", requires = "dir")]
    origin: Option<Numbers<3>>,
    /// Where it goes
    #[arg(long, value_name = "X,Y,Z", requires = "origin")]
    dir: Option<Numbers<3>>,
    #[command(flatten)]
    grid: grid::GridArgs,
    /// Print a table: a line of names, then one line for each stretch
    #[arg(long, help_heading = "Table")]
    csv: bool,
    /// What the table has, separated by commas; with --json one object for each stretch, with
    /// these names [default: ray, both t, the length, both points and both leaves]
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        value_parser = columns::parser(),
        help_heading = "Table"
    )]
    columns: Vec<Column>,
    #[command(flatten)]
    reading: Reading,
}

/// What is printed of each ray.
enum Form<'a> {
    Text(Global),
    Json,
    /// A line of values for each span.
    Csv(&'a [Column]),
    /// An object for each span.
    JsonTable(&'a [Column]),
}

impl Rays {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        let from_input = self.origin.is_none() && !self.grid.is_wanted();
        if from_input && self.file.as_os_str() == "-" {
            bail!("standard input cannot be both the model and the list");
        }
        if self.csv && global.json {
            bail!("standard output cannot take both --csv and --json");
        }
        let columns =
            if self.columns.is_empty() { columns::usual() } else { self.columns.clone() };
        let form = match (global.json, self.csv || !self.columns.is_empty()) {
            (true, true) => Form::JsonTable(&columns),
            (true, false) => Form::Json,
            (false, true) => Form::Csv(&columns),
            (false, false) => Form::Text(global),
        };
        let scene = self.reading.load(&self.file, global)?.scene;
        let grid = self.grid.over(&scene.bounds())?;
        if let Form::Csv(columns) = form {
            columns::heading(out, columns)?;
        }
        // On one terminal the answers themselves show how far they are.
        let quiet = global.quiet || io::stdout().is_terminal();
        let count = grid.as_ref().map(Grid::count);
        let meter = Meter::new(Global { quiet, ..global }, "tracing", count);
        let write = |number: u64, ray: &Ray, spans: &[Span], out: &mut Vec<u8>| {
            form.write(out, &scene, number, ray, spans)
        };
        let mut batch = Batch::new(&scene, &write, &meter, out);
        let done = match (&grid, self.origin, self.dir) {
            (Some(grid), ..) => grid.rays().try_for_each(|ray| batch.push(ray)),
            (None, Some(origin), Some(dir)) => {
                batch.push(Ray::new(origin.into(), dir.into()))
            }
            (None, ..) => lines_of_numbers(|numbers| match numbers {
                Some([a, b, c, d, e, f]) => {
                    batch.push(Ray::new(DVec3::new(a, b, c), DVec3::new(d, e, f)))
                }
                None => batch.answer(),
            }),
        };
        // Rays before one that is none are answered.
        batch.flush()?;
        done?;
        Ok(Answer::Yes)
    }
}

impl Form<'_> {
    fn write(
        &self,
        out: &mut Vec<u8>,
        scene: &Scene,
        number: u64,
        ray: &Ray,
        spans: &[Span],
    ) -> anyhow::Result<()> {
        match *self {
            Form::Text(global) => words::print(out, scene, ray, spans, global),
            Form::Json => output::json(out, words::RayJson::new(scene, ray, spans)),
            Form::Csv(columns) => columns::rows(scene, number, ray, spans)
                .try_for_each(|row| columns::csv(out, columns, &row)),
            Form::JsonTable(columns) => columns::rows(scene, number, ray, spans)
                .try_for_each(|row| columns::json(out, columns, &row)),
        }
    }
}
