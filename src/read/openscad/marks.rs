//! What `#` and `%` mark: shown by OpenSCAD's preview, without being of the model.
//!
//! Maps around it move it, and nothing else does: what is marked within a hull, a sum or
//! an extrusion is shown as it is there, as OpenSCAD's `CSGTreeEvaluator` has it. Plane
//! shapes are not shown.

use super::super::error::Located;
use super::super::model::{Counts, Marks};
use super::arguments::Call;
use super::node::Shape;
use super::transform;
use super::value::Modifiers;
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
    pub(super) left_out: Option<Located>,
}

impl Marked {
    /// Adds what is marked in a statement, and its shape if the statement itself is.
    pub(super) fn add(&mut self, inner: Self, modifiers: Modifiers, shape: &Shape) {
        self.highlighted.extend(inner.highlighted);
        self.background.extend(inner.background);
        let Shape::Solid(solid) = shape else { return };
        if modifiers.background {
            self.background.push(solid.clone());
        } else if modifiers.highlighted {
            self.highlighted.push(solid.clone());
        }
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

fn union(mut solids: Vec<Solid>) -> Solid {
    match solids.len() {
        1 => solids.remove(0),
        _ => Solid::boolean(Op::Union, solids),
    }
}
