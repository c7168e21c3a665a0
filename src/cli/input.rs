//! Models and lines from files and standard input.

use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use solidray::read::{self, Curves, Format, Imports, Model, ReadOptions, Rules};
use solidray::{CompileError, CompileOptions, NearMisses, Scene, Solid};

use super::Global;
use super::numbers::Numbers;
use super::report;

/// How files are read.
#[derive(Args, Clone, Debug)]
pub(super) struct Reading {
    /// What curves of OpenSCAD models become
    #[arg(long, value_enum, default_value_t = CurvesArg::Auto, help_heading = "Reading")]
    curves: CurvesArg,
    /// Whose rules hold where versions of OpenSCAD make different facets of the same text
    #[arg(long, value_enum, default_value_t = RulesArg::V2021, value_name = "YEAR", help_heading = "Reading")]
    openscad_rules: RulesArg,
    /// The format, where the file's name does not tell it
    #[arg(long, value_enum, help_heading = "Reading")]
    format: Option<FormatArg>,
    /// The OpenSCAD program that converts .scad files [default: openscad on PATH]
    #[arg(long, value_name = "PROGRAM", help_heading = "Reading")]
    openscad: Option<PathBuf>,
    /// Stop that program after this many seconds for a file, or for a node that is left to it
    #[arg(long, value_name = "SECONDS", default_value = "300", value_parser = seconds, help_heading = "Reading")]
    openscad_limit: Duration,
    /// Set a variable of a .scad file, as OpenSCAD's own -D does; may be given several times
    #[arg(short = 'D', value_name = "NAME=VALUE", help_heading = "Reading")]
    define: Vec<String>,
    /// A file with sets of parameters, for .scad files
    #[arg(short = 'p', value_name = "FILE", requires = "set", help_heading = "Reading")]
    parameters: Option<PathBuf>,
    /// Which set of parameters
    #[arg(
        short = 'P',
        value_name = "SET",
        requires = "parameters",
        help_heading = "Reading"
    )]
    set: Option<String>,
    /// Give two-dimensional models this thickness
    #[arg(long, value_name = "THICKNESS", value_parser = super::sampling::positive, help_heading = "Reading")]
    plate: Option<f64>,
    /// Make one of surfaces no farther apart than this anywhere on a leaf, measured square
    /// to them; `check` says which length a model wants
    #[arg(long, value_name = "LENGTH", default_value_t = 0.0, value_parser = length, help_heading = "Reading")]
    weld: f64,
    /// The largest tree that is compiled: leaves, operators, maps and tags, with what
    /// occurs more than once counted as often
    #[arg(long, value_name = "N", default_value_t = CompileOptions::default().most_nodes, help_heading = "Reading")]
    max_nodes: u64,
    /// Let a .csg import files from outside of its folder
    #[arg(long, help_heading = "Reading")]
    allow_outside: bool,
    /// Read no more than this, of the file and all that it imports together
    #[arg(
        long,
        value_name = "BYTES",
        default_value_t = ReadOptions::default().max_bytes,
        help_heading = "Reading"
    )]
    max_bytes: u64,
    /// Make no more triangles than this of curves and polygons
    #[arg(
        long,
        value_name = "TRIANGLES",
        default_value_t = ReadOptions::default().max_facets,
        help_heading = "Reading"
    )]
    max_facets: u64,
    /// How far facets may be from curves that have no exact solid, as in twisted extrusions
    #[arg(
        long,
        value_name = "LENGTH",
        default_value_t = ReadOptions::default().facet_tolerance,
        value_parser = super::sampling::positive,
        help_heading = "Reading"
    )]
    facet_tolerance: f64,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum CurvesArg {
    /// true curves, but polygons where $fn is 3 to 8, as for hexagonal holes
    Auto,
    /// true curves everywhere
    Exact,
    /// OpenSCAD's own polygons everywhere, vertex for vertex
    Faceted,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum RulesArg {
    /// OpenSCAD 2021.01
    #[value(name = "2021")]
    V2021,
    /// OpenSCAD 2025.07: other starts of `rotate_extrude`, sections rounded up, split edges
    #[value(name = "2025")]
    V2025,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum FormatArg {
    Csg,
    Scad,
    Obj,
    Stl,
    Off,
    #[value(name = "3mf")]
    ThreeMf,
}

impl From<FormatArg> for Format {
    fn from(format: FormatArg) -> Self {
        match format {
            FormatArg::Csg => Self::Csg,
            FormatArg::Scad => Self::Scad,
            FormatArg::Obj => Self::Obj,
            FormatArg::Stl => Self::Stl,
            FormatArg::Off => Self::Off,
            FormatArg::ThreeMf => Self::ThreeMf,
        }
    }
}

/// A finite number that is not below zero.
fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        Ok(_) | Err(_) => Err(format!("`{text}` is not a finite length of at least 0")),
    }
}

/// A time above zero.
fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = super::sampling::positive(text)?;
    Duration::try_from_secs_f64(seconds).map_err(|error| format!("`{text}`: {error}"))
}

/// A compiled model, and how long that took.
pub(super) struct Loaded {
    pub(super) scene: Scene,
    pub(super) read_seconds: f64,
    pub(super) compile_seconds: f64,
}

impl Reading {
    /// Reads a model; its warnings go to standard error unless they are unwanted.
    pub(super) fn read(&self, file: &Path, global: Global) -> anyhow::Result<Model> {
        Ok(warned(file, self.read_silently(file)?, global))
    }

    /// The same with what `%` and `#` mark.
    pub(super) fn read_marked(
        &self,
        file: &Path,
        global: Global,
    ) -> anyhow::Result<Model> {
        let options = ReadOptions { marks: true, ..self.options() };
        Ok(warned(file, read(file, &options)?, global))
    }

