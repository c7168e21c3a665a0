//! Volumes against closed forms, with fixed seeds.

#[expect(dead_code, reason = "volumes need no random rays")]
mod support;

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use glam::{DAffine3, DMat3, DVec3, dvec3};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use solidray::measure::{self, Method, Sampling, Verdict};
use solidray::{Scene, Solid, unwatched};
use support::{meshes, scene, strategies};

fn sampling(rel_tol: f64, max_rays: u64, seed: u64) -> Sampling {
    Sampling { rel_tol, max_rays, seed, ..Sampling::default() }
}

/// The value is near the truth for its interval, and the interval as narrow as asked for.
///
/// 2.5 half-widths are five standard errors: with fixed seeds a fault, not bad luck.
fn assert_volume(name: &str, solid: &Solid, exact: f64) {
    let estimate = measure::volume(&scene(solid), &sampling(1e-4, 1 << 20, 1));
    let error = (estimate.value - exact).abs();
    let rounding = 1e-12 * exact;
    assert!(
        error <= 2.5 * estimate.half_width() + rounding,
        "{name}: {estimate:?}, {exact}"
    );
    assert!(estimate.resolved && estimate.target_met, "{name}: {estimate:?}");
    assert!(estimate.half_width() <= 1e-4 * estimate.value, "{name}: {estimate:?}");
    let middle = f64::midpoint(estimate.interval[0], estimate.interval[1]);
    assert!((middle - estimate.value).abs() <= rounding, "{name}: {estimate:?}");
}

/// A cylinder of this radius about an axis, far longer than anything here.
fn rod(radius: f64, axis: DVec3) -> Solid {
    let upright = Solid::cylinder(radius, 20.0).translated(-10.0 * DVec3::Z);
    match axis {
        DVec3::X => upright.rotated(DVec3::Y, 0.5 * PI),
        DVec3::Y => upright.rotated(DVec3::X, 0.5 * PI),
        _ => upright,
    }
}

fn tilt() -> DAffine3 {
    DAffine3::from_axis_angle(dvec3(1.0, 2.0, -0.5).normalize(), 0.7)
}

#[test]
fn quadrics_have_their_textbook_volumes() {
    let (r, h) = (1.3, 2.1);
    assert_volume("ball", &Solid::ball(r), 4.0 / 3.0 * PI * r.powi(3));
    assert_volume(
        "ellipsoid",
        &Solid::ball(1.0).scaled(dvec3(1.0, 2.0, 0.3)).mapped(tilt()),
        4.0 / 3.0 * PI * 0.6,
    );
    assert_volume("cylinder", &Solid::cylinder(r, h), PI * r * r * h);
    assert_volume("lying", &Solid::cylinder(r, h).mapped(tilt()), PI * r * r * h);
    assert_volume("cone", &Solid::frustum(r, 0.0, h), PI * r * r * h / 3.0);
    assert_volume("upturned", &Solid::frustum(0.0, r, h), PI * r * r * h / 3.0);
    assert_volume(
        "frustum",
        &Solid::frustum(r, 0.4, h).mapped(tilt()),
        PI * h / 3.0 * (r * r + r * 0.4 + 0.16),
    );
    assert_volume(
        "paraboloid",
        &Solid::paraboloid(r, h).mapped(tilt()),
        PI * r * r * h / 2.0,
    );
    assert_volume(
        "one sheet",
        &Solid::hyperboloid_of_one_sheet(0.5, r, h),
        PI * h / 3.0 * (2.0 * 0.25 + r * r),
    );
    // ∫ π s² (z² − v²) dz from v to e, twice.
    let (v, s, e) = (0.4_f64, 0.8, 1.5_f64);
    assert_volume(
        "two sheets",
        &Solid::hyperboloid_of_two_sheets(v, s, 2.0 * e).mapped(tilt()),
        2.0 * PI * s * s * ((e.powi(3) - v.powi(3)) / 3.0 - v * v * (e - v)),
    );
}

