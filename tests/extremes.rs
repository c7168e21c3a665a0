//! Precision where it is hardest: far away, at grazes, near apexes, at odd scales.
//!
//! All rays have coordinates that are exact in binary, so the right answers are known to
//! the last digit. u = 2⁻⁵³ is the rounding unit.

#![expect(clippy::float_cmp, reason = "scaling by powers of two rounds nothing")]

#[expect(dead_code, reason = "extremes are chosen, not drawn by lot")]
mod support;

use glam::{DAffine3, DVec3, dvec3};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use solidray::{Op, Ray, Scene, Solid, measure, unwatched};
use support::model::Model;
use support::strategies::{aims, direction, model, place, placed_leaf};
use support::{along_x, ends, ends_in, scene, spans};

const U: f64 = 0.5 * f64::EPSILON;

/// Positions are exact to eight rounding units of the largest length at hand: twice the
/// worst of numerous trials of roots from a re-centred origin.
fn assert_at(found: &[[f64; 2]], exact: [f64; 2], length: f64, largest: f64, what: &str) {
    assert_eq!(found.len(), 1, "{what}: {found:?} instead of {exact:?}");
    for (found, exact) in found[0].into_iter().zip(exact) {
        let error = (found - exact).abs() * length;
        assert!(error <= 8.0 * U * largest, "{what}: {found} − {exact}: {error:e}");
    }
}

/// Rays of direction (3, 4, 12) or (3, 4, 0) at up to 0.94 of a radius of 1 from the
/// middle, from `far` directions away. In plane (3, 4) they are moved by `side` (4, −3).
fn offsets() -> impl Iterator<Item = f64> {
    (-48..=48).map(|i| f64::from(i) / 256.0)
}

#[test]
fn a_ball_is_hit_from_as_far_as_1e12_radii() {
    let (ball, dir) = (scene(&Solid::ball(1.0)), dvec3(3.0, 4.0, 12.0));
    for power in 0..=40 {
        let far = 2.0_f64.powi(power);
        for side in offsets() {
            let ray = Ray::new(side * dvec3(4.0, -3.0, 0.0) - far * dir, dir);
            let half = (1.0 - 25.0 * side * side).sqrt() / 13.0;
            let what = format!("from {far} at {side}");
            let exact = [far - half, far + half];
            assert_at(&ends_in(&ball, &ray), exact, 13.0, 13.0 * far + 1.0, &what);
        }
    }
}

#[test]
fn a_ball_is_hit_in_a_scene_1e12_times_as_large() {
    let dir = dvec3(3.0, 4.0, 12.0);
    for power in 4..=40 {
        let far = 2.0_f64.powi(power);
        let speck = Solid::cuboid(DVec3::ONE).translated(2.0 * far * dir);
        let large = scene(&(Solid::ball(1.0) + speck));
        for side in offsets() {
            let ray = Ray::new(side * dvec3(4.0, -3.0, 0.0), dir);
            let half = (1.0 - 25.0 * side * side).sqrt() / 13.0;
            let list = ends_in(&large, &ray);
            let what = format!("far {far}, {side}");
            assert_at(&list[..1], [-half, half], 13.0, 26.0 * far, &what);
        }
    }
}

#[test]
fn a_cylinder_is_hit_from_as_far_as_1e12_radii() {
    let (rod, dir) = (scene(&Solid::cylinder(1.0, 2.0)), dvec3(3.0, 4.0, 0.0));
    for power in 0..=40 {
        let far = 2.0_f64.powi(power);
        for side in offsets() {
            let ray = Ray::new(dvec3(4.0 * side, -3.0 * side, 1.0) - far * dir, dir);
            let half = (1.0 - 25.0 * side * side).sqrt() / 5.0;
            let exact = [far - half, far + half];
            let what = format!("from {far} at {side}");
            assert_at(&ends_in(&rod, &ray), exact, 5.0, 5.0 * far + 1.0, &what);
        }
    }
}

#[test]
fn a_cone_is_hit_from_as_far_as_1e12_radii() {
    // At half its height this cone has radius 1.
    let (cone, dir) = (scene(&Solid::frustum(2.0, 0.0, 2.0)), dvec3(3.0, 4.0, 0.0));
    for power in 0..=40 {
        let far = 2.0_f64.powi(power);
        for side in offsets() {
            let ray = Ray::new(dvec3(4.0 * side, -3.0 * side, 1.0) - far * dir, dir);
            let half = (1.0 - 25.0 * side * side).sqrt() / 5.0;
            let exact = [far - half, far + half];
            let what = format!("from {far} at {side}");
            assert_at(&ends_in(&cone, &ray), exact, 5.0, 5.0 * far + 2.0, &what);
        }
    }
}

