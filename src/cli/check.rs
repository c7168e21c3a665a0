//! `solidray check`

use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use serde::Serialize;
use solidray::measure::{self, Sampling};
use solidray::read::{Model, ReadError, ReadErrorKind};
use solidray::{Leaf, NearMisses, Scene, Solid, Weld};

use super::input::{CompileFault, Reading};
use super::output::{self, BoundsJson, bounds_json, point, uncertain_in_words};
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
    fine: usize,
    sliced: usize,
    made_by_openscad: usize,
    facet_tolerance: f64,
    turned: usize,
    bounds: Option<BoundsJson>,
    /// What a few thousand rays found, and how much of it is thinner than rounding.
    rays: u64,
    spans: u64,
    uncertain: u64,
    welds: Vec<PairJson>,
    near_misses: Vec<PairJson>,
    suggested_weld: Option<f64>,
    warnings: Vec<String>,
}

/// Two surfaces that are, or nearly are, one.
#[derive(Serialize)]
struct PairJson {
    distance: f64,
    surfaces: [SurfaceJson; 2],
}

#[derive(Serialize)]
struct SurfaceJson {
    leaf: u32,
    face: u32,
    kind: &'static str,
    line: Option<u32>,
    column: Option<u32>,
}

impl Check {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        let found = self.reading.read_silently(&self.file).and_then(|model| {
            let scene = self.reading.compile(&self.file, &model.solid)?;
            let near_misses = self.reading.near_misses(&self.file, &model.solid)?;
            Ok((model, scene, near_misses))
        });
        let (model, scene, near_misses) = match found {
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
        let file = self.file.to_string_lossy();
        let tolerance = self.reading.facet_tolerance();
        let mut report = Report::new(&file, &model, &scene, tolerance);
        report.near_misses = near_misses.pairs.iter().map(|w| pair(w, &scene)).collect();
        report.suggested_weld = near_misses.weld;
        report.warnings.extend(warning(&file, &near_misses, &scene));
        if global.json {
            output::json(out, report)?;
        } else {
            report.print(out, &scene, global)?;
        }
        Ok(Answer::Yes)
    }
}

/// How many pairs of surfaces are listed unless all are asked for.
const FEW: usize = 5;

fn pair(weld: &Weld, scene: &Scene) -> PairJson {
    let surface = |k: usize| {
        let [leaf, face] = [weld.leaves[k], weld.faces[k]];
        let Leaf { kind, place, .. } = scene.leaf(leaf);
        let line = place.map(|place| place.line);
        SurfaceJson { leaf, face, kind, line, column: place.map(|place| place.column) }
    };
    PairJson { distance: weld.distance, surfaces: [surface(0), surface(1)] }
}

/// Two surfaces in words, with their places in the file.
fn in_words(pair: &PairJson) -> String {
    let [a, b] = pair.surfaces.each_ref().map(|surface| {
        let SurfaceJson { leaf, face, kind, line, column } = surface;
        match (line, column) {
            (Some(line), Some(column)) => {
                format!("{line}:{column} ({kind}, face {face})")
            }
            _ => format!("leaf {leaf} ({kind}, face {face})"),
        }
    });
    format!("{a} and {b}, {:.2e} apart", pair.distance)
}

/// What to say of surfaces that nearly coincide.
fn warning(file: &str, near_misses: &NearMisses, scene: &Scene) -> Option<String> {
    let farthest = near_misses.pairs.first()?;
    let count = match near_misses.pairs.len() {
        1 => "a pair of surfaces nearly coincides".to_owned(),
        n => format!("{n} pairs of surfaces nearly coincide, the farthest"),
    };
    let advice = match near_misses.weld {
        Some(weld) => format!("--weld {weld} makes them one"),
        None => "no --weld makes all of them one".to_owned(),
    };
    Some(format!("{file}: {count}: {}; {advice}", in_words(&pair(farthest, scene))))
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
                | ReadErrorKind::OpenscadSlow { .. }
        ),
    }
}

/// One round of the smallest lattices.
const A_FEW_RAYS: Sampling = Sampling {
    rel_tol: 0.0,
    abs_tol: 0.0,
    max_rays: 0,
    time_limit: Some(Duration::from_secs(2)),
    seed: 0,
};

