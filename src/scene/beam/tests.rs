//! Tiles answer as rays do that are traced one by one, to the last bit.

use glam::{DAffine3, DVec3};
use proptest::collection::vec;
use proptest::prelude::*;
use pulp::Arch;

use super::work::Work;
use super::{Bunch, BunchTracer, Chords, Places, SIDE, Tile, TileTracer};
use crate::fan::{Fan, Linear};
use crate::op::Op;
use crate::ray::{Crossing, Span};
use crate::scene::Scene;
use crate::solid::Solid;
use crate::support::leaf::Leaf;
use crate::support::meshes;
use crate::support::model::Model;
use crate::support::strategies::{
    coordinate, direction, length, model, op, place, placed_leaf,
};

#[expect(dead_code, reason = "the benchmarks need more of it")]
#[path = "../../../benches/scenes/mod.rs"]
mod scenes;

use scenes::Subject;

/// A fan and the step from a ray to the next, such that rays often are on lattices. Its middle
/// ray goes through the origin.
fn fans() -> impl Strategy<Value = (Fan, [f64; 2])> {
    let axes = prop_oneof![
        Just([DVec3::X, DVec3::Y, DVec3::Z]),
        Just([DVec3::Y, DVec3::Z, -DVec3::X]),
        Just([DVec3::new(1.0, -1.0, 0.0), DVec3::Z, DVec3::new(-1.0, -1.0, 0.0)]),
        (direction(), direction()).prop_map(|(forward, other)| {
            let right = forward.cross(other);
            let right = if right.length() < 0.1 {
                forward.any_orthogonal_vector()
            } else {
                right
            };
            [right, right.cross(forward), forward]
        }),
    ];
    let step = || prop_oneof![Just(0.125), Just(0.25), 0.01..0.5_f64];
    (axes, coordinate(), length(), any::<bool>(), step(), step()).prop_map(
        |([right, up, forward], back, speed, parallel, x, y)| {
            let middle = -2.0 * back * forward;
            let (origin, dir) = if parallel {
                (Linear { middle, right, up }, Linear::constant(speed * forward))
            } else {
                let dir = Linear { middle: speed * forward, right, up };
                (Linear::constant(middle), dir)
            };
            (Fan { origin, dir }, [x, y])
        },
    )
}

/// With the machine's vectors and without.
fn arches() -> [Arch; 2] {
    [Arch::new(), Arch::Scalar]
}

/// Where in a fan the rays of a tile are.
fn tile_place(step: [f64; 2], i: usize, j: usize) -> [f64; 2] {
    [(i as f64 - 16.0) * step[0], (16.0 - j as f64) * step[1]]
}

fn assert_same_hits(scene: &Scene, fan: &Fan, step: [f64; 2], size: [usize; 2]) {
    let at = |i: usize, j: usize| tile_place(step, i, j);
    let tile = Tile { fan, size, at: &at };
    let mut alone = scene.tracer();
    for arch in arches() {
        let mut tiles = TileTracer::on(arch, scene);
        // Twice, for scratch memory is used again.
        for _ in 0..2 {
            let mut rays = 0;
            tiles.first_hits(&tile, |i, j, hit| {
                let [right, up] = at(i, j);
                let ray = fan.ray(right, up);
                let expected = alone.first_hit(&ray);
                let bits = |hit: Option<Crossing>| hit.map(|hit| hit.t.to_bits());
                assert_eq!(hit, expected, "{ray:?}");
                assert_eq!(bits(hit), bits(expected), "{ray:?}");
                rays += 1;
            });
            assert_eq!(rays, size[0] * size[1]);
        }
    }
}

