//! Leaves as formulas that know nothing of the kernel, and what tests need to know of each.
//!
//! What stands here of a leaf is all that tests of its kind need: it is drawn by lot, aimed at, asked
//! point by point, crossed in numbers of 200 bits, and meshed. A leaf of a new kind is a variant of
//! [`Leaf`], the arms that the compiler asks for, and a line in [`bounded`] and in [`of_lengths`], for
//! which nobody asks. It changes what all tests draw after it.

use std::f64::consts::PI;
use std::ops::{Div, Mul, Sub};
use std::sync::Arc;

use glam::{DVec3, dvec3};
use proptest::prelude::*;
use solidray::{Mesh, Solid};

use super::dice::Dice;
use super::meshes;
use super::strategies::{length, place};

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
    Prism { sides: u32, radii: [f64; 2], height: f64 },
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

/// Points nearer to a surface than this, as a fraction of the coordinates and sizes at
/// hand, which are of order 1, get no answer. Six orders above the rounding of well-conditioned maps, and far
/// below what the tests are about.
const NEAR: f64 = 1e-9;

/// What a leaf's equations are written in.
pub(crate) trait Number:
    Clone + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    fn of(x: f64) -> Self;
}

impl Number for f64 {
    fn of(x: f64) -> Self {
        x
    }
}

/// A leaf of any kind that is bounded.
pub(crate) fn bounded() -> impl Strategy<Value = Leaf> {
    prop_oneof![
        3 => (place(), [length(), length(), length()]).prop_map(|(min, size)| {
            Leaf::Cuboid { min, max: min + DVec3::from_array(size) }
        }),
        2 => length().prop_map(|radius| Leaf::Ball { radius }),
        1 => (length(), length())
            .prop_map(|(radius, height)| Leaf::Cylinder { radius, height }),
        2 => (prop_oneof![Just(0.0), length()], length(), length(), any::<bool>()).prop_map(
            |(a, b, height, turned)| {
                let (bottom, top) = if turned { (b, a) } else { (a, b) };
                Leaf::Frustum { bottom, top, height }
            }
        ),
        1 => (length(), length())
            .prop_map(|(radius, height)| Leaf::Paraboloid { radius, height }),
        1 => (length(), 0.0..2.0_f64, length()).prop_map(|(waist, more, height)| {
            Leaf::OneSheet { waist, radius: waist + more, height }
        }),
        1 => (0.2..1.0_f64, 0.3..2.0_f64, length()).prop_map(|(vertex, slope, more)| {
            Leaf::TwoSheets { vertex, slope, height: 2.0 * (vertex + more) }
        }),
        2 => (3..=8_u32, [length(), length()], length(), 0..4_u32).prop_map(
            |(sides, [a, b], height, kind)| {
                let radii = [[a, a], [a, b], [a, 0.0], [0.0, a]][kind as usize];
                Leaf::Prism { sides, radii, height }
            }
        ),
        2 => mesh(),
    ]
}

fn mesh() -> impl Strategy<Value = Leaf> {
    let all: Vec<Leaf> = [
        meshes::tetrahedron(),
        meshes::octahedron(),
        meshes::prism(5),
        meshes::icosphere(1),
        meshes::jittered(&meshes::icosphere(1), 0.2, 7),
        meshes::grid_box(-DVec3::ONE, DVec3::ONE, 2),
    ]
    .into_iter()
    .map(|mesh| Leaf::Mesh(Shared(Arc::new(mesh))))
    .collect();
    prop::sample::select(all)
}

