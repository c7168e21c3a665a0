//! What you say: an immutable tree of primitives, meshes, maps and Boolean operators.

use std::collections::HashMap;
use std::fmt;
use std::ops::{Add, BitAnd, Sub};
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use crate::color::Color;
use crate::mesh::Mesh;
use crate::op::Op;
use crate::primitive::{Cuboid, HalfSpace, Primitive, Prism, Profile, Quadric};

/// A solid: cheap to clone, never changed.
///
/// Lengths are model units (millimetres by OpenSCAD's custom), angles radians. Sizes are
/// checked by [`Scene::compile`](crate::Scene::compile), which names the leaf at fault.
///
/// ```
/// use glam::dvec3;
/// use solidray::Solid;
///
/// let plate = Solid::cuboid(dvec3(40.0, 20.0, 4.0));
/// let hole = Solid::cylinder(3.0, 10.0).translated(dvec3(0.0, 0.0, -5.0));
/// let washer = plate - hole;
/// # let _ = washer;
/// ```
#[derive(Clone)]
pub struct Solid(Arc<Node>);

pub(crate) struct Node {
    pub(crate) kind: Kind,
    pub(crate) children: Vec<Solid>,
}

/// What a node does with its children; leaves have none, maps and tags have one.
#[derive(Debug)]
pub(crate) enum Kind {
    Primitive(Primitive),
    Mesh(Arc<Mesh>),
    Boolean(Op),
    Mapped(Box<DAffine3>),
    Tagged(Tag),
}

/// Something said about a subtree that does not change its shape.
#[derive(Clone, Debug)]
pub(crate) enum Tag {
    Name(Arc<str>),
    Color(Color),
    Place(Place),
    /// One body to the eye: what is subtracted within it leaves walls of its own.
    Outline,
}

/// Where in a file something stands, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The line.
    pub line: u32,
    /// The column, in characters.
    pub column: u32,
}

