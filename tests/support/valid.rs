//! The checker of spans, for all tests and for the fuzz targets.

use solidray::{Ray, Scene, Sense, Span};

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
