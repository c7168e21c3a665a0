//! The leaves of a scene: where a line crosses them, and with which normal.
//!
//! There are two kinds. [`Sides`] are on the inner side of planes and at most one quadric: all
//! primitives are, so that one more of those (see `crate::primitive`) changes nothing here. A
//! [`Polyhedron`] is a mesh.
//!
//! A leaf of a third kind would have its own file here, with the methods of [`Surface`] and where
//! lines are inside. Then the compiler asks how regions, points and the machine's vectors see it:
//! in the matches below, in `region.rs`, `point.rs` and `scene/beam/block.rs`. Nobody asks where meshes
//! are told from the rest: of what is neither, tiles must not believe that they know all crossings.

mod ahead;
mod chain;
mod doubt;
mod line;
mod over;
mod pack;
mod place;
mod plane;
mod point;
mod polyhedron;
mod region;
mod share;
mod shear;
mod sheared;
mod sides;
mod stretch;
mod touch;
mod wall;
#[cfg(test)]
mod watertight;

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::aabb::Aabb;
use crate::lanes::whole;
use crate::primitive::Primitive;
use crate::ray::Sense;
pub(crate) use ahead::Ahead;
pub(crate) use chain::Chain;
pub(crate) use doubt::{Local, Spot, U};
pub(crate) use line::{Heading, Line, Lines, Rays, Stage, inverse_power_of_two};
pub(crate) use pack::{Kept, Linear, Pack, View};
use place::Frame;
pub(crate) use place::{ToLocal, inverse};
pub(crate) use plane::{Keeps, Plane};
pub(crate) use point::{Beside, Equation};
pub(crate) use polyhedron::{IndexedMesh, Polyhedron};
pub(crate) use region::{Region, Side};
pub(crate) use share::Block;
pub(crate) use sheared::Sheared;
pub(crate) use sides::Sides;
pub(crate) use stretch::Stretch;
pub(crate) use wall::Wall;

/// What a leaf owes.
pub(crate) trait Surface {
    /// A normal of any length, outward, on a face at a point.
    fn normal(&self, point: DVec3, face: u32) -> DVec3;

    /// The equation of a face at a place on a line.
    fn local(&self, spot: &Spot<'_>, face: u32) -> Local;

    /// How many faces there are.
    fn faces(&self) -> u32;

    /// Calls `visit` with the faces that the place may be on; with none where it is outside of
    /// another one.
    ///
    /// As it stands here this is right for leaves that are on the inner side of all their
    /// faces.
    fn near(&self, spot: &Spot<'_>, visit: &mut dyn FnMut(u32, &Local)) {
        let faces = || (0..self.faces()).map(|face| (face, self.local(spot, face)));
        if faces().any(|(_, local)| local.is_outside()) {
            return;
        }
        faces()
            .filter(|(_, local)| local.is_near())
            .for_each(|(f, local)| visit(f, &local));
    }

    /// At most how far along the line the true crossing is from one that was found on a face.
    fn error(&self, spot: &Spot<'_>, face: u32) -> f64 {
        let mut error = self.local(spot, face).reach();
        self.near(spot, &mut |_, local| error = error.max(local.reach()));
        error
    }
}

/// A placed leaf: the closed list of what there is.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Sides(Sides),
    Polyhedron(Box<Polyhedron>),
}

/// A leaf in its place.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub(crate) shape: Shape,
    /// A box around it, perhaps infinite.
    pub(crate) bounds: Aabb,
    /// The condition number of its map.
    pub(crate) condition: f64,
    pub(crate) slack: Slack,
    /// No coordinate of the leaf, or of the plane of a half-space, is larger than this.
    pub(crate) reach: f64,
}

/// At most how far the surfaces of a leaf, as they are kept, lie beside those that were said.
#[derive(Clone, Debug)]
pub(crate) enum Slack {
    /// Anywhere on the leaf.
    Bounded(f64),
    /// It depends on how much of a half-space is wanted.
    Unbounded(Box<(Frame, Chain)>),
}

impl Slack {
    /// Of a leaf with no point farther than this from its own origin, which has planes or not.
    fn of(frame: &Frame, chain: &Chain, radius: f64, has_planes: bool) -> Self {
        let slack =
            if has_planes { frame.slack_of_planes(radius) } else { frame.slack(radius) };
        Self::Bounded(chain.error(radius) + slack)
    }

    /// The same for what is within a box.
    pub(crate) fn within(&self, reach: &Aabb) -> f64 {
        match self {
            Self::Bounded(slack) => *slack,
            Self::Unbounded(map) => {
                let (frame, chain) = &**map;
                // An oblique normal is rounded on its way into the world.
                let rounds = 16.0 * frame.condition();
                let radius = frame.radius_of(reach);
                chain.error(radius) + rounds * frame.slack_of_planes(radius)
            }
        }
    }
}

impl Shape {
    /// A primitive under a map; or the determinant of a map that cannot be inverted.
    pub(crate) fn place(primitive: &Primitive, chain: &Chain) -> Result<Placed, f64> {
        Sides::place(primitive.describe(), chain)
    }

