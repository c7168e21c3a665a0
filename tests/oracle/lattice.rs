//! Boxes, half-spaces and meshes whose coordinates have few digits, in whole numbers.
//!
//! Coordinates are counted in steps of 1/4096, so the place where a line crosses a plane is
//! a fraction of whole numbers. Where the line lies within a face or passes an edge, it
//! counts as moved by (ε, ε², ε³) with ε smaller than any number: along the normal of which
//! the first component that is not zero is positive.

use std::cmp::Ordering;

use glam::{DAffine3, DVec3};
use solidray::{Mesh, Ray};

use super::sweep::Passage;
use crate::support::leaf::Leaf;
use crate::support::model::Model;

/// A point or a direction.
type Whole = [i64; 3];

/// How many steps there are to a unit of length.
const STEPS: f64 = 4096.0;

/// A place on a line: a fraction with a positive denominator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fraction {
    numerator: i64,
    denominator: i64,
}

impl Fraction {
    fn new(numerator: i64, denominator: i64) -> Self {
        let sign = denominator.signum();
        Self { numerator: sign * numerator, denominator: sign * denominator }
    }

    /// The number closest to it.
    pub(crate) fn rounded(self) -> f64 {
        real(self.numerator) / real(self.denominator)
    }
}

impl Ord for Fraction {
    fn cmp(&self, other: &Self) -> Ordering {
        let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
        product(self.numerator, other.denominator)
            .cmp(&product(other.numerator, self.denominator))
    }
}

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Fraction {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Fraction {}

/// A line in steps.
struct Line {
    origin: Whole,
    dir: Whole,
}

/// The leaves of a model in their places.
pub(crate) struct Lattice(Vec<Shape>);

enum Shape {
    /// What is on the inner side of all of some planes.
    Convex(Vec<Side>),
    Mesh(Vec<[Whole; 3]>),
}

/// The points with `normal · p ≤ offset`.
struct Side {
    normal: Whole,
    offset: i64,
}

impl Lattice {
    /// Of a model with boxes, half-spaces and meshes under maps that turn by right angles,
    /// mirror, move and scale evenly, all by numbers with few digits.
    pub(crate) fn new(model: &Model) -> Self {
        let leaves = model.leaves();
        Self(leaves.into_iter().map(|(leaf, map)| Shape::new(leaf, &map)).collect())
    }

    /// What a line meets of all leaves.
    pub(crate) fn passages(&self, ray: &Ray) -> Vec<Passage<Fraction>> {
        let line = Line { origin: whole(ray.origin), dir: whole(ray.dir) };
        self.0.iter().map(|shape| shape.passage(&line)).collect()
    }
}

impl Shape {
    fn new(leaf: &Leaf, map: &DAffine3) -> Self {
        if let Leaf::Mesh(mesh) = leaf {
            return Self::Mesh(faces(&mesh.0, map));
        }
        assert!(leaf.wall::<f64>().is_none(), "{leaf:?} is not made of planes");
        let sides = leaf.planes().into_iter();
        Self::Convex(
            sides.map(|(normal, offset)| Side::new(normal, offset, map)).collect(),
        )
    }

    fn passage(&self, line: &Line) -> Passage<Fraction> {
        match self {
            Self::Convex(sides) => passage_of_convex(sides, line),
            Self::Mesh(faces) => passage_of_mesh(faces, line),
        }
    }
}

impl Side {
    /// The image of a side. A map that turns and scales by s takes `normal · p ≤ offset` to
    /// `n · (p − v) ≤ s² offset` with the mapped normal n and the move v.
    fn new(normal: DVec3, offset: f64, map: &DAffine3) -> Self {
        let square = map.matrix3.x_axis.length_squared();
        let normal = map.transform_vector3(normal);
        let offset = square * offset + normal.dot(map.translation);
        Self { normal: whole(normal), offset: exact(offset * STEPS * STEPS) }
    }
}

/// The faces of a placed mesh, turned as they were in it.
fn faces(mesh: &Mesh, map: &DAffine3) -> Vec<[Whole; 3]> {
    let place = |i: u32| whole(map.transform_point3(mesh.points()[i as usize]));
    let mirrored = map.matrix3.determinant() < 0.0;
    let turn = |[a, b, c]: [Whole; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
    mesh.faces().iter().map(|face| turn(face.map(place))).collect()
}

fn passage_of_convex(sides: &[Side], line: &Line) -> Passage<Fraction> {
    let (mut enter, mut exit): (Option<Fraction>, Option<Fraction>) = (None, None);
    let outside = Passage { starts_inside: false, changes: Vec::new() };
    for side in sides {
        let speed = dot(side.normal, line.dir);
        let room = side.offset - dot(side.normal, line.origin);
        if speed == 0 {
            if room < 0 || (room == 0 && leading_sign(side.normal) > 0) {
                return outside;
            }
            continue;
        }
        let t = Fraction::new(room, speed);
        if speed > 0 {
            exit = Some(exit.map_or(t, |exit| exit.min(t)));
        } else {
            enter = Some(enter.map_or(t, |enter| enter.max(t)));
        }
    }
    if let (Some(enter), Some(exit)) = (enter, exit)
        && enter >= exit
    {
        return outside;
    }
    let changes = enter.into_iter().chain(exit).collect();
    Passage { starts_inside: enter.is_none(), changes }
}

fn passage_of_mesh(faces: &[[Whole; 3]], line: &Line) -> Passage<Fraction> {
    let mut events: Vec<(Fraction, i32)> =
        faces.iter().filter_map(|face| crossing(face, line)).collect();
    events.sort_unstable();
    let (mut winding, mut changes) = (0, Vec::new());
    for group in events.chunk_by(|a, b| a.0 == b.0) {
        let before = winding;
        winding += group.iter().map(|(_, step)| step).sum::<i32>();
        if (before > 0) != (winding > 0) {
            changes.push(group[0].0);
        }
    }
    assert_eq!(winding, 0, "a closed mesh is left as often as it is entered");
    Passage { starts_inside: false, changes }
}

/// Where the moved line passes a triangle, and whether it goes in (1) or out (−1).
fn crossing(&[a, b, c]: &[Whole; 3], line: &Line) -> Option<(Fraction, i32)> {
    let sides = [(a, b), (b, c), (c, a)].map(|(a, b)| side_of_edge(a, b, line));
    let out = match sides {
        [1, 1, 1] => true,
        [-1, -1, -1] => false,
        _ => return None,
    };
    let normal = cross(minus(b, a), minus(c, a));
    let t = Fraction::new(dot(normal, minus(a, line.origin)), dot(normal, line.dir));
    Some((t, if out { -1 } else { 1 }))
}

/// On which side of the line from `a` to `b` the moved line passes: the sign of
/// d · ((a − o) × (b − o)), which a move by m changes by m · ((a − b) × d). Zero if the two
/// are parallel.
fn side_of_edge(a: Whole, b: Whole, line: &Line) -> i64 {
    let turn = dot(line.dir, cross(minus(a, line.origin), minus(b, line.origin)));
    if turn != 0 { turn.signum() } else { leading_sign(cross(minus(a, b), line.dir)) }
}

/// The sign of a product with (ε, ε², ε³).
fn leading_sign(v: Whole) -> i64 {
    v.into_iter().find(|&c| c != 0).map_or(0, i64::signum)
}

fn dot(a: Whole, b: Whole) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: Whole, b: Whole) -> Whole {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn cross(a: Whole, b: Whole) -> Whole {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

/// A point or a direction in steps.
fn whole(v: DVec3) -> Whole {
    v.to_array().map(|x| exact(STEPS * x))
}

#[expect(clippy::cast_possible_truncation, reason = "the number is compared with it")]
#[expect(clippy::float_cmp, reason = "whole numbers are exact")]
fn exact(x: f64) -> i64 {
    let whole = x as i64;
    assert!(real(whole) == x && x.abs() < 2.0_f64.powi(53), "{x} is not whole");
    whole
}

/// A whole number below 2⁵³ as it is.
fn real(x: i64) -> f64 {
    assert!(x.unsigned_abs() <= 1 << 53, "{x} has too many digits");
    x as f64
}
