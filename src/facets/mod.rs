//! Facets, for those who need some: curves as polyhedra, and a solid's surface as one mesh.
//!
//! No query needs them: solids are asked as they are, and what readers make of facets, where a curve
//! has no exact solid, they say. Here [`faceted`] replaces balls, cylinders
//! and cones by the polyhedra that OpenSCAD makes of them, and [`boundary`] finds the
//! surface of what is then made of meshes alone, by the Manifold library
//! (<https://github.com/elalish/manifold>). [`surface()`] does both with facets as near to the
//! curves as is asked for.

mod boundary;
mod flatten;
mod hull;
#[cfg(test)]
mod hull_tests;
mod in_phase;
mod longest;
mod parts;
mod quickhull;
mod replace;
mod surface;

use thiserror::Error;

pub use boundary::boundary;
pub(crate) use flatten::{section, shadow};
pub(crate) use hull::{Operand, hull, sum, triangles_of_sum};
pub(crate) use parts::{Fine, bounds_of_union, of_meshes, parts};
pub use replace::{Faceted, faceted};
pub use surface::surface;

use crate::mesh::MeshError;
use crate::primitive::{BadParameter, Facets, Primitive};
use crate::shown::Shown;

/// What facets stand for a primitive, if its sizes make a solid.
fn of(primitive: &Primitive) -> Result<Facets, FacetsError> {
    primitive.check().map_err(|BadParameter { parameter, value }| {
        FacetsError::BadParameter { leaf: primitive.name(), parameter, value }
    })?;
    Ok(primitive.describe().facets())
}

/// Why a solid has no facets.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FacetsError {
    /// A leaf that OpenSCAD does not have, so that there are no polyhedra for it.
    #[error("there are no facets for a {0}")]
    NoFacets(&'static str),
    /// A leaf whose sizes make no solid.
    #[error("the {leaf} has a {parameter} of {}", Shown(*.value))]
    BadParameter {
        /// What the leaf is called.
        leaf: &'static str,
        /// Which size.
        parameter: &'static str,
        /// What it is.
        value: f64,
    },
    /// So few segments make no polygon.
    #[error("a curve has at least 3 segments, not {0}")]
    TooFewSegments(u32),
    /// Facets cannot be as near to curves as that.
    #[error("a tolerance is a length above zero, not {}", Shown(*.0))]
    BadTolerance(f64),
    /// A half-space that nothing else bounds.
    #[error("a solid without bounds has no mesh")]
    Unbounded,
    /// There would be too many of them.
    #[error("there would be {count} triangles, which is more than the limit of {limit}")]
    TooMany {
        /// How many there would be.
        count: u64,
        /// How many there may be.
        limit: u64,
    },
    /// A size that makes no polyhedron.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A mesh whose edges belong to more than two faces, or that is broken in another way
    /// that Manifold does not take.
    #[error("Manifold does not take a mesh of this solid: {0}")]
    NotTaken(String),
    /// It was told to stop.
    #[error("stopped before all facets were found")]
    Stopped,
}
