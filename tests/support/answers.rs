//! A few questions to any scene at all, for tests of what files describe and for the fuzz
//! targets.

use glam::{DVec3, dvec3};
use solidray::{Aabb, Ray, Scene};

use super::valid::assert_spans_valid;

/// Directions of the rays: along axes, within planes of two axes, and askew.
const DIRECTIONS: [DVec3; 6] = [
    DVec3::X,
    DVec3::Y,
    DVec3::NEG_Z,
    dvec3(1.0, 1.0, 0.0),
    dvec3(0.0, -2.0, 1.0),
    dvec3(0.3, 0.7, -0.6),
];

/// Asks about points and casts rays, through the origin and through corners, the middle and
/// another point of the bounds.
pub(crate) fn assert_answers_valid(scene: &Scene) {
    let bounds = scene.bounds();
    assert!(bounds.is_empty() || bounds.is_bounded(), "{bounds:?}");
    let places = if bounds.is_empty() {
        vec![DVec3::ZERO]
    } else {
        let Aabb { min, max } = bounds;
        let within = min + dvec3(0.37, 0.61, 0.23) * bounds.size();
        vec![DVec3::ZERO, bounds.center(), within, min, max]
    };
    let mut tracer = scene.tracer();
    for origin in places.into_iter().filter(|p| p.is_finite()) {
        let inside = tracer.contains(origin);
        assert!(
            !inside || is_near(&bounds, origin),
            "{origin} is inside, not {bounds:?}"
        );
        for dir in DIRECTIONS {
            let ray = Ray::new(origin, dir);
            let spans = tracer.spans(&ray).to_vec();
            assert_spans_valid(scene, &ray, &spans);
            assert!(spans.is_empty() || !bounds.is_empty(), "{ray:?}: {spans:?}");
        }
    }
}

/// Whether a point is within some bounds, but for what the rounding of coordinates as large
/// as theirs can do.
fn is_near(bounds: &Aabb, p: DVec3) -> bool {
    let far = bounds.min.abs().max(bounds.max.abs()).max(p.abs()).max_element();
    let slack = DVec3::splat(1e-12 * far);
    p.cmpge(bounds.min - slack).all() && p.cmple(bounds.max + slack).all()
}
