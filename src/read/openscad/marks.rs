//! What `#` and `%` mark: shown by OpenSCAD's preview, without being of the model.
//!
//! Maps around it move it, and nothing else does: what is marked within a hull, a sum or
//! an extrusion is shown as it is there, as OpenSCAD's `CSGTreeEvaluator` has it. Plane
//! shapes are not shown, nor is what is within nodes that are left to OpenSCAD.

use super::super::error::Located;
use super::super::load::Budget;
use super::super::model::{Counts, Marks};
use super::arguments::Call;
use super::node::Shape;
use super::transform;
use super::value::Statement;
use crate::op::Op;
use crate::solid::Solid;

/// What is marked within a statement.
#[derive(Debug, Default)]
pub(super) struct Marked {
    highlighted: Vec<Solid>,
    background: Vec<Solid>,
}

/// A statement after `%` that is being made, and what is to be after it as it was before.
#[derive(Debug)]
pub(super) struct Aside {
    pub(super) statement: usize,
    pub(super) counts: Counts,
    pub(super) facets: u64,
    pub(super) budget: Budget,
    pub(super) asked: usize,
    pub(super) left_out: Option<Located>,
}

impl Marked {
    /// Adds what is marked in a statement, and its shape if the statement itself is.
    pub(super) fn add(
        &mut self,
        mut inner: Self,
        statement: &Statement<'_>,
        shape: &Shape,
    ) {
        if let Shape::Solid(solid) = shape {
            if statement.modifiers.background {
                inner.background.push(solid.clone());
            } else if statement.modifiers.highlighted {
                // All of it is shown already where nothing is taken away.
                if matches!(
                    statement.name,
                    "group" | "union" | "color" | "render" | "multmatrix"
                ) {
                    inner.highlighted.clear();
                }
                inner.highlighted.push(solid.clone());
            }
        }
        append(&mut self.highlighted, inner.highlighted);
        append(&mut self.background, inner.background);
    }

    /// Moves everything with the children of a `multmatrix`.
    pub(super) fn map(&mut self, call: &Call<'_>) -> Result<(), Located> {
        if call.name() != "multmatrix" {
            return Ok(());
        }
        let map = transform::matrix(call)?;
        for solids in [&mut self.highlighted, &mut self.background] {
            if !solids.is_empty() {
                let all = union(std::mem::take(solids));
                solids.extend(transform::is_regular(&map).then(|| all.mapped(map)));
            }
        }
        Ok(())
    }

    pub(super) fn into_marks(self) -> Marks {
        Marks { highlighted: union(self.highlighted), background: union(self.background) }
    }
}

/// Adds solids to others, without moving many into nothing.
fn append(solids: &mut Vec<Solid>, mut more: Vec<Solid>) {
    if solids.is_empty() {
        *solids = more;
    } else {
        solids.append(&mut more);
    }
}

fn union(mut solids: Vec<Solid>) -> Solid {
    match solids.len() {
        1 => solids.remove(0),
        _ => Solid::boolean(Op::Union, solids),
    }
}
