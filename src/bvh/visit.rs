//! Which ends of a tree a line may cross: in any order, or the nearest first.

use super::probe::{OnAxis, Probe};
use super::{Bvh, END, Node, Visitor};
use crate::eight::{EIGHT, Eight, Numbers, WithEight, with_eight};

impl Bvh {
    /// Shows a visitor the ends whose boxes the line crosses.
    pub(crate) fn visited<V: Visitor>(&self, probe: &Probe, visitor: V) {
        let room = self.room();
        let mut later = [0; 128];
        if room <= later.len() {
            with_eight(Traversal { bvh: self, probe, visitor, later: &mut later });
        } else {
            let later = &mut vec![0; room];
            with_eight(Traversal { bvh: self, probe, visitor, later });
        }
    }

    /// The same, the nearest box of each node first, up to the visitor's limit.
    pub(crate) fn visited_in_order<V: Visitor>(&self, probe: &Probe, visitor: &mut V) {
        let room = self.room();
        let mut later = [(0.0, 0); 64];
        if room <= later.len() {
            with_eight(InOrder { bvh: self, probe, visitor, later: &mut later });
        } else {
            let later = &mut vec![(0.0, 0); room];
            with_eight(InOrder { bvh: self, probe, visitor, later });
        }
    }

    /// How many nodes and ends can be waiting: all children but one on each level, and all
    /// on the last.
    fn room(&self) -> usize {
        (EIGHT - 1) * self.depth + EIGHT
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
        let across = Across::new(simd, probe);
        let [from, to] = probe.part;
        let (from, to) = (Numbers::same(simd, from), Numbers::same(simd, to));
        let (mut waiting, mut at) = (0, 0);
        loop {
            if at & END != 0 {
                visitor.end(simd, at & !END);
            } else {
                let node = &bvh.nodes[at as usize];
                let [near, far] = across.ranges(simd, node);
                // What is not sorted out is crossed.
                let mut crossed = !far.min(to).less(near.max(from)) & 0xff;
                while crossed != 0 {
                    later[waiting] = node.children[next_bit(&mut crossed)];
                    waiting += 1;
                }
            }
            if waiting == 0 {
                return;
            }
            waiting -= 1;
            at = later[waiting];
        }
    }
}

struct InOrder<'a, V> {
    bvh: &'a Bvh,
    probe: &'a Probe,
    visitor: &'a mut V,
    later: &'a mut [(f32, u32)],
}

impl<V: Visitor> WithEight for InOrder<'_, V> {
    type Output = ();

    #[inline(always)]
    fn with_eight<S: Eight>(self, simd: S) {
        let Self { bvh, probe, visitor, later } = self;
        let across = Across::new(simd, probe);
        let from = Numbers::same(simd, probe.part[0]);
        let (mut waiting, mut at) = (0, 0);
        loop {
            if at & END != 0 {
                visitor.end(simd, at & !END);
            } else {
                let node = &bvh.nodes[at as usize];
                let [near, far] = across.ranges(simd, node);
                let (near, far) =
                    (near.max(from), far.min(Numbers::same(simd, visitor.limit())));
                let mut crossed = !far.less(near) & 0xff;
                if crossed != 0 {
                    let places = near.store();
                    let first = next_bit(&mut crossed);
                    at = node.children[first];
                    if crossed != 0 {
                        let mut place = places[first];
                        let room = &mut later[waiting..waiting + EIGHT];
                        let mut others = 0;
                        while crossed != 0 {
                            let other = next_bit(&mut crossed);
                            let mut put_off = (places[other], node.children[other]);
                            if put_off.0 < place {
                                std::mem::swap(&mut put_off.0, &mut place);
                                std::mem::swap(&mut put_off.1, &mut at);
                            }
                            room[others % EIGHT] = put_off;
                            others += 1;
                        }
                        waiting += others;
                    }
                    continue;
                }
            }
            let limit = visitor.limit();
            loop {
                if waiting == 0 {
                    return;
                }
                waiting -= 1;
                let (place, child) = later[waiting];
                if place <= limit {
                    at = child;
                    break;
                }
            }
        }
    }
}

/// Takes away the lowest bit that is set, and says which it was.
#[inline(always)]
fn next_bit(bits: &mut u32) -> usize {
    let bit = bits.trailing_zeros() as usize % EIGHT;
    *bits &= *bits - 1;
    bit
}

/// A probe beside eight boxes.
#[derive(Clone, Copy)]
struct Across<S: Eight> {
    inverse: [Numbers<S>; 3],
    /// The origin seen from near and from far planes.
    origins: [[Numbers<S>; 2]; 3],
    runs_down: [bool; 3],
}

impl<S: Eight> Across<S> {
    #[inline(always)]
    fn new(simd: S, probe: &Probe) -> Self {
        let [x, y, z] = probe.axes;
        Self {
            inverse: [
                Numbers::same(simd, x.inverse),
                Numbers::same(simd, y.inverse),
                Numbers::same(simd, z.inverse),
            ],
            origins: [
                Self::origins(simd, x),
                Self::origins(simd, y),
                Self::origins(simd, z),
            ],
            runs_down: [x.runs_down, y.runs_down, z.runs_down],
        }
    }

    #[inline(always)]
    fn origins(simd: S, on: OnAxis) -> [Numbers<S>; 2] {
        let [near, far] = on.origins;
        [Numbers::same(simd, near), Numbers::same(simd, far)]
    }

    /// From where to where the line is in each child's box; the child is crossed unless the
    /// second is less.
    ///
    /// With `e = 2⁻²⁴`, a plane is off by at most `3 e` times its distance from the origin,
    /// for a difference, a quotient and a product, and by `e` times the origin: [`Probe`] has
    /// put the planes farther apart than that.
    #[inline(always)]
    fn ranges(&self, simd: S, node: &Node) -> [Numbers<S>; 2] {
        let [near_x, far_x] = self.range(simd, node, 0);
        let [near_y, far_y] = self.range(simd, node, 1);
        let [near_z, far_z] = self.range(simd, node, 2);
        [near_x.max(near_y).max(near_z), far_x.min(far_y).min(far_z)]
    }

    #[inline(always)]
    fn range(&self, simd: S, node: &Node, axis: usize) -> [Numbers<S>; 2] {
        let [near_origin, far_origin] = self.origins[axis];
        let runs_down = self.runs_down[axis];
        let near = &node.planes[axis][usize::from(runs_down)];
        let far = &node.planes[axis][usize::from(!runs_down)];
        [
            (Numbers::load(simd, near) - near_origin) * self.inverse[axis],
            (Numbers::load(simd, far) - far_origin) * self.inverse[axis],
        ]
    }
}
