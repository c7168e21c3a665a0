//! A bounding-volume hierarchy: which boxes can a line cross?
//!
//! It knows boxes and numbers of items, nothing of what is in the boxes. A node holds the
//! boxes of its eight children, which meet a line side by side.

mod around;
mod build;
mod probe;
mod split;
#[cfg(test)]
mod tests;
mod visit;

use glam::DVec3;

use crate::aabb::Aabb;
use crate::eight::{EIGHT, Eight, WithEight, with_eight};
use crate::lanes::Lanes;
use around::{Around, Boxed};
pub(crate) use probe::Probe;

/// Boxes in a tree whose ends hold one item each, or several that have a number together.
///
/// 256 bytes a node. There is a node for every five ends or so.
#[derive(Debug)]
pub(crate) struct Bvh {
    bounds: Aabb,
    /// The largest coordinate.
    reach: f64,
    unit: Unit,
    nodes: Vec<Node>,
    /// The children of the root with boxes of double precision, if they are all ends.
    few: Vec<(u32, Aabb)>,
    /// How many nodes and ends can be waiting while those below another are visited.
    waiting: usize,
}

/// Up to eight children and their boxes, in the units of the tree, rounded outward; whole
/// lines of a cache.
#[derive(Clone, Debug)]
#[repr(align(64))]
struct Node {
    /// By axis, low and high.
    planes: [[[f32; EIGHT]; 2]; 3],
    /// Numbers of nodes; with [`END`] numbers of ends.
    children: [u32; EIGHT],
}

/// What is added to the number of an end. There are fewer than 2³¹ of them, and of nodes.
const END: u32 = 1 << 31;

/// The frame in which the box around everything is within −1..1, so that single precision
/// goes a long way wherever in space that is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unit {
    center: DVec3,
    /// A power of two.
    scale: f64,
}

/// What looks at the ends that a line may cross.
pub(crate) trait Visitor {
    /// Always inlined.
    fn end<S: Eight>(&mut self, simd: S, end: u32);

    /// How far along the line, as [`Probe::place`] has it, ends are looked for.
    #[inline(always)]
    fn limit(&self) -> f32 {
        f32::INFINITY
    }
}

impl Bvh {
    /// The hierarchy over some items, whose boxes, all bounded, are looked up by number.
    pub(crate) fn over(items: Vec<u32>, bounds: &[Aabb]) -> Self {
        let items = items.into_iter().map(|i| (i, bounds[i as usize]));
        Self::grouped(items, 1, |items| items[0])
    }

    /// The hierarchy over items and their boxes, of which at most `most` are at an end; `end`
    /// says which number they have together.
    pub(crate) fn grouped(
        items: impl Iterator<Item = (u32, Aabb)> + Clone,
        most: usize,
        mut end: impl FnMut(&[u32]) -> u32,
    ) -> Self {
        let bounds =
            items.clone().fold(Aabb::EMPTY, |around, (_, bounds)| around.hull(bounds));
        let unit = Unit::new(&bounds);
        let mut boxed: Vec<Boxed> = items
            .map(|(item, bounds)| Boxed { around: unit.around(&bounds), item })
            .collect();
        let mut numbers = Vec::new();
        let (nodes, waiting) = build::tree(&mut boxed, most, |items| {
            numbers.clear();
            numbers.extend(items.iter().map(|boxed| boxed.item));
            end(&numbers)
        });
        let few = match &nodes[..] {
            [root] => root.ends(&unit, &bounds),
            _ => Vec::new(),
        };
        Self { bounds, reach: bounds.reach(), unit, nodes, few, waiting }
    }

    /// Its frame.
    pub(crate) fn unit(&self) -> &Unit {
        &self.unit
    }

