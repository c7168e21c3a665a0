//! Laws that hold for every solid and every ray, on random ones.
//!
//! Half of the rays are aimed at corners, edges, apexes and into faces: random rays alone
//! show nothing. `PROPTEST_CASES=10000 cargo test --test laws` looks for longer.

#[expect(dead_code, reason = "laws need no dice")]
mod support;

use glam::{DAffine3, DVec3};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use solidray::{Op, Ray, Scene};
use support::model::{Leaf, Model, crossings_of_leaves};
use support::strategies::{Aim, aims, direction, map, model, place, placed_leaf};
use support::{covers, ends_in, scene, spans, total};

/// Pieces of a ray shorter than this, in units of length, are not argued about: at a graze
/// the length of a chord is known to the root of the precision of everything else.
const SHORT: f64 = 1e-6;

/// Four times what is usual, so 1024, as these cases are small.
fn many() -> ProptestConfig {
    let usual = ProptestConfig::default();
    ProptestConfig { cases: 4 * usual.cases, ..usual }
}

fn rays<'a>(model: &'a Model, aims: &'a [Aim]) -> impl Iterator<Item = Ray> {
    aims.iter().map(|aim| aim.ray(model))
}

fn union(children: impl IntoIterator<Item = Model>) -> Model {
    Model::boolean(Op::Union, children)
}

fn intersection(children: impl IntoIterator<Item = Model>) -> Model {
    Model::boolean(Op::Intersection, children)
}

fn minus(a: &Model, b: &Model) -> Model {
    Model::boolean(Op::Difference, [a.clone(), b.clone()])
}

fn or(a: &Model, b: &Model) -> Model {
    union([a.clone(), b.clone()])
}

fn and(a: &Model, b: &Model) -> Model {
    intersection([a.clone(), b.clone()])
}

fn cube(center: f64, size: f64) -> Model {
    let (center, half) = (DVec3::splat(center), DVec3::splat(0.5 * size));
    Model::Leaf(Leaf::Cuboid { min: center - half, max: center + half })
}

/// Every line's reference point depends on the bounds of its scene. With two small cubes
/// far out all scenes have the same bounds, so equal surfaces give equal bits.
fn in_common_frame(model: &Model) -> Scene {
    let corners = [-1.0, 1.0].map(|sign| cube(sign * FAR, 1.0));
    scene(&union(std::iter::once(model.clone()).chain(corners)).solid())
}

/// Where the corners of the common frame are.
const FAR: f64 = 4096.0;

/// Whether a model has room in the common frame.
fn fits(model: &Model) -> bool {
    let bounds = scene(&model.solid()).bounds();
    bounds.min.min_element() > 1.0 - FAR && bounds.max.max_element() < FAR - 1.0
}

fn assert_equal_bits(a: &Model, b: &Model, ray: &Ray) {
    let (a, b) = (in_common_frame(a), in_common_frame(b));
    assert_eq!(ends_in(&a, ray), ends_in(&b, ray), "{ray:?}");
}

/// Pieces of a ray between neighbouring ends that are not short: their middles.
fn middles(ray: &Ray, mut ends: Vec<f64>) -> Vec<f64> {
    ends.sort_by(f64::total_cmp);
    let long = |piece: &&[f64]| (piece[1] - piece[0]) * ray.dir.length() > SHORT;
    ends.windows(2).filter(long).map(|piece| f64::midpoint(piece[0], piece[1])).collect()
}

/// Two lists agree wherever the model is sure.
fn assert_agree(model: &Model, ray: &Ray, a: &[[f64; 2]], b: &[[f64; 2]]) {
    for t in middles(ray, a.iter().chain(b).flatten().copied().collect()) {
        let sure = model.holds(ray.at(t)).is_some();
        assert!(
            covers(a, t) == covers(b, t) || !sure,
            "at {t} of {ray:?}:\n{a:?}\n{b:?}"
        );
    }
}

fn assert_same_solid(a: &Model, b: &Model, aims: &[Aim]) {
    let (scene_a, scene_b) = (scene(&a.solid()), scene(&b.solid()));
    for ray in rays(a, aims) {
        assert_agree(a, &ray, &ends_in(&scene_a, &ray), &ends_in(&scene_b, &ray));
    }
}

