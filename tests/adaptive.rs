//! Volumes to many digits against closed forms, and against lattices where there are none.

#[expect(dead_code, reason = "volumes need no random rays")]
mod support;

use std::f64::consts::PI;
use std::time::{Duration, Instant};

use glam::{DAffine3, DVec3, dvec3};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use solidray::measure::{self, Estimate, Method, Sampling, Unsuited};
use solidray::{Scene, Solid};
use support::{meshes, scene, strategies};

fn sampling(rel_tol: f64, seed: u64) -> Sampling {
    Sampling { rel_tol, seed, ..Sampling::default() }
}

fn measured(solid: &Solid, rel_tol: f64, seed: u64) -> Estimate {
    measure::adaptive(&scene(solid), &sampling(rel_tol, seed)).expect("few primitives")
}

/// The interval holds the truth, is as narrow as was asked for and from slices.
fn assert_volume(name: &str, solid: &Solid, exact: f64, rel_tol: f64, seed: u64) {
    let estimate = measured(solid, rel_tol, seed);
    assert_eq!(estimate.method, Method::Adaptive, "{name}: {estimate:?}, {exact}");
    assert!(estimate.target_met && estimate.resolved, "{name}: {estimate:?}");
    assert!(estimate.half_width() <= rel_tol * exact, "{name}: {estimate:?}, {exact}");
    // The closed form is rounded too.
    let error = (estimate.value - exact).abs();
    assert!(
        error <= estimate.half_width() + 8.0 * f64::EPSILON * exact,
        "{name}, seed {seed}: {estimate:?}, {exact}, off by {error:e}"
    );
}

/// A cylinder of this radius about an axis, from −3 to 3.
fn rod(radius: f64, axis: DVec3) -> Solid {
    let upright = Solid::cylinder(radius, 6.0).translated(-3.0 * DVec3::Z);
    match axis {
        DVec3::X => upright.rotated(DVec3::Y, 0.5 * PI),
        DVec3::Y => upright.rotated(DVec3::X, 0.5 * PI),
        _ => upright,
    }
}

fn ball_volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3)
}

fn tilt() -> DAffine3 {
    DAffine3::from_axis_angle(dvec3(1.0, 2.0, -0.5).normalize(), 0.7)
}

/// Solids with their volumes.
fn textbook() -> Vec<(&'static str, Solid, f64)> {
    let (r, h) = (1.3, 2.1);
    let [x, y, z] = DVec3::AXES.map(|axis| rod(0.9, axis));
    let body = Solid::cuboid(DVec3::splat(2.0)) & Solid::ball(1.35);
    let classic = DVec3::AXES.into_iter().fold(body, |b, axis| b - rod(0.7, axis));
    let box_of_ball = Solid::cuboid(DVec3::splat(2.0));
    let speck = Solid::ball(0.01).translated(dvec3(0.3, 0.2, -0.4));
    let (v, s, e) = (0.4_f64, 0.8, 1.5_f64);
    let lens =
        (Solid::ball(1.0) & Solid::ball(1.0).translated(DVec3::Y), 5.0 * PI / 12.0);
    vec![
        ("ball", Solid::ball(r), ball_volume(r)),
        ("speck", box_of_ball.clone() - (box_of_ball - speck), ball_volume(0.01)),
        ("box", Solid::cuboid(dvec3(1.0, 2.0, 0.7)), 1.4),
        (
            "shell",
            Solid::ball(1.0) - Solid::ball(0.9975),
            4.0 / 3.0 * PI * 0.0025 * (1.0 + 0.9975 + 0.9975 * 0.9975),
        ),
        ("cylinder", Solid::cylinder(r, h), PI * r * r * h),
        ("cone", Solid::frustum(r, 0.0, h), PI * r * r * h / 3.0),
        ("paraboloid", Solid::paraboloid(r, h), PI * r * r * h / 2.0),
        (
            "one sheet",
            Solid::hyperboloid_of_one_sheet(0.5, r, h),
            PI * h / 3.0 * (2.0 * 0.25 + r * r),
        ),
        (
            "two sheets",
            Solid::hyperboloid_of_two_sheets(v, s, 2.0 * e),
            2.0 * PI * s * s * ((e.powi(3) - v.powi(3)) / 3.0 - v * v * (e - v)),
        ),
        ("two rods", x.clone() & y.clone(), 16.0 / 3.0 * 0.9_f64.powi(3)),
        ("three rods", x & y & z, 8.0 * (2.0 - 2.0_f64.sqrt()) * 0.9_f64.powi(3)),
        (
            "ring",
            Solid::ball(2.0) - rod((4.0_f64 - 1.21).sqrt(), DVec3::Z),
            ball_volume(1.1),
        ),
        ("classic", classic, 2.102_460_573_219_949_5),
        ("lens", lens.0, lens.1),
        (
            "capsule",
            Solid::cylinder(0.5, 1.0)
                + Solid::ball(0.5)
                + Solid::ball(0.5).translated(DVec3::Z),
            PI * 0.25 + ball_volume(0.5),
        ),
        (
            "touching balls",
            Solid::ball(1.0) + Solid::ball(0.5).translated(dvec3(0.9, 1.2, 0.0)),
            ball_volume(1.0) + ball_volume(0.5),
        ),
        (
            "ball in a rod",
            rod(0.8, DVec3::Z) - Solid::ball(0.8),
            PI * 0.64 * 6.0 - ball_volume(0.8),
        ),
        (
            "boxes that share a face",
            Solid::cuboid(DVec3::ONE)
                + Solid::cuboid(dvec3(1.0, 0.5, 0.5)).translated(DVec3::X),
            1.25,
        ),
        (
            "boxes that share an edge",
            Solid::cuboid(DVec3::ONE)
                + Solid::cuboid(DVec3::ONE).translated(dvec3(1.0, 1.0, 0.0)),
            2.0,
        ),
    ]
}

