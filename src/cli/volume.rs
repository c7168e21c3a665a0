//! `solidray volume`

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::Context;
use clap::{Args, ValueEnum};
use serde::Serialize;
use solidray::measure::{self, Method};

use super::input::Reading;
use super::meter::Meter;
use super::output::{self, EstimateJson, in_words, uncertain_in_words};
use super::sampling::{SamplingArgs, check_range};
use super::{Answer, Global};

/// Measure the volume, with a 95 % interval
///
/// Sixteen randomly shifted Fibonacci lattices of parallel rays are made larger, and more of
/// them at last, until the interval is as narrow as asked. A solid that too few rays meet is
/// "not resolved" and gets an upper bound; if no ray at all meets it, a sixteenth of
/// --max-rays is enough to say so. The exit code is 0 whether the tolerance was met or not:
/// --json says in `target_met`.
#[derive(Args, Debug)]
pub(super) struct Volume {
    /// The model
    file: PathBuf,
    /// How it is measured
    #[arg(long, value_enum, default_value_t = MethodArg::Lattice)]
    method: MethodArg,
    #[command(flatten)]
    sampling: SamplingArgs,
    #[command(flatten)]
    reading: Reading,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum MethodArg {
    /// By randomly shifted lattices of rays: for every solid
    Lattice,
    /// By rules of Gauss between breakpoints that are found from the equations, checked by lattices:
    /// for many digits of solids with few surfaces and no meshes. A result that the
    /// lattices contradict is not given: then it is theirs, and so it is beyond the limits
    Adaptive,
    /// Certain bounds, rounding included, from cells that are inside, outside or cut; --max-rays
    /// limits the cells
    Bracket,
    /// Random points, as a baseline; --max-rays limits the points
    Points,
    /// By formulas, without rays: for single primitives, star-shaped meshes, and unions of these
    /// that are apart
    Exact,
}

/// What a method takes many of.
fn samples(method: Method) -> &'static str {
    match method {
        Method::Points => "points",
        Method::Bracket => "cells",
        Method::Exact | Method::Lattice | Method::Adaptive | _ => "rays",
    }
}

#[derive(Serialize)]
struct Report {
    #[serde(flatten)]
    estimate: EstimateJson,
    seconds: f64,
    seed: u64,
    rel_tol: f64,
}

impl Volume {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        let (loaded, solid) = self.reading.load_and_keep(&self.file, global)?;
        check_range(&loaded.scene.bounds(), 0.0, "volumes")?;
        let sampling = self.sampling.meant();
        let start = Instant::now();
        let meter = Meter::interruptible(global, "measuring")?;
        let watch = |rays| meter.step(rays);
        let volume = match self.method {
            MethodArg::Lattice => measure::volume_with(&loaded.scene, &sampling, &watch),
            MethodArg::Adaptive => {
                measure::adaptive_with(&loaded.scene, &sampling, &watch)
                    .context("--method adaptive")?
            }
            MethodArg::Bracket => measure::bracket(&loaded.scene, &sampling, &watch),
            MethodArg::Points => measure::points(&loaded.scene, &sampling, &watch),
            MethodArg::Exact => measure::exact(&solid)
                .context("--method exact: there is no formula for this solid")?,
        };
        drop(meter);
        let seconds = start.elapsed().as_secs_f64();
        if global.json {
            let estimate = EstimateJson::from(&volume);
            let measure::Sampling { seed, rel_tol, .. } = sampling;
            output::json(out, Report { estimate, seconds, seed, rel_tol })?;
            return Ok(Answer::Yes);
        }
        writeln!(out, "{}", in_words(&volume))?;
        if !volume.target_met && !global.quiet {
            super::report::note(&format!(
                "the relative tolerance {:e} was not met with {} {}: allow more with --max-rays or --time-limit",
                sampling.rel_tol,
                volume.rays,
                samples(volume.method)
            ));
        }
        if global.verbose {
            writeln!(out, "method    {}", volume.method.name())?;
            writeln!(out, "{:9} {}", samples(volume.method), volume.rays)?;
            let measure::Estimate { spans, uncertain, .. } = volume;
            writeln!(out, "spans     {}", uncertain_in_words(spans, uncertain))?;
            writeln!(
                out,
                "seconds   {seconds:.3} (reading {:.3}, compiling {:.3})",
                loaded.read_seconds, loaded.compile_seconds
            )?;
            writeln!(out, "seed      {}", sampling.seed)?;
        }
        Ok(Answer::Yes)
    }
}
