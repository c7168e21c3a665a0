//! `solidray check`

use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use solidray::read::{Model, ReadError, ReadErrorKind};
use solidray::{Scene, Solid};

use super::input::{CompileFault, Reading};
use super::output::{self, BoundsJson, bounds_json, point};
use super::report::located;
use super::{Answer, Global};

/// Say what is in a model, and what is wrong with it
///
/// The exit code is 1 if the model cannot be used; the messages say why and where.
#[derive(Args, Debug)]
pub(super) struct Check {
    /// The model
    file: PathBuf,
    #[command(flatten)]
    reading: Reading,
}

/// Why a model cannot be used.
#[derive(Serialize)]
struct Faults {
    ok: bool,
    errors: [String; 1],
}

/// What is in a model that can.
#[derive(Serialize)]
struct Report {
    ok: bool,
    leaves: u64,
    leaves_by_kind: BTreeMap<&'static str, u64>,
    faces: u64,
    unions: u64,
    intersections: u64,
    differences: u64,
    maps: u64,
    depth: u64,
    true_curves: usize,
    polygons: usize,
    faceted: usize,
    turned: usize,
    bounds: Option<BoundsJson>,
    warnings: Vec<String>,
}

impl Check {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        let found = self.reading.read_silently(&self.file).and_then(|model| {
            let scene = self.reading.compile(&self.file, &model.solid)?;
            Ok((model, scene))
        });
        let (model, scene) = match found {
            Ok(found) => found,
            Err(error) if is_about_the_model(&error) => {
                let message = format!("{error:#}");
                if global.json {
                    output::json(out, Faults { ok: false, errors: [message] })?;
                } else {
                    writeln!(out, "{message}")?;
                }
                return Ok(Answer::No);
            }
            Err(error) => return Err(error),
        };
        let report = Report::new(&self.file.to_string_lossy(), &model, &scene);
        if global.json {
            output::json(out, report)?;
        } else {
            report.print(out, &scene, global)?;
        }
        Ok(Answer::Yes)
    }
}

/// Whether an error is the answer to the question rather than a failure to ask it.
fn is_about_the_model(error: &anyhow::Error) -> bool {
    match error.downcast_ref::<ReadError>() {
        None => error.is::<CompileFault>(),
        Some(error) => !matches!(
            error.kind,
            ReadErrorKind::Io(_)
                | ReadErrorKind::UnknownFormat
                | ReadErrorKind::OpenscadMissing { .. }
        ),
    }
}

impl Report {
    fn new(file: &str, model: &Model, scene: &Scene) -> Self {
        let census = Solid::census(&model.solid);
        let (mut kinds, mut faces) = (BTreeMap::new(), 0);
        for i in (0_u32..).take(scene.leaf_count()) {
            let leaf = scene.leaf(i);
            *kinds.entry(leaf.kind).or_insert(0) += 1;
            faces += u64::from(leaf.faces);
        }
        Self {
            ok: true,
            leaves: census.leaves,
            leaves_by_kind: kinds,
            faces,
            unions: census.unions,
            intersections: census.intersections,
            differences: census.differences,
            maps: census.maps,
            depth: census.depth,
            true_curves: model.counts.curves,
            polygons: model.counts.polygons,
            faceted: model.counts.faceted,
            turned: model.counts.turned,
            bounds: bounds_json(&scene.bounds()),
            warnings: model
                .warnings
                .iter()
                .map(|warning| located(file, warning))
                .collect(),
        }
    }

    fn print(
        &self,
        out: &mut dyn Write,
        scene: &Scene,
        global: Global,
    ) -> anyhow::Result<()> {
        let kinds: Vec<String> =
            self.leaves_by_kind.iter().map(|(kind, n)| format!("{n} {kind}")).collect();
        writeln!(out, "leaves     {} ({})", self.leaves, kinds.join(", "))?;
        writeln!(out, "faces      {}", self.faces)?;
        let operators = [
            (self.unions, "union"),
            (self.intersections, "intersection"),
            (self.differences, "difference"),
        ];
        let operators = operators.map(|(n, name)| format!("{n} {name}"));
        writeln!(out, "operators  {}", operators.join(", "))?;
        writeln!(out, "maps       {}", self.maps)?;
        writeln!(out, "depth      {}", self.depth)?;
        writeln!(
            out,
            "curves     {} true, {} deliberate polygons, {} made polygons by --curves",
            self.true_curves, self.polygons, self.faceted
        )?;
        let bounds = scene.bounds();
        if bounds.is_empty() {
            writeln!(out, "bounds     none: the model is empty")?;
        } else {
            writeln!(out, "bounds     {} to {}", point(bounds.min), point(bounds.max))?;
            writeln!(out, "size       {}", point(bounds.size()))?;
        }
        if global.verbose {
            writeln!(out, "nodes      {} after flattening", scene.node_count())?;
        }
        if !global.quiet {
            writeln!(out, "warnings   {}", self.warnings.len())?;
            for warning in &self.warnings {
                writeln!(out, "  {warning}")?;
            }
        }
        Ok(())
    }
}