#[test]
fn a_cone_is_exact_beside_its_apex() {
    let cone = scene(&Solid::frustum(0.0, 1.0, 1.0));
    for power in 1..=100 {
        let near = 2.0_f64.powi(-power);
        for part in [0.0, 0.5, 0.75] {
            let ray = Ray::new(dvec3(0.0, part * near, near), DVec3::X);
            let half = near * (1.0_f64 - part * part).sqrt();
            let what = format!("{near} from the apex at {part}");
            // The reference point rounds to steps of the scene, exactly here.
            assert_at(&ends_in(&cone, &ray), [-half, half], 1.0, near, &what);
        }
    }
}

/// The middle of the rod is far from where the line passes it, the vertex of the parabola
/// is not.
#[test]
fn a_rod_1e12_radii_long_is_hit_at_its_end() {
    for power in 4..=40 {
        let height = 2.0_f64.powi(power);
        let rod = scene(&Solid::cylinder(1.0, height));
        for side in offsets() {
            let through = dvec3(4.0 * side, -3.0 * side, 15.0 / 16.0 * height);
            let ray = Ray::new(through, dvec3(3.0, 4.0, 1.0));
            let half = (1.0 - 25.0 * side * side).sqrt() / 5.0;
            let what = format!("{height} high at {side}");
            assert_at(&ends_in(&rod, &ray), [-half, half], 5.0, height, &what);
        }
    }
}

/// Through (4 s, −3 s, 1) e along (3, 4, 1) the cone x² + y² ≤ z² is met where
/// 24 t² − 2 e t = e² (1 − 25 s²).
#[test]
fn an_oblique_line_near_an_apex_is_exact() {
    let cone = scene(&Solid::frustum(0.0, 1.0, 1.0));
    for power in 4..=40 {
        let near = 2.0_f64.powi(-power);
        for side in offsets() {
            let through = near * dvec3(4.0 * side, -3.0 * side, 1.0);
            let ray = Ray::new(through, dvec3(3.0, 4.0, 1.0));
            let root = (25.0 - 600.0 * side * side).sqrt();
            let exact = [(1.0 - root) / 24.0 * near, (1.0 + root) / 24.0 * near];
            let what = format!("{near} from the apex at {side}");
            assert_at(&ends_in(&cone, &ray), exact, 5.0, 1.0, &what);
        }
    }
}

#[test]
fn through_an_apex_exactly_there_is_one_span_or_none() {
    let cone = scene(&Solid::frustum(0.0, 1.0, 1.0));
    for (dir, count) in [
        (DVec3::Z, 1),
        (dvec3(0.5, 0.0, 1.0), 1),
        (dvec3(-0.25, 0.5, 1.0), 1),
        (DVec3::X, 0),
        (dvec3(1.0, 0.5, 0.25), 0),
        (dvec3(1.0, 0.0, 1.0), 0),
    ] {
        for dir in [dir, -dir] {
            let list = ends_in(&cone, &Ray::new(DVec3::ZERO, dir));
            assert_eq!(list.len(), count, "{dir}: {list:?}");
        }
    }
}

/// A chord at 1 − δ of the radius is √(δ (2 − δ)) long on either side, and one rounding of
/// the data moves that by u / δ of itself.
#[test]
fn grazing_chords_are_as_exact_as_their_data() {
    for solid in [Solid::ball(1.0), Solid::cylinder(1.0, 2.0)] {
        let solid = scene(&solid);
        for power in 1..=52 {
            let graze = 2.0_f64.powi(-power);
            let ray = Ray::new(dvec3(0.0, 1.0 - graze, 0.0), DVec3::X);
            let list = ends_in(&solid, &ray);
            let half = (graze * (2.0 - graze)).sqrt();
            let near = half * (4.0 * U / graze + 8.0 * U);
            assert_eq!(list.len(), 1, "{graze:e}");
            assert!((list[0][1] - half).abs() <= near, "{graze:e}: {list:?}, {half}");
            assert!((list[0][0] + half).abs() <= near, "{graze:e}: {list:?}, {half}");
        }
        assert!(ends_in(&solid, &along_x(1.0, 0.0)).is_empty(), "tangent");
        assert!(ends_in(&solid, &along_x(1.0 + f64::EPSILON, 0.0)).is_empty());
    }
}

