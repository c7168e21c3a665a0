//! Items divided in two again and again, by the surface-area heuristic over bins (I. Wald,
//! "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on
//! Interactive Ray Tracing 2007).

use std::ops::Range;

use super::around::{Around, Boxed};
use super::count;

/// How many bins of an axis a split is chosen from.
const BINS: usize = 16;

/// After this many splits ranges are halved whatever it costs, which bounds the depth.
const STEEP: u32 = 32;

/// Some of the items.
pub(super) struct Branch {
    pub(super) around: Around,
    pub(super) range: Range<u32>,
    /// The number of the first of the two branches that it is divided into; the other one has
    /// the next number. None at an end.
    pub(super) parts: Option<u32>,
}

/// All branches, each before its parts, the first with all items; those of at most `most` items
/// are ends. Items are reordered so that those of a branch are contiguous.
pub(super) fn branches(items: &mut [Boxed], most: usize) -> Vec<Branch> {
    let range = 0..count(items.len());
    let whole = Branch { around: Around::of(items), range, parts: None };
    let mut branches = Vec::with_capacity(5 * items.len().div_ceil(most) / 2);
    branches.push(whole);
    let mut open = vec![(0, 0)];
    while let Some((at, splits)) = open.pop() {
        let Range { start, end } = branches[at].range;
        let items = &mut items[start as usize..end as usize];
        if items.len() <= most {
            continue;
        }
        let (middle, sides) = split(items, most, splits);
        let middle = start + count(middle);
        let ranges = [start..middle, middle..end];
        branches[at].parts = Some(count(branches.len()));
        for (range, around) in ranges.into_iter().zip(sides) {
            open.push((branches.len(), splits + 1));
            branches.push(Branch { around, range, parts: None });
        }
    }
    branches
}

/// Reorders items so that the two sides of the best split are contiguous; says where the
/// second begins, and what is around them. Neither side is empty.
fn split(items: &mut [Boxed], most: usize, splits: u32) -> (usize, [Around; 2]) {
    let mut middles = Around::EMPTY;
    for Boxed { around, .. } in items.iter() {
        middles.add_point(around.middle());
    }
    if splits < STEEP {
        let bins = Bins::over(&middles);
        if let Some(Split { axis, border, sides, .. }) = bins.cheapest(items, most) {
            let middle = partition(items, |item| bins.of(item)[axis] < border);
            return (middle, sides);
        }
    }
    let larger = |a, b| if middles.size(b) > middles.size(a) { b } else { a };
    let axis = larger(larger(0, 1), 2);
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |a, b| {
        let place = |item: &Boxed| item.around.middle()[axis];
        place(a).total_cmp(&place(b)).then(a.item.cmp(&b.item))
    });
    let (first, second) = items.split_at(half);
    (half, [Around::of(first), Around::of(second)])
}

/// Brings the items with a property to the front; says how many there are.
fn partition(items: &mut [Boxed], is_first: impl Fn(&Boxed) -> bool) -> usize {
    let (mut from, mut to) = (0, items.len());
    while from < to {
        if is_first(&items[from]) {
            from += 1;
        } else {
            to -= 1;
            items.swap(from, to);
        }
    }
    from
}

/// Where items are divided.
struct Split {
    axis: usize,
    /// The first bin of the second side.
    border: usize,
    sides: [Around; 2],
    cost: f32,
}

/// Equal parts of each axis.
struct Bins {
    from: [f32; 4],
    /// How many there are to a unit.
    scale: [f32; 4],
}

/// The items of a bin: what is around them, and how many there are.
type Bin = (Around, usize);

impl Bins {
    fn over(middles: &Around) -> Self {
        let scale = std::array::from_fn(|k| BINS as f32 / middles.size(k));
        Self { from: middles.low, scale }
    }

    /// By axis; the last bin for what cannot be told apart.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "nothing is less than zero or more than the last"
    )]
    #[inline(always)]
    fn of(&self, item: &Boxed) -> [usize; 4] {
        let last = (BINS - 1) as f32;
        let middle = item.around.middle();
        std::array::from_fn(|k| {
            let bin = (middle[k] - self.from[k]) * self.scale[k];
            // Zero times infinity is no number and not less.
            (if bin < last { bin } else { last }) as u32 as usize
        })
    }

    /// The split that costs least; nothing if all items are in one bin.
    fn cheapest(&self, items: &[Boxed], most: usize) -> Option<Split> {
        let mut axes: [[Bin; BINS]; 3] = [[(Around::EMPTY, 0); BINS]; 3];
        for item in items {
            for (bins, bin) in axes.iter_mut().zip(self.of(item)) {
                let (around, n) = &mut bins[bin % BINS];
                around.add(&item.around);
                *n += 1;
            }
        }
        let splits =
            axes.iter().enumerate().filter_map(|(k, bins)| on_axis(k, bins, most));
        splits.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }
}

/// The split between the bins of an axis that costs least.
fn on_axis(axis: usize, bins: &[Bin; BINS], most: usize) -> Option<Split> {
    let mut above = [(Around::EMPTY, 0.0); BINS];
    let (mut around, mut n) = (Around::EMPTY, 0);
    for (bin, above) in bins.iter().zip(&mut above).rev().filter(|(bin, _)| bin.1 > 0) {
        around.add(&bin.0);
        n += bin.1;
        *above = (around, cost(&around, n, most));
    }
    let (mut around, mut n) = (Around::EMPTY, 0);
    let mut best: Option<Split> = None;
    for (border, (bin, (other, above))) in bins.iter().zip(&above).enumerate() {
        if bin.1 == 0 {
            continue;
        }
        if n > 0 {
            let cost = cost(&around, n, most) + above;
            if best.as_ref().is_none_or(|best| cost < best.cost) {
                best = Some(Split { axis, border, sides: [around, *other], cost });
            }
        }
        around.add(&bin.0);
        n += bin.1;
    }
    best
}

/// What it costs to look for lines among so many items: as many ends as have room for them,
/// but with the more of them a line passes by, the more there are.
fn cost(around: &Around, n: usize, most: usize) -> f32 {
    let ends = n.div_ceil(most) as f32;
    around.area() * (ends + 3.0 * ends.sqrt())
}
