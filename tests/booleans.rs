//! Where solids touch, coincide or all but coincide: what is left is what is meant.

#[expect(dead_code, reason = "these solids are made and not drawn by proptest")]
mod support;

use glam::{DAffine3, DMat3, DVec3, dvec3};
use solidray::measure::{self, Sampling};
use solidray::{Ray, Solid};
use support::dice::Dice;
use support::{ends, ends_in, meshes, scene, total};

const NOTHING: [[f64; 2]; 0] = [];

/// A turn and a move.
fn place(dice: &mut Dice) -> DAffine3 {
    DAffine3::from_mat3_translation(dice.rotation(), dice.point(10.0))
}

fn mapped(map: &DAffine3, ray: &Ray) -> Ray {
    Ray::new(map.transform_point3(ray.origin), map.transform_vector3(ray.dir))
}

/// Boxes with maps of their own that share the plane x = 1, seen along lines through it.
#[test]
fn n28_a_flush_cut_leaves_no_film() {
    let mut dice = Dice::new(28);
    for _ in 0..1000 {
        let map = place(&mut dice);
        let cube = Solid::cuboid_between(DVec3::ZERO, DVec3::ONE);
        let a = cube.clone().mapped(map);
        let beside = cube
            .clone()
            .scaled(dvec3(dice.within(0.1, 2.0), 2.0, 2.0))
            .mapped(map * DAffine3::from_translation(dvec3(1.0, -0.5, -0.5)));
        let inner = Solid::cuboid_between(dvec3(-1.0, -0.5, -0.5), dvec3(0.5, 1.5, 1.5))
            .translated(dvec3(0.5, 0.0, 0.0))
            .mapped(map);
        let at = dvec3(1.0, dice.within(0.1, 0.9), dice.within(0.1, 0.9));
        let dir = DVec3::X + 0.05 * dice.direction();
        let ray = mapped(&map, &Ray::new(at - 5.0 * dir, dir));
        assert_eq!(ends(&(a.clone() & beside.clone()), &ray), NOTHING);
        assert_eq!(ends(&(a.clone() - inner), &ray), NOTHING, "{ray:?}");
        let (cut, whole) = (ends(&(a.clone() - beside), &ray), ends(&a, &ray));
        assert_eq!((cut.len(), whole.len()), (1, 1), "{ray:?}");
        let error = (cut[0][0] - whole[0][0]).abs() + (cut[0][1] - whole[0][1]).abs();
        assert!(error <= 1e-13, "{cut:?} {whole:?}");
    }
}

/// Solids that touch in a point, an edge or a face, seen along lines through it: their
/// union goes on there, what they have in common is nothing, and neither cuts the other.
#[test]
fn n29_solids_that_touch_have_nothing_in_common() {
    let cube = Solid::cuboid_between(DVec3::ZERO, DVec3::ONE);
    let ball = Solid::ball(1.0);
    let cone = Solid::frustum(0.0, 1.0, 1.0);
    let mesh = Solid::mesh(meshes::grid_box(DVec3::ZERO, DVec3::ONE, 2));
    let moved =
        |solid: &Solid, x: f64, y: f64, z: f64| solid.clone().translated(dvec3(x, y, z));
    let touching = [
        (moved(&ball, -1.0, 0.0, 0.0), moved(&ball, 1.0, 0.0, 0.0)),
        (moved(&ball, -1.0, 0.0, 0.0), moved(&cube, 0.0, -0.5, -0.5)),
        (cube.clone(), moved(&cube, -1.0, -1.0, -1.0)),
        (cube.clone(), moved(&cube, -1.0, -1.0, 0.0)),
        (moved(&cube, 0.0, -0.5, -0.5), moved(&cube, -1.0, -0.5, -0.5)),
        (cone.clone(), cone.clone().mirrored(DVec3::Z)),
        (moved(&mesh, 0.0, -0.5, -0.5), moved(&cube, -1.0, -0.5, -0.5)),
        (moved(&ball, -1.0, 0.0, 0.0), moved(&mesh, 0.0, -0.5, -0.5)),
    ];
    for (a, b) in &touching {
        let scenes = [
            a.clone() & b.clone(),
            a.clone() - b.clone(),
            a.clone(),
            b.clone() - a.clone(),
            b.clone(),
            a.clone() + b.clone(),
        ];
        // All with the same bounds, and so the same reference points on lines.
        let specks = [-1.0, 1.0]
            .map(|sign| Solid::ball(0.01).translated(sign * dvec3(9.0, 7.3, 8.1)));
        let scenes = scenes.map(|solid| {
            let [low, high] = specks.clone();
            scene(&(solid + low + high))
        });
        let digits = |i: i32| [i % 5, i / 5 % 5, i / 25].map(|k| f64::from(k - 2));
        let dirs = (0..125).map(|i| DVec3::from_array(digits(i)));
        for dir in dirs.filter(|dir| *dir != DVec3::ZERO) {
            let ray = Ray::new(-3.0 * dir, dir);
            let [and, a_only, a, b_only, b, or] =
                scenes.each_ref().map(|scene| ends_in(scene, &ray));
            assert_eq!(and, NOTHING, "{ray:?}");
            assert_eq!((&a_only, &b_only), (&a, &b), "{ray:?}");
            let mut both = [a, b].concat();
            both.sort_by(|a, b| a[0].total_cmp(&b[0]));
            both.dedup_by(|next, last| {
                #[expect(clippy::float_cmp, reason = "one place is one number")]
                let joins = next[0] == last[1];
                if joins {
                    last[1] = next[1];
                }
                joins
            });
            assert_eq!(or, both, "{ray:?}");
        }
    }
}

