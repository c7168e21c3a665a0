//! Convex hulls of solids, exact where they are made of balls and polyhedra, or are plates.
//!
//! ```text
//!          ┌─ balls, boxes, meshes ──► balls: a polyhedron, cones between balls, and balls
//! leaves ──┤
//!          └─ upright cylinders, boxes and prisms of one height ──► plate: an extrusion
//! ```
//!
//! All others have no exact hull here: cones, ellipsoids, differences with curves.

mod arcs;
mod balls;
mod cone;
mod leaves;
mod plate;

use crate::facets::{FacetsError, Fine};
use crate::solid::Solid;

/// The exact hull of a solid with curves; `None` if it has no curves or no exact hull. `fine` is
/// for polyhedra cut from each other.
///
/// # Errors
///
/// If a mesh is not taken by those who cut it.
pub(super) fn exact(
    solid: &Solid,
    fine: &Fine<'_>,
) -> Result<Option<Solid>, FacetsError> {
    let Some(leaves) = leaves::leaves(solid, fine)? else { return Ok(None) };
    match balls::of(&leaves) {
        Some(balls) => balls::hull(balls),
        None => Ok(plate::hull(&leaves)),
    }
}
