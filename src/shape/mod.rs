//! The leaves of a scene: where a line crosses them, and with which normal.
//!
//! # To add a primitive
//!
//! 1. describe it in [`Primitive`] (`primitive.rs`), with its name and the check of its sizes;
//! 2. write its file here, with the three methods of `Surface` and its bounds;
//! 3. add it to `Shape` and the three matches below;
//! 4. give it a maker in `solid.rs`;
//! 5. and a keyword in the reader, if a format has one.

mod cuboid;
mod half_space;
mod line;
mod place;
mod plane;
mod polyhedron;
mod primitive;
mod quadric;
mod wall;

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use crate::aabb::Aabb;
use crate::ray::Sense;
use cuboid::Cuboid;
use half_space::HalfSpace;
pub(crate) use line::Line;
use place::Frame;
pub(crate) use place::inverse;
pub(crate) use plane::Plane;
pub(crate) use polyhedron::IndexedMesh;
use polyhedron::Polyhedron;
pub use primitive::{BadParameter, Primitive, Profile};
use quadric::Quadric;
pub(crate) use wall::Wall;

/// What a leaf owes.
pub(crate) trait Surface {
    /// Hands over all crossings with a line, in any order: as many in as out, infinite ones
    /// where the line starts or ends inside.
    fn crossings(&self, line: &Line, sink: &mut Sink<'_>);

    /// A normal of any length, outward, on a face at a point.
    fn normal(&self, point: DVec3, face: u32) -> DVec3;

    /// How many faces there are.
    fn faces(&self) -> u32;
}

/// A placed leaf: the closed list of what there is.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Cuboid(Cuboid),
    HalfSpace(HalfSpace),
    Polyhedron(Polyhedron),
    Quadric(Quadric),
}

/// A leaf in its place.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub(crate) shape: Shape,
    /// A box around it, perhaps infinite.
    pub(crate) bounds: Aabb,
    /// The condition number of its map.
    pub(crate) condition: f64,
}

impl Shape {
    /// A primitive under a map; or the determinant of a map that cannot be inverted.
    pub(crate) fn place(primitive: &Primitive, map: DAffine3) -> Result<Placed, f64> {
        let frame = Frame::new(map)?;
        let (shape, bounds) = match *primitive {
            Primitive::Cuboid { min, max } => (
                Self::Cuboid(Cuboid::new(&frame, min, max)),
                Cuboid::bounds(&frame, min, max),
            ),
            Primitive::Quadric { profile, bottom, top } => (
                Self::Quadric(Quadric::new(&frame, profile, bottom, top)),
                Quadric::bounds(&frame, profile, bottom, top),
            ),
            Primitive::HalfSpace { normal, offset } => {
                let leaf = HalfSpace::new(&frame, normal, offset);
                let bounds = leaf.bounds();
                (Self::HalfSpace(leaf), bounds)
            }
        };
        Ok(Placed { shape, bounds, condition: frame.condition() })
    }

    /// A mesh under a map; or the determinant of a map that cannot be inverted.
    pub(crate) fn place_mesh(
        mesh: Arc<IndexedMesh>,
        map: DAffine3,
    ) -> Result<Placed, f64> {
        let frame = Frame::new(map)?;
        let bounds = Polyhedron::bounds(&frame, &mesh);
        let shape = Self::Polyhedron(Polyhedron::new(&frame, mesh));
        Ok(Placed { shape, bounds, condition: frame.condition() })
    }

    /// Whether the leaf is all of its bounds: a box along the axes.
    pub(crate) fn fills_its_bounds(&self) -> bool {
        match self {
            Self::Cuboid(leaf) => leaf.planes.iter().all(|plane| plane.axis().is_some()),
            Self::HalfSpace(_) | Self::Polyhedron(_) | Self::Quadric(_) => false,
        }
    }

    /// The planes of the leaf.
    pub(crate) fn planes_mut(&mut self) -> &mut [Plane] {
        match self {
            Self::Cuboid(leaf) => &mut leaf.planes,
            Self::HalfSpace(leaf) => &mut leaf.planes,
            Self::Quadric(leaf) => leaf.planes.as_mut().map_or(&mut [], |p| p),
            Self::Polyhedron(_) => &mut [],
        }
    }

    /// The curved wall of the leaf.
    pub(crate) fn wall_mut(&mut self) -> Option<&mut Wall> {
        match self {
            Self::Quadric(leaf) => Some(&mut leaf.wall),
            Self::Cuboid(_) | Self::HalfSpace(_) | Self::Polyhedron(_) => None,
        }
    }

    /// What kind of leaf it is, as in [`Primitive::name`].
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Cuboid(_) => "cuboid",
            Self::HalfSpace(_) => "half-space",
            Self::Polyhedron(_) => "mesh",
            Self::Quadric(leaf) => leaf.kind(),
        }
    }

    /// The leaf's methods.
    pub(crate) fn surface(&self) -> &dyn Surface {
        match self {
            Self::Cuboid(leaf) => leaf,
            Self::HalfSpace(leaf) => leaf,
            Self::Polyhedron(leaf) => leaf,
            Self::Quadric(leaf) => leaf,
        }
    }
}

/// A crossing of a line with the surface of one leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Event {
    /// Where on the line; perhaps infinite, never NaN.
    pub(crate) t: f64,
    /// Which leaf.
    pub(crate) leaf: u32,
    /// Which face of it.
    pub(crate) face: u32,
    /// Into the leaf or out of it.
    pub(crate) sense: Sense,
}

/// Where leaves put their crossings.
#[derive(Debug)]
pub(crate) struct Sink<'a> {
    pub(crate) events: &'a mut Vec<Event>,
    pub(crate) leaf: u32,
}

impl Sink<'_> {
    /// The line is inside from one `(t, face)` to another; nothing if that is empty.
    fn stretch(&mut self, enter: (f64, u32), exit: (f64, u32)) {
        if enter.0 < exit.0 {
            self.crossing(enter.0, enter.1, Sense::Enter);
            self.crossing(exit.0, exit.1, Sense::Exit);
        }
    }

    fn crossing(&mut self, t: f64, face: u32, sense: Sense) {
        self.events.push(Event { t, leaf: self.leaf, face, sense });
    }
}
