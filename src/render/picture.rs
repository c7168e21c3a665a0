//! Pictures with smooth edges: the average of frames whose rays are spread over each
//! pixel.

use std::ops::Range;

use glam::Vec3;
use image::RgbImage;

use super::frame::{Frame, TILE, trace_rows};
use super::shade::{Shader, add, write};
use super::{Camera, Light, Look, Scheme, Shown, View};
use crate::progress::Progress;
use crate::scene::Scene;

/// How a picture is made of what a camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// What it shows of surfaces.
    pub look: Look,
    /// The colours of what has none of its own.
    pub scheme: Scheme,
    /// How many rays go through each pixel; 0 counts as 1.
    pub samples: u32,
    /// Where the light comes from, in looks that have any.
    pub light: Light,
    /// Whether dark lines are drawn along outlines, steps and creases.
    pub edges: bool,
    /// Whether the faces of half-spaces are hatched, as those of [`Solid::section`] are drawn.
    ///
    /// [`Solid::section`]: crate::Solid::section
    pub hatch: bool,
}

impl Default for Style {
    /// Shaded, in OpenSCAD's colours, one ray through the centre of each pixel.
    fn default() -> Self {
        Self {
            look: Look::Shaded,
            scheme: Scheme::CORNFIELD,
            samples: 1,
            light: Light::Plain,
            edges: false,
            hatch: false,
        }
    }
}

impl Style {
    /// How many rays from the eye a picture takes in which so many solids are
    /// [seen through](Shown::translucent), for those who watch its progress.
    pub fn rays(&self, size @ [width, height]: [u32; 2], translucent: usize) -> u64 {
        let layers = 1 + if self.look.is_lit() { translucent } else { 0 };
        let rows: u64 =
            bands(size, layers).map(|rows| self.traced(&rows, height).len() as u64).sum();
        let samples = u64::from(self.samples.max(1)).saturating_mul(layers as u64);
        let survey = if self.needs_survey() { u64::from(height) } else { 0 };
        u64::from(width)
            .saturating_mul(rows.saturating_mul(samples).saturating_add(survey))
    }

    /// The rows that are traced for a band of rows: edges depend on the rows beside them.
    fn traced(&self, rows: &Range<u32>, height: u32) -> Range<u32> {
        match self.edges {
            true => rows.start.saturating_sub(1)..rows.end.saturating_add(1).min(height),
            false => rows.clone(),
        }
    }

    /// Whether the range of depths is to be known before anything is painted.
    fn needs_survey(&self) -> bool {
        self.look == Look::Depth
    }
}

/// The largest number of pixels traced at once (unless a few rows have more): 28 bytes
/// each, whatever the number of samples.
const BAND_PIXELS: u32 = 1 << 21;

/// A picture of a scene in `size` = \[width, height\] pixels.
///
/// The rays through a pixel are spread evenly over it, the same in each; their linear
/// light is averaged. [`Look::Depth`] traces pixel centres once before, for the depths
/// that are white and dark grey. The picture is the same to the last bit on any number of
/// threads.
///
/// It takes some 60 MB beside the picture itself, whatever its height and `style.samples`: more for
/// pictures wider than 65,536 pixels, divided by one more than what is seen through.
pub fn picture<'a>(
    shown: impl Into<Shown<'a>>,
    camera: &Camera,
    size: [u32; 2],
    style: &Style,
    progress: Progress<'_>,
) -> RgbImage {
    let painter = Painter::new(shown.into(), camera, size, style, progress);
    let mut image = RgbImage::new(size[0], size[1]);
    let bytes: &mut [u8] = &mut image;
    let row = 3 * size[0] as usize;
    for rows in painter.bands() {
        painter.paint(&rows, &mut bytes[row * rows.start as usize..][..row * rows.len()]);
    }
    image
}

/// The same picture in bands from top to bottom, each made when it is asked for (but for the depths of
/// [`Look::Depth`], which are looked for at once): for pictures that are too large to be held whole.
pub fn picture_bands<'a>(
    shown: impl Into<Shown<'a>>,
    camera: &Camera,
    size: [u32; 2],
    style: &Style,
    progress: Progress<'a>,
) -> impl Iterator<Item = RgbImage> + 'a {
    let painter = Painter::new(shown.into(), camera, size, style, progress);
    painter.bands().map(move |rows| {
        let mut band = RgbImage::new(size[0], rows.end - rows.start);
        painter.paint(&rows, &mut band);
        band
    })
}

/// All that a band of a picture is made of.
struct Painter<'a> {
    view: View,
    style: Style,
    /// Of the solid, then of what is seen through.
    shaders: Vec<Shader<'a>>,
    offsets: Vec<[f64; 2]>,
    progress: Progress<'a>,
}

impl<'a> Painter<'a> {
    fn new(
        shown: Shown<'a>,
        camera: &Camera,
        size: [u32; 2],
        style: &Style,
        progress: Progress<'a>,
    ) -> Self {
        let Shown { solid, translucent } = shown;
        let view = camera.view(size, &shown.bounds());
        let depths =
            if style.needs_survey() { survey(solid, &view, progress) } else { None };
        let shader = Shader { scene: solid, style: *style, depths, color: None };
        let mut shaders = vec![shader];
        if style.look.is_lit() {
            let style = Style { light: Light::Plain, ..*style };
            shaders.extend(translucent.iter().map(|layer| Shader {
                scene: layer.scene,
                style,
                color: Some(layer.color),
                ..shader
            }));
        }
        let offsets = spread(style.samples.max(1));
        Self { view, style: *style, shaders, offsets, progress }
    }

