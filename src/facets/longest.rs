//! How much a linear map lengthens what it lengthens most.

use glam::{DMat3, DVec3};

/// The largest ratio of the length of an image to that of a vector: the root of the largest
/// eigenvalue of `MᵀM`, by the formula for symmetric matrices of three rows (O. K. Smith,
/// "Eigenvalues of a symmetric 3 × 3 matrix", Communications of the ACM 4, 1961).
///
/// Where the two largest are equal, as of what is flattened along one axis, half of the digits
/// are right, which is more than a number of segments needs.
pub(super) fn longest(map: &DMat3) -> f64 {
    // Lengths whose squares are out of range would be, too.
    let size = map.to_cols_array().into_iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if size == 0.0 || !size.is_finite() {
        return size;
    }
    let scaled = *map * (1.0 / size);
    let squares = scaled.transpose() * scaled;
    let mean = trace(&squares) / 3.0;
    let off = squares - DMat3::from_diagonal(DVec3::splat(mean));
    let spread = (trace(&(off * off)) / 6.0).sqrt();
    if spread <= f64::EPSILON * mean {
        return size * mean.sqrt();
    }
    let half = 0.5 * (off * (1.0 / spread)).determinant();
    let angle = half.clamp(-1.0, 1.0).acos() / 3.0;
    size * (mean + 2.0 * spread * angle.cos()).sqrt()
}

fn trace(matrix: &DMat3) -> f64 {
    matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_longest_image_of_a_unit_vector() {
        let turn = DMat3::from_rotation_x(0.3) * DMat3::from_rotation_z(1.1);
        for (map, expected) in [
            (DMat3::IDENTITY, 1.0),
            (DMat3::ZERO, 0.0),
            (turn * 1e200, 1e200),
            (turn * DMat3::from_diagonal(DVec3::new(2.0, 5.0, 0.1)) * turn, 5.0),
            (DMat3::from_diagonal(DVec3::new(3.0, 3.0, 0.0)), 3.0),
            // Shear by one: the golden ratio.
            (
                DMat3::from_cols(DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Z),
                1.618_033_988_75,
            ),
        ] {
            let found = longest(&map);
            assert!(
                (found - expected).abs() <= 1e-8 * expected,
                "{found} for {expected}"
            );
        }
    }
}