fn assert_same_spans(scene: &Scene, fan: &Fan, step: [f64; 2], size: [usize; 2]) {
    let at = |i: usize, j: usize| tile_place(step, i, j);
    let places: Vec<[f64; 2]> =
        (0..size[1]).flat_map(|j| (0..size[0]).map(move |i| at(i, j))).collect();
    let corners = [at(0, 0), at(size[0] - 1, size[1] - 1)];
    let [right, up] =
        [0, 1].map(|axis| places.iter().map(|place| place[axis]).collect::<Vec<f64>>());
    let bunch = Bunch { fan, corners, places: Places { right: &right, up: &up } };
    let mut alone = scene.tracer();
    let expected: Vec<(Vec<Span>, Chords)> = places
        .iter()
        .map(|&[right, up]| {
            let ray = fan.ray(right, up);
            let spans = alone.spans(&ray).to_vec();
            (spans, Chords::found(&alone, &ray))
        })
        .collect();
    let bits = |spans: &[Span]| -> Vec<[u64; 2]> {
        spans.iter().map(|s| [s.enter.t.to_bits(), s.exit.t.to_bits()]).collect()
    };
    for arch in arches() {
        let mut bunches = BunchTracer::on(arch, scene);
        for _ in 0..2 {
            let mut found = vec![(Vec::new(), Chords::default()); places.len()];
            bunches.spans(&bunch, |i, ray, tracer| {
                found[i] = (tracer.spans_found().to_vec(), Chords::found(tracer, ray));
            });
            for (i, (found, expected)) in found.iter().zip(&expected).enumerate() {
                assert_eq!(found, expected, "{:?}", fan.ray(places[i][0], places[i][1]));
                assert_eq!(bits(&found.0), bits(&expected.0));
            }
            let mut found = vec![Chords::default(); places.len()];
            bunches.chords(&bunch, |i, chords| found[i] = chords);
            for (i, (found, (_, expected))) in found.iter().zip(&expected).enumerate() {
                assert_eq!(found, expected, "{:?}", fan.ray(places[i][0], places[i][1]));
            }
        }
    }
}

fn compiled(model: &Model) -> Scene {
    Scene::compile(&model.solid()).expect("a sound solid")
}

/// A fan whose middle ray goes through a feature of a model, or by it.
fn aimed(fan: &Fan, model: &Model, at: usize, aside: DVec3) -> Fan {
    let features = model.features();
    let at = features[at % features.len()].point + 0.125 * aside;
    let origin = Linear { middle: fan.origin.middle + at, ..fan.origin };
    Fan { origin, ..*fan }
}

/// A model of dozens of leaves: copies of a small one here and there, joined, or taken away from
/// a box.
fn crowd() -> impl Strategy<Value = Model> {
    (placed_leaf(), vec(place(), 10..60), any::<bool>(), op(), placed_leaf()).prop_map(
        |(leaf, places, taken, op, other)| {
            let small = |at: &DVec3| {
                let map = DAffine3::from_scale(DVec3::splat(0.25));
                leaf.clone().mapped(DAffine3::from_translation(*at) * map)
            };
            let copies = places.iter().map(small);
            let copies = if taken {
                let block =
                    Leaf::Cuboid { min: -DVec3::splat(3.0), max: DVec3::splat(3.0) };
                let block = Model::Leaf(block);
                Model::boolean(Op::Difference, [block].into_iter().chain(copies))
            } else {
                Model::boolean(Op::Union, copies)
            };
            Model::boolean(op, [copies, other])
        },
    )
}

proptest! {
    #[test]
    fn tiles_hit_what_rays_hit(
        model in prop_oneof![3 => model(), 1 => crowd()],
        (fan, step) in fans(),
        (at, aside) in (0..1000_usize, place()),
        size in [1..=32_usize, 1..=32_usize],
    ) {
        let fan = aimed(&fan, &model, at, aside);
        assert_same_hits(&compiled(&model), &fan, step, size);
    }

    #[test]
    fn bunches_find_what_rays_find(
        model in prop_oneof![3 => model(), 1 => crowd()],
        (fan, step) in fans(),
        (at, aside) in (0..1000_usize, place()),
        size in [1..=12_usize, 1..=12_usize],
    ) {
        let fan = aimed(&fan, &model, at, aside);
        assert_same_spans(&compiled(&model), &fan, step, size);
    }
}