#[test]
fn boxes_keep_their_volume_turned_and_sheared() {
    let brick = Solid::cuboid(dvec3(1.0, 2.0, 0.7));
    let shear = DMat3::from_cols(
        dvec3(1.0, 0.0, 0.0),
        dvec3(0.6, 1.0, 0.0),
        dvec3(-0.3, 0.8, 1.0),
    );
    assert_volume("straight", &brick, 1.4);
    assert_volume("turned", &brick.clone().mapped(tilt()), 1.4);
    assert_volume("sheared", &brick.clone().mapped(DAffine3::from_mat3(shear)), 1.4);
    assert_volume("mirrored", &brick.mirrored(dvec3(1.0, 1.0, 0.2)), 1.4);
}

#[test]
fn booleans_have_their_textbook_volumes() {
    let r = 0.9;
    let [x, y, z] = DVec3::AXES.map(|axis| rod(r, axis));
    assert_volume("two rods", &(x.clone() & y.clone()), 16.0 / 3.0 * r.powi(3));
    assert_volume("three rods", &(x & y & z), 8.0 * (2.0 - 2.0_f64.sqrt()) * r.powi(3));
    let (radius, h) = (2.0, 0.6);
    assert_volume(
        "cap",
        &(Solid::ball(radius) & Solid::half_space(-DVec3::Z, -(radius - h))),
        PI * h * h * (3.0 * radius - h) / 3.0,
    );
    // A ball with a bore leaves a ring whose volume depends on its height alone.
    let half: f64 = 1.1;
    let bore = (radius * radius - half * half).sqrt();
    assert_volume(
        "ring",
        &(Solid::ball(radius) - rod(bore, DVec3::Z)),
        PI * (2.0 * half).powi(3) / 6.0,
    );
}

#[test]
fn the_classic_scene_has_its_volume() {
    let (big, r) = (1.35_f64, 0.7_f64);
    let h = big - 1.0;
    let body = Solid::cuboid(DVec3::splat(2.0)) & Solid::ball(big);
    let rods = DVec3::AXES.map(|axis| rod(r, axis));
    let classic = rods.into_iter().fold(body, |body, rod| body - rod);
    let ball = 4.0 / 3.0 * PI * big.powi(3) - 6.0 * PI * h * h * (3.0 * big - h) / 3.0;
    let bored =
        6.0 * PI * r * r - 16.0 * r.powi(3) + 8.0 * (2.0 - 2.0_f64.sqrt()) * r.powi(3);
    assert_volume("classic", &classic, ball - bored);
    assert_volume("classic, tilted", &classic.mapped(tilt()), ball - bored);
}

#[test]
fn meshes_have_the_volume_of_the_divergence_theorem() {
    let jittered = meshes::jittered(&meshes::icosphere(2), 0.2, 3);
    for mesh in [meshes::tetrahedron(), meshes::octahedron(), meshes::prism(7), jittered]
    {
        let exact = mesh.volume();
        assert_volume("mesh", &Solid::mesh(mesh).mapped(tilt()), exact);
    }
    assert!((meshes::octahedron().volume() - 4.0 / 3.0).abs() < 1e-14);
    assert!((meshes::tetrahedron().volume() - 8.0 / 3.0).abs() < 1e-14);
}

#[test]
fn maps_scale_volumes_by_their_determinant() {
    let mut runner = TestRunner::deterministic();
    let cases = (strategies::placed_leaf(), strategies::map());
    for _ in 0..40 {
        let case = cases.new_tree(&mut runner).expect("nothing is rejected");
        let (model, map) = case.current();
        let measure =
            |solid: &Solid| measure::volume(&scene(solid), &sampling(1e-3, 1 << 17, 2));
        let (here, there) =
            (measure(&model.solid()), measure(&model.solid().mapped(map)));
        let factor = map.matrix3.determinant().abs();
        let error = (there.value - factor * here.value).abs();
        let width = there.half_width() + factor * here.half_width();
        assert!(
            error <= 2.0 * width + 1e-12 * there.value,
            "{model:?} {map:?}: {here:?} × {factor}, {there:?}"
        );
    }
}

