//! Is this mesh that solid? A tube beside prisms of more and more sides, and beside one that
//! lost its hole; what they differ by is known.
//!
//! `cargo run --release --example compare`

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::process::ExitCode;

use glam::dvec3;
use solidray::facets::{boundary, faceted};
use solidray::measure::{Sampling, Verdict, compare};
use solidray::{Solid, unwatched};

const OUTER: f64 = 10.0;
const INNER: f64 = 6.0;
const HEIGHT: f64 = 20.0;

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn main() -> Result<ExitCode, Box<dyn Error>> {
    let hole = Solid::cylinder(INNER, HEIGHT + 2.0).translated(dvec3(0.0, 0.0, -1.0));
    let tube = Solid::cylinder(OUTER, HEIGHT) - hole;
    let tolerance = 1e-2;
    let sampling = Sampling::default();

    let mut holds = true;
    for sides in [16, 32, 64, 128] {
        // What a mesh file would hold, as `solidray::read::file` gives it.
        let mesh = boundary(&faceted(&tube, sides, 1 << 20)?, &unwatched)?;
        let prism = mesh.map_or_else(Solid::empty, Solid::mesh);
        let found = compare(&tube, &prism, tolerance, &sampling, &unwatched)?;

        // A polygon within a circle lacks that much of its area.
        let n = f64::from(sides);
        let lacks = PI - 0.5 * n * (TAU / n).sin();
        let exact = HEIGHT * lacks * (OUTER * OUTER + INNER * INNER);
        let [low, high] = found.difference.interval;
        let near = 3.0 * (high - low);
        holds &= (found.difference.value - exact).abs() <= near;
        println!(
            "{sides:3} sides: {:?}, {:.3} ± {:.3} in one only, exactly {exact:.3}",
            found.verdict,
            found.difference.value,
            found.difference.half_width(),
        );
        let same = lacks * (OUTER * OUTER + INNER * INNER)
            <= tolerance * PI * (OUTER * OUTER - INNER * INNER);
        holds &= (found.verdict == Verdict::Same) == same;
    }

    let found = compare(
        &tube,
        &Solid::cylinder(OUTER, HEIGHT),
        tolerance,
        &sampling,
        &unwatched,
    )?;
    if let Some(worst) = &found.worst {
        println!(
            "no hole:   {:?}, and worst from {:.2} to {:.2}",
            found.verdict, worst.from, worst.to
        );
    }
    holds &= found.verdict == Verdict::Different;
    Ok(if holds { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