proptest! {
    #![proptest_config(many())]

    #[test]
    fn middles_of_spans_are_inside_and_of_gaps_outside(model in model(), aims in aims()) {
        let scene = scene(&model.solid());
        for ray in rays(&model, &aims) {
            let list = ends_in(&scene, &ray);
            let mut ends: Vec<f64> = list.iter().flatten().copied().collect();
            if let (Some(first), Some(last)) = (ends.first().copied(), ends.last().copied()) {
                ends.extend([first - 1.0, last + 1.0]);
            }
            for t in middles(&ray, ends) {
                let holds = model.holds(ray.at(t));
                prop_assert!(
                    holds.is_none_or(|inside| inside == covers(&list, t)),
                    "{holds:?} at {t} of {ray:?}: {list:?}"
                );
            }
        }
    }

    /// S. D. Roth, "Ray Casting for Modeling Solids", 1982: between the crossings of all
    /// leaves nothing changes, so one point of each piece tells what it is.
    #[test]
    fn testing_the_pieces_between_all_crossings_gives_the_same_spans(
        model in model(),
        aims in aims(),
    ) {
        let scene = scene(&model.solid());
        for ray in rays(&model, &aims) {
            let list = ends_in(&scene, &ray);
            let crossings = crossings_of_leaves(&model, &ray);
            for t in middles(&ray, crossings.clone()) {
                let holds = model.holds(ray.at(t));
                prop_assert!(
                    holds.is_none_or(|inside| inside == covers(&list, t)),
                    "{holds:?} at {t} of {ray:?}: {list:?}, {crossings:?}"
                );
            }
            for t in list.into_iter().flatten() {
                prop_assert!(
                    model.holds(ray.at(t)).is_none(),
                    "an end at {t} of {ray:?} is on no surface"
                );
            }
        }
    }

    #[test]
    fn a_reversed_ray_gives_the_mirrored_list(model in model(), aims in aims()) {
        let scene = scene(&model.solid());
        for ray in rays(&model, &aims) {
            let mut back = ends_in(&scene, &Ray::new(ray.origin, -ray.dir));
            back.reverse();
            let mirrored: Vec<[f64; 2]> = back.into_iter().map(|[a, b]| [-b, -a]).collect();
            prop_assert_eq!(ends_in(&scene, &ray), mirrored, "{:?}", ray);
        }
    }

    #[test]
    fn a_direction_twice_as_long_halves_every_t(
        model in model(),
        aims in aims(),
        power in -40..=40_i32,
    ) {
        let scene = scene(&model.solid());
        let factor = 2.0_f64.powi(power);
        for ray in rays(&model, &aims) {
            let longer = spans(&scene, &Ray::new(ray.origin, factor * ray.dir));
            let list = spans(&scene, &ray);
            prop_assert_eq!(list.len(), longer.len());
            for (a, b) in list.iter().zip(&longer) {
                for (a, b) in [(a.enter, b.enter), (a.exit, b.exit)] {
                    prop_assert_eq!((a.t, a.leaf, a.face), (factor * b.t, b.leaf, b.face));
                }
            }
        }
    }

    #[test]
    fn bounds_contain_every_span(model in model(), aims in aims()) {
        let scene = scene(&model.solid());
        let bounds = scene.bounds();
        for ray in rays(&model, &aims) {
            for t in ends_in(&scene, &ray).into_iter().flatten() {
                let (p, near) = (ray.at(t), 1e-9 * (1.0 + ray.at(t).length()));
                prop_assert!((bounds.min - p).max(p - bounds.max).max_element() < near);
            }
        }
    }

    #[test]
    fn points_are_inside_where_the_formula_says(
        model in model(),
        points in prop::collection::vec(place(), 1..20),
    ) {
        let scene = scene(&model.solid());
        let mut tracer = scene.tracer();
        let features = model.features().into_iter().map(|f| f.point * 0.999);
        for p in points.into_iter().chain(features) {
            let holds = model.holds(p);
            prop_assert!(holds.is_none_or(|inside| inside == tracer.contains(p)), "{p}");
        }
    }

    #[test]
    fn maps_move_points_and_keep_t(model in model(), map in map(), aims in aims()) {
        let mapped = model.clone().mapped(map);
        let (here, there) = (scene(&model.solid()), scene(&mapped.solid()));
        for ray in rays(&model, &aims) {
            let image = Ray::new(
                map.transform_point3(ray.origin),
                map.transform_vector3(ray.dir),
            );
            assert_agree(&model, &ray, &ends_in(&here, &ray), &ends_in(&there, &image));
            if model.holds(ray.origin).is_some() {
                prop_assert_eq!(here.contains(ray.origin), there.contains(image.origin));
            }
        }
    }

    #[test]
    fn guards_change_nothing(model in model(), aims in aims()) {
        prop_assume!(fits(&model));
        let (far, big) = (cube(FAR, 2.0), cube(0.0, 2.0 * FAR));
        assert_same_solid(&model, &or(&model, &minus(&far, &far)), &aims);
        assert_same_solid(&model, &minus(&model, &far), &aims);
        let (plain, guarded) =
            (scene(&model.solid()), scene(&and(&model, &big).solid()));
        prop_assert_eq!(plain.bounds(), guarded.bounds());
        for ray in rays(&model, &aims) {
            prop_assert_eq!(ends_in(&plain, &ray), ends_in(&guarded, &ray));
        }
    }

    #[test]
    fn a_tracer_leaves_nothing_behind(model in model(), aims in aims()) {
        let scene = scene(&model.solid());
        let mut tracer = scene.tracer();
        for ray in rays(&model, &aims) {
            let first = tracer.first_hit(&ray);
            let list = tracer.spans(&ray).to_vec();
            prop_assert_eq!(&list, &spans(&scene, &ray));
            let ahead = list.iter().flat_map(|s| [s.enter, s.exit]).find(|c| c.t >= 0.0);
            prop_assert_eq!(first, ahead);
        }
    }
}

