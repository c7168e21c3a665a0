//! Each primitive against numbers of 200 bits: from afar, at grazes, beside apexes, under
//! maps. u = 2⁻⁵³ is the rounding unit; R is a radius and ρ a distance in such radii.

#[expect(dead_code, reason = "primitives need no trees")]
mod oracle;
#[expect(dead_code, reason = "primitives are drawn by lot")]
mod support;

use glam::{DAffine3, DMat3, DVec3, dvec3};
use oracle::placed::{Placed, U};
use oracle::real::Real;
use solidray::{Ray, Scene, Sense};
use support::dice::Dice;
use support::leaf::{self, Leaf};
use support::model::Model;
use support::{ends_in, scene, spans};

/// A leaf both ways.
struct Case {
    scene: Scene,
    exact: Placed,
}

impl Case {
    fn new(leaf: &Leaf, maps: &[DAffine3]) -> Self {
        let plain = Model::Leaf(leaf.clone());
        let model = maps.iter().rev().fold(plain, |model, map| model.mapped(*map));
        Self { scene: scene(&model.solid()), exact: Placed::new(leaf, maps) }
    }

    /// The one span of a ray and what it should be.
    fn span(&self, ray: &Ray) -> ([f64; 2], [Real; 2]) {
        let (found, exact) = (ends_in(&self.scene, ray), self.exact.crossings(ray));
        assert_eq!((found.len(), exact.len()), (1, 2), "{ray:?}: {found:?}, {exact:?}");
        (found[0], [exact[0].0.clone(), exact[1].0.clone()])
    }
}

fn off(found: f64, exact: &Real) -> f64 {
    (Real::exact(found) - exact).rounded().abs()
}

/// The error of the length of a span, as a part of it.
fn off_in_length(found: [f64; 2], exact: &[Real; 2]) -> f64 {
    let length = &exact[1] - &exact[0];
    let found = Real::exact(found[1]) - Real::exact(found[0]);
    ((found - &length) / &length).rounded().abs()
}

/// 10 to a power from `low` to `high`.
fn power(dice: &mut Dice, low: f64, high: f64) -> f64 {
    10.0_f64.powf(dice.within(low, high))
}

/// A ray that passes the origin at a distance, from a place `rho` before that.
fn passing(dice: &mut Dice, impact: f64, rho: f64) -> Ray {
    let dir = dice.direction();
    let side = dir.cross(dice.direction()).normalize();
    Ray::new(impact * side - rho * dir, dir)
}

#[test]
fn n01_a_ball_is_hit_within_4_u_rho_r_from_1e12_radii() {
    let (mut dice, mut worst) = (Dice::new(101), 0.0_f64);
    for i in 0..1200 {
        let radius = power(&mut dice, -3.0, 3.0);
        let ball = Case::new(&Leaf::Ball { radius }, &[]);
        let rho = 10.0_f64.powi(i % 13);
        let impact = dice.within(0.0, 0.94);
        let ray = passing(&mut dice, radius * impact, radius * rho);
        let (found, exact) = ball.span(&ray);
        for (found, exact) in found.iter().zip(&exact) {
            let error = off(*found, exact) * ray.speed();
            worst = worst.max(error / (U * (rho + 1.0) * radius));
        }
    }
    assert!(worst <= 4.0, "{worst}");
}

#[test]
fn n02_a_chord_is_exact_to_4e_15_and_the_rounding_of_its_ends() {
    let (mut dice, mut worst) = (Dice::new(102), 0.0_f64);
    let ball = Case::new(&Leaf::Ball { radius: 1.0 }, &[]);
    for i in 0..1300 {
        let rho = 10.0_f64.powi(i % 13);
        let impact = dice.within(0.0, 0.94);
        let ray = passing(&mut dice, impact, rho);
        let (found, exact) = ball.span(&ray);
        let chord = (&exact[1] - &exact[0]).rounded();
        let ends = U * (found[0].abs() + found[1].abs());
        let error = off_in_length(found, &exact) * chord;
        worst = worst.max((error - ends) / chord);
    }
    assert!(worst <= 4e-15, "{worst:e}");
}

