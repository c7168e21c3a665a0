//! The other ways to a volume: formulas, random points, certain bounds.

#[expect(dead_code, reason = "volumes need no rays")]
mod support;

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use glam::{DAffine3, DQuat, DVec3, dvec3};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, TestRunner};
use solidray::measure::{self, Estimate, Method, Sampling};
use solidray::primitive::{Primitive, Profile, Quadric};
use solidray::{Op, Scene, Solid, unwatched};
use support::leaf::{self, Leaf};
use support::model::Model;
use support::strategies::{self, map};
use support::{meshes, scene};

fn sampling(rel_tol: f64, max_rays: u64) -> Sampling {
    Sampling { rel_tol, max_rays, ..Sampling::default() }
}

fn exact(solid: &Solid) -> Estimate {
    measure::exact(solid).expect("there is a formula")
}

/// A bracket of so many cells at most.
fn bracket(solid: &Solid, cells: u64) -> Estimate {
    measure::bracket(&scene(solid), &sampling(0.0, cells), &unwatched)
}

fn holds(estimate: &Estimate, truth: f64) -> bool {
    let [low, high] = estimate.interval;
    low <= truth && truth <= high
}

fn width(estimate: &Estimate) -> f64 {
    2.0 * estimate.half_width()
}

fn tilted(solid: Solid) -> Solid {
    solid.rotated(dvec3(1.0, 2.0, -0.5), 0.7)
}

/// Solids with their volumes from textbooks.
fn textbook() -> Vec<(&'static str, Solid, f64)> {
    let ball = 4.0 / 3.0 * PI;
    let cap = |h: f64| PI * h * h * (3.0 - h) / 3.0;
    vec![
        ("ball", Solid::ball(1.3), ball * 1.3_f64.powi(3)),
        ("box", Solid::cuboid(dvec3(1.0, 2.0, 3.0)), 6.0),
        ("rotated box", tilted(Solid::cuboid(dvec3(1.0, 2.0, 3.0))), 6.0),
        ("ellipsoid", tilted(Solid::ball(1.0).scaled(dvec3(1.0, 2.0, 0.3))), ball * 0.6),
        ("cylinder", tilted(Solid::cylinder(0.7, 3.0)), PI * 0.49 * 3.0),
        ("cone", tilted(Solid::frustum(1.0, 0.0, 2.0)), PI * 2.0 / 3.0),
        ("frustum", Solid::frustum(1.0, 2.0, 3.0), PI * 7.0),
        ("paraboloid", tilted(Solid::paraboloid(2.0, 3.0)), 0.5 * PI * 4.0 * 3.0),
        (
            "one sheet",
            tilted(Solid::hyperboloid_of_one_sheet(1.0, 2.0, 3.0)),
            PI * 3.0 * 2.0,
        ),
        (
            "two sheets",
            tilted(Solid::hyperboloid_of_two_sheets(1.0, 0.5, 4.0)),
            2.0 * PI * 0.25 * (7.0 / 3.0 - 1.0),
        ),
        (
            "segment",
            Solid::primitive(Primitive::Quadric(Quadric {
                profile: Profile::Ball { radius: 1.0 },
                bottom: 0.25,
                top: 1.0,
            })),
            cap(0.75),
        ),
        ("mesh", tilted(Solid::mesh(meshes::grid_box(-DVec3::ONE, DVec3::ONE, 2))), 8.0),
        ("corner of a box", tilted(Solid::mesh(corner())), 1.0 / 6.0),
        ("tiny", Solid::ball(1e-9), ball * 1e-27),
        ("huge", tilted(Solid::cuboid(DVec3::splat(1e9))), 1e27),
        ("far away", Solid::ball(1.0).translated(dvec3(1e6, -2e5, 3e7)), ball),
    ]
}

/// A mesh that the middle of its box is not inside of.
fn corner() -> solidray::Mesh {
    let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    solidray::Mesh::new(points, faces).expect("it is closed")
}

#[test]
fn formulas_give_textbook_volumes() {
    for (name, solid, truth) in textbook() {
        let found = exact(&solid);
        let [low, high] = found.interval;
        let room = 4.0 * f64::EPSILON * truth;
        assert!(low <= truth + room && truth - room <= high, "{name}: {found:?} {truth}");
        assert!(width(&found) < 1e-13 * truth, "{name}: {found:?} {truth}");
        assert!(found.method == Method::Exact && found.rays == 0 && found.target_met);
    }
}