/// A leaf of any kind that is bounded and has equations, from three lengths.
pub(crate) fn of_lengths(dice: &mut Dice, [a, b, c]: [f64; 3]) -> Leaf {
    let all = [
        Leaf::Cuboid { min: -dvec3(a, b, c), max: dvec3(c, a, b) },
        Leaf::Ball { radius: a },
        Leaf::Cylinder { radius: a, height: b },
        Leaf::Frustum { bottom: a, top: b, height: c },
        Leaf::Frustum { bottom: a, top: 0.0, height: b },
        Leaf::Paraboloid { radius: a, height: b },
        Leaf::OneSheet { waist: a, radius: a + b, height: c },
        Leaf::TwoSheets { vertex: a, slope: b / c, height: 2.0 * (a + b) },
        Leaf::Prism { sides: 6, radii: [a, a], height: b },
        Leaf::Prism { sides: 5, radii: [a, b], height: c },
    ];
    all[dice.below(all.len())].clone()
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
            Self::Prism { sides, radii, height } => {
                Solid::prism_between(*sides, *radii, [0.0, *height])
            }
            Self::HalfSpace { normal, offset } => Solid::half_space(*normal, *offset),
            Self::Mesh(mesh) => Solid::mesh(mesh.0.clone()),
        }
    }

    /// The planes that it is on the inner side of, in the order of its faces: `normal · p ≤ offset`.
    /// Those of a prism are rounded.
    pub(crate) fn planes(&self) -> Vec<(DVec3, f64)> {
        match *self {
            Self::Cuboid { min, max } => DVec3::AXES
                .into_iter()
                .flat_map(|axis| [(-axis, -axis.dot(min)), (axis, axis.dot(max))])
                .collect(),
            Self::HalfSpace { normal, offset } => vec![(normal, offset)],
            Self::Prism { sides, radii: [a, b], height } => {
                let half = PI / f64::from(sides);
                let side = |i: u32| {
                    let (sine, cosine) = (half * f64::from(2 * i + 1)).sin_cos();
                    let apothem = a * half.cos();
                    (dvec3(cosine, sine, (apothem - b * half.cos()) / height), apothem)
                };
                let caps = between(0.0, height).into_iter().zip([a, b]);
                let caps = caps.filter(|&(_, radius)| radius > 0.0).map(|(cap, _)| cap);
                caps.chain((0..sides).map(side)).collect()
            }
            Self::Cylinder { height, .. }
            | Self::Frustum { height, .. }
            | Self::Paraboloid { height, .. } => between(0.0, height),
            Self::OneSheet { height, .. } | Self::TwoSheets { height, .. } => {
                between(-0.5 * height, 0.5 * height)
            }
            Self::Ball { .. } | Self::Mesh(_) => Vec::new(),
        }
    }

    /// The quadric that it is inside of, if there is one: a, b and c of `x² + y² ≤ a z² + 2 b z + c`.
    pub(crate) fn wall<N: Number>(&self) -> Option<[N; 3]> {
        let of = N::of;
        let square = |x: N| x.clone() * x;
        match *self {
            Self::Ball { radius } => Some([of(-1.0), of(0.0), square(of(radius))]),
            Self::Cylinder { radius, .. } => Some([of(0.0), of(0.0), square(of(radius))]),
            Self::Frustum { bottom, top, height } => {
                let slope = (of(top) - of(bottom)) / of(height);
                let middle = of(bottom) * slope.clone();
                Some([square(slope), middle, square(of(bottom))])
            }
            Self::Paraboloid { radius, height } => {
                let growth = square(of(radius)) / (of(2.0) * of(height));
                Some([of(0.0), growth, of(0.0)])
            }
            Self::OneSheet { waist, radius, height } => {
                let more = square(of(radius)) - square(of(waist));
                let growth = more / square(of(0.5 * height));
                Some([growth, of(0.0), square(of(waist))])
            }
            Self::TwoSheets { vertex, slope, .. } => {
                let least = square(of(slope)) * square(of(vertex));
                Some([square(of(slope)), of(0.0), of(0.0) - least])
            }
            Self::Cuboid { .. }
            | Self::Prism { .. }
            | Self::HalfSpace { .. }
            | Self::Mesh(_) => None,
        }
    }

    /// No point is farther than this from the leaf's own origin, nor by orders nearer are all.
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
            Self::Prism { radii: [a, b], height, .. } => a.max(b) + height,
            Self::HalfSpace { normal, offset } => (offset / normal.length()).abs(),
            Self::Mesh(ref mesh) => mesh.0.bounds().size().max_element(),
        }
    }

    /// Whether a point is inside; nothing if it is too near to a surface that matters.
    pub(crate) fn holds(&self, p: DVec3) -> Option<bool> {
        if let Self::Mesh(mesh) = self {
            return mesh_holds(&mesh.0, p);
        }
        // How far outside it is, as a length: the largest of what all faces say.
        let across = p.truncate().length();
        let of_wall = self.wall::<f64>().map(|wall| {
            (across * across - square_of_radius(wall, p.z)) / (across + self.size())
        });
        let of_plane =
            |(normal, offset): (DVec3, f64)| (normal.dot(p) - offset) / normal.length();
        let faces = self.planes().into_iter().map(of_plane).chain(of_wall);
        let excess = faces.fold(f64::NEG_INFINITY, f64::max);
        let near = NEAR * (1.0 + self.size() + p.length());
        if excess.abs() <= near { None } else { Some(excess < 0.0) }
    }

    /// Corners, apexes, middles of edges and faces, points of walls and rims.
    pub(crate) fn features(&self) -> Vec<DVec3> {
        match self {
            Self::Cuboid { min, max } => grid(*min, *max),
            Self::Ball { radius } => DVec3::AXES
                .into_iter()
                .flat_map(|a| [a * *radius, -a * *radius])
                .collect(),
            Self::Prism { sides, radii, height } => {
                let corner = |radius: f64, z: f64, i: u32| {
                    let angle = 2.0 * PI * f64::from(i) / f64::from(*sides);
                    let (sine, cosine) = angle.sin_cos();
                    dvec3(radius * cosine, radius * sine, z)
                };
                let of_side = |i: u32| {
                    let low = [i, i + 1].map(|i| corner(radii[0], 0.0, i));
                    let high = [i, i + 1].map(|i| corner(radii[1], *height, i));
                    let middle = |[a, b]: [DVec3; 2]| 0.5 * (a + b);
                    let edges = [low, high, [low[0], high[0]]].map(middle);
                    let face = middle([edges[0], edges[1]]);
                    [low[0], high[0], edges[0], edges[1], edges[2], face]
                };
                let axis = [0.0, 0.5, 1.0].map(|part| part * height * DVec3::Z);
                (0..*sides).flat_map(of_side).chain(axis).collect()
            }
            Self::HalfSpace { normal, offset } => {
                vec![*normal * (*offset / normal.length_squared())]
            }
            Self::Mesh(mesh) => features_of_mesh(&mesh.0),
            Self::Cylinder { .. }
            | Self::Frustum { .. }
            | Self::Paraboloid { .. }
            | Self::OneSheet { .. }
            | Self::TwoSheets { .. } => {
                let (Some(wall), [(_, below), (_, top)]) =
                    (self.wall(), &self.planes()[..])
                else {
                    return Vec::new();
                };
                let (bottom, top) = (-below, *top);
                let rim = |z: f64| {
                    let radius = square_of_radius(wall, z).max(0.0).sqrt();
                    [dvec3(0.0, 0.0, z), dvec3(radius, 0.0, z), dvec3(0.0, -radius, z)]
                };
                [bottom, 0.5 * (bottom + top), top].into_iter().flat_map(rim).collect()
            }
        }
    }
}

/// The planes at two heights.
fn between(bottom: f64, top: f64) -> Vec<(DVec3, f64)> {
    vec![(-DVec3::Z, -bottom), (DVec3::Z, top)]
}

fn square_of_radius([a, b, c]: [f64; 3], z: f64) -> f64 {
    (a * z + 2.0 * b) * z + c
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
    let windings = angle / (4.0 * PI);
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
