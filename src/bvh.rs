//! A bounding-volume hierarchy: which boxes can a line cross?
//!
//! It knows boxes and numbers of items, nothing of what is in the boxes. Built top-down
//! by the surface-area heuristic over bins (I. Wald, "On fast Construction of SAH-based
//! Bounding Volume Hierarchies", IEEE Symposium on Interactive Ray Tracing 2007).

use std::ops::Range;

use glam::DVec3;

use crate::aabb::Aabb;

/// Boxes in a binary tree whose ends hold a few items each.
///
/// 56 bytes a node; with at most [`FEW`] items at an end there are fewer nodes than items
/// in all but adversarial cases, and never more than twice as many.
#[derive(Debug)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

/// An end if it has items; else the children are at `first` and `first + 1`.
#[derive(Clone, Debug)]
struct Node {
    bounds: Aabb,
    first: u32,
    count: u32,
}

/// Ends are not split any further at this number of items.
const FEW: usize = 4;

/// How many bins a split is chosen from.
const BINS: usize = 16;

/// Below this depth ranges are halved whatever it costs, which bounds the depth by
/// `STEEP + 32`.
const STEEP: u32 = 32;

/// Room for what a traversal puts off: one node a level.
const STACK: usize = STEEP as usize + 34;

impl Bvh {
    /// The hierarchy over items `0..bounds.len()` with these boxes, all bounded.
    pub(crate) fn new(bounds: &[Aabb]) -> Self {
        Self::over((0..count(bounds.len())).collect(), bounds)
    }

    /// The hierarchy over some items, whose boxes are looked up by number.
    pub(crate) fn over(mut items: Vec<u32>, bounds: &[Aabb]) -> Self {
        let mut nodes = vec![node(&items, bounds, 0..items.len())];
        let mut open = vec![(0, 0..items.len(), 0)];
        while let Some((parent, range, depth)) = open.pop() {
            if range.len() <= FEW {
                continue;
            }
            let part = &mut items[range.clone()];
            let middle = range.start + split(part, bounds, depth);
            let first = nodes.len();
            for half in [range.start..middle, middle..range.end] {
                nodes.push(node(&items, bounds, half.clone()));
                open.push((nodes.len() - 1, half, depth + 1));
            }
            nodes[parent] =
                Node { first: count(first), count: 0, ..nodes[parent].clone() };
        }
        nodes.shrink_to_fit();
        Self { nodes, items }
    }

    /// How much memory it takes.
    #[cfg(test)]
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.items)
    }

    /// The box around everything.
    pub(crate) fn bounds(&self) -> Aabb {
        self.nodes[0].bounds
    }

    /// Calls `visit` with each item at an end whose box the line crosses.
    pub(crate) fn crossed(&self, slabs: &Slabs, mut visit: impl FnMut(u32)) {
        if self.items.is_empty() || !slabs.cross(&self.bounds()) {
            return;
        }
        let mut later = [0_u32; STACK];
        let mut waiting = 0;
        let mut at = 0;
        loop {
            let Node { first, count, .. } = self.nodes[at as usize];
            if count > 0 {
                self.items[first as usize..][..count as usize]
                    .iter()
                    .for_each(|&i| visit(i));
            } else {
                let (left, right) = (first, first + 1);
                let crossed = |i: u32| slabs.cross(&self.nodes[i as usize].bounds);
                match (crossed(left), crossed(right)) {
                    (true, true) => {
                        later[waiting] = right;
                        waiting += 1;
                        at = left;
                        continue;
                    }
                    (true, false) => {
                        at = left;
                        continue;
                    }
                    (false, true) => {
                        at = right;
                        continue;
                    }
                    (false, false) => {}
                }
            }
            if waiting == 0 {
                return;
            }
            waiting -= 1;
            at = later[waiting];
        }
    }

    /// Calls `visit` with each item at an end whose box touches a box.
    pub(crate) fn around(&self, place: &Aabb, visit: impl FnMut(u32)) {
        self.meeting(|bounds| !bounds.intersection(*place).is_empty(), visit);
    }

    /// Calls `visit` with each item at an end whose box holds a point between these corners.
    pub(crate) fn holding(&self, low: DVec3, high: DVec3, mut visit: impl FnMut(u32)) {
        if self.items.is_empty() {
            return;
        }
        let (mut later, mut waiting) = ([0_u32; STACK], 1);
        while waiting > 0 {
            waiting -= 1;
            let Node { bounds, first, count } = &self.nodes[later[waiting] as usize];
            if low.cmpgt(bounds.max).any() || high.cmplt(bounds.min).any() {
                continue;
            }
            if *count > 0 {
                let (first, count) = (*first as usize, *count as usize);
                self.items[first..][..count].iter().for_each(|&i| visit(i));
            } else {
                later[waiting] = first + 1;
                later[waiting + 1] = *first;
                waiting += 2;
            }
        }
    }

    /// Calls `visit` with each item at an end whose box, as all those around it, has a
    /// property.
    pub(crate) fn meeting(
        &self,
        has: impl Fn(&Aabb) -> bool,
        mut visit: impl FnMut(u32),
    ) {
        if self.items.is_empty() {
            return;
        }
        let mut later = vec![0_u32];
        while let Some(at) = later.pop() {
            let Node { bounds, first, count } = &self.nodes[at as usize];
            if !has(bounds) {
                continue;
            }
            if *count > 0 {
                let (first, count) = (*first as usize, *count as usize);
                self.items[first..][..count].iter().for_each(|&i| visit(i));
            } else {
                later.extend([*first, first + 1]);
            }
        }
    }
}

