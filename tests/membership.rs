//! In, out and on: what is said of points, and how sure it is.

#[expect(dead_code, reason = "few helpers are needed for points")]
mod support;

use glam::{DAffine3, DVec3, dvec3};
use proptest::prelude::*;
use solidray::Membership::{In, On, Out};
use solidray::{Membership, Ray, Scene, Solid};
use support::dice::Dice;
use support::strategies::{aims, model, place};
use support::{meshes, scene, spans};

fn unit_box() -> Solid {
    Solid::cuboid_between(DVec3::ZERO, DVec3::ONE)
}

fn beside(offset: DVec3) -> Solid {
    unit_box().translated(offset)
}

fn at(scene: &Scene, point: DVec3) -> Membership {
    scene.tracer().classify(point)
}

#[test]
fn corners_edges_and_faces_are_on() {
    let mut dice = Dice::new(21);
    for _ in 0..200 {
        let map =
            DAffine3::from_mat3_translation(dice.rotation(), 100.0 * dice.point(1.0))
                * DAffine3::from_scale(dvec3(0.01, 1.0, 30.0));
        let solids =
            [unit_box(), Solid::mesh(meshes::grid_box(DVec3::ZERO, DVec3::ONE, 2))];
        for solid in solids {
            let scene = scene(&solid.mapped(map));
            for [x, y, z] in
                [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.5, 1.0, 0.0], [0.25, 0.7, 1.0]]
            {
                assert_eq!(at(&scene, map.transform_point3(dvec3(x, y, z))), On);
            }
            assert_eq!(at(&scene, map.transform_point3(dvec3(0.5, 0.5, 0.5))), In);
            assert_eq!(at(&scene, map.transform_point3(dvec3(0.5, 0.5, 1.0001))), Out);
        }
    }
}

#[test]
fn walls_rims_and_apexes_are_on() {
    let cone = scene(&Solid::frustum(2.0, 0.0, 2.0));
    for p in
        [dvec3(0.0, 0.0, 2.0), dvec3(2.0, 0.0, 0.0), dvec3(0.6, 0.8, 1.0), DVec3::ZERO]
    {
        assert_eq!(at(&cone, p), On, "{p}");
    }
    for p in [dvec3(0.0, 0.0, 1.999), dvec3(0.0, 0.0, 2.001), dvec3(1.0, 0.0, 1.001)] {
        assert_ne!(at(&cone, p), On, "{p}");
    }
    // A line through these passes the ball without touching it, or just so.
    let ball = scene(&Solid::ball(1.0));
    let mut dice = Dice::new(22);
    for _ in 0..2000 {
        let d = dice.direction();
        assert_eq!(at(&ball, d), On);
        assert_eq!((at(&ball, 0.999_999 * d), at(&ball, 1.000_001 * d)), (In, Out));
    }
}

/// The planes of faces go on where the faces end.
#[test]
fn points_beside_a_face_in_its_plane_are_not_on() {
    let ball = meshes::icosphere(1);
    let scene = scene(&Solid::mesh(ball.clone()));
    for face in ball.faces() {
        let [a, b, c] = face.map(|i| ball.points()[i as usize]);
        assert_eq!(at(&scene, (a + b + c) / 3.0), On);
        assert_eq!(at(&scene, a + 0.25 * (b - a)), On);
        assert_eq!(at(&scene, b + 0.7 * (b - a) + 0.1 * (c - a)), Out);
        assert_eq!(at(&scene, a + 1e-9 * (2.0 * a - b - c)), Out);
    }
}

/// The boundary is that of the solid, not of its leaves.
#[test]
fn points_on_buried_and_shared_faces_are_inside() {
    let middle = dvec3(1.0, 0.5, 0.5);
    assert_eq!(at(&scene(&unit_box()), middle), On);
    assert_eq!(at(&scene(&(unit_box() + beside(DVec3::X))), middle), In);
    assert_eq!(at(&scene(&(unit_box() + beside(0.5 * DVec3::X))), middle), In);
    assert_eq!(at(&scene(&(unit_box() - beside(DVec3::X))), middle), On);
    assert_eq!(at(&scene(&(beside(DVec3::X) - unit_box())), middle), On);
    assert_eq!(at(&scene(&(unit_box() - unit_box())), middle), Out);
    assert_eq!(at(&scene(&(unit_box() & beside(DVec3::X))), middle), Out);
    // Four boxes around an edge, and three.
    let around = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y].map(beside);
    let edge = dvec3(1.0, 1.0, 0.5);
    let all = around.iter().skip(1).fold(around[0].clone(), |a, b| a + b.clone());
    let three = around.iter().skip(2).fold(around[0].clone(), |a, b| a + b.clone());
    assert_eq!((at(&scene(&all), edge), at(&scene(&three), edge)), (In, On));
    // Two that touch along it.
    assert_eq!(at(&scene(&(around[0].clone() + around[3].clone())), edge), On);
}

