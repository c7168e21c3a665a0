//! Which points are inside: a slice through a solid, printed as text.
//!
//! `cargo run --release --example membership`

use glam::dvec3;
use solidray::{CompileError, Scene, Solid};

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn main() -> Result<(), CompileError> {
    // A wheel: a rim, a hub and six spokes, with a hole for the axle.
    let rim = Solid::cylinder(10.0, 2.0) - Solid::cylinder(8.0, 2.0);
    let spoke = Solid::cuboid_between(dvec3(0.0, -0.6, 0.0), dvec3(9.0, 0.6, 2.0));
    let spokes = (0..6).map(|i| {
        spoke.clone().rotated(glam::DVec3::Z, f64::from(i) * std::f64::consts::FRAC_PI_3)
    });
    let hub = Solid::cylinder(3.0, 2.0);
    let axle = Solid::cylinder(1.2, 2.0);
    let wheel = spokes.fold(rim + hub, |wheel, spoke| wheel + spoke) - axle;

    let scene = Scene::compile(&wheel)?;
    for row in (-10..=10).rev() {
        let points: Vec<_> = (-20..=20)
            .map(|column| dvec3(0.5 * f64::from(column), f64::from(row), 1.0))
            .collect();
        let inside = scene.contains_all(&points).into_iter();
        let line: String = inside.map(|is| if is { '#' } else { '.' }).collect();
        println!("{line}");
    }
    Ok(())
}
