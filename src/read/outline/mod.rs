//! Plane shapes: trees of squares, circles and paths, before they are extruded or revolved.
//!
//! ```text
//!            ┌─ extrude: the tree of prisms and frusta over it, circles exact
//! Outline ───┤
//!            └─ paths: simple polygons, circles fine ones ──► revolve: pieces of cones
//! ```

mod discs;
mod extrude;
mod hull;
mod offset;
mod paths;
mod revolve;
mod split;

use std::sync::Arc;

use glam::{DAffine2, DVec2};

use crate::op::Op;
use crate::solid::Tag;

pub(super) use discs::{Disc, exact_hull, hull_of_discs};
pub(super) use extrude::Extrusion;
pub(super) use hull::{hull, sum};
pub(super) use offset::{Join, offset, offset_with_arcs, stroke};
pub(super) use paths::{Paths, filled};
pub(super) use revolve::{in_wedge, revolved, turned};
pub(super) use split::{by_length, by_number, split};

/// A plane shape: cheap to clone, never changed.
#[derive(Clone, Debug)]
pub(super) struct Outline(Arc<Node>);

#[derive(Debug)]
struct Node {
    kind: Kind,
    children: Vec<Outline>,
}

/// What a node does with its children; shapes have none, maps and tags have one.
#[derive(Debug)]
enum Kind {
    Shape(Shape),
    Boolean(Op),
    Mapped(DAffine2),
    Tagged(Tag),
}

/// A plane shape in its own frame.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// The points with `min ≤ p ≤ max` on both axes.
    Square { min: DVec2, max: DVec2 },
    /// The disc around the origin.
    Circle { radius: f64 },
    /// The even-odd fill of closed paths.
    Paths(Arc<Vec<Vec<DVec2>>>),
}

impl Outline {
    pub(super) fn shape(shape: Shape) -> Self {
        Self::new(Kind::Shape(shape), Vec::new())
    }

    pub(super) fn paths(paths: Vec<Vec<DVec2>>) -> Self {
        Self::shape(Shape::Paths(Arc::new(paths)))
    }

    pub(super) fn boolean(op: Op, children: Vec<Self>) -> Self {
        Self::new(Kind::Boolean(op), children)
    }

    pub(super) fn mapped(self, map: DAffine2) -> Self {
        Self::new(Kind::Mapped(map), vec![self])
    }

    pub(super) fn tagged(self, tag: Tag) -> Self {
        Self::new(Kind::Tagged(tag), vec![self])
    }

    fn new(kind: Kind, children: Vec<Self>) -> Self {
        Self(Arc::new(Node { kind, children }))
    }

    /// Makes something of the shapes and joins it from the leaves up.
    fn fold<T, E>(&self, fold: &mut impl Fold<T, E>) -> Result<T, E> {
        let start = Within { map: DAffine2::IDENTITY, level: 0 };
        let mut values: Vec<T> = Vec::new();
        let mut tasks = vec![(self, Some(start))];
        while let Some((outline, within)) = tasks.pop() {
            let Node { kind, children } = &*outline.0;
            let count = children.len();
            match (kind, within) {
                (Kind::Shape(shape), _) => {
                    let within = within.unwrap_or(start);
                    values.push(fold.shape(shape, &within)?);
                }
                (Kind::Mapped(map), Some(within)) => {
                    let within = Within { map: within.map * *map, ..within };
                    tasks.extend(children.iter().map(|child| (child, Some(within))));
                }
                (kind, Some(within)) => {
                    tasks.push((outline, None));
                    tasks.extend(children.iter().enumerate().rev().map(|(i, child)| {
                        let is_cut =
                            matches!(kind, Kind::Boolean(Op::Difference)) && i > 0;
                        let level = within.level + u32::from(is_cut);
                        (child, Some(Within { level, ..within }))
                    }));
                }
                (Kind::Boolean(op), None) => {
                    let parts = values.split_off(values.len() - count);
                    values.push(fold.boolean(*op, parts)?);
                }
                (Kind::Tagged(tag), None) => {
                    if let Some(value) = values.pop() {
                        values.push(fold.tagged(tag, value));
                    }
                }
                (Kind::Mapped(_), None) => {}
            }
        }
        match values.pop() {
            Some(value) => Ok(value),
            None => fold.boolean(Op::Union, Vec::new()),
        }
    }
}

/// What is around a shape.
#[derive(Clone, Copy, Debug)]
struct Within {
    /// The map from its frame.
    map: DAffine2,
    /// Within how many differences it is subtracted.
    level: u32,
}

/// What becomes of the nodes of an outline.
trait Fold<T, E> {
    fn shape(&mut self, shape: &Shape, within: &Within) -> Result<T, E>;
    fn boolean(&mut self, op: Op, parts: Vec<T>) -> Result<T, E>;
    fn tagged(&mut self, tag: &Tag, part: T) -> T;
}

/// Trees can be deep: they are taken apart with a list of what is left, not by recursion.
impl Drop for Outline {
    fn drop(&mut self) {
        let mut rest = take_children(self);
        while let Some(mut outline) = rest.pop() {
            rest.append(&mut take_children(&mut outline));
        }
    }
}

/// The children of a node that nobody else holds.
fn take_children(outline: &mut Outline) -> Vec<Outline> {
    Arc::get_mut(&mut outline.0)
        .map(|node| std::mem::take(&mut node.children))
        .unwrap_or_default()
}