fn node(items: &[u32], bounds: &[Aabb], range: Range<usize>) -> Node {
    let around =
        items[range.clone()].iter().fold(Aabb::EMPTY, |b, &i| b.hull(bounds[i as usize]));
    Node { bounds: around, first: count(range.start), count: count(range.len()) }
}

/// Reorders items so that the two sides of the best split are contiguous; says where the
/// second begins. Neither side is empty.
fn split(items: &mut [u32], bounds: &[Aabb], depth: u32) -> usize {
    let center = |i: u32| bounds[i as usize].center();
    let centers = Aabb::around(items.iter().map(|&i| center(i)));
    let size = centers.size();
    let axis = size.max_position();
    let half = items.len() / 2;
    if size[axis] > 0.0 && depth < STEEP {
        let bin = |i: u32| bin(center(i)[axis], centers.min[axis], size[axis]);
        if let Some(border) = cheapest_border(items, bounds, bin) {
            items.sort_unstable_by_key(|&i| bin(i) >= border);
            return items.partition_point(|&i| bin(i) < border);
        }
    }
    if size[axis] > 0.0 {
        items.select_nth_unstable_by(half, |&a, &b| {
            center(a)[axis].total_cmp(&center(b)[axis]).then(a.cmp(&b))
        });
    }
    half
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the quotient is in 0..=1, so the product is in 0..=BINS"
)]
fn bin(position: f64, from: f64, width: f64) -> usize {
    (((position - from) / width * BINS as f64) as usize).min(BINS - 1)
}

/// The first bin of the second side where Σ area · items over both sides is least; `None`
/// if all items are in one bin.
fn cheapest_border(
    items: &[u32],
    bounds: &[Aabb],
    bin: impl Fn(u32) -> usize,
) -> Option<usize> {
    let mut bins = [(Aabb::EMPTY, 0_usize); BINS];
    for &i in items {
        let (around, n) = &mut bins[bin(i)];
        *around = around.hull(bounds[i as usize]);
        *n += 1;
    }
    let mut below = [(0.0, 0); BINS];
    let (mut around, mut n) = (Aabb::EMPTY, 0);
    for (border, &(b, k)) in bins.iter().enumerate() {
        below[border] = (area(&around) * n as f64, n);
        around = around.hull(b);
        n += k;
    }
    let (mut around, mut above) = (Aabb::EMPTY, 0);
    let mut best = None;
    for border in (1..BINS).rev() {
        around = around.hull(bins[border].0);
        above += bins[border].1;
        let (cost_below, n_below) = below[border];
        if above == 0 || n_below == 0 {
            continue;
        }
        let cost = cost_below + area(&around) * above as f64;
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, border));
        }
    }
    best.map(|(_, border)| border)
}

/// Half the surface.
fn area(b: &Aabb) -> f64 {
    let s = b.size();
    s.x * s.y + s.y * s.z + s.z * s.x
}

/// Numbers of items and nodes fit 32 bits: leaves and triangles are counted so.
fn count(n: usize) -> u32 {
    u32::try_from(n).expect("leaves and faces are counted in 32 bits")
}

/// A line as box tests want it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slabs {
    origin: DVec3,
    inverse: DVec3,
    pad: DVec3,
}

impl Slabs {
    /// The line through `origin` along `dir`, for boxes within `bounds`.
    ///
    /// Boxes are widened by 16 u (|box| + |origin|), u = 2⁻⁵³. That exceeds the rounding of
    /// the test itself (three operations a plane, relative error 3 u of a difference of
    /// coordinates) and of the shear by which triangles are tested (five operations on
    /// coordinates of this size), so a box is never missed that holds a crossing.
    pub(crate) fn new(origin: DVec3, dir: DVec3, bounds: &Aabb) -> Self {
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        let pad = DVec3::splat(8.0 * f64::EPSILON * (reach + origin.abs().max_element()));
        // A line parallel to a plane has a quotient too large, not an infinite one: the
        // difference of coordinates may be zero, and 0 · ∞ is no number.
        let inverse = DVec3::from_array(
            dir.to_array().map(|d| (1.0 / d).clamp(-f64::MAX, f64::MAX)),
        );
        Self { origin, inverse, pad }
    }

    /// The range of `t` in which the line is in the box, widened as above.
    pub(crate) fn range(&self, b: &Aabb) -> [f64; 2] {
        let low = (b.min - self.pad - self.origin) * self.inverse;
        let high = (b.max + self.pad - self.origin) * self.inverse;
        [low.min(high).max_element(), low.max(high).min_element()]
    }

    /// Whether the line crosses a box.
    pub(crate) fn cross(&self, b: &Aabb) -> bool {
        let [near, far] = self.range(b);
        near <= far
    }
}