    /// A mesh under a map; or the determinant of a map that cannot be inverted.
    pub(crate) fn place_mesh(
        mesh: Arc<IndexedMesh>,
        chain: &Chain,
    ) -> Result<Placed, f64> {
        let frame = Frame::new(chain.map)?;
        let bounds = Polyhedron::bounds(&frame, &mesh);
        let slack = Slack::of(&frame, chain, mesh.radius(), false);
        let reach = frame.reach(mesh.largest());
        let shape = Self::Polyhedron(Polyhedron::new(&frame, mesh).into());
        Ok(Placed { shape, bounds, condition: frame.condition(), slack, reach })
    }

    /// Whether the leaf is all of its bounds: a box along the axes.
    pub(crate) fn fills_its_bounds(&self) -> bool {
        match self {
            Self::Sides(leaf) => leaf.is_box(),
            Self::Polyhedron(_) => false,
        }
    }

    /// The mesh, if it is one.
    pub(crate) fn polyhedron(&self) -> Option<&Polyhedron> {
        match self {
            Self::Sides(_) => None,
            Self::Polyhedron(leaf) => Some(leaf),
        }
    }

    /// The planes of the leaf.
    pub(crate) fn planes_mut(&mut self) -> &mut [Plane] {
        match self {
            Self::Sides(leaf) => leaf.planes_mut(),
            Self::Polyhedron(_) => &mut [],
        }
    }

    /// The planes and the curved wall of a leaf that is inside of all of them; the number of
    /// the first plane's face is that of the wall and one more, or zero.
    pub(crate) fn sides(&self) -> (&[Plane], Option<&Wall>) {
        match self {
            Self::Sides(leaf) => leaf.planes_and_wall(),
            Self::Polyhedron(_) => (&[], None),
        }
    }

    /// The curved wall of the leaf.
    pub(crate) fn wall_mut(&mut self) -> Option<&mut Wall> {
        match self {
            Self::Sides(leaf) => leaf.wall_mut(),
            Self::Polyhedron(_) => None,
        }
    }

    /// The surface on which a face lies, and whether the leaf is on the side where that surface's
    /// equation is positive.
    pub(crate) fn identity(&self, face: u32) -> (Identity, bool) {
        match self {
            Self::Sides(leaf) => leaf.identity(face),
            Self::Polyhedron(leaf) => (Identity::Mesh(leaf.numbers()), false),
        }
    }

    /// The ten coefficients of a face's equation at `origin + map · s`: of s₀², s₁², s₂², s₀s₁,
    /// s₁s₂, s₂s₀, s₀, s₁, s₂ and 1; none for meshes.
    pub(crate) fn form(&self, face: u32, origin: DVec3, map: DMat3) -> Option<[f64; 10]> {
        match self {
            Self::Sides(leaf) => Some(leaf.form(face, origin, map)),
            Self::Polyhedron(_) => None,
        }
    }

    /// Hands over all crossings with a line, in any order: as many in as out, infinite ones
    /// where the line starts or ends inside. Of a leaf with few faces those are taken for far
    /// away whose bits are zero.
    #[inline(always)]
    pub(crate) fn crossings(&self, faces: u32, line: &Line, sink: &mut Sink<'_>) {
        match self {
            Self::Sides(leaf) => {
                let courses = leaf.courses(line.dir.into());
                let stretches = leaf.stretches(faces, &line.into(), &courses);
                let slots = leaf.slots(faces);
                stretches[..slots].iter().for_each(|stretch| sink.stretch(stretch));
            }
            Self::Polyhedron(leaf) => leaf.crossings(line, sink),
        }
    }

    /// What kind of leaf it is, as in [`Primitive::name`].
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Sides(leaf) => leaf.kind(),
            Self::Polyhedron(_) => "mesh",
        }
    }

    /// The leaf's methods.
    pub(crate) fn surface(&self) -> &dyn Surface {
        match self {
            Self::Sides(leaf) => leaf,
            Self::Polyhedron(leaf) => &**leaf,
        }
    }

    /// How much memory it takes beside its own size and meshes.
    #[cfg(test)]
    pub(crate) fn bytes(&self) -> usize {
        match self {
            Self::Sides(leaf) => leaf.bytes(),
            Self::Polyhedron(leaf) => size_of_val(&**leaf),
        }
    }
}

/// A surface by its numbers: faces of two leaves lie on one surface where these are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Identity {
    Plane([f64; 4]),
    Wall([f64; 15]),
    /// All faces of a mesh, by its address and its place.
    Mesh((usize, [f64; 12])),
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
    /// The line is inside on a stretch; nothing if that is empty.
    #[inline(always)]
    fn stretch(&mut self, stretch: &Stretch<f64>) {
        if stretch.enter < stretch.exit {
            self.crossing(stretch.enter, face_of(stretch.enter_face), Sense::Enter);
            self.crossing(stretch.exit, face_of(stretch.exit_face), Sense::Exit);
        }
    }

    fn crossing(&mut self, t: f64, face: u32, sense: Sense) {
        self.events.push(Event { t, leaf: self.leaf, face, sense });
    }
}

/// The number of a face, or of an end, that was kept among the numbers of a stretch.
pub(crate) fn face_of(number: f64) -> u32 {
    u32::try_from(whole(number)).expect("faces and ends are counted in 32 bits")
}

/// All faces of a leaf that has no more than there are bits.
pub(crate) const ALL: u32 = u32::MAX;
