//! A solid built in code and drawn: a cup, from a paraboloid, a shell and a handle.
//!
//! `cargo run --release --example picture` writes `cup.png`.

use std::error::Error;
use std::f64::consts::FRAC_PI_2;

use glam::{DVec3, dvec3};
use solidray::render::{Camera, Style, picture};
use solidray::{Color, Scene, Solid};

fn main() -> Result<(), Box<dyn Error>> {
    let bowl = Solid::paraboloid(30.0, 50.0);
    let tea = Solid::paraboloid(27.5, 46.0).translated(dvec3(0.0, 0.0, 4.5));
    let foot = Solid::hyperboloid_of_one_sheet(8.0, 18.0, 16.0);
    let handle = Solid::cylinder(15.0, 5.0) - Solid::cylinder(10.0, 5.0);
    let handle = handle
        .translated(dvec3(0.0, 0.0, -2.5))
        .rotated(DVec3::X, FRAC_PI_2)
        .translated(dvec3(30.0, 0.0, 26.0));
    let china = Color::rgb(0.86, 0.91, 0.96);
    let cup = (bowl + foot + (handle - Solid::paraboloid(30.0, 50.0))
        - tea.colored(china))
    .colored(china);

    let scene = Scene::compile(&cup)?;
    let camera = Camera::framing(&scene.bounds());
    let style = Style { samples: 16, ..Style::default() };
    picture(&scene, &camera, [800, 600], &style, &|_| {}).save("cup.png")?;
    Ok(())
}
