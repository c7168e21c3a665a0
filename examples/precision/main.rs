//! What single precision would cost and save: one small kernel in both, with the same rays,
//! against the library's answers and closed forms.
//!
//! ```sh
//! cargo run --release --example precision
//! ```

#[expect(dead_code, reason = "points and directions are enough")]
#[path = "../../tests/support/dice.rs"]
mod dice;
mod kernel;

use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Instant;

use glam::{DVec3, dvec3};
use solidray::{Scene, Solid};

use dice::Dice;
use kernel::{BALL, BORE, Ball, HALF, Many, Part, Ray, Real, Triangle, meets, triple};

/// Where the scene is, in its own sizes.
const OFFSETS: [f64; 3] = [0.0, 1e3, 1e6];

/// A place so far away that both precisions have it exactly.
fn place(offset: f64) -> DVec3 {
    offset * dvec3(1.0, -0.5, 0.25)
}

/// The two kernels' answers to one question.
struct Both<A> {
    single: A,
    double: A,
}

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("| error of a chord of a ball | f32 | f64 |\n|---|---|---|");
    for offset in OFFSETS {
        for rho in [1e1, 1e3, 1e6] {
            let Both { single, double } = chords(offset, rho)?;
            println!(
                "| ball at {offset:.0e}, seen from {rho:.0e} radii | {single} | {double} |"
            );
        }
    }
    println!("\n| error of the volume of a part | f32 | f32, summed in f64 | f64 |");
    println!("|---|---|---|---|");
    for offset in OFFSETS {
        for lattice @ [_, rays] in LATTICES {
            let [single, mixed, double] = volumes(offset, lattice);
            println!(
                "| at {offset:.0e}, {rays} rays | {single:.0e} | {mixed:.0e} | {double:.0e} |"
            );
        }
    }
    println!("\n| wrong of a million | f32 | f64 |\n|---|---|---|");
    for offset in OFFSETS {
        let Both { single, double } = wrong_points(offset);
        println!(
            "| points within 1e-4 of a ball at {offset:.0e} | {single} | {double} |"
        );
    }
    for offset in OFFSETS {
        let Both { single, double } = wrong_crossings(offset);
        let [one, two] =
            [single, double].map(|[lost, twice]| format!("{lost} + {twice}"));
        println!(
            "| crossings of a sheet at {offset:.0e}, lost + doubled | {one} | {two} |"
        );
    }
    println!("\n| time and room | f32 | f64 |\n|---|---|---|");
    for (name, Both { single, double }) in [
        ("ball", time_of_ball()),
        ("ball, rays side by side", time_of_many()),
        ("part", time_of_part()),
        ("triangle", time_of_triangle()),
    ] {
        println!("| {name}, ns a ray | {single:.2} | {double:.2} |");
    }
    let sizes = [size_of::<Ball<f32>>(), size_of::<Ball<f64>>()];
    println!("| ball, bytes | {} | {} |", sizes[0], sizes[1]);
    let sizes = [size_of::<Triangle<f32>>(), size_of::<Triangle<f64>>()];
    println!("| triangle, bytes | {} | {} |", sizes[0], sizes[1]);
    Ok(())
}

/// The median error of the chord of a ball in parts of it, and how many rays lost the ball.
struct Chords {
    median: f64,
    lost: usize,
    all: usize,
}

impl std::fmt::Display for Chords {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.0e}", self.median)?;
        if self.lost > 0 {
            write!(f, ", {} of {} lost", self.lost, self.all)?;
        }
        Ok(())
    }
}

/// Chords of a ball that is seen from afar, against the library.
fn chords(offset: f64, rho: f64) -> Result<Both<Chords>, solidray::CompileError> {
    let center = place(offset);
    let scene = Scene::compile(&Solid::ball(1.0).translated(center))?;
    let (mut tracer, mut dice) = (scene.tracer(), Dice::new(1));
    let rays: Vec<_> = (0..10_000)
        .map(|_| {
            let (from, aside) = (dice.direction(), dice.direction());
            let aim = aside.cross(from).normalize() * dice.within(0.0, 0.95);
            let origin = center + rho * from;
            let ray = solidray::Ray::new(origin, (center + aim - origin).normalize());
            let truth = tracer.spans(&ray).iter().map(solidray::Span::length).sum();
            (ray, truth)
        })
        .collect();
    Ok(Both {
        single: against::<f32>(center, &rays),
        double: against::<f64>(center, &rays),
    })
}

