//! Whether intervals hold as often as they say, and how errors fall: for ten solids, how many of
//! the 95 % intervals of how many seeds hold the true volume, and the order in which the error of
//! each method falls with its cost.
//!
//! ```sh
//! cargo run --release --example honesty -- 300
//! ```

use std::error::Error;

use glam::{DVec3, dvec3};
use solidray::measure::{self, Estimate, Sampling};
use solidray::{Mesh, Scene, Solid, unwatched};

/// A solid and its volume.
struct Subject {
    name: &'static str,
    scene: Scene,
    truth: f64,
}

impl Subject {
    /// One whose volume is found to twelve digits from its equations, or by a formula.
    fn new(name: &'static str, solid: &Solid) -> Result<Self, Box<dyn Error>> {
        let scene = Scene::compile(solid)?;
        let sampling = Sampling { rel_tol: 1e-11, ..Sampling::default() };
        let truth = match measure::exact(solid) {
            Some(exact) => exact,
            None => measure::adaptive(&scene, &sampling)?,
        };
        if truth.half_width() > 1e-9 * truth.value {
            return Err(format!("{name}: the true volume is not known: {truth:?}").into());
        }
        Ok(Self { name, scene, truth: truth.value })
    }
}

fn cube(size: f64) -> Solid {
    Solid::cuboid(DVec3::splat(size))
}

fn turned(solid: Solid) -> Solid {
    solid.rotated(DVec3::Z, 0.5).rotated(DVec3::X, 0.3).rotated(DVec3::Y, 1.1)
}

fn rods(radius: f64) -> Solid {
    let rod = Solid::cylinder(radius, 4.0).translated(dvec3(0.0, 0.0, -2.0));
    let across = rod.clone().rotated(DVec3::X, std::f64::consts::FRAC_PI_2);
    let along = rod.clone().rotated(DVec3::Y, std::f64::consts::FRAC_PI_2);
    rod + across + along
}

/// A plate with nine round holes.
fn perforated(thickness: f64) -> Solid {
    let hole = Solid::cylinder(0.2, 4.0).translated(dvec3(0.0, 0.0, -2.0));
    let places =
        (0..9_i32).map(|i| dvec3(f64::from(i % 3 - 1), f64::from(i / 3 - 1), 0.0));
    places.fold(Solid::cuboid(dvec3(3.0, 3.0, thickness)), |plate, at| {
        plate - hole.clone().translated(0.8 * at)
    })
}

/// Seven balls, each cut from what the one before it has left.
fn deep() -> Solid {
    let ball = |i: i32| {
        let angle = f64::from(i) * 2.4;
        let at = dvec3(angle.cos(), angle.sin(), 0.3 * f64::from(i % 3 - 1));
        Solid::ball(0.4 + 0.05 * f64::from(i)).translated(0.6 * at)
    };
    (1..7).fold(
        Solid::ball(1.0),
        |all, i| {
            if i % 2 == 0 { all + ball(i) } else { all - ball(i) }
        },
    )
}

/// An octahedron with its corners moved, which is a mesh.
fn crystal() -> Result<Mesh, Box<dyn Error>> {
    let points = vec![
        dvec3(1.0, 0.1, 0.0),
        dvec3(-0.9, 0.0, 0.2),
        dvec3(0.0, 1.2, 0.1),
        dvec3(0.1, -1.0, 0.0),
        dvec3(0.0, 0.2, 0.8),
        dvec3(-0.1, 0.0, -1.1),
    ];
    let faces = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    Ok(Mesh::new(points, faces)?)
}

fn subjects() -> Result<Vec<Subject>, Box<dyn Error>> {
    let speck = Solid::ball(0.01).translated(dvec3(0.3, 0.2, -0.1));
    let room = cube(2.0) - cube(1.99) + speck;
    Ok(vec![
        Subject::new("ball", &Solid::ball(1.0))?,
        Subject::new("box along the axes", &cube(1.0))?,
        Subject::new("turned box", &turned(cube(1.0)))?,
        Subject::new("shell of 0.25 %", &(Solid::ball(1.0) - Solid::ball(0.9975)))?,
        Subject::new("classic", &((cube(2.0) & Solid::ball(1.35)) - rods(0.7)))?,
        Subject::new("nested balls", &deep())?,
        Subject::new("mesh", &Solid::mesh(crystal()?))?,
        Subject::new("speck in a thin room", &room)?,
        Subject::new("perforated plate", &perforated(0.1))?,
        Subject::new("thin turned plate", &turned(Solid::cuboid(dvec3(3.0, 3.0, 0.1))))?,
    ])
}

/// Part of the intervals that hold the truth, of those that were resolved, and how many these are.
fn coverage(subject: &Subject, seeds: u64, rel_tol: f64) -> (f64, u64) {
    let (mut holds, mut resolved) = (0, 0);
    for seed in 0..seeds {
        let sampling = Sampling { rel_tol, seed, ..Sampling::default() };
        let found = measure::volume(&subject.scene, &sampling);
        let [low, high] = found.interval;
        let room = 1e-13 * subject.truth;
        resolved += u64::from(found.resolved);
        holds += u64::from((low - room..=high + room).contains(&subject.truth));
    }
    (holds as f64 / seeds as f64, resolved)
}

/// The slope of the logarithm of the error over that of the cost, by least squares, where errors
/// are those of many seeds and not yet rounding.
fn order(
    subject: &Subject,
    seeds: u64,
    volume: impl Fn(&Sampling) -> Estimate,
) -> Option<f64> {
    let mut points = Vec::new();
    for power in 12..19 {
        let (mut squares, mut cost) = (0.0, 0.0);
        for seed in 0..seeds {
            let max_rays = 1 << power;
            let sampling =
                Sampling { rel_tol: 0.0, max_rays, seed, ..Sampling::default() };
            let found = volume(&sampling);
            let error = found.value / subject.truth - 1.0;
            squares += error * error / seeds as f64;
            cost += found.rays as f64 / seeds as f64;
        }
        let error = squares.sqrt();
        if error > 1e-11 {
            points.push((cost.ln(), error.ln()));
        }
    }
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let both: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let squares: f64 = points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
    (points.len() >= 3 && squares > 0.0).then(|| both / squares)
}

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn main() -> Result<(), Box<dyn Error>> {
    let seeds = match std::env::args().nth(1) {
        Some(text) => text.parse()?,
        None => 8,
    };
    println!("| solid | intervals that hold, 1e-3 | 1e-4 | lattice | points | bracket |");
    println!("|---|---|---|---|---|---|");
    for subject in subjects()? {
        let held = [1e-3, 1e-4].map(|rel_tol| {
            let (held, resolved) = coverage(&subject, seeds, rel_tol);
            let all = if resolved == seeds {
                String::new()
            } else {
                format!(" ({resolved} resolved)")
            };
            format!("{:.1} %{all}", 100.0 * held)
        });
        let few = seeds.min(24);
        let shown =
            |order: Option<f64>| order.map_or("–".to_owned(), |o| format!("{o:.2}"));
        let lattice = order(&subject, few, |s| measure::volume(&subject.scene, s));
        let points =
            order(&subject, few, |s| measure::points(&subject.scene, s, &unwatched));
        let bracket = order(&subject, 1, |s| {
            // Its error is what it says.
            let found = measure::bracket(&subject.scene, s, &unwatched);
            Estimate { value: subject.truth + found.half_width(), ..found }
        });
        println!(
            "| {} | {} | {} | {} | {} | {} |",
            subject.name,
            held[0],
            held[1],
            shown(lattice),
            shown(points),
            shown(bracket)
        );
    }
    Ok(())
}