/// Boxes whose sides are exactly where rays of a fan along an axis are: rays within faces, at
/// the edges of regions.
fn walls() -> impl Strategy<Value = (Model, Fan, [f64; 2])> {
    let ray = || 0..32_usize;
    let sides = vec((ray(), ray(), ray(), ray(), coordinate(), length(), op()), 1..6);
    let place = || -3.0..3.0_f64;
    (sides, place(), place(), 0.01..0.3_f64, 0.01..0.3_f64).prop_map(
        |(sides, x, y, dx, dy)| {
            let middle = DVec3::new(x, y, -7.0);
            let origin = Linear { middle, right: DVec3::X, up: DVec3::Y };
            let fan = Fan { origin, dir: Linear::constant(DVec3::Z) };
            let at = |i: usize, j: usize| {
                let [right, up] = tile_place([dx, dy], i, j);
                fan.ray(right, up).origin
            };
            let solid =
                sides.into_iter().fold(None, |all, (a, b, c, d, z, height, op)| {
                    let (p, q) = (at(a.min(b), c.max(d)), at(a.max(b) + 1, c.min(d)));
                    let max = DVec3::new(q.x, q.y.max(p.y + dy), z + height);
                    let leaf = Model::Leaf(Leaf::Cuboid { min: p.with_z(z), max });
                    Some(match all {
                        Some(all) => Model::boolean(op, [all, leaf]),
                        None => leaf,
                    })
                });
            (solid.expect("there is a box"), fan, [dx, dy])
        },
    )
}

proptest! {
    #[test]
    fn rays_within_faces_at_the_edges_of_regions_hit_the_same(
        (model, fan, step) in walls(),
    ) {
        let scene = compiled(&model);
        assert_same_hits(&scene, &fan, step, [32, 32]);
        assert_same_spans(&scene, &fan, step, [16, 9]);
    }
}

/// Thin boxes, flush here and there, and rays along an axis to them from so far away that
/// several of their sides can be at one place of a ray.
fn plates() -> impl Strategy<Value = (Model, Fan)> {
    let side = || 0..5_i32;
    let lean = || -1.0..1.0_f64;
    let plates = vec((side(), 1..4_i32, lean(), op()), 2..6);
    let far = prop_oneof![Just(1.0), Just(1e4), Just(1e8)];
    (plates, far, lean(), lean()).prop_map(|(plates, far, x, y)| {
        let middle = DVec3::new(x, y, -far);
        let fan = Fan {
            origin: Linear { middle, right: DVec3::X, up: DVec3::Y },
            dir: Linear::constant(DVec3::Z),
        };
        // Half of what rounding leaves of the distance.
        let unit = far * (f64::EPSILON / 4.0);
        let mut model = None;
        for (from, thick, edge, op) in plates {
            let [from, to] = [from, from + thick].map(|z| f64::from(z) * unit);
            let (min, max) = (DVec3::new(edge, -4.0, from), DVec3::new(4.0, 4.0, to));
            let plate = Model::Leaf(Leaf::Cuboid { min, max });
            model = Some(match model {
                Some(model) => Model::boolean(op, [model, plate]),
                None => plate,
            });
        }
        (model.expect("there is a plate"), fan)
    })
}

proptest! {
    #[test]
    fn rays_from_afar_hit_the_same((model, fan) in plates()) {
        let (scene, step) = (compiled(&model), [0.1, 0.1]);
        assert_same_hits(&scene, &fan, step, [32, 9]);
        assert_same_spans(&scene, &fan, step, [16, 9]);
    }
}

/// Solids of every size that a scene can have, and farther away than they are large.
#[test]
fn rays_to_solids_of_any_size_hit_the_same() {
    for exponent in (-132..=132).step_by(4).chain([-46, -45, -44, -43, -42, -41, -38]) {
        let size = 10_f64.powi(exponent);
        for (away, parallel) in [(0.0, true), (0.0, false), (1e3, true), (1e6, false)] {
            let at = size * away * DVec3::new(1.0, -0.7, 0.3);
            let mesh = Solid::mesh(meshes::icosphere(2)).scaled(DVec3::splat(size));
            let ball = mesh - Solid::ball(0.3 * size).translated(-0.8 * size * DVec3::Z);
            let cut = Solid::cuboid(DVec3::splat(size)).translated(0.8 * size * DVec3::X);
            let scene = Scene::compile(&(ball - cut).translated(at)).expect("a solid");
            let middle = at - 4.0 * size * DVec3::Z;
            // Directions may be as long as the solid is large, or not.
            for speed in [size, 1.0] {
                let [x, y, z] = DVec3::AXES.map(|axis| speed * axis);
                let (fan, step) = if parallel {
                    let (right, up) = (size * DVec3::X, size * DVec3::Y);
                    let origin = Linear { middle, right, up };
                    (Fan { origin, dir: Linear::constant(z) }, 0.0701)
                } else {
                    let dir = Linear { middle: z, right: x, up: y };
                    (Fan { origin: Linear::constant(middle), dir }, 0.0179)
                };
                assert_same_hits(&scene, &fan, [step, step], [32, 32]);
            }
        }
    }
}

