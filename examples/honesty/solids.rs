//! Solids with their volumes, which are known without a ray.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec3, dvec3};
use solidray::measure::{self, Estimate};
use solidray::{Mesh, Op, Scene, Solid};

/// A solid and its volume.
pub(crate) struct Subject {
    pub(crate) name: &'static str,
    pub(crate) scene: Scene,
    pub(crate) truth: f64,
}

impl Subject {
    fn new(name: &'static str, solid: &Solid, truth: f64) -> Self {
        let scene = Scene::compile(solid).expect("the solid is right");
        Self { name, scene, truth }
    }

    /// One that has a formula.
    fn leaf(name: &'static str, solid: &Solid) -> Self {
        let truth = measure::exact(solid).expect("there is a formula");
        Self::new(name, solid, truth.value)
    }

    /// Whether an interval holds the truth, which is rounded.
    pub(crate) fn is_held_by(&self, found: &Estimate) -> bool {
        let ([low, high], room) = (found.interval, 1e-13 * self.truth);
        (low - room..=high + room).contains(&self.truth)
    }
}

/// Of every kind one.
pub(crate) fn subjects() -> Vec<Subject> {
    let (chain, of_chain) = chain();
    let speck = Solid::ball(0.01).translated(dvec3(0.3, 0.2, -0.1));
    let room = cube(2.0) - cube(1.99) + speck;
    let shell = Solid::ball(1.0) - Solid::ball(0.9975);
    let plate = cuboid(3.0, 3.0, 0.1);
    vec![
        Subject::leaf("ball", &Solid::ball(1.0)),
        Subject::leaf("box along the axes", &cube(1.0)),
        Subject::leaf("turned box", &turned(cube(1.0))),
        Subject::new("shell of 0.25 %", &shell, ball(1.0) - ball(0.9975)),
        Subject::new("classic", &classic(), 2.102_460_573_219_949_5),
        Subject::new("chain of 50 balls", &turned(chain), of_chain),
        Subject::leaf("mesh", &Solid::mesh(crystal())),
        Subject::new("speck in a thin room", &room, 8.0 - 1.99_f64.powi(3) + ball(0.01)),
        Subject::new("perforated plate", &perforated(), 0.9 - 9.0 * PI * 0.04 * 0.1),
        Subject::leaf("thin turned plate", &turned(plate)),
    ]
}

/// Those of which views along the three axes can agree and all be wrong, and of which rays at
/// equal distances can all meet the same part.
pub(crate) fn traps() -> Vec<Subject> {
    let plate = || cuboid(0.3, 0.3, 0.01);
    let of_plate = 0.3 * 0.3 * 0.01;
    let framed = |solid| solid + corners();
    let of_framed = of_plate + 2.0 * GRAIN.powi(3);
    let ball_at = |at| Solid::ball(0.004).translated(at);
    let cube_at = |at| cube(0.01).translated(at);
    vec![
        Subject::new("turned plate", &turned(plate()), of_plate),
        Subject::new("turned plate in a room", &framed(turned(plate())), of_framed),
        Subject::new("plate in a room", &framed(plate()), of_framed),
        Subject::new("comb of 64 teeth", &comb(64, 0.1), 0.1),
        Subject::new("block with 233 slits", &comb(233, 0.9), 0.9),
        Subject::new("grille of 32 by 32 bars", &grille(32, 0.1), 0.19 * 0.05),
        Subject::new("lattice of 512 cubes", &lattice(cube_at), 512.0 * 1e-6),
        Subject::new("lattice of 512 balls", &lattice(ball_at), 512.0 * ball(0.004)),
    ]
}

fn ball(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3)
}

fn cuboid(x: f64, y: f64, z: f64) -> Solid {
    Solid::cuboid(dvec3(x, y, z))
}

fn cube(size: f64) -> Solid {
    cuboid(size, size, size)
}

fn turned(solid: Solid) -> Solid {
    solid.rotated(DVec3::Z, 0.5).rotated(DVec3::X, 0.3).rotated(DVec3::Y, 1.1)
}

/// A cube, rounded by a ball and bored along the axes.
fn classic() -> Solid {
    let rod = Solid::cylinder(0.7, 4.0).translated(dvec3(0.0, 0.0, -2.0));
    let across = rod.clone().rotated(DVec3::X, FRAC_PI_2);
    let along = rod.clone().rotated(DVec3::Y, FRAC_PI_2);
    (cube(2.0) & Solid::ball(1.35)) - (rod + across + along)
}

/// A plate with nine round holes.
fn perforated() -> Solid {
    let hole = Solid::cylinder(0.2, 4.0).translated(dvec3(0.0, 0.0, -2.0));
    let places =
        (0..9_i32).map(|i| dvec3(f64::from(i % 3 - 1), f64::from(i / 3 - 1), 0.0));
    places.fold(cuboid(3.0, 3.0, 0.1), |plate, at| {
        plate - hole.clone().translated(0.8 * at)
    })
}

