//! The pictures of a report: both models, and how thick what only one of them has is.

use std::io::Cursor;

use anyhow::{Context, bail};
use image::{ImageFormat, Rgb, RgbImage};
use solidray::measure::Worst;
use solidray::render::{self, Camera, Style, tint};
use solidray::{Aabb, CompileOptions, Scene, Solid};

use super::super::interrupt::interrupted;
use super::super::meter::Meter;

/// Width and height of each of them, in pixels.
pub(super) const SIZE: [u32; 2] = [640, 480];
/// What is only in A is red, what is only in B blue: hues that people with any colour vision tell
/// apart.
pub(super) const HUES_DEG: [f32; 2] = [29.0, 255.0];

/// As `render --edges` draws.
const STYLE: Style = Style {
    look: render::Look::Shaded,
    scheme: render::Scheme::CORNFIELD,
    samples: 4,
    light: render::Light::Plain,
    edges: true,
    hatch: false,
};

/// Pictures by one camera, as .png.
pub(super) struct Pictures {
    pub(super) camera: Camera,
    /// A, B, and the difference.
    pub(super) pngs: [Vec<u8>; 3],
    /// The thickness with the darkest colours.
    pub(super) most: f32,
    /// How much of what is only in A, and of what is only in B, is in line at most.
    pub(super) thickest: [f32; 2],
    /// Where in the pictures the longest disagreement begins and ends, if its middle is in them.
    pub(super) worst: Option<[[f64; 2]; 2]>,
}

/// What is drawn, and how.
pub(super) struct Task<'a> {
    pub(super) solids: [&'a Solid; 2],
    pub(super) options: CompileOptions,
    /// Of both together, with finite numbers.
    pub(super) bounds: Aabb,
    pub(super) camera: Camera,
    pub(super) worst: Option<&'a Worst>,
    /// Which part of the larger volume may differ.
    pub(super) tolerance: f64,
}

impl Task<'_> {
    /// How many rays from the eye that takes.
    pub(super) fn rays() -> u64 {
        let [width, height] = SIZE.map(u64::from);
        2 * STYLE.rays(SIZE, 0) + 2 * width * height * u64::from(STYLE.samples)
    }

    pub(super) fn pictures(&self, meter: &Meter) -> anyhow::Result<Pictures> {
        let progress = |rays| meter.tick(rays);
        let [a, b] = self.solids;
        let picture = |solid| {
            let scene = self.scene(solid)?;
            anyhow::Ok(render::picture(&scene, &self.camera, SIZE, &STYLE, &progress))
        };
        let thickness = |solid| {
            let (scene, samples) = (self.scene(&solid)?, STYLE.samples);
            anyhow::Ok(render::thickness(&scene, &self.camera, SIZE, samples, &progress))
        };
        let [of_a, of_b] = [picture(a)?, picture(b)?];
        let only = [thickness(a.clone() - b.clone())?, thickness(b.clone() - a.clone())?];
        let thickest =
            only.each_ref().map(|all| all.iter().copied().fold(0.0_f32, f32::max));
        // Of a difference that is tolerated if it is everywhere nothing needs to catch the eye.
        #[expect(
            clippy::cast_possible_truncation,
            reason = "colours need no more digits"
        )]
        let tolerated = (self.tolerance * self.bounds.size().length()) as f32;
        let most = thickest[0].max(thickest[1]).max(tolerated);
        let difference = colored([&of_a, &of_b], &only, most);
        Ok(Pictures {
            camera: self.camera,
            pngs: [png(&of_a)?, png(&of_b)?, png(&difference)?],
            most,
            thickest,
            worst: self.worst.and_then(|worst| self.ends(worst)),
        })
    }

    fn scene(&self, solid: &Solid) -> anyhow::Result<Scene> {
        if interrupted() {
            bail!("stopped, and no page is written");
        }
        Ok(Scene::compile_with(solid, &self.options)?)
    }

    fn ends(&self, worst: &Worst) -> Option<[[f64; 2]; 2]> {
        let view = self.camera.view(SIZE, &self.bounds);
        let [x, y] = view.place(worst.from.midpoint(worst.to))?;
        let [width, height] = SIZE.map(f64::from);
        let is_seen = (0.0..width).contains(&x) && (0.0..height).contains(&y);
        let ends = [view.place(worst.from)?, view.place(worst.to)?];
        is_seen.then_some(ends)
    }
}

/// The thicker of what is only in one of them, as a colour, over a pale grey picture of both.
fn colored(models: [&RgbImage; 2], [in_a, in_b]: &[Vec<f32>; 2], most: f32) -> RgbImage {
    let mut image = RgbImage::new(SIZE[0], SIZE[1]);
    let models = models[0].pixels().zip(models[1].pixels());
    let pixels = image.pixels_mut().zip(models).zip(in_a.iter().zip(in_b));
    for ((pixel, (a, b)), (&in_a, &in_b)) in pixels {
        let (hue_deg, thickness) = match in_a >= in_b {
            true => (HUES_DEG[0], in_a),
            false => (HUES_DEG[1], in_b),
        };
        let grey = 0.5 * (brightness(a) + brightness(b));
        let pale = 1.0 - PALE * (1.0 - grey);
        #[expect(clippy::cast_possible_truncation, reason = "between 0 and 255")]
        #[expect(clippy::cast_sign_loss, reason = "between 0 and 255")]
        let over = |byte: u8| (f32::from(byte) * pale).round() as u8;
        // What is too long for a number that colours are made of is the longest there is.
        let share = if thickness.is_finite() { thickness / most } else { 1.0 };
        pixel.0 = tint(hue_deg, share).map(over);
    }
    image
}

/// How much of the models' own shades is left under the colours: enough to see where one is, too
/// little to change what a colour says.
const PALE: f32 = 0.3;

/// From 0 to 1, of the bytes as they are.
fn brightness(Rgb([r, g, b]): &Rgb<u8>) -> f32 {
    let [r, g, b] = [r, g, b].map(|&byte| f32::from(byte) / 255.0);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn png(image: &RgbImage) -> anyhow::Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png).context("the pictures")?;
    Ok(bytes.into_inner())
}
