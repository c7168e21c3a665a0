//! What a ray meets first is the first of all it meets, to the bit.

#[expect(dead_code, reason = "meshes are what matters here")]
mod support;

use glam::{DQuat, DVec3, dvec3};
use proptest::prelude::*;
use solidray::{Crossing, Mesh, Ray, Scene, Solid, Tracer};
use support::dice::Dice;
use support::strategies::{aims, model};
use support::{aim, meshes, scene};

/// Also from where the ray meets something and from a little before and after, from between,
/// and backwards.
fn assert_first(tracer: &mut Tracer<'_>, ray: &Ray, dice: &mut Dice) {
    let ends: Vec<f64> =
        tracer.spans(ray).iter().flat_map(|span| [span.enter.t, span.exit.t]).collect();
    let mut starts = vec![0.0, dice.within(-2.0, 2.0)];
    starts.extend(ends.iter().flat_map(|t| [*t, t.next_up(), t.next_down()]));
    starts.extend(ends.windows(2).map(|t| f64::midpoint(t[0], t[1])));
    for start in starts {
        for dir in [ray.dir, -ray.dir, 1e-3 * ray.dir] {
            let ray = Ray::new(ray.at(start), dir);
            let first = first_of_all(tracer, &ray);
            assert_eq!(tracer.first_hit(&ray), first, "{ray:?}");
        }
    }
}

fn first_of_all(tracer: &mut Tracer<'_>, ray: &Ray) -> Option<Crossing> {
    let spans = tracer.spans(ray);
    spans.iter().flat_map(|span| [span.enter, span.exit]).find(|c| c.t >= 0.0)
}

proptest! {
    #[test]
    fn the_first_hit_is_the_first_end_of_all_spans(model in model(), aims in aims()) {
        let scene = scene(&model.solid());
        let (mut tracer, mut dice) = (scene.tracer(), Dice::new(1));
        for aim in aims {
            assert_first(&mut tracer, &aim.ray(&model), &mut dice);
        }
    }
}

/// Solids of a mesh and copies of it: beside it, within it, touching it, the same.
fn solids(mesh: &Mesh) -> Vec<(&'static str, Scene)> {
    let solid = || Solid::mesh(mesh.clone());
    let size = mesh.bounds().size();
    let center = mesh.bounds().center();
    let beside = |x: f64| solid().translated(x * DVec3::X);
    let scaled = |factor: f64| {
        solid().translated(-center).scaled(DVec3::splat(factor)).translated(center)
    };
    let ball = |radius: f64| Solid::ball(radius * size.max_element()).translated(center);
    let stack = (0..12).map(|i| scaled(1.0 - f64::from(i) / 13.0)).enumerate().fold(
        Solid::empty(),
        |all, (i, next)| {
            if i % 2 == 0 { all + next } else { all - next }
        },
    );
    let row = (0..9).fold(Solid::empty(), |all, i| all + beside(f64::from(i) * size.x));
    let turned =
        solid().rotated(dvec3(1.0, 2.0, 3.0), 0.4).translated(0.2 * size.x * DVec3::X);
    let far = solid().translated(dvec3(1e7, -3e6, 2e6));
    [
        ("alone", solid()),
        ("minus a ball", solid() - ball(0.4)),
        ("within a ball", solid() & ball(0.3)),
        ("a hole", ball(1.0) - solid()),
        ("in a ball", ball(0.4) + solid()),
        ("the same", solid() + solid()),
        ("nothing", solid() - solid()),
        ("a row", row),
        ("shells", stack),
        ("shells in a ball", ball(0.35) + scaled(0.9) - scaled(0.3)),
        ("minus a turned one", solid() - turned),
        ("two far apart", solid() + far.clone()),
        ("far", far - Solid::ball(0.2).translated(dvec3(1e7, -3e6, 2e6))),
    ]
    .map(|(name, solid)| (name, scene(&solid)))
    .into()
}

#[test]
fn the_first_hit_of_rays_at_features_of_meshes_is_the_first_end_of_all_spans() {
    let flat = meshes::mapped(
        &meshes::grid_box(-DVec3::ONE, DVec3::ONE, 4),
        &glam::DAffine3::from_scale(dvec3(1.0, 1.0, 1e-7)),
    );
    let turned = glam::DAffine3::from_quat(DQuat::from_rotation_x(0.3));
    for mesh in [
        meshes::icosphere(3),
        meshes::jittered(&meshes::icosphere(3), 0.2, 5),
        meshes::grid_box(-DVec3::ONE, DVec3::ONE, 5),
        meshes::stacked_cubes(),
        meshes::needle(1e6),
        meshes::mapped(&flat, &turned),
        flat,
    ] {
        for (_, scene) in solids(&mesh) {
            let (mut tracer, mut dice) = (scene.tracer(), Dice::new(7));
            for i in 0..120 {
                let ray = aim::at_feature(&mesh, &mut dice, i);
                assert_first(&mut tracer, &ray, &mut dice);
                let away = dice.within(-1.0, 1.0) * [1.0, 1e2, 1e4, 1e7, 1e11][i % 5];
                let ray = Ray::new(ray.at(away), ray.dir);
                assert_first(&mut tracer, &ray, &mut dice);
            }
        }
    }
}

/// Meshes whose faces are nearer to one another than numbers of rays from afar.
#[test]
fn the_first_hit_of_rays_from_afar_at_plates_is_the_first_end_of_all_spans() {
    let cube = meshes::grid_box(-DVec3::ONE, DVec3::ONE, 2);
    let mut dice = Dice::new(9);
    let mut merged = 0;
    for i in 0..60 {
        let gap = dice.within(1e-6, 4e-6);
        let solid = || Solid::mesh(cube.clone());
        let behind = |gap: f64| solid().translated(gap * DVec3::X);
        let scene = scene(&match i % 3 {
            0 => solid() - behind(gap),
            1 => solid() + behind(gap) - behind(2.0 * gap),
            _ => (solid() - behind(gap)) + (behind(2.0 * gap) - behind(3.0 * gap)),
        });
        let mut tracer = scene.tracer();
        for _ in 0..200 {
            let far = 10_f64.powf(dice.within(9.0, 11.0));
            let [y, z] = [dice.within(-0.9, 0.9), dice.within(-0.9, 0.9)];
            let ray = Ray::new(dvec3(-far, y, z), DVec3::X);
            let first = first_of_all(&mut tracer, &ray);
            merged += usize::from(tracer.spans(&ray).is_empty());
            assert_eq!(tracer.first_hit(&ray), first, "{ray:?}");
        }
    }
    assert!(merged > 100, "only {merged} rays have lost a plate");
}