#[test]
fn n03_a_graze_of_delta_is_found_and_is_exact_to_2_u_over_delta() {
    let (mut dice, mut worst) = (Dice::new(103), 0.0_f64);
    let ball = Case::new(&Leaf::Ball { radius: 1.0 }, &[]);
    for _ in 0..1000 {
        let delta = power(&mut dice, -12.0, -2.0);
        let ray = passing(&mut dice, 1.0 - delta, 1.0);
        let (found, exact) = ball.span(&ray);
        worst = worst.max(off_in_length(found, &exact) * delta / U);
    }
    assert!(worst <= 2.0, "{worst}");
}

#[test]
fn n04_a_cylinder_is_crossed_to_2e_15_at_1e_12_to_its_axis_and_at_its_caps_along_it() {
    let (mut dice, mut worst) = (Dice::new(104), 0.0_f64);
    for _ in 0..1000 {
        let theta = power(&mut dice, -12.0, 0.0);
        let height = 16.0 / theta;
        let rod = Case::new(&Leaf::Cylinder { radius: 1.0, height }, &[]);
        let turn = DMat3::from_rotation_z(dice.within(-3.0, 3.0));
        let side = dice.within(-0.94, 0.94);
        let through = turn * dvec3(0.0, side, 0.0) + dvec3(0.0, 0.0, 0.5 * height);
        let ray = Ray::new(through, turn * dvec3(theta, 0.0, 1.0));
        let (found, exact) = rod.span(&ray);
        worst = worst.max(off_in_length(found, &exact));
        let along = Ray::new(through - dvec3(0.0, 0.0, height), DVec3::Z);
        let (found, exact) = rod.span(&along);
        for (found, exact) in found.iter().zip(&exact) {
            assert!(off(*found, exact) <= 2.0 * U * found.abs(), "{along:?}: {found}");
        }
        let faces = spans(&rod.scene, &along);
        assert_eq!([faces[0].enter.face, faces[0].exit.face], [1, 2]);
    }
    assert!(worst <= 2e-15, "{worst:e}");
}

#[test]
fn n05_a_cone_is_exact_to_1e_15_at_1e_12_from_its_apex_and_even_through_it() {
    let (mut dice, mut worst) = (Dice::new(105), 0.0_f64);
    let cone = Case::new(&Leaf::Frustum { bottom: 0.0, top: 1.0, height: 1.0 }, &[]);
    for _ in 0..1000 {
        let eps = power(&mut dice, -12.0, -1.0);
        let side = dice.direction().truncate() * dice.within(0.0, 0.99);
        let dir = dice.direction();
        // Along a generator the other root is at infinity, and as uncertain.
        if (dir.z * dir.z - dir.truncate().length_squared()).abs() < 0.1 {
            continue;
        }
        let ray = Ray::new(eps * side.extend(1.0) - dir, dir);
        let (found, exact) = cone.span(&ray);
        for (found, exact) in found.iter().zip(&exact) {
            worst = worst.max(off(*found, exact));
        }
        // A list of spans has an even number of ends; beside the cone there is no span, or
        // one of a few roundings.
        let through = ends_in(&cone.scene, &Ray::new(-dir, dir));
        let inside = dir.z * dir.z > dir.truncate().length_squared();
        let length: f64 = through.iter().map(|[enter, exit]| exit - enter).sum();
        assert!(inside == (length > 16.0 * U), "{dir}: {through:?}");
    }
    assert!(worst <= 1e-15, "{worst:e}");
}

/// A leaf of any kind.
fn leaf(dice: &mut Dice) -> Leaf {
    let lengths = [(); 3].map(|()| dice.within(0.2, 2.0));
    leaf::of_lengths(dice, lengths)
}