#[test]
fn points_that_are_no_points_are_outside() {
    let scene = scene(&unit_box());
    for p in [DVec3::NAN, DVec3::INFINITY, DVec3::splat(1e300)] {
        assert_eq!(at(&scene, p), Out);
    }
}

proptest! {
    /// The band of doubt is far thinner than what the formula is unsure about.
    #[test]
    fn n33_points_are_classified_as_the_formula_says(
        model in model(),
        points in prop::collection::vec(place(), 1..20),
    ) {
        let scene = scene(&model.solid());
        let mut tracer = scene.tracer();
        let features = model.features().into_iter().map(|f| f.point * 0.999);
        for p in points.into_iter().chain(features) {
            let class = tracer.classify(p);
            match model.holds(p) {
                Some(true) => prop_assert_eq!(class, In, "{}", p),
                Some(false) => prop_assert_eq!(class, Out, "{}", p),
                None => {}
            }
            prop_assert!(class == On || (class == In) == tracer.contains(p), "{}", p);
        }
    }

    /// What a ray says and what is said of the points on it is one thing.
    #[test]
    fn n33_points_of_rays_are_what_the_spans_say(model in model(), aims in aims()) {
        let scene = scene(&model.solid());
        let mut tracer = scene.tracer();
        for ray in aims.iter().map(|aim| aim.ray(&model)) {
            let list = spans(&scene, &ray);
            for span in &list {
                let (a, b) = (scene.error_at(&ray, &span.enter), scene.error_at(&ray, &span.exit));
                let middle = f64::midpoint(span.enter.t, span.exit.t);
                if span.length() > 4.0 * (a + b) {
                    prop_assert_ne!(tracer.classify(ray.at(middle)), Out, "{:?} {:?}", ray, span);
                }
            }
            for pair in list.windows(2) {
                let (a, b) = (pair[0].exit, pair[1].enter);
                let sure = 4.0 * (scene.error_at(&ray, &a) + scene.error_at(&ray, &b));
                if b.t - a.t > sure {
                    let middle = ray.at(f64::midpoint(a.t, b.t));
                    prop_assert_ne!(tracer.classify(middle), In, "{:?} {:?}", ray, pair);
                }
            }
        }
    }

    /// A point before a crossing is on the side from which the ray comes.
    #[test]
    fn n34_a_step_back_is_before_the_crossing(model in model(), aims in aims()) {
        let scene = scene(&model.solid());
        let mut tracer = scene.tracer();
        for ray in aims.iter().map(|aim| aim.ray(&model)) {
            let Some(span) = spans(&scene, &ray).first().copied() else { continue };
            let p = scene.point_before(&ray, &span.enter);
            prop_assert!((p - ray.origin).dot(ray.dir) <= span.enter.t * ray.dir.length_squared());
            if scene.error_at(&ray, &span.enter) < 1e-9 {
                // The ray may run in a face of another leaf all the way.
                prop_assert_ne!(tracer.classify(p), In, "{:?} {:?}", ray, span);
            }
        }
    }
}

/// A chord of a ball with one end moved by less than rounding is counted; others are not.
#[test]
fn thin_spans_are_counted_as_uncertain() {
    let count = |solid: &Solid, ray: &Ray| {
        let scene = scene(solid);
        let mut tracer = scene.tracer();
        let spans = tracer.spans(ray).len();
        (spans, tracer.uncertain(ray))
    };
    let along = |y: f64| Ray::new(dvec3(-5.0, y, 0.5), DVec3::X);
    assert_eq!(count(&unit_box(), &along(0.5)), (1, 0));
    let film =
        |width: f64| beside(dvec3(-1.0, 0.0, 0.0)) + beside(dvec3(width, 0.0, 0.0));
    assert_eq!(count(&film(1e-9), &along(0.5)), (2, 0));
    assert_eq!(count(&film(2e-14), &along(0.5)), (2, 1));
    assert_eq!(count(&film(0.0), &along(0.5)), (1, 0));
    let graze = |depth: f64| Ray::new(dvec3(-5.0, 1.0 - depth, 0.0), DVec3::X);
    assert_eq!(count(&Solid::ball(1.0), &graze(1e-9)), (1, 0));
    assert_eq!(count(&Solid::ball(1.0), &graze(f64::EPSILON)), (1, 1));
    // From so far away that both ends of the film are one number.
    let far = Ray::new(dvec3(-1e9, 0.5, 0.5), DVec3::X);
    assert_eq!(count(&film(1e-9), &far), (1, 1));
}