#[test]
fn n39_too_small_to_be_seen_is_not_resolved() {
    let speck = Solid::cuboid(DVec3::splat(10.0)) - Solid::cuboid(DVec3::splat(20.0))
        + Solid::ball(0.01)
        + Solid::ball(0.01).translated(DVec3::splat(5.0));
    let few = measure::volume(&scene(&speck), &sampling(1e-4, 50_000, 0));
    let exact = 2.0 * 4.0 / 3.0 * PI * 1e-6;
    assert!(!few.resolved && !few.target_met, "{few:?}");
    assert!(few.interval[0] <= 0.0 && exact <= few.interval[1], "{few:?}");
}

#[test]
fn nothing_is_an_upper_bound_unless_it_is_known() {
    let ball = Solid::ball(1.0);
    let nothing =
        measure::volume(&scene(&(ball.clone() - ball)), &sampling(1e-4, 500_000, 0));
    assert!(!nothing.resolved && !nothing.target_met);
    assert_eq!((nothing.value, nothing.interval[0]), (0.0, 0.0));
    assert!(nothing.interval[1] > 0.0 && nothing.interval[1] < 1e-2, "{nothing:?}");
    let cube = Solid::cuboid(DVec3::splat(2.0));
    for known in [Solid::empty(), cube.clone() - cube] {
        let empty = measure::volume(&scene(&known), &Sampling::default());
        assert_eq!(
            (empty.value, empty.interval, empty.method),
            (0.0, [0.0; 2], Method::Exact)
        );
    }
}

/// The spread of sixteen lattices falls as the theory of their order says: like 1/N where a
/// chord rises steadily from a silhouette, and faster where it is made of straight pieces
/// alone, as that of a box along its edges is for rays that lean.
#[test]
fn n38_the_error_of_lattices_falls_like_1_over_n() {
    let tilted = Solid::cuboid(dvec3(1.0, 2.0, 0.7)).mapped(tilt());
    let rods = DVec3::AXES.map(|axis| rod(0.7, axis));
    let [x, y, z] = rods;
    let csg = (Solid::cuboid(DVec3::splat(2.0)) & Solid::ball(1.35)) - (x + y + z);
    for (name, solid) in [
        ("ball", Solid::ball(1.0)),
        ("box", Solid::cuboid(dvec3(1.0, 2.0, 0.7))),
        ("tilted box", tilted),
        ("csg", csg),
        ("shell", Solid::ball(1.0) - Solid::ball(0.9)),
    ] {
        let scene = scene(&solid);
        let spread = |most: u64| {
            let found =
                (0..4).map(|seed| measure::volume(&scene, &sampling(0.0, most, seed)));
            let widths: Vec<[f64; 2]> =
                found.map(|e| [e.rays as f64, e.half_width() / e.value]).collect();
            let mean = |k: usize| widths.iter().map(|w| w[k].ln()).sum::<f64>() / 4.0;
            [mean(0), mean(1)]
        };
        let points: Vec<[f64; 2]> = ROUNDS.into_iter().map(spread).collect();
        let order = slope(&points);
        assert!((-2.15..=-0.85).contains(&order), "{name}: {order:.3} of {points:?}");
    }
}

/// Limits of rays each of which lets one more lattice pass than the one before.
const ROUNDS: [u64; 5] = [4_000, 14_000, 40_000, 110_000, 290_000];

/// The slope of the line of least squares.
fn slope(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / n;
    let (x, y) = (mean(0), mean(1));
    let product: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    product / points.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>()
}