/// An octahedron with its corners moved, which is a mesh.
fn crystal() -> Mesh {
    let points = vec![
        dvec3(1.0, 0.1, 0.0),
        dvec3(-0.9, 0.0, 0.2),
        dvec3(0.0, 1.2, 0.1),
        dvec3(0.1, -1.0, 0.0),
        dvec3(0.0, 0.2, 0.8),
        dvec3(-0.1, 0.0, -1.1),
    ];
    let faces = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    Mesh::new(points, faces).expect("it is closed")
}

/// Fifty balls along a line, by turns added to what those before have left and cut from it; and
/// its volume.
///
/// Across the line they are discs about one point, and the last one that covers a place says
/// what is there. The squares of their radii differ by linear functions of the height. So between
/// the heights where two are equal, or one is zero, the area is a polynomial of degree two, which
/// Simpson's rule integrates.
fn chain() -> (Solid, f64) {
    let balls: Vec<(f64, f64)> = (0..50_i32)
        .map(f64::from)
        .map(|i| (1.5 * (0.755 * i).fract(), 1.2 - 0.02 * i))
        .collect();
    let place =
        |&(at, radius): &(f64, f64)| Solid::ball(radius).translated(at * DVec3::Z);
    let solid = (1..50).fold(place(&balls[0]), |all, i| {
        let op = if i % 2 == 0 { Op::Union } else { Op::Difference };
        Solid::boolean(op, [all, place(&balls[i])])
    });
    let square = |(at, radius): (f64, f64), z: f64| radius * radius - (z - at) * (z - at);
    let area = |z: f64| {
        let squares: Vec<f64> =
            balls.iter().map(|&ball| square(ball, z).max(0.0)).collect();
        let mut rings = squares.clone();
        rings.push(0.0);
        rings.sort_by(f64::total_cmp);
        let is_solid = |ring: &&[f64]| {
            let middle = f64::midpoint(ring[0], ring[1]);
            squares.iter().rposition(|s| middle < *s).is_some_and(|last| last % 2 == 0)
        };
        PI * rings.windows(2).filter(is_solid).map(|ring| ring[1] - ring[0]).sum::<f64>()
    };
    let mut heights: Vec<f64> =
        balls.iter().flat_map(|(at, r)| [at - r, at + r]).collect();
    for (i, &(a, r)) in balls.iter().enumerate() {
        let equal =
            |&(b, s): &(f64, f64)| ((r * r - a * a) - (s * s - b * b)) / (2.0 * (b - a));
        heights.extend(balls[..i].iter().map(equal));
    }
    let [low, high] = [-1.2, 2.7];
    heights.retain(|z| (low..=high).contains(z));
    heights.sort_by(f64::total_cmp);
    let simpson = |piece: &[f64]| {
        let (a, b) = (piece[0], piece[1]);
        (b - a) / 6.0 * (area(a) + 4.0 * area(f64::midpoint(a, b)) + area(b))
    };
    (solid, heights.windows(2).map(simpson).sum())
}

/// The edge of the grains in the corners of a room.
const GRAIN: f64 = 1e-3;

/// Two grains in opposite corners of a room of edge 1, which make its bounds.
fn corners() -> Solid {
    let at = DVec3::splat(0.5 * (1.0 - GRAIN));
    cube(GRAIN).translated(at) + cube(GRAIN).translated(-at)
}

/// So many walls at equal distances in a cube of edge 1, which fill this part of it. The first
/// begins where the cube does.
fn comb(walls: u32, part: f64) -> Solid {
    let step = 1.0 / f64::from(walls);
    Solid::boolean(
        Op::Union,
        (0..walls).map(|i| {
            let x = f64::from(i) * step;
            Solid::cuboid_between(dvec3(x, 0.0, 0.0), dvec3(x + part * step, 1.0, 1.0))
        }),
    )
}

/// So many bars each way in a plane, which cover this part of it each.
fn grille(bars: u32, part: f64) -> Solid {
    let flat = comb(bars, part).scaled(dvec3(1.0, 1.0, 0.05));
    flat.clone() + flat.mirrored(dvec3(1.0, -1.0, 0.0))
}

/// Eight by eight by eight of something, an eighth apart.
fn lattice(of: impl Fn(DVec3) -> Solid) -> Solid {
    let at = |i: i32| dvec3(f64::from(i % 8), f64::from(i / 8 % 8), f64::from(i / 64));
    Solid::boolean(Op::Union, (0..512).map(|i| of(at(i) / 8.0)))
}
