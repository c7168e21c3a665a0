//! Unions, differences and intersections.
//!
//! The first operand that is not empty says whether an operation is plane or solid;
//! operands of the other dimension count as empty, with a warning. (In OpenSCAD 2021.01 an
//! empty primitive still has a dimension, though a group around it has none:
//! `union() { circle(r = 0); cube(1); }` is nothing there and the cube here.)
//!
//! Plane shapes are prisms from z = 0 to 1, and extrusion distributes over the operators,
//! so plane operators are solid ones. What is subtracted is stretched to z = −1 … 2 first:
//! if the prism of A ends at 0 and 1 and that of B reaches beyond, their difference is the
//! prism of A − B and its only ends are those of A. By induction a prism made of any plane
//! operators ends at 0 and 1 alone; a subtracted one is stretched as a whole, so that
//! within it, too, all that is subtracted reaches beyond what it is subtracted from. Thus
//! no end of anything subtracted lies in the plane of another end.

use glam::{DAffine3, DVec3};

use super::super::error::Located;
use super::arguments::Call;
use super::evaluate::Reading;
use super::node::Shape;
use crate::op::Op;
use crate::solid::{Place, Solid};

/// The union of all children.
pub(super) fn union(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    Ok(all(children, &quoted(call), call.place(), reading))
}

/// The first child without the others; nothing when the first is empty.
pub(super) fn difference(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    if !matches!(children.first(), Some(Shape::Flat(_) | Shape::Solid(_))) {
        return Ok(Shape::Empty);
    }
    let alike = Alike::new(children, &quoted(call), call.place(), reading);
    let stretched = |(index, solid): (usize, Solid)| match alike.dimension {
        Dimension::Two if index > 0 => solid.mapped(stretch()),
        Dimension::Two | Dimension::Three => solid,
    };
    let solids: Vec<Solid> =
        alike.solids.into_iter().enumerate().map(stretched).collect();
    Ok(alike.dimension.shape(joined(Op::Difference, solids)))
}

/// What all children share; nothing when any is empty or of another dimension than the
/// first.
pub(super) fn intersection(
    call: &Call<'_>,
    children: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    if children.iter().any(|c| matches!(c, Shape::Empty)) {
        return Ok(Shape::Empty);
    }
    let count = children.len();
    let alike = Alike::new(children, &quoted(call), call.place(), reading);
    if alike.solids.len() < count {
        return Ok(Shape::Empty);
    }
    Ok(alike.dimension.shape(joined(Op::Intersection, alike.solids)))
}

/// The union of shapes; the name and place are for warnings.
pub(super) fn all(
    shapes: Vec<Shape>,
    name: &str,
    place: Place,
    reading: &mut Reading<'_>,
) -> Shape {
    let alike = Alike::new(shapes, name, place, reading);
    alike.dimension.shape(joined(Op::Union, alike.solids))
}

fn quoted(call: &Call<'_>) -> String {
    format!("`{}`", call.name())
}

/// One solid of many; none of none.
fn joined(op: Op, mut solids: Vec<Solid>) -> Option<Solid> {
    if solids.len() > 1 { Some(Solid::boolean(op, solids)) } else { solids.pop() }
}

/// z ↦ 3 z − 1.
fn stretch() -> DAffine3 {
    let mut map = DAffine3::from_scale(DVec3::new(1.0, 1.0, 3.0));
    map.translation = DVec3::new(0.0, 0.0, -1.0);
    map
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Dimension {
    Two,
    Three,
}

impl Dimension {
    fn shape(self, solid: Option<Solid>) -> Shape {
        match (self, solid) {
            (_, None) => Shape::Empty,
            (Self::Two, Some(solid)) => Shape::Flat(solid),
            (Self::Three, Some(solid)) => Shape::Solid(solid),
        }
    }
}

/// The shapes that are not empty and of the dimension of the first of them.
struct Alike {
    dimension: Dimension,
    solids: Vec<Solid>,
}

impl Alike {
    fn new(
        shapes: Vec<Shape>,
        name: &str,
        place: Place,
        reading: &mut Reading<'_>,
    ) -> Self {
        let known = shapes.into_iter().filter_map(|shape| match shape {
            Shape::Empty => None,
            Shape::Flat(solid) => Some((Dimension::Two, solid)),
            Shape::Solid(solid) => Some((Dimension::Three, solid)),
        });
        let (mut first, mut solids, mut others) = (None, Vec::new(), 0);
        for (dimension, solid) in known {
            if *first.get_or_insert(dimension) == dimension {
                solids.push(solid);
            } else {
                others += 1;
            }
        }
        let dimension = first.unwrap_or(Dimension::Three);
        if others > 0 {
            let (this, other) = match dimension {
                Dimension::Two => ("two", "three"),
                Dimension::Three => ("three", "two"),
            };
            reading.warn(
                place,
                format!(
                    "{name} starts {this}-dimensional; {others} {other}-dimensional \
                     {} as nothing",
                    if others == 1 { "child counts" } else { "children count" }
                ),
            );
        }
        Self { dimension, solids }
    }
}
