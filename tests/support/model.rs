//! Trees of which every point can be asked directly, without rays.
//!
//! A [`Model`] is both a [`Solid`] for the kernel and a formula: the point is taken into
//! each leaf's frame by one inverse map after the other, the leaf's inequality is looked at
//! there, and the operators combine the answers. It shares no code with the kernel.

use std::sync::Arc;

use glam::{DAffine3, DVec3, dvec3};
use solidray::{Mesh, Op, Ray, Solid};

/// A solid that can be asked without rays.
#[derive(Clone, Debug)]
pub(crate) enum Model {
    Leaf(Leaf),
    Boolean(Op, Vec<Self>),
    Mapped(DAffine3, Box<Self>),
}

/// A leaf by its sizes, as the makers of [`Solid`] take them.
#[derive(Clone, Debug)]
pub(crate) enum Leaf {
    Cuboid { min: DVec3, max: DVec3 },
    Ball { radius: f64 },
    Cylinder { radius: f64, height: f64 },
    Frustum { bottom: f64, top: f64, height: f64 },
    Paraboloid { radius: f64, height: f64 },
    OneSheet { waist: f64, radius: f64, height: f64 },
    TwoSheets { vertex: f64, slope: f64, height: f64 },
    HalfSpace { normal: DVec3, offset: f64 },
    Mesh(Shared),
}

/// A mesh that does not print all its points.
#[derive(Clone)]
pub(crate) struct Shared(pub(crate) Arc<Mesh>);

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} faces in {:?}", self.0.faces().len(), self.0.bounds())
    }
}

/// A place worth aiming at, and the directions of the leaf's axes there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Feature {
    pub(crate) point: DVec3,
    pub(crate) axes: [DVec3; 3],
}

/// Points nearer to a surface than this, as a fraction of the coordinates and sizes at
/// hand, which are of order 1, get no answer. Six orders above the rounding of well-conditioned maps, and far
/// below what the tests are about.
const NEAR: f64 = 1e-9;

impl Model {
    pub(crate) fn boolean(op: Op, children: impl IntoIterator<Item = Self>) -> Self {
        Self::Boolean(op, children.into_iter().collect())
    }

    pub(crate) fn mapped(self, map: DAffine3) -> Self {
        Self::Mapped(map, Box::new(self))
    }

    /// The same for the kernel.
    pub(crate) fn solid(&self) -> Solid {
        match self {
            Self::Leaf(leaf) => leaf.solid(),
            Self::Boolean(op, children) => {
                Solid::boolean(*op, children.iter().map(Self::solid))
            }
            Self::Mapped(map, child) => child.solid().mapped(*map),
        }
    }

    /// Whether a point is inside; nothing if it is too near to a surface that matters.
    pub(crate) fn holds(&self, point: DVec3) -> Option<bool> {
        match self {
            Self::Leaf(leaf) => leaf.holds(point),
            Self::Mapped(map, child) => {
                child.holds(map.inverse().transform_point3(point))
            }
            Self::Boolean(_, children) if children.is_empty() => Some(false),
            Self::Boolean(op, children) => {
                let mut answers = children.iter().map(|child| child.holds(point));
                match op {
                    Op::Union => not(all(answers.map(not))),
                    Op::Intersection => all(answers),
                    Op::Difference => {
                        let first = answers.next().flatten();
                        all(std::iter::once(first).chain(answers.map(not)))
                    }
                }
            }
        }
    }

    /// The leaves with their maps.
    pub(crate) fn leaves(&self) -> Vec<(&Leaf, DAffine3)> {
        match self {
            Self::Leaf(leaf) => vec![(leaf, DAffine3::IDENTITY)],
            Self::Boolean(_, children) => {
                children.iter().flat_map(Self::leaves).collect()
            }
            Self::Mapped(map, child) => {
                child.leaves().into_iter().map(|(leaf, m)| (leaf, *map * m)).collect()
            }
        }
    }

    /// What rays should be aimed at.
    pub(crate) fn features(&self) -> Vec<Feature> {
        let of_leaf = |(leaf, map): (&Leaf, DAffine3)| {
            let axes = DVec3::AXES.map(|axis| map.transform_vector3(axis));
            let place = move |p| Feature { point: map.transform_point3(p), axes };
            leaf.features().into_iter().map(place).collect::<Vec<_>>()
        };
        self.leaves().into_iter().flat_map(of_leaf).collect()
    }
}