#[test]
fn unions_of_leaves_that_are_apart_have_formulas() {
    let row = (0..100)
        .map(|i| Solid::cuboid(DVec3::ONE).translated(dvec3(f64::from(i), 0.0, 0.0)));
    let found = exact(&Solid::boolean(Op::Union, row));
    assert!(holds(&found, 100.0) && width(&found) < 1e-9, "{found:?}");
    let apart =
        Solid::ball(1.0) + tilted(Solid::cuboid(DVec3::ONE)).translated(3.0 * DVec3::X);
    assert!((exact(&apart).value - 4.0 / 3.0 * PI - 1.0).abs() < 1e-13);
    assert!(holds(&exact(&Solid::empty()), 0.0));
    if let Ok(nothing) = solidray::Mesh::new(Vec::new(), Vec::new()) {
        assert!(holds(&exact(&Solid::mesh(nothing)), 0.0));
    }
}

#[test]
fn what_has_to_be_cut_has_no_formula() {
    let ball = Solid::ball(1.0);
    let near = ball.clone().translated(0.5 * DVec3::X);
    for solid in [
        ball.clone() - near.clone(),
        ball.clone() & near.clone(),
        ball.clone() + near,
        ball.clone() + ball.clone(),
        Solid::half_space(DVec3::X, 0.0),
        Solid::ball(-1.0),
        ball.scaled(dvec3(1.0, 1.0, 0.0)),
    ] {
        assert_eq!(measure::exact(&solid), None);
    }
}

/// Space around which a mesh winds twice would be counted twice.
#[test]
fn meshes_that_wind_twice_have_no_formula() {
    let one = meshes::grid_box(-DVec3::ONE, DVec3::ONE, 1);
    let points = one.points().iter().chain(one.points());
    let points = points.enumerate().map(|(i, &p)| if i < 8 { p } else { 0.5 * p });
    let count = u32::try_from(one.points().len()).expect("it is small");
    let again = one.faces().iter().map(|face| face.map(|i| i + count));
    let faces = one.faces().iter().copied().chain(again).collect();
    let two = solidray::Mesh::new(points.collect(), faces).expect("it is closed");
    assert_eq!(measure::exact(&Solid::mesh(two)), None);
}

proptest! {
    #![proptest_config(Config::with_cases(64))]

    /// Formulas against certain bounds, under maps that turn, stretch and shear.
    #[test]
    fn formulas_are_within_brackets(leaf in leaf::bounded(), map in map()) {
        let model = Model::Leaf(leaf).mapped(map);
        let solid = model.solid();
        if let Some(found) = measure::exact(&solid) {
            let bounds = bracket(&solid, 1 << 14);
            prop_assert!(found.interval[0] <= bounds.interval[1]
                && bounds.interval[0] <= found.interval[1], "{found:?} {bounds:?}");
            prop_assert!(width(&found) < 1e-12 * found.value);
        }
    }

    /// Brackets of random trees hold what lattices find.
    #[test]
    fn n40_brackets_hold_the_volumes_of_random_trees(model in strategies::model()) {
        let solid = model.solid();
        let Ok(scene) = Scene::compile(&solid) else { return Ok(()) };
        let bounds = measure::bracket(&scene, &sampling(0.0, 1 << 14), &unwatched);
        let lattice = measure::volume(&scene, &sampling(1e-3, 1 << 16));
        // Half widths are 2.13 standard errors.
        let room = 3.0 * lattice.half_width() + 1e-9;
        let [low, high] = bounds.interval;
        prop_assert!(
            low <= lattice.value + room && lattice.value - room <= high,
            "{bounds:?} {lattice:?}"
        );
    }
}

/// As they are, and under maps.
#[test]
fn n40_brackets_hold_textbook_volumes() {
    let mut runner = TestRunner::deterministic();
    for (name, solid, truth) in textbook() {
        let maps = (0..3)
            .map(|_| map().new_tree(&mut runner).expect("nothing is rejected").current());
        for map in std::iter::once(DAffine3::IDENTITY).chain(maps) {
            let solid = solid.clone().mapped(map);
            let truth = truth * map.matrix3.determinant().abs();
            for cells in [1 << 6, 1 << 10, 1 << 14, 1 << 16] {
                let found = bracket(&solid, cells);
                // The truth is rounded, and so are the maps' products.
                let room = 64.0 * f64::EPSILON * truth;
                let [low, high] = found.interval;
                assert!(
                    low <= truth + room && truth - room <= high,
                    "{name}: {found:?} {truth} {map:?}"
                );
                assert!(found.rays <= cells && found.method == Method::Bracket);
            }
        }
    }
}