#[test]
fn textbook_solids_have_their_volumes_to_twelve_digits() {
    for (name, solid, exact) in textbook() {
        for seed in [0, 1] {
            assert_volume(name, &solid, exact, 1e-12, seed);
            let moved = solid.clone().translated(dvec3(0.3, -0.2, 0.7)).mapped(tilt());
            assert_volume(name, &moved, exact, 1e-12, seed);
        }
    }
}

/// Rays in all, those of the check included; measured and a little more.
#[test]
fn simple_solids_take_few_rays() {
    let most = [
        ("ball", 6_000),
        ("speck", 6_000),
        ("box", 6_000),
        ("shell", 40_000),
        ("cylinder", 80_000),
        ("cone", 40_000),
    ];
    for (name, most) in most {
        let (_, solid, _) =
            textbook().into_iter().find(|(n, ..)| *n == name).expect("it is there");
        let estimate = measured(&solid, 1e-12, 0);
        assert!(estimate.rays <= most, "{name}: {estimate:?}");
    }
}

#[test]
fn sizes_do_not_matter() {
    for size in [1e-9, 1e-3, 1e9] {
        for (name, solid, exact) in textbook() {
            let solid = solid.scaled(DVec3::splat(size));
            assert_volume(name, &solid, exact * size.powi(3), 1e-11, 0);
        }
    }
}

#[test]
fn maps_scale_volumes_by_their_determinant() {
    let mut runner = TestRunner::deterministic();
    let cases = (strategies::map(), 0..textbook().len());
    for _ in 0..40 {
        let (map, which) =
            cases.new_tree(&mut runner).expect("none is rejected").current();
        let (name, solid, exact) = textbook().swap_remove(which);
        let factor = map.matrix3.determinant().abs();
        assert_volume(name, &solid.mapped(map), exact * factor, 1e-9, 0);
    }
}

/// Two directions of slices and the lattices: three answers to one question.
#[test]
fn random_trees_agree_with_lattices_and_other_directions() {
    let mut runner = TestRunner::deterministic();
    let cases = strategies::model();
    let (mut adaptive, mut all) = (0, 0);
    while all < 60 {
        let model = cases.new_tree(&mut runner).expect("none is rejected").current();
        let scene = scene(&model.solid());
        let find = |seed| measure::adaptive(&scene, &sampling(1e-9, seed));
        let (Ok(one), Ok(two)) = (find(1), find(2)) else { continue };
        let is_nothing = !one.resolved || one.method == Method::Exact;
        if scene.leaf_count() > 6 || is_nothing {
            continue;
        }
        all += 1;
        if [one, two].iter().any(|e| e.method != Method::Adaptive) {
            continue;
        }
        adaptive += 1;
        let lattice = measure::volume(&scene, &sampling(1e-4, 3));
        let apart = (one.value - lattice.value).abs();
        if lattice.resolved {
            assert!(apart <= 2.5 * lattice.half_width(), "{model:?} {one:?} {lattice:?}");
        }
        let apart = (one.value - two.value).abs();
        let width = one.half_width() + two.half_width();
        assert!(apart <= width, "{model:?} {one:?} {two:?}");
    }
    assert!(adaptive >= all - 2, "{adaptive} of {all}");
}

