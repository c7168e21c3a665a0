//! Measures this crate and others on the same scenes, in turns, on one thread.
//!
//! `cargo run --release` here measures all and writes `../RESULTS.md`; `--help` says how to
//! measure less. fidget comes with the build. The others are taken if they are there:
//! POV-Ray (`povray`), Embree 3 (`libembree-dev` and a C compiler), and Manifold
//! (`pip install manifold3d`).

#[path = "../../scenes/queries.rs"]
mod queries;
#[path = "../../scenes/mod.rs"]
mod scenes;

mod clock;
mod embree;
mod facets;
mod goals;
mod part;
mod povray;
mod report;
mod topics;
mod voxels;

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::Result;
use clap::{Parser, ValueEnum};
use clock::median;
use rayon::{ThreadPool, ThreadPoolBuilder};
use report::Table;
use scenes::{FORMULAS, MESHES};
use tempfile::TempDir;

/// Measures solidray and its peers on the same scenes.
#[derive(Parser)]
struct Args {
    /// Only scenes whose names begin so.
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// Only these parts.
    #[arg(long, value_delimiter = ',')]
    parts: Vec<Topic>,
    /// How many times each is measured; medians are shown.
    #[arg(long, default_value_t = 5)]
    rounds: u32,
    /// Without fidget.
    #[arg(long)]
    no_fidget: bool,
    /// Without POV-Ray.
    #[arg(long)]
    no_povray: bool,
    /// Without Embree.
    #[arg(long)]
    no_embree: bool,
    /// Without Manifold.
    #[arg(long)]
    no_manifold: bool,
    /// The Python that has Manifold.
    #[arg(long, default_value = "python3")]
    python: PathBuf,
    /// The most seconds that POV-Ray and Manifold may take for one measurement.
    #[arg(long, default_value_t = 30.0)]
    patience: f64,
    /// Leave the file of results as it is.
    #[arg(long)]
    dry_run: bool,
}

/// A table of results.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Topic {
    /// Pictures of formulas.
    Primary,
    /// How cost grows with leaves, compiling, and two threads.
    Growth,
    /// Rays through meshes.
    Meshes,
    /// Whether points are inside.
    Membership,
    /// Volumes to one part in ten thousand.
    Volume,
}

/// What all parts of a run share.
struct Run {
    args: Args,
    folder: TempDir,
    one: ThreadPool,
}

/// One measurement, in seconds or whatever its table is in.
type Call<'a> = Box<dyn FnMut() -> Result<f64> + 'a>;

fn main() -> Result<()> {
    let args = Args::parse();
    let run = Run { args, folder: tempfile::tempdir()?, one: threads(1)? };
    let tables = [
        (Topic::Primary, topics::primary as fn(&Run) -> Result<Table>),
        (Topic::Growth, topics::growth),
        (Topic::Meshes, topics::meshes),
        (Topic::Membership, topics::membership),
        (Topic::Volume, topics::volume),
    ];
    let results = Path::new(env!("CARGO_MANIFEST_DIR")).join("../RESULTS.md");
    // Asked first: to write results changes the work tree.
    let when = when();
    for (topic, measure) in tables {
        if run.args.parts.is_empty() || run.args.parts.contains(&topic) {
            let table = measure(&run)?;
            if !run.args.dry_run {
                table.save(&results, &when)?;
            }
        }
    }
    if !run.args.dry_run {
        report::replace(&results, "setting", |_| setting(&run))?;
    }
    Ok(())
}

impl Run {
    fn asked(&self, name: &str) -> bool {
        let only = &self.args.only;
        only.is_empty() || only.iter().any(|start| name.starts_with(start.as_str()))
    }

    /// The formulas that were asked for.
    fn formulas(&self) -> impl Iterator<Item = &'static str> {
        FORMULAS.into_iter().filter(|name| self.asked(name))
    }

    /// The meshes that were asked for.
    fn meshes(&self) -> impl Iterator<Item = &'static str> {
        MESHES.into_iter().filter(|name| self.asked(name))
    }

    /// Medians of several calls in turns.
    fn in_turns<const N: usize>(
        &self,
        mut calls: [Option<Call<'_>>; N],
    ) -> Result<[Option<f64>; N]> {
        let mut times = [(); N].map(|()| Vec::new());
        for _ in 0..self.args.rounds.max(1) {
            for (times, call) in times.iter_mut().zip(&mut calls) {
                if let Some(call) = call {
                    times.push(call()?);
                }
            }
        }
        Ok(times.map(median))
    }
}

fn threads(count: usize) -> Result<ThreadPool> {
    Ok(ThreadPoolBuilder::new().num_threads(count).build()?)
}

/// What a program prints.
fn said(program: &str, args: &[&str]) -> String {
    let output = Command::new(program).args(args).output().ok();
    let text = output
        .filter(|output| output.status.success())
        .and_then(|output| String::from_utf8(output.stdout).ok());
    text.map_or_else(|| "unknown".to_owned(), |text| text.trim().to_owned())
}

/// When what was measured, and how.
fn when() -> String {
    let args: Vec<String> = std::env::args().skip(1).collect();
    format!(
        "Last run on {} at commit {} with `{}`.",
        said("date", &["+%F"]),
        said("git", &["describe", "--always", "--dirty"]),
        args.join(" "),
    )
}

/// On what, and with what.
fn setting(run: &Run) -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    let cores = std::thread::available_parallelism().map_or(0, |n| n.get());
    let lock = include_str!("../Cargo.lock");
    let fidget = lock
        .split("[[package]]")
        .find(|package| package.contains("name = \"fidget\"\n"))
        .and_then(|package| package.split("version = \"").nth(1)?.split('"').next());
    let peers = [
        Some(format!("fidget {}", fidget.unwrap_or("?"))),
        povray::version(),
        embree::version(),
        facets::version(&run.args.python),
    ];
    let peers: Vec<String> = peers.into_iter().flatten().collect();
    format!(
        "{} ({cores} cores), {}, {}.",
        cpu.unwrap_or_else(|| "An unknown processor".to_owned()),
        said("rustc", &["--version"]),
        peers.join(", "),
    )
}
