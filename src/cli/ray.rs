//! `solidray ray`

use std::io::Write;
use std::path::PathBuf;

use anyhow::bail;
use clap::Args;
use glam::DVec3;
use serde::Serialize;
use solidray::{Crossing, Ray, Scene, Span};

use super::input::{Reading, lines_of_numbers};
use super::numbers::Numbers;
use super::output::{self, point};
use super::{Answer, Global};

/// List the stretches of rays inside the solid
///
/// The whole line counts, before its origin too; t is in multiples of the direction, which
/// may have any length. Without --origin and --dir, rays are read from standard input: six
/// numbers on a line, origin and direction.
#[derive(Args, Debug)]
pub(super) struct Rays {
    /// The model
    file: PathBuf,
    /// Where the ray starts
    #[arg(long, value_name = "X,Y,Z", requires = "dir")]
    origin: Option<Numbers<3>>,
    /// Where it goes
    #[arg(long, value_name = "X,Y,Z", requires = "origin")]
    dir: Option<Numbers<3>>,
    #[command(flatten)]
    reading: Reading,
}

#[derive(Serialize)]
struct RayJson {
    origin: [f64; 3],
    dir: [f64; 3],
    spans: Vec<SpanJson>,
    /// The total length inside, in model units.
    chord: f64,
}

#[derive(Serialize)]
struct SpanJson {
    t: [f64; 2],
    chord: f64,
    enter: CrossingJson,
    exit: CrossingJson,
}

#[derive(Serialize)]
struct CrossingJson {
    /// At most how far `t` is from that of the solid as it was said; none if that is
    /// not bounded.
    error: Option<f64>,
    point: [f64; 3],
    normal: [f64; 3],
    leaf: u32,
    face: u32,
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    column: Option<u32>,
}

impl Rays {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        if self.origin.is_none() && self.file.as_os_str() == "-" {
            bail!("standard input cannot be both the model and the list");
        }
        let scene = self.reading.load(&self.file, global)?.scene;
        let mut tracer = scene.tracer();
        let mut each = |ray: Ray| -> anyhow::Result<()> {
            if !ray.is_valid() {
                bail!("the direction is zero");
            }
            let spans = tracer.spans(&ray);
            if global.json {
                output::json(out, RayJson::new(&scene, &ray, spans))
            } else {
                print(out, &scene, &ray, spans, global)
            }
        };
        match (self.origin, self.dir) {
            (Some(origin), Some(dir)) => each(Ray::new(origin.into(), dir.into()))?,
            _ => lines_of_numbers(|[a, b, c, d, e, f]| {
                each(Ray::new(DVec3::new(a, b, c), DVec3::new(d, e, f)))
            })?,
        }
        Ok(Answer::Yes)
    }
}

fn chord(ray: &Ray, span: &Span) -> f64 {
    span.length() * ray.speed()
}

/// Added to zero: the sum of nothing would be −0.
fn total(ray: &Ray, spans: &[Span]) -> f64 {
    spans.iter().fold(0.0, |sum, span| sum + chord(ray, span))
}

fn print(
    out: &mut dyn Write,
    scene: &Scene,
    ray: &Ray,
    spans: &[Span],
    global: Global,
) -> anyhow::Result<()> {
    if !global.quiet {
        let Ray { origin, dir } = *ray;
        let total = total(ray, spans);
        let count = spans.len();
        let plural = if count == 1 { "" } else { "s" };
        writeln!(
            out,
            "ray from {} along {}: {count} span{plural}, {total} inside",
            point(origin),
            point(dir)
        )?;
    }
    for span in spans {
        writeln!(
            out,
            "  t {} to {}, chord {}",
            span.enter.t,
            span.exit.t,
            chord(ray, span)
        )?;
        for (word, crossing) in [("in ", &span.enter), ("out", &span.exit)] {
            writeln!(out, "    {word} {}", in_words(scene, ray, crossing))?;
            if global.verbose {
                let error = scene.error_at(ray, crossing);
                writeln!(out, "        t ± {error:.1e} at most, by rounding")?;
            }
        }
    }
    Ok(())
}

fn in_words(scene: &Scene, ray: &Ray, crossing: &Crossing) -> String {
    let leaf = scene.leaf(crossing.leaf);
    let at =
        leaf.place.map(|p| format!(" at {}:{}", p.line, p.column)).unwrap_or_default();
    format!(
        "at {} normal {} leaf {} ({}{at}) face {}",
        point(ray.at(crossing.t)),
        point(scene.normal_at(ray, crossing)),
        crossing.leaf,
        leaf.kind,
        crossing.face
    )
}

impl RayJson {
    fn new(scene: &Scene, ray: &Ray, spans: &[Span]) -> Self {
        let crossing = |c: &Crossing| {
            let leaf = scene.leaf(c.leaf);
            CrossingJson {
                error: Some(scene.error_at(ray, c)).filter(|error| error.is_finite()),
                point: ray.at(c.t).to_array(),
                normal: scene.normal_at(ray, c).to_array(),
                leaf: c.leaf,
                face: c.face,
                kind: leaf.kind,
                line: leaf.place.map(|place| place.line),
                column: leaf.place.map(|place| place.column),
            }
        };
        Self {
            origin: ray.origin.to_array(),
            dir: ray.dir.to_array(),
            chord: total(ray, spans),
            spans: spans
                .iter()
                .map(|span| SpanJson {
                    t: [span.enter.t, span.exit.t],
                    chord: chord(ray, span),
                    enter: crossing(&span.enter),
                    exit: crossing(&span.exit),
                })
                .collect(),
        }
    }
}