fn against<T: Real>(center: DVec3, rays: &[(solidray::Ray, f64)]) -> Chords {
    let ball = Ball { center: triple::<T>(center), radius: T::of(1.0) };
    let error = |(ray, truth): &(solidray::Ray, f64)| {
        let [from, to] = ball.stretch(&Ray::of(ray))?;
        Some(((to - from).wide() / truth - 1.0).abs())
    };
    let mut errors: Vec<f64> = rays.iter().filter_map(error).collect();
    errors.sort_by(f64::total_cmp);
    let median = errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN);
    Chords { median, lost: rays.len() - errors.len(), all: rays.len() }
}

/// Numbers of Fibonacci: the size of a lattice, after its generator.
const LATTICES: [[u32; 2]; 3] =
    [[6_765, 10_946], [196_418, 317_811], [2_178_309, 3_524_578]];

/// Relative errors of the volume of a part by a lattice of parallel rays: all in single
/// precision, chords in single and sums in double, all in double.
fn volumes(offset: f64, lattice: [u32; 2]) -> [f64; 3] {
    let [single, mixed] = sums::<f32>(offset, lattice);
    let [double, _] = sums::<f64>(offset, lattice);
    let cap = BALL - HALF;
    let ball = PI * (4.0 / 3.0 * BALL.powi(3) - 2.0 * cap * cap * (3.0 * BALL - cap));
    let bores = 6.0 * PI * BORE.powi(2) - 8.0 * 2.0_f64.sqrt() * BORE.powi(3);
    [single, mixed, double].map(|volume| (volume / (ball - bores) - 1.0).abs())
}

/// The volume of the part, with the chords added up as they are, and in double precision.
fn sums<T: Real>(offset: f64, [generator, rays]: [u32; 2]) -> [f64; 2] {
    let part = Part::<T>::at(place(offset));
    let dir = dvec3(0.62, 0.46, 2.0);
    let [width, height] = [2.0 * HALF + dir.x, 2.0 * HALF + dir.y];
    let (mut plain, mut wide) = (T::default(), 0.0);
    for i in 0..rays {
        let n = f64::from(rays);
        let [x, y] = [1, generator].map(|g| (f64::from(i) * f64::from(g) % n + 0.5) / n);
        let from = dvec3(x * width - HALF - dir.x, y * height - HALF - dir.y, -HALF);
        let ray = solidray::Ray::new(place(offset) + from, dir);
        let length = part.length(&Ray::of(&ray));
        plain = plain + length;
        wide += length.wide();
    }
    [plain.wide(), wide].map(|sum| sum * dir.z * width * height / f64::from(rays))
}

/// How many of a million points beside a ball are put on the wrong side.
fn wrong_points(offset: f64) -> Both<u32> {
    let (center, mut dice) = (place(offset), Dice::new(2));
    let single = Ball { center: triple::<f32>(center), radius: 1.0 };
    let double = Ball { center: triple::<f64>(center), radius: 1.0 };
    let mut wrong = Both { single: 0, double: 0 };
    for _ in 0..1_000_000 {
        let above = dice.within(-1e-4, 1e-4);
        let point = center + (1.0 + above) * dice.direction();
        wrong.single += u32::from(single.contains(triple(point)) != (above < 0.0));
        wrong.double += u32::from(double.contains(triple(point)) != (above < 0.0));
    }
    wrong
}

/// How many cells a sheet of triangles has each way, and how wide they are.
const CELLS: usize = 64;
const WIDTH: f64 = 1.0 / 64.0;

