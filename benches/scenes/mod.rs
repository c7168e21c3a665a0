//! The scenes that speed is measured on.
//!
//! Each stresses one thing: `classic` the cost of a leaf, `spheres` and `plate` many
//! subtractions, `menger` long bars whose boxes tell little, `deep` trees of turned leaves,
//! `blob` meshes. Names end in the number of leaves, operators or triangles.

use std::collections::HashMap;
use std::f64::consts::{PI, SQRT_2};
use std::path::Path;

use glam::{DAffine3, DMat3, DVec3, Vec3Swizzles, dvec3};
use solidray::read::{self, Format, ReadOptions};
use solidray::render::{Camera, Projection, View};
use solidray::{Aabb, Mesh, Op, Solid};

/// The scenes of formulas, small ones first.
pub(crate) const FORMULAS: [&str; 9] = [
    "classic",
    "spheres-1k",
    "spheres-10k",
    "plate-1k",
    "plate-10k",
    "menger-3",
    "menger-4",
    "deep-50",
    "deep-200",
];

/// The scenes with a mesh.
pub(crate) const MESHES: [&str; 2] = ["blob-82k", "blob-1310k"];

/// A solid to be measured on, and how it is looked at.
#[derive(Debug)]
pub(crate) struct Subject {
    pub(crate) solid: Solid,
    /// By a closed form.
    pub(crate) volume: Option<f64>,
    /// A box around it, not the smallest for the `deep` ones.
    pub(crate) bounds: Aabb,
    /// From the middle of the picture to its upper edge.
    pub(crate) half_height: f64,
}

impl Subject {
    /// The scene of one of the names.
    ///
    /// # Panics
    ///
    /// If there is none.
    pub(crate) fn named(name: &str) -> Self {
        match name {
            "classic" => classic(),
            "spheres-1k" => spheres(10),
            "spheres-10k" => spheres(22),
            "plate-1k" => plate(30),
            "plate-10k" => plate(100),
            "menger-3" => menger(3),
            "menger-4" => menger(4),
            "deep-50" => deep(include_bytes!("deep-50.csg")),
            "deep-200" => deep(include_bytes!("deep-200.csg")),
            "blob-5k" => blob(4),
            "blob-82k" => blob(6),
            "blob-1310k" => blob(8),
            _ => panic!("there is no scene {name}"),
        }
    }

    /// A scene that fills its bounds, seen whole.
    fn new(solid: Solid, volume: Option<f64>, bounds: Aabb) -> Self {
        let half_height = 1.02 * 0.5 * bounds.size().length();
        Self { solid, volume, bounds, half_height }
    }

    /// A square picture, orthographic and from above one corner.
    pub(crate) fn view(&self, size: u32) -> View {
        let slope = (0.5 * Camera::FIELD_OF_VIEW_DEG).to_radians().tan();
        let to_eye = dvec3(0.62, 0.53, 0.58).normalize() * (self.half_height / slope);
        let center = self.bounds.center();
        let [ex, ey, ez] = (center + to_eye).to_array();
        let [x, y, z] = center.to_array();
        Camera::vector([ex, ey, ez, x, y, z])
            .expect("the eye is beside the centre")
            .with_projection(Projection::Orthographic)
            .view([size; 2], &self.bounds)
    }
}

/// A rounded cube with three bores.
fn classic() -> Subject {
    let (ball, bore) = (1.35_f64, 0.7_f64);
    let cube = Aabb::new(DVec3::NEG_ONE, DVec3::ONE);
    let rounded = cuboid(cube) & Solid::ball(ball);
    let bores = DVec3::AXES.map(|axis| cylinder(-1.1 * axis, axis, 2.2, bore));
    let cap = ball - 1.0;
    let caps = 6.0 * PI * cap * cap * (3.0 * ball - cap) / 3.0;
    let pairs = 3.0 * 16.0 / 3.0 * bore.powi(3);
    let triple = 8.0 * (2.0 - SQRT_2) * bore.powi(3);
    let bored = 6.0 * PI * bore * bore - pairs + triple;
    let volume = 4.0 / 3.0 * PI * ball.powi(3) - caps - bored;
    Subject::new(difference(rounded, bores), Some(volume), cube)
}

/// A cube less n³ balls, which overlap their neighbours.
fn spheres(n: u32) -> Subject {
    let gap = 1.0 / f64::from(n - 1);
    let radius = 0.55 * gap;
    let ball = |(i, j, k)| Solid::ball(radius).translated(gap * cell(i, j, k));
    let balls =
        (0..n).flat_map(|i| (0..n).flat_map(move |j| (0..n).map(move |k| (i, j, k))));
    let lens = PI * (4.0 * radius + gap) * (2.0 * radius - gap).powi(2) / 12.0;
    let each = 4.0 / 3.0 * PI * radius.powi(3) - 3.0 * lens;
    let volume = 1.0 - f64::from(n - 1).powi(3) * each;
    let cube = Aabb::new(DVec3::ZERO, DVec3::ONE);
    Subject::new(difference(cuboid(cube), balls.map(ball)), Some(volume), cube)
}

/// A plate with n² holes through it and 100 cones on it.
fn plate(n: u32) -> Subject {
    const CONES: u32 = 10;
    let side = f64::from(n);
    let squares = |n: u32| (0..n).flat_map(move |i| (0..n).map(move |j| (i, j)));
    let holes = squares(n).map(|(i, j)| {
        let foot = cell(i, j, 0) + dvec3(0.5, 0.5, -1.5);
        cylinder(foot, DVec3::Z, 3.0, 0.3)
    });
    let step = n / CONES;
    let cones = squares(CONES).map(|(i, j)| {
        let foot = cell(step * i + step / 2, step * j + step / 2, 0);
        Solid::frustum(0.4, 0.0, 4.0).translated(foot)
    });
    let slab = cuboid(Aabb::new(dvec3(0.0, 0.0, -1.0), dvec3(side, side, 1.0)));
    let drilled = difference(slab, holes);
    let above = f64::from(CONES * CONES) * PI * 0.16 * 4.0 / 3.0 * 27.0 / 64.0;
    let volume = 2.0 * side * side * (1.0 - PI * 0.09) + above;
    let bounds = Aabb::new(dvec3(0.0, 0.0, -1.0), dvec3(side, side, 4.0));
    let solid = Solid::boolean(Op::Union, std::iter::once(drilled).chain(cones));
    Subject::new(solid, Some(volume), bounds)
}

