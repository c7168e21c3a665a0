//! What a tree is made of.

use std::collections::HashMap;

use crate::op::Op;
use crate::solid::{Solid, View};

/// Counts over the tree of a solid, as it was said: shared subtrees count once for each
/// time they occur.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Census {
    /// Primitives and meshes.
    pub leaves: u64,
    /// Unions.
    pub unions: u64,
    /// Intersections.
    pub intersections: u64,
    /// Differences.
    pub differences: u64,
    /// Affine maps.
    pub maps: u64,
    /// The largest number of operators, maps and leaves from the root to a leaf.
    pub depth: u64,
}

impl Solid {
    /// Counts what the tree is made of. Numbers end at `u64::MAX`.
    pub fn census(&self) -> Census {
        let mut known: HashMap<usize, Census> = HashMap::new();
        let mut open = vec![(self, false)];
        while let Some((solid, seen)) = open.pop() {
            if known.contains_key(&solid.address()) {
                continue;
            }
            let children = solid.children();
            if !seen {
                open.push((solid, true));
                open.extend(children.iter().map(|child| (child, false)));
                continue;
            }
            let below = children.iter().map(|child| known[&child.address()]);
            let sum = below.reduce(Census::beside).unwrap_or_default();
            known.insert(solid.address(), sum.under(solid.view()));
        }
        known[&self.address()]
    }
}

impl Census {
    fn beside(self, other: Self) -> Self {
        Self {
            leaves: self.leaves.saturating_add(other.leaves),
            unions: self.unions.saturating_add(other.unions),
            intersections: self.intersections.saturating_add(other.intersections),
            differences: self.differences.saturating_add(other.differences),
            maps: self.maps.saturating_add(other.maps),
            depth: self.depth.max(other.depth),
        }
    }

    /// The same with the node above.
    fn under(mut self, node: View<'_>) -> Self {
        let count = match node {
            View::Primitive(_) | View::Mesh(_) => &mut self.leaves,
            View::Mapped(..) => &mut self.maps,
            View::Boolean(Op::Union, _) => &mut self.unions,
            View::Boolean(Op::Intersection, _) => &mut self.intersections,
            View::Boolean(Op::Difference, _) => &mut self.differences,
            View::Tagged(_) => return self,
        };
        *count = count.saturating_add(1);
        self.depth += 1;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shared_subtrees_count_each_time() {
        let mut solid = Solid::ball(1.0).named("ball");
        for _ in 0..100 {
            solid = (solid.clone() - solid).translated(glam::DVec3::X);
        }
        let Census { leaves, unions, intersections, differences, maps, depth } =
            solid.census();
        assert_eq!((leaves, differences, maps), (u64::MAX, u64::MAX, u64::MAX));
        assert_eq!((unions, intersections, depth), (0, 0, 201));
        assert_eq!(
            Solid::empty().census(),
            Census { unions: 1, depth: 1, ..Census::default() }
        );
    }
}
