//! A Boolean expression of few faces as arithmetic on points.

use crate::scene::Scene;
use crate::scene::program::Combine;

/// How a number is put with the one that a slot has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Join {
    /// It is the first.
    Set,
    /// Union.
    Min,
    /// Intersection.
    Max,
}

impl From<Combine> for Join {
    fn from(combine: Combine) -> Self {
        match combine {
            Combine::All => Self::Max,
            Combine::Any => Self::Min,
        }
    }
}

/// One thing to be computed for points.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    Face { equation: u32, to: u16, join: Join },
    Slot { from: u16, to: u16, join: Join },
}

/// What is to be computed for the points of each of many regions. Numbers are negative inside,
/// and certain beyond ±1 (`shape/point.rs`).
#[derive(Debug, Default)]
pub(super) struct Plans {
    steps: Vec<Step>,
    ends: Vec<End>,
    /// How many slots are in use at once at most.
    slots: usize,
}

/// Where the steps of a plan end.
#[derive(Clone, Copy, Debug)]
struct End {
    steps: u32,
    /// The slot of the solid then.
    root: u16,
    /// How many slots there are.
    slots: u16,
}

/// What is to be computed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan<'a> {
    pub(super) steps: &'a [Step],
    /// The slot of the solid in the end.
    pub(super) root: u16,
    /// Whether there is one slot only, and so only faces.
    pub(super) is_single: bool,
}

impl Plans {
    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(super) fn slots(&self) -> usize {
        self.slots
    }

    /// How much memory they take.
    #[cfg(test)]
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.steps) + size_of_val(&*self.ends)
    }

    /// The plan with a number.
    #[inline(always)]
    pub(super) fn get(&self, plan: usize) -> Plan<'_> {
        let first = plan.checked_sub(1).map_or(0, |before| self.ends[before].steps);
        let End { steps: end, root, slots } = self.ends[plan];
        let steps = &self.steps[first as usize..end as usize];
        Plan { steps, root, is_single: slots == 1 }
    }
}

/// Something computed or to be computed.
#[derive(Clone, Copy, Debug)]
enum Operand {
    Face(u32),
    Slot(u16),
}

/// Makes plans.
#[derive(Debug)]
pub(super) struct Planner<'a> {
    scene: &'a Scene,
    plans: Plans,
    /// The nodes above the leaves of the plan at hand.
    nodes: Vec<u32>,
    /// For each node of the program the plan in which it was met last, and what is known of
    /// its children there.
    states: Vec<(u32, Option<Operand>)>,
    number: u32,
    /// Slots whose numbers are not needed any more.
    free: Vec<u16>,
    slots: u16,
}

impl<'a> Planner<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            plans: Plans::default(),
            nodes: Vec::new(),
            states: vec![(0, None); scene.program.len()],
            number: 0,
            free: Vec::new(),
            slots: 0,
        }
    }

    pub(super) fn finish(mut self) -> Plans {
        self.plans.steps.shrink_to_fit();
        self.plans.ends.shrink_to_fit();
        self.plans
    }

    /// How many nodes are above the leaves of the last plan.
    pub(super) fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Makes a plan without steps.
    pub(super) fn nothing(&mut self) -> usize {
        self.end(0)
    }

    /// Makes the plan for some leaves that are open, given the equations of their faces,
    /// where all nodes above them are open and everything else is decided. A node with one
    /// child that is open is what that child is.
    pub(super) fn make<F: Iterator<Item = u32>>(
        &mut self,
        leaves: impl Iterator<Item = (u32, F)>,
    ) -> usize {
        self.number += 1;
        self.nodes.clear();
        self.free.clear();
        self.slots = 0;
        for (leaf, faces) in leaves {
            let literal = self.scene.literals[leaf as usize];
            self.meet(literal.parent);
            let of_faces = if literal.complement { Join::Min } else { Join::Max };
            let of_node = self.scene.program.combine(literal.parent).into();
            if of_faces == of_node {
                faces.for_each(|face| self.add(literal.parent, Operand::Face(face)));
            } else {
                let mut faces = faces.map(Operand::Face);
                let Some(first) = faces.next() else { continue };
                let leaf = faces.fold(first, |a, b| self.join(of_faces, a, b));
                self.add(literal.parent, leaf);
            }
        }
        // Parents have smaller numbers than their children.
        self.nodes.sort_unstable_by_key(|&node| std::cmp::Reverse(node));
        for i in 0..self.nodes.len() {
            let node = self.nodes[i];
            if let (Some(found), true) = (self.states[node as usize].1, node > 0) {
                self.add(self.scene.program.parent(node), found);
            }
        }
        match self.states[0] {
            (number, Some(Operand::Slot(root))) if number == self.number => {
                self.end(root)
            }
            (number, Some(Operand::Face(equation))) if number == self.number => {
                let to = self.slot();
                self.plans.steps.push(Step::Face { equation, to, join: Join::Set });
                self.end(to)
            }
            _ => self.end(0),
        }
    }

    fn end(&mut self, root: u16) -> usize {
        let steps = u32::try_from(self.plans.steps.len()).expect("steps are limited");
        self.plans.ends.push(End { steps, root, slots: self.slots });
        self.plans.ends.len() - 1
    }

    /// Notes a node and those above it.
    fn meet(&mut self, mut node: u32) {
        while self.states[node as usize].0 != self.number {
            self.states[node as usize] = (self.number, None);
            self.nodes.push(node);
            if node == 0 {
                break;
            }
            node = self.scene.program.parent(node);
        }
    }

    /// Adds a child to a node.
    fn add(&mut self, node: u32, child: Operand) {
        let join = self.scene.program.combine(node).into();
        let now = match self.states[node as usize].1 {
            None => child,
            Some(before) => self.join(join, before, child),
        };
        self.states[node as usize].1 = Some(now);
    }

    /// Puts two together. Which comes first makes no difference.
    fn join(&mut self, join: Join, a: Operand, b: Operand) -> Operand {
        let to = match (a, b) {
            (Operand::Slot(to), Operand::Slot(from)) => {
                self.plans.steps.push(Step::Slot { from, to, join });
                self.free.push(from);
                to
            }
            (Operand::Slot(to), Operand::Face(equation))
            | (Operand::Face(equation), Operand::Slot(to)) => {
                self.plans.steps.push(Step::Face { equation, to, join });
                to
            }
            (Operand::Face(first), Operand::Face(equation)) => {
                let to = self.slot();
                let set = Step::Face { equation: first, to, join: Join::Set };
                self.plans.steps.extend([set, Step::Face { equation, to, join }]);
                to
            }
        };
        Operand::Slot(to)
    }

    fn slot(&mut self) -> u16 {
        self.free.pop().unwrap_or_else(|| {
            self.slots += 1;
            self.plans.slots = self.plans.slots.max(usize::from(self.slots));
            self.slots - 1
        })
    }
}
