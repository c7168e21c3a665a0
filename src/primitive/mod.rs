//! The primitives: solids given by a formula, in their own frames, and all that is said of each.
//!
//! # To add a primitive
//!
//! Ask first whether it is a combination of those there are. Then a maker in `solid.rs` is all that
//! it takes, and a keyword in the reader if a format has one: a capsule is a cylinder and two balls. What
//! is met often is worth a kind of its own: one leaf instead of several, exact bounds and volume, and
//! a name in reports.
//!
//! One that is on the inner side of planes and at most one quadric of revolution, as a pyramid or a
//! shaft with a flat is, takes four files:
//!
//! 1. its own, here: its sizes, and what `Describe` asks of it. Only its name, the check of its
//!    sizes, its faces and its extent have to be said; who knows more says more, and gets exact volumes,
//!    facets, hulls;
//! 2. this one: its module, its variant of [`Primitive`], and its arm in `Primitive::describe`;
//! 3. its maker, in `solid.rs`;
//! 4. `tests/support/leaf.rs`: its formula once more. Then it is in the random trees, and the exact
//!    arithmetic and the laws that the tests hold against leaves are held against its surfaces, its volume
//!    and its facets too. What sizes it refuses is for a test of its own, as in `tests/prisms.rs`.
//!
//! There is nothing to do for rays, pictures, points and measures: `shape/sides.rs` makes leaves of
//! planes and walls, whichever they are. [`Profile`] is the closed list of quadrics of revolution.
//! If a format has it, there is a keyword in `src/read` besides. The fuzz target `tree` and the programs in
//! `benches/peers` have lists of their own, which may do without.
//!
//! A surface of another degree (a torus, say) is a new kind of leaf: a solver, with bounds for its
//! rounding, beside `shape/sides.rs` and `shape/polyhedron.rs`, and answers to what the head of
//! `shape/mod.rs` lists.

mod cuboid;
mod extent;
mod half_space;
mod parameter;
mod prism;
mod profile;
mod quadric;

use std::fmt;

use glam::DVec3;

use crate::rounded::Rounded;
pub use cuboid::Cuboid;
pub(crate) use extent::Extent;
pub use half_space::HalfSpace;
pub use parameter::BadParameter;
pub use prism::Prism;
pub use profile::Profile;
pub use quadric::Quadric;

/// A solid given by a formula, in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Primitive {
    /// A box along the axes.
    Cuboid(Cuboid),
    /// A solid of revolution about the z-axis, cut at two heights.
    Quadric(Quadric),
    /// What is between two regular polygons: a prism, a pyramid or a frustum of one.
    Prism(Prism),
    /// One side of a plane: unbounded, so of use inside an intersection or as what is
    /// subtracted.
    HalfSpace(HalfSpace),
}

impl Primitive {
    /// The primitive's own answers.
    pub(crate) fn describe(&self) -> &dyn Describe {
        match self {
            Self::Cuboid(primitive) => primitive,
            Self::Quadric(primitive) => primitive,
            Self::Prism(primitive) => primitive,
            Self::HalfSpace(primitive) => primitive,
        }
    }

    /// What the primitive is called in reports.
    pub fn name(&self) -> &'static str {
        self.describe().name()
    }

    /// Whether the sizes make a solid.
    ///
    /// # Errors
    ///
    /// The first parameter that is not finite or not in its range.
    pub fn check(&self) -> Result<(), BadParameter> {
        self.describe().check()
    }
}

/// What a primitive says of itself, in its own frame.
pub(crate) trait Describe: fmt::Debug {
    /// What it is called in reports.
    fn name(&self) -> &'static str;

    /// Whether the sizes make a solid; nothing else is asked if they do not.
    ///
    /// # Errors
    ///
    /// The first parameter that is not finite or not in its range.
    fn check(&self) -> Result<(), BadParameter>;

    /// Its flat faces: it is on the inner side of all of them. They are numbered in this order, from 1 if
    /// there is a wall, which is 0, and else from 0; [`MOST_FACES`] there may be with the wall.
    fn planes(&self) -> Vec<Flat>;

    /// The quadric that it is inside of as well.
    fn wall(&self) -> Option<Curved> {
        None
    }

    /// What it is within: the bounds of models are made of it, so it should not be larger than need
    /// be.
    fn extent(&self) -> Extent;

    /// What facets stand for it. Without an answer there are no meshes of it, nor hulls.
    fn facets(&self) -> Facets {
        Facets::Unknown
    }

    /// Whether it is its own hull. Without an answer hulls are made of facets.
    fn is_convex(&self) -> bool {
        false
    }

    /// Its volume. Without an answer it is measured by rays.
    fn volume(&self) -> Option<Rounded> {
        None
    }

    /// The sizes that move its faces along each axis, and what files may have said instead of them (a
    /// height for the difference of two ends): where OpenSCAD has printed them with six digits they are
    /// off by half of the sixth, and a weld makes up for that. Without an answer they count as exact, as
    /// do those of what no file has.
    fn lengths(&self) -> [Vec<f64>; 3] {
        [const { Vec::new() }; 3]
    }
}

/// How many faces a primitive can have: sets of them are bits of a number.
pub(crate) const MOST_FACES: usize = 32;

/// A flat face: the points with `normal · p ≤ offset` are on its inner side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flat {
    /// Of any length.
    pub(crate) normal: DVec3,
    pub(crate) offset: f64,
    /// A point on it: one whose coordinates were said, a corner perhaps. Where a map makes the plane square
    /// to an axis, its place is this point's.
    pub(crate) point: DVec3,
}

/// A curved face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curved {
    pub(crate) profile: Profile,
    /// The heights between which there is any of it.
    pub(crate) ends: [f64; 2],
}

/// What facets stand for a primitive.
#[derive(Clone, Debug)]
pub(crate) enum Facets {
    /// Nobody has said.
    Unknown,
    /// A ball around the origin.
    Ball { radius: f64 },
    /// A cylinder, a cone or a frustum of one about the z-axis: its radii at its ends.
    Frustum { radii: [f64; 2], ends: [f64; 2] },
    /// Its own triangles, which look outwards: it has no curves.
    Polyhedron { points: Vec<DVec3>, faces: Vec<[u32; 3]> },
    /// As much of the points with `normal · p ≤ offset` as there is of anything else.
    HalfSpace { normal: DVec3, offset: f64 },
}
