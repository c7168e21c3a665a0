//! Cells of a box, in an order in which the halves of halves of it follow one another.

use glam::DVec3;

use super::Room;
use crate::aabb::Aabb;

/// No axis is divided more often.
const MOST_BITS: usize = 10;

/// A box divided by halving it across its longest side, again and again. Cells are numbered
/// so that those of each half have one bit more than those of the other (the order of
/// G. M. Morton, 1966, where sides are not halved in turn but as their lengths ask).
#[derive(Clone, Debug)]
pub(super) struct Grid {
    bounds: Aabb,
    /// Along which axis each halving divides, the first first.
    axes: Vec<usize>,
    /// How many steps of a cell's width a unit of length is, on each axis.
    per_unit: DVec3,
    /// The width of a cell.
    width: DVec3,
    /// For each place on each axis the bits it gives to the number.
    bits: [Vec<u32>; 3],
    /// By how much cells are wider than they are divided.
    pad: f64,
}

/// Adding this to a number of less than 2³¹ leaves the nearest whole one in its last bits.
const WHOLE: f64 = 4_503_599_627_370_496.0;

impl Grid {
    /// Divides a box this often, or less if an axis is used up.
    pub(super) fn new(room: &Room, halvings: usize) -> Self {
        let bounds = room.bounds;
        let (mut size, mut axes, mut count) = (bounds.size(), Vec::new(), [0; 3]);
        while axes.len() < halvings {
            let axis = size.max_position();
            if count[axis] == MOST_BITS || size[axis] <= 0.0 {
                break;
            }
            size[axis] *= 0.5;
            count[axis] += 1;
            axes.push(axis);
        }
        // The first cell and the last are half as wide as the others: then every coordinate
        // within the bounds rounds to one of them.
        let steps = count.map(|n| f64::from((1_u32 << n) - 1));
        let steps = DVec3::from_array(steps);
        let per_unit =
            DVec3::select(steps.cmpgt(DVec3::ZERO), steps / bounds.size(), DVec3::ZERO);
        // The one cell of an axis that is not divided is cut at the bounds on both sides.
        let undivided = 2.0 * bounds.size();
        let width =
            DVec3::select(steps.cmpgt(DVec3::ZERO), bounds.size() / steps, undivided);
        let bits = [0, 1, 2].map(|axis| {
            (0..1_u32 << count[axis])
                .map(|place| spread(place, axis, &axes, count[axis]))
                .collect()
        });
        Self { bounds, axes, per_unit, width, bits, pad: room.pad }
    }

    pub(super) fn halvings(&self) -> usize {
        self.axes.len()
    }

    /// The cell of a point within the bounds.
    #[inline(always)]
    pub(super) fn cell(&self, p: DVec3) -> u32 {
        let places = (p - self.bounds.min) * self.per_unit + WHOLE;
        let place = |axis: usize| {
            let i = (places[axis].to_bits() & ((1 << MOST_BITS) - 1)) as usize;
            self.bits[axis].get(i).copied().unwrap_or(0)
        };
        place(0) | place(1) | place(2)
    }

    /// The box of all cells whose first bits are those of `prefix`, and a little more.
    pub(super) fn around(&self, prefix: u32, halvings: usize) -> Aabb {
        let (mut place, mut left) = ([0_u32; 3], [0_u32; 3]);
        for (i, &axis) in self.axes.iter().enumerate() {
            if i < halvings {
                place[axis] = place[axis] << 1 | (prefix >> (halvings - 1 - i) & 1);
            } else {
                left[axis] += 1;
            }
        }
        let first = [0, 1, 2].map(|k| f64::from(place[k] << left[k]) - 0.5);
        let last = [0, 1, 2].map(|k| f64::from((place[k] + 1) << left[k]) - 0.5);
        let at =
            |steps: [f64; 3]| self.bounds.min + DVec3::from_array(steps) * self.width;
        let b = Aabb::new(at(first), at(last)).grown(self.pad);
        let most = self.bounds.grown(self.pad);
        Aabb::new(b.min.max(most.min), b.max.min(most.max))
    }
}

/// Where the bits of a place on an axis are in the numbers of cells.
fn spread(place: u32, axis: usize, axes: &[usize], count: usize) -> u32 {
    let (mut number, mut left) = (0, count);
    for &a in axes {
        number <<= 1;
        if a == axis {
            left -= 1;
            number |= place >> left & 1;
        }
    }
    number
}
