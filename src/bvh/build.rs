//! Nodes with eight children from branches with two: those that cost least of all that can be
//! made of the same branches (H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs", High-Performance Graphics 2017,
//! section 3.1).
//!
//! Lines meet a box as often as it has surface, and the boxes of the ends are there anyway. So
//! what counts is the surface of the nodes.

use super::around::Boxed;
use super::split::{Branch, branches};
use super::{END, Node, count};
use crate::eight::EIGHT;

/// The nodes, the root first, and how many of their children can be waiting while those below
/// another child are visited. Each end has at most `most` items, which `end` gives a number.
pub(super) fn tree(
    items: &mut [Boxed],
    most: usize,
    mut end: impl FnMut(&[Boxed]) -> u32,
) -> (Vec<Node>, usize) {
    // What is kept stands before what is not, so that this leaves no gap behind. There is room
    // for more nodes than are needed in all but adversarial cases.
    let mut nodes = Vec::with_capacity(items.len() / most / 3 + 1);
    nodes.push(Node::EMPTY);
    let branches = branches(items, most);
    let plans = plans(&branches);
    let (mut open, mut room) = (vec![(0, 0, 0)], 0);
    let mut children = Vec::with_capacity(EIGHT);
    while let Some((at, branch, waiting)) = open.pop() {
        children_of(branch, &branches, &plans, &mut children);
        room = room.max(waiting);
        for (slot, &child) in children.iter().enumerate() {
            let Branch { around, range, parts } = &branches[child];
            let number = match parts {
                None if range.is_empty() => continue,
                None => END | end(&items[range.start as usize..range.end as usize]),
                Some(_) => {
                    nodes.push(Node::EMPTY);
                    open.push((nodes.len() - 1, child, waiting + children.len() - 1));
                    count(nodes.len() - 1)
                }
            };
            nodes[at].put(slot, around, number);
        }
    }
    nodes.shrink_to_fit();
    (nodes, room)
}

/// How to put the nodes below a branch under at most so many children of a node, one more with
/// each number.
#[derive(Clone)]
struct Plan {
    /// The surface of those nodes.
    costs: [f32; EIGHT],
    /// How many of the children are in the first part; none if the branch is a child itself.
    firsts: [u8; EIGHT],
}

impl Plan {
    /// An end is one child.
    const END: Self = Self { costs: [0.0; EIGHT], firsts: [0; EIGHT] };

    /// The children shared out among two parts; what has all of them may be a node.
    fn shared(first: &Self, second: &Self) -> Self {
        let mut plan = Self { costs: [f32::INFINITY; EIGHT], firsts: [0; EIGHT] };
        for all in 1..EIGHT {
            let shares = first.costs[..all].iter().zip(second.costs[..all].iter().rev());
            for ((a, b), of_first) in shares.zip(1..) {
                if a + b < plan.costs[all] {
                    plan.costs[all] = a + b;
                    plan.firsts[all] = of_first;
                }
            }
        }
        plan
    }

    /// The same where the branch may be a node, which costs as much beside what is below it.
    fn or_node(mut self, cost: f32) -> Self {
        let cost = cost + self.costs[EIGHT - 1];
        for all in 0..EIGHT - 1 {
            if cost <= self.costs[all] {
                self.costs[all] = cost;
                self.firsts[all] = 0;
            }
        }
        self
    }
}

/// The cheapest plans of the branches that are not ends, in the order of their parts.
fn plans(branches: &[Branch]) -> Vec<Plan> {
    /// What a node costs that nothing meets, of what it costs that everything meets, divided
    /// among all branches: of nodes that are as good there should be few.
    const MEMORY: f32 = 0.5;
    let all = MEMORY * branches[0].around.area();
    let memory = (all / branches.len() as f32).max(f32::MIN_POSITIVE);
    let mut plans = vec![Plan::END; branches.len() / 2];
    for Branch { around, parts, .. } in branches.iter().rev() {
        if let Some(first) = parts.map(|first| first as usize) {
            let [a, b] = [first, first + 1].map(|i| plan(&branches[i], &plans));
            plans[first / 2] = Plan::shared(a, b).or_node(around.area() + memory);
        }
    }
    plans
}

/// The plan of a branch. Its parts have numbers 1 and 2, 3 and 4, and so on.
fn plan<'a>(branch: &Branch, plans: &'a [Plan]) -> &'a Plan {
    branch.parts.map_or(&Plan::END, |first| &plans[first as usize / 2])
}

/// The branches that are children of a node.
fn children_of(
    node: usize,
    branches: &[Branch],
    plans: &[Plan],
    children: &mut Vec<usize>,
) {
    children.clear();
    let mut open = Vec::with_capacity(EIGHT);
    open.push((node, EIGHT));
    while let Some((at, all)) = open.pop() {
        let branch = &branches[at];
        let of_first = usize::from(plan(branch, plans).firsts[all - 1]);
        match branch.parts.map(|first| first as usize) {
            Some(first) if of_first > 0 => {
                open.push((first + 1, all - of_first));
                open.push((first, of_first));
            }
            _ => children.push(at),
        }
    }
}
