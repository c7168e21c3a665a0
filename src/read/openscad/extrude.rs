//! `linear_extrude`.

use super::super::error::Located;
use super::arguments::Call;
use super::combine;
use super::evaluate::Reading;
use super::node::Shape;
use super::outlines::lifted;
use super::solids::is_size;

pub(super) const PARAMETERS: &[&str] = &[
    "height",
    "center",
    "convexity",
    "twist",
    "slices",
    "scale",
    "segments",
    "v",
    "h",
    "file",
    "layer",
    "origin",
    "timestamp",
];

/// The prism over the plane children. A height that is not positive makes nothing.
pub(super) fn linear_extrude(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let height = match call.number("height")? {
        Some(height) => height,
        None => call.number("h")?.unwrap_or(100.0),
    };
    let center = call.truth("center")?;
    let twist = call.number("twist")?.unwrap_or(0.0);
    let scale: [f64; 2] = call.sizes("scale")?.unwrap_or([1.0; 2]);
    if !is_size(height) {
        return Ok(Shape::Empty);
    }
    #[expect(clippy::float_cmp, reason = "whatever is not 1 is a scale")]
    let scaled = scale != [1.0; 2];
    for (bad, what) in [
        (twist != 0.0, "twist"),
        (scaled, "scale"),
        (call.value("v").is_some(), "v"),
        (call.value("file").is_some(), "file"),
    ] {
        if bad {
            return Err(call.unsupported(format!("`linear_extrude` with `{what}`")));
        }
    }
    let mut flat = children;
    let before = flat.len();
    flat.retain(|child| !matches!(child, Shape::Solid(_)));
    if flat.len() < before {
        let message = "`linear_extrude` ignores three-dimensional children";
        reading.warn(call.place(), message);
    }
    let heights = if center { [-0.5 * height, 0.5 * height] } else { [0.0, height] };
    Ok(match combine::union(call, flat, reading)? {
        Shape::Flat(prism) => Shape::Solid(lifted(prism, heights).as_outline()),
        Shape::Empty | Shape::Solid(_) => Shape::Empty,
    })
}
