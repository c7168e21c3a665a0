//! What a camera sees, before any colour: the first crossing of each pixel's ray.

use std::ops::Range;

use super::{View, chunks};
use crate::progress::Progress;
use crate::ray::{Crossing, Ray, Sense};
use crate::scene::{SIDE, Scene, Tile};

/// The side of the square tiles in which frames are traced and stored.
pub(super) const TILE: u32 = SIDE;
const TILE_AREA: usize = (TILE * TILE) as usize;

/// The first crossing of one ray through each pixel, in 16 bytes a pixel.
#[derive(Clone, Debug)]
pub struct Frame {
    view: View,
    /// The rows of the view that the frame holds.
    rows: Range<u32>,
    /// Where in its pixel each ray is.
    offset: [f64; 2],
    /// Tiles from left to right, then from top to bottom, each row by row. Those at the
    /// right and lower edges are stored whole.
    hits: Vec<Packed>,
}

/// An optional crossing with `t ≥ 0`: `t` is not a number for none, and its sign bit is
/// set where the ray leaves a solid (the eye is inside).
#[derive(Clone, Copy, Debug)]
struct Packed {
    t: f64,
    leaf: u32,
    face: u32,
}

/// Traces one ray through each pixel of a view, at the same `offset` from the pixel's
/// upper left corner (0–1 to the right and down; `[0.5, 0.5]` is its centre).
///
/// The frame is the same to the last bit on any number of threads. `progress` is called
/// after each tile.
pub fn trace(
    scene: &Scene,
    view: &View,
    offset: [f64; 2],
    progress: Progress<'_>,
) -> Frame {
    trace_rows(scene, view, 0..view.size()[1], offset, progress)
}

/// Traces some rows of a view.
pub(super) fn trace_rows(
    scene: &Scene,
    view: &View,
    rows: Range<u32>,
    offset: [f64; 2],
    progress: Progress<'_>,
) -> Frame {
    let mut frame = Frame { view: *view, rows, offset, hits: Vec::new() };
    let [width, height] = frame.size();
    let tiles = tiles_along(width) * tiles_along(height);
    let mut hits = vec![Packed::NONE; tiles * TILE_AREA];
    chunks::for_each(
        &mut hits,
        TILE_AREA,
        || scene.tile_tracer(),
        |tracer, index, tile| {
            let [columns, rows] = frame.tile(index);
            let size = [columns.len(), rows.len()];
            #[expect(clippy::cast_possible_truncation, reason = "tiles are small")]
            let at = |i: usize, j: usize| {
                let [x, y] =
                    frame.in_view(columns.start + i as u32, rows.start + j as u32);
                view.in_fan(x, y)
            };
            let rays = Tile { fan: view.fan(), size, at: &at };
            tracer.first_hits(&rays, |i, j, hit| {
                tile[j * TILE as usize + i] = Packed::new(hit);
            });
            progress(size[0] as u64 * size[1] as u64);
        },
    );
    frame.hits = hits;
    frame
}

impl Frame {
    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.view.size()[0], self.rows.end - self.rows.start]
    }

    /// The rows of the view that the frame holds.
    #[cfg(feature = "image")]
    pub(super) fn rows(&self) -> Range<u32> {
        self.rows.clone()
    }

    /// The view that the frame is a picture of.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The ray through pixel (x, y), counted from the upper left from zero.
    pub fn ray(&self, x: u32, y: u32) -> Ray {
        let [x, y] = self.in_view(x, y);
        self.view.ray(x, y)
    }

    /// Where in the view the ray through a pixel is.
    pub(super) fn in_view(&self, x: u32, y: u32) -> [f64; 2] {
        let (column, row) = (f64::from(x), f64::from(y) + f64::from(self.rows.start));
        [column + self.offset[0], row + self.offset[1]]
    }

    /// How far down in the view a row's rays are: 0 at its upper, 1 at its lower edge.
    #[cfg(feature = "image")]
    pub(super) fn down(&self, y: u32) -> f32 {
        let [_, height] = self.view.size();
        #[expect(clippy::cast_possible_truncation, reason = "a fraction")]
        let down = (self.in_view(0, y)[1] / f64::from(height)) as f32;
        down
    }

    /// Where the ray through pixel (x, y) first crosses the boundary of the solid; none
    /// where it misses, and outside of the frame. A crossing with [`Sense::Exit`] is seen
    /// from inside.
    pub fn hit(&self, x: u32, y: u32) -> Option<Crossing> {
        let [width, height] = self.size();
        if x >= width || y >= height {
            return None;
        }
        let tile = (y / TILE) as usize * tiles_along(width) + (x / TILE) as usize;
        self.hits[tile * TILE_AREA + place_in_tile(x, y)].crossing()
    }

    /// The smallest and the largest depth of the hits; none where nothing was hit.
    pub fn depths(&self) -> Option<[f64; 2]> {
        self.hits.iter().filter_map(|hit| hit.crossing()).map(|hit| hit.t).fold(
            None,
            |range, t| {
                let [near, far] = range.unwrap_or([t, t]);
                Some([near.min(t), far.max(t)])
            },
        )
    }

    /// The columns and rows of a tile.
    fn tile(&self, index: usize) -> [Range<u32>; 2] {
        let [width, height] = self.size();
        let across = tiles_along(width);
        #[expect(clippy::cast_possible_truncation, reason = "a frame has u32 rows")]
        let [left, top] = [index % across, index / across].map(|i| i as u32 * TILE);
        [
            left..width.min(left.saturating_add(TILE)),
            top..height.min(top.saturating_add(TILE)),
        ]
    }
}

fn tiles_along(pixels: u32) -> usize {
    pixels.div_ceil(TILE) as usize
}

fn place_in_tile(x: u32, y: u32) -> usize {
    (y % TILE * TILE + x % TILE) as usize
}

impl Packed {
    const NONE: Self = Self { t: f64::NAN, leaf: 0, face: 0 };

    fn new(crossing: Option<Crossing>) -> Self {
        let Some(Crossing { t, leaf, face, sense }) = crossing else {
            return Self::NONE;
        };
        debug_assert!(t >= 0.0, "a first hit is not behind the origin");
        let sign = match sense {
            Sense::Enter => 1.0,
            Sense::Exit => -1.0,
        };
        Self { t: t.copysign(sign), leaf, face }
    }

    fn crossing(self) -> Option<Crossing> {
        let Self { t, leaf, face } = self;
        if t.is_nan() {
            return None;
        }
        let sense = if t.is_sign_negative() { Sense::Exit } else { Sense::Enter };
        Some(Crossing { t: t.abs(), leaf, face, sense })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packing_keeps_everything() {
        for t in [0.0, 1e-300, 2.5, f64::MAX, f64::INFINITY] {
            for sense in [Sense::Enter, Sense::Exit] {
                let crossing = Crossing { t, leaf: u32::MAX, face: u32::MAX, sense };
                assert_eq!(Packed::new(Some(crossing)).crossing(), Some(crossing));
            }
        }
        assert_eq!(Packed::new(None).crossing(), None);
        assert_eq!(size_of::<Packed>(), 16);
    }
}