/// A turn, a stretch or a shear, another turn and a move.
fn maps(dice: &mut Dice, stretch: DVec3, shear: f64) -> Vec<DAffine3> {
    let shear = DMat3::from_cols(DVec3::X, dvec3(shear, 1.0, 0.0), DVec3::Z);
    vec![
        DAffine3::from_translation(dice.point(10.0)),
        DAffine3::from_mat3(dice.rotation()),
        DAffine3::from_mat3(DMat3::from_diagonal(stretch) * shear),
        DAffine3::from_mat3(dice.rotation()),
    ]
}

/// A ray into the bounds of a scene, from a few times its size away.
fn into(scene: &Scene, dice: &mut Dice) -> Ray {
    let bounds = scene.bounds();
    let part = 0.5 * (dice.point(1.0) + DVec3::ONE);
    let dir = bounds.size().length() * dice.direction();
    Ray::new(bounds.min + part * bounds.size() - 3.0 * dir, dir)
}

/// The largest distance of crossings from their faces, in units of what n06 allows.
fn worst_residual(case: &Case, ray: &Ray) -> f64 {
    let ratio = |crossing: solidray::Crossing| {
        let lengths =
            ray.speed() * crossing.t.abs() + ray.origin.length() + case.exact.reach;
        let allowed = 8.0 * U * lengths * case.exact.condition;
        case.exact.distance(crossing.face, ray, crossing.t) / allowed
    };
    let found = spans(&case.scene, ray);
    found.iter().flat_map(|s| [s.enter, s.exit]).map(ratio).fold(0.0, f64::max)
}

/// Without the division by the angle between ray and face that the error of `t` needs.
#[test]
fn n06_a_crossing_is_on_its_face_within_8_u_of_the_lengths_at_hand() {
    let (mut dice, mut worst) = (Dice::new(106), 0.0_f64);
    for _ in 0..1000 {
        let stretch = dvec3(dice.within(0.5, 2.0), -dice.within(0.5, 2.0), 1.0);
        let (leaf, maps) = (leaf(&mut dice), maps(&mut dice, stretch, 0.3));
        let case = Case::new(&leaf, &maps);
        worst = worst.max(worst_residual(&case, &into(&case.scene, &mut dice)));
    }
    assert!(worst <= 1.0, "{worst}");
}

#[test]
fn n07_a_normal_is_a_unit_within_4_u_faces_the_right_way_and_is_that_of_the_gradient() {
    let mut dice = Dice::new(107);
    for _ in 0..1000 {
        let stretch = dvec3(dice.within(0.2, 5.0), -dice.within(0.2, 5.0), 1.0);
        let (leaf, maps) = (leaf(&mut dice), maps(&mut dice, stretch, 0.5));
        let case = Case::new(&leaf, &maps);
        let ray = into(&case.scene, &mut dice);
        for crossing in spans(&case.scene, &ray).iter().flat_map(|s| [s.enter, s.exit]) {
            let normal = case.scene.normal_at(&ray, &crossing);
            let exact = case.exact.normal(crossing.face, &ray, crossing.t);
            assert!((normal.length() - 1.0).abs() <= 4.0 * U, "{normal}");
            assert!((normal - exact).length() <= 1e-6, "{normal} {exact}");
            let against = exact.dot(ray.dir) / ray.speed();
            let enters = crossing.sense == Sense::Enter;
            assert!((against < 0.0) == enters || against.abs() < 1e-7, "{crossing:?}");
        }
    }
}

#[test]
fn n15_under_stretches_of_1e6_and_shears_the_residual_grows_by_the_condition_only() {
    let (mut dice, mut worst) = (Dice::new(115), 0.0_f64);
    for i in 0..1000 {
        let (stretch, shear) = match i % 3 {
            0 => (dvec3(1.0, 1e6, 1.0), 0.0),
            1 => (dvec3(1e-3, 1.0, 1e3), 0.0),
            _ => (DVec3::ONE, dice.within(-1e3, 1e3)),
        };
        let (leaf, maps) = (leaf(&mut dice), maps(&mut dice, stretch, shear));
        let case = Case::new(&leaf, &maps);
        worst = worst.max(worst_residual(&case, &into(&case.scene, &mut dice)));
    }
    assert!(worst <= 1.0, "{worst}");
}
