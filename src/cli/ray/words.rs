//! A ray's spans in words, and as one JSON object.

use std::io::Write;

use serde::Serialize;
use solidray::{Crossing, Ray, Scene, Span};

use super::super::Global;
use super::super::output::point;

#[derive(Serialize)]
pub(super) struct RayJson {
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

fn chord(ray: &Ray, span: &Span) -> f64 {
    span.length() * ray.speed()
}

/// Added to zero: the sum of nothing would be −0.
fn total(ray: &Ray, spans: &[Span]) -> f64 {
    spans.iter().fold(0.0, |sum, span| sum + chord(ray, span))
}

pub(super) fn print(
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
    pub(super) fn new(scene: &Scene, ray: &Ray, spans: &[Span]) -> Self {
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
