//! What a tree is made of.

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
    /// Counts what the tree is made of.
    pub fn census(&self) -> Census {
        let mut census = Census::default();
        let mut rest = vec![(self, 1)];
        while let Some((solid, depth)) = rest.pop() {
            let (children, below) = match solid.view() {
                View::Primitive(_) | View::Mesh(_) => {
                    census.leaves += 1;
                    (&[][..], depth)
                }
                View::Mapped(_, child) => {
                    census.maps += 1;
                    (std::slice::from_ref(child), depth + 1)
                }
                View::Tagged(child) => (std::slice::from_ref(child), depth),
                View::Boolean(op, children) => {
                    *match op {
                        Op::Union => &mut census.unions,
                        Op::Intersection => &mut census.intersections,
                        Op::Difference => &mut census.differences,
                    } += 1;
                    (children, depth + 1)
                }
            };
            census.depth = census.depth.max(depth);
            rest.extend(children.iter().map(|child| (child, below)));
        }
        census
    }
}
