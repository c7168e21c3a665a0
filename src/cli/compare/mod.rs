//! `solidray compare`
//!
//! ```text
//! Comparison ─► text, JSON
//!      └──────► pictures, commands ─► page
//! ```

mod camera;
mod commands;
mod figures;
mod measures;
mod page;
mod pictures;
mod shell;
mod words;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::bail;
use clap::Args;
use serde::Serialize;
use solidray::measure::{self, Comparison, Verdict, Worst};
use solidray::{Aabb, Solid};

use super::input::Reading;
use super::interrupt;
use super::meter::Meter;
use super::output::{self, EstimateJson, in_words, point};
use super::render::CameraArgs;
use super::report::note;
use super::sampling::{SamplingArgs, check_range, positive};
use super::typed::Typed;
use super::{Answer, Global};
use camera::near;
use page::Page;
use pictures::{Pictures, Task};

/// Measure how much two solids differ, and where most
///
/// The exit code is 0 if the volume of what only one of them has is at most --tol times the
/// larger volume, 1 if it is more, and 2 if the rays allowed did not decide it.
#[derive(Args, Debug)]
pub(super) struct Compare {
    /// One model
    a: PathBuf,
    /// The other
    b: PathBuf,
    /// How much may differ, as a fraction of the larger volume
    #[arg(long, value_name = "T", default_value = "1e-3", value_parser = positive)]
    tol: f64,
    /// Write a page for eyes to this .html: pictures of both, a map of the difference, the measures, and
    /// the commands that show them again. The options of the view are those of its pictures
    #[arg(long, value_name = "OUT")]
    report: Option<PathBuf>,
    #[command(flatten)]
    camera: Typed<CameraArgs>,
    #[command(flatten)]
    sampling: Typed<SamplingArgs>,
    #[command(flatten)]
    reading: Typed<Reading>,
}

#[derive(Serialize)]
struct Report {
    a: EstimateJson,
    b: EstimateJson,
    a_minus_b: EstimateJson,
    b_minus_a: EstimateJson,
    difference: EstimateJson,
    iou: EstimateJson,
    worst: Option<WorstJson>,
    verdict: &'static str,
    tol: f64,
    rays: u64,
    seconds: f64,
}

#[derive(Serialize)]
struct WorstJson {
    length: f64,
    from: [f64; 3],
    to: [f64; 3],
    only_in: &'static str,
}

