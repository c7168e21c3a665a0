//! `solidray measure` and `solidray merge`

mod json;
mod merge;
mod text;

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::bail;
use clap::Args;
use solidray::measure::{self, Run, Sampling};
use solidray::{Scene, Solid};

use super::input::Reading;
use super::interrupt::interrupted;
use super::meter::Meter;
use super::pieces::{By, pieces};
use super::sampling::{SamplingArgs, check_range};
use super::{Answer, Global, output};
use json::{PartJson, Report};
pub(super) use merge::Merge;

/// Measure volume, surface, centroid, inertia and mass, each with a 95 % interval
///
/// Lattices of rays along three axes are made larger until all intervals are as narrow as
/// asked: those of volume, surface and inertia as a fraction of the value, that of the
/// centroid as a fraction of the radius of gyration. Names and colours of the model are
/// parts, measured each by itself in its own bounds, or else the objects at its top are. Ctrl-C ends with the best answer so far.
#[derive(Args, Debug)]
pub(super) struct Measure {
    /// The model
    file: PathBuf,
    /// What is measured by itself, besides the whole
    #[arg(long, value_enum, default_value_t = By::Parts)]
    by: By,
    /// The mass of a cubic unit, of everything or of one part by its name or colour; may be
    /// given several times, as in --density 1e-3 --density screw=7.85e-3 --density '#ff0000=2e-3';
    /// with --by objects of one by its line and column, as in --density 7:1=2.7e-3
    #[arg(long, value_name = "[PART=]D", value_parser = density)]
    density: Vec<Density>,
    /// Measure with this many seeds, beginning with --seed, and combine them; the same numbers as
    /// from `merge` of runs with one of them each
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1_000_000), help_heading = "Sampling")]
    seeds: u64,
    #[command(flatten)]
    sampling: SamplingArgs,
    #[command(flatten)]
    reading: Reading,
}

/// A density, and of which part.
#[derive(Clone, Debug, PartialEq)]
struct Density {
    part: Option<String>,
    value: f64,
}

fn density(text: &str) -> Result<Density, String> {
    let (part, number) = match text.rsplit_once('=') {
        Some((part, number)) => (Some(part.to_owned()), number),
        None => (None, text),
    };
    match number.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(Density { part, value }),
        Ok(_) | Err(_) => {
            Err(format!("`{number}` is not a finite density of at least 0"))
        }
    }
}

impl Measure {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        let start = Instant::now();
        let solid = self.reading.read(&self.file, global)?.solid;
        let scene = self.reading.compile(&self.file, &solid)?;
        check_range(&scene.bounds(), 2.0, "moments of inertia")?;
        let parts = pieces(&solid, self.by);
        let densities = self.densities(&parts)?;
        let meter = Meter::interruptible(global, "measuring")?;
        let watch = |rays| meter.step(rays);
        let sampling = self.sampling.meant();
        let seeds = sampling.seed..sampling.seed.saturating_add(self.seeds);
        let runs = |scene: &Scene, sampling: &dyn Fn(u64) -> Sampling| {
            let mut runs: Vec<Run> = Vec::new();
            for seed in seeds.clone() {
                if !runs.is_empty() && interrupted() {
                    break;
                }
                runs.push(measure::run(scene, &sampling(seed), &watch));
            }
            runs
        };
        let whole = runs(&scene, &|seed| Sampling { seed, ..sampling });
        let mut pieces = Vec::new();
        if parts.len() > 1 {
            for (number, (_, solid)) in (1..).zip(&parts) {
                let scene = self.reading.compile(&self.file, solid)?;
                let each = |seed| Sampling { seed, ..sampling }.for_part(number);
                pieces.push(runs(&scene, &each));
            }
        }
        drop(meter);
        let density = |i: usize| densities.as_ref().map(|d| d[i]);
        let whole_density = if parts.len() > 1 { None } else { density(0) };
        let mut report = Report {
            file: self.file.display().to_string(),
            by: self.by,
            whole: PartJson::new(None, whole_density, &whole),
            parts: (0..pieces.len())
                .map(|i| PartJson::new(Some(&parts[i].0), density(i), &pieces[i]))
                .collect(),
            rel_tol: sampling.rel_tol,
            abs_tol: sampling.abs_tol,
            seconds: start.elapsed().as_secs_f64(),
            interrupted: interrupted(),
            mass: None,
        };
        report.sum_up()?;
        answer(&report, global, out)
    }

    /// The density of each part, if any was given.
    fn densities(&self, parts: &[(String, Solid)]) -> anyhow::Result<Option<Vec<f64>>> {
        let labels: Vec<&str> = parts.iter().map(|(name, _)| name.as_str()).collect();
        let (known, noun) = (|| labels.join(", "), self.by.noun());
        for Density { part, .. } in &self.density {
            if let Some(part) = part
                && !labels.contains(&part.as_str())
            {
                bail!("--density: there is no {noun} `{part}`; there are: {}", known());
            }
        }
        if self.density.is_empty() {
            return Ok(None);
        }
        let of = |label: &&str| {
            let named = self.density.iter().rfind(|d| d.part.as_deref() == Some(*label));
            let all = self.density.iter().rfind(|d| d.part.is_none());
            named.or(all).map(|density| density.value)
        };
        let found: Option<Vec<f64>> = labels.iter().map(of).collect();
        match found {
            Some(found) => Ok(Some(found)),
            None => bail!(
                "--density: some {noun} has none; give one for all others, as in --density 1e-3; there are: {}",
                known()
            ),
        }
    }
}

/// Prints what was found.
fn answer(
    report: &Report,
    global: Global,
    out: &mut dyn Write,
) -> anyhow::Result<Answer> {
    if global.json {
        output::json(out, report)?;
        return Ok(Answer::Yes);
    }
    text::print(report, global, out)?;
    if global.quiet {
        return Ok(Answer::Yes);
    }
    if report.interrupted {
        super::report::note("interrupted: these are the numbers found so far");
    } else if !report.target_met() {
        super::report::note(&format!(
            "the relative tolerance {:e} was not met everywhere: allow more with --max-rays or --time-limit",
            report.rel_tol
        ));
    }
    Ok(Answer::Yes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densities_may_name_a_part() {
        let all = Density { part: None, value: 0.5 };
        assert_eq!(density("0.5"), Ok(all));
        let one = Density { part: Some("a=b".to_owned()), value: 2.0 };
        assert_eq!(density("a=b=2"), Ok(one));
        assert!(
            density("a=-1").is_err() && density("x").is_err() && density("").is_err()
        );
    }
}
