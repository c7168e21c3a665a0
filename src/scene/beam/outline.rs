//! Which rays of a tile may meet which faces of a mesh.
//!
//! Faces are seen as triangles and rays as points of a plane, eight side by side, and of each
//! ray it is decided whether it certainly passes by (edge functions: J. Pineda, "A Parallel
//! Algorithm for Polygon Rasterization", SIGGRAPH 1988).

use super::block::BLOCK;
use super::sighting::{Grid, PARTS};
use super::tile::{BLOCKS, SIDE, first_of_row};
use crate::eight::{EIGHT, Eight, Numbers, WithEight};
use crate::shape::{Kept, Pack, Polyhedron, View};

/// A list for each ray of a tile: the faces it may meet, front first.
#[derive(Clone, Debug, Default)]
pub(super) struct Lists {
    /// The first entry of each ray, or [`END`].
    first: Vec<u32>,
    entries: Vec<Entry>,
}

/// A face that a ray may meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    /// No crossing is in front of this place on the ray.
    pub(super) near: f64,
    /// The number of the face among those that are shown.
    pub(super) number: u32,
    next: u32,
}

/// Behind the last entry.
const END: u32 = u32::MAX;

impl Lists {
    pub(super) fn clear(&mut self) {
        self.first.clear();
        self.first.resize(BLOCKS * BLOCK, END);
        self.entries.clear();
    }

    /// The list of a ray of the tile.
    #[inline]
    pub(super) fn of(&self, ray: usize) -> impl Iterator<Item = Entry> {
        let mut at = self.first[ray];
        std::iter::from_fn(move || {
            let entry = *self.entries.get(at as usize)?;
            at = entry.next;
            Some(entry)
        })
    }

    /// The first of a ray's list, if there is one.
    #[inline]
    pub(super) fn first(&self, ray: usize) -> Option<Entry> {
        self.entries.get(self.first[ray] as usize).copied()
    }

    /// The one after an entry of a ray's list.
    #[inline]
    pub(super) fn after(&self, entry: &Entry) -> Option<Entry> {
        self.entries.get(entry.next as usize).copied()
    }

    /// Forgets the first of a ray's list.
    #[inline]
    pub(super) fn forget_first(&mut self, ray: usize) {
        if let Some(Entry { next, .. }) = self.first(ray) {
            self.first[ray] = next;
        }
    }

    #[inline]
    fn insert(&mut self, ray: usize, near: f64, number: u32) {
        let (mut before, mut next) = (END, self.first[ray]);
        while let Some(entry) = self.entries.get(next as usize)
            && entry.near <= near
        {
            (before, next) = (next, entry.next);
        }
        #[expect(clippy::cast_possible_truncation, reason = "a few for each ray")]
        let new = self.entries.len() as u32;
        self.entries.push(Entry { near, number, next });
        match self.entries.get_mut(before as usize) {
            Some(entry) => entry.next = new,
            None => self.first[ray] = new,
        }
    }
}

/// A face, and where in which pack it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shown {
    pub(super) face: u32,
    pub(super) pack: u32,
    pub(super) bit: u32,
}

/// Finds the rays that faces of some packs may meet.
pub(super) struct Show<'a> {
    pub(super) mesh: &'a Polyhedron,
    pub(super) view: &'a View,
    pub(super) grid: &'a Grid,
    pub(super) kept: &'a [Kept],
    /// The rays of each block that are asked for.
    pub(super) open: &'a [u64; BLOCKS],
    /// The faces that have been shown.
    pub(super) faces: &'a mut Vec<Shown>,
    pub(super) lists: &'a mut Lists,
}

impl WithEight for Show<'_> {
    type Output = ();

    #[inline(always)]
    fn with_eight<S: Eight>(mut self, simd: S) {
        for kept in self.kept {
            let pack = self.mesh.pack(kept.pack);
            let outlines = Outlines::new(simd, pack, self.view);
            let mut bits = kept.faces;
            while bits != 0 {
                let bit = bits.trailing_zeros();
                bits &= bits - 1;
                if let Some(face) = pack.face(bit) {
                    let shown = Shown { face, pack: kept.pack, bit };
                    self.show(simd, &outlines, bit as usize, shown);
                }
            }
        }
    }
}