/// More meshes than a tile keeps.
#[test]
fn rays_to_many_meshes_hit_the_same() {
    let mesh = Solid::mesh(meshes::icosphere(1)).scaled(DVec3::splat(0.11));
    let places = (0..400).map(|i| {
        DVec3::new(f64::from(i % 20), f64::from(i / 20), f64::from(i % 3)) * 0.2
    });
    let all = places.map(|at| mesh.clone().translated(at));
    let scene = Scene::compile(&Solid::boolean(Op::Union, all)).expect("a solid");
    let middle = DVec3::new(1.9, 1.9, -3.0);
    let origin = Linear { middle, right: DVec3::X, up: DVec3::Y };
    let fan = Fan { origin, dir: Linear::constant(DVec3::Z) };
    for step in [0.2, 0.13, 0.01] {
        assert_same_hits(&scene, &fan, [step, step], [32, 32]);
    }
}

/// What tiles do for a picture of 256 × 256 rays of a scene that speed is measured on, for each
/// thousand rays.
fn work_for_a_picture(name: &str) -> Work {
    const SIZE: usize = 256;
    let subject = Subject::named(name);
    let scene = Scene::compile(&subject.solid).expect("a sound solid");
    let forward = DVec3::new(-0.62, -0.53, -0.58).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let (up, middle) = (right.cross(forward), subject.bounds.center());
    let middle = middle - subject.bounds.size().length() * forward;
    let origin = Linear { middle, right, up };
    let fan = Fan { origin, dir: Linear::constant(forward) };
    let step = 2.0 * subject.half_height / SIZE as f64;
    let place = |i: usize| (i as f64 + 0.5 - 0.5 * SIZE as f64) * step;
    let mut tiles = TileTracer::new(&scene);
    let side = SIDE as usize;
    for row in (0..SIZE).step_by(side) {
        for column in (0..SIZE).step_by(side) {
            let at = |i: usize, j: usize| [place(column + i), place(row + j)];
            let tile = Tile { fan: &fan, size: [side; 2], at: &at };
            tiles.first_hits(&tile, |_, _, _| ());
        }
    }
    let per_thousand = |count: u64| count * 1000 / (SIZE * SIZE) as u64;
    let Work { regions, sides, meetings, walks, searches } = tiles.work();
    Work {
        regions: per_thousand(regions),
        sides: per_thousand(sides),
        meetings: per_thousand(meetings),
        walks: per_thousand(walks),
        searches: per_thousand(searches),
    }
}

/// What culling saves would be seen here if it were lost: without regions each ray meets all
/// leaves. The numbers for each thousand rays are those measured and a tenth more.
#[test]
fn rays_of_a_picture_meet_few_leaves() {
    for (name, most) in [
        ("classic", [38, 116, 2_100, 1]),
        ("spheres-1k", [96, 1_150, 6_200, 10]),
        ("spheres-10k", [94, 5_600, 13_800, 10]),
        ("plate-1k", [42, 910, 4_600, 810]),
        ("plate-10k", [36, 6_100, 22_900, 370]),
        ("menger-3", [77, 720, 3_750, 1]),
        ("deep-50", [43, 180, 1_800, 560]),
        ("deep-200", [92, 840, 3_750, 1_130]),
    ] {
        let Work { regions, sides, meetings, walks, searches } = work_for_a_picture(name);
        let work = [regions, sides, meetings, walks];
        assert!(
            work.iter().zip(most).all(|(&work, most)| work <= most),
            "{name}: {work:?}"
        );
        assert!(meetings > 0 && searches <= 1, "{name}: {searches} searches");
    }
}
