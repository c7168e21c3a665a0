//! Rays that start where others ended.

#[expect(dead_code, reason = "rooms are built by hand")]
mod support;

use glam::{DQuat, DVec3, dvec3};
use solidray::{Crossing, Ray, Scene, Sense, Solid, Tracer};
use support::dice::Dice;
use support::{meshes, scene};

/// How many bounces in all, over all rooms.
const BOUNCES: usize = 1_000_000;

/// A closed space: a solid around it, with things in it.
fn rooms() -> Vec<(&'static str, Scene)> {
    let shell = |room: Solid| Solid::ball(10.0) - room;
    let mut dice = Dice::new(31);
    let turned = |solid: Solid, dice: &mut Dice| {
        let axis = dice.direction();
        solid.rotated(axis, dice.within(-3.0, 3.0))
    };
    let pillars = (0..12).fold(Solid::empty(), |all, i| {
        let things = [
            Solid::cylinder(0.2, 4.0).translated(-2.0 * DVec3::Z),
            Solid::ball(0.5),
            Solid::cuboid(dvec3(0.7, 0.6, 0.5)),
            Solid::frustum(0.6, 0.0, 1.0),
            Solid::mesh(meshes::icosphere(1)).scaled(DVec3::splat(0.4)),
            Solid::hyperboloid_of_two_sheets(0.2, 0.5, 1.5),
        ];
        let thing = turned(things[i % things.len()].clone(), &mut dice);
        all + thing.translated(dice.point(1.8))
    });
    let cube = || Solid::cuboid(DVec3::splat(4.0));
    let rooms = [
        ("box", shell(cube())),
        ("turned box", shell(turned(cube(), &mut dice))),
        ("ball", shell(Solid::ball(3.0))),
        ("flat ellipsoid", shell(Solid::ball(1.0).scaled(dvec3(4.0, 3.0, 0.01)))),
        ("can", shell(Solid::cylinder(2.0, 3.0))),
        ("cone", shell(Solid::frustum(2.0, 0.0, 3.0))),
        ("hourglass", shell(Solid::hyperboloid_of_one_sheet(0.3, 2.0, 4.0))),
        ("icosphere", shell(Solid::mesh(meshes::icosphere(3)))),
        (
            "jittered icosphere",
            shell(Solid::mesh(meshes::jittered(&meshes::icosphere(3), 0.1, 1))),
        ),
        ("boxes with shared faces", {
            let part =
                |x: f64| Solid::cuboid(dvec3(1.0, 2.0, 2.0)).translated(DVec3::X * x);
            shell(turned(part(-0.5) + part(0.5) + part(1.5), &mut dice))
        }),
        ("pillars", shell(cube() - pillars)),
    ];
    rooms.map(|(name, solid)| (name, scene(&solid))).into()
}

fn reflected(dir: DVec3, normal: DVec3) -> DVec3 {
    dir - 2.0 * dir.dot(normal) * normal
}

/// Follows a ray from the inside of a room; says how often it was thrown back.
fn bounce(
    name: &str,
    scene: &Scene,
    tracer: &mut Tracer<'_>,
    first: Ray,
    most: usize,
) -> usize {
    let mut ray = first;
    let Some(mut hit) = tracer.first_hit(&ray) else { return 0 };
    for i in 0..most {
        // The shell is thick: whoever gets out of it or into it is 7 away from any room.
        let point = ray.at(hit.t);
        assert!(point.length() < 7.0, "{name}: bounce {i} leaks to {point}");
        assert_eq!(hit.sense, Sense::Enter, "{name}: bounce {i} is inside the shell");
        let normal = scene.normal_at(&ray, &hit);
        ray = Ray::new(point, reflected(ray.dir, normal));
        let next = tracer.next_hit(&ray, &hit);
        let Some(next) = next else { panic!("{name}: bounce {i} escapes along {ray:?}") };
        assert!(next.t >= 0.0 && next.t.is_finite(), "{name}: {next:?}");
        assert_no_self_hit(name, scene, &ray, &hit, &next);
        hit = next;
    }
    most
}

/// A plane is not met twice in a row, and nothing is at once, save in a corner.
fn assert_no_self_hit(
    name: &str,
    scene: &Scene,
    ray: &Ray,
    hit: &Crossing,
    next: &Crossing,
) {
    let same = (hit.leaf, hit.face) == (next.leaf, next.face);
    let kind = scene.leaf(hit.leaf).kind;
    let is_flat = matches!(kind, "cuboid" | "mesh") || hit.face > 0;
    assert!(!(same && is_flat), "{name}: {kind}: {ray:?}: {hit:?}, {next:?}");
    let sure = scene.error_at(ray, next);
    assert!(!same || next.t > sure, "{name}: {kind}: {ray:?}: {next:?} ± {sure:e}");
}

