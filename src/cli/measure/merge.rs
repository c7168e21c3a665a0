//! `solidray merge`

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail, ensure};
use clap::Args;
use serde::Deserialize;

use super::super::output::SCHEMA;
use super::super::{Answer, Global};
use super::answer;
use super::json::Report;

/// Combine what `measure --json` found with other seeds, on other machines perhaps
///
/// The numbers are those of one run with all the seeds, bit by bit, in whichever order the
/// files are given. A large job on four cores, with GNU parallel:
///
///   parallel 'solidray measure part.csg -j 1 --seed {} --json > {}.json' ::: 0 1 2 3
///   solidray merge 0.json 1.json 2.json 3.json
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(in crate::cli) struct Merge {
    /// What `measure --json` printed, or - for standard input
    #[arg(required = true)]
    files: Vec<PathBuf>,
}

#[derive(Deserialize)]
struct Versioned {
    schema: u32,
    #[serde(flatten)]
    report: serde_json::Value,
}

impl Merge {
    pub(in crate::cli) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        let mut all: Option<Report> = None;
        for file in &self.files {
            let name = || file.display().to_string();
            let report = read(file).with_context(name)?;
            match &mut all {
                None => all = Some(report),
                Some(all) => add(all, report).with_context(name)?,
            }
        }
        let Some(mut all) = all else { bail!("there is nothing to merge") };
        all.sum_up()?;
        answer(&all, global, out)
    }
}

fn read(file: &Path) -> anyhow::Result<Report> {
    let text = if file.as_os_str() == "-" {
        std::io::read_to_string(std::io::stdin())?
    } else {
        std::fs::read_to_string(file)?
    };
    let Versioned { schema, report } =
        serde_json::from_str(&text).context("it is not what `measure --json` prints")?;
    ensure!(schema == SCHEMA, "its schema is {schema}, and this program reads {SCHEMA}");
    serde_json::from_value(report).context("it is not what `measure --json` prints")
}

/// Adds the runs of a report to those of another one of the same model.
fn add(all: &mut Report, more: Report) -> anyhow::Result<()> {
    let labels = |report: &Report| -> Vec<_> {
        report.parts.iter().map(|part| (part.name.clone(), part.density)).collect()
    };
    ensure!(
        all.by == more.by
            && labels(all) == labels(&more)
            && all.whole.density == more.whole.density,
        "it has other parts or densities than the files before it"
    );
    #[expect(clippy::float_cmp, reason = "what was typed is the same or is not")]
    let is_like = all.rel_tol == more.rel_tol && all.abs_tol == more.abs_tol;
    ensure!(is_like, "it was measured with another tolerance than the files before it");
    all.whole.runs.extend(more.whole.runs);
    for (part, more) in all.parts.iter_mut().zip(more.parts) {
        part.runs.extend(more.runs);
    }
    all.seconds += more.seconds;
    all.interrupted |= more.interrupted;
    Ok(())
}