/// True if all are, whatever the open ones turn out to be; false if one is.
fn all(answers: impl Iterator<Item = Option<bool>>) -> Option<bool> {
    let mut sum = Some(true);
    for answer in answers {
        match answer {
            Some(false) => return Some(false),
            Some(true) => {}
            None => sum = None,
        }
    }
    sum
}

fn not(answer: Option<bool>) -> Option<bool> {
    answer.map(|value| !value)
}

impl Leaf {
    /// The same for the kernel.
    pub(crate) fn solid(&self) -> Solid {
        match self {
            Self::Cuboid { min, max } => Solid::cuboid_between(*min, *max),
            Self::Ball { radius } => Solid::ball(*radius),
            Self::Cylinder { radius, height } => Solid::cylinder(*radius, *height),
            Self::Frustum { bottom, top, height } => {
                Solid::frustum(*bottom, *top, *height)
            }
            Self::Paraboloid { radius, height } => Solid::paraboloid(*radius, *height),
            Self::OneSheet { waist, radius, height } => {
                Solid::hyperboloid_of_one_sheet(*waist, *radius, *height)
            }
            Self::TwoSheets { vertex, slope, height } => {
                Solid::hyperboloid_of_two_sheets(*vertex, *slope, *height)
            }
            Self::HalfSpace { normal, offset } => Solid::half_space(*normal, *offset),
            Self::Mesh(mesh) => Solid::mesh(mesh.0.clone()),
        }
    }

    fn holds(&self, p: DVec3) -> Option<bool> {
        let excess = match self {
            Self::Mesh(mesh) => return mesh_holds(&mesh.0, p),
            Self::HalfSpace { normal, offset } => {
                (normal.dot(p) - offset) / normal.length()
            }
            Self::Cuboid { min, max } => (*min - p).max(p - *max).max_element(),
            Self::Ball { .. }
            | Self::Cylinder { .. }
            | Self::Frustum { .. }
            | Self::Paraboloid { .. }
            | Self::OneSheet { .. }
            | Self::TwoSheets { .. } => self.excess_of_revolved(p),
        };
        let near = NEAR * (1.0 + self.size() + p.length());
        if excess.abs() <= near { None } else { Some(excess < 0.0) }
    }

    /// How far outside a point is, as a length: the larger of what the wall and the two
    /// ends say.
    fn excess_of_revolved(&self, p: DVec3) -> f64 {
        let [bottom, top] = self.ends();
        let across = p.truncate().length();
        let wall =
            (across * across - self.square_of_radius(p.z)) / (across + self.size());
        wall.max(bottom - p.z).max(p.z - top)
    }

    fn square_of_radius(&self, z: f64) -> f64 {
        match *self {
            Self::Ball { radius } => radius * radius - z * z,
            Self::Cylinder { radius, .. } => radius * radius,
            Self::Frustum { bottom, top, height } => {
                (bottom + (top - bottom) * z / height).powi(2)
            }
            Self::Paraboloid { radius, height } => radius * radius * z / height,
            Self::OneSheet { waist, radius, height } => {
                let growth = (radius * radius - waist * waist) / (0.5 * height).powi(2);
                waist * waist + growth * z * z
            }
            Self::TwoSheets { vertex, slope, .. } => {
                slope * slope * (z * z - vertex * vertex)
            }
            Self::Cuboid { .. } | Self::HalfSpace { .. } | Self::Mesh(_) => {
                unreachable!("only solids of revolution have a radius")
            }
        }
    }

    /// The heights at which the leaf ends.
    fn ends(&self) -> [f64; 2] {
        match *self {
            Self::Ball { radius } => [-radius, radius],
            Self::Cylinder { height, .. }
            | Self::Frustum { height, .. }
            | Self::Paraboloid { height, .. } => [0.0, height],
            Self::OneSheet { height, .. } | Self::TwoSheets { height, .. } => {
                [-0.5 * height, 0.5 * height]
            }
            Self::Cuboid { .. } | Self::HalfSpace { .. } | Self::Mesh(_) => {
                unreachable!("only solids of revolution have an axis")
            }
        }
    }

    /// A length of the leaf's own order.
    pub(crate) fn size(&self) -> f64 {
        match *self {
            Self::Cuboid { min, max } => min.length().max(max.length()),
            Self::Ball { radius } => radius,
            Self::Cylinder { radius, height } | Self::Paraboloid { radius, height } => {
                radius + height
            }
            Self::Frustum { bottom, top, height } => bottom + top + height,
            Self::OneSheet { radius, height, .. } => radius + height,
            Self::TwoSheets { vertex, slope, height } => vertex + (1.0 + slope) * height,
            Self::HalfSpace { normal, offset } => (offset / normal.length()).abs(),
            Self::Mesh(ref mesh) => mesh.0.bounds().size().max_element(),
        }
    }