#[test]
fn n34_a_million_bounces_neither_leak_nor_hit_where_they_start() {
    let rooms = rooms();
    let each = BOUNCES.div_ceil(rooms.len());
    for (name, scene) in rooms {
        let (mut tracer, mut dice) = (scene.tracer(), Dice::new(33));
        let mut bounces = 0;
        while bounces < each {
            let start = dice.point(2.0);
            // A room's inside is a hole in the shell.
            if start.length() < 9.0 && !tracer.contains(start) {
                let ray = Ray::new(start, dice.direction());
                bounces += bounce(name, &scene, &mut tracer, ray, 500);
            }
        }
    }
}

/// Rays sent exactly into corners, edges, apexes and along the diagonals of rooms with
/// corners at whole numbers.
#[test]
fn n34_rays_into_corners_stay_in_the_room() {
    let rooms = [
        ("box", Solid::cuboid(DVec3::splat(4.0))),
        (
            "mesh box",
            Solid::mesh(meshes::grid_box(DVec3::splat(-2.0), DVec3::splat(2.0), 4)),
        ),
        ("cone", Solid::frustum(2.0, 0.0, 4.0).translated(-2.0 * DVec3::Z)),
        ("can", Solid::cylinder(2.0, 4.0).translated(-2.0 * DVec3::Z)),
    ];
    let mut dice = Dice::new(34);
    for (name, room) in rooms {
        let scene = scene(&(Solid::ball(10.0) - room));
        let mut tracer = scene.tracer();
        for i in 0..4000 {
            let start = if i % 2 == 0 { DVec3::ZERO } else { 0.3 * dice.point(1.0) };
            let whole = (2.0 * dice.point(2.4)).round() * 0.5;
            let ray = Ray::new(
                start,
                whole.clamp(DVec3::splat(-2.0), DVec3::splat(2.0)) - start,
            );
            if ray.is_valid() {
                bounce(name, &scene, &mut tracer, ray, 40);
            }
        }
    }
}

/// Plates nearer to one another than single precision, in which the points are kept where rays
/// have met the uppermost: only its identity tells that one from those below.
#[test]
fn rays_thrown_back_from_a_stack_of_thin_plates_do_not_meet_those_below() {
    let plate = |i: i32| {
        let top = -4e-9 * f64::from(i);
        Solid::cuboid(dvec3(4.0, 4.0, 2e-9)).translated(DVec3::Z * (top - 1e-9))
    };
    let stack = (0..20).map(plate).fold(Solid::empty(), |all, plate| all + plate);
    let (axis, angle) = (dvec3(1.0, 2.0, 3.0).normalize(), 0.7);
    let turn = DQuat::from_axis_angle(axis, angle);
    let scene = scene(&stack.rotated(axis, angle));
    let mut tracer = scene.tracer();
    let mut dice = Dice::new(5);
    let mut below = 0;
    for _ in 0..1000 {
        let to = dvec3(dice.within(-1.0, 1.0), dice.within(-1.0, 1.0), 0.0);
        let dir = dvec3(dice.within(-0.5, 0.5), dice.within(-0.5, 0.5), -1.0);
        let ray = Ray::new(turn * (to - 3.0 * dir), turn * dir);
        let hit = tracer.first_hit(&ray).expect("the stack is wide");
        let point = ray.at(hit.t).as_vec3().as_dvec3();
        below += usize::from((turn.inverse() * point).z < -4e-9);
        let ray = Ray::new(point, reflected(ray.dir, scene.normal_at(&ray, &hit)));
        assert_eq!(tracer.next_hit(&ray, &hit), None, "{ray:?}");
    }
    assert!(below > 100, "only {below} points are below the uppermost plate");
}

/// Rays that come from afar end a long way, in units of rounding, off the surface.
#[test]
fn n34_rays_from_afar_leave_where_they_hit() {
    let mut dice = Dice::new(35);
    for solid in [
        Solid::ball(1.0),
        Solid::cuboid(DVec3::splat(1.5)),
        Solid::mesh(meshes::icosphere(2)),
        Solid::frustum(1.0, 0.2, 1.0),
    ] {
        let scene = scene(&solid);
        let mut tracer = scene.tracer();
        for _ in 0..5000 {
            let from = 1e6 * dice.direction();
            let ray = Ray::new(from, 0.4 * dice.direction() - from);
            let Some(hit) = tracer.first_hit(&ray) else { continue };
            let (point, normal) = (ray.at(hit.t), scene.normal_at(&ray, &hit));
            let chord = tracer.spans(&ray)[0].length() * ray.speed();
            // These are convex: what is thrown back is gone, what goes on comes out.
            let back = Ray::new(point, reflected(ray.dir.normalize(), normal));
            assert_eq!(tracer.next_hit(&back, &hit), None, "{ray:?}");
            let on = Ray::new(point, ray.dir.normalize());
            let out = tracer.next_hit(&on, &hit).expect("what goes in comes out");
            assert_eq!(out.sense, Sense::Exit);
            // The point is off by u · 10⁶ in any direction.
            let near = 1e-9 / (1e-3 + normal.dot(on.dir).abs());
            assert!((out.t - chord).abs() < near, "{ray:?}: {out:?}, {chord}");
        }
    }
}
