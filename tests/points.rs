//! Points without lines: single ones and many at once are answered as their line answers.

#[expect(dead_code, reason = "few helpers are needed for points")]
mod support;

use glam::{DAffine3, DVec3, dvec3};
use proptest::prelude::*;
use solidray::{Op, Ray, Scene, Solid};
use support::dice::Dice;
use support::strategies::{aims, model, place};
use support::{meshes, scene, spans};

/// The direction in which points are asked about (`PROBE`).
const PROBE: DVec3 = DVec3::new(
    0.547_722_557_505_166_1,
    0.316_227_766_016_837_94,
    0.774_596_669_241_483_4,
);

/// What the line through a point says of it.
fn by_line(scene: &Scene, points: &[DVec3]) -> Vec<bool> {
    let mut tracer = scene.tracer();
    let mut holds = |p: &DVec3| {
        let spans = tracer.spans(&Ray::new(*p, PROBE));
        spans.iter().any(|span| span.enter.t <= 0.0 && 0.0 < span.exit.t)
    };
    points.iter().map(&mut holds).collect()
}

/// Asks in all ways.
fn check(scene: &Scene, points: &[DVec3]) {
    let lines = by_line(scene, points);
    let mut tracer = scene.tracer();
    let found = scene.contains_all(points);
    assert_eq!(found.len(), points.len());
    // So many that it is worth to learn which leaves matter where.
    let crowd: Vec<DVec3> = points.iter().copied().cycle().take(20_000).collect();
    let in_cells = scene.contains_all(&crowd);
    for (i, p) in points.iter().enumerate() {
        assert_eq!(tracer.contains(*p), lines[i], "one: {p:?}");
        assert_eq!(found[i], lines[i], "some: {p:?}");
    }
    for (i, p) in crowd.iter().enumerate() {
        assert_eq!(in_cells[i], lines[i % points.len()], "many: {p:?}");
    }
}

/// The neighbours of a point in numbers, and itself.
fn neighbours(p: DVec3) -> impl Iterator<Item = DVec3> {
    let step = |x: f64, i: i32| match i {
        0 => x,
        1 => x.next_up(),
        _ => x.next_down(),
    };
    (0..27).map(move |i| dvec3(step(p.x, i % 3), step(p.y, i / 3 % 3), step(p.z, i / 9)))
}

/// Points in a scene's bounds, around them and on their faces, edges and corners.
fn around(scene: &Scene, count: usize, dice: &mut Dice) -> Vec<DVec3> {
    let b = scene.bounds();
    if b.is_empty() {
        return (0..count).map(|_| dice.point(3.0)).collect();
    }
    let (middle, half) = (b.center(), 0.5 * b.size());
    let mut points: Vec<DVec3> = (0..count)
        .map(|i| {
            let reach = if i % 8 == 0 { 1.3 } else { 1.0 };
            let p = dice.point(reach);
            // Lattice points too: they are on borders of cells.
            let p = if i % 5 == 0 { (8.0 * p).round() / 8.0 } else { p };
            middle + half * p
        })
        .collect();
    points.extend(b.corners().into_iter().flat_map(neighbours));
    points
        .extend([dvec3(b.min.x, middle.y, b.max.z), dvec3(middle.x, b.max.y, middle.z)]);
    points
}

/// Points that are far away or no points.
const STRANGE: [DVec3; 8] = [
    DVec3::NAN,
    DVec3::INFINITY,
    DVec3::NEG_INFINITY,
    DVec3::new(f64::NAN, 0.5, 0.5),
    DVec3::new(0.5, 0.5, f64::INFINITY),
    DVec3::splat(1e300),
    DVec3::new(-1e18, 0.1, 0.1),
    DVec3::splat(f64::MIN_POSITIVE),
];

proptest! {
    #[test]
    fn points_are_inside_where_their_lines_say_so(
        model in model(),
        more in prop::option::of((model(), model())),
        aims in aims(),
        places in prop::collection::vec(place(), 20),
        seed in any::<u64>(),
    ) {
        let mut solid = model.solid();
        if let Some((a, b)) = &more {
            // Enough leaves that points are sorted.
            let copies = (0..4).map(|i| b.solid().translated(DVec3::X * f64::from(i)));
            solid = Solid::boolean(Op::Union, [solid, a.solid()].into_iter().chain(copies));
        }
        let scene = scene(&solid);
        let mut dice = Dice::new(seed);
        let mut points = around(&scene, 400, &mut dice);
        points.extend(STRANGE);
        points.extend(places.into_iter().flat_map(neighbours));
        points.extend(model.features().into_iter().flat_map(|f| neighbours(f.point)));
        // On surfaces but for rounding, along lines that are aimed and along the probe.
        for aim in aims {
            let ray = aim.ray(&model);
            for ray in [ray, Ray::new(ray.origin, PROBE)] {
                for span in spans(&scene, &ray) {
                    points.extend(neighbours(ray.at(span.enter.t)));
                    points.extend(neighbours(ray.at(span.exit.t)));
                }
            }
        }
        check(&scene, &points);
    }
}

