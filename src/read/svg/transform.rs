//! The attribute `transform`.

use glam::{DAffine2, DMat2, DVec2};

use super::shape::number;
use crate::angle::{cos_deg, sin_deg};

/// The map that a text describes. Operations with a wrong number of arguments are none, and words
/// that are no numbers are 0.
pub(super) fn map(text: &str) -> DAffine2 {
    let mut map = DAffine2::IDENTITY;
    for operation in text.split(')') {
        let Some((name, arguments)) = operation.split_once('(') else { continue };
        let name = name.trim_matches([' ', ',']);
        let words = arguments.split([' ', ',']).filter(|word| !word.is_empty());
        let numbers: Vec<f64> = words.take(7).map(number).collect();
        map *= one(name, &numbers).unwrap_or(DAffine2::IDENTITY);
    }
    map
}

fn one(name: &str, numbers: &[f64]) -> Option<DAffine2> {
    let linear = |x: [f64; 2], y: [f64; 2]| {
        DAffine2::from_mat2(DMat2::from_cols(DVec2::from_array(x), DVec2::from_array(y)))
    };
    let moved = |x, y| DAffine2::from_translation(DVec2::new(x, y));
    let turned = |angle| {
        let (cos, sin) = (cos_deg(angle), sin_deg(angle));
        linear([cos, sin], [-sin, cos])
    };
    let tan = |angle| sin_deg(angle) / cos_deg(angle);
    Some(match (name, numbers) {
        ("matrix", &[a, b, c, d, e, f]) => moved(e, f) * linear([a, b], [c, d]),
        ("translate", &[x]) => moved(x, 0.0),
        ("translate", &[x, y]) => moved(x, y),
        ("scale", &[s]) => linear([s, 0.0], [0.0, s]),
        ("scale", &[x, y]) => linear([x, 0.0], [0.0, y]),
        ("rotate", &[angle]) => turned(angle),
        ("rotate", &[angle, x, y]) => moved(x, y) * turned(angle) * moved(-x, -y),
        ("skewX", &[angle]) => linear([1.0, 0.0], [tan(angle), 1.0]),
        ("skewY", &[angle]) => linear([1.0, tan(angle)], [0.0, 1.0]),
        _ => return None,
    })
}