/// Of 1200 intervals of 95 %, about 1140 hold the truth: of those after a number of
/// rays, and of those that are as narrow as was asked for.
#[test]
fn n39_intervals_hold_the_truth_as_often_as_they_say() {
    let tilted = Solid::cuboid(dvec3(1.0, 2.0, 0.7)).mapped(tilt());
    let shell = Solid::ball(1.0) - Solid::ball(0.9);
    let rods = rod(1.0, DVec3::X) & rod(1.0, DVec3::Y);
    let solids = [
        ("ball", Solid::ball(1.0), 4.0 / 3.0 * PI),
        ("box", tilted, 1.4),
        ("shell", shell, 4.0 / 3.0 * PI * (1.0 - 0.729)),
        ("rods", rods, 16.0 / 3.0),
    ]
    .map(|(name, solid, exact)| (name, scene(&solid), exact));
    for (rel_tol, most) in [(1e-9, 4000), (1e-3, u64::MAX)] {
        let mut all = 0;
        for (name, scene, exact) in &solids {
            let holds = |seed: &u64| {
                let estimate = measure::volume(scene, &sampling(rel_tol, most, *seed));
                assert!(estimate.target_met || most < u64::MAX, "{estimate:?}");
                estimate.interval[0] <= *exact && *exact <= estimate.interval[1]
            };
            let held = (0..300).filter(holds).count();
            assert!((270..=297).contains(&held), "{name}, {rel_tol}: {held} of 300");
            all += held;
        }
        // Three standard errors.
        assert!((1117..=1163).contains(&all), "{rel_tol}: {all} of 1200");
    }
}

#[test]
fn other_seeds_give_other_answers_and_equal_seeds_equal_ones() {
    let scene = scene(&Solid::ball(1.0).mapped(tilt()));
    let value = |seed| measure::volume(&scene, &sampling(1e-3, 10_000, seed)).value;
    assert_eq!(value(3).to_bits(), value(3).to_bits());
    assert_ne!(value(3).to_bits(), value(4).to_bits());
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let ring = Solid::ball(2.0) - rod(1.0, dvec3(0.0, 0.0, 1.0)).mapped(tilt());
    let scene = scene(&ring);
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.expect("a few threads can be had");
        pool.install(|| measure::volume(&scene, &sampling(1e-9, 1 << 17, 5)))
    };
    let one = with_threads(1);
    assert!(one.rays > 100_000);
    for threads in [2, 16] {
        assert_eq!(with_threads(threads), one, "{threads} threads");
    }
}

#[test]
fn n41_more_rays_make_narrower_intervals() {
    let scene = scene(&(Solid::ball(2.0) - rod(1.0, DVec3::Z)).mapped(tilt()));
    let median = |most: u64| {
        let widths = (0..15)
            .map(|seed| measure::volume(&scene, &sampling(0.0, most, seed)).half_width());
        let mut widths: Vec<f64> = widths.collect();
        widths.sort_by(f64::total_cmp);
        widths[7]
    };
    let medians: Vec<f64> = ROUNDS.into_iter().map(median).collect();
    assert!(medians.is_sorted_by(|a, b| a > b), "{medians:?}");
}

/// A limit of time is held to a part of itself that no busy machine breaks.
#[test]
fn n41_limits_of_rays_and_time_are_kept() {
    let scene = scene(&Solid::ball(1.0));
    for max_rays in [10_000, 100_000, 1_000_000] {
        let estimate = measure::volume(&scene, &sampling(0.0, max_rays, 0));
        assert!(!estimate.target_met);
        assert!(
            estimate.rays <= max_rays && estimate.rays > max_rays / 4,
            "{estimate:?}"
        );
    }
    let limit = Duration::from_millis(300);
    let start = Instant::now();
    let sampling = Sampling { time_limit: Some(limit), ..sampling(0.0, u64::MAX, 0) };
    let estimate = measure::volume(&scene, &sampling);
    assert!(!estimate.target_met && estimate.resolved);
    assert!(start.elapsed() < 10 * limit, "{:?}", start.elapsed());
}