#[test]
fn empty_and_tiny_scenes_and_lists() {
    let mut dice = Dice::new(5);
    let ball = Solid::ball(1.0);
    let apart = ball.clone() & ball.clone().translated(3.0 * DVec3::X);
    let nothing =
        ball.clone() - Solid::cuboid_between(DVec3::splat(-2.0), DVec3::splat(2.0));
    for solid in [Solid::empty(), apart, nothing, ball.clone()] {
        let scene = scene(&solid);
        assert!(scene.contains_all(&[]).is_empty());
        check(&scene, &STRANGE);
        check(&scene, &around(&scene, 1000, &mut dice));
    }
    for scale in [1e-300, 1e-150, 1e-90, 1e-30, 1e30, 1e90, 1e150] {
        let many = (0..20).map(|i| ball.clone().translated(DVec3::Y * f64::from(i)));
        let many = Solid::boolean(Op::Union, many);
        for solid in [&ball, &many] {
            let scene = scene(&solid.clone().scaled(DVec3::splat(scale)));
            check(&scene, &around(&scene, 500, &mut dice));
        }
    }
}

/// Leaves without ends, and complements that cut off what bounds are made of.
#[test]
fn half_spaces_and_cut_bounds() {
    let mut dice = Dice::new(6);
    for round in 0..40 {
        let center = dice.point(2.0);
        let sides = (0..12).map(|_| {
            let out = dice.direction();
            Solid::half_space(out, out.dot(center) + dice.within(0.5, 1.5))
        });
        let hull = Solid::boolean(Op::Intersection, sides.collect::<Vec<_>>());
        let ball = Solid::ball(2.0).translated(center);
        let cutter = Solid::cuboid_between(
            center - dvec3(2.0, 2.0, 4.0),
            center + dvec3(2.0, 2.0, 0.25),
        );
        let solid = match round % 3 {
            0 => hull & ball,
            1 => (ball - cutter) - hull,
            _ => ball - cutter,
        };
        let scene = scene(&solid);
        let mut points = around(&scene, 600, &mut dice);
        // Where the cylinder and the cutter end together.
        points.extend((0..50).flat_map(|_| neighbours(center + 2.0 * dice.direction())));
        let faces = DVec3::AXES.into_iter().flat_map(|a| [2.0 * a, -2.0 * a]);
        let levels = || [-1.0, -0.25, 0.25, 1.0].map(|z| DVec3::Z * z);
        points.extend(
            faces.flat_map(|f| levels().map(|l| center + f + l)).flat_map(neighbours),
        );
        check(&scene, &points);
    }
}

/// Flat solids, long ones, slanted ones and meshes, with many leaves.
#[test]
fn many_leaves_of_all_kinds() {
    let mut dice = Dice::new(7);
    let kinds = [
        Solid::ball(0.3),
        Solid::cylinder(0.2, 1.0),
        Solid::frustum(0.3, 0.0, 0.8),
        Solid::paraboloid(0.3, 0.7),
        Solid::hyperboloid_of_one_sheet(0.1, 0.4, 0.9),
        Solid::hyperboloid_of_two_sheets(0.1, 0.8, 0.9),
        Solid::cuboid(dvec3(0.5, 0.3, 0.2)),
        Solid::mesh(meshes::icosphere(1)).scaled(DVec3::splat(0.3)),
    ];
    for stretch in [DVec3::ONE, dvec3(1.0, 100.0, 0.01), dvec3(1e-6, 1.0, 1.0)] {
        for kinds in [&kinds[..7], &kinds] {
            let leaves: Vec<Solid> = (0..60)
                .map(|i| {
                    let turned =
                        DAffine3::from_mat3_translation(dice.rotation(), dice.point(2.0));
                    let straight =
                        DAffine3::from_translation((4.0 * dice.point(2.0)).round() / 4.0);
                    let map = if i % 2 == 0 { turned } else { straight };
                    kinds[dice.below(kinds.len())].clone().mapped(map)
                })
                .collect();
            let solid = leaves.into_iter().enumerate().fold(
                Solid::ball(1.0),
                |solid, (i, leaf)| {
                    if i % 3 == 2 { solid - leaf } else { solid + leaf }
                },
            );
            let scene = scene(&solid.mapped(DAffine3::from_scale(stretch)));
            check(&scene, &around(&scene, 6000, &mut dice));
        }
    }
}

