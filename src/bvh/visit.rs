//! Which ends of a tree a line may cross: in any order, or the nearest first.

use super::probe::{OnAxis, Probe};
use super::{Bvh, END, Node, Visitor};
use crate::eight::{EIGHT, Eight, Numbers};

impl Bvh {
    /// Shows a visitor the ends whose boxes the line crosses.
    #[inline(always)]
    pub(crate) fn visited<S: Eight, V: Visitor>(
        &self,
        simd: S,
        probe: &Probe,
        visitor: &mut V,
    ) {
        let room = self.room();
        let mut few = [0; 128];
        let mut many = Vec::new();
        let later = if room <= few.len() {
            &mut few[..]
        } else {
            many.resize(room, 0);
            &mut many
        };
        self.visit(simd, probe, visitor, later);
    }

    /// The same, the nearest box of each node first, up to the visitor's limit.
    #[inline(always)]
    pub(crate) fn visited_in_order<S: Eight, V: Visitor>(
        &self,
        simd: S,
        probe: &Probe,
        visitor: &mut V,
    ) {
        let room = self.room();
        let mut few = [(0.0, 0); 64];
        let mut many = Vec::new();
        let later = if room <= few.len() {
            &mut few[..]
        } else {
            many.resize(room, (0.0, 0));
            &mut many
        };
        self.visit_in_order(simd, probe, visitor, later);
    }

    /// How many nodes and ends can be waiting, those of a last node among them.
    fn room(&self) -> usize {
        self.waiting + EIGHT
    }

    #[inline(always)]
    fn visit<S: Eight, V: Visitor>(
        &self,
        simd: S,
        probe: &Probe,
        visitor: &mut V,
        later: &mut [u32],
    ) {
        let across = Across::new(simd, probe);
        let [from, to] = probe.part;
        let (from, to) = (Numbers::same(simd, from), Numbers::same(simd, to));
        let (mut waiting, mut at) = (0, 0);
        loop {
            if at & END != 0 {
                visitor.end(simd, at & !END);
            } else {
                let node = &self.nodes[at as usize];
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

    #[inline(always)]
    fn visit_in_order<S: Eight, V: Visitor>(
        &self,
        simd: S,
        probe: &Probe,
        visitor: &mut V,
        later: &mut [(f32, u32)],
    ) {
        let across = Across::new(simd, probe);
        let from = Numbers::same(simd, probe.part[0]);
        let (mut waiting, mut at) = (0, 0);
        loop {
            if at & END != 0 {
                visitor.end(simd, at & !END);
            } else {
                let node = &self.nodes[at as usize];
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
