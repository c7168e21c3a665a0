//! `multmatrix` and `color`.

use glam::{DAffine2, DAffine3, DMat2, DMat3, DVec3, Vec3Swizzles};

use super::super::error::Located;
use super::arguments::Call;
use super::combine;
use super::evaluate::Reading;
use super::node::Shape;
use crate::color::Color;
use crate::shape::inverse;
use crate::solid::Tag;

/// The children under an affine map. Of a plane shape only x and y are mapped. A matrix
/// that flattens (scale 0) or is not finite makes nothing, with a warning: OpenSCAD
/// leaves a shell without volume in the first case, which is no solid.
pub(super) fn multmatrix(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let map = matrix(call)?;
    let shape = combine::union(call, children, reading)?;
    let (is_regular, is_identity) = match shape {
        Shape::Empty => return Ok(Shape::Empty),
        Shape::Solid(_) => (is_regular(&map), map == DAffine3::IDENTITY),
        Shape::Flat(_) => (is_regular(&lifted(map)), plane(map) == DAffine2::IDENTITY),
    };
    if !is_regular {
        let message = "the matrix is singular or not finite; what it maps is left out";
        reading.warn(call.place(), message);
        return Ok(Shape::Empty);
    }
    Ok(match shape {
        shape if is_identity => shape,
        Shape::Solid(solid) => Shape::Solid(solid.mapped(map)),
        Shape::Flat(outline) => Shape::Flat(outline.mapped(plane(map))),
        Shape::Empty => Shape::Empty,
    })
}

/// The matrix argument. Rows or elements left out are those of the identity; the last row
/// can only divide the others, as OpenSCAD has no perspective.
pub(super) fn matrix(call: &Call<'_>) -> Result<DAffine3, Located> {
    let mut rows = [[0.0; 4]; 4];
    for (i, row) in rows.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for (i, row) in call.vector("m")?.unwrap_or_default().into_iter().take(4).enumerate()
    {
        for (j, value) in call.elements("m", row)?.into_iter().take(4).enumerate() {
            let number = call.document.number(value);
            rows[i][j] =
                number.ok_or_else(|| call.wrong("m", "a matrix of numbers", value))?;
        }
    }
    let w = rows[3][3];
    let column = |j: usize| DVec3::new(rows[0][j], rows[1][j], rows[2][j]) / w;
    Ok(DAffine3 {
        matrix3: DMat3::from_cols(column(0), column(1), column(2)),
        translation: column(3),
    })
}

/// The part of a map that acts on the plane z = 0 within it.
fn plane(map: DAffine3) -> DAffine2 {
    let DAffine3 { matrix3, translation } = map;
    DAffine2 {
        matrix2: DMat2::from_cols(matrix3.x_axis.xy(), matrix3.y_axis.xy()),
        translation: translation.xy(),
    }
}

/// That part with z as it is.
fn lifted(map: DAffine3) -> DAffine3 {
    let DAffine3 { matrix3, translation } = map;
    DAffine3 {
        matrix3: DMat3::from_cols(
            matrix3.x_axis.with_z(0.0),
            matrix3.y_axis.with_z(0.0),
            DVec3::Z,
        ),
        translation: translation.with_z(0.0),
    }
}

/// Whether a map is finite and flattens nothing, by the measure that leaves are placed by.
pub(super) fn is_regular(map: &DAffine3) -> bool {
    map.is_finite() && inverse(&map.matrix3).is_some()
}

/// The children in a colour. OpenSCAD prints one with −1 where none was given.
pub(super) fn color(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let shape = combine::union(call, children, reading)?;
    let Some(value) = call.value("c") else { return Ok(shape) };
    let rgb: Option<[f64; 3]> = call.document.numbers(value);
    let expected = "a vector of 3 or 4 numbers";
    let [r, g, b] = rgb.ok_or_else(|| call.wrong("c", expected, value))?;
    if [r, g, b].into_iter().any(|part| part.is_nan() || part < 0.0) {
        return Ok(shape);
    }
    let own = call.document.numbers(value).map(|[_, _, _, a]: [f64; 4]| a);
    let alpha = call.number("alpha")?.or(own).unwrap_or(1.0);
    #[expect(clippy::cast_possible_truncation, reason = "colours have few digits")]
    let color = Color { rgba: [r, g, b, alpha].map(|part| part as f32) };
    Ok(match shape {
        Shape::Empty => Shape::Empty,
        Shape::Flat(outline) => Shape::Flat(outline.tagged(Tag::Color(color))),
        Shape::Solid(solid) => Shape::Solid(solid.colored(color)),
    })
}