#[test]
fn a_line_almost_along_a_cylinder_is_as_exact_as_any() {
    let long = Solid::cylinder(1.0, 2.0_f64.powi(60)).translated(dvec3(
        0.0,
        0.0,
        -(2.0_f64.powi(59)),
    ));
    let long = scene(&long);
    for power in 0..=40 {
        let slant = 2.0_f64.powi(-power);
        let list = ends_in(&long, &Ray::new(DVec3::ZERO, dvec3(slant, 0.0, 1.0)));
        assert_eq!(list.len(), 1, "{slant:e}");
        assert!((list[0][1] * slant - 1.0).abs() <= 8.0 * U, "{slant:e}: {list:?}");
        assert!((list[0][0] * slant + 1.0).abs() <= 8.0 * U, "{slant:e}: {list:?}");
    }
    let along = ends_in(&long, &Ray::new(dvec3(0.5, 0.5, 0.0), DVec3::Z));
    assert_eq!(along, [[-(2.0_f64.powi(59)), 2.0_f64.powi(59)]]);
}

/// Factors that are no powers of two round the map, the sizes and the ray.
#[test]
fn n14_scenes_scaled_by_1e6_give_the_same_leaves_and_places_within_8_u() {
    let (mut compared, mut beyond) = (0, 0);
    for (model, scene_of_one, ray) in clear_cases(500) {
        for factor in [1e6, 1e-6] {
            let grow = DAffine3::from_scale(DVec3::splat(factor));
            let scaled = scene(&model.solid().mapped(grow));
            let image = Ray::new(factor * ray.origin, factor * ray.dir);
            let (plain, there) = (spans(&scene_of_one, &ray), spans(&scaled, &image));
            assert_eq!(plain.len(), there.len(), "{factor:e} {ray:?} {model:?}");
            for (a, b) in plain.iter().zip(&there) {
                for (a, b) in [(a.enter, b.enter), (a.exit, b.exit)] {
                    assert_eq!((a.leaf, a.face, a.sense), (b.leaf, b.face, b.sense));
                    let normal = scene_of_one.normal_at(&ray, &a);
                    let cosine = normal.dot(ray.dir).abs() / ray.speed();
                    let lengths = length_at_hand(&scene_of_one, &ray) / ray.speed();
                    let units = (a.t - b.t).abs() * cosine / (U * (a.t.abs() + lengths));
                    // One draw of a hyperboloid, which a line meets almost along its asymptote, is at
                    // 8.9 u for both factors; its stated error is 24 times as large.
                    let is_hyperboloid =
                        scene_of_one.leaf(a.leaf).kind.starts_with("hyper");
                    beyond += u32::from(units > 8.0);
                    let most = if is_hyperboloid { 9.0 } else { 8.0 };
                    assert!(units <= most, "{units}: {a:?} {b:?} {ray:?}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 300 && beyond <= 2, "{beyond} of {compared}");
}

#[test]
fn n14_scenes_scaled_by_a_power_of_two_give_the_same_bits() {
    let mut runner = TestRunner::deterministic();
    let cases = (model(), aims());
    for _ in 0..200 {
        let case = cases.new_tree(&mut runner).expect("nothing is rejected").current();
        let (model, aims) = case;
        let plain = scene(&model.solid());
        for power in [-200, -30, 30, 200] {
            let factor = 2.0_f64.powi(power);
            let grow = DAffine3::from_scale(DVec3::splat(factor));
            let scaled = scene(&model.solid().mapped(grow));
            for ray in aims.iter().map(|aim| aim.ray(&model)) {
                let image = Ray::new(factor * ray.origin, factor * ray.dir);
                assert_eq!(ends_in(&plain, &ray), ends_in(&scaled, &image), "{factor:e}");
            }
        }
    }
}

/// Squares of volumes are no numbers long before volumes are none.
#[test]
fn n14_measures_scale_by_powers_of_two_to_the_bit() {
    let sampling = measure::Sampling { rel_tol: 1e-3, ..measure::Sampling::default() };
    let part = Solid::cuboid(dvec3(3.0, 2.0, 1.0)) - Solid::ball(0.9)
        + Solid::frustum(1.0, 0.3, 2.0).rotated(dvec3(1.0, 2.0, 3.0), 0.7);
    let other = part.clone() - Solid::cylinder(0.3, 5.0);
    // Far apart, so that each is measured in a box of its own.
    let apart = [0.0, 1000.0, 3000.0].map(|x| part.clone().translated(x * DVec3::X));
    let apart = Solid::boolean(Op::Union, apart);
    let volumes = measure::volume(&scene(&apart), &sampling);
    let volume = measure::volume(&scene(&part), &sampling);
    let whole = measure::properties(&scene(&part), &sampling, &unwatched);
    let compared =
        measure::compare(&part, &other, 1e-3, &sampling, &unwatched).expect("solids");
    assert!(volume.target_met && volume.half_width() > 0.0);
    for power in [-300, -190, 190, 300] {
        let factor = 2.0_f64.powi(power);
        let grown = |solid: &Solid| solid.clone().scaled(DVec3::splat(factor));
        let by = |k: i32, x: f64| x * 2.0_f64.powi(k * power);
        let found = measure::volume(&scene(&grown(&part)), &sampling);
        assert_eq!(found.value, by(3, volume.value), "{power}");
        assert_eq!(found.interval, volume.interval.map(|x| by(3, x)), "{power}");
        let found = measure::volume(&scene(&grown(&apart)), &sampling);
        // One more map moves the boxes by a rounding.
        for (found, plain) in found.interval.into_iter().zip(volumes.interval) {
            assert!((found / by(3, plain) - 1.0).abs() < 1e-14, "{power}");
        }
        assert_eq!((found.rays, found.target_met), (volumes.rays, true), "{power}");
        let found =
            measure::compare(&grown(&part), &grown(&other), 1e-3, &sampling, &unwatched)
                .expect("solids");
        let none = compared.b_minus_a.interval.map(|x| by(3, x));
        assert_eq!(found.b_minus_a.interval, none, "{power}");
        assert_eq!(
            found.difference.interval,
            compared.difference.interval.map(|x| by(3, x)),
            "{power}"
        );
        assert_eq!(found.iou, compared.iou, "{power}");
        if power.abs() < 200 {
            let found = measure::properties(&scene(&grown(&part)), &sampling, &unwatched);
            assert_eq!(
                found.area.interval,
                whole.area.interval.map(|x| by(2, x)),
                "{power}"
            );
            let moment = |p: &measure::Properties| {
                p.body.as_ref().expect("it has mass").principal[0].moment.interval
            };
            assert_eq!(moment(&found), moment(&whole).map(|x| by(5, x)), "{power}");
        }
    }
}

/// Lines that are clear of edges and grazes.
fn clear_cases(count: u32) -> impl Iterator<Item = (Model, Scene, Ray)> {
    let mut runner = TestRunner::deterministic();
    let cases = (placed_leaf(), place(), direction());
    std::iter::repeat_with(move || {
        let case = cases.new_tree(&mut runner).expect("nothing is rejected");
        let (model, through, dir) = case.current();
        let scene = scene(&model.solid());
        let ray = Ray::new(through - 3.0 * dir, dir);
        (model, scene, ray)
    })
    .take(count as usize)
    .filter(|(_, scene, ray)| {
        let spans = spans(scene, ray);
        let mut ends = spans.iter().flat_map(|s| [s.enter, s.exit]);
        ends.all(|c| scene.error_at(ray, &c) * ray.speed() < 1e-12)
    })
}

/// The largest coordinate that is at hand along a ray.
fn length_at_hand(scene: &Scene, ray: &Ray) -> f64 {
    let bounds = scene.bounds();
    bounds.min.abs().max(bounds.max.abs()).max_element() + ray.origin.length()
}

#[test]
fn n11_moving_the_origin_back_by_2_to_the_k_keeps_lengths_within_4_u_of_the_way() {
    let mut compared = 0;
    for (_, scene, ray) in clear_cases(500) {
        let plain = spans(&scene, &ray);
        for power in 0..=30 {
            let back = 2.0_f64.powi(power);
            let moved = Ray::new(ray.origin - back * ray.dir, ray.dir);
            // The origin itself is rounded, and the line with it.
            let aside = (moved.origin + back * ray.dir - ray.origin).length()
                + U * moved.origin.length();
            let there = spans(&scene, &moved);
            if there.len() != plain.len() {
                continue;
            }
            for (a, b) in plain.iter().zip(&there) {
                let doubt: f64 = [a.enter, a.exit]
                    .iter()
                    .map(|c| {
                        let cosine = scene.normal_at(&ray, c).dot(ray.dir) / ray.speed();
                        2.0 * scene.error_at(&ray, c)
                            + 2.0 * aside / ray.speed() / cosine.abs()
                    })
                    .sum();
                let error = (a.length() - b.length()).abs();
                assert!(error <= 4.0 * U * back + doubt, "{back}: {a:?} {b:?} {ray:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 3000, "{compared}");
}

#[test]
fn n12_zeros_of_either_sign_and_the_smallest_numbers_are_directions_like_others() {
    let solid = Solid::cuboid(DVec3::splat(2.0)) - Solid::cylinder(0.5, 3.0)
        + Solid::mesh(support::meshes::octahedron()).translated(dvec3(2.0, 0.0, 0.0));
    let scene = scene(&solid);
    for (y, z) in [(0.25, 0.25), (1.0, 1.0), (0.0, 0.0), (-1.0, 0.5), (0.5, -1.0)] {
        let list = |dy: f64, dz: f64| {
            ends_in(&scene, &Ray::new(dvec3(-10.0, y, z), dvec3(1.0, dy, dz)))
        };
        let level = list(0.0, 0.0);
        assert_eq!(level, list(-0.0, 0.0));
        assert_eq!(level, list(0.0, -0.0));
        // Too small to move the line by a bit, except off a face that it lies in.
        for tiny in [1e-300, -1e-300, 5e-324, -5e-324] {
            let moved = list(tiny, -tiny);
            assert!(
                moved == level || y.abs() >= 1.0 || z.abs() >= 1.0 || y == 0.0,
                "{moved:?}"
            );
        }
    }
}

#[test]
fn n13_directions_may_be_as_long_or_short_as_they_like() {
    for length in [1e-300, 1e-100, 1e100, 1e300] {
        let ray = Ray::new(dvec3(-10.0, 0.0, 0.0), dvec3(length, 0.0, 0.0));
        let list = ends(&Solid::ball(1.0), &ray);
        let exact = [9.0 / length, 11.0 / length];
        assert_at(&list, exact, length, 22.0, &format!("{length:e}"));
    }
}

/// Sizes by parameters or by a map, alone and in a scene 1e200 times as large.
#[test]
fn n13_solids_may_be_as_long_or_short_as_they_like() {
    let kinds = |size: f64| {
        [
            Solid::ball(size),
            Solid::cylinder(size, size),
            Solid::frustum(size, 0.0, size),
            Solid::paraboloid(size, size),
            Solid::hyperboloid_of_one_sheet(0.5 * size, size, 2.0 * size),
            Solid::hyperboloid_of_two_sheets(0.25 * size, 1.0, 3.0 * size),
            Solid::cuboid(DVec3::splat(2.0 * size)),
        ]
    };
    for (i, plain) in kinds(1.0).into_iter().enumerate() {
        let ray = Ray::new(dvec3(-5.0, 0.125, 0.0625), dvec3(1.0, 0.03125, 0.125));
        let exact = ends(&plain, &ray);
        assert!(!exact.is_empty(), "{i}");
        for power in [-400, -333, 333, 400] {
            let size = 2.0_f64.powi(power);
            let map = DAffine3::from_scale(DVec3::splat(size));
            let there = Ray::new(size * ray.origin, ray.dir);
            let scaled: Vec<_> =
                exact.iter().map(|span| span.map(|t| t * size)).collect();
            assert_eq!(ends(&plain.clone().mapped(map), &there), scaled, "{i}");
            assert_eq!(ends(&kinds(size)[i], &there), scaled, "{i}");
            // One is a speck on the other.
            let both = scene(&(kinds(size)[i].clone() + plain.clone()));
            let list =
                ends_in(&both, &Ray::new(DVec3::splat(-9.0 * size.max(1.0)), DVec3::ONE));
            assert!(list.iter().flatten().all(|t| t.is_finite()), "{i}: {list:?}");
        }
    }
}
