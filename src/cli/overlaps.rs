//! `solidray overlaps`

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use serde::Serialize;
use solidray::Solid;
use solidray::measure::{self, Overlap};

use super::input::Reading;
use super::interrupt::interrupted;
use super::meter::Meter;
use super::output::{self, EstimateJson, in_words, point};
use super::pieces::{By, pieces};
use super::sampling::{SamplingArgs, check_range};
use super::{Answer, Global};

/// Find pairs of parts that share volume: how much, how deep, and where
///
/// Parts are what shares a name or a colour; of a model with only one, the objects at its
/// top. What only touches is no overlap. The exit code is 0 if no parts overlap, 1 if some do.
/// The depth is the shortest of the three stretches along the axes, through the deepest place
/// that was found, that both share.
#[derive(Args, Debug)]
pub(super) struct Overlaps {
    /// The model
    file: PathBuf,
    /// What is looked at [default: parts if there are several, or else objects]
    #[arg(long, value_enum)]
    by: Option<By>,
    #[command(flatten)]
    sampling: SamplingArgs,
    #[command(flatten)]
    reading: Reading,
}

#[derive(Serialize)]
struct Report {
    overlaps: Vec<OverlapJson>,
    looked_at: usize,
    interrupted: bool,
    seconds: f64,
}

#[derive(Serialize)]
struct OverlapJson {
    a: String,
    b: String,
    volume: EstimateJson,
    depth: Option<f64>,
    at: Option<[f64; 3]>,
}

impl Overlaps {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        let start = Instant::now();
        let solid = self.reading.read(&self.file, global)?.solid;
        let bounds = self.reading.compile(&self.file, &solid)?.bounds();
        check_range(&bounds, 0.0, "volumes")?;
        let (names, solids) = self.pieces(&solid);
        let meter = Meter::interruptible(global, "comparing")?;
        let watch = |rays| meter.step(rays);
        let (options, sampling) = (self.reading.compiling(), self.sampling.meant());
        let found = measure::overlaps(&solids, &options, &sampling, &watch)?;
        drop(meter);
        if global.json {
            let overlaps = found.iter().map(|overlap| json(overlap, &names)).collect();
            let (looked_at, interrupted) = (solids.len(), interrupted());
            let seconds = start.elapsed().as_secs_f64();
            output::json(out, Report { overlaps, looked_at, interrupted, seconds })?;
        } else {
            print(&found, &names, out)?;
        }
        if interrupted() && !global.quiet {
            super::report::note("interrupted: not all pairs have been looked at");
        }
        let none = found.iter().all(|overlap| overlap.volume.value == 0.0);
        Ok(if none { Answer::Yes } else { Answer::No })
    }

    fn pieces(&self, solid: &Solid) -> (Vec<String>, Vec<Solid>) {
        let chosen = pieces(solid, self.by.unwrap_or(By::Parts));
        let several = self.by.is_some() || chosen.len() > 1;
        let chosen = if several { chosen } else { pieces(solid, By::Objects) };
        chosen.into_iter().unzip()
    }
}

fn json(overlap: &Overlap, names: &[String]) -> OverlapJson {
    let [a, b] = overlap.pair.map(|i| names[i].clone());
    OverlapJson {
        a,
        b,
        volume: (&overlap.volume).into(),
        depth: overlap.deepest.map(|deepest| deepest.depth),
        at: overlap.deepest.map(|deepest| deepest.at.to_array()),
    }
}

fn print(found: &[Overlap], names: &[String], out: &mut dyn Write) -> anyhow::Result<()> {
    if found.is_empty() {
        writeln!(out, "none of the {} overlaps another", names.len())?;
    }
    for overlap in found {
        let [a, b] = overlap.pair.map(|i| &names[i]);
        if overlap.volume.value == 0.0 {
            let most = overlap.volume.interval[1];
            writeln!(out, "{a} and {b}  nothing was found: at most {most:.3e} (95 %)")?;
            continue;
        }
        write!(out, "{a} and {b}  {}", in_words(&overlap.volume))?;
        match overlap.deepest {
            Some(deepest) => {
                writeln!(out, ", {:.6} deep at {}", deepest.depth, point(deepest.at))?;
            }
            None => writeln!(out)?,
        }
    }
    Ok(())
}
