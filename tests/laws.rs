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
use solidray::{Crossing, Membership, Ray, Scene, Span};
use support::algebra::{FAR, and, cube, equal_pairs, in_common_frame, minus, or, union};
use support::leaf::Leaf;
use support::model::{Model, crossings_of_leaves};
use support::strategies::{Aim, aims, direction, map, model, place, placed_leaf};
use support::{covers, ends_in, scene, spans};

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

/// Whether a model has room in the common frame.
fn fits(model: &Model) -> bool {
    let bounds = scene(&model.solid()).bounds();
    bounds.min.min_element() > 1.0 - FAR && bounds.max.max_element() < FAR - 1.0
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
    fn n33_middles_of_spans_are_inside_and_of_gaps_outside(model in model(), aims in aims()) {
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
    fn n09_a_reversed_ray_gives_the_mirrored_list_bit_by_bit(model in model(), aims in aims()) {
        let scene = scene(&model.solid());
        for ray in rays(&model, &aims) {
            let mut back = ends_in(&scene, &Ray::new(ray.origin, -ray.dir));
            back.reverse();
            let mirrored: Vec<[f64; 2]> = back.into_iter().map(|[a, b]| [-b, -a]).collect();
            prop_assert_eq!(ends_in(&scene, &ray), mirrored, "{:?}", ray);
        }
    }

    #[test]
    fn n08_a_direction_2_to_the_k_times_as_long_divides_every_t_by_that(
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

    /// Of a line with short coordinates it is the same line wherever on it, at a short number,
    /// the origin is: so are its crossings, but for the rounding of the two sums that
    /// say where they are, and spans and gaps that are thinner than their errors. The half-lines
    /// to both sides begin with the crossings next to the origin.
    #[test]
    fn n10_a_line_split_anywhere_has_the_crossings_of_the_whole_line(
        model in model(),
        aims in aims(),
        splits in prop::collection::vec(-40..=40_i32, 4),
    ) {
        let scene = scene(&model.solid());
        let reach = scene.bounds().size().length();
        for ray in rays(&model, &aims) {
            let short = |v: DVec3| (64.0 * v).round() / 64.0;
            let ray = Ray::new(short(ray.origin), short(ray.dir));
            let whole = crossings(&scene, &ray);
            for split in splits.iter().map(|i| 0.25 * f64::from(*i)) {
                let there = Ray::new(ray.at(split), ray.dir);
                let moved = crossings(&scene, &there);
                let back = Ray::new(there.origin, -there.dir);
                let [ahead, behind] = [there, back].map(|ray| scene.tracer().first_hit(&ray));
                let turned = |c: Crossing| Crossing { t: -c.t, sense: c.sense.reversed(), ..c };
                prop_assert_eq!(ahead, moved.iter().find(|c| c.t >= 0.0).copied());
                prop_assert_eq!(behind.map(turned), moved.iter().rfind(|c| c.t <= 0.0).copied());
                let rounding =
                    |t: f64| 2.0 * f64::EPSILON * (t.abs() + split.abs() + reach / ray.speed());
                let without_thin = |list: &[Crossing], ray: &Ray| {
                    annihilated(list, |a, b| {
                        let errors = scene.error_at(ray, a) + scene.error_at(ray, b);
                        b.t - a.t <= errors + rounding(a.t)
                    })
                };
                let [one, two] = [without_thin(&whole, &ray), without_thin(&moved, &there)];
                prop_assert_eq!(one.len(), two.len(), "{:?} {:?}", one, two);
                for (a, b) in one.iter().zip(&two) {
                    prop_assert_eq!(a.sense, b.sense);
                    // Where faces meet it may be another one, if that is as near as rounding.
                    let other = Crossing { leaf: b.leaf, face: b.face, ..*a };
                    let off = (a.t - split - b.t).abs();
                    if (a.leaf, a.face) == (b.leaf, b.face) {
                        prop_assert!(off <= rounding(a.t), "{:?} {:?}", a, b);
                    } else {
                        let near = 4.0 * (scene.error_at(&ray, a) + scene.error_at(&there, b));
                        prop_assert!(off <= near + rounding(a.t), "{:?} {:?}", a, b);
                        let to_other = scene.error_at(&ray, &other);
                        prop_assert!(to_other <= near + rounding(a.t), "{:?} {:?}", a, b);
                    }
                }
            }
        }
    }

    /// What a plane parts has together the spans of the whole, bit by bit and face by face.
    #[test]
    fn n10_the_two_sides_of_a_plane_have_together_the_spans_of_the_whole(
        model in model(),
        aims in aims(),
        normal in [0.2..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64],
        part in -0.1..1.1_f64,
    ) {
        prop_assume!(fits(&model));
        let whole = in_common_frame(&model);
        for ray in rays(&model, &aims) {
            // Without the corners of the frame.
            let is_near = |span: &Span| ray.at(span.enter.t).abs().max_element() < FAR - 1.0;
            let within = |scene: &Scene| -> Vec<Span> {
                spans(scene, &ray).into_iter().filter(is_near).collect()
            };
            let list = within(&whole);
            let (Some(first), Some(last)) = (list.first(), list.last()) else { continue };
            let at = first.enter.t + part * (last.exit.t - first.enter.t);
            // Through an end, the plane would be the end.
            let mut ends = list.iter().flat_map(|span| [span.enter.t, span.exit.t]);
            if ends.any(|t| (t - at).abs() <= 1e-9 * (1.0 + t.abs())) {
                continue;
            }
            let normal = DVec3::from_array(normal);
            let half = Model::Leaf(Leaf::HalfSpace { normal, offset: normal.dot(ray.at(at)) });
            let mut parts = [and(&model, &half), minus(&model, &half)];
            if normal.dot(ray.dir) < 0.0 {
                parts.reverse();
            }
            let [near, far] = parts.map(|part| within(&in_common_frame(&part)));
            let mut both = near;
            for span in far {
                match both.last_mut() {
                    #[expect(clippy::float_cmp, reason = "one place is one number")]
                    Some(last) if last.exit.t == span.enter.t => last.exit = span.exit,
                    _ => both.push(span),
                }
            }
            prop_assert_eq!(both, list, "{:?} at {}", ray, at);
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
    fn n35_guards_change_no_bit(model in model(), aims in aims()) {
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
    fn n24_the_algebra_holds_bit_by_bit(
        a in model(),
        b in model(),
        c in model(),
        aims in aims(),
    ) {
        prop_assume!(fits(&a) && fits(&b) && fits(&c));
        let all = union([&a, &b, &c].map(Model::clone));
        for (left, right) in equal_pairs(&a, &b, &c) {
            let (left, right) = (in_common_frame(&left), in_common_frame(&right));
            for ray in rays(&all, &aims) {
                prop_assert_eq!(ends_in(&left, &ray), ends_in(&right, &ray), "{:?}", ray);
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

    /// The ends of union and intersection together are those of both operands, bit by bit:
    /// so are the lengths, but for the rounding of their sum. Surfaces of both that coincide but
    /// for rounding have to be there for that, even if only one is asked.
    #[test]
    fn n31_union_and_intersection_together_have_the_ends_of_both(
        a in model(),
        b in model(),
        aims in aims(),
    ) {
        prop_assume!(fits(&a) && fits(&b));
        let beside = |a, b| or(a, &minus(b, b));
        let scenes = [or(&a, &b), and(&a, &b), beside(&a, &b), beside(&b, &a)]
            .map(|model| in_common_frame(&model));
        for ray in rays(&or(&a, &b), &aims) {
            let [or, and, a, b] = scenes.each_ref().map(|scene| ends_in(scene, &ray));
            let (left, right) = (balance([&or, &and]), balance([&a, &b]));
            prop_assert_eq!(left, right, "{:?} {:?} {:?} {:?} {:?}", or, and, a, b, ray);
        }
    }

    #[test]
    fn n25_the_order_of_a_union_changes_no_bit(
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

/// The ends of the spans of one ray, in order.
fn crossings(scene: &Scene, ray: &Ray) -> Vec<Crossing> {
    spans(scene, ray).iter().flat_map(|span| [span.enter, span.exit]).collect()
}

/// A list without neighbours that are too near each other.
fn annihilated(
    list: &[Crossing],
    near: impl Fn(&Crossing, &Crossing) -> bool,
) -> Vec<Crossing> {
    let mut left: Vec<Crossing> = Vec::new();
    for crossing in list {
        match left.last() {
            Some(last) if near(last, crossing) => {
                left.pop();
            }
            _ => left.push(*crossing),
        }
    }
    left
}

/// How many more spans of two lists start than end at each place where that is not zero.
fn balance(lists: [&[[f64; 2]]; 2]) -> Vec<(f64, i32)> {
    let mut steps: Vec<(f64, i32)> = lists
        .into_iter()
        .flatten()
        .flat_map(|[enter, exit]| [(*enter, 1), (*exit, -1)])
        .collect();
    steps.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut sums: Vec<(f64, i32)> = Vec::new();
    for (t, step) in steps {
        match sums.last_mut() {
            #[expect(clippy::float_cmp, reason = "one place is one number")]
            Some(last) if last.0 == t => last.1 += step,
            _ => sums.push((t, step)),
        }
    }
    sums.retain(|(_, sum)| *sum != 0);
    sums
}

/// Points ask along lines of their own, so this holds what two lines say of one place
/// against each other. On a boundary to which the ray is parallel either is right.
#[test]
fn n33_points_in_spans_are_not_outside_and_in_gaps_not_inside() {
    let mut runner = TestRunner::deterministic();
    let cases = (model(), aims());
    let (mut sure, mut all) = (0, 0);
    for _ in 0..ProptestConfig::default().cases {
        let case = cases.new_tree(&mut runner).expect("nothing is rejected");
        let (model, aims) = case.current();
        let scene = scene(&model.solid());
        for ray in rays(&model, &aims) {
            let spans = spans(&scene, &ray);
            let ends: Vec<_> = spans.iter().flat_map(|s| [s.enter, s.exit]).collect();
            for (i, pair) in ends.windows(2).enumerate() {
                let error: f64 = pair.iter().map(|c| scene.error_at(&ray, c)).sum();
                if pair[1].t - pair[0].t <= 2.0 * error {
                    continue;
                }
                let middle = ray.at(f64::midpoint(pair[0].t, pair[1].t));
                let found = scene.tracer().classify(middle);
                let [right, wrong] = match i % 2 {
                    0 => [Membership::In, Membership::Out],
                    _ => [Membership::Out, Membership::In],
                };
                assert_ne!(found, wrong, "{middle} of {ray:?}: {spans:?}");
                all += 1;
                sure += i32::from(found == right);
            }
        }
    }
    assert!(sure > all * 8 / 10, "{sure} of {all}");
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
