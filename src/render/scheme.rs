//! The colours of what has none of its own.

use glam::Vec3;

use crate::color::Color;

/// The colours of a picture, as OpenSCAD's colour schemes give them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Where nothing is hit: at the upper and at the lower edge of the picture.
    pub background: [Color; 2],
    /// Surfaces without a colour.
    pub face: Color,
    /// Surfaces without a colour that a subtracted solid left behind.
    pub cut: Color,
}

impl Scheme {
    /// OpenSCAD's default: yellow solids with green cuts on a pale ground.
    pub const CORNFIELD: Self = Self::ALL[0].1;

    /// OpenSCAD's schemes by their names (its folder `color-schemes/render` of July 2026; 2021.01 has
    /// neither the gems nor `ClearSky`).
    #[rustfmt::skip]
    pub const ALL: [(&'static str, Self); 14] = [
        ("Cornfield", Self::new([0xffffe5, 0xffffe5], 0xf9d72c, 0x9dcb51)),
        ("Metallic", Self::new([0xaaaaff, 0xaaaaff], 0xddddff, 0xdd22dd)),
        ("Sunset", Self::new([0xaa4444, 0xaa4444], 0xffaaaa, 0x882233)),
        ("Starnight", Self::new([0x000000, 0x000000], 0xffffe0, 0x00ffff)),
        ("BeforeDawn", Self::new([0x333333, 0x333333], 0xcccccc, 0x5563dd)),
        ("Nature", Self::new([0xfafafa, 0xfafafa], 0x16a085, 0xdbf4da)),
        ("Daylight Gem", Self::new([0xf0f0f0, 0xf0f0f0], 0x02daf7, 0x014da1)),
        ("Nocturnal Gem", Self::new([0x0c0c0c, 0x0c0c0c], 0x02daf7, 0x014da1)),
        ("DeepOcean", Self::new([0x333333, 0x333333], 0xeeeeee, 0x0babc8)),
        ("Solarized", Self::new([0xfdf6e3, 0xfdf6e3], 0xb58800, 0x882233)),
        ("Tomorrow", Self::new([0xf8f8f8, 0xf8f8f8], 0x4271ae, 0xf5871f)),
        ("Tomorrow Night", Self::new([0x1d1f21, 0x1d1f21], 0x81a2be, 0xde935f)),
        ("ClearSky", Self::new([0x87ceeb, 0xc9e9f6], 0xf9d72c, 0x9dcb51)),
        ("Monotone", Self::new([0xffffe5, 0xffffe5], 0xf9d72c, 0xf9d72c)),
    ];

    /// The scheme that OpenSCAD knows by a name; capitals, spaces and dashes do not matter.
    pub fn named(name: &str) -> Option<Self> {
        let plain = |name: &str| -> String {
            let letters = name.chars().filter(|c| c.is_ascii_alphanumeric());
            letters.map(|c| c.to_ascii_lowercase()).collect()
        };
        let name = plain(name);
        Self::ALL.into_iter().find(|(known, _)| plain(known) == name).map(|found| found.1)
    }

    const fn new(background: [u32; 2], face: u32, cut: u32) -> Self {
        let [upper, lower] = background;
        Self { background: [hex(upper), hex(lower)], face: hex(face), cut: hex(cut) }
    }

    /// The light of the ground of a picture, 0 at its upper and 1 at its lower edge.
    pub(super) fn ground(&self, down: f32) -> Vec3 {
        let [upper, lower] = self.background.map(linear);
        upper.lerp(lower, down)
    }
}

impl Default for Scheme {
    fn default() -> Self {
        Self::CORNFIELD
    }
}

/// A colour from its 24 bits.
const fn hex(rgb: u32) -> Color {
    let [_, r, g, b] = rgb.to_be_bytes();
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

/// The light of what is seen through things of some opacity, and of these, the nearest last: means of
/// sRGB's values and not of light, as OpenGL blends for OpenSCAD, and browsers.
pub(super) fn covered(behind: Vec3, before: impl Iterator<Item = (Vec3, f32)>) -> Vec3 {
    before
        .fold(behind.map(encoded), |behind, (light, opacity)| {
            behind.lerp(light.map(encoded), opacity)
        })
        .map(decoded)
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
            let bytes = [byte, 255 - byte, byte / 2];
            let color = hex(u32::from_be_bytes([0, bytes[0], bytes[1], bytes[2]]));
            assert_eq!(srgb8(linear(color)), bytes);
        }
    }

    #[test]
    fn schemes_have_names() {
        for (name, scheme) in Scheme::ALL {
            assert_eq!(Scheme::named(name), Some(scheme));
        }
        assert_eq!(Scheme::named("daylight-gem"), Scheme::named("Daylight Gem"));
        assert_eq!(Scheme::named(""), None);
        assert_eq!(srgb8(linear(Scheme::CORNFIELD.face)), [0xf9, 0xd7, 0x2c]);
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
