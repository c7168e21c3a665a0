//! The three Boolean operators.

/// How the children of a Boolean node combine, as in OpenSCAD.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// Inside any child. Without children: empty.
    Union,
    /// Inside every child. Without children: empty, as in OpenSCAD.
    Intersection,
    /// Inside the first child and outside all the others.
    Difference,
}
