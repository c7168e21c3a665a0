//! `solidray compare`

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::bail;
use clap::Args;
use serde::Serialize;
use solidray::measure::{self, Comparison, Verdict, Worst};

use super::input::Reading;
use super::meter::Meter;
use super::output::{self, EstimateJson, in_words, point};
use super::sampling::{SamplingArgs, positive};
use super::{Answer, Global};

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
    #[command(flatten)]
    sampling: SamplingArgs,
    #[command(flatten)]
    reading: Reading,
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
        let a = self.reading.read(&self.a, global)?.solid;
        let b = self.reading.read(&self.b, global)?.solid;
        for (file, solid) in [(&self.a, &a), (&self.b, &b)] {
            self.reading.compile(file, solid)?;
        }
        let start = Instant::now();
        let meter = Meter::interruptible(global, "comparing")?;
        let sampling = self.sampling.meant();
        let watch = |rays| meter.step(rays);
        let found = measure::compare_with(
            &a,
            &b,
            self.tol,
            &sampling,
            &self.reading.compiling(),
            &watch,
        )?;
        drop(meter);
        let seconds = start.elapsed().as_secs_f64();
        if global.json {
            output::json(out, self.report(&found, seconds))?;
        } else {
            self.print(out, &found, seconds, global)?;
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
            verdict: match found.verdict {
                Verdict::Same => "same",
                Verdict::Different => "different",
                Verdict::Undecided => "undecided",
            },
            tol: self.tol,
            rays: found.a.rays,
            seconds,
        }
    }
}

fn only_in(worst: &Worst) -> &'static str {
    if worst.in_a { "A" } else { "B" }
}
