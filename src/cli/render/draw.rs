//! One picture, made band by band, so that a large one takes no more memory than a small one.

use std::cell::Cell;
use std::io::{self, Seek, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use image::{GenericImage, RgbImage};
use solidray::render::{self, Camera, Shown, Style};

use super::super::meter::Meter;
use super::numbers::Numbers;
use super::{encode, scale};

/// Numbers that are found before any colour.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Depth,
    Thickness,
}

/// What is written.
#[derive(Clone, Copy, Debug)]
pub(super) enum Format {
    /// Colours.
    Png,
    /// Numbers as grey.
    Png16,
    /// Numbers.
    Tiff,
}

/// What one picture is made by, and what was found in it.
pub(super) struct Drawing {
    pub(super) style: Style,
    pub(super) size: [u32; 2],
    pub(super) camera: Camera,
    pub(super) numbers: Option<Kind>,
    pub(super) format: Format,
    /// Where there is room for what does not fit into memory.
    pub(super) folder: PathBuf,
    /// The time spent on rays.
    pub(super) traced: Duration,
    /// The least and the largest of its numbers.
    pub(super) range: Option<[f32; 2]>,
}

impl Drawing {
    /// Draws it into a file.
    pub(super) fn draw(
        &mut self,
        shown: Shown<'_>,
        meter: &Meter,
        file: &mut (impl Write + Seek),
    ) -> anyhow::Result<()> {
        let Self { style, size, ref camera, .. } = *self;
        let progress = |rays| meter.tick(rays);
        let clock = Clock::default();
        let scene = shown.solid;
        let bands: Box<dyn Iterator<Item = Vec<f32>>> = match self.numbers {
            Some(Kind::Depth) => {
                Box::new(render::depth_bands(scene, camera, size, &progress))
            }
            Some(Kind::Thickness) => {
                let samples = style.samples;
                Box::new(render::thickness_bands(scene, camera, size, samples, &progress))
            }
            None => {
                let bands = clock.time(|| {
                    render::picture_bands(shown, camera, size, &style, &progress)
                });
                encode::png(file, size, clock.timed(bands).map(Ok))?;
                self.traced = clock.0.get();
                return Ok(());
            }
        };
        let mut numbers = Numbers::kept(&self.folder, size, clock.timed(bands))?;
        self.traced = clock.0.get();
        self.range = numbers.range;
        match self.format {
            Format::Png => colored(&mut numbers, size, file),
            Format::Png16 => self.gray(&mut numbers, file),
            Format::Tiff => {
                encode::tiff(file, size, numbers.rows_per_band(), numbers.bands()?)
            }
        }
    }

    /// Grey in 16 bits: nothing is 0. Depths go from 65535, the nearest, to 1; thicknesses from 1 to 65535,
    /// the largest, as which what has no end counts too.
    fn gray(&self, numbers: &mut Numbers, file: &mut impl Write) -> anyhow::Result<()> {
        let [least, most] = numbers.range.unwrap_or_default();
        let is_depth = matches!(self.numbers, Some(Kind::Depth));
        let (dark, bright, what) =
            if is_depth { (most, least, "depth") } else { (0.0, most, "thickness") };
        let comment = format!(
            "{what} = {dark} + (grey - 1) / 65534 * ({bright} - {dark}) in units of the model; grey 0 is where nothing is"
        );
        let gray = |number: f32| {
            if number.is_nan() || (!is_depth && number <= 0.0) {
                return 0;
            }
            let range = f64::from(bright) - f64::from(dark);
            let part = (f64::from(number) - f64::from(dark)) / range;
            // Where all numbers are the same, they are the brightest.
            let part = if part.is_nan() { 1.0 } else { part };
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "it is between 1 and 65535"
            )]
            let gray = (1.0 + part.clamp(0.0, 1.0) * 65534.0).round() as u16;
            gray
        };
        let bands =
            numbers.bands()?.map(|band| Ok(band?.into_iter().map(gray).collect()));
        encode::png16(file, self.size, comment, bands)
    }
}

/// Colours for numbers, with a scale where there is room for one.
fn colored(
    numbers: &mut Numbers,
    size @ [width, height]: [u32; 2],
    file: &mut impl Write,
) -> anyhow::Result<()> {
    let [_, most] = numbers.range.unwrap_or_default();
    let heat = |band: Vec<f32>| {
        let rows = band.len() / width as usize;
        #[expect(clippy::cast_possible_truncation, reason = "a picture has u32 rows")]
        let rows = rows as u32;
        render::heat(&band, [width, rows], most)
    };
    // The scale is drawn on what is below it: that strip is made first, for the whole height.
    let mut strip = None;
    if let Some(wide) = scale::width(size) {
        let mut image = RgbImage::new(wide, height);
        let mut top = 0;
        for band in numbers.bands()? {
            let band = heat(band?);
            let below =
                image::imageops::crop_imm(&band, width - wide, 0, wide, band.height());
            image.copy_from(&*below, 0, top)?;
            top += band.height();
        }
        scale::draw_scale(&mut image, most)?;
        strip = Some(image);
    }
    let mut top = 0;
    let bands = numbers.bands()?.map(|band| {
        let mut band = heat(band?);
        if let Some(strip) = &strip {
            let part =
                image::imageops::crop_imm(strip, 0, top, strip.width(), band.height());
            band.copy_from(&*part, width - strip.width(), 0).map_err(io::Error::other)?;
        }
        top += band.height();
        Ok(band)
    });
    encode::png(file, size, bands)
}

/// The time that was spent in something.
#[derive(Default)]
struct Clock(Cell<Duration>);

impl Clock {
    fn time<T>(&self, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.0.set(self.0.get() + start.elapsed());
        result
    }

    /// The same items, each with its time counted.
    fn timed<T>(&self, mut items: impl Iterator<Item = T>) -> impl Iterator<Item = T> {
        std::iter::from_fn(move || self.time(|| items.next()))
    }
}
