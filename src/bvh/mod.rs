//! A bounding-volume hierarchy: which boxes can a line cross?
//!
//! It knows boxes and numbers of items, nothing of what is in the boxes. A node holds the
//! boxes of its eight children, which meet a line side by side.

mod build;
#[cfg(test)]
mod tests;

use glam::DVec3;

use crate::aabb::Aabb;
use crate::eight::{EIGHT, Eight, Numbers, WithEight, with_eight};
use crate::lanes::Lanes;
use build::{Around, Boxed};

/// Boxes in a tree whose ends hold one item each, or several that have a number together.
///
/// 224 bytes a node. Where ends are divided from eight items on there are at most two nodes
/// for seven ends in all but adversarial cases.
#[derive(Debug)]
pub(crate) struct Bvh {
    bounds: Aabb,
    unit: Unit,
    nodes: Vec<Node>,
    /// How many nodes there are on the longest way down.
    depth: usize,
}

/// Up to eight children and their boxes, in the units of the tree, rounded outward.
#[derive(Clone, Debug)]
struct Node {
    low: [[f32; EIGHT]; 3],
    high: [[f32; EIGHT]; 3],
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
}

impl Bvh {
    /// The hierarchy over some items, whose boxes, all bounded, are looked up by number.
    pub(crate) fn over(items: Vec<u32>, bounds: &[Aabb]) -> Self {
        let items = items.into_iter().map(|i| (i, bounds[i as usize]));
        Self::grouped(items, 1, |_, items| items[0])
    }

    /// The hierarchy over items and their boxes, of which at most `most` are at an end; `end`
    /// says which number they have together.
    pub(crate) fn grouped(
        items: impl Iterator<Item = (u32, Aabb)> + Clone,
        most: usize,
        mut end: impl FnMut(&Unit, &[u32]) -> u32,
    ) -> Self {
        let bounds =
            items.clone().fold(Aabb::EMPTY, |around, (_, bounds)| around.hull(bounds));
        let unit = Unit::new(&bounds);
        let mut boxed: Vec<Boxed> = items
            .map(|(item, bounds)| Boxed { around: unit.around(&bounds), item })
            .collect();
        let mut numbers = Vec::new();
        let (nodes, depth) = build::tree(&mut boxed, most, |items| {
            numbers.clear();
            numbers.extend(items.iter().map(|boxed| boxed.item));
            end(&unit, &numbers)
        });
        Self { bounds, unit, nodes, depth }
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

    /// Calls `visit` with each item at an end whose box the line crosses.
    pub(crate) fn crossed(&self, slabs: &Slabs, visit: impl FnMut(u32)) {
        if slabs.cross(&self.bounds) {
            self.visited(&self.probe(slabs), Each(visit));
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
            let probe = Probe::new(&self.unit, slabs, &self.bounds);
            self.visited(&probe.widened(&self.unit, slabs, breadth), Each(visit));
        }
    }

    /// The line in the frame of the tree.
    pub(crate) fn probe(&self, slabs: &Slabs) -> Probe {
        Probe::new(&self.unit, slabs, &self.bounds)
    }

    /// Shows a visitor the ends whose boxes the line crosses.
    pub(crate) fn visited<V: Visitor>(&self, probe: &Probe, visitor: V) {
        // A node more is put off for each child but one on each level, and the last ones
        // are written eight at a time.
        let room = (EIGHT - 1) * self.depth + 2 * EIGHT;
        let mut later = [0; 128];
        if room <= later.len() {
            with_eight(Traversal { bvh: self, probe, visitor, later: &mut later });
        } else {
            let later = &mut vec![0; room];
            with_eight(Traversal { bvh: self, probe, visitor, later });
        }
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
        let reach = self.bounds.min.abs().max(self.bounds.max.abs()).max_element();
        let room = 2.0 * f64::EPSILON * reach;
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
        low: [[f32::INFINITY; EIGHT]; 3],
        high: [[f32::NEG_INFINITY; EIGHT]; 3],
        children: [NONE; EIGHT],
    };

    fn put(&mut self, slot: usize, around: &Around, child: u32) {
        for k in 0..3 {
            self.low[k][slot] = around.low[k];
            self.high[k][slot] = around.high[k];
        }
        self.children[slot] = child;
    }

    fn child(&self, slot: usize) -> Around {
        Around { low: self.low.map(|x| x[slot]), high: self.high.map(|x| x[slot]) }
    }

    /// A bit for each child whose box is crossed.
    ///
    /// With `e = 2⁻²⁴`, a plane is off by at most `3 e` times its distance from the origin,
    /// for a difference, a quotient and a product, and by `e` times the origin: [`Probe`] has
    /// put the planes farther apart than that.
    #[inline(always)]
    fn crossed<S: Eight>(&self, simd: S, probe: &Probe) -> u32 {
        let [x, y, z] = probe.axes;
        let [near_x, far_x] = self.range(simd, 0, &x);
        let [near_y, far_y] = self.range(simd, 1, &y);
        let [near_z, far_z] = self.range(simd, 2, &z);
        let [from, to] = probe.part.map(|t| Numbers::same(simd, t));
        let near = near_x.max(near_y).max(near_z.max(from));
        let far = far_x.min(far_y).min(far_z.min(to));
        // What is not sorted out is crossed.
        !far.less(near) & 0xff
    }

    #[inline(always)]
    fn range<S: Eight>(&self, simd: S, axis: usize, on: &OnAxis) -> [Numbers<S>; 2] {
        let inverse = Numbers::same(simd, on.inverse);
        let (near, far) = if on.inverse < 0.0 {
            (&self.high[axis], &self.low[axis])
        } else {
            (&self.low[axis], &self.high[axis])
        };
        let [near_origin, far_origin] = on.origins;
        [
            (Numbers::load(simd, near) - Numbers::same(simd, near_origin)) * inverse,
            (Numbers::load(simd, far) - Numbers::same(simd, far_origin)) * inverse,
        ]
    }
}

struct Traversal<'a, V> {
    bvh: &'a Bvh,
    probe: &'a Probe,
    visitor: V,
    later: &'a mut [u32],
}