impl Compare {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        if self.a.as_os_str() == "-" && self.b.as_os_str() == "-" {
            bail!("only one of the two models can be standard input");
        }
        let why = "reports are written as .html";
        output::check_name(self.report.as_deref(), "html", why)?;
        if self.report.is_none() && !self.camera.words.is_empty() {
            bail!("only a --report has pictures that a camera could take");
        }
        let reading = &self.reading.meant;
        let a = reading.read(&self.a, global)?.solid;
        let b = reading.read(&self.b, global)?.solid;
        let bounds = [
            reading.compile(&self.a, &a)?.bounds(),
            reading.compile(&self.b, &b)?.bounds(),
        ];
        for bounds in &bounds {
            check_range(bounds, 0.0, "volumes")?;
        }
        let start = Instant::now();
        let meter = Meter::interruptible(global, "comparing")?;
        let sampling = self.sampling.meant.meant();
        let watch = |rays| meter.step(rays);
        let found = measure::compare_with(
            &a,
            &b,
            self.tol,
            &sampling,
            &reading.compiling(),
            &watch,
        )?;
        drop(meter);
        let seconds = start.elapsed().as_secs_f64();
        if global.json {
            output::json(out, self.report(&found, seconds))?;
        } else {
            self.print(out, &found, seconds, global)?;
        }
        if let Some(path) = &self.report {
            // Who asked for numbers has them, whatever becomes of the page.
            out.flush()?;
            interrupt::forget();
            self.write(path, [&a, &b], bounds, &found, seconds, global)?;
            if !global.quiet {
                note(&format!("{} is written", path.display()));
            }
        }
        match found.verdict {
            Verdict::Same => Ok(Answer::Yes),
            Verdict::Different => Ok(Answer::No),
            Verdict::Undecided => {
                out.flush()?;
                bail!(
                    "undecided with {} rays: allow more with --max-rays or --time-limit",
                    found.a.rays
                )
            }
        }
    }

    /// Writes the report.
    fn write(
        &self,
        path: &Path,
        solids: [&Solid; 2],
        bounds: [Aabb; 2],
        found: &Comparison,
        seconds: f64,
        global: Global,
    ) -> anyhow::Result<()> {
        let pictures = self.pictures(solids, bounds, found, global)?;
        let camera = pictures.as_ref().map(|pictures| &pictures.camera);
        let commands = self.commands(path, found.worst.as_ref(), camera);
        let page = Page {
            files: [&self.a, &self.b],
            bounds,
            found,
            tolerance: self.tol,
            sampling: &self.sampling.meant.meant(),
            seconds,
            pictures: pictures.as_ref(),
            commands: &commands,
        };
        output::save(path, page.html().as_bytes())
    }

    /// The pictures of a report, if there is anything to see and it has an end.
    fn pictures(
        &self,
        solids: [&Solid; 2],
        bounds: [Aabb; 2],
        found: &Comparison,
        global: Global,
    ) -> anyhow::Result<Option<Pictures>> {
        let [a, b] = bounds;
        let bounds = a.hull(b);
        if !bounds.is_bounded() {
            return Ok(None);
        }
        let meter = Meter::new(global, "drawing", Some(Task::rays()));
        let task = Task {
            solids,
            options: self.reading.meant.compiling(),
            bounds,
            camera: match &self.camera.meant {
                camera if camera.is_placed() => camera.camera(&bounds),
                camera => near(&bounds, camera.projection),
            },
            worst: found.worst.as_ref(),
            tolerance: self.tol,
        };
        task.pictures(&meter).map(Some)
    }

    fn print(
        &self,
        out: &mut dyn Write,
        found: &Comparison,
        seconds: f64,
        global: Global,
    ) -> anyhow::Result<()> {
        let same = match found.verdict {
            Verdict::Same => "the same",
            Verdict::Different => "different",
            Verdict::Undecided => "perhaps the same",
        };
        writeln!(out, "{same} within {} of the larger volume", self.tol)?;
        writeln!(out, "A      {}", in_words(&found.a))?;
        writeln!(out, "B      {}", in_words(&found.b))?;
        writeln!(out, "A − B  {}", in_words(&found.a_minus_b))?;
        writeln!(out, "B − A  {}", in_words(&found.b_minus_a))?;
        writeln!(out, "intersection over union  {}", in_words(&found.iou))?;
        if let Some(worst) = &found.worst {
            writeln!(
                out,
                "longest disagreement  {:.6} from {} to {}, only in {}",
                worst.length,
                point(worst.from),
                point(worst.to),
                only_in(worst)
            )?;
        }
        if global.verbose {
            writeln!(out, "rays     {}", found.a.rays)?;
            writeln!(out, "seconds  {seconds:.3}")?;
        }
        Ok(())
    }

    fn report(&self, found: &Comparison, seconds: f64) -> Report {
        Report {
            a: EstimateJson::from(&found.a),
            b: EstimateJson::from(&found.b),
            a_minus_b: EstimateJson::from(&found.a_minus_b),
            b_minus_a: EstimateJson::from(&found.b_minus_a),
            difference: EstimateJson::from(&found.difference),
            iou: EstimateJson::from(&found.iou),
            worst: found.worst.as_ref().map(|worst| WorstJson {
                length: worst.length,
                from: worst.from.to_array(),
                to: worst.to.to_array(),
                only_in: only_in(worst),
            }),
            verdict: verdict_name(found.verdict),
            tol: self.tol,
            rays: found.a.rays,
            seconds,
        }
    }
}

/// A verdict in JSON.
fn verdict_name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Same => "same",
        Verdict::Different => "different",
        Verdict::Undecided => "undecided",
    }
}

fn only_in(worst: &Worst) -> &'static str {
    if worst.in_a { "A" } else { "B" }
}