/// The two triangles of a cell of a wavy sheet.
fn cell<T: Real>(offset: f64, x: usize, y: usize) -> [Triangle<T>; 2] {
    let corner = |x: usize, y: usize| {
        let [x, y] = [x, y].map(|k| WIDTH * k as f64);
        triple(place(offset) + dvec3(x, y, height(x, y)))
    };
    let [a, b, c, d] =
        [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
    [[a, b, c], [a, c, d]]
}

fn height(x: f64, y: f64) -> f64 {
    0.1 * (3.0 * x + y).sin() * (2.0 * y).cos()
}

/// How many of a million lines that cross a sheet once do not cross it, or cross it twice.
fn wrong_crossings(offset: f64) -> Both<[u32; 2]> {
    let mut dice = Dice::new(3);
    let at = |_| {
        let [x, y] = [dice.within(0.1, 0.9), dice.within(0.1, 0.9)];
        let to = place(offset) + dvec3(x, y, height(x, y));
        let from = to + dvec3(dice.within(-0.5, 0.5), dice.within(-0.5, 0.5), 3.0);
        (solidray::Ray::new(from, to - from), [cell_of(x), cell_of(y)])
    };
    let rays: Vec<_> = (0..1_000_000).map(at).collect();
    Both {
        single: wrong_of::<f32>(offset, &rays),
        double: wrong_of::<f64>(offset, &rays),
    }
}

#[expect(clippy::cast_possible_truncation, reason = "it is one of the cells")]
#[expect(clippy::cast_sign_loss, reason = "it is not negative")]
fn cell_of(x: f64) -> usize {
    (x / WIDTH) as usize
}

fn wrong_of<T: Real>(offset: f64, rays: &[(solidray::Ray, [usize; 2])]) -> [u32; 2] {
    let cells: Vec<[Triangle<T>; 2]> =
        (0..CELLS * CELLS).map(|i| cell(offset, i % CELLS, i / CELLS)).collect();
    let (mut lost, mut doubled) = (0, 0);
    for (ray, [x, y]) in rays {
        let ray = Ray::<T>::of(ray);
        let around = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| [x, y]));
        let faces = around.flat_map(|[x, y]| cells[CELLS * y + x]);
        match faces.filter(|&face| meets(face, &ray)).count() {
            0 => lost += 1,
            1 => {}
            _ => doubled += 1,
        }
    }
    [lost, doubled]
}

/// Lines through a cube.
fn lines() -> Vec<solidray::Ray> {
    let mut dice = Dice::new(4);
    let line = |_| {
        let from = 3.0 * dice.direction();
        solidray::Ray::new(from, dice.point(1.0) - from)
    };
    (0..10_000).map(line).collect()
}

/// Nanoseconds a ray: the medians of rounds that take turns.
fn timed(rays: usize, single: impl Fn() -> f32, double: impl Fn() -> f64) -> Both<f64> {
    const ROUNDS: usize = 51;
    let [mut a, mut b] = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        let start = Instant::now();
        black_box(single());
        a.push(start.elapsed());
        let start = Instant::now();
        black_box(double());
        b.push(start.elapsed());
    }
    let [single, double] = [a, b].map(|mut times| {
        times.sort();
        1e9 * times[ROUNDS / 2].as_secs_f64() / rays as f64
    });
    Both { single, double }
}

fn cast<T: Real>(rays: &[solidray::Ray]) -> Vec<Ray<T>> {
    rays.iter().map(Ray::of).collect()
}

fn time_of_part() -> Both<f64> {
    fn run<T: Real>(part: &Part<T>, rays: &[Ray<T>]) -> T {
        rays.iter().fold(T::default(), |sum, ray| sum + part.length(ray))
    }
    let (rays, at) = (lines(), DVec3::ZERO);
    let (single, double) = (cast(&rays), cast(&rays));
    let parts = (Part::at(at), Part::at(at));
    timed(rays.len(), || run(&parts.0, &single), || run(&parts.1, &double))
}

fn time_of_ball() -> Both<f64> {
    fn run<T: Real>(rays: &[Ray<T>]) -> T {
        let ball = Ball { center: [T::default(); 3], radius: T::of(1.0) };
        rays.iter().fold(T::default(), |sum, ray| match ball.stretch(ray) {
            Some([from, to]) => sum + (to - from),
            None => sum,
        })
    }
    let rays = lines();
    let (single, double) = (cast(&rays), cast(&rays));
    timed(rays.len(), || run::<f32>(&single), || run::<f64>(&double))
}

fn time_of_many() -> Both<f64> {
    fn run<T: Real>(rays: &Many<T>) -> T {
        let ball = Ball { center: [T::default(); 3], radius: T::of(1.0) };
        let lengths = ball.lengths(rays);
        lengths[0] + lengths[lengths.len() / 2]
    }
    let rays = lines();
    let (single, double) = (Many::of(&rays), Many::of(&rays));
    timed(rays.len(), || run::<f32>(&single), || run::<f64>(&double))
}

fn time_of_triangle() -> Both<f64> {
    fn run<T: Real>(rays: &[Ray<T>], triangle: Triangle<T>) -> T {
        let met = rays.iter().filter(|ray| meets(triangle, ray)).count();
        T::of(met as f64)
    }
    let corners = [dvec3(-1.0, -0.5, 0.0), dvec3(1.0, -0.7, 0.2), dvec3(0.1, 1.0, -0.1)];
    let rays = lines();
    let (single, double) = (cast(&rays), cast(&rays));
    timed(
        rays.len(),
        || run::<f32>(&single, corners.map(triple)),
        || run::<f64>(&double, corners.map(triple)),
    )
}
