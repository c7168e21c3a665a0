//! Trees too deep and too wide for recursion and for anything quadratic.

#[expect(dead_code, reason = "these trees are made, not drawn by lot")]
mod support;

use std::time::Instant;

use glam::{DVec3, dvec3};
use solidray::{Op, Ray, Scene, Solid};
use support::{ends, ends_in, scene};

const MANY: u32 = 100_000;

/// Runs something on a stack of 256 KiB: a frame for each of 100,000 nodes would not fit.
fn on_a_small_stack(test: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(256 * 1024).spawn(test);
    thread.expect("a thread can be had").join().expect("the test's thread did not panic");
}

/// Place `i` on a square grid of 400 by 250 with unit steps.
fn cell(i: u32) -> DVec3 {
    dvec3(f64::from(i % 400), f64::from(i / 400), 0.0)
}

fn pearl(i: u32) -> Solid {
    Solid::ball(0.25).translated(cell(i))
}

/// Along a row of the grid.
fn row() -> Ray {
    Ray::new(dvec3(-10.0, 7.0, 0.0), DVec3::X)
}

#[test]
fn n36_a_chain_of_100_000_differences_compiles_answers_and_drops() {
    on_a_small_stack(|| {
        let plate =
            Solid::cuboid_between(dvec3(-1.0, -1.0, -1.0), dvec3(400.0, 250.0, 1.0));
        let drilled = (0..MANY).fold(plate, |rest, i| rest - pearl(i));
        let list = ends(&drilled, &row());
        assert_eq!(list.len(), 401);
        assert!((list[1][0] - 10.25).abs() < 1e-12 && (list[1][1] - 10.75).abs() < 1e-12);
    });
}

/// a − (b − (c − …)): every level is another node, and complements alternate.
#[test]
fn n36_a_chain_of_100_000_differences_from_the_right_compiles_answers_and_drops() {
    on_a_small_stack(|| {
        let chain = (0..MANY).rev().fold(Solid::empty(), |rest, i| pearl(i) - rest);
        assert_eq!(ends(&chain, &Ray::new(dvec3(-10.0, 0.0, 0.0), DVec3::X)).len(), 1);
        let shells = (1..=1000)
            .rev()
            .fold(Solid::empty(), |rest, i| Solid::ball(f64::from(1001 - i)) - rest);
        assert_eq!(ends(&shells, &Ray::new(DVec3::ZERO, DVec3::X)).len(), 1000);
    });
}

#[test]
fn n36_a_chain_of_100_000_maps_compiles_answers_and_drops() {
    on_a_small_stack(|| {
        let step = dvec3(2.0_f64.powi(-10), 0.0, 0.0);
        let moved = (0..MANY).fold(Solid::ball(1.0), |solid, _| solid.translated(step));
        let middle = f64::from(MANY) / 1024.0;
        let ray = Ray::new(DVec3::ZERO, DVec3::X);
        assert_eq!(ends(&moved, &ray), [[middle - 1.0, middle + 1.0]]);
    });
}

#[test]
fn n36_a_union_of_100_000_answers_from_what_a_ray_meets() {
    on_a_small_stack(|| {
        let pearls = scene(&Solid::boolean(Op::Union, (0..MANY).map(pearl)));
        assert_eq!(ends_in(&pearls, &row()).len(), 400);
        let mut tracer = pearls.tracer();
        for i in 0..MANY {
            assert!(tracer.contains(cell(i)) && !tracer.contains(cell(i) + 0.3));
        }
    });
}

#[test]
fn a_shared_subtree_outlives_the_trees_that_hold_it() {
    on_a_small_stack(|| {
        let shared =
            (0..MANY).fold(Solid::ball(1.0), |solid, _| solid.translated(DVec3::ZERO));
        let holder = shared.clone() + Solid::cuboid(DVec3::ONE);
        drop(holder);
        assert_eq!(ends(&shared, &support::along_x(0.0, 0.0)), [[9.0, 11.0]]);
    });
}

/// Forty lines of code, a million million leaves.
#[test]
fn a_tree_that_shares_itself_too_often_is_refused() {
    let doubled = (0..40).fold(Solid::ball(1.0), |solid, _| solid.clone() + solid);
    let error = Scene::compile(&doubled).expect_err("it is too large");
    assert_eq!(
        error.to_string(),
        "the solid has more than 134217728 leaves, operators, maps and tags"
    );
    let few = (0..10).fold(Solid::ball(1.0), |solid, _| solid.clone() + solid);
    assert_eq!(Scene::compile(&few).expect("it is small").leaf_count(), 1024);
}

/// A union of 64 differences of 64 unions of this many pearls.
fn fans(leaves: u32) -> Solid {
    let inner = |i: u32| {
        Solid::boolean(Op::Union, (0..leaves).map(|k| pearl((i * leaves + k) % MANY)))
    };
    let middle =
        |i: u32| Solid::boolean(Op::Difference, (0..64).map(|k| inner(64 * i + k)));
    Solid::boolean(Op::Union, (0..64).map(middle))
}

#[test]
fn n36_fans_of_64_compile_answer_and_drop() {
    on_a_small_stack(|| {
        let fans = scene(&fans(64));
        assert_eq!(fans.leaf_count(), 64 * 64 * 64);
        // What stands first in its difference is there.
        let mut tracer = fans.tracer();
        for i in 0..MANY {
            let mut places = (i..262_144).step_by(MANY as usize);
            assert_eq!(tracer.contains(cell(i)), places.any(|k| k % 4096 < 64), "{i}");
        }
    });
}

/// The time that this thread has had a processor for, in seconds, where the system tells;
/// else the time that has passed.
fn seconds(since: Instant) -> f64 {
    let spent = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds: Option<f64> =
        spent.and_then(|text| text.split_whitespace().next()?.parse().ok());
    nanoseconds.map_or_else(|| since.elapsed().as_secs_f64(), |n| 1e-9 * n)
}

/// What it takes to make a tree, compile it, ask it along a row and drop it: the least of a
/// few times.
fn work(make: impl Fn(u32) -> Solid, size: u32) -> f64 {
    let once = || {
        let start = Instant::now();
        let before = seconds(start);
        let found = ends(&make(size), &row());
        std::hint::black_box(found);
        seconds(start) - before
    };
    (0..3).map(|_| once()).fold(f64::INFINITY, f64::min)
}

/// Four times the size may take nine times as long, which leaves room for logarithms and
/// for memory that is farther away; what is quadratic takes sixteen times as long.
#[test]
fn n36_work_grows_with_size() {
    on_a_small_stack(|| {
        type Make = fn(u32) -> Solid;
        let makes: [(&str, Make); 5] = [
            ("chain of differences", |n| {
                let low = dvec3(-1.0, -1.0, -1.0);
                let plate = Solid::cuboid_between(low, dvec3(400.0, 250.0, 1.0));
                (0..n).fold(plate, |rest, i| rest - pearl(i))
            }),
            ("chain of differences from the right", |n| {
                (0..n).rev().fold(Solid::empty(), |rest, i| pearl(i) - rest)
            }),
            ("chain of maps", |n| {
                (0..n).fold(Solid::ball(1.0), |solid, _| solid.translated(DVec3::ZERO))
            }),
            ("union", |n| Solid::boolean(Op::Union, (0..n).map(pearl))),
            ("fans of 64", |n| fans(n / 4096)),
        ];
        for (name, make) in makes {
            let (few, many) = (24_576, 98_304);
            let ratio = work(make, many) / work(make, few);
            assert!(ratio < 9.0, "{name}: {ratio} times the work for 4 times the size");
        }
    });
}
