//! `projection`.

use super::super::error::Located;
use super::super::outline::{self, Outline, Paths};
use super::arguments::Call;
use super::combine;
use super::convex::{fault, fine, flat, parts};
use super::evaluate::Reading;
use super::node::Shape;
use crate::facets;
use crate::solid::{Kind, Solid};

/// The shadow of the solid children on the plane z = 0, or their section with it.
pub(super) fn projection(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let is_cut = call.truth("cut")?;
    let mut solids = children;
    let before = solids.len();
    solids.retain(|child| !matches!(child, Shape::Flat(_)));
    if solids.len() < before {
        reading.warn(call.place(), "`projection` ignores two-dimensional children");
    }
    let Shape::Solid(solid) = combine::union(call, solids, reading)? else {
        return Ok(Shape::Empty);
    };
    let paths = if is_cut {
        let made = fine(reading, |fine| facets::of_meshes(&solid, fine));
        section(&made.map_err(|e| fault(call, e))?)
    } else {
        let parts = parts(&solid, call, reading)?;
        outline::filled(&parts.iter().flat_map(facets::shadow).collect())
    };
    let corners: u64 = paths.iter().map(|path| 4 * path.len() as u64).sum();
    reading.count_facets(corners, call.place())?;
    Ok(flat(paths, call))
}

/// The section of a solid of meshes with the plane z = 0. Leaves are closed sets there: of a solid
/// that stands on the plane it is the face below, of one that something is cut from up to the
/// plane it is what that leaves, as in OpenSCAD.
fn section(solid: &Solid) -> Paths {
    let mut values: Vec<Outline> = Vec::new();
    let mut open = vec![(solid, false)];
    while let Some((solid, seen)) = open.pop() {
        let children = solid.children();
        match solid.kind() {
            Kind::Mesh(mesh) => {
                let paths = outline::filled(&facets::section(mesh));
                values.push(Outline::paths(paths));
            }
            Kind::Boolean(op) if seen => {
                let operands = values.split_off(values.len() - children.len());
                values.push(Outline::boolean(*op, operands));
            }
            Kind::Boolean(_) => {
                open.push((solid, true));
                open.extend(children.iter().rev().map(|child| (child, false)));
            }
            // There are none.
            Kind::Primitive(_) | Kind::Mapped(_) | Kind::Tagged(_) => {}
        }
    }
    values.pop().map_or_else(Vec::new, |outline| outline.polygons(&|_| 3))
}