impl<V: Visitor> WithEight for Traversal<'_, V> {
    type Output = ();

    #[inline(always)]
    fn with_eight<S: Eight>(self, simd: S) {
        let Self { bvh, probe, mut visitor, later } = self;
        later[0] = 0;
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let at = later[waiting];
            if at & END != 0 {
                visitor.end(simd, at & !END);
                continue;
            }
            let node = &bvh.nodes[at as usize];
            let crossed = node.crossed(simd, probe);
            let room = &mut later[waiting..waiting + EIGHT];
            let mut found = 0;
            for (slot, &child) in node.children.iter().enumerate() {
                room[found & (EIGHT - 1)] = child;
                found += (crossed >> slot & 1) as usize;
            }
            waiting += found;
        }
    }
}

/// A line in the frame of a tree, its origin near the middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probe {
    axes: [OnAxis; 3],
    /// The point of the line that is nearest to the middle.
    pub(crate) origin: DVec3,
    /// At most how far rounding has put the line or a point beside where they should be, in
    /// single and in double precision; too much to sort anything out if it is [`ANYWHERE`].
    pub(crate) pad: f64,
    dir: DVec3,
    /// From where to where on the line.
    part: [f32; 2],
}

/// So large that it is more than all else, but its square is no number of single precision.
const ANYWHERE: f64 = 1e30;

#[derive(Clone, Copy, Debug)]
struct OnAxis {
    inverse: f32,
    /// The origin seen from near and from far planes: on the sides that put these apart.
    origins: [f32; 2],
}