impl Report {
    fn new(file: &str, model: &Model, scene: &Scene, facet_tolerance: f64) -> Self {
        let census = Solid::census(&model.solid);
        let (mut kinds, mut faces) = (BTreeMap::new(), 0);
        for i in (0_u32..).take(scene.leaf_count()) {
            let leaf = scene.leaf(i);
            *kinds.entry(leaf.kind).or_insert(0) += 1;
            faces += u64::from(leaf.faces);
        }
        let sample = measure::volume(scene, &A_FEW_RAYS);
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
            fine: model.counts.fine,
            sliced: model.counts.sliced,
            made_by_openscad: model.counts.elsewhere,
            facet_tolerance,
            turned: model.counts.turned,
            bounds: bounds_json(&scene.bounds()),
            rays: sample.rays,
            spans: sample.spans,
            uncertain: sample.uncertain,
            welds: scene.welds().iter().map(|weld| pair(weld, scene)).collect(),
            near_misses: Vec::new(),
            suggested_weld: None,
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
        writeln!(out, "curves     {}", self.curves())?;
        if let Some(facets) = self.facets() {
            writeln!(out, "facets     {facets}")?;
        }
        let bounds = scene.bounds();
        if bounds.is_empty() {
            writeln!(out, "bounds     none: the model is empty")?;
        } else {
            writeln!(out, "bounds     {} to {}", point(bounds.min), point(bounds.max))?;
            writeln!(out, "size       {}", point(bounds.size()))?;
        }
        let uncertain = uncertain_in_words(self.spans, self.uncertain);
        writeln!(out, "spans      {uncertain} ({} rays)", self.rays)?;
        if let Some(farthest) = self.welds.first() {
            let (n, distance) = (self.welds.len(), farthest.distance);
            writeln!(out, "welds      {n}, of surfaces at most {distance:.2e} apart")?;
            print_pairs(out, &self.welds, global)?;
        }
        if global.verbose {
            writeln!(out, "nodes      {} after flattening", scene.node_count())?;
        }
        if !global.quiet {
            writeln!(out, "warnings   {}", self.warnings.len())?;
            for warning in &self.warnings {
                writeln!(out, "  {warning}")?;
            }
            if self.near_misses.len() > 1 {
                writeln!(out, "nearly one {}", self.near_misses.len())?;
                print_pairs(out, &self.near_misses, global)?;
            }
        }
        Ok(())
    }
}

impl Report {
    /// What became of curves, and by which rule.
    fn curves(&self) -> String {
        let mut words = vec![counted(self.true_curves, "true curve")];
        if self.polygons > 0 {
            words.push(format!(
                "{} ($fn up to 8; --curves exact makes them round)",
                counted(self.polygons, "deliberate polygon")
            ));
        }
        if self.faceted > 0 {
            let made = counted(self.faceted, "polygon");
            words.push(format!("{made} as OpenSCAD makes them (--curves faceted)"));
        }
        words.join(", ")
    }

    /// What has facets that are not the author's; nothing if there are none.
    fn facets(&self) -> Option<String> {
        let mut words = Vec::new();
        if self.fine > 0 {
            words.push(format!(
                "{} with curves that have no exact solid: within {} of them (--facet-tolerance)",
                counted(self.fine, "node"),
                self.facet_tolerance
            ));
        }
        if self.sliced > 0 {
            let made = counted(self.sliced, "extrusion");
            words.push(format!("{made} in slices as OpenSCAD makes them"));
        }
        if self.made_by_openscad > 0 {
            let made = counted(self.made_by_openscad, "node");
            words.push(format!("{made} made by the installed OpenSCAD"));
        }
        (!words.is_empty()).then(|| words.join(", "))
    }
}

/// So many of something.
fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// Prints the first few pairs, or all of them.
fn print_pairs(
    out: &mut dyn Write,
    pairs: &[PairJson],
    global: Global,
) -> anyhow::Result<()> {
    let shown = if global.verbose { pairs.len() } else { pairs.len().min(FEW) };
    for pair in &pairs[..shown] {
        writeln!(out, "  {}", in_words(pair))?;
    }
    if shown < pairs.len() {
        writeln!(out, "  and {} more, listed with -v", pairs.len() - shown)?;
    }
    Ok(())
}