/// Many points make cells of cells, and threads share them.
#[test]
fn a_million_points_are_the_same_on_any_number_of_threads() {
    let mut dice = Dice::new(8);
    let leaves = (0..300).map(|_| Solid::ball(0.25).translated(dice.point(2.0)));
    let solid = Solid::cuboid(DVec3::splat(3.0))
        - Solid::boolean(Op::Union, leaves.collect::<Vec<_>>());
    let scene = scene(&solid);
    let b = scene.bounds();
    let points: Vec<DVec3> =
        (0..1_000_000).map(|_| b.center() + 0.51 * b.size() * dice.point(1.0)).collect();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be had").install(|| scene.contains_all(&points))
    };
    let one = on(1);
    assert!(one == on(1) && one == on(2) && one == on(2) && one == on(7));
    let some: Vec<DVec3> = points.iter().copied().step_by(17).collect();
    let lines = by_line(&scene, &some);
    assert!(one.iter().copied().step_by(17).eq(lines));
    assert!(one.iter().any(|&inside| inside) && !one.iter().all(|&inside| inside));
}

/// All in one place, all on one line.
#[test]
fn crowded_points() {
    let balls = (0..30).map(|i| Solid::ball(0.4).translated(DVec3::X * f64::from(i)));
    let scene = scene(&Solid::boolean(Op::Union, balls));
    let mut dice = Dice::new(9);
    let one = dice.point(0.4);
    check(&scene, &vec![one; 20_000]);
    check(&scene, &vec![dvec3(0.4, 0.0, 0.0); 5_000]);
    let line: Vec<DVec3> =
        (0..20_000).map(|_| dvec3(dice.within(-1.0, 31.0), 0.1, 0.0)).collect();
    check(&scene, &line);
}

/// Cells that no triangle touches are not asked about by lines one by one.
#[test]
fn meshes() {
    let mut dice = Dice::new(10);
    let ball = Solid::mesh(meshes::icosphere(3));
    let turned = |scale: DVec3, dice: &mut Dice| {
        let turn = DAffine3::from_mat3_translation(dice.rotation(), dice.point(0.5));
        ball.clone().scaled(scale).mapped(turn)
    };
    for _ in 0..6 {
        let shell = ball.clone() - ball.clone().scaled(DVec3::splat(0.8));
        let thin = turned(dvec3(1.0, 0.01, 0.7), &mut dice);
        let far = turned(DVec3::splat(1e-3), &mut dice).translated(1e3 * DVec3::X);
        let needle = turned(dvec3(1e-7, 1e-7, 1.0), &mut dice);
        let flipped = turned(dvec3(-1.0, 0.5, 0.5), &mut dice);
        for solid in [shell, thin + ball.clone(), ball.clone() + far, needle, flipped] {
            let scene = scene(&solid);
            let mut points = around(&scene, 8000, &mut dice);
            let corners = meshes::icosphere(3);
            points.extend(
                corners.points().iter().copied().step_by(20).flat_map(neighbours),
            );
            check(&scene, &points);
        }
    }
}

/// A tree with many levels, where leaves overlap.
#[test]
fn nested_operators() {
    let mut dice = Dice::new(11);
    let leaves: Vec<Solid> = (0..120)
        .map(|i| {
            let turn = DAffine3::from_mat3_translation(dice.rotation(), dice.point(1.0));
            let kind =
                if i % 2 == 0 { Solid::ball(0.5) } else { Solid::cylinder(0.4, 0.9) };
            kind.scaled(dvec3(1.0, 0.6, 1.3)).mapped(turn)
        })
        .collect();
    let solid =
        leaves.into_iter().enumerate().fold(Solid::ball(1.0), |solid, (i, leaf)| match i
            % 5
        {
            0 | 1 => solid + leaf,
            2 | 3 => solid - leaf,
            _ => solid & (leaf + Solid::ball(0.9)),
        });
    let scene = scene(&solid);
    check(&scene, &around(&scene, 20_000, &mut dice));
}
