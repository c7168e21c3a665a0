//! The volume of a napkin ring against its closed form: what is left of a ball when a hole
//! is drilled through its middle depends on the height of the hole's wall alone.
//!
//! `cargo run --release --example volume`

use std::f64::consts::PI;
use std::process::ExitCode;

use glam::dvec3;
use solidray::measure::{Sampling, volume};
use solidray::{CompileError, Scene, Solid};

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn main() -> Result<ExitCode, CompileError> {
    let (radius, height) = (5.0_f64, 6.0_f64);
    let hole = (radius * radius - 0.25 * height * height).sqrt();
    let drill =
        Solid::cylinder(hole, 4.0 * radius).translated(dvec3(0.0, 0.0, -2.0 * radius));
    let ring = Scene::compile(&(Solid::ball(radius) - drill))?;

    let exact = PI * height.powi(3) / 6.0;
    println!("exact      {exact:.9}");
    let mut honest = true;
    for rel_tol in [1e-2, 1e-3, 1e-4, 1e-5] {
        let found = volume(&ring, &Sampling { rel_tol, ..Sampling::default() });
        let error = found.value - exact;
        honest &= error.abs() <= 3.0 * found.half_width();
        println!(
            "{:9} rays: {:.9} ± {:.9}, off by {error:+.1e}",
            found.rays,
            found.value,
            found.half_width()
        );
    }
    Ok(if honest { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
