//! Tiles answer as rays do that are traced one by one, to the last bit.

use glam::DVec3;
use proptest::prelude::*;

use super::Tile;
use crate::fan::{Fan, Linear};
use crate::scene::Scene;

#[expect(dead_code, reason = "other tests need more of it")]
#[path = "../../../tests/support/mod.rs"]
mod support;

use support::model::Model;
use support::strategies::{coordinate, direction, length, model, place};

/// A fan and the step from a ray to the next, such that rays often are on lattices. Its middle
/// ray goes through the origin.
fn fans() -> impl Strategy<Value = (Fan, [f64; 2])> {
    let axes = prop_oneof![
        Just([DVec3::X, DVec3::Y, DVec3::Z]),
        Just([DVec3::Y, DVec3::Z, -DVec3::X]),
        Just([DVec3::new(1.0, -1.0, 0.0), DVec3::Z, DVec3::new(-1.0, -1.0, 0.0)]),
        (direction(), direction()).prop_map(|(forward, other)| {
            let right = forward.cross(other);
            let right = if right.length() < 0.1 { forward.any_orthogonal_vector() } else { right };
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

fn assert_same_hits(scene: &Scene, fan: &Fan, step: [f64; 2], size: [usize; 2]) {
    let at = |i: usize, j: usize| {
        [(i as f64 - 16.0) * step[0], (16.0 - j as f64) * step[1]]
    };
    let tile = Tile { fan, size, at: &at };
    let (mut tiles, mut alone) = (scene.tile_tracer(), scene.tracer());
    let mut rays = 0;
    // Twice, for scratch memory is used again.
    for _ in 0..2 {
        tiles.first_hits(&tile, |i, j, hit| {
            let [right, up] = at(i, j);
            let ray = fan.ray(right, up);
            let expected = alone.first_hit(&ray);
            let bits = |hit: Option<crate::Crossing>| hit.map(|hit| hit.t.to_bits());
            assert_eq!(hit, expected, "{ray:?}");
            assert_eq!(bits(hit), bits(expected), "{ray:?}");
            rays += 1;
        });
    }
    assert_eq!(rays, 2 * size[0] * size[1]);
}

fn compiled(model: &Model) -> Scene {
    Scene::compile(&model.solid()).expect("a sound solid")
}

proptest! {
    #[test]
    fn tiles_hit_what_rays_hit(
        model in model(),
        (fan, step) in fans(),
        (at, aside) in (0..1000_usize, place()),
        size in [1..=32_usize, 1..=32_usize],
    ) {
        let features = model.features();
        let at = features[at % features.len()].point + 0.125 * aside;
        let origin = Linear { middle: fan.origin.middle + at, ..fan.origin };
        assert_same_hits(&compiled(&model), &Fan { origin, ..fan }, step, size);
    }
}
