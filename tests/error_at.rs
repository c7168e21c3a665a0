//! The bound on a crossing's error against the error itself, which 200 bits tell.
//!
//! One leaf of every kind under maps that move it far, squeeze it a million times and shear
//! it, and rays that come from afar, graze it or run almost along its faces.
//! `PROPTEST_CASES=10000 cargo test --test error_at` looks for longer.

#[expect(dead_code, reason = "crossings of one leaf need no tree")]
mod oracle;
#[expect(dead_code, reason = "leaves are drawn by lot")]
mod support;

use glam::{DAffine3, DMat3, DVec3, dvec3};
use oracle::placed::{Placed, U};
use oracle::real::Real;
use proptest::prelude::ProptestConfig;
use solidray::{Crossing, Ray, Scene};
use support::dice::Dice;
use support::leaf::{self, Leaf};
use support::model::Model;
use support::{scene, spans};

/// 10 to a power from `low` to `high`.
fn power(dice: &mut Dice, low: f64, high: f64) -> f64 {
    10.0_f64.powf(dice.within(low, high))
}

fn leaf(dice: &mut Dice) -> Leaf {
    let size = power(dice, -2.0, 2.0);
    let lengths = [(); 3].map(|()| size * dice.within(0.2, 2.0));
    leaf::of_lengths(dice, lengths)
}

/// How a leaf is placed: turned, and then one of several extremes.
fn maps(dice: &mut Dice) -> Vec<DAffine3> {
    let turn = DAffine3::from_mat3(dice.rotation());
    let moved = DAffine3::from_translation(dice.point(10.0));
    let extreme = match dice.below(6) {
        0 => return Vec::new(),
        1 => DAffine3::IDENTITY,
        2 => DAffine3::from_translation(1e6 * dice.direction()),
        3 => DAffine3::from_scale(DVec3::from_array(
            [(); 3].map(|()| power(dice, -3.0, 3.0)),
        )),
        4 => DAffine3::from_mat3(DMat3::from_cols(
            DVec3::X,
            dvec3(dice.within(-30.0, 30.0), 1.0, 0.0),
            dvec3(dice.within(-3.0, 3.0), dice.within(-3.0, 3.0), -1.0),
        )),
        _ => DAffine3::from_scale(DVec3::splat(power(dice, -30.0, 30.0))),
    };
    let again = DAffine3::from_mat3(dice.rotation());
    vec![turn, extreme, moved, again]
}

/// A ray through the solid from up to 1e12 times as far as it is large.
fn from_afar(scene: &Scene, dice: &mut Dice) -> Ray {
    let bounds = scene.bounds();
    let part = dvec3(dice.within(0.0, 1.0), dice.within(0.0, 1.0), dice.within(0.0, 1.0));
    let through = bounds.min + part * bounds.size();
    let dir = dice.direction() * bounds.size().length();
    Ray::new(through - power(dice, -1.0, 12.0) * dir, dir * power(dice, -3.0, 3.0))
}

/// A ray through a crossing of another one, at an angle down to 1e-12 to the surface.
fn grazing(scene: &Scene, ray: &Ray, crossing: &Crossing, dice: &mut Dice) -> Ray {
    let normal = scene.normal_at(ray, crossing);
    let along = normal.cross(dice.direction()).normalize();
    let dir = along + power(dice, -12.0, 0.0) * normal;
    let dir = dir * scene.bounds().size().length();
    Ray::new(ray.at(crossing.t) - power(dice, -3.0, 2.0) * dir, dir)
}

/// What is known of a crossing.
struct Sample {
    /// Its error and the bound on it, in multiples of the direction.
    error: f64,
    bound: f64,
    /// What a few roundings of the lengths at hand come to, at the angle at which it is
    /// crossed, if that and the map are harmless.
    plain: Option<f64>,
}

fn samples(scene: &Scene, leaf: &Placed, ray: &Ray) -> Vec<Sample> {
    let exact = leaf.crossings(ray);
    let found = spans(scene, ray);
    let found: Vec<Crossing> = found.iter().flat_map(|s| [s.enter, s.exit]).collect();
    if found.len() != exact.len() {
        // At a graze a span may be found where there is none, or the other way round.
        return Vec::new();
    }
    let sample = |(crossing, (exact, _)): (Crossing, (Real, bool))| {
        let error = (Real::exact(crossing.t) - exact).rounded().abs();
        let bound = scene.error_at(ray, &crossing);
        assert!(error <= bound, "{error:e} > {bound:e}: {ray:?}: {crossing:?}");
        let cosine = scene.normal_at(ray, &crossing).dot(ray.dir).abs() / ray.speed();
        let lengths = ray.origin.length() + ray.speed() * crossing.t.abs() + leaf.spread;
        let plain = U * lengths / (cosine * ray.speed());
        let is_plain = leaf.condition < 30.0 && cosine > 0.1;
        Sample { error, bound, plain: is_plain.then_some(plain) }
    };
    found.into_iter().zip(exact).map(sample).collect()
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

#[test]
fn no_crossing_is_farther_off_than_its_bound_and_no_bound_is_absurd() {
    let mut dice = Dice::new(21);
    let (mut all, mut steep) = (Vec::new(), Vec::new());
    for _ in 0..8 * ProptestConfig::default().cases {
        let (leaf, maps) = (leaf(&mut dice), maps(&mut dice));
        let model = maps
            .iter()
            .rev()
            .fold(Model::Leaf(leaf.clone()), |model, map| model.mapped(*map));
        let (scene, placed) = (scene(&model.solid()), Placed::new(&leaf, &maps));
        let ray = from_afar(&scene, &mut dice);
        let of_ray = samples(&scene, &placed, &ray);
        steep.extend(of_ray.iter().filter_map(|s| Some(s.bound / s.plain?)));
        all.extend(of_ray);
        if let Some(span) = spans(&scene, &ray).first() {
            let ray = grazing(&scene, &ray, &span.exit, &mut dice);
            all.extend(samples(&scene, &placed, &ray));
        }
    }
    // Many errors are next to nothing by luck.
    let ratios = all.iter().filter(|s| s.error > 0.0);
    let ratio = median(ratios.map(|s| s.bound / s.error).collect());
    let steep_worst = steep.iter().copied().fold(0.0, f64::max);
    let steep = median(steep);
    assert!(
        ratio < 300.0 && steep < 5.0 && steep_worst < 200.0,
        "{ratio} {steep} {steep_worst}"
    );
}
