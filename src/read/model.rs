//! What was read.

use std::fmt;

use crate::solid::{Place, Solid};

/// A solid with what there is to say about its reading.
#[derive(Clone, Debug)]
pub struct Model {
    /// The solid; empty when the file describes nothing.
    pub solid: Solid,
    /// What its author marked for the eye.
    pub marks: Marks,
    /// What was ignored or put right.
    pub warnings: Vec<Warning>,
    /// What was read as what.
    pub counts: Counts,
}

impl Default for Model {
    fn default() -> Self {
        Self {
            solid: Solid::empty(),
            marks: Marks::default(),
            warnings: Vec::new(),
            counts: Counts::default(),
        }
    }
}

/// What an OpenSCAD model marks for the eye; none of it is read unless
/// [`ReadOptions::marks`](super::ReadOptions::marks) asks for it.
#[derive(Clone, Debug)]
pub struct Marks {
    /// What stands after `#`, whole, whatever is left of it in the model.
    pub highlighted: Solid,
    /// What stands after `%`, which is no part of the model.
    pub background: Solid,
}

impl Default for Marks {
    fn default() -> Self {
        Self { highlighted: Solid::empty(), background: Solid::empty() }
    }
}

/// What was read as what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Circles, cylinders and spheres read as true curves.
    pub curves: usize,
    /// Those with a small explicit `$fn`, read as the polygons they were meant to be.
    pub polygons: usize,
    /// Those read as polygons because [`Curves::Faceted`](super::Curves) asks for it.
    pub faceted: usize,
    /// Nodes where curves have no exact solid, so that they are facets within
    /// [`ReadOptions::facet_tolerance`](super::ReadOptions::facet_tolerance): hulls, sums, twisted
    /// extrusions and the like.
    pub fine: usize,
    /// Extrusions with twist or uneven scale, cut into slices as OpenSCAD does it.
    pub sliced: usize,
    /// Nodes that were left to the installed OpenSCAD.
    pub elsewhere: usize,
    /// Meshes that were inside out and have been turned.
    pub turned: usize,
}

/// Something that was ignored or put right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Where, if at a place in the text.
    pub place: Option<Place>,
    /// What.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(Place { line, column }) = self.place {
            write!(f, "{line}:{column}: ")?;
        }
        f.write_str(&self.message)
    }
}
