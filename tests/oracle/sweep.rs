//! One line through a tree: all that happens at one place happens together.

use solidray::Op;

use crate::support::model::Model;

/// What a line meets of one leaf.
#[derive(Clone, Debug)]
pub(crate) struct Passage<T> {
    pub(crate) starts_inside: bool,
    /// Where it comes in or goes out, in order, no two in one place.
    pub(crate) changes: Vec<T>,
}

/// A place where a line comes into a tree or out of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change<T> {
    pub(crate) t: T,
    pub(crate) enters: bool,
    /// The leaf to which it is put down.
    pub(crate) owner: usize,
}

/// The changes along a line, given its passages of all leaves in the order of the tree.
pub(crate) fn sweep<T: Ord + Copy>(
    model: &Model,
    passages: &[Passage<T>],
) -> Vec<Change<T>> {
    let mut events: Vec<(T, usize)> = passages
        .iter()
        .enumerate()
        .flat_map(|(leaf, passage)| passage.changes.iter().map(move |&t| (t, leaf)))
        .collect();
    events.sort_unstable();
    let mut states: Vec<bool> = passages.iter().map(|p| p.starts_inside).collect();
    let mut inside = holds(model, &states);
    assert!(!inside, "the tree is bounded");
    let mut changes = Vec::new();
    for group in events.chunk_by(|a, b| a.0 == b.0) {
        let before = states.clone();
        for &(_, leaf) in group {
            states[leaf] = !states[leaf];
        }
        if holds(model, &states) != inside {
            inside = !inside;
            let owner = Search { before: &before, after: &states, value: inside };
            let owner = owner.first(model, false, &mut 0).expect("some leaf did it");
            changes.push(Change { t: group[0].0, enters: inside, owner });
        }
    }
    changes
}

/// Whether a tree is inside where these leaves are.
pub(crate) fn holds(model: &Model, states: &[bool]) -> bool {
    evaluate(model, states, &mut 0)
}

/// The value of a subtree of which `next` is the first leaf, and then the leaf behind it.
fn evaluate(model: &Model, states: &[bool], next: &mut usize) -> bool {
    match model {
        Model::Leaf(_) => {
            *next += 1;
            states[*next - 1]
        }
        Model::Mapped(_, child) => evaluate(child, states, next),
        Model::Boolean(op, children) => {
            let mut values = children.iter().map(|child| evaluate(child, states, next));
            match op {
                Op::Union => values.fold(false, |sum, value| sum | value),
                Op::Intersection => {
                    values.fold(!children.is_empty(), |sum, value| sum & value)
                }
                Op::Difference => {
                    let first = values.next().unwrap_or(false);
                    values.fold(first, |sum, value| sum & !value)
                }
            }
        }
    }
}

/// The search for the leaf that made a change: the first in the order of the tree that
/// changed the same way, as did all nodes above it.
struct Search<'a> {
    before: &'a [bool],
    after: &'a [bool],
    value: bool,
}

impl Search<'_> {
    fn first(&self, model: &Model, complement: bool, next: &mut usize) -> Option<usize> {
        let leaf = *next;
        let was = evaluate(model, self.before, &mut leaf.clone()) != complement;
        let is = evaluate(model, self.after, next) != complement;
        if was == self.value || is != self.value {
            return None;
        }
        let mut next = leaf;
        match model {
            Model::Leaf(_) => Some(leaf),
            Model::Mapped(_, child) => self.first(child, complement, &mut next),
            Model::Boolean(op, children) => {
                children.iter().enumerate().find_map(|(i, child)| {
                    let turned = *op == Op::Difference && i > 0;
                    self.first(child, complement != turned, &mut next)
                })
            }
        }
    }
}
