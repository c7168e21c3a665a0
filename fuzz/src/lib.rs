//! What the fuzz targets share: what must hold for whatever a reader makes of any bytes.

#[path = "../../tests/support/answers.rs"]
mod answers;
#[path = "../../tests/support/valid.rs"]
mod valid;
pub mod words;

use std::path::Path;

use solidray::read::{self, Format, Model, ReadError, ReadErrorKind, ReadOptions};
use solidray::{CompileOptions, Place, Scene, Solid};

/// The largest solid that is compiled, with what occurs more than once counted as often: larger
/// ones are legal, but take their time.
const MOST_NODES: u64 = 4_000;

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
        // Places are in the parts of an archive.
        _ => format == Format::ThreeMf,
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
    let options = CompileOptions { most_nodes: MOST_NODES, ..CompileOptions::default() };
    match Scene::compile_with(solid, &options) {
        Ok(scene) => answers::assert_answers_valid(&scene),
        Err(error) => assert!(!error.to_string().is_empty(), "nothing is said"),
    }
}