/// Trees of balls and boxes, of which slices know the volume to nine digits.
#[test]
fn n40_brackets_hold_the_volumes_of_trees_of_balls_and_boxes() {
    let mut runner = TestRunner::deterministic();
    let leaf = prop_oneof![
        strategies::length().prop_map(|radius| Leaf::Ball { radius }),
        [(); 3].map(|()| strategies::length()).prop_map(|size| Leaf::Cuboid {
            min: DVec3::ZERO,
            max: DVec3::from_array(size),
        }),
    ];
    let placed = (leaf, strategies::place())
        .prop_map(|(leaf, at)| Model::Leaf(leaf).mapped(DAffine3::from_translation(at)));
    let trees = placed.prop_recursive(3, 6, 3, |inner| {
        (strategies::op(), prop::collection::vec(inner, 2..=3))
            .prop_map(|(op, children)| Model::boolean(op, children))
    });
    let cases = (trees, map());
    let mut known = 0;
    while known < 60 {
        let (tree, map) =
            cases.new_tree(&mut runner).expect("nothing is rejected").current();
        let solid = tree.solid();
        let truth = measure::adaptive(&scene(&solid), &sampling(1e-9, 1 << 22))
            .expect("there are few surfaces");
        let is_known = truth.method == Method::Adaptive && truth.target_met;
        if !is_known || !truth.resolved {
            continue;
        }
        known += 1;
        for (solid, factor) in
            [(solid.clone(), 1.0), (solid.mapped(map), map.matrix3.determinant().abs())]
        {
            for cells in [1 << 8, 1 << 12, 1 << 15] {
                let found = bracket(&solid, cells);
                let [low, high] = found.interval;
                let [least, most] = truth.interval.map(|end| factor * end);
                assert!(low <= most && least <= high, "{found:?} {truth:?} {tree:?}");
            }
        }
    }
}

#[test]
fn brackets_hold_where_surfaces_meet() {
    let cube = Solid::cuboid(DVec3::ONE);
    let ball = Solid::ball(0.5);
    let of_ball = PI / 6.0;
    let flush = cube.clone().translated(DVec3::X);
    for (solid, truth) in [
        (cube.clone() - cube.clone(), 0.0),
        (tilted(cube.clone()) - tilted(cube.clone()), 0.0),
        (cube.clone() + flush.clone(), 2.0),
        (cube.clone() & flush, 0.0),
        (cube.clone() - ball.clone(), 1.0 - of_ball),
        (ball.clone() + ball.clone().translated(DVec3::X), 2.0 * of_ball),
        (ball.clone() & ball.translated(DVec3::Y), 0.0),
    ] {
        let found = bracket(&solid, 1 << 16);
        assert!(holds(&found, truth), "{found:?} {truth}");
        assert!(width(&found) < 0.02, "{found:?} {truth}");
    }
}

/// The order in which the width falls with the number of cells.
fn order(solid: &Solid) -> f64 {
    let [few, many] = [1 << 15, 1 << 20].map(|cells| bracket(solid, cells));
    (width(&many) / width(&few)).ln() / (many.rays as f64 / few.rays as f64).ln()
}

#[test]
fn brackets_narrow_like_the_number_of_cells() {
    let cube = DVec3::splat(1.3);
    for (name, solid, least) in [
        ("ball", Solid::ball(1.0), -0.85),
        ("rotated box", tilted(Solid::cuboid(cube)), -0.85),
        ("ball and box", Solid::ball(0.8) & tilted(Solid::cuboid(cube)), -0.85),
        // Half an order in the end, but most of so few cells touch a face still.
        ("mesh", tilted(Solid::mesh(meshes::icosphere(2))), -0.4),
    ] {
        let order = order(&solid);
        assert!(order <= least, "{name}: {order}");
    }
}