impl Probe {
    /// With `e = 2⁻²⁴` and coordinates of at most 1 for boxes and 1.8 for the origin, a plane
    /// is off by at most `10.3 e`, and by 64 u (|box| + |origin|) in double precision: half
    /// of it for the nearest point, for the rest see [`Slabs::new`].
    fn new(unit: &Unit, slabs: &Slabs, bounds: &Aabb) -> Self {
        const SINGLE: f64 = 16.0 / 16_777_216.0;
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        let largest = reach + slabs.origin.abs().max_element();
        let rounding = 32.0 * f64::EPSILON * largest * unit.scale;
        let dir = slabs.dir * slabs.dir.abs().max_element().inverse_power_of_two();
        let from = unit.point(slabs.origin);
        let nearest = from - from.dot(dir) / dir.length_squared() * dir;
        let (origin, pad) = if rounding < 0.1 && nearest.is_finite() {
            (nearest, SINGLE + 1.001 * rounding)
        } else {
            (DVec3::ZERO, ANYWHERE)
        };
        let axes = std::array::from_fn(|k| OnAxis::new(origin[k], dir[k], pad));
        Self { axes, origin, pad, dir, part: [f32::NEG_INFINITY, f32::INFINITY] }
    }

    /// The same for boxes as far beside the line, and not farther along it than to `t` = −1 and
    /// 1, give or take a thousandth and what rounding does.
    #[expect(clippy::cast_possible_truncation, reason = "there is room for rounding")]
    fn widened(mut self, unit: &Unit, slabs: &Slabs, breadth: DVec3) -> Self {
        // Single precision rounds what is wide more than the origin, which is near.
        let pad = self.pad + 1.001 * unit.scale * breadth;
        if !pad.is_finite() || pad.max_element() >= ANYWHERE {
            self.axes = [OnAxis::new(0.0, 1.0, ANYWHERE); 3];
            return self;
        }
        self.axes =
            std::array::from_fn(|k| OnAxis::new(self.origin[k], self.dir[k], pad[k]));
        let steps = self.dir.length_squared();
        let along = unit.scale * slabs.dir.dot(self.dir) / steps;
        let middle = (unit.point(slabs.origin) - self.origin).dot(self.dir) / steps;
        let room = 1.001 * along + 4.0 * (self.pad + 1e-6 * middle.abs()) / steps.sqrt();
        if self.pad < ANYWHERE {
            self.part = [(middle - room) as f32, (middle + room) as f32];
        }
        self
    }
}

impl OnAxis {
    #[expect(clippy::cast_possible_truncation, reason = "there is room for rounding")]
    fn new(origin: f64, dir: f64, pad: f64) -> Self {
        // A line parallel to a plane has a quotient too large, not an infinite one: the
        // difference of coordinates may be zero, and 0 · ∞ is no number.
        let inverse = (1.0 / dir).clamp(-ANYWHERE, ANYWHERE);
        let pad = pad.copysign(inverse);
        Self {
            inverse: inverse as f32,
            origins: [(origin + pad) as f32, (origin - pad) as f32],
        }
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
    pub(crate) fn point(&self, p: DVec3) -> DVec3 {
        (p - self.center) * self.scale
    }

    /// The function `weights · (p − origin)` of points as one of points in this frame: its
    /// weights and its constant.
    pub(crate) fn linear(&self, weights: DVec3, origin: DVec3) -> (DVec3, f64) {
        (weights / self.scale, weights.dot(self.center - origin))
    }

    fn around(&self, b: &Aabb) -> Around {
        Around {
            low: self.point(b.min).to_array().map(rounded_down),
            high: self.point(b.max).to_array().map(|x| -rounded_down(-x)),
        }
    }

    fn aabb(&self, around: &Around) -> Aabb {
        let corner =
            |p: [f32; 3]| DVec3::from_array(p.map(f64::from)) / self.scale + self.center;
        Aabb::new(corner(around.low), corner(around.high))
    }
}

/// The next number of single precision that is not larger.
#[expect(clippy::cast_possible_truncation, reason = "that is what it is for")]
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
        Self { origin, dir, inverse, pad }
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
