//! `solidray tradeoff`
//!
//! ```text
//! volumes ─┐
//!          ├─► Series of Trials ─► table, csv, json, plot
//! pictures ┘        (fit)
//! ```

mod fit;
mod ladder;
mod pictures;
mod plot;
mod table;
mod volumes;

use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::bail;
use clap::Args;
use serde::Serialize;

use super::input::Reading;
use super::interrupt::interrupted;
use super::meter::Meter;
use super::sampling::positive;
use super::{Answer, Global, output};
use pictures::Pictures;
use volumes::Volumes;

/// Measure what accuracy costs, on your own model
///
/// Every method of `volume` is run with larger and larger budgets and compared with the best
/// volume there is: by formula, by `adaptive`, or by a far larger lattice. OpenSCAD's facets, 8 to
/// 512 segments a turn, are combined by Manifold, and their volume is compared in the same way.
/// Pictures are compared with finer ones, by how far their outlines are off. All times are those of one
/// thread.
#[derive(Args, Debug)]
pub(super) struct Tradeoff {
    /// The model
    file: PathBuf,
    /// The plot to write, a .png
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Write all that was measured, one line a budget, to this .csv
    #[arg(long, value_name = "OUT")]
    csv: Option<PathBuf>,
    /// Take about so many seconds in all; more shows more decades
    #[arg(long, value_name = "S", default_value = "60", value_parser = positive)]
    time_limit: f64,
    #[command(flatten)]
    reading: Reading,
}

/// What one budget brought.
#[derive(Clone, Debug, Serialize)]
struct Trial {
    /// The budget, as options would say it.
    setting: String,
    /// How many rays, points, cells or triangles it took.
    samples: u64,
    /// Seconds of one thread, those of the fastest run.
    seconds: f64,
    /// The root mean square of the errors of all runs.
    error: f64,
    /// The median half width of what the runs themselves said, if they said anything.
    half_width: Option<f64>,
    /// How many runs there were, each with other random numbers.
    runs: u32,
}

/// What one method brought.
#[derive(Clone, Debug, Serialize)]
struct Series {
    name: String,
    /// What its samples are.
    unit: &'static str,
    trials: Vec<Trial>,
    /// The exponent of the samples with which the error falls.
    order: Option<f64>,
}

#[derive(Serialize)]
struct Report {
    file: String,
    volumes: Volumes,
    pictures: Option<Pictures>,
    notes: Vec<String>,
    seconds: f64,
    interrupted: bool,
}

impl Tradeoff {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        output::check_name(self.output.as_deref(), "png", "plots are written as .png")?;
        output::check_name(self.csv.as_deref(), "csv", "tables are written as .csv")?;
        let start = Instant::now();
        let (loaded, solid) = self.reading.load_and_keep(&self.file, global)?;
        if loaded.scene.bounds().is_empty() {
            bail!(
                "{}: the model is empty, so there is nothing to measure",
                self.file.display()
            );
        }
        let seconds =
            Duration::try_from_secs_f64(self.time_limit).unwrap_or(Duration::MAX);
        let meter = Meter::interruptible(global, "measuring")?;
        let watch = |rays| meter.step(rays);
        let study = Study {
            scene: &loaded.scene,
            solid: &solid,
            options: self.reading.compiling(),
            seconds,
            watch: &watch,
        };
        let mut notes = Vec::new();
        let volumes = study.volumes(&mut notes)?;
        let facets = volumes.series.iter().find(|series| series.unit == "triangles");
        let pictures = study.pictures(facets, &mut notes)?;
        drop(meter);
        let report = Report {
            file: self.file.display().to_string(),
            volumes,
            pictures,
            notes,
            seconds: start.elapsed().as_secs_f64(),
            interrupted: interrupted(),
        };
        if let Some(path) = &self.csv {
            output::save(path, &table::csv(&report)?)?;
        }
        if let Some(path) = &self.output {
            output::save(path, &plot::png(&report)?)?;
        }
        if global.json {
            output::json(out, &report)?;
            return Ok(Answer::Yes);
        }
        table::print(&report, out)?;
        if !global.quiet {
            report.notes.iter().for_each(|text| super::report::note(text));
            if report.interrupted {
                super::report::note("interrupted: this is what was found so far");
            }
        }
        Ok(Answer::Yes)
    }
}

/// What is measured, and how long.
struct Study<'a> {
    scene: &'a solidray::Scene,
    solid: &'a solidray::Solid,
    options: solidray::CompileOptions,
    seconds: Duration,
    watch: solidray::Watch<'a>,
}

impl Study<'_> {
    /// A part of the time that there is in all.
    fn share(&self, part: f64) -> Duration {
        Duration::try_from_secs_f64(self.seconds.as_secs_f64() * part)
            .unwrap_or(Duration::MAX)
    }
}

/// Runs something on one thread, whose time is then what it costs.
#[cfg(feature = "parallel")]
fn on_one_thread<T: Send>(task: impl FnOnce() -> T + Send) -> anyhow::Result<T> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(1).build()?.install(task))
}

/// Runs something on the one thread that there is.
#[cfg(not(feature = "parallel"))]
fn on_one_thread<T>(task: impl FnOnce() -> T) -> anyhow::Result<T> {
    Ok(task())
}
