//! What all tests of spans share.

use glam::DVec3;
use solidray::{Ray, Scene, Sense, Solid, Span};

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

/// The ends of the spans of one ray.
pub(crate) fn ends(solid: &Solid, ray: &Ray) -> Vec<[f64; 2]> {
    spans(&scene(solid), ray).iter().map(|s| [s.enter.t, s.exit.t]).collect()
}

/// What every list of spans must be: finite, in order, disjoint, none empty, owned by
/// leaves and faces that exist, with unit normals against the ray where it enters.
pub(crate) fn assert_spans_valid(scene: &Scene, ray: &Ray, spans: &[Span]) {
    let mut last = f64::NEG_INFINITY;
    for span in spans {
        for (crossing, sense) in [(span.enter, Sense::Enter), (span.exit, Sense::Exit)] {
            assert!(crossing.t.is_finite(), "{ray:?}: {span:?}");
            assert!(crossing.t > last, "out of order: {ray:?}: {spans:?}");
            last = crossing.t;
            assert_eq!(crossing.sense, sense, "{ray:?}: {span:?}");
            let leaf = scene.leaf(crossing.leaf);
            assert!(crossing.face < leaf.faces, "{ray:?}: {span:?}");
            let normal = scene.normal_at(ray, &crossing);
            assert!((normal.length() - 1.0).abs() < 1e-12, "{ray:?}: {span:?}: {normal}");
            let along = normal.dot(ray.dir);
            assert!(if sense == Sense::Enter { along <= 0.0 } else { along >= 0.0 });
        }
    }
}

/// A ray along the x-axis at this y and z.
pub(crate) fn along_x(y: f64, z: f64) -> Ray {
    Ray::new(DVec3::new(-10.0, y, z), DVec3::X)
}
