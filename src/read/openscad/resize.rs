//! `resize`.

use glam::{DAffine2, DAffine3, DVec2, DVec3};

use super::super::error::Located;
use super::arguments::Call;
use super::combine;
use super::convex::{parts, polygons};
use super::evaluate::Reading;
use super::node::Shape;
use super::value::Value;
use crate::aabb::Aabb;
use crate::facets::bounds_of_union;

/// The children scaled about the origin to a size along the axes. An axis with a size of 0 or less
/// keeps its scale, or takes that of the axis with the largest new size where `auto` says so.
pub(super) fn resize(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let mut wanted = [0.0; 3];
    for (size, value) in
        wanted.iter_mut().zip(call.vector("newsize")?.unwrap_or_default())
    {
        let number = call.document.number(value).filter(|x| x.is_finite());
        *size = number.ok_or_else(|| call.wrong("newsize", "finite numbers", value))?;
    }
    let auto = auto(call)?;
    Ok(match combine::union(call, children, reading)? {
        Shape::Empty => Shape::Empty,
        Shape::Solid(solid) => {
            let bounds = match bounds_of_union(&solid) {
                Some(bounds) => bounds,
                None => {
                    let parts = parts(&solid, call, reading)?;
                    parts.iter().fold(Aabb::EMPTY, |b, mesh| b.hull(mesh.bounds()))
                }
            };
            // Facets that are only measured are none of the model.
            reading.is_fine.set(false);
            match factors(bounds.size().to_array(), wanted, auto) {
                Some(scale) => Shape::Solid(
                    solid.mapped(DAffine3::from_scale(DVec3::from_array(scale))),
                ),
                None => Shape::Empty,
            }
        }
        Shape::Flat(outline) => {
            let [low, high] = outline.bounds_of_union().unwrap_or_else(|| {
                let paths = polygons(&outline, reading);
                paths
                    .into_iter()
                    .flatten()
                    .fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], p| {
                        [low.min(p), high.max(p)]
                    })
            });
            reading.is_fine.set(false);
            let size = (high - low).extend(1.0).to_array();
            match factors(size, wanted, auto) {
                Some([x, y, _]) => {
                    Shape::Flat(outline.mapped(DAffine2::from_scale(DVec2::new(x, y))))
                }
                None => Shape::Empty,
            }
        }
    })
}

/// One truth for all axes, or one for each.
fn auto(call: &Call<'_>) -> Result<[bool; 3], Located> {
    let Some(value) = call.value("auto") else { return Ok([false; 3]) };
    let truth = |value: u32| match call.document.values[value as usize] {
        Value::Bool(truth) => Ok(truth),
        Value::Number(number) => Ok(number != 0.0),
        Value::Undef | Value::Text { .. } | Value::Vector { .. } => {
            Err(call.wrong("auto", "true, false or a vector of them", value))
        }
    };
    let Value::Vector { .. } = call.document.values[value as usize] else {
        return Ok([truth(value)?; 3]);
    };
    let mut found = [false; 3];
    for (auto, value) in found.iter_mut().zip(call.document.elements(value)) {
        *auto = truth(value)?;
    }
    Ok(found)
}

/// What an axis is scaled by; `None` of what has no size to be scaled.
fn factors(size: [f64; 3], wanted: [f64; 3], auto: [bool; 3]) -> Option<[f64; 3]> {
    let own = |i: usize| if wanted[i] > 0.0 { wanted[i] / size[i] } else { 1.0 };
    let largest = (1..3).fold(0, |m, i| if wanted[i] > wanted[m] { i } else { m });
    let factor = |i: usize| {
        let is_auto = auto[i] && wanted[i] <= 0.0;
        own(if is_auto { largest } else { i })
    };
    let found = [0, 1, 2].map(factor);
    found.iter().all(|f| *f > 0.0 && f.is_finite()).then_some(found)
}