    /// How much memory it takes.
    #[cfg(test)]
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
    }

    /// The box around everything.
    pub(crate) fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The line through `origin` along `dir`, for the boxes of the tree.
    #[inline(always)]
    pub(crate) fn slabs(&self, origin: DVec3, dir: DVec3) -> Slabs {
        Slabs::new(origin, dir, self.reach)
    }

    /// Calls `visit` with each item at an end whose box the line crosses.
    #[inline(always)]
    pub(crate) fn crossed(&self, slabs: &Slabs, mut visit: impl FnMut(u32)) {
        if !self.few.is_empty() {
            for (end, bounds) in &self.few {
                if slabs.cross(bounds) {
                    visit(*end);
                }
            }
        } else if slabs.cross(&self.bounds) {
            let probe = &self.probe(slabs);
            with_eight(All { bvh: self, probe, each: Each(visit) });
        }
    }

    /// Calls `visit` with each end whose box comes no farther beside a stretch of the line on
    /// any axis than `breadth`: that from `t` = −1 to 1, and some more.
    pub(crate) fn crossed_by(
        &self,
        slabs: &Slabs,
        breadth: DVec3,
        visit: impl FnMut(u32),
    ) {
        let bounds = Aabb::new(self.bounds.min - breadth, self.bounds.max + breadth);
        let [near, far] = slabs.range(&bounds);
        if near <= far && near <= 1.0 && far >= -1.0 {
            let probe = &self.probe(slabs).widened(&self.unit, breadth);
            with_eight(All { bvh: self, probe, each: Each(visit) });
        }
    }

    /// The line in the frame of the tree.
    #[inline(always)]
    pub(crate) fn probe(&self, slabs: &Slabs) -> Probe {
        Probe::new(&self.unit, slabs)
    }

    /// Calls `visit` with each item at an end whose box holds a point between these corners.
    pub(crate) fn holding(&self, low: DVec3, high: DVec3, visit: impl FnMut(u32)) {
        self.meeting(|b| low.cmple(b.max).all() && high.cmpge(b.min).all(), visit);
    }

    /// Calls `visit` with each item at an end whose box touches a box.
    pub(crate) fn around(&self, place: &Aabb, visit: impl FnMut(u32)) {
        self.meeting(|bounds| !bounds.intersection(*place).is_empty(), visit);
    }

    /// Calls `visit` with each item at an end whose box, as all those around it, has a
    /// property.
    pub(crate) fn meeting(
        &self,
        has: impl Fn(&Aabb) -> bool,
        mut visit: impl FnMut(u32),
    ) {
        if self.bounds.is_empty() {
            return;
        }
        let room = 2.0 * f64::EPSILON * self.reach;
        let mut later = vec![0];
        while let Some(at) = later.pop() {
            let node: &Node = &self.nodes[at as usize];
            for (slot, &child) in node.children.iter().enumerate() {
                if child == NONE || !has(&self.unit.aabb(&node.child(slot)).grown(room)) {
                    continue;
                }
                if child & END == 0 {
                    later.push(child);
                } else {
                    visit(child & !END);
                }
            }
        }
    }
}

/// Shows ends to a function.
struct All<'a, F> {
    bvh: &'a Bvh,
    probe: &'a Probe,
    each: Each<F>,
}

impl<F: FnMut(u32)> WithEight for All<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_eight<S: Eight>(mut self, simd: S) {
        self.bvh.visited(simd, self.probe, &mut self.each);
    }
}

/// Calls a function.
struct Each<F>(F);

impl<F: FnMut(u32)> Visitor for Each<F> {
    #[inline(always)]
    fn end<S: Eight>(&mut self, _simd: S, end: u32) {
        self.0(end);
    }
}

/// The child of a slot that has none.
const NONE: u32 = u32::MAX;

impl Node {
    /// Boxes that nothing crosses.
    const EMPTY: Self = Self {
        planes: [[[f32::INFINITY; EIGHT], [f32::NEG_INFINITY; EIGHT]]; 3],
        children: [NONE; EIGHT],
    };

    fn put(&mut self, slot: usize, around: &Around, child: u32) {
        for (k, [low, high]) in self.planes.iter_mut().enumerate() {
            low[slot] = around.low[k];
            high[slot] = around.high[k];
        }
        self.children[slot] = child;
    }

    /// The children, if they are all ends, and their boxes, about as much wider as single
    /// precision makes them.
    fn ends(&self, unit: &Unit, bounds: &Aabb) -> Vec<(u32, Aabb)> {
        const SINGLE: f64 = 16.0 / 16_777_216.0;
        let room = SINGLE / unit.scale + 2.0 * f64::EPSILON * bounds.reach();
        let around = |slot: usize| unit.aabb(&self.child(slot)).grown(room);
        let children = self.children.into_iter().enumerate();
        children
            .filter(|&(_, child)| child != NONE)
            .map(|(slot, child)| (child & !END, around(slot)))
            .collect()
    }

