//! The colours of what has none of its own.

use glam::Vec3;

use crate::color::Color;

/// The colours of a picture, as OpenSCAD's colour schemes give them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Where nothing is hit.
    pub background: Color,
    /// Surfaces without a colour.
    pub face: Color,
    /// Surfaces without a colour that a subtracted solid left behind.
    pub cut: Color,
}

impl Scheme {
    /// OpenSCAD's default: yellow solids with green cuts on a pale ground.
    pub const CORNFIELD: Self = Self {
        background: rgb8(0xff, 0xff, 0xe5),
        face: rgb8(0xf9, 0xd7, 0x2c),
        cut: rgb8(0x9d, 0xcb, 0x51),
    };
}

impl Default for Scheme {
    fn default() -> Self {
        Self::CORNFIELD
    }
}

const fn rgb8(r: u8, g: u8, b: u8) -> Color {
    Color::rgb(r as f32 / 255.0, g as f32 / 255.0, b as f32 / 255.0)
}

/// The linear light of an sRGB colour, without its opacity. What is below 0 or above 1 is
/// taken as 0 or 1.
pub(super) fn linear(color: Color) -> Vec3 {
    let [r, g, b, _] = color.rgba;
    Vec3::new(r, g, b).clamp(Vec3::ZERO, Vec3::ONE).map(decoded)
}

/// The sRGB bytes of linear light; what is below 0 or above 1 is cut off.
pub(super) fn srgb8(light: Vec3) -> [u8; 3] {
    let code = 255.0 * light.clamp(Vec3::ZERO, Vec3::ONE).map(encoded);
    #[expect(clippy::cast_possible_truncation, reason = "it is between 0 and 255")]
    #[expect(clippy::cast_sign_loss, reason = "it is between 0 and 255")]
    code.to_array().map(|value| value.round() as u8)
}

/// From sRGB to linear light (IEC 61966-2-1:1999, §5.2).
pub(super) fn decoded(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// From linear light to sRGB (IEC 61966-2-1:1999, §5.3).
fn encoded(light: f32) -> f32 {
    if light <= 0.003_130_8 {
        12.92 * light
    } else {
        1.055 * light.powf(1.0 / 2.4) - 0.055
    }
}

/// The linear light of a lightness (0–1), chroma and hue (in turns) of the Oklab space,
/// in which equal steps look equal; what a screen cannot show is cut off.
///
/// Björn Ottosson, "A perceptual color space for image processing" (2020).
pub(super) fn oklch(lightness: f32, chroma: f32, hue_turns: f32) -> Vec3 {
    let (sin, cos) = (std::f32::consts::TAU * hue_turns).sin_cos();
    let (a, b) = (chroma * cos, chroma * sin);
    let l = lightness + 0.396_337_78 * a + 0.215_803_76 * b;
    let m = lightness - 0.105_561_346 * a - 0.063_854_17 * b;
    let s = lightness - 0.089_484_18 * a - 1.291_485_5 * b;
    let (l, m, s) = (l * l * l, m * m * m, s * s * s);
    Vec3::new(
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_38 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    )
    .clamp(Vec3::ZERO, Vec3::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_linear_light() {
        for byte in 0..=u8::MAX {
            let color = rgb8(byte, 255 - byte, byte / 2);
            assert_eq!(srgb8(linear(color)), [byte, 255 - byte, byte / 2]);
        }
    }

    #[test]
    fn strange_light_is_cut_off() {
        assert_eq!(srgb8(Vec3::new(-1.0, 2.0, f32::INFINITY)), [0, 255, 255]);
        let beyond = linear(Color::rgb(-0.5, 1.5, 1.0));
        assert_eq!(beyond, Vec3::new(0.0, 1.0, 1.0));
    }

    #[test]
    fn oklch_greys() {
        assert_eq!(srgb8(oklch(0.0, 0.0, 0.3)), [0, 0, 0]);
        assert_eq!(srgb8(oklch(1.0, 0.0, 0.3)), [255, 255, 255]);
        // Red #ff0000 is (0.62796, 0.25768, 29.234°) in Oklch.
        let [r, g, b] = srgb8(oklch(0.627_96, 0.257_68, 29.234 / 360.0));
        assert!(r >= 254 && g <= 2 && b <= 2, "{r} {g} {b}");
    }
}
