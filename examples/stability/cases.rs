//! What is made extreme, for which solids, and by which rays.

use std::f64::consts::TAU;

use glam::{DVec3, dvec3};
use solidray::{Mesh, Ray, Solid};

use crate::reference::Surface;

/// A solid of size 1 with its surfaces.
pub(crate) struct Shape {
    pub(crate) name: &'static str,
    pub(crate) solid: Solid,
    pub(crate) surfaces: Vec<Surface>,
    /// A point of its inside. In the plane z = 1 solids of revolution have radius 1.
    pub(crate) middle: DVec3,
}

/// One question: a solid in its place, and a ray.
pub(crate) struct Case {
    pub(crate) scale: DVec3,
    pub(crate) offset: DVec3,
    pub(crate) ray: Ray,
}

/// A way to be extreme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    /// Rays that start this many radii away.
    Distance,
    /// Rays that pass this part of a radius below the surface.
    Grazing,
    /// Rays at this angle to a wall.
    Tilt,
    /// Solids flattened by this factor.
    Scale,
    /// Solids this many radii from the origin of the world.
    Offset,
}

impl Axis {
    pub(crate) const ALL: [Self; 5] =
        [Self::Distance, Self::Grazing, Self::Tilt, Self::Scale, Self::Offset];

    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::Distance => "DISTANCE of the origin, in radii",
            Self::Grazing => "GRAZING: depth of the chord, in radii",
            Self::Tilt => "TILT: angle to the wall, in radians",
            Self::Scale => "SCALE: flattened by this factor",
            Self::Offset => "OFFSET of solid and ray, in radii",
        }
    }

    /// What is compared.
    pub(crate) const fn measure(self) -> &'static str {
        match self {
            Self::Grazing => "relative error of the chord",
            Self::Distance | Self::Tilt | Self::Scale | Self::Offset => {
                "error of the entry, in radii"
            }
        }
    }

    /// How extreme, from harmless to hopeless.
    pub(crate) fn steps(self) -> Vec<f64> {
        let powers = |from: i32, to: i32, step: i32| -> Vec<f64> {
            (0..=(to - from) / step).map(|i| 2.0_f64.powi(from + i * step)).collect()
        };
        match self {
            Self::Distance => powers(0, 40, 2),
            Self::Grazing | Self::Tilt => powers(-40, -2, 2),
            Self::Scale => powers(0, 20, 1),
            Self::Offset => powers(0, 30, 2),
        }
    }

    /// What no method in double precision can undercut, because the numbers that state the
    /// question or the answer are rounded themselves (u = 2⁻⁵³; the factors are medians).
    pub(crate) fn floor(self, x: f64) -> f64 {
        const U: f64 = 0.5 * f64::EPSILON;
        match self {
            Self::Distance => 0.35 * U * x,
            Self::Grazing | Self::Tilt => 0.35 * U / x,
            Self::Scale | Self::Offset => 0.35 * U,
        }
    }

    /// Whether it can be done to a solid.
    pub(crate) fn suits(self, shape: &Shape) -> bool {
        match self {
            Self::Grazing => !matches!(shape.name, "box" | "mesh"),
            Self::Tilt => matches!(shape.name, "cylinder" | "box" | "mesh"),
            Self::Distance | Self::Scale | Self::Offset => true,
        }
    }

    /// The `i`-th question at this step.
    pub(crate) fn case(self, shape: &Shape, x: f64, i: u32) -> Case {
        let [a, b, c] = [1, 2, 3].map(|k| fraction(i, k));
        let turn = TAU * a;
        let level = dvec3(turn.cos(), turn.sin(), 0.0);
        let side = dvec3(-level.y, level.x, 0.0);
        let (mut scale, mut offset) = (DVec3::ONE, DVec3::ZERO);
        let lean = level + dvec3(0.0, 0.0, 0.4 * (b - 0.5));
        let aim = shape.middle + 0.6 * (c - 0.5) * side;
        let ray = match self {
            Self::Distance => Ray::new(aim - x * lean, lean),
            Self::Grazing => Ray::new(shape.middle + (1.0 - x) * side - level, level),
            Self::Tilt => {
                // The solid is as long as it takes, and the ray starts within.
                scale.z = 4.0 / x;
                offset.z = -scale.z * shape.middle.z;
                let dir = if shape.name == "cylinder" {
                    level
                } else {
                    dvec3(1.0, 0.3 * b, 0.0)
                };
                Ray::new(dvec3(0.3 * (b - 0.5), 0.3 * (c - 0.5), a), x * dir + DVec3::Z)
            }
            Self::Scale => {
                scale.z = 1.0 / x;
                let flat = |v: DVec3| v * scale;
                Ray::new(flat(aim - 2.0 * lean), flat(lean))
            }
            Self::Offset => {
                offset = x * dvec3(0.6, 0.64, 0.48);
                Ray::new(offset + aim - 2.0 * lean, lean)
            }
        };
        Case { scale, offset, ray }
    }
}

