//! Numbers as colours.

use glam::Vec3;
use image::RgbImage;

use super::scheme::{oklch, srgb8};

/// The sRGB colour of a fraction between 0 and 1, from pale yellow over red to dark blue: darker in
/// even steps, so that it reads without hues as well.
pub fn heat_color(fraction: f32) -> [u8; 3] {
    srgb8(light(fraction))
}

fn light(fraction: f32) -> Vec3 {
    let f = fraction.clamp(0.0, 1.0);
    // Hues from 105° down over 0° to −85°; the least and the most have little room for chroma.
    let hue_turns = (105.0 - 190.0 * f) / 360.0;
    oklch(0.95 - 0.70 * f, 0.16 * (f * (1.0 - f) * 4.0).sqrt().max(0.25), hue_turns)
}

/// The sRGB colour of a fraction between 0 and 1 in one hue, an angle of the Oklab space in degrees
/// (29 is red, 255 blue): from white to dark, in even steps of lightness.
pub fn tint(hue_deg: f32, fraction: f32) -> [u8; 3] {
    let f = fraction.clamp(0.0, 1.0);
    // White has no chroma and the dark end room for little.
    let chroma = 0.19 * (0.8 * std::f32::consts::PI * f).sin();
    srgb8(oklch(1.0 - 0.62 * f, chroma, hue_deg / 360.0))
}

/// A picture of numbers, row by row from the upper left, the largest being `most`; white where they
/// are zero or none.
///
/// # Panics
///
/// If there are not as many numbers as pixels.
pub fn heat(numbers: &[f32], size: [u32; 2], most: f32) -> RgbImage {
    assert_eq!(numbers.len(), size[0] as usize * size[1] as usize);
    let mut image = RgbImage::new(size[0], size[1]);
    for (pixel, &number) in image.pixels_mut().zip(numbers) {
        pixel.0 = if number > 0.0 { heat_color(number / most) } else { [255; 3] };
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_is_darker() {
        let luma = |f: f32| light(f).dot(Vec3::new(0.2126, 0.7152, 0.0722));
        for i in 0..100_u8 {
            let [a, b] = [i, i + 1].map(|i| luma(f32::from(i) / 100.0));
            assert!(b < a, "{i}: {a} {b}");
        }
    }

    #[test]
    fn tints_begin_at_white_and_darken() {
        for hue_deg in [29.0, 255.0] {
            assert_eq!(tint(hue_deg, 0.0), [255; 3]);
            let sum =
                |f: f32| tint(hue_deg, f).iter().copied().map(u32::from).sum::<u32>();
            for i in 0..20_u8 {
                let [a, b] = [i, i + 1].map(|i| sum(f32::from(i) / 20.0));
                assert!(b < a, "{hue_deg}, {i}: {a} {b}");
            }
        }
        let ([r, _, b], [s, _, c]) = (tint(29.0, 0.6), tint(255.0, 0.6));
        assert!(r > b && s < c, "red and blue");
    }

    #[test]
    fn nothing_is_white() {
        let image = heat(&[0.0, 1.0, f32::NAN, 0.5], [2, 2], 1.0);
        assert_eq!(image.get_pixel(0, 0).0, [255; 3]);
        assert_eq!(image.get_pixel(0, 1).0, [255; 3]);
        assert_eq!(image.get_pixel(1, 0).0, heat_color(1.0));
        assert_ne!(image.get_pixel(1, 1).0, heat_color(1.0));
    }
}
