//! The Boolean expression of a scene as counters.

use crate::aabb::Aabb;

/// How the children of a node combine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Combine {
    /// True when all are; true without children.
    All,
    /// True when one is; false without children.
    Any,
}

/// A leaf as its parent sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Literal {
    /// The node above.
    pub(crate) parent: u32,
    /// Whether it is true outside the leaf rather than inside.
    pub(crate) complement: bool,
}

impl Literal {
    /// A box around where it is true, from that of its leaf.
    fn bounds(&self, leaf: Aabb) -> Aabb {
        if self.complement { Aabb::ALL } else { leaf }
    }
}

/// An expression in which complements have been pushed to the leaves.
///
/// A node is true when at least `need` of its children are: all of them, or one. Parents
/// stand before their children. Node 0 is the root, a union.
#[derive(Debug)]
pub(crate) struct Program {
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    parent: u32,
    need: u32,
    combine: Combine,
}

impl Program {
    /// The union of nothing yet.
    pub(crate) fn new() -> Self {
        Self { nodes: vec![Node { parent: 0, need: 1, combine: Combine::Any }] }
    }

    /// How many nodes there are.
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The node to add children to for an operator below `parent`: a new one, or the parent
    /// itself if it combines its children in the same way. `None` when nodes have run out.
    pub(crate) fn node_below(&mut self, parent: u32, combine: Combine) -> Option<u32> {
        if self.nodes[parent as usize].combine == combine {
            return Some(parent);
        }
        self.expect_child(parent);
        let id = u32::try_from(self.nodes.len()).ok()?;
        let need = match combine {
            Combine::All => 0,
            Combine::Any => 1,
        };
        self.nodes.push(Node { parent, need, combine });
        Some(id)
    }

    /// Notes that a node gets one more child.
    pub(crate) fn expect_child(&mut self, parent: u32) {
        let node = &mut self.nodes[parent as usize];
        if node.combine == Combine::All {
            node.need += 1;
        }
    }

    /// How many children of each node are true far away from everything, where a leaf is
    /// true if it is a complement.
    pub(crate) fn counts_far_away(&self, literals: &[Literal]) -> Vec<u32> {
        let mut counts = vec![0; self.nodes.len()];
        for literal in literals.iter().filter(|literal| literal.complement) {
            counts[literal.parent as usize] += 1;
        }
        for (i, node) in self.nodes.iter().enumerate().skip(1).rev() {
            if counts[i] >= node.need {
                counts[node.parent as usize] += 1;
            }
        }
        counts
    }

    /// Whether the root is true where some leaves are inside. The counts are scratch memory.
    pub(crate) fn evaluate(
        &self,
        literals: &[Literal],
        counts: &mut Vec<u32>,
        is_inside: impl Fn(usize) -> bool,
    ) -> bool {
        counts.clear();
        counts.resize(self.nodes.len(), 0);
        for (leaf, literal) in literals.iter().enumerate() {
            counts[literal.parent as usize] +=
                u32::from(is_inside(leaf) != literal.complement);
        }
        for (i, node) in self.nodes.iter().enumerate().skip(1).rev() {
            counts[node.parent as usize] += u32::from(counts[i] >= node.need);
        }
        self.root(counts)
    }

    /// A box around where the root is true, from the boxes of the leaves.
    ///
    /// `cutters` are boxes that complements fill: a solid is smaller by what a box cuts off it
    /// straight across. Without them the box holds whatever the complements are.
    pub(crate) fn bounds(
        &self,
        literals: &[Literal],
        leaves: &[Aabb],
        cutters: &[(u32, Aabb)],
    ) -> Aabb {
        self.boxes(literals, leaves, cutters)[0]
    }

    /// Such boxes for all nodes.
    fn boxes(
        &self,
        literals: &[Literal],
        leaves: &[Aabb],
        cutters: &[(u32, Aabb)],
    ) -> Vec<Aabb> {
        let mut boxes: Vec<Aabb> = self
            .nodes
            .iter()
            .map(|node| match node.combine {
                Combine::All => Aabb::ALL,
                Combine::Any => Aabb::EMPTY,
            })
            .collect();
        for (literal, &leaf) in literals.iter().zip(leaves) {
            self.merge(&mut boxes, literal.parent, literal.bounds(leaf));
        }
        let mut cutters_of = vec![Vec::new(); self.nodes.len()];
        for &(node, cutter) in cutters {
            if self.nodes[node as usize].combine == Combine::All {
                cutters_of[node as usize].push(cutter);
            }
        }
        for i in (0..self.nodes.len()).rev() {
            boxes[i] = boxes[i].trimmed(&cutters_of[i]);
            if i > 0 {
                let around = boxes[i];
                self.merge(&mut boxes, self.nodes[i].parent, around);
            }
        }
        boxes
    }

