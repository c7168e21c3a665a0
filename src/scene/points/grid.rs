//! A box cut into cells.

use std::ops::Range;

use glam::DVec3;
use pulp::Simd;

use super::Room;
use super::block::Numbers;
use crate::aabb::Aabb;
use crate::lanes::{Lanes, Vector};

/// No axis is divided more often.
const MOST_HALVINGS: u32 = 10;

/// A box divided by halving it across the longest side of its parts, again and again. Cells
/// are numbered row by row: places on the first axis follow one another.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    bounds: Aabb,
    /// Along which axis each halving divides, the first first.
    axes: Vec<usize>,
    /// How many places there are on each axis.
    places: [u32; 3],
    /// How many steps of a cell's width a unit of length is, on each axis.
    per_unit: DVec3,
    /// The width of a cell.
    width: DVec3,
    /// By how much cells are wider than they are divided.
    pad: f64,
}

/// From where to where some cells are on each axis.
pub(super) type Places = [Range<u32>; 3];

/// What is left of a grid after some halvings.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) places: Places,
    halvings: usize,
}

/// Adding this to a number of less than 2³¹ leaves the nearest whole one in its last bits.
const WHOLE: f64 = 4_503_599_627_370_496.0;

/// The whole number in the last bits of a sum with [`WHOLE`].
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "those are the last bits")]
pub(super) fn last_bits(sum: f64) -> usize {
    sum.to_bits() as u32 as usize
}

impl Grid {
    /// Divides a box this often, or less if all axes are used up.
    pub(super) fn new(room: &Room, halvings: usize) -> Self {
        let bounds = room.bounds;
        let (mut size, mut axes, mut count) = (bounds.size(), Vec::new(), [0; 3]);
        while axes.len() < halvings {
            let has_room =
                |&axis: &usize| count[axis] < MOST_HALVINGS && size[axis] > 0.0;
            let axes_left = (0..3).rev().filter(has_room);
            let Some(axis) = axes_left.max_by(|&a, &b| size[a].total_cmp(&size[b]))
            else {
                break;
            };
            size[axis] *= 0.5;
            count[axis] += 1;
            axes.push(axis);
        }
        // The first cell and the last are half as wide as the others: then every coordinate
        // within the bounds rounds to one of them.
        let places = count.map(|n| 1 << n);
        let steps = DVec3::from_array(places.map(|n: u32| f64::from(n - 1)));
        let per_unit =
            DVec3::select(steps.cmpgt(DVec3::ZERO), steps / bounds.size(), DVec3::ZERO);
        // The one cell of an axis that is not divided is cut at the bounds on both sides.
        let undivided = 2.0 * bounds.size();
        let width =
            DVec3::select(steps.cmpgt(DVec3::ZERO), bounds.size() / steps, undivided);
        Self { bounds, axes, places, per_unit, width, pad: room.pad }
    }

    /// How many cells there are.
    pub(super) fn len(&self) -> usize {
        1 << self.axes.len()
    }

    /// All of it.
    pub(super) fn whole(&self) -> Part {
        Part { places: self.places.map(|n| 0..n), halvings: 0 }
    }

    /// The cells of points, as the last bits of numbers; [`Grid::len`] for points that are not
    /// within the bounds.
    #[inline(always)]
    pub(super) fn locate<S: Simd>(
        &self,
        simd: S,
        points: &[Numbers; 3],
        cells: &mut Numbers,
        vectors: usize,
    ) {
        let Self { bounds: Aabb { min, max }, per_unit, places, .. } = self;
        let [x, y, z] = points;
        let [x, y, z] =
            [S::as_simd_f64s(x).0, S::as_simd_f64s(y).0, S::as_simd_f64s(z).0];
        let cells = S::as_mut_simd_f64s(cells).0;
        let like = Vector(simd, simd.splat_f64s(WHOLE));
        let row = like.same(f64::from(places[0]));
        let rows = like.same(f64::from(places[1]));
        #[expect(clippy::cast_precision_loss, reason = "there are at most 2³⁰ cells")]
        let elsewhere = like.same(self.len() as f64 + WHOLE);
        // A number that is not smaller is larger than the one before.
        let low = [min.x, min.y, min.z].map(f64::next_down);
        let high = [max.x, max.y, max.z].map(f64::next_up);
        for (((&x, &y), &z), cell) in x.iter().zip(y).zip(z).zip(cells).take(vectors) {
            let (x, y, z) = (Vector(simd, x), Vector(simd, y), Vector(simd, z));
            let place_x = ((x - like.same(min.x)) * like.same(per_unit.x) + like) - like;
            let place_y = ((y - like.same(min.y)) * like.same(per_unit.y) + like) - like;
            let place_z = ((z - like.same(min.z)) * like.same(per_unit.z) + like) - like;
            let number = ((place_z * rows + place_y) * row + place_x) + like;
            let above = like.same(low[0]).less(x)
                & like.same(low[1]).less(y)
                & like.same(low[2]).less(z);
            let below = x.less(like.same(high[0]))
                & y.less(like.same(high[1]))
                & z.less(like.same(high[2]));
            *cell = Vector::select(above & below, number, elsewhere).1;
        }
    }

    /// The box of some cells, and a little more.
    pub(super) fn around(&self, places: &Places) -> Aabb {
        let at = |axis: usize, place: u32| {
            self.bounds.min[axis] + (f64::from(place) - 0.5) * self.width[axis]
        };
        let first = [0, 1, 2].map(|axis| at(axis, places[axis].start));
        let last = [0, 1, 2].map(|axis| at(axis, places[axis].end));
        let b = Aabb::new(first.into(), last.into()).grown(self.pad);
        let most = self.bounds.grown(self.pad);
        Aabb::new(b.min.max(most.min), b.max.min(most.max))
    }

    /// Whether a part is not divided any further.
    pub(super) fn is_cell(&self, part: &Part) -> bool {
        part.halvings == self.axes.len()
    }

    /// The halves of a part that is no cell, and along which axis it is divided.
    pub(super) fn halves(&self, part: &Part) -> Option<(usize, [Part; 2])> {
        let axis = *self.axes.get(part.halvings)?;
        let Range { start, end } = part.places[axis];
        let middle = start + (end - start) / 2;
        let halves = [start..middle, middle..end].map(|half| {
            let mut places = part.places.clone();
            places[axis] = half;
            Part { places, halvings: part.halvings + 1 }
        });
        Some((axis, halves))
    }

    /// Calls `visit` with the numbers of each row of some cells.
    pub(super) fn rows(&self, [x, y, z]: &Places, mut visit: impl FnMut(Range<usize>)) {
        for z in z.clone() {
            for y in y.clone() {
                let row = ((z * self.places[1] + y) * self.places[0]) as usize;
                visit(row + x.start as usize..row + x.end as usize);
            }
        }
    }

    /// The cells whose boxes a box may touch.
    pub(super) fn touched(&self, b: &Aabb) -> Places {
        // Boxes of cells are larger by one pad, and this is for two more.
        let low = (b.min - 4.0 * self.pad - self.bounds.min) * self.per_unit;
        let high = (b.max + 4.0 * self.pad - self.bounds.min) * self.per_unit;
        [0, 1, 2].map(|axis| {
            let most = f64::from(self.places[axis] - 1);
            let place = |x: f64| {
                // Below 2³¹.
                u32::try_from(last_bits(x.clamp(0.0, most) + WHOLE)).unwrap_or(0)
            };
            if high[axis] < -0.5 || low[axis] > most + 0.5 {
                0..0
            } else {
                place(low[axis])..place(high[axis]) + 1
            }
        })
    }
}