proptest! {
    #[test]
    fn the_algebra_holds_bit_by_bit(a in model(), b in model(), c in model(), aims in aims()) {
        prop_assume!(fits(&a) && fits(&b) && fits(&c));
        let pairs = [
            (or(&a, &b), or(&b, &a)),
            (and(&a, &b), and(&b, &a)),
            (or(&a, &a), a.clone()),
            (and(&a, &a), a.clone()),
            (or(&a, &and(&a, &b)), a.clone()),
            (and(&a, &or(&a, &b)), a.clone()),
            (minus(&a, &minus(&a, &b)), and(&a, &b)),
            (minus(&c, &or(&a, &b)), and(&minus(&c, &a), &minus(&c, &b))),
            (minus(&c, &and(&a, &b)), or(&minus(&c, &a), &minus(&c, &b))),
            (and(&a, &or(&b, &c)), or(&and(&a, &b), &and(&a, &c))),
            (or(&a, &and(&b, &c)), and(&or(&a, &b), &or(&a, &c))),
            (union([a.clone(), b.clone(), c.clone()]), or(&c, &or(&b, &a))),
            (intersection([a.clone(), b.clone(), c.clone()]), and(&c, &and(&b, &a))),
            (
                Model::boolean(Op::Difference, [a.clone(), b.clone(), c.clone()]),
                minus(&a, &or(&c, &b)),
            ),
            (minus(&a, &a), union([])),
            (and(&a, &minus(&b, &a)), union([])),
        ];
        let all = union([a, b, c]);
        for (left, right) in pairs {
            for ray in rays(&all, &aims) {
                assert_equal_bits(&left, &right, &ray);
            }
        }
    }

    #[test]
    fn the_algebra_holds_in_every_frame(
        a in model(),
        b in model(),
        c in model(),
        aims in aims(),
    ) {
        assert_same_solid(&minus(&a, &minus(&a, &b)), &and(&a, &b), &aims);
        assert_same_solid(
            &and(&a, &or(&b, &c)),
            &or(&and(&a, &b), &and(&a, &c)),
            &aims,
        );
        assert_same_solid(&or(&a, &b), &union([minus(&a, &b), b.clone()]), &aims);
        let nothing = scene(&minus(&a, &a).solid());
        for ray in rays(&a, &aims) {
            prop_assert!(ends_in(&nothing, &ray).is_empty());
        }
    }

    #[test]
    fn lengths_of_union_and_intersection_add_up(a in model(), b in model(), aims in aims()) {
        prop_assume!(fits(&a) && fits(&b));
        let scenes = [or(&a, &b), and(&a, &b), a.clone(), b.clone()]
            .map(|model| in_common_frame(&model));
        for ray in rays(&or(&a, &b), &aims) {
            let [or, and, a, b] =
                scenes.each_ref().map(|scene| total(&ends_in(scene, &ray)));
            let near = 1e-10 / ray.dir.length();
            prop_assert!((or + and - a - b).abs() <= near, "{or} {and} {a} {b} {ray:?}");
        }
    }

    #[test]
    fn the_order_of_a_union_does_not_matter(
        children in prop::collection::vec(model(), 2..6),
        turn in 0..6_usize,
        aims in aims(),
    ) {
        let mut turned = children.clone();
        turned.rotate_left(turn % children.len());
        turned.swap(0, 1);
        let (a, b) = (scene(&union(children.clone()).solid()), scene(&union(turned).solid()));
        prop_assert_eq!(a.bounds(), b.bounds());
        for ray in rays(&union(children), &aims) {
            prop_assert_eq!(ends_in(&a, &ray), ends_in(&b, &ray));
        }
    }
}