/// Thin films, narrow slits and specks are right or said not to be.
#[test]
fn small_features_are_not_missed() {
    let cube = Solid::cuboid(DVec3::splat(2.0));
    for thin in [1e-2, 1e-4, 1e-6, 1e-8] {
        let slit = Solid::cuboid(dvec3(thin, 3.0, 3.0)).translated(0.3 * DVec3::X);
        let cut = cube.clone() - slit.mapped(tilt());
        let film = Solid::cuboid(dvec3(1.0, 1.0, thin)).mapped(tilt())
            + Solid::ball(0.1).translated(3.0 * DVec3::X);
        let exact = thin + ball_volume(0.1);
        assert_volume("film", &film, exact, 1e-9, 0);
        let hole = rod(thin, DVec3::Z).translated(dvec3(0.3, 0.1, 0.0));
        let exact = 8.0 - 2.0 * PI * thin * thin;
        assert_volume("hole", &(cube.clone() - hole), exact, 1e-10, 0);
        let far = Solid::ball(1.0) + Solid::ball(thin).translated(dvec3(3.0, 1.0, 2.0));
        assert_volume("speck", &far, ball_volume(1.0) + ball_volume(thin), 1e-10, 0);
        let cut = measured(&cut, 1e-9, 0);
        let other = measured(&(cube.clone() & Solid::ball(5.0)), 1e-9, 0);
        assert!(cut.value < other.value, "{cut:?}");
    }
}

#[test]
fn nothing_is_an_upper_bound_unless_it_is_known() {
    let ball = Solid::ball(1.0);
    let nothing = measured(&(ball.clone() - ball), 1e-9, 0);
    assert!(!nothing.resolved && !nothing.target_met, "{nothing:?}");
    assert!(nothing.interval[0] <= 0.0 && nothing.interval[1] > 0.0, "{nothing:?}");
    let known = measured(&Solid::empty(), 1e-9, 0);
    assert_eq!((known.value, known.rays, known.method), (0.0, 0, Method::Exact));
}

#[test]
fn unsuited_scenes_say_why() {
    let mesh = Solid::ball(2.0) - Solid::mesh(meshes::tetrahedron());
    let unsuited = measure::adaptive(&scene(&mesh), &Sampling::default());
    assert_eq!(unsuited, Err(Unsuited::Mesh { leaf: 1 }));
    let many = (0..11_u32)
        .map(|i| Solid::cuboid(DVec3::ONE).rotated(DVec3::ONE, 0.1 * f64::from(i)));
    let many = Scene::compile(&Solid::boolean(solidray::Op::Union, many));
    let unsuited =
        measure::adaptive(&many.expect("boxes"), &Sampling::default()).unwrap_err();
    assert_eq!(unsuited, Unsuited::TooManySurfaces);
    assert_eq!(unsuited.to_string(), "the leaves lie on more than 64 different surfaces");
}

/// Where there are too few rays or there is too little time lattices take over.
#[test]
fn limits_are_kept() {
    let (_, classic, exact) = textbook()
        .into_iter()
        .find(|(name, ..)| *name == "classic")
        .expect("it is there");
    let scene = scene(&classic);
    for max_rays in [4_000, 100_000, 400_000] {
        let sampling = Sampling { max_rays, ..sampling(1e-12, 0) };
        let few = measure::adaptive(&scene, &sampling).expect("few primitives");
        assert_eq!(few.method, Method::Lattice);
        assert!(!few.target_met && few.resolved, "{few:?}");
        assert!((few.value - exact).abs() < 2.5 * few.half_width(), "{few:?}");
        // At least one bunch of slices and one round of lattices.
        assert!(few.rays <= max_rays + 100_000, "{max_rays}: {few:?}");
    }
    let limit = Duration::from_millis(200);
    let sampling =
        Sampling { time_limit: Some(limit), max_rays: u64::MAX, ..sampling(1e-30, 0) };
    let start = Instant::now();
    let late = measure::adaptive(&scene, &sampling).expect("few primitives");
    assert!(start.elapsed() < 4 * limit, "{:?}", start.elapsed());
    assert!(!late.target_met, "{late:?}");
}

#[test]
fn equal_seeds_give_equal_bits() {
    let ring = Solid::ball(2.0) - rod(1.0, DVec3::Z).mapped(tilt());
    let value = |seed| measured(&ring, 1e-10, seed).value.to_bits();
    assert_eq!(value(3), value(3));
    assert_ne!(value(3), value(4));
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let ring = Solid::ball(2.0) - rod(1.0, DVec3::Z).mapped(tilt());
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a few threads can be had").install(|| measured(&ring, 1e-10, 5))
    };
    let one = with_threads(1);
    for threads in [2, 16] {
        assert_eq!(with_threads(threads), one, "{threads} threads");
    }
}
