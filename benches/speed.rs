//! How fast scenes are compiled and answer: `cargo bench`.
//!
//! Times are for a whole batch; the column of items a second says what a ray or a point
//! costs. `cargo bench -- primary` runs one group. To compare with other programs see
//! `benches/peers`.

#[path = "scenes/queries.rs"]
mod queries;
#[path = "scenes/mod.rs"]
mod scenes;

use divan::counter::ItemsCount;
use divan::{AllocProfiler, Bencher, black_box};
use glam::DVec3;
use rayon::{ThreadPool, ThreadPoolBuilder};
use scenes::{FORMULAS, MESHES, Subject};
use solidray::measure::{self, Sampling};
use solidray::render::{Frame, View, trace};
use solidray::{Ray, Scene, Tracer};

/// Counts what compiling allocates.
#[global_allocator]
static ALLOCATOR: AllocProfiler = AllocProfiler::system();

/// The side of pictures.
const SIZE: u32 = 1024;
/// The side of the grid of rays that are asked for all their spans.
const GRID: u32 = 256;
/// How many single rays, and points, are asked about.
const COUNT: u32 = 1 << 16;

fn main() {
    divan::main();
}

fn everything() -> impl Iterator<Item = &'static str> {
    FORMULAS.into_iter().chain(MESHES)
}

fn compiled(name: &str) -> (Subject, Scene) {
    let subject = Subject::named(name);
    let scene = Scene::compile(&subject.solid).expect("the scene is right");
    (subject, scene)
}

fn threads(count: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(count).build().expect("threads can be had")
}

/// The first hit of each pixel with its normal: all that shading needs.
#[divan::bench(args = everything(), consts = [1, 2], sample_count = 7, sample_size = 1)]
fn primary<const THREADS: usize>(bencher: Bencher, name: &str) {
    let (subject, scene) = compiled(name);
    let (view, pool) = (subject.view(SIZE), threads(THREADS));
    let rays = ItemsCount::new(SIZE * SIZE);
    bencher.counter(rays).bench_local(|| pool.install(|| normals(&scene, &view)));
}

/// Traces a picture and adds up its normals, on as many threads as there are.
fn normals(scene: &Scene, view: &View) -> DVec3 {
    use rayon::prelude::*;
    let frame = trace(scene, view, [0.5; 2], &|_| ());
    let row = |y| (0..SIZE).filter_map(|x| normal(scene, &frame, x, y)).sum::<DVec3>();
    (0..SIZE).into_par_iter().map(row).sum()
}

fn normal(scene: &Scene, frame: &Frame, x: u32, y: u32) -> Option<DVec3> {
    Some(scene.normal_at(&frame.ray(x, y), &frame.hit(x, y)?))
}

/// All spans of parallel rays.
#[divan::bench(args = everything(), sample_count = 7, sample_size = 1)]
fn spans(bencher: Bencher, name: &str) {
    let (subject, scene) = compiled(name);
    let rays = queries::parallel(&subject.view(GRID));
    let mut tracer = scene.tracer();
    bencher
        .counter(ItemsCount::new(rays.len()))
        .bench_local(|| rays.iter().map(|ray| tracer.spans(ray).len()).sum::<usize>());
}

/// The first hit of single rays from all sides.
#[divan::bench(args = everything(), sample_count = 7, sample_size = 1)]
fn random(bencher: Bencher, name: &str) {
    let (subject, scene) = compiled(name);
    let rays = queries::chords(&subject.bounds, COUNT);
    let mut tracer = scene.tracer();
    bencher
        .counter(ItemsCount::new(rays.len()))
        .bench_local(|| first(&mut tracer, &rays));
}

fn first(tracer: &mut Tracer<'_>, rays: &[Ray]) -> f64 {
    rays.iter().filter_map(|ray| tracer.first_hit(ray)).map(|hit| hit.t).sum()
}

/// Whether points are inside.
#[divan::bench(args = everything(), sample_count = 7, sample_size = 1)]
fn membership(bencher: Bencher, name: &str) {
    let (subject, scene) = compiled(name);
    let points = queries::points(&subject.bounds, COUNT);
    bencher
        .counter(ItemsCount::new(points.len()))
        .bench_local(|| inside(&scene, &points));
}

fn inside(scene: &Scene, points: &[DVec3]) -> usize {
    let mut tracer = scene.tracer();
    points.iter().filter(|&&point| tracer.contains(point)).count()
}

/// A volume to a half width of one part in ten thousand.
#[divan::bench(args = everything(), consts = [1, 2], sample_count = 3, sample_size = 1)]
fn volume<const THREADS: usize>(bencher: Bencher, name: &str) {
    let (subject, scene) = compiled(name);
    let pool = threads(THREADS);
    let sampling = Sampling { rel_tol: 1e-4, ..Sampling::default() };
    let volume = pool.install(|| measure::volume(&scene, &sampling));
    let error = subject.volume.map_or(0.0, |exact| (volume.value - exact).abs());
    assert!(error <= 3.0 * volume.half_width(), "{name}: {volume:?}");
    bencher
        .counter(ItemsCount::new(volume.rays))
        .bench_local(|| pool.install(|| measure::volume(black_box(&scene), &sampling)));
}

/// From what is said to a scene that answers.
#[divan::bench(args = everything(), sample_count = 7, sample_size = 1)]
fn compile(bencher: Bencher, name: &str) {
    let solid = Subject::named(name).solid;
    bencher
        .bench_local(|| Scene::compile(black_box(&solid)).expect("the scene is right"));
}