    fn child(&self, slot: usize) -> Around {
        let [low, high] = [0, 1].map(|side| {
            let [x, y, z] = self.planes.map(|on| on[side][slot]);
            [x, y, z, 0.0]
        });
        Around { low, high }
    }
}

impl Unit {
    fn new(bounds: &Aabb) -> Self {
        if bounds.is_empty() {
            return Self { center: DVec3::ZERO, scale: 1.0 };
        }
        let half = 0.5 * bounds.max - 0.5 * bounds.min;
        let scale = 0.5 * half.max_element().inverse_power_of_two();
        Self { center: bounds.center(), scale }
    }

    /// A point in this frame.
    #[inline(always)]
    pub(crate) fn point(&self, p: DVec3) -> DVec3 {
        (p - self.center) * self.scale
    }

    /// The function `weights · (p − origin)` of points as one of points in this frame: its
    /// weights and its constant.
    pub(crate) fn linear(&self, weights: DVec3, origin: DVec3) -> (DVec3, f64) {
        (weights / self.scale, weights.dot(self.center - origin))
    }

    fn around(&self, b: &Aabb) -> Around {
        let (low, high) = (self.point(b.min), self.point(b.max));
        Around {
            low: low.extend(0.0).to_array().map(rounded_down),
            high: high.extend(0.0).to_array().map(|x| -rounded_down(-x)),
        }
    }

    fn aabb(&self, around: &Around) -> Aabb {
        let corner = |[x, y, z, _]: [f32; 4]| {
            DVec3::from_array([x, y, z].map(f64::from)) / self.scale + self.center
        };
        Aabb::new(corner(around.low), corner(around.high))
    }
}

/// The next number of single precision that is not larger.
#[expect(clippy::cast_possible_truncation, reason = "that is what it is for")]
#[inline(always)]
fn rounded_down(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x { nearest.next_down() } else { nearest }
}

/// Numbers of items and nodes fit 31 bits.
fn count(n: usize) -> u32 {
    u32::try_from(n).ok().filter(|&n| n < END).expect("there are fewer than 2³¹ nodes")
}

/// A line as box tests want it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slabs {
    origin: DVec3,
    dir: DVec3,
    inverse: DVec3,
    pad: DVec3,
}

impl Slabs {
    /// The line through `origin` along `dir`, for boxes without coordinates larger than `reach`.
    ///
    /// Boxes are widened by 16 u (|box| + |origin|), u = 2⁻⁵³. That exceeds the rounding of
    /// the test itself (three operations a plane, relative error 3 u of a difference of
    /// coordinates) and of the shear by which triangles are tested (five operations on
    /// coordinates of this size), so a box is never missed that holds a crossing.
    #[inline(always)]
    pub(crate) fn new(origin: DVec3, dir: DVec3, reach: f64) -> Self {
        let pad = DVec3::splat(8.0 * f64::EPSILON * (reach + origin.abs().max_element()));
        // A line parallel to a plane has a quotient too large, not an infinite one: the
        // difference of coordinates may be zero, and 0 · ∞ is no number.
        let inverse = |d: f64| (1.0 / d).clamp(-f64::MAX, f64::MAX);
        let inverse = DVec3::new(inverse(dir.x), inverse(dir.y), inverse(dir.z));
        Self { origin, dir, inverse, pad }
    }

    /// The range of `t` in which the line is in the box, widened as above.
    #[inline(always)]
    pub(crate) fn range(&self, b: &Aabb) -> [f64; 2] {
        let low = (b.min - self.pad - self.origin) * self.inverse;
        let high = (b.max + self.pad - self.origin) * self.inverse;
        [low.min(high).max_element(), low.max(high).min_element()]
    }

    /// Whether the line crosses a box.
    #[inline(always)]
    pub(crate) fn cross(&self, b: &Aabb) -> bool {
        let [near, far] = self.range(b);
        near <= far
    }
}
