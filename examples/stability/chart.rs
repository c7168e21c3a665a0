//! Curves on logarithmic scales.

use font8x8::legacy::BASIC_LEGACY;
use image::{Rgb, RgbImage};

/// The size of one chart in pixels, with its margins.
pub(crate) const SIZE: [u32; 2] = [560, 420];

const MARGIN: [f64; 4] = [70.0, 20.0, 40.0, 50.0];
const INK: Rgb<u8> = Rgb([40, 40, 48]);
const GRID: Rgb<u8> = Rgb([226, 226, 232]);

/// How a curve is drawn.
#[derive(Clone, Copy)]
pub(crate) enum Stroke {
    Full,
    Dashed,
    Dotted,
}

impl Stroke {
    const fn gap(self) -> u32 {
        match self {
            Self::Full => 1,
            Self::Dashed => 8,
            Self::Dotted => 3,
        }
    }
}

/// A short piece of a curve with words beside it.
pub(crate) fn sample(
    picture: &mut RgbImage,
    [x, y]: [u32; 2],
    (color, stroke): (Rgb<u8>, Stroke),
    words: &str,
) {
    let [left, height] = [x, y + 3].map(f64::from);
    segment(picture, [left, height], [left + 40.0, height], color, stroke.gap());
    text(picture, [x + 52, y], words, INK);
}

/// A chart on a picture.
pub(crate) struct Chart<'a> {
    picture: &'a mut RgbImage,
    corner: [u32; 2],
    x: [f64; 2],
    y: [f64; 2],
}

impl<'a> Chart<'a> {
    /// Axes between powers of ten.
    pub(crate) fn new(
        picture: &'a mut RgbImage,
        corner: [u32; 2],
        [x, y]: [[f64; 2]; 2],
        [title, subtitle]: [&str; 2],
    ) -> Self {
        let decades = |[low, high]: [f64; 2]| [low.log10().floor(), high.log10().ceil()];
        let mut chart = Self { picture, corner, x: decades(x), y: decades(y) };
        for (range, step, is_x) in [(chart.x, 2.0, true), (chart.y, 2.0, false)] {
            let mut at = range[0];
            while at <= range[1] {
                chart.grid_line(at, is_x);
                at += step;
            }
        }
        let [left, top] = corner;
        text(chart.picture, [left + 70, top + 8], title, INK);
        text(chart.picture, [left + 70, top + 22], subtitle, INK);
        chart
    }

    fn grid_line(&mut self, at: f64, is_x: bool) {
        let label = format!("1e{at:.0}");
        let ends = if is_x {
            [[at, self.y[0]], [at, self.y[1]]]
        } else {
            [[self.x[0], at], [self.x[1], at]]
        };
        let [from, to] = ends.map(|p| self.pixel(p));
        segment(self.picture, from, to, GRID, 1);
        let [x, y] = from.map(whole);
        let place = if is_x {
            [x.saturating_sub(14), y + 8]
        } else {
            [x.saturating_sub(44), y - 4]
        };
        text(self.picture, place, &label, INK);
    }

    /// A curve through points, each given as it is, not as its logarithm.
    pub(crate) fn curve(&mut self, points: &[[f64; 2]], color: Rgb<u8>, stroke: Stroke) {
        let place = |[x, y]: [f64; 2]| {
            let y = y.max(f64::MIN_POSITIVE).log10().clamp(self.y[0], self.y[1]);
            self.pixel([x.log10(), y])
        };
        let pixels: Vec<[f64; 2]> = points.iter().copied().map(place).collect();
        for pair in pixels.windows(2) {
            segment(self.picture, pair[0], pair[1], color, stroke.gap());
        }
    }

    fn pixel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, right, top, bottom] = MARGIN;
        let [width, height] = SIZE.map(f64::from);
        let part = |v: f64, [low, high]: [f64; 2]| (v - low) / (high - low);
        let inside = [width - left - right, height - top - bottom];
        [
            f64::from(self.corner[0]) + left + inside[0] * part(x, self.x),
            f64::from(self.corner[1]) + top + inside[1] * (1.0 - part(y, self.y)),
        ]
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pixels are small and positive"
)]
fn whole(x: f64) -> u32 {
    x.max(0.0).round() as u32
}

/// A line two pixels thick; of `gap` pixels along it only the first half is drawn.
fn segment(picture: &mut RgbImage, a: [f64; 2], b: [f64; 2], color: Rgb<u8>, gap: u32) {
    let steps = whole((b[0] - a[0]).abs().max((b[1] - a[1]).abs())).max(1);
    for i in 0..=steps {
        let part = f64::from(i) / f64::from(steps);
        let [x, y] = [0, 1].map(|k| whole(a[k] + part * (b[k] - a[k])));
        if gap > 1 && (x / gap) % 2 == 1 {
            continue;
        }
        let thick = if color == GRID { 1 } else { 2 };
        for (dx, dy) in (0..thick).flat_map(|dx| (0..thick).map(move |dy| (dx, dy))) {
            if let Some(pixel) = picture.get_pixel_mut_checked(x + dx, y + dy) {
                *pixel = color;
            }
        }
    }
}

/// Letters eight pixels high.
fn text(picture: &mut RgbImage, at: [u32; 2], text: &str, color: Rgb<u8>) {
    for (i, letter) in (0..).zip(text.chars()) {
        let rows = BASIC_LEGACY.get(letter as usize).unwrap_or(&BASIC_LEGACY[0]);
        for (dy, row) in (0..).zip(rows) {
            for dx in (0..8).filter(|dx| row >> dx & 1 == 1) {
                if let Some(pixel) =
                    picture.get_pixel_mut_checked(at[0] + 8 * i + dx, at[1] + dy)
                {
                    *pixel = color;
                }
            }
        }
    }
}