#[test]
fn progress_counts_every_ray_once() {
    let scene = scene(&Solid::ball(1.0));
    let count = std::sync::atomic::AtomicU64::new(0);
    let add = |rays| {
        count.fetch_add(rays, std::sync::atomic::Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    let estimate = measure::volume_with(&scene, &sampling(1e-4, 1 << 18, 0), &add);
    assert_eq!(count.into_inner(), estimate.rays);
}

fn compare(a: &Solid, b: &Solid, tolerance: f64) -> measure::Comparison {
    measure::compare(a, b, tolerance, &sampling(1e-3, 1 << 19, 0), &unwatched)
        .expect("both solids are right")
}

#[test]
fn equal_solids_are_the_same() {
    let solid = Solid::ball(2.0) - rod(1.0, DVec3::X);
    let same = compare(&solid, &solid.clone(), 1e-3);
    assert_eq!(same.verdict, Verdict::Same);
    assert_eq!((same.iou.value, same.iou.interval[1]), (1.0, 1.0));
    assert_eq!((same.difference.value, same.worst), (0.0, None));
    let empty = compare(&Solid::empty(), &Solid::empty(), 0.0);
    assert_eq!((empty.verdict, empty.iou.value), (Verdict::Same, 1.0));
}

#[test]
fn a_shifted_box_differs_by_what_it_was_shifted() {
    let a = Solid::cuboid(dvec3(4.0, 2.0, 1.0)).mapped(tilt());
    let b = Solid::cuboid(dvec3(4.0, 2.0, 1.0))
        .translated(dvec3(0.5, 0.0, 0.0))
        .mapped(tilt());
    let found = compare(&a, &b, 1e-2);
    assert_eq!(found.verdict, Verdict::Different);
    for (name, estimate, exact) in [
        ("a", found.a, 8.0),
        ("b", found.b, 8.0),
        ("a − b", found.a_minus_b, 1.0),
        ("b − a", found.b_minus_a, 1.0),
        ("difference", found.difference, 2.0),
        ("iou", found.iou, 7.0 / 9.0),
    ] {
        let error = (estimate.value - exact).abs();
        assert!(error <= 2.5 * estimate.half_width(), "{name}: {estimate:?}");
        assert!(estimate.half_width() < 1e-2 * exact, "{name}: {estimate:?}");
    }
    let worst = found.worst.expect("they differ");
    assert!((worst.from.distance(worst.to) - worst.length).abs() < 1e-9);
    let middle = 0.5 * (worst.from + worst.to);
    let (only, other) = if worst.in_a { (a, b) } else { (b, a) };
    assert!(scene(&only).contains(middle) && !scene(&other).contains(middle));
}

#[test]
fn the_worst_place_is_where_the_bump_is() {
    let plate = Solid::cuboid(dvec3(4.0, 4.0, 10.0));
    let bumped = plate.clone() - Solid::ball(0.5).translated(dvec3(1.0, -1.0, 2.0));
    let worst = compare(&plate, &bumped, 1e-6).worst.expect("there is a hole");
    assert!(worst.in_a);
    assert!(worst.length <= 1.0 + 1e-9 && worst.length > 0.95, "{worst:?}");
    let middle = 0.5 * (worst.from + worst.to);
    assert!(middle.distance(dvec3(1.0, -1.0, 2.0)) < 0.2, "{worst:?}");
}

#[test]
fn a_ball_differs_from_its_facets_by_what_they_cut_off() {
    let mesh = meshes::icosphere(3);
    let exact = 4.0 / 3.0 * PI - mesh.volume();
    let found = compare(&Solid::ball(1.0), &Solid::mesh(mesh), 1e-3);
    assert_eq!(found.verdict, Verdict::Different);
    let error = (found.difference.value - exact).abs();
    assert!(
        error <= 2.5 * found.difference.half_width(),
        "{:?}, {exact}",
        found.difference
    );
    assert!(found.b_minus_a.value <= 0.0);
    let loose = compare(&Solid::ball(1.0), &Solid::mesh(meshes::icosphere(3)), 0.1);
    assert_eq!(loose.verdict, Verdict::Same);
}

/// A scene is shared by threads and outlives what it was compiled from.
#[test]
fn scenes_are_shared_between_threads() {
    fn assert_shared<T: Send + Sync + 'static>(_: &T) {}
    let scene: Scene = scene(&Solid::ball(1.0));
    assert_shared(&scene);
}
