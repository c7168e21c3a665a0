//! Principal axes of a symmetric matrix.

use glam::{DMat3, DVec3};

/// Eigenvalues in ascending order and their unit vectors, which are right-handed, by Jacobi's
/// rotations (G. H. Golub, C. F. Van Loan, "Matrix Computations", 4th ed., §8.5).
pub(super) fn principal(matrix: &DMat3) -> [(f64, DVec3); 3] {
    /// Off-diagonal elements fall quadratically at last: a few sweeps are enough.
    const SWEEPS: usize = 16;
    let (mut m, mut axes) = (*matrix, DMat3::IDENTITY);
    for _ in 0..SWEEPS {
        for [p, q] in [[0, 1], [0, 2], [1, 2]] {
            let off = m.col(q)[p];
            if off == 0.0 {
                continue;
            }
            let theta = (m.col(q)[q] - m.col(p)[p]) / (2.0 * off);
            let tangent = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            let sine = tangent * cosine;
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(p)[p] = cosine;
            turn.col_mut(q)[q] = cosine;
            turn.col_mut(q)[p] = sine;
            turn.col_mut(p)[q] = -sine;
            m = turn.transpose() * m * turn;
            m.col_mut(q)[p] = 0.0;
            m.col_mut(p)[q] = 0.0;
            axes *= turn;
        }
    }
    let mut found = [0, 1, 2].map(|i| (m.col(i)[i], axes.col(i).normalize_or_zero()));
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (first, second) = (found[0].1, found[1].1);
    found[2].1 = first.cross(second);
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn axes_make_the_matrix_diagonal(
            angles in [-3.0..3.0_f64, -3.0..3.0, -3.0..3.0],
            [a, b] in [-2.0..2.0_f64, -2.0..2.0],
            c in prop_oneof![Just(0.0), 1e-9..1e-6, Just(2.0)],
        ) {
            let [x, y, z] = angles;
            let values = [a, b, c];
            let turn = DMat3::from_euler(glam::EulerRot::XYZ, x, y, z);
            let matrix = turn * DMat3::from_diagonal(DVec3::from_array(values)) * turn.transpose();
            let matrix = 0.5 * (matrix + matrix.transpose());
            let mut expected = values;
            expected.sort_by(f64::total_cmp);
            for ((value, axis), expected) in principal(&matrix).into_iter().zip(expected) {
                prop_assert!((value - expected).abs() < 1e-14, "{value} {expected}");
                prop_assert!((matrix * axis - value * axis).length() < 1e-14);
                prop_assert!((axis.length() - 1.0).abs() < 1e-14);
            }
        }
    }
}
