//! The tree top-down, by the surface-area heuristic over bins (I. Wald, "On fast
//! Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on Interactive Ray
//! Tracing 2007), eight children at once: the child with the largest surface is divided until
//! there are as many (I. Wald, C. Benthin, S. Boulos, "Getting Rid of Packets", IEEE Symposium
//! on Interactive Ray Tracing 2008).

use std::ops::Range;

use super::{END, Node};
use crate::eight::EIGHT;

/// How many bins a split is chosen from.
const BINS: usize = 16;

/// After this many splits ranges are halved whatever it costs, which bounds the depth.
const STEEP: u32 = 32;

/// An item and its box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boxed {
    pub(super) around: Around,
    pub(super) item: u32,
}

/// A box in the units of a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    pub(super) low: [f32; 3],
    pub(super) high: [f32; 3],
}

/// Some of the items, after so many splits.
struct Part {
    around: Around,
    range: Range<usize>,
    splits: u32,
}

/// The nodes, the root first, and how many there are on the longest way down. Each end has
/// at most `most` items, which `end` gives a number.
pub(super) fn tree(
    items: &mut [Boxed],
    most: usize,
    mut end: impl FnMut(&[Boxed]) -> u32,
) -> (Vec<Node>, usize) {
    let mut nodes = vec![Node::EMPTY];
    let whole = Part { around: Around::of(items), range: 0..items.len(), splits: 0 };
    let (mut open, mut depth) = (vec![(0, whole, 1)], 0);
    while let Some((at, part, level)) = open.pop() {
        depth = depth.max(level);
        let parts = divided(items, part, most);
        for (slot, part) in parts.into_iter().enumerate() {
            let around = part.around;
            let child = match part.range.len() {
                0 => continue,
                n if n <= most => END | end(&items[part.range]),
                _ => {
                    nodes.push(Node::EMPTY);
                    open.push((nodes.len() - 1, part, level + 1));
                    super::count(nodes.len() - 1)
                }
            };
            nodes[at].put(slot, &around, child);
        }
    }
    nodes.shrink_to_fit();
    (nodes, depth)
}

/// Up to eight parts of one.
fn divided(items: &mut [Boxed], part: Part, most: usize) -> Vec<Part> {
    let mut parts = Vec::with_capacity(EIGHT);
    parts.push(part);
    while parts.len() < EIGHT {
        let Some(i) = next(&parts, most) else { break };
        let Part { range: Range { start, end }, splits, .. } = parts.swap_remove(i);
        let middle = start + split(&mut items[start..end], most, splits);
        for range in [start..middle, middle..end] {
            let around = Around::of(&items[range.clone()]);
            parts.push(Part { around, range, splits: splits + 1 });
        }
    }
    parts
}

/// Which part is divided next: the one with the largest surface as long as there are parts
/// for more than a node. Then the smallest one, if all its ends have room in this node:
/// what is small and has no room is a node of its own, and not a nearly empty one.
fn next(parts: &[Part], most: usize) -> Option<usize> {
    let ends = |part: &Part| part.range.len().div_ceil(most);
    let parts = || parts.iter().enumerate();
    let large = parts().filter(|(_, part)| ends(part) > EIGHT);
    let area = |part: &Part| part.around.area();
    if let Some((i, _)) = large.max_by(|(_, a), (_, b)| area(a).total_cmp(&area(b))) {
        return Some(i);
    }
    let (i, small) =
        parts().filter(|(_, part)| ends(part) > 1).min_by_key(|(_, part)| ends(part))?;
    (parts().len() - 1 + ends(small) <= EIGHT).then_some(i)
}

/// Reorders items so that the two sides of the best split are contiguous; says where the
/// second begins. Neither side is empty.
fn split(items: &mut [Boxed], most: usize, splits: u32) -> usize {
    let mut middles = Around::EMPTY;
    for Boxed { around, .. } in items.iter() {
        middles.add_point(around.middle());
    }
    let size: [f32; 3] = std::array::from_fn(|k| middles.high[k] - middles.low[k]);
    let axis = (0..3).fold(0, |best, k| if size[k] > size[best] { k } else { best });
    if size[axis] <= 0.0 {
        return items.len() / 2;
    }
    let node = EIGHT * most;
    // A few nodes are filled one after the other.
    let is_few = most == 1 && items.len() > node && items.len() <= 4 * node;
    if splits < STEEP && !is_few {
        let bins = Bins { axis, from: middles.low[axis], width: size[axis] };
        if let Some(border) = bins.cheapest_border(items, most) {
            return partition(items, |item| bins.of(item) < border);
        }
    }
    let half = items.len() / 2;
    let half = if is_few { half.next_multiple_of(node) } else { half };
    items.select_nth_unstable_by(half, |a, b| {
        let place = |item: &Boxed| item.around.middle()[axis];
        place(a).total_cmp(&place(b)).then(a.item.cmp(&b.item))
    });
    half
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

/// Equal parts of an axis.
struct Bins {
    axis: usize,
    from: f32,
    width: f32,
}

impl Bins {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the quotient is in 0..=1, so the product is in 0..=BINS"
    )]
    fn of(&self, item: &Boxed) -> usize {
        let place = item.around.middle()[self.axis] - self.from;
        ((place / self.width * BINS as f32) as usize).min(BINS - 1)
    }

    /// The first bin of the second side where Σ area · ends over both sides is least;
    /// nothing if all items are in one bin.
    fn cheapest_border(&self, items: &[Boxed], most: usize) -> Option<usize> {
        let mut bins = [(Around::EMPTY, 0_usize); BINS];
        for item in items {
            let (around, n) = &mut bins[self.of(item)];
            around.add(&item.around);
            *n += 1;
        }
        // What does not fit into one node is counted in nodes, so that these are full.
        let unit = if items.len() > EIGHT * most { EIGHT * most } else { most };
        let cost = |around: &Around, n: usize| around.area() * n.div_ceil(unit) as f32;
        let mut below = [(0.0, 0); BINS];
        let (mut around, mut n) = (Around::EMPTY, 0);
        for (border, (b, k)) in bins.iter().enumerate() {
            below[border] = (cost(&around, n), n);
            around.add(b);
            n += k;
        }
        let (mut around, mut above) = (Around::EMPTY, 0);
        let mut best = None;
        for border in (1..BINS).rev() {
            around.add(&bins[border].0);
            above += bins[border].1;
            let (cost_below, n_below) = below[border];
            if above == 0 || n_below == 0 {
                continue;
            }
            let cost = cost_below + cost(&around, above);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, border));
            }
        }
        best.map(|(_, border)| border)
    }
}

impl Around {
    const EMPTY: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    fn of(items: &[Boxed]) -> Self {
        let mut around = Self::EMPTY;
        for item in items {
            around.add(&item.around);
        }
        around
    }

    fn add(&mut self, other: &Self) {
        for k in 0..3 {
            self.low[k] = self.low[k].min(other.low[k]);
            self.high[k] = self.high[k].max(other.high[k]);
        }
    }

    fn add_point(&mut self, point: [f32; 3]) {
        self.add(&Self { low: point, high: point });
    }

    /// Twice the middle.
    fn middle(&self) -> [f32; 3] {
        std::array::from_fn(|k| self.low[k] + self.high[k])
    }

    /// Half the surface; zero of none.
    fn area(&self) -> f32 {
        let [x, y, z] = std::array::from_fn(|k| (self.high[k] - self.low[k]).max(0.0));
        x * y + y * z + z * x
    }
}
