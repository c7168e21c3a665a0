//! What accuracy costs: the error of a volume against the number of rays, or of points. The root
//! mean square of sixteen seeds, for a drilled ball whose volume is known.
//!
//! `cargo run --release --example tradeoff`; the command `solidray tradeoff` does the same for any
//! model, and draws it.

use std::f64::consts::PI;
use std::process::ExitCode;

use glam::dvec3;
use solidray::measure::{Estimate, Sampling, points, volume};
use solidray::{CompileError, Scene, Solid, unwatched};

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn main() -> Result<ExitCode, CompileError> {
    // What is left of a ball of radius 5 when the wall of the hole through it is 6 high.
    let drill = Solid::cylinder(4.0, 12.0).translated(dvec3(0.0, 0.0, -6.0));
    let ring = Scene::compile(&(Solid::ball(5.0) - drill))?;
    let exact = 36.0 * PI;

    println!("   number    error by rays    by points");
    let mut errors = Vec::new();
    for budget in [12, 14, 16, 18, 20].map(|power| 1_u64 << power) {
        // A tolerance of nothing: each takes all that it may.
        let sampling = |seed| Sampling {
            rel_tol: 0.0,
            max_rays: budget,
            seed,
            ..Sampling::default()
        };
        let rms = |find: &dyn Fn(&Sampling) -> Estimate| {
            let error = |seed| find(&sampling(seed)).value / exact - 1.0;
            let squares: f64 = (0..16).map(|seed| error(seed).powi(2)).sum();
            (squares / 16.0).sqrt()
        };
        let by_rays = rms(&|sampling| volume(&ring, sampling));
        let by_points = rms(&|sampling| points(&ring, sampling, &unwatched));
        println!("{budget:9} {by_rays:16.1e} {by_points:12.1e}");
        errors.push([by_rays, by_points]);
    }
    // Errors of points fall like the root, those of rays faster.
    let [first, last] = [errors[0], errors[errors.len() - 1]];
    let [rays, points] = [0, 1].map(|i| (last[i] / first[i]).ln() / 256_f64.ln());
    println!("order     {rays:16.2} {points:12.2}");
    let holds = rays < -0.6 && (-0.65..-0.35).contains(&points);
    Ok(if holds { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
