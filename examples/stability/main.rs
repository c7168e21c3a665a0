//! How exact rays are, from harmless to hopeless: error against extremity for each
//! primitive, beside what double precision allows and what the textbook formula gives.
//!
//! `cargo run --release --example stability [stability.png]` prints a table and draws it.
//! Every figure is the median, or the largest, of 200 rays against 200 bits.

mod cases;
mod chart;
#[expect(dead_code, reason = "maps are for other uses")]
#[path = "../../tests/oracle/real.rs"]
mod real;
mod reference;

use std::error::Error;
use std::path::PathBuf;

use image::{Rgb, RgbImage};
use solidray::{Ray, Scene};

use cases::{Axis, Case, Shape, shapes};
use chart::{Chart, SIZE, Stroke, sample};
use real::Real;
use reference::ends;

/// How many rays each figure comes from.
const RAYS: u32 = 200;

/// Curves begin here.
const LEAST: f64 = 1e-18;

/// What 200 rays at one step have in common.
#[derive(Clone, Copy, Debug)]
struct Figure {
    x: f64,
    median: f64,
    largest: f64,
    /// The median of the bounds that the kernel itself gives.
    bound: f64,
    /// How many rays found nothing.
    misses: u32,
}

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn main() -> Result<(), Box<dyn Error>> {
    let path = PathBuf::from(std::env::args().nth(1).unwrap_or("stability.png".into()));
    let shapes = shapes();
    let size = [3 * SIZE[0], 2 * SIZE[1]];
    let mut picture = RgbImage::from_pixel(size[0], size[1], Rgb([255, 255, 255]));
    let mut misses = 0;
    for (number, axis) in (0..).zip(Axis::ALL) {
        println!("{}: {}\n", axis.title(), axis.measure());
        println!(
            "{:>12} {:>10} {:>9} {:>9} {:>9} {:>9} misses",
            "", "at", "median", "largest", "bound", "floor"
        );
        let steps = axis.steps();
        let corner = [number % 3 * SIZE[0], number / 3 * SIZE[1]];
        let range = [[steps[0], steps[steps.len() - 1]], [LEAST, 1.0]];
        let mut chart =
            Chart::new(&mut picture, corner, range, [axis.title(), axis.measure()]);
        let floor: Vec<[f64; 2]> = steps.iter().map(|&x| [x, axis.floor(x)]).collect();
        chart.curve(&floor, FLOOR, Stroke::Dashed);
        for (shape, color) in shapes.iter().zip(COLORS) {
            if !axis.suits(shape) {
                continue;
            }
            let ours = |x| figure(axis, shape, x, kernel);
            let found: Vec<Figure> = steps.iter().map(|&x| ours(x)).collect();
            print(axis, shape.name, &found);
            misses += found.iter().map(|figure| figure.misses).sum::<u32>();
            let curve = |of: fn(&Figure) -> f64| -> Vec<[f64; 2]> {
                found.iter().map(|figure| [figure.x, of(figure).max(LEAST)]).collect()
            };
            chart.curve(&curve(|f| f.bound), color, Stroke::Dotted);
            chart.curve(&curve(|f| f.median), color, Stroke::Full);
            if shape.name == "ball" && axis != Axis::Scale {
                let found: Vec<Figure> =
                    steps.iter().map(|&x| figure(axis, shape, x, textbook)).collect();
                print(axis, "textbook", &found);
                let curve: Vec<[f64; 2]> =
                    found.iter().map(|f| [f.x, f.median.max(LEAST)]).collect();
                chart.curve(&curve, NAIVE, Stroke::Full);
            }
        }
        println!();
    }
    legend(&mut picture, &shapes);
    println!("{misses} rays of the kernel found nothing where there is something");
    picture.save(&path)?;
    println!("drawn in {}", path.display());
    if misses == 0 { Ok(()) } else { Err("rays were lost".into()) }
}

/// The entry and exit of a ray, and a bound on the error of either.
type Answer = Option<([f64; 2], f64)>;

