//! Maps that make balls of balls.

use glam::{DMat2, DMat3, DVec3};

/// How far from one a map may be. OpenSCAD prints six digits, so that the numbers of a rotation are
/// wrong by 5e-7 each: these are a few of them, one within the other.
const DIGITS: f64 = 5e-6;

/// The same of one that nobody has printed.
const ROUNDING: f64 = 1e-13;

/// What a map multiplies lengths by if it is a similarity (a rotation, a mirror, an even scale or some
/// of these), to the digits that are printed.
pub(crate) fn scale(map: &DMat3) -> Option<f64> {
    scale_within(map, DIGITS)
}

/// The same but for rounding.
pub(crate) fn exact_scale(map: &DMat3) -> Option<f64> {
    scale_within(map, ROUNDING)
}

fn scale_within(map: &DMat3, off_by: f64) -> Option<f64> {
    let scale = map.determinant().abs().cbrt();
    let products = map.transpose() * *map / (scale * scale);
    let off = products - DMat3::IDENTITY;
    let most = [off.x_axis, off.y_axis, off.z_axis]
        .map(|column| column.abs().max_element())
        .into_iter()
        .fold(0.0, f64::max);
    // Lengths are off by half of what their squares are. What is not a number is refused.
    (scale > 0.0 && scale.is_finite() && most <= 2.0 * off_by).then_some(scale)
}

/// The same in the plane.
pub(crate) fn plane_scale(map: &DMat2) -> Option<f64> {
    let scale_of_z = map.determinant().abs().sqrt();
    scale(&DMat3::from_cols(
        map.x_axis.extend(0.0),
        map.y_axis.extend(0.0),
        scale_of_z * DVec3::Z,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_rotations_are_similarities_and_stretches_are_not() {
        let turned = DMat2::from_cols_array(&[0.866025, 0.5, -0.5, 0.866025]);
        let scale = plane_scale(&(3.0 * turned)).expect("a rotation and a scale");
        assert!((scale - 3.0).abs() < 1e-5, "{scale}");
        assert_eq!(
            plane_scale(&DMat2::from_diagonal(glam::DVec2::new(-2.0, 2.0))),
            Some(2.0)
        );
        for map in [
            DMat3::from_diagonal(DVec3::new(1.0, 1.0, 1.0001)),
            DMat3::from_cols(DVec3::X, DVec3::new(1e-4, 1.0, 0.0), DVec3::Z),
            DMat3::ZERO,
            DMat3::from_diagonal(DVec3::splat(f64::INFINITY)),
        ] {
            assert_eq!(super::scale(&map), None, "{map}");
        }
    }
}