    /// Reads a model and keeps its warnings to itself.
    pub(super) fn read_silently(&self, file: &Path) -> anyhow::Result<Model> {
        read(file, &self.options())
    }

    fn options(&self) -> ReadOptions {
        ReadOptions {
            curves: match self.curves {
                CurvesArg::Auto => Curves::Auto,
                CurvesArg::Exact => Curves::Exact,
                CurvesArg::Faceted => Curves::Faceted,
            },
            rules: match self.openscad_rules {
                RulesArg::V2021 => Rules::V2021,
                RulesArg::V2025 => Rules::V2025,
            },
            openscad: self.openscad.clone(),
            openscad_limit: self.openscad_limit,
            format: self.format.map(Format::from),
            imports: if self.allow_outside { Imports::Anywhere } else { Imports::Folder },
            max_bytes: self.max_bytes,
            max_facets: self.max_facets,
            facet_tolerance: self.facet_tolerance,
            plate: self.plate,
            marks: false,
            definitions: self.define.clone(),
            parameters: self.parameters.clone().zip(self.set.clone()),
        }
    }

    /// Reads and compiles a model.
    pub(super) fn load(&self, file: &Path, global: Global) -> anyhow::Result<Loaded> {
        Ok(self.load_and_keep(file, global)?.0)
    }

    /// The same, and the solid that was compiled, which takes memory.
    pub(super) fn load_and_keep(
        &self,
        file: &Path,
        global: Global,
    ) -> anyhow::Result<(Loaded, Solid)> {
        let start = Instant::now();
        let model = self.read(file, global)?;
        let read_seconds = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let scene = self.compile(file, &model.solid)?;
        let compile_seconds = start.elapsed().as_secs_f64();
        warn_if_empty(file, &scene, global);
        Ok((Loaded { scene, read_seconds, compile_seconds }, model.solid))
    }

    /// Compiles a model; an error begins with the file's name.
    pub(super) fn compile(
        &self,
        file: &Path,
        solid: &Solid,
    ) -> Result<Scene, CompileFault> {
        Scene::compile_with(solid, &self.compiling())
            .map_err(|error| CompileFault { file: file.display().to_string(), error })
    }

    /// What of a model nearly coincides; an error begins with the file's name.
    pub(super) fn near_misses(
        &self,
        file: &Path,
        solid: &Solid,
    ) -> Result<NearMisses, CompileFault> {
        Scene::near_misses(solid, &self.compiling())
            .map_err(|error| CompileFault { file: file.display().to_string(), error })
    }

    /// How far facets may be from curves.
    pub(super) fn facet_tolerance(&self) -> f64 {
        self.facet_tolerance
    }

    /// What was chosen for compiling.
    pub(super) fn compiling(&self) -> CompileOptions {
        CompileOptions { weld: self.weld, most_nodes: self.max_nodes }
    }
}

fn read(file: &Path, options: &ReadOptions) -> anyhow::Result<Model> {
    if file.as_os_str() != "-" {
        return Ok(read::file(file, options)?);
    }
    let Some(format) = options.format else {
        bail!("standard input needs --format csg, scad, obj, stl, off or 3mf");
    };
    let mut bytes = Vec::new();
    let mut some = io::stdin().lock().take(options.max_bytes.saturating_add(1));
    some.read_to_end(&mut bytes).context("standard input")?;
    Ok(read::bytes(&bytes, Path::new("standard input"), format, options)?)
}

/// A model whose warnings went to standard error, unless they are unwanted.
fn warned(file: &Path, model: Model, global: Global) -> Model {
    if !global.quiet {
        for warning in &model.warnings {
            report::warning(&file.to_string_lossy(), warning);
        }
    }
    model
}

/// Says that there is nothing in a scene.
pub(super) fn warn_if_empty(file: &Path, scene: &Scene, global: Global) {
    if scene.bounds().is_empty() && !global.quiet {
        report::note(&format!("warning: {}: the model is empty", file.display()));
    }
}

/// Why the solid of a file cannot be compiled, as `file:line:column: message` if it has a
/// place.
#[derive(Debug)]
pub(super) struct CompileFault {
    file: String,
    error: CompileError,
}

impl std::error::Error for CompileFault {}

impl std::fmt::Display for CompileFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let message = self.error.to_string();
        let gap =
            if message.starts_with(|c: char| c.is_ascii_digit()) { "" } else { " " };
        write!(f, "{}:{gap}{message}", self.file)
    }
}

/// Calls `each` with the numbers on every line of standard input that has any, and with none before it
/// waits for more, so that who asks one by one is answered; `#` begins a comment, and a first line
/// without any number is a heading.
pub(super) fn lines_of_numbers<const N: usize>(
    mut each: impl FnMut(Option<[f64; N]>) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    // As much as a pipe holds.
    let mut input = io::BufReader::with_capacity(1 << 16, io::stdin().lock());
    let mut line = String::new();
    let mut number = 0;
    let mut is_first = true;
    loop {
        if !input.buffer().contains(&b'\n') {
            each(None)?;
        }
        line.clear();
        number += 1;
        if input.read_line(&mut line).context("standard input")? == 0 {
            return Ok(());
        }
        let line = line.trim_start_matches('\u{feff}');
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        let was_first = std::mem::replace(&mut is_first, false);
        let has = |kind: fn(char) -> bool| line.chars().any(kind);
        if was_first && has(char::is_alphabetic) && !has(char::is_numeric) {
            continue;
        }
        let Numbers(numbers) =
            line.parse().with_context(|| format!("standard input, line {number}"))?;
        each(Some(numbers))?;
    }
}