/// Beside a surface, a little along the normal is outside and a little against it inside,
/// unless another surface is as near: those are few. On a surface all but parallel to the
/// ray the normal is turned against the ray, whatever its true side.
#[test]
fn a_step_along_the_normal_leaves_and_against_it_enters() {
    const STEP: f64 = 1e-5;
    let mut runner = TestRunner::deterministic();
    let mut sample =
        |strategy: &dyn Fn(&mut TestRunner) -> (Model, Vec<Aim>)| strategy(&mut runner);
    let (mut clear, mut all) = (0, 0);
    for i in 0..1000 {
        let (model, aims) = sample(&|runner| {
            let strategy =
                if i % 2 == 0 { model().boxed() } else { placed_leaf().boxed() };
            let tree = (strategy, aims()).new_tree(runner);
            tree.expect("these strategies reject nothing").current()
        });
        let scene = scene(&model.solid());
        for ray in rays(&model, &aims) {
            for crossing in spans(&scene, &ray).iter().flat_map(|s| [s.enter, s.exit]) {
                let (p, n) = (ray.at(crossing.t), scene.normal_at(&ray, &crossing));
                let sides = (model.holds(p + STEP * n), model.holds(p - STEP * n));
                if n.dot(ray.dir.normalize()).abs() < 1e-7 {
                    continue;
                }
                all += 1;
                clear += i32::from(sides == (Some(false), Some(true)));
                assert_ne!(sides, (Some(true), Some(false)), "{model:?} {ray:?} {p} {n}");
            }
        }
    }
    assert!(clear > all * 7 / 10, "{clear} of {all}");
}

proptest! {
    #[test]
    fn every_line_through_a_point_says_the_same_of_it(
        model in model(),
        point in place(),
        dirs in prop::collection::vec(direction(), 4),
    ) {
        if let Some(inside) = model.holds(point) {
            let scene = scene(&model.solid());
            for dir in dirs {
                let list = ends_in(&scene, &Ray::new(point, dir));
                prop_assert_eq!(covers(&list, 0.0), inside, "{} {}", point, dir);
            }
        }
    }

    #[test]
    fn one_map_is_as_good_as_two(model in model(), a in map(), b in map(), aims in aims()) {
        let nested = model.clone().mapped(b).mapped(a);
        let at_once = model.mapped(a * b);
        let moved_back = nested.clone().mapped(a.inverse()).mapped(DAffine3::IDENTITY);
        assert_same_solid(&nested, &at_once, &aims);
        let (there, back) = (scene(&nested.solid()), scene(&moved_back.solid()));
        for ray in rays(&moved_back, &aims) {
            let image = Ray::new(a.transform_point3(ray.origin), a.transform_vector3(ray.dir));
            assert_agree(
                &moved_back,
                &ray,
                &ends_in(&back, &ray),
                &ends_in(&there, &image),
            );
        }
    }
}
