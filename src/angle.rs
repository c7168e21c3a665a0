//! Sines and cosines of angles in degrees.

use std::f64::consts::FRAC_1_SQRT_2;

/// The cosine of an angle in degrees, exact where a square root or less tells it.
pub(crate) fn cos_deg(degrees: f64) -> f64 {
    let degrees = degrees.rem_euclid(360.0);
    sin_deg(if degrees < 270.0 { degrees + 90.0 } else { degrees - 270.0 })
}

/// The sine of an angle in degrees, exact where a square root or less tells it:
/// corners of squares, hexagons and octagons then lie in common planes.
pub(crate) fn sin_deg(degrees: f64) -> f64 {
    let degrees = degrees.rem_euclid(360.0);
    if degrees >= 180.0 {
        return -sin_deg_half(degrees - 180.0);
    }
    sin_deg_half(degrees)
}

#[expect(clippy::float_cmp, reason = "exact angles have exact values")]
fn sin_deg_half(degrees: f64) -> f64 {
    let x = if degrees > 90.0 { 180.0 - degrees } else { degrees };
    if x == 30.0 {
        0.5
    } else if x == 45.0 {
        FRAC_1_SQRT_2
    } else if x == 60.0 {
        0.75_f64.sqrt()
    } else if x > 45.0 {
        (90.0 - x).to_radians().cos()
    } else {
        x.to_radians().sin()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_angles_are_exact() {
        for (degrees, expected) in [
            (-90.0, (-1.0, 0.0)),
            (0.0, (0.0, 1.0)),
            (90.0, (1.0, 0.0)),
            (180.0, (0.0, -1.0)),
            (270.0, (-1.0, 0.0)),
            (360.0, (0.0, 1.0)),
            (720.0 + 90.0, (1.0, 0.0)),
            (-1e-300, (0.0, 1.0)),
        ] {
            assert_eq!((sin_deg(degrees), cos_deg(degrees)), expected, "{degrees}°");
        }
        for degrees in [1.0, 44.0, 46.0, 100.0, 224.0, 226.0, 300.0, 350.0] {
            let (sin, cos) = (sin_deg(degrees), cos_deg(degrees));
            let (s, c) = f64::to_radians(degrees).sin_cos();
            assert!((sin - s).abs() + (cos - c).abs() < 1e-15, "{degrees}°");
        }
    }
}
