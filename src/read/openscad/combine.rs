//! Unions, differences and intersections.
//!
//! The first operand that is not empty says whether an operation is plane or solid;
//! operands of the other dimension count as empty, with a warning. (In OpenSCAD 2021.01 an
//! empty primitive still has a dimension, though a group around it has none:
//! `union() { circle(r = 0); cube(1); }` is nothing there and the cube here.)

use super::super::error::Located;
use super::super::outline::Outline;
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
    Ok(alike.joined(Op::Difference))
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
    if alike.len() < count {
        return Ok(Shape::Empty);
    }
    Ok(alike.joined(Op::Intersection))
}

/// The union of shapes; the name and place are for warnings.
pub(super) fn all(
    shapes: Vec<Shape>,
    name: &str,
    place: Place,
    reading: &mut Reading<'_>,
) -> Shape {
    Alike::new(shapes, name, place, reading).joined(Op::Union)
}

pub(super) fn quoted(call: &Call<'_>) -> String {
    format!("`{}`", call.name())
}

/// The shapes that are not empty and of the dimension of the first of them.
#[derive(Debug)]
pub(super) enum Alike {
    Flat(Vec<Outline>),
    Solid(Vec<Solid>),
}

impl Alike {
    pub(super) fn new(
        shapes: Vec<Shape>,
        name: &str,
        place: Place,
        reading: &mut Reading<'_>,
    ) -> Self {
        let (mut alike, mut others) = (Self::Solid(Vec::new()), 0);
        for shape in shapes {
            match (shape, &mut alike) {
                (Shape::Empty, _) => {}
                (Shape::Flat(outline), Self::Flat(outlines)) => outlines.push(outline),
                (Shape::Solid(solid), Self::Solid(solids)) => solids.push(solid),
                (Shape::Flat(outline), Self::Solid(solids)) if solids.is_empty() => {
                    alike = Self::Flat(vec![outline]);
                }
                (Shape::Flat(_), Self::Solid(_)) | (Shape::Solid(_), Self::Flat(_)) => {
                    others += 1;
                }
            }
        }
        if others > 0 {
            let (this, other) = match alike {
                Self::Flat(_) => ("two", "three"),
                Self::Solid(_) => ("three", "two"),
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
        alike
    }

    fn len(&self) -> usize {
        match self {
            Self::Flat(outlines) => outlines.len(),
            Self::Solid(solids) => solids.len(),
        }
    }

    /// One shape of many; none of none.
    pub(super) fn joined(self, op: Op) -> Shape {
        match self {
            Self::Flat(mut outlines) if outlines.len() < 2 => {
                outlines.pop().map_or(Shape::Empty, Shape::Flat)
            }
            Self::Solid(mut solids) if solids.len() < 2 => {
                solids.pop().map_or(Shape::Empty, Shape::Solid)
            }
            Self::Flat(outlines) => Shape::Flat(Outline::boolean(op, outlines)),
            Self::Solid(solids) => Shape::Solid(Solid::boolean(op, solids)),
        }
    }
}
