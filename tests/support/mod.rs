//! What all tests of spans share.
//!
//! A test file takes what it needs: `#[expect(dead_code, reason = "…")] mod support;`.

pub(crate) mod aim;
pub(crate) mod algebra;
pub(crate) mod dice;
pub(crate) mod leaf;
pub(crate) mod meshes;
pub(crate) mod model;
pub(crate) mod nearness;
pub(crate) mod strategies;
mod valid;

use glam::DVec3;
use solidray::{Ray, Scene, Solid, Span};
pub(crate) use valid::assert_spans_valid;

/// A compiled scene.
pub(crate) fn scene(solid: &Solid) -> Scene {
    Scene::compile(solid).expect("the test's solid is right")
}

/// The spans of one ray, checked.
pub(crate) fn spans(scene: &Scene, ray: &Ray) -> Vec<Span> {
    let spans = scene.tracer().spans(ray).to_vec();
    assert_spans_valid(scene, ray, &spans);
    spans
}

/// The ends of the spans of one ray in a scene, checked.
pub(crate) fn ends_in(scene: &Scene, ray: &Ray) -> Vec<[f64; 2]> {
    spans(scene, ray).iter().map(|s| [s.enter.t, s.exit.t]).collect()
}

/// The ends of the spans of one ray.
pub(crate) fn ends(solid: &Solid, ray: &Ray) -> Vec<[f64; 2]> {
    ends_in(&scene(solid), ray)
}

/// The total length of some spans, in multiples of the direction.
pub(crate) fn total(ends: &[[f64; 2]]) -> f64 {
    ends.iter().map(|[enter, exit]| exit - enter).sum()
}

/// Whether a place on a ray is inside a span.
pub(crate) fn covers(ends: &[[f64; 2]], t: f64) -> bool {
    ends.iter().any(|[enter, exit]| *enter <= t && t < *exit)
}

/// A ray along the x-axis at this y and z.
pub(crate) fn along_x(y: f64, z: f64) -> Ray {
    Ray::new(DVec3::new(-10.0, y, z), DVec3::X)
}