impl Show<'_> {
    #[inline(always)]
    fn show<S: Eight>(&mut self, simd: S, outlines: &Outlines, i: usize, face: Shown) {
        let Self { view, grid, open, faces, lists, .. } = self;
        let columns = between(simd, &grid.columns, outlines.sides[0], i);
        if columns == 0 {
            return;
        }
        let mut rows = between(simd, &grid.rows, outlines.sides[1], i);
        let near = view.in_front_of(outlines.near[i]);
        #[expect(clippy::cast_possible_truncation, reason = "faces have such numbers")]
        let number = faces.len() as u32;
        let mut is_seen = false;
        while rows != 0 {
            let row = rows.trailing_zeros() as usize;
            rows &= rows - 1;
            for part in 0..PARTS {
                let first = first_of_row(part, row);
                let asked = open[first / BLOCK] >> (first % BLOCK)
                    & u64::from(columns >> (part * EIGHT))
                    & 0xff;
                if asked == 0 {
                    continue;
                }
                let y = grid.rows[row / EIGHT][row % EIGHT];
                let mut met = asked & outlines.met(simd, i, &grid.columns[part], y);
                while met != 0 {
                    let ray = first + met.trailing_zeros() as usize;
                    met &= met - 1;
                    is_seen = true;
                    lists.insert(ray, near, number);
                }
            }
        }
        if is_seen {
            faces.push(face);
        }
    }
}

/// A bit for each of the numbers that is not certainly outside of a range.
#[inline(always)]
fn between<S: Eight>(
    simd: S,
    numbers: &[[f32; EIGHT]; PARTS],
    [low, high]: [[f32; EIGHT]; 2],
    i: usize,
) -> u32 {
    const { assert!(SIDE == 32) }
    let (low, high) = (Numbers::same(simd, low[i]), Numbers::same(simd, high[i]));
    let mut bits = 0;
    for (part, numbers) in numbers.iter().enumerate() {
        let x = Numbers::load(simd, numbers);
        bits |= (!(x.less(low) | high.less(x)) & 0xff) << (part * EIGHT);
    }
    bits
}

/// Eight faces as they are seen: for each edge the lines beyond which it is certain on
/// which side of the edge a ray is, and a box.
struct Outlines {
    /// Multiples of right and up, for each edge.
    weights: [[[f32; EIGHT]; 2]; 3],
    /// A sum below the first or above the second is certain.
    bounds: [[[f32; EIGHT]; 2]; 3],
    /// Between which places they are, to the right and up.
    sides: [[[f32; EIGHT]; 2]; 2],
    near: [f32; EIGHT],
}

impl Outlines {
    /// With corners that are off by δ each on both axes, an edge function of a ray within δ + ε
    /// of the box around the face, W wide and H high, is off by 2 δ (W + H + 2 ε) + 8 δ².
    /// Divided by the sum of its two weights it is a distance, which is rounded by at most
    /// ε = 16 e (2 + F) if no coordinate is larger than F, e = 2⁻²⁴.
    #[inline(always)]
    fn new<S: Eight>(simd: S, pack: &Pack, view: &View) -> Self {
        let seen = pack.seen(simd, view);
        let [a, b, c] = seen.corners;
        let [low_x, high_x] = [a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0])];
        let [low_y, high_y] = [a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1])];
        let (two, eight) = (Numbers::same(simd, 2.0), Numbers::same(simd, 8.0));
        let single = Numbers::same(simd, 16.0 / 16_777_216.0) * (two + seen.far);
        let off = seen.off;
        let room = off + single;
        let size = (high_x - low_x) + (high_y - low_y) + two * single;
        let error = two * off * size + eight * off * off;
        let mut weights = [[[0.0; EIGHT]; 2]; 3];
        let mut bounds = [[[0.0; EIGHT]; 2]; 3];
        let corners = [a, b, c];
        let mut k = 0;
        while k < 3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            let (p, q) = (from[1] - to[1], to[0] - from[0]);
            let length = p.abs() + q.abs();
            let (p, q) = (p / length, q / length);
            let constant = p * from[0] + q * from[1];
            let error = error / length + single;
            weights[k] = [p.store(), q.store()];
            bounds[k] = [(constant - error).store(), (constant + error).store()];
            k += 1;
        }
        Self {
            weights,
            bounds,
            sides: [
                [(low_x - room).store(), (high_x + room).store()],
                [(low_y - room).store(), (high_y + room).store()],
            ],
            near: seen.near.store(),
        }
    }

    /// A bit for each ray of a row that does not certainly pass by face `i`.
    #[inline(always)]
    fn met<S: Eight>(&self, simd: S, i: usize, columns: &[f32; EIGHT], y: f32) -> u64 {
        let x = Numbers::load(simd, columns);
        let (mut left, mut right) = (0, 0);
        for edge in 0..3 {
            let [p, q] = &self.weights[edge];
            let [low, high] = &self.bounds[edge];
            let sum = x * Numbers::same(simd, p[i]) + Numbers::same(simd, q[i] * y);
            left |= Numbers::same(simd, high[i]).less(sum);
            right |= sum.less(Numbers::same(simd, low[i]));
        }
        u64::from(!(left & right) & 0xff)
    }
}