    fn bands(&self) -> impl Iterator<Item = Range<u32>> + use<> {
        bands(self.view.size(), self.shaders.len())
    }

    /// Paints some rows into their bytes.
    fn paint(&self, rows: &Range<u32>, bytes: &mut [u8]) {
        let [width, height] = self.view.size();
        let mut light = vec![Vec3::ZERO; width as usize * rows.len()];
        let traced = self.style.traced(rows, height);
        for (&offset, sample) in self.offsets.iter().zip(0..) {
            let trace = |shader: &Shader<'a>| {
                let rows = traced.clone();
                trace_rows(shader.scene, &self.view, rows, offset, self.progress)
            };
            let frames: Vec<Frame> = self.shaders.iter().map(trace).collect();
            add(&self.shaders, &frames, rows.clone(), sample, &mut light);
        }
        write(&light, 1.0 / self.offsets.len() as f32, bytes);
    }
}

/// The least and the greatest depth seen through pixel centres.
fn survey(scene: &Scene, view: &View, progress: Progress<'_>) -> Option<[f64; 2]> {
    bands(view.size(), 1)
        .filter_map(|rows| trace_rows(scene, view, rows, [0.5, 0.5], progress).depths())
        .reduce(|[near, far], [n, f]| [near.min(n), far.max(f)])
}

/// Ranges of rows, whole tiles high, that make up a picture of so many layers.
pub(super) fn bands(
    [width, height]: [u32; 2],
    layers: usize,
) -> impl Iterator<Item = Range<u32>> {
    let layers = u32::try_from(layers.max(1)).unwrap_or(u32::MAX);
    let tiles = (BAND_PIXELS / TILE / width.max(1) / layers).max(1);
    let step = tiles * TILE;
    (0..height.div_ceil(step))
        .map(move |i| i * step..height.min((i + 1).saturating_mul(step)))
}

/// Places in the unit square, one in each of `count` equal columns and one in each of as
/// many rows; their mean is the centre.
///
/// Column i has the row that i / φ, without its integer part, has among the others. Where
/// `count` is a Fibonacci number this is the Fibonacci lattice, a rank-1 lattice (Niederreiter
/// and Sloan, "Integration of nonperiodic functions of two variables by Fibonacci lattice
/// rules", 1994; for pictures: Dammertz and Keller, "Image synthesis by rank-1 lattices",
/// 2008); for other counts it stays as even, where lattices can fail (all those of 4
/// points that fill rows and columns are diagonals).
pub(super) fn spread(count: u32) -> Vec<[f64; 2]> {
    const INVERSE_PHI: f64 = 0.618_033_988_749_894_9;
    let mut columns: Vec<(f64, u32)> =
        (0..count).map(|i| ((f64::from(i) * INVERSE_PHI).fract(), i)).collect();
    columns.sort_by(|a, b| a.0.total_cmp(&b.0));
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(count);
    let mut points: Vec<[f64; 2]> = columns
        .iter()
        .zip(0..)
        .map(|(&(_, column), row)| [place(column), place(row)])
        .collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sample_is_at_the_centre() {
        assert_eq!(spread(1), [[0.5, 0.5]]);
    }

    #[test]
    fn samples_fill_rows_and_columns() {
        for count in [2, 3, 4, 5, 8, 9, 16, 21, 64, 100] {
            let cell = |v: f64| (v * f64::from(count)).floor();
            let points = spread(count);
            for axis in 0..2 {
                let mut cells: Vec<f64> = points.iter().map(|p| cell(p[axis])).collect();
                cells.sort_by(f64::total_cmp);
                let all: Vec<f64> = (0..count).map(f64::from).collect();
                assert_eq!(cells, all);
            }
        }
    }

    #[test]
    fn samples_keep_their_distance() {
        // On a torus, as pixels repeat, against the step of a square grid.
        for count in [4, 5, 8, 9, 13, 16, 25, 32, 64] {
            let points = spread(count);
            let wrapped = |d: f64| d.abs().min(1.0 - d.abs());
            let mut nearest = f64::INFINITY;
            for (i, a) in points.iter().enumerate() {
                for b in &points[i + 1..] {
                    nearest =
                        nearest.min(wrapped(a[0] - b[0]).hypot(wrapped(a[1] - b[1])));
                }
            }
            let relative = nearest * f64::from(count).sqrt();
            assert!(relative > 0.45, "{count} points: {relative}");
        }
    }

    #[test]
    fn bands_cover_each_row_once() {
        for size in [[0, 0], [0, 5], [5, 0], [64, 48], [16384, 16384], [u32::MAX, 70]] {
            let mut next = 0;
            for rows in bands(size, 1) {
                assert!(rows.start == next && rows.end > next);
                next = rows.end;
            }
            assert_eq!(next, size[1]);
        }
    }
}