/// What the kernel says.
fn kernel(shape: &Shape, case: &Case) -> Answer {
    let placed = shape.solid.clone().scaled(case.scale).translated(case.offset);
    let scene = Scene::compile(&placed).expect("the solid is right");
    let span = *scene.tracer().spans(&case.ray).first()?;
    let [enter, exit] = [span.enter, span.exit].map(|c| scene.error_at(&case.ray, &c));
    Some(([span.enter.t, span.exit.t], enter.max(exit)))
}

/// What the textbook says of a ball: `a t² + 2 b t + c = 0` with the stable root first. Its
/// `c = o² − r²` is rounded before anything else, and with it go the digits of r.
fn textbook(_ball: &Shape, case: &Case) -> Answer {
    let Ray { origin, dir } = case.ray;
    let o = origin - case.offset;
    let (a, b, c) = (dir.length_squared(), o.dot(dir), o.length_squared() - 1.0);
    let discriminant = b * b - a * c;
    if discriminant <= 0.0 {
        return None;
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let (t, s) = (q / a, c / q);
    Some(([t.min(s), t.max(s)], 0.0))
}

/// The errors of 200 rays at one step.
fn figure(axis: Axis, shape: &Shape, x: f64, ask: fn(&Shape, &Case) -> Answer) -> Figure {
    let (mut errors, mut bounds, mut misses) = (Vec::new(), Vec::new(), 0);
    for case in (0..RAYS).map(|i| axis.case(shape, x, i)) {
        let [enter, exit] = ends(&shape.surfaces, case.scale, case.offset, &case.ray);
        if enter >= exit {
            continue;
        }
        let Some((found, bound)) = ask(shape, &case) else {
            misses += 1;
            errors.push(1.0);
            continue;
        };
        let chord = (&exit - &enter).rounded();
        let off = |found: f64, right: &Real| (Real::exact(found) - right).rounded().abs();
        let (error, bound) = match axis {
            Axis::Grazing => {
                ((found[1] - found[0] - chord).abs() / chord, 2.0 * bound / chord)
            }
            Axis::Distance | Axis::Tilt | Axis::Scale | Axis::Offset => {
                let speed = case.ray.speed();
                (off(found[0], &enter) * speed, bound * speed)
            }
        };
        errors.push(error);
        bounds.push(bound);
    }
    let [median, largest] = middle_and_last(errors);
    Figure { x, median, largest, bound: middle_and_last(bounds)[0], misses }
}

fn middle_and_last(mut numbers: Vec<f64>) -> [f64; 2] {
    numbers.sort_by(f64::total_cmp);
    let at = |i: usize| numbers.get(i).copied().unwrap_or(0.0);
    [at(numbers.len() / 2), at(numbers.len().saturating_sub(1))]
}

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn print(axis: Axis, name: &str, found: &[Figure]) {
    for Figure { x, median, largest, bound, misses } in found {
        let floor = axis.floor(*x);
        println!(
            "{name:>12} {x:10.1e} {median:9.1e} {largest:9.1e} {bound:9.1e} {floor:9.1e} {misses:6}"
        );
    }
}

const FLOOR: Rgb<u8> = Rgb([120, 120, 128]);
const NAIVE: Rgb<u8> = Rgb([0, 0, 0]);
const COLORS: [Rgb<u8>; 6] = [
    Rgb([214, 39, 40]),
    Rgb([31, 119, 180]),
    Rgb([44, 160, 44]),
    Rgb([255, 127, 14]),
    Rgb([148, 103, 189]),
    Rgb([23, 170, 190]),
];

/// In the last sixth of the picture.
fn legend(picture: &mut RgbImage, shapes: &[Shape]) {
    let shapes =
        shapes.iter().zip(COLORS).map(|(s, color)| (color, Stroke::Full, s.name));
    let others = [
        (NAIVE, Stroke::Full, "ball by the textbook formula"),
        (FLOOR, Stroke::Full, "full: median of 200 rays against 200 bits"),
        (FLOOR, Stroke::Dotted, "dotted: the bound stated with each crossing"),
        (FLOOR, Stroke::Dashed, "dashed: what double precision allows"),
    ];
    for (i, (color, stroke, words)) in (0..).zip(shapes.chain(others)) {
        let place = [2 * SIZE[0] + 70, SIZE[1] + 40 + 24 * i];
        sample(picture, place, (color, stroke), words);
    }
}
