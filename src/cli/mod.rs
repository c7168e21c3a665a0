//! The command line: what was typed, what it means, and the one place where answers become
//! exit codes.
//!
//! # To add a command
//!
//! Write its file with a struct of arguments and a `run`, and add it to [`Command`] and the
//! match in [`Command::run`].

mod check;
mod compare;
mod completions;
mod contains;
mod excerpt;
mod input;
mod interrupt;
mod measure;
mod mesh;
mod meter;
mod numbers;
mod output;
mod overlaps;
mod pieces;
mod ray;
mod render;
mod report;
mod sampling;
mod ticks;
mod tradeoff;
mod typed;
mod volume;
mod watch;

use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

/// Pictures, volumes and answers from OpenSCAD models and meshes, by rays, without facets.
#[derive(Parser, Debug)]
#[command(
    name = "solidray",
    version,
    arg_required_else_help = true,
    max_term_width = 100
)]
#[command(
    after_help = "FILE is an OpenSCAD .csg or .scad file (.scad needs OpenSCAD installed), or a closed mesh
as .obj, .stl, .off or .3mf; or - for standard input, with --format. Lengths are the model's
units, millimetres by OpenSCAD's custom.

Exit codes: 0 done, or the answer is yes; 1 the answer is no; 2 it could not be done.

Examples:
  solidray render part.scad -o part.png
  solidray volume part.csg --rel-tol 1e-5
  solidray contains part.csg 0,0,5 1,2,3
  solidray compare part.scad part.stl --tol 0.01
  solidray mesh part.scad -o part.stl --tolerance 0.01"
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    global: Global,
}

/// What every command understands.
#[derive(Args, Clone, Copy, Debug)]
struct Global {
    /// Print one JSON object on standard output instead of text
    #[arg(long, global = true, help_heading = "Everywhere")]
    json: bool,
    /// Print no warnings and no progress
    #[arg(
        short,
        long,
        global = true,
        conflicts_with = "verbose",
        help_heading = "Everywhere"
    )]
    quiet: bool,
    /// Print more about how the answer was found
    #[arg(short, long, global = true, help_heading = "Everywhere")]
    verbose: bool,
    /// How many threads to use [default: as many as there are cores]
    #[arg(
        short = 'j',
        long,
        global = true,
        value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..),
        help_heading = "Everywhere"
    )]
    threads: Option<u16>,
}

#[derive(Subcommand, Debug)]
enum Command {
    Check(check::Check),
    Render(render::Render),
    Ray(ray::Rays),
    Contains(contains::Contains),
    Volume(volume::Volume),
    Measure(measure::Measure),
    Merge(measure::Merge),
    Compare(compare::Compare),
    Overlaps(overlaps::Overlaps),
    Mesh(mesh::Mesh),
    Tradeoff(tradeoff::Tradeoff),
    Completions(completions::Completions),
    Man(completions::ManPage),
}

/// What a command that could be done answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    Yes,
    No,
}

impl Command {
    fn run(&self, global: Global, out: &mut dyn Write) -> anyhow::Result<Answer> {
        match self {
            Self::Check(command) => command.run(global, out),
            Self::Render(command) => command.run(global, out),
            Self::Ray(command) => command.run(global, out),
            Self::Contains(command) => command.run(global, out),
            Self::Volume(command) => command.run(global, out),
            Self::Measure(command) => command.run(global, out),
            Self::Merge(command) => command.run(global, out),
            Self::Compare(command) => command.run(global, out),
            Self::Overlaps(command) => command.run(global, out),
            Self::Mesh(command) => command.run(global, out),
            Self::Tradeoff(command) => command.run(global, out),
            Self::Completions(command) => command.run(out),
            Self::Man(command) => command.run(out),
        }
    }
}

/// Standard output, and whether anything was written to it.
struct Output<W: Write> {
    inner: io::BufWriter<W>,
    used: bool,
}

impl<W: Write> Write for Output<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.used = true;
        self.inner.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

/// The object that `--json` prints when something could not be done.
#[derive(serde::Serialize)]
struct ErrorReport {
    error: String,
}

/// Runs the program. Usage errors end in clap, with code 2.
pub(crate) fn main() -> ExitCode {
    let Cli { command, global } = Cli::parse_from(std::env::args_os().map(as_value));
    let mut out = Output { inner: io::BufWriter::new(io::stdout().lock()), used: false };
    let mut result = start_threads(global).and_then(|()| command.run(global, &mut out));
    if let (Err(error), true, false) = (&result, global.json, out.used) {
        // Whoever asked for an object gets one.
        let report = ErrorReport { error: format!("{error:#}") };
        result = output::json(&mut out, report).and(result);
    }
    let result = result.and_then(|answer| Ok(out.flush().map(|()| answer)?));
    match result {
        Ok(Answer::Yes) => ExitCode::SUCCESS,
        Ok(Answer::No) => ExitCode::from(1),
        // Whoever read the output has seen enough: `solidray ray … | head` is no failure.
        Err(error) if is_broken_pipe(&error) => {
            // What is left in the buffer has nowhere to go.
            drop(out.inner.into_parts());
            ExitCode::SUCCESS
        }
        Err(error) => {
            let _ = out.flush();
            report::error(&error);
            ExitCode::from(2)
        }
    }
}

/// An argument that is a list of numbers is no option though it begins with a minus: a
/// space in front tells clap, and does not matter to whoever reads the numbers.
fn as_value(argument: OsString) -> OsString {
    let is_list = argument.to_str().is_some_and(|text| {
        text.starts_with('-') && text != "-" && numbers::list(text).is_ok()
    });
    if !is_list {
        return argument;
    }
    let mut value = OsString::from(" ");
    value.push(argument);
    value
}

#[cfg(feature = "parallel")]
fn start_threads(global: Global) -> anyhow::Result<()> {
    let threads = global.threads.map_or(0, usize::from);
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?)
}

#[cfg(not(feature = "parallel"))]
fn start_threads(_global: Global) -> anyhow::Result<()> {
    Ok(())
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        let io = cause.downcast_ref::<io::Error>().map(io::Error::kind);
        let json =
            cause.downcast_ref::<serde_json::Error>().and_then(|e| e.io_error_kind());
        io.or(json) == Some(io::ErrorKind::BrokenPipe)
    })
}