/// A number from 0 to 1, spread evenly over `i` (M. Roberts' R-sequence, in one dimension).
fn fraction(i: u32, k: u32) -> f64 {
    let step = 1.220_744_084_605_759_5_f64.powi(-i32::try_from(k).unwrap_or(1));
    (0.5 + step * f64::from(i)).fract()
}

/// The solids.
pub(crate) fn shapes() -> Vec<Shape> {
    let ends = |top: f64| {
        [Surface::plane(-DVec3::Z, DVec3::ZERO), Surface::plane(DVec3::Z, DVec3::Z * top)]
    };
    let revolved =
        |wall: Surface, top: f64| [wall].into_iter().chain(ends(top)).collect();
    let middle = DVec3::Z;
    let box_planes = DVec3::AXES.into_iter().flat_map(|a| [a, -a]);
    vec![
        Shape {
            name: "ball",
            solid: Solid::ball(1.0),
            surfaces: vec![Surface::revolved(-1.0, 0.0, 1.0)],
            middle: DVec3::ZERO,
        },
        Shape {
            name: "cylinder",
            solid: Solid::cylinder(1.0, 2.0),
            surfaces: revolved(Surface::revolved(0.0, 0.0, 1.0), 2.0),
            middle,
        },
        Shape {
            name: "cone",
            solid: Solid::frustum(2.0, 0.0, 2.0),
            surfaces: revolved(Surface::revolved(1.0, -2.0, 4.0), 2.0),
            middle,
        },
        Shape {
            name: "paraboloid",
            solid: Solid::paraboloid(2.0, 4.0),
            surfaces: revolved(Surface::revolved(0.0, 0.5, 0.0), 4.0),
            middle,
        },
        Shape {
            name: "box",
            solid: Solid::cuboid(DVec3::splat(2.0)),
            surfaces: box_planes.map(|n| Surface::plane(n, n)).collect(),
            middle: DVec3::ZERO,
        },
        wedge(),
    ]
}

/// A mesh: an upright prism over a triangle.
fn wedge() -> Shape {
    let points = vec![
        dvec3(-1.0, -1.0, -1.0),
        dvec3(1.5, -0.5, -1.0),
        dvec3(-0.5, 1.5, -1.0),
        dvec3(-1.0, -1.0, 1.0),
        dvec3(1.5, -0.5, 1.0),
        dvec3(-0.5, 1.5, 1.0),
    ];
    let faces = vec![
        [0, 2, 1],
        [3, 4, 5],
        [0, 1, 4],
        [0, 4, 3],
        [1, 2, 5],
        [1, 5, 4],
        [2, 0, 3],
        [2, 3, 5],
    ];
    let planes = faces.iter().map(|face: &[u32; 3]| {
        let [a, b, c] = face.map(|i| points[i as usize]);
        Surface::plane((b - a).cross(c - a), a)
    });
    let surfaces = planes.collect();
    let mesh = Mesh::new(points, faces).expect("a prism is closed");
    Shape { name: "mesh", solid: Solid::mesh(mesh), surfaces, middle: DVec3::ZERO }
}
