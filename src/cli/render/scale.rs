//! A scale beside colours that mean numbers.

use anyhow::anyhow;
use image::RgbImage;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use solidray::render::heat_color;

use super::super::ticks::{short, ticks};

const FONT: &str = "sans-serif";
/// What the scale takes: less room has none.
const ROOM: [u32; 2] = [220, 160];
/// How wide it is, in heights of its letters.
const LETTERS: u32 = 10;

/// How wide a strip at the right edge of a picture its scale takes; none in a small picture.
pub(super) fn width([width, height]: [u32; 2]) -> Option<u32> {
    let has_room = width >= ROOM[0] && height >= ROOM[1];
    has_room.then(|| (LETTERS * letter(height)).min(width))
}

/// The height of the letters in a picture.
fn letter(height: u32) -> u32 {
    (height / 40).clamp(11, 40)
}

/// Draws a bar with the colours from nothing to `most` at the right edge of a picture, or of a strip
/// of it that is wide enough, and numbers beside it.
pub(super) fn draw_scale(image: &mut RgbImage, most: f32) -> anyhow::Result<()> {
    let (width, height) = image.dimensions();
    register_font(FONT, FontStyle::Normal, dejavu::sans::regular())
        .map_err(|_| anyhow!("the font of the scale cannot be read"))?;
    let [w, h, em] = [width, height, letter(height)].map(i32::try_from);
    let (w, h, em) = (w?, h?, em?);
    let (top, bottom) = (h / 10, h - h / 10);
    let (left, right) = (w - 2 * em, w - em);
    let backend = BitMapBackend::with_buffer(image, (width, height));
    let area = backend.into_drawing_area();
    let draw = || -> Result<(), Box<dyn std::error::Error + '_>> {
        for y in top..=bottom {
            let fraction = (bottom - y) as f32 / (bottom - top) as f32;
            let [r, g, b] = heat_color(fraction);
            let line =
                Rectangle::new([(left, y), (right, y + 1)], RGBColor(r, g, b).filled());
            area.draw(&line)?;
        }
        for number in ticks(most) {
            let up = (bottom - top) as f32 * number / most;
            #[expect(clippy::cast_possible_truncation, reason = "within the picture")]
            let y = bottom - up.round() as i32;
            let text = short(f64::from(number));
            let style = (FONT, f64::from(em)).into_font().color(&BLACK);
            let (wide, high) = area.estimate_text_size(&text, &style)?;
            let (wide, high) = (i32::try_from(wide)?, i32::try_from(high)?);
            area.draw_text(&text, &style, (left - em / 3 - wide, y - high / 2))?;
        }
        area.present()?;
        Ok(())
    };
    draw().map_err(|error| anyhow!("the scale: {error}"))
}