/// Menger's sponge: a cube less square bars, finer from level to level. Bars that would
/// run where a thicker one has been are left out.
fn menger(levels: u32) -> Subject {
    const OVER: f64 = 0.01;
    let mut bars = Vec::new();
    for level in 0..levels {
        let cells = 3_u32.pow(level);
        let scale = 1.0 / f64::from(cells);
        let squares = (0..cells).flat_map(|i| (0..cells).map(move |j| [i, j]));
        for square in squares.filter(|&square| !is_bored(square, level)) {
            let [low, high] = [1.0, 2.0].map(|third| {
                square.map(|index| (f64::from(index) + third / 3.0) * scale)
            });
            for axis in 0..3 {
                let along = |end: f64, [u, v]: [f64; 2]| match axis {
                    0 => dvec3(end, u, v),
                    1 => dvec3(u, end, v),
                    _ => dvec3(u, v, end),
                };
                bars.push(cuboid(Aabb::new(along(-OVER, low), along(1.0 + OVER, high))));
            }
        }
    }
    let cube = Aabb::new(DVec3::ZERO, DVec3::ONE);
    let volume = (20.0_f64 / 27.0).powf(f64::from(levels));
    Subject::new(difference(cuboid(cube), bars), Some(volume), cube)
}

/// Whether a square of a grid of 3^`level` squares a side is within a bar of a coarser level.
fn is_bored([mut i, mut j]: [u32; 2], level: u32) -> bool {
    (0..level).any(|_| {
        let middle = i % 3 == 1 && j % 3 == 1;
        (i, j) = (i / 3, j / 3);
        middle
    })
}

/// A tree of unions, differences and intersections at random, many levels deep, of balls,
/// cylinders and boxes that are turned and stretched.
fn deep(csg: &[u8]) -> Subject {
    let path = Path::new("deep.csg");
    let model = read::bytes(csg, path, Format::Csg, &ReadOptions::default());
    let solid = model.expect("the file is right").solid;
    let bounds = Aabb::new(DVec3::splat(-1.6), DVec3::splat(1.6));
    Subject { half_height: 1.0, ..Subject::new(solid, None, bounds) }
}

/// An icosphere with bumps on bumps, in single precision as meshes often are, less a ball.
fn blob(level: u32) -> Subject {
    let (points, faces) = icosphere(level);
    let swell = |p: DVec3, frequency: DVec3, phase: DVec3| {
        (frequency * p + phase).to_array().map(f64::sin).iter().product::<f64>()
    };
    let points = points.into_iter().map(|p| {
        let coarse = swell(p, dvec3(6.0, 7.0, 5.0), dvec3(1.0, 2.0, 3.0));
        let fine = swell(p, dvec3(41.0, 37.0, 43.0), DVec3::ZERO);
        ((1.0 + 0.12 * coarse + 0.01 * fine) * p).as_vec3().as_dvec3()
    });
    let mesh = Mesh::new(points.collect(), faces).expect("a displaced sphere is closed");
    let bite = Solid::ball(0.6).translated(dvec3(0.55, 0.45, 0.6));
    let bounds = Aabb::new(DVec3::splat(-1.2), DVec3::splat(1.2));
    Subject { half_height: 1.2, ..Subject::new(Solid::mesh(mesh) - bite, None, bounds) }
}

/// A mesh of the unit sphere: an icosahedron whose faces are quartered `level` times.
fn icosphere(level: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    // Three golden rectangles, each square to the next.
    let corners = [[-1.0, 1.0], [1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let rectangle = |[u, v]: [f64; 2]| dvec3(u, v * golden, 0.0);
    let turned = |p: DVec3| [p, dvec3(p.z, p.x, p.y), dvec3(p.y, p.z, p.x)];
    let thrice = corners.map(|corner| turned(rectangle(corner)));
    let mut points: Vec<DVec3> =
        (0..3).flat_map(|turn| thrice.map(|turned| turned[turn].normalize())).collect();
    let mut faces = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..level {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize());
                u32::try_from(points.len() - 1).expect("the mesh is small")
            })
        };
        faces = faces
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [d, e, f] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, d, f], [b, e, d], [c, f, e], [d, e, f]]
            })
            .collect();
    }
    (points, faces)
}

fn cell(i: u32, j: u32, k: u32) -> DVec3 {
    dvec3(f64::from(i), f64::from(j), f64::from(k))
}

fn cuboid(Aabb { min, max }: Aabb) -> Solid {
    Solid::cuboid_between(min, max)
}

/// The cylinder from `foot` along an axis of the world.
fn cylinder(foot: DVec3, axis: DVec3, height: f64, radius: f64) -> Solid {
    // The axes in a circle, so that the frame is right-handed.
    let frame = DMat3::from_cols(axis.zxy(), axis.yzx(), axis);
    let map = DAffine3::from_mat3_translation(frame, foot);
    Solid::cylinder(radius, height).mapped(map)
}

fn difference(from: Solid, what: impl IntoIterator<Item = Solid>) -> Solid {
    Solid::boolean(Op::Difference, std::iter::once(from).chain(what))
}