#[test]
fn points_are_right_in_95_of_100_cases() {
    let rare = Solid::boolean(
        Op::Union,
        [Solid::ball(0.05), Solid::ball(0.05).translated(DVec3::ONE)],
    );
    let rare_truth = 2.0 * 4.0 / 3.0 * PI * 0.05_f64.powi(3);
    for (solid, truth, points) in [
        (Solid::ball(1.0), 4.0 / 3.0 * PI, 4096),
        (rare.clone(), rare_truth, 4096),
        (rare, rare_truth, 1 << 16),
    ] {
        let scene = scene(&solid);
        let held = (0..300)
            .filter(|&seed| {
                let sampling = Sampling { seed, ..sampling(0.0, points) };
                let found = measure::points(&scene, &sampling, &unwatched);
                assert_eq!((found.rays, found.method), (points, Method::Points));
                assert!(width(&found) > 0.0);
                assert_eq!(found.resolved, found.value > 0.0);
                holds(&found, truth)
            })
            .count();
        assert!((270..=298).contains(&held), "{held}");
    }
}

#[test]
fn points_go_on_until_they_are_enough() {
    let scene = scene(&Solid::ball(1.0));
    let found = measure::points(&scene, &sampling(3e-3, 1 << 26), &unwatched);
    assert!(found.target_met && found.half_width() <= 3e-3 * found.value);
    assert!(found.rays < 1 << 20, "{found:?}");
    assert!((found.value - 4.0 / 3.0 * PI).abs() < 3.0 * found.half_width());
}

#[test]
fn nothing_found_is_not_nothing() {
    let corners = [DVec3::ZERO, DVec3::splat(1.0)];
    let dust = corners.map(|at| Solid::ball(1e-6).translated(at));
    let dust = scene(&Solid::boolean(Op::Union, dust));
    let found = measure::points(&dust, &sampling(1e-2, 1 << 14), &unwatched);
    let [low, high] = found.interval;
    assert!(!found.resolved && !found.target_met && found.value == 0.0, "{found:?}");
    assert!(low == 0.0 && high > 1e-4 && high < 1e-3, "{found:?}");
}

#[cfg(feature = "parallel")]
#[test]
fn threads_change_no_bit() {
    let solid = tilted(Solid::cuboid(DVec3::splat(1.3))) - Solid::ball(0.7)
        + Solid::mesh(meshes::icosphere(2)).translated(2.0 * DVec3::X);
    let scene = scene(&solid);
    let answers = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be had").install(|| {
            let sampling = sampling(1e-3, 1 << 17);
            let points = measure::points(&scene, &sampling, &unwatched);
            let bracket = measure::bracket(&scene, &sampling, &unwatched);
            format!("{points:?} {bracket:?}")
        })
    });
    assert_eq!(answers[0], answers[1]);
}

#[test]
fn answers_are_true_when_work_is_cut_short() {
    let truth = 4.0 / 3.0 * PI;
    let scene = scene(&Solid::ball(1.0));
    let endless = Sampling {
        time_limit: Some(Duration::from_millis(200)),
        ..sampling(0.0, u64::MAX)
    };
    for method in [measure::points, measure::bracket] {
        let found = method(&scene, &endless, &unwatched);
        assert!(!found.target_met && found.rays > 0, "{found:?}");
        let room = width(&found);
        let [low, high] = found.interval;
        assert!(low - room <= truth && truth <= high + room, "{found:?}");
        for after in [0, 10_000, 200_000] {
            let count = AtomicU64::new(0);
            let watch = |rays: u64| {
                if count.fetch_add(rays, Ordering::Relaxed) + rays > after {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            };
            let endless = Sampling { time_limit: None, ..endless };
            let found = method(&scene, &endless, &watch);
            let room = width(&found);
            let [low, high] = found.interval;
            assert!(low - room <= truth && truth <= high + room, "{found:?}");
        }
    }
}

/// Offsets of which rounding leaves little.
#[test]
fn brackets_hold_far_from_the_origin() {
    for distance in [1e3, 1e8, 1e12, 1e15] {
        let at = DAffine3::from_rotation_translation(
            DQuat::from_rotation_x(0.3),
            distance * dvec3(1.0, -0.5, 0.25),
        );
        for (solid, truth) in
            [(Solid::ball(1.0), 4.0 / 3.0 * PI), (Solid::cuboid(DVec3::ONE), 1.0)]
        {
            let found = bracket(&solid.mapped(at), 1 << 14);
            assert!(holds(&found, truth), "{distance}: {found:?}");
        }
    }
}