    /// Boxes that hold together where the root is true, from the boxes of the leaves: those of
    /// the operands of the union at the top, and of unions of which something is cut, for
    /// what is left of a union is within what is left of its operands. None is empty.
    pub(crate) fn pieces(
        &self,
        literals: &[Literal],
        leaves: &[Aabb],
        cutters: &[(u32, Aabb)],
    ) -> Vec<Aabb> {
        /// A union is not looked into whose operands all but fill what is left of it: they
        /// tell nothing apart.
        const MOST: f64 = 2.0;
        let boxes = self.boxes(literals, leaves, cutters);
        // How much of each union's cut operands there is.
        let mut sums = vec![0.0; self.nodes.len()];
        let mut count = |node: u32, child: Aabb| {
            let Node { parent, combine, .. } = self.nodes[node as usize];
            if node > 0 && combine == Combine::Any {
                sums[node as usize] +=
                    child.intersection(boxes[parent as usize]).half_area();
            }
        };
        for (literal, &leaf) in literals.iter().zip(leaves) {
            count(literal.parent, literal.bounds(leaf));
        }
        for (node, &around) in self.nodes.iter().zip(&boxes).skip(1) {
            count(node.parent, around);
        }
        // Of the unions that an intersection is of, the one that is looked into.
        let mut chosen: Vec<Option<u32>> = vec![None; self.nodes.len()];
        for (i, node) in (0..).zip(&self.nodes).skip(1) {
            let (parent, sum) = (node.parent as usize, sums[i as usize]);
            let is_better = chosen[parent].is_none_or(|other| sum < sums[other as usize]);
            let is_small = sum <= MOST * boxes[parent].half_area();
            if node.combine == Combine::Any && is_better && is_small {
                chosen[parent] = Some(i);
            }
        }
        let mut pieces = Vec::new();
        let mut found = |piece: Aabb| {
            if !piece.is_empty() {
                pieces.push(piece);
            }
        };
        // What the solid is within, for unions that are looked into.
        let mut within: Vec<Option<Aabb>> = vec![None; self.nodes.len()];
        within[0] = Some(boxes[0]);
        for (i, node) in (0..).zip(&self.nodes).skip(1) {
            let here = match (node.combine, within[node.parent as usize]) {
                (Combine::All, Some(outer)) => outer.intersection(boxes[i]),
                _ => continue,
            };
            match chosen[i] {
                Some(union) => within[union as usize] = Some(here),
                None => found(here),
            }
        }
        for (literal, &leaf) in literals.iter().zip(leaves) {
            if let Some(outer) = within[literal.parent as usize] {
                found(outer.intersection(literal.bounds(leaf)));
            }
        }
        pieces
    }

    fn merge(&self, boxes: &mut [Aabb], node: u32, child: Aabb) {
        let b = &mut boxes[node as usize];
        *b = match self.nodes[node as usize].combine {
            Combine::All => b.intersection(child),
            // The hull of an empty box would be wrong: its bounds are no bounds.
            Combine::Any if child.is_empty() => *b,
            Combine::Any => b.hull(child),
        };
    }

    /// Whether the root is true.
    pub(crate) fn root(&self, counts: &[u32]) -> bool {
        counts[0] >= self.nodes[0].need
    }

    /// Whether a node is true.
    pub(crate) fn is_true(&self, counts: &[u32], node: u32) -> bool {
        counts[node as usize] >= self.nodes[node as usize].need
    }

    /// How a node combines its children.
    pub(crate) fn combine(&self, node: u32) -> Combine {
        self.nodes[node as usize].combine
    }

    /// The node above one that is not the root.
    pub(crate) fn parent(&self, node: u32) -> u32 {
        self.nodes[node as usize].parent
    }

    /// Tells the nodes above a leaf that it has become true or false; says whether the root
    /// changes.
    #[inline]
    pub(crate) fn toggle(
        &self,
        counts: &mut [u32],
        parent: u32,
        mut value: bool,
    ) -> bool {
        let mut at = parent;
        loop {
            let (node, count) = (&self.nodes[at as usize], &mut counts[at as usize]);
            let before = *count >= node.need;
            *count = if value { *count + 1 } else { *count - 1 };
            let after = *count >= node.need;
            if before == after || at == 0 {
                return before != after;
            }
            value = after;
            at = node.parent;
        }
    }

    /// Whether the root depends on a leaf that has this value.
    pub(crate) fn depends(&self, counts: &[u32], parent: u32, mut value: bool) -> bool {
        let mut at = parent;
        loop {
            let (node, count) = (&self.nodes[at as usize], counts[at as usize]);
            if count + u32::from(!value) != node.need {
                return false;
            }
            if at == 0 {
                return true;
            }
            value = count >= node.need;
            at = node.parent;
        }
    }

    /// Whether all nodes from `parent` up to the root have this value.
    pub(crate) fn agrees(&self, counts: &[u32], parent: u32, value: bool) -> bool {
        let mut at = parent;
        loop {
            let node = &self.nodes[at as usize];
            if (counts[at as usize] >= node.need) != value {
                return false;
            }
            if at == 0 {
                return true;
            }
            at = node.parent;
        }
    }
}
