//! `cube`, `sphere` and `cylinder`. Sizes that are not positive or not finite make
//! nothing, as in OpenSCAD.

use glam::DVec3;

use super::super::error::Located;
use super::arguments::Call;
use super::curve::Round;
use super::evaluate::Reading;
use super::node::Shape;
use crate::solid::Solid;

pub(super) fn cube(
    call: &Call<'_>,
    _: Vec<Shape>,
    _: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let size = DVec3::from_array(call.sizes("size")?.unwrap_or([1.0; 3]));
    let center = call.truth("center")?;
    if !size.to_array().into_iter().all(is_size) {
        return Ok(Shape::Empty);
    }
    let min = if center { -0.5 * size } else { DVec3::ZERO };
    let max = if center { 0.5 * size } else { size };
    Ok(Shape::Solid(Solid::cuboid_between(min, max).placed(call.place())))
}

pub(super) fn sphere(
    call: &Call<'_>,
    _: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let radius = radius(call, ["r", "d"])?.unwrap_or(1.0);
    if !is_size(radius) {
        return Ok(Shape::Empty);
    }
    Ok(Shape::Solid(Round::Ball { radius }.solid(call, reading)?))
}

pub(super) fn cylinder(
    call: &Call<'_>,
    _: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let both = radius(call, ["r", "d"])?.unwrap_or(1.0);
    let bottom = radius(call, ["r1", "d1"])?.unwrap_or(both);
    let top = radius(call, ["r2", "d2"])?.unwrap_or(both);
    let height = call.number("h")?.unwrap_or(1.0);
    let center = call.truth("center")?;
    let is_radius = |r: f64| is_size(r) || r == 0.0;
    let makes_solid = is_radius(bottom) && is_radius(top) && bottom.max(top) > 0.0;
    if !is_size(height) || !makes_solid {
        return Ok(Shape::Empty);
    }
    let heights = if center { [-0.5 * height, 0.5 * height] } else { [0.0, height] };
    let round = Round::Frustum { radii: [bottom, top], heights };
    Ok(Shape::Solid(round.solid(call, reading)?))
}

/// A radius, given as such or as a diameter, which wins.
pub(super) fn radius(
    call: &Call<'_>,
    [radius, diameter]: [&str; 2],
) -> Result<Option<f64>, Located> {
    let given = call.number(radius)?;
    Ok(call.number(diameter)?.map(|d| 0.5 * d).or(given))
}

/// Whether a size makes something.
pub(super) fn is_size(size: f64) -> bool {
    size > 0.0 && size.is_finite()
}