/// One node of a tree, for those who walk it: to count, to export, to check.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum View<'a> {
    /// A leaf given by a formula.
    Primitive(&'a Primitive),
    /// A leaf given by a mesh.
    Mesh(&'a Arc<Mesh>),
    /// An operator and its operands.
    Boolean(Op, &'a [Solid]),
    /// A map from the child's frame to the parent's, and the child.
    Mapped(&'a DAffine3, &'a Solid),
    /// A name, a colour or a place, which changes no shape, and what it is given to.
    Tagged(&'a Solid),
}

impl Solid {
    /// The topmost node. Trees can be deep: walk them with a list of what is left.
    pub fn view(&self) -> View<'_> {
        let Node { kind, children } = self.node();
        match kind {
            Kind::Primitive(primitive) => View::Primitive(primitive),
            Kind::Mesh(mesh) => View::Mesh(mesh),
            Kind::Boolean(op) => View::Boolean(*op, children),
            Kind::Mapped(map) => View::Mapped(map, &children[0]),
            Kind::Tagged(_) => View::Tagged(&children[0]),
        }
    }
}

/// # Leaves
impl Solid {
    /// The ball of points no farther than `radius` from the origin.
    pub fn ball(radius: f64) -> Self {
        Self::revolved(Profile::Ball { radius }, -radius, radius)
    }

    /// The box of this size around the origin.
    pub fn cuboid(size: DVec3) -> Self {
        Self::cuboid_between(-0.5 * size, 0.5 * size)
    }

    /// The box with these two corners.
    pub fn cuboid_between(min: DVec3, max: DVec3) -> Self {
        Self::primitive(Primitive::Cuboid(Cuboid { min, max }))
    }

    /// The cylinder about the z-axis from z = 0 to `height`.
    pub fn cylinder(radius: f64, height: f64) -> Self {
        Self::revolved(Profile::Cylinder { radius }, 0.0, height)
    }

    /// The frustum of a cone about the z-axis from z = 0 to `height`. One radius may be
    /// zero, which makes a cone.
    pub fn frustum(bottom_radius: f64, top_radius: f64, height: f64) -> Self {
        Self::frustum_between(bottom_radius, top_radius, 0.0, height)
    }

    /// The frustum of a cone about the z-axis between two heights.
    pub fn frustum_between(
        bottom_radius: f64,
        top_radius: f64,
        bottom: f64,
        top: f64,
    ) -> Self {
        #[expect(clippy::float_cmp, reason = "equal radii make a cylinder, not a cone")]
        if bottom_radius == top_radius {
            return Self::revolved(
                Profile::Cylinder { radius: bottom_radius },
                bottom,
                top,
            );
        }
        // The frame's origin is the centre of the smaller end, so that the radius is a sum
        // of terms of one sign wherever the cone is, and an apex is at the origin exactly.
        let (height, step) = (top - bottom, top_radius - bottom_radius);
        let (radius, from) =
            if step > 0.0 { (bottom_radius, bottom) } else { (top_radius, top) };
        let profile = Profile::Cone { radius, slope: step / height };
        let (low, high) = if step > 0.0 { (0.0, height) } else { (-height, 0.0) };
        Self::revolved(profile, low, high).translated(DVec3::new(0.0, 0.0, from))
    }

    /// The paraboloid `x² + y² ≤ radius² z / height` up to z = `height`, where its radius
    /// is `radius`; its vertex is the origin.
    pub fn paraboloid(radius: f64, height: f64) -> Self {
        let scale = radius * radius / height;
        Self::revolved(Profile::Paraboloid { scale }, 0.0, height)
    }

    /// The solid inside a hyperboloid of one sheet, from z = −`height`/2 to `height`/2,
    /// with radius `waist` at z = 0 and `radius` at both ends.
    pub fn hyperboloid_of_one_sheet(waist: f64, radius: f64, height: f64) -> Self {
        let end = 0.5 * height;
        let slope = ((radius - waist) * (radius + waist)).sqrt() / end;
        Self::revolved(Profile::OneSheet { waist, slope }, -end, end)
    }

    /// The two solids inside a hyperboloid of two sheets,
    /// `x² + y² ≤ slope² (z² − vertex²)`, from z = −`height`/2 to `height`/2.
    pub fn hyperboloid_of_two_sheets(vertex: f64, slope: f64, height: f64) -> Self {
        let end = 0.5 * height;
        Self::revolved(Profile::TwoSheets { vertex, slope }, -end, end)
    }

    /// The regular prism about the z-axis from z = 0 to `height`, with corners on a circle of this
    /// radius, the first on +x.
    pub fn prism(sides: u32, radius: f64, height: f64) -> Self {
        Self::prism_between(sides, [radius; 2], [0.0, height])
    }

    /// What is between two regular polygons about the z-axis, from bottom to top, with corners on
    /// circles of these radii, the first on +x. One radius may be zero, which makes a pyramid.
    pub fn prism_between(sides: u32, radii: [f64; 2], ends: [f64; 2]) -> Self {
        Self::primitive(Primitive::Prism(Prism { sides, radii, ends }))
    }

    /// The half-space of points with `normal · p ≤ offset`. It has no bounds, so it is of
    /// use inside an intersection or as what is subtracted.
    pub fn half_space(normal: DVec3, offset: f64) -> Self {
        Self::primitive(Primitive::HalfSpace(HalfSpace { normal, offset }))
    }

    /// The solid inside a mesh.
    pub fn mesh(mesh: impl Into<Arc<Mesh>>) -> Self {
        Self::new(Kind::Mesh(mesh.into()), Vec::new())
    }

    /// The solid without points.
    pub fn empty() -> Self {
        Self::boolean(Op::Union, [])
    }

    /// A primitive, in its own frame.
    pub fn primitive(primitive: Primitive) -> Self {
        Self::new(Kind::Primitive(primitive), Vec::new())
    }

    fn revolved(profile: Profile, bottom: f64, top: f64) -> Self {
        Self::primitive(Primitive::Quadric(Quadric { profile, bottom, top }))
    }
}

impl Solid {
    /// How many nodes the tree has when every shared subtree is written out as often as it
    /// occurs; `u64::MAX` for that many or more.
    pub(crate) fn size(&self) -> u64 {
        let mut known: HashMap<*const Node, u64> = HashMap::new();
        // Nodes on the way down, each with the children yet to visit and the sum so far.
        let mut open = vec![(self, self.node().children.iter(), 1_u64)];
        loop {
            let Some((solid, rest, sum)) = open.last_mut() else { return 0 };
            if let Some(child) = rest.next() {
                match known.get(&Arc::as_ptr(&child.0)) {
                    Some(size) => *sum = sum.saturating_add(*size),
                    None => open.push((child, child.node().children.iter(), 1)),
                }
                continue;
            }
            let (solid, size) = (*solid, *sum);
            open.pop();
            if Arc::strong_count(&solid.0) > 1 {
                known.insert(Arc::as_ptr(&solid.0), size);
            }
            match open.last_mut() {
                Some((_, _, sum)) => *sum = sum.saturating_add(size),
                None => return size,
            }
        }
    }
}

/// # Combinations, maps and tags
impl Solid {
    /// The children combined by an operator; `a + b`, `a - b` and `a & b` are short for
    /// two of them.
    pub fn boolean(op: Op, children: impl IntoIterator<Item = Self>) -> Self {
        Self::new(Kind::Boolean(op), children.into_iter().collect())
    }

    /// The image under an affine map, mirrored and sheared ones included. A singular map
    /// is an error when the solid is compiled.
    #[must_use]
    pub fn mapped(self, parent_from_child: DAffine3) -> Self {
        Self::new(Kind::Mapped(Box::new(parent_from_child)), vec![self])
    }

    /// Moved by `offset`.
    #[must_use]
    pub fn translated(self, offset: DVec3) -> Self {
        self.mapped(DAffine3::from_translation(offset))
    }

    /// Turned about an axis through the origin, counter-clockwise seen from its tip.
    #[must_use]
    pub fn rotated(self, axis: DVec3, radians: f64) -> Self {
        self.mapped(DAffine3::from_axis_angle(axis.normalize_or(DVec3::Z), radians))
    }

    /// Scaled along the axes; negative factors mirror.
    #[must_use]
    pub fn scaled(self, factors: DVec3) -> Self {
        self.mapped(DAffine3::from_scale(factors))
    }

    /// Mirrored in the plane through the origin with this normal.
    #[must_use]
    pub fn mirrored(self, normal: DVec3) -> Self {
        let n = normal.normalize_or(DVec3::X);
        let column = |axis: DVec3| axis - 2.0 * axis.dot(n) * n;
        let linear =
            glam::DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
        self.mapped(DAffine3::from_mat3(linear))
    }

    /// With a name that reports use; of nested names the innermost holds.
    #[must_use]
    pub fn named(self, name: impl Into<Arc<str>>) -> Self {
        self.tagged(Tag::Name(name.into()))
    }

    /// With a colour; of nested colours the outermost holds, as in OpenSCAD.
    #[must_use]
    pub fn colored(self, color: Color) -> Self {
        self.tagged(Tag::Color(color))
    }

    /// With a place in a file that errors and reports name; of nested places the
    /// innermost holds.
    #[must_use]
    pub fn placed(self, place: Place) -> Self {
        self.tagged(Tag::Place(place))
    }

    /// With all its walls counted as its own in [`Leaf::subtracted`](crate::Leaf), those of
    /// operands that are subtracted within it too: as if it were one leaf.
    #[must_use]
    pub fn as_outline(self) -> Self {
        self.tagged(Tag::Outline)
    }

    pub(crate) fn tagged(self, tag: Tag) -> Self {
        Self::new(Kind::Tagged(tag), vec![self])
    }

    fn new(kind: Kind, children: Vec<Self>) -> Self {
        Self(Arc::new(Node { kind, children }))
    }

    pub(crate) fn node(&self) -> &Node {
        &self.0
    }

    pub(crate) fn kind(&self) -> &Kind {
        &self.0.kind
    }

    pub(crate) fn children(&self) -> &[Self] {
        &self.0.children
    }

    /// A number that tells it from other nodes as long as it lives.
    pub(crate) fn address(&self) -> usize {
        Arc::as_ptr(&self.0).addr()
    }
}

impl Add for Solid {
    type Output = Self;

    /// The union.
    fn add(self, other: Self) -> Self {
        Self::boolean(Op::Union, [self, other])
    }
}

impl Sub for Solid {
    type Output = Self;

    /// The difference.
    fn sub(self, other: Self) -> Self {
        Self::boolean(Op::Difference, [self, other])
    }
}

impl BitAnd for Solid {
    type Output = Self;

    /// The intersection.
    fn bitand(self, other: Self) -> Self {
        Self::boolean(Op::Intersection, [self, other])
    }
}

/// Says what the topmost node is; trees can be too deep and too wide to print.
impl fmt::Debug for Solid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Node { kind, children } = self.node();
        write!(f, "Solid({kind:?}, {} children)", children.len())
    }
}

/// Trees can be deep: they are taken apart with a list of what is left, not by recursion.
impl Drop for Solid {
    fn drop(&mut self) {
        let mut rest = take_children(self);
        while let Some(mut solid) = rest.pop() {
            rest.append(&mut take_children(&mut solid));
        }
    }
}

/// The children of a node that nobody else holds.
fn take_children(solid: &mut Solid) -> Vec<Solid> {
    Arc::get_mut(&mut solid.0)
        .map(|node| std::mem::take(&mut node.children))
        .unwrap_or_default()
}