    /// Corners, apexes, middles of edges and faces, points of walls and rims.
    fn features(&self) -> Vec<DVec3> {
        match self {
            Self::Cuboid { min, max } => grid(*min, *max),
            Self::Ball { radius } => DVec3::AXES
                .into_iter()
                .flat_map(|a| [a * *radius, -a * *radius])
                .collect(),
            Self::HalfSpace { normal, offset } => {
                vec![*normal * (*offset / normal.length_squared())]
            }
            Self::Mesh(mesh) => features_of_mesh(&mesh.0),
            Self::Cylinder { .. }
            | Self::Frustum { .. }
            | Self::Paraboloid { .. }
            | Self::OneSheet { .. }
            | Self::TwoSheets { .. } => {
                let [bottom, top] = self.ends();
                let rim = |z: f64| {
                    let radius = self.square_of_radius(z).max(0.0).sqrt();
                    [dvec3(0.0, 0.0, z), dvec3(radius, 0.0, z), dvec3(0.0, -radius, z)]
                };
                [bottom, 0.5 * (bottom + top), top].into_iter().flat_map(rim).collect()
            }
        }
    }
}

/// Corners of a box, middles of its edges and faces, and its middle.
fn grid(min: DVec3, max: DVec3) -> Vec<DVec3> {
    let pick = |i: usize, axis: usize| {
        let step = i / 3_usize.pow(u32::try_from(axis).expect("0, 1 or 2")) % 3;
        min[axis] + 0.5 * step as f64 * (max[axis] - min[axis])
    };
    (0..27).map(|i| dvec3(pick(i, 0), pick(i, 1), pick(i, 2))).collect()
}

/// Corners, middles of edges and middles of faces of at most a dozen faces.
fn features_of_mesh(mesh: &Mesh) -> Vec<DVec3> {
    let step = mesh.faces().len().div_ceil(12);
    let of_face = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|i| mesh.points()[i as usize]);
        [a, 0.5 * (a + b), 0.5 * (b + c), (a + b + c) / 3.0]
    };
    mesh.faces().iter().step_by(step).flat_map(of_face).collect()
}

/// Whether the mesh winds around a point: by the sum of the solid angles of its faces
/// (A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", IEEE Transactions
/// on Biomedical Engineering, 1983).
fn mesh_holds(mesh: &Mesh, p: DVec3) -> Option<bool> {
    let near = NEAR * (mesh.bounds().size().max_element() + p.length());
    let mut angle = 0.0;
    for face in mesh.faces() {
        let corners = face.map(|i| mesh.points()[i as usize] - p);
        if is_near(corners, near) {
            return None;
        }
        let [a, b, c] = corners;
        let [la, lb, lc] = corners.map(DVec3::length);
        let across = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        angle += 2.0 * a.dot(b.cross(c)).atan2(across);
    }
    let windings = angle / (4.0 * std::f64::consts::PI);
    assert!((windings - windings.round()).abs() < 1e-3, "{windings} times around {p}");
    Some(windings > 0.5)
}

/// Whether the origin may be within `near` of a triangle.
fn is_near([a, b, c]: [DVec3; 3], near: f64) -> bool {
    let (low, high) = (a.min(b).min(c) - near, a.max(b).max(c) + near);
    let normal = (b - a).cross(c - a);
    low.max_element() <= 0.0
        && high.min_element() >= 0.0
        && normal.dot(a).abs() <= near * normal.length()
}

/// Where a ray passes through the surfaces of all leaves, in order: each leaf asked alone,
/// half-spaces by their formula.
pub(crate) fn crossings_of_leaves(model: &Model, ray: &Ray) -> Vec<f64> {
    let mut all: Vec<f64> = model
        .leaves()
        .into_iter()
        .flat_map(|(leaf, map)| alone(leaf, map, ray))
        .collect();
    all.sort_by(f64::total_cmp);
    all
}

fn alone(leaf: &Leaf, map: DAffine3, ray: &Ray) -> Vec<f64> {
    if let Leaf::HalfSpace { normal, offset } = leaf {
        let back = map.inverse();
        let (o, d) = (back.transform_point3(ray.origin), back.transform_vector3(ray.dir));
        let t = (offset - normal.dot(o)) / normal.dot(d);
        return if t.is_finite() { vec![t] } else { Vec::new() };
    }
    super::ends(&leaf.solid().mapped(map), ray).into_iter().flatten().collect()
}