/// A slab as thin as 1e-12, left of a block, is found by every line through it and is as
/// long as it should be: no thickness counts as none, seen from any side.
#[test]
fn n30_a_sliver_is_there_from_every_side() {
    let mut dice = Dice::new(30);
    for power in 3..=12 {
        let top = 1.0 - 10.0_f64.powi(-power);
        let cutter = Solid::cuboid_between(DVec3::splat(-3.0), dvec3(3.0, 3.0, top));
        let sliver = Solid::cuboid(DVec3::splat(2.0)) - cutter;
        for _ in 0..20 {
            let map = DAffine3::from_mat3(dice.rotation());
            let scene = scene(&sliver.clone().mapped(map));
            for _ in 0..20 {
                let at = dvec3(dice.within(-0.5, 0.5), dice.within(-0.5, 0.5), 1.0);
                let mut dir = dice.direction();
                dir.z = dir.z.signum() * dir.z.abs().max(0.05);
                let ray = mapped(&map, &Ray::new(at - dir, dir));
                let list = ends_in(&scene, &ray);
                let wanted = (1.0 - top) / dir.z.abs();
                assert_eq!(list.len(), 1, "{top}: {ray:?}");
                assert!((total(&list) - wanted).abs() <= 1e-12, "{list:?} {wanted}");
            }
        }
    }
}

/// The volume of an image is that of the original times the determinant, mirrored or not.
#[test]
fn n32_maps_multiply_volumes_by_their_determinants() {
    let solid = (Solid::cylinder(1.0, 2.0) + Solid::cuboid(DVec3::splat(1.5)))
        - Solid::ball(0.9).translated(dvec3(0.3, 0.2, 1.0));
    let sampling = Sampling { rel_tol: 1e-4, max_rays: 1 << 17, ..Sampling::default() };
    let volume = |solid: &Solid| measure::volume(&scene(solid), &sampling);
    let plain = volume(&solid);
    let mut dice = Dice::new(32);
    for mirror in [1.0, -1.0, 1.0, -1.0] {
        let shear = DMat3::from_cols(
            dvec3(mirror * dice.within(0.3, 3.0), 0.0, 0.0),
            dvec3(dice.within(-1.0, 1.0), dice.within(0.3, 3.0), 0.0),
            dvec3(dice.within(-1.0, 1.0), dice.within(-1.0, 1.0), 1.0),
        );
        let map = place(&mut dice) * DAffine3::from_mat3(shear);
        let factor = map.matrix3.determinant();
        assert!(factor * mirror > 0.0);
        let image = volume(&solid.clone().mapped(map));
        let error = (image.value - factor.abs() * plain.value).abs();
        let allowed = 2.0 * image.half_width().hypot(factor.abs() * plain.half_width());
        assert!(error <= allowed, "{image:?}: {factor} {plain:?}");
    }
}
