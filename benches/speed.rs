//! How fast scenes answer: `cargo bench`.
//!
//! Times are for a whole batch; the column of items a second says what a ray or a point
//! costs. `cargo bench -- primary` runs one group. To compare with other programs see
//! `benches/peers`.

#[path = "scenes/queries.rs"]
mod queries;
#[path = "scenes/mod.rs"]
mod scenes;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use rayon::{ThreadPool, ThreadPoolBuilder};
use scenes::{FORMULAS, MESHES, Subject};
use solidray::Scene;
use solidray::measure::{self, Sampling};

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
    bencher
        .counter(rays)
        .bench_local(|| pool.install(|| queries::normals(&scene, &view)));
}

/// All spans of parallel rays.
#[divan::bench(args = everything(), sample_count = 7, sample_size = 1)]
fn spans(bencher: Bencher, name: &str) {
    let (subject, scene) = compiled(name);
    let rays = queries::parallel(&subject.view(GRID));
    let mut tracer = scene.tracer();
    bencher
        .counter(ItemsCount::new(rays.len()))
        .bench_local(|| queries::spans(&mut tracer, &rays));
}

/// The first hit of single rays from all sides.
#[divan::bench(args = everything(), sample_count = 7, sample_size = 1)]
fn random(bencher: Bencher, name: &str) {
    let (subject, scene) = compiled(name);
    let rays = queries::chords(&subject.bounds, COUNT);
    let mut tracer = scene.tracer();
    bencher
        .counter(ItemsCount::new(rays.len()))
        .bench_local(|| queries::first(&mut tracer, &rays));
}

/// Whether points are inside.
#[divan::bench(args = everything(), sample_count = 7, sample_size = 1)]
fn membership(bencher: Bencher, name: &str) {
    let (subject, scene) = compiled(name);
    let points = queries::points(&subject.bounds, COUNT);
    bencher
        .counter(ItemsCount::new(points.len()))
        .bench_local(|| queries::inside(&scene, &points));
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
