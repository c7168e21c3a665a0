//! What the fuzz targets share: what must hold for whatever a reader makes of any bytes.

#[path = "../../tests/support/valid.rs"]
mod valid;
pub mod words;

use std::path::Path;

use glam::{DVec3, dvec3};
use solidray::read::{self, Format, Model, ReadError, ReadErrorKind, ReadOptions};
use solidray::{Aabb, Place, Ray, Scene, Solid};

/// The largest solid that is compiled: larger ones are legal, but take their time.
const MOST_LEAVES: u64 = 2_000;

/// Directions of the rays: along axes, within planes of two axes, and askew.
const DIRECTIONS: [DVec3; 6] = [
    DVec3::X,
    DVec3::Y,
    DVec3::NEG_Z,
    dvec3(1.0, 1.0, 0.0),
    dvec3(0.0, -2.0, 1.0),
    dvec3(0.3, 0.7, -0.6),
];

/// Reads bytes, and asks what they describe, if they do.
///
/// # Panics
///
/// If anything that must hold does not.
pub fn check(bytes: &[u8], format: Format, options: &ReadOptions) {
    // A folder that does not exist, so that nothing is found to import.
    let path = Path::new("/nonexistent/fuzz/part");
    match read::bytes(bytes, path, format, options) {
        Ok(model) => check_model(&model, bytes),
        Err(error) => check_error(&error, bytes, format),
    }
}

fn check_error(error: &ReadError, bytes: &[u8], format: Format) {
    let said = error.kind.to_string();
    assert!(!said.trim().is_empty(), "nothing is said: {error:?}");
    assert!(said.len() < 2_000, "too much is said: {error:?}");
    let whole = match &error.kind {
        // Whole files are plane or cut short.
        ReadErrorKind::TwoDimensional | ReadErrorKind::Truncated { .. } => true,
        // Nothing says where a face or a point of a mesh file came from.
        ReadErrorKind::Mesh(_) | ReadErrorKind::NoSuchPoint => format != Format::Csg,
        // A file too short to be binary, and without the first word of text.
        ReadErrorKind::Syntax { .. } => format == Format::Stl && error.place.is_none(),
        _ => false,
    };
    assert_eq!(error.place.is_none(), whole, "the place: {error:?}");
    if let Some(place) = error.place {
        check_place(place, bytes);
    }
}

fn check_model(model: &Model, bytes: &[u8]) {
    for warning in &model.warnings {
        assert!(!warning.message.trim().is_empty(), "nothing is said: {warning:?}");
        if let Some(place) = warning.place {
            check_place(place, bytes);
        }
    }
    check_solid(&model.solid);
}

/// A place is in the text, or just behind it.
fn check_place(place: Place, bytes: &[u8]) {
    let line = bytes.split(|&b| b == b'\n').nth((place.line as usize).wrapping_sub(1));
    let length = line.map_or(0, <[u8]>::len);
    let column = place.column as usize;
    assert!((1..=length + 1).contains(&column), "{place:?} is not in the text");
}

fn check_solid(solid: &Solid) {
    if solid.census().leaves > MOST_LEAVES {
        return;
    }
    match Scene::compile(solid) {
        Ok(scene) => check_scene(&scene),
        Err(error) => assert!(!error.to_string().is_empty(), "nothing is said"),
    }
}

fn check_scene(scene: &Scene) {
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
        assert!(!inside || holds(&bounds, origin), "{origin} is inside");
        for dir in DIRECTIONS {
            let ray = Ray::new(origin, dir);
            let spans = tracer.spans(&ray).to_vec();
            valid::assert_spans_valid(scene, &ray, &spans);
            assert!(spans.is_empty() || !bounds.is_empty(), "{spans:?}");
        }
    }
}

/// Whether a point is within some bounds, ends included.
fn holds(bounds: &Aabb, p: DVec3) -> bool {
    p.cmpge(bounds.min).all() && p.cmple(bounds.max).all()
}
