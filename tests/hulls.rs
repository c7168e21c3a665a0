//! Exact hulls of balls, of circles and of plates.
//!
//! What is made lies within the hull. So a point of its surface is on the surface of the hull if it
//! is on a plane that all balls are below: if p · n = max (c · n + r) over all balls, n the normal
//! there.

use std::f64::consts::PI;
use std::path::Path;

use glam::{DMat3, DVec3, dvec3};
use proptest::collection::vec;
use proptest::prelude::*;
use solidray::measure::{self, Sampling};
use solidray::read::{self, Curves, Format, ReadOptions};
use solidray::{Crossing, Ray, Scene, Solid};

fn solid(text: &str) -> Solid {
    let options = ReadOptions { curves: Curves::Auto, ..ReadOptions::default() };
    let read = read::bytes(text.as_bytes(), Path::new("test.csg"), Format::Csg, &options);
    read.unwrap_or_else(|error| panic!("{error}: {text}")).solid
}

fn scene(text: &str) -> Scene {
    Scene::compile(&solid(text)).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn at([x, y, z]: [f64; 3]) -> String {
    format!("multmatrix([[1,0,0,{x:?}],[0,1,0,{y:?}],[0,0,1,{z:?}],[0,0,0,1]])")
}

/// A ball, or a point if its radius is zero.
#[derive(Clone, Copy, Debug)]
struct Ball {
    center: DVec3,
    radius: f64,
}

fn ball(x: f64, y: f64, z: f64, radius: f64) -> Ball {
    Ball { center: dvec3(x, y, z), radius }
}

/// What a hull is taken of.
#[derive(Clone, Copy, Debug)]
enum Item {
    Ball(Ball),
    /// Corners at a place and at this distance from it along each axis.
    Corners(DVec3, f64),
}

impl Item {
    fn text(&self) -> String {
        match self {
            Self::Ball(Ball { center, radius }) => {
                format!("{} sphere(r = {radius:?});", at(center.to_array()))
            }
            Self::Corners(at, size) => {
                let points = Self::corners(*at, *size).map(|p| p.to_array());
                format!(
                    "polyhedron(points = {points:?}, \
                     faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);"
                )
            }
        }
    }

    fn corners(at: DVec3, size: f64) -> [DVec3; 4] {
        [at, at + size * DVec3::X, at + size * DVec3::Y, at + size * DVec3::Z]
    }

    fn balls(&self) -> Vec<Ball> {
        match self {
            Self::Ball(ball) => vec![*ball],
            Self::Corners(at, size) => Self::corners(*at, *size)
                .map(|center| Ball { center, radius: 0.0 })
                .to_vec(),
        }
    }
}

/// A hull, and the balls that it is of.
struct Hull {
    text: String,
    balls: Vec<Ball>,
    scene: Scene,
    /// How far it reaches from the origin.
    size: f64,
}

impl Hull {
    fn new(items: &[Item]) -> Self {
        let parts: String = items.iter().map(Item::text).collect();
        let text = format!("hull() {{ {parts} }}");
        let balls: Vec<Ball> = items.iter().flat_map(Item::balls).collect();
        let reach = |b: &Ball| b.center.length() + b.radius;
        let size = balls.iter().map(reach).fold(0.0, f64::max);
        Self { scene: scene(&text), text, balls, size }
    }

    /// How far it reaches in a direction.
    fn reach(&self, direction: DVec3) -> f64 {
        let reach = |b: &Ball| b.center.dot(direction) + b.radius;
        self.balls.iter().map(reach).fold(f64::NEG_INFINITY, f64::max)
    }

    /// A point within, from weights of balls and a vector of length less than 1.
    fn inner(&self, weights: &[f64], offset: DVec3) -> DVec3 {
        let weights = || self.balls.iter().zip(weights.iter().cycle());
        let sum: f64 = weights().map(|(_, w)| w).sum();
        weights().map(|(b, w)| w / sum * (b.center + b.radius * offset)).sum()
    }

    /// Where a ray enters and leaves; fails if there are gaps.
    fn ends(&self, ray: &Ray) -> [Crossing; 2] {
        let mut tracer = self.scene.tracer();
        let spans = tracer.spans(ray);
        let [Some(first), Some(last)] = [spans.first(), spans.last()] else {
            panic!("{ray:?} misses {}", self.text);
        };
        for pair in spans.windows(2) {
            let gap = (pair[1].enter.t - pair[0].exit.t) * ray.speed();
            assert!(gap <= self.room(), "{ray:?} sees a gap of {gap:e} in {}", self.text);
        }
        [first.enter, last.exit]
    }

    /// Fails if a crossing is not on the plane that the hull touches with a normal.
    fn assert_on(&self, ray: &Ray, crossing: &Crossing, normal: DVec3) {
        let below = self.reach(normal) - ray.at(crossing.t).dot(normal);
        assert!(below.abs() <= self.room(), "{ray:?} is {below:e} within {}", self.text);
    }

    fn room(&self) -> f64 {
        ROUNDING * self.size
    }

    /// Points of facets between three balls and of cones between two, with the normals there.
    fn tangents(&self) -> Vec<(DVec3, DVec3)> {
        let mut found = Vec::new();
        for i in 0..self.balls.len() {
            for j in 0..i {
                for k in 0..j {
                    found.extend(self.facet([i, j, k]));
                }
            }
        }
        found
    }

    /// Points of the sides of the facets that touch three balls, and within.
    fn facet(&self, balls: [usize; 3]) -> Vec<(DVec3, DVec3)> {
        let [a, b, c] = balls.map(|i| self.balls[i]);
        let (e, f) = (b.center - a.center, c.center - a.center);
        let across = e.cross(f);
        if across.length() <= 1e-6 * e.length() * f.length() {
            return Vec::new();
        }
        let rows = DMat3::from_cols(e, f, across).transpose();
        let level = rows.inverse() * dvec3(a.radius - b.radius, a.radius - c.radius, 0.0);
        let rest = 1.0 - level.length_squared();
        if rest <= 0.0 {
            return Vec::new();
        }
        let mut found = Vec::new();
        for sign in [-1.0, 1.0] {
            let normal = level + sign * rest.sqrt() * across.normalize();
            let touching = |ball: Ball| ball.center + ball.radius * normal;
            let [p, q, r] = [a, b, c].map(touching);
            if self.reach(normal) - p.dot(normal) > 1e-13 * self.size {
                continue;
            }
            let sides = [(p, q), (q, r), (r, p)];
            for (p, q) in sides {
                found.extend([0.0, 0.3, 0.5].map(|t| (p.lerp(q, t), normal)));
            }
            found.push(((p + q + r) / 3.0, normal));
        }
        found
    }
}

/// How far surfaces may be from where they should, in sizes of the hull.
const ROUNDING: f64 = 1e-12;

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![(-3..=3_i32).prop_map(f64::from), -3.0..3.0_f64]
}

fn place() -> impl Strategy<Value = DVec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from_array)
}

fn radius() -> impl Strategy<Value = f64> {
    prop_oneof![3 => Just(1.0), 1 => (1..=4_i32).prop_map(|i| 0.5 * f64::from(i)), 2 => 0.01..2.5_f64]
}

fn item() -> impl Strategy<Value = Item> {
    prop_oneof![
        4 => (place(), radius()).prop_map(|(center, radius)| Item::Ball(Ball { center, radius })),
        1 => (place(), radius()).prop_map(|(at, size)| Item::Corners(at, size)),
    ]
}

fn direction() -> impl Strategy<Value = DVec3> {
    place().prop_map(|p| p.try_normalize().unwrap_or(DVec3::X))
}

proptest! {
    #[test]
    fn hulls_of_balls_reach_as_far_as_their_balls(
        first in (place(), radius()),
        others in vec(item(), 0..=7),
        scale in prop_oneof![3 => Just(1.0), 1 => Just(1e-6), 1 => Just(1e6)],
        aims in vec((vec(0.0..1.0_f64, 9), direction(), 0.0..0.999_f64, direction()), 12),
    ) {
        let first = Item::Ball(Ball { center: first.0, radius: first.1 });
        let items: Vec<Item> = [first].into_iter().chain(others).map(|item| match item {
            Item::Ball(Ball { center, radius }) => {
                Item::Ball(Ball { center: scale * center, radius: scale * radius })
            }
            Item::Corners(at, size) => Item::Corners(scale * at, scale * size),
        }).collect();
        let hull = Hull::new(&items);
        for &(ref weights, offset, part, dir) in &aims {
            let origin = hull.inner(weights, part * offset);
            prop_assert!(hull.scene.contains(origin), "{origin} of {}", hull.text);
            let ray = Ray { origin, dir };
            for crossing in hull.ends(&ray) {
                hull.assert_on(&ray, &crossing, hull.scene.normal_at(&ray, &crossing));
            }
        }
        // Where cones and facets meet any of their normals may be given, those between them too.
        for (i, (point, normal)) in hull.tangents().into_iter().enumerate() {
            let (weights, offset, part, _) = &aims[i % aims.len()];
            let origin = hull.inner(weights, *part * *offset);
            let ray = Ray { origin, dir: point - origin };
            let [_, exit] = hull.ends(&ray);
            hull.assert_on(&ray, &exit, normal);
        }
    }
}

/// The same hull of circles in the plane, extruded, as text.
fn plate(discs: &[Ball]) -> String {
    let circle =
        |b: &Ball| format!("{} circle(r = {:?});", at(b.center.to_array()), b.radius);
    let circles: String = discs.iter().map(circle).collect();
    format!("linear_extrude(height = 2) hull() {{ {circles} square(0.5); }}")
}

/// The hull of cylinders of one height, as text.
fn cylinders(discs: &[Ball]) -> String {
    let cylinder = |b: &Ball| {
        format!("{} cylinder(r = {:?}, h = 2);", at(b.center.to_array()), b.radius)
    };
    let all: String = discs.iter().map(cylinder).collect();
    format!("hull() {{ {all} cube([0.5, 0.5, 2]); }}")
}

proptest! {
    #[test]
    fn hulls_of_circles_reach_as_far_as_their_circles(
        discs in vec((coordinate(), coordinate(), radius()), 1..=9),
        aims in vec((vec(0.0..1.0_f64, 13), 0.0..6.3_f64, 0.0..0.999_f64, 0.0..6.3_f64), 12),
    ) {
        let discs: Vec<Ball> = discs.into_iter().map(|(x, y, r)| ball(x, y, 0.0, r)).collect();
        let corners = [(0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5)];
        let mut balls = discs.clone();
        balls.extend(corners.map(|(x, y)| ball(x, y, 0.0, 0.0)));
        for text in [plate(&discs), cylinders(&discs)] {
            let reach = |b: &Ball| b.center.length() + b.radius;
            let size = balls.iter().map(reach).fold(0.0, f64::max);
            let hull = Hull { scene: scene(&text), text, balls: balls.clone(), size };
            for (weights, angle, part, way) in &aims {
                let around = |angle: f64| dvec3(angle.cos(), angle.sin(), 0.0);
                let mut origin = hull.inner(weights, *part * around(*angle));
                origin.z = 1.3;
                prop_assert!(hull.scene.contains(origin), "{origin} of {}", hull.text);
                let ray = Ray { origin, dir: around(*way) };
                for crossing in hull.ends(&ray) {
                    hull.assert_on(&ray, &crossing, hull.scene.normal_at(&ray, &crossing));
                }
            }
        }
    }
}

fn volume(scene: &Scene, rel_tol: f64) -> f64 {
    measure::volume(scene, &Sampling { rel_tol, ..Sampling::default() }).value
}

fn ball_volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3)
}

/// The hull of two balls at a distance, the smaller of radius `b`.
fn drop_volume(a: f64, b: f64, distance: f64) -> f64 {
    let sine = (a - b) / distance;
    let cosine = (1.0 - sine * sine).sqrt();
    // Caps of height h: the larger ball's is more than half of it.
    let cap = |r: f64, h: f64| PI * h * h * (r - h / 3.0);
    let [p, q] = [a * cosine, b * cosine];
    let height = distance * cosine * cosine;
    cap(a, a * (1.0 + sine))
        + cap(b, b * (1.0 - sine))
        + PI * height / 3.0 * (p * p + p * q + q * q)
}

/// A body within a distance, by J. Steiner's formula: volume, surface and mean width of the body.
fn rounded_box([x, y, z]: [f64; 3], r: f64) -> f64 {
    x * y * z
        + 2.0 * r * (x * y + y * z + z * x)
        + PI * r * r * (x + y + z)
        + ball_volume(r)
}

fn sphere(place: [f64; 3], radius: f64) -> String {
    format!("{} sphere(r = {radius:?});", at(place))
}

#[test]
fn hulls_of_two_balls_are_right_to_twelve_digits() {
    let far = |radius| sphere([6.0, 8.0, 0.0], radius);
    for (text, expected) in [
        (sphere([0.0; 3], 2.0) + &far(2.0), drop_volume(2.0, 2.0, 10.0)),
        (sphere([0.0; 3], 3.0) + &far(1.0), drop_volume(3.0, 1.0, 10.0)),
        // One that barely looks out of the other.
        (sphere([0.0; 3], 3.0) + &far(12.999), drop_volume(12.999, 3.0, 10.0)),
    ] {
        let scene = scene(&format!("hull() {{ {text} }}"));
        let sampling = Sampling { rel_tol: 1e-11, ..Sampling::default() };
        let found = measure::adaptive(&scene, &sampling).expect("few leaves").value;
        let off = found / expected - 1.0;
        assert!(off.abs() < 1e-11, "{off:.1e}: {text}");
    }
}

/// The balls of a rounded box.
fn corners([x, y, z]: [f64; 3], radius: f64) -> String {
    let part = |i: u32, bit: u32, size: f64| if i & bit == 0 { 0.0 } else { size };
    let place = |i| [part(i, 1, x), part(i, 2, y), part(i, 4, z)];
    (0..8).map(|i| sphere(place(i), radius)).collect()
}

/// A rotation, exact, and a translation.
const TURNED: &str =
    "multmatrix([[0.36, 0.48, -0.8, 3], [-0.8, 0.6, 0, 5], [0.48, 0.64, 0.6, 7]])";

#[test]
fn hulls_have_the_volumes_of_closed_forms() {
    let (size, r) = ([10.0, 20.0, 5.0], 2.0);
    let rounded = rounded_box(size, r);
    // A right triangle with sides of 6, 8 and 10, within 1.
    let triangle = [[0.0; 3], [6.0, 0.0, 0.0], [0.0, 8.0, 0.0]].map(|p| sphere(p, 1.0));
    let of_triangle = 2.0 * 24.0 + PI / 2.0 * 24.0 + ball_volume(1.0);
    let circles = [[0.0; 3], [6.0, 0.0, 0.0], [0.0, 8.0, 0.0]];
    let each = |text: &str| circles.map(|p| at(p) + text).concat();
    let of_circles = 24.0 + 24.0 + PI;
    let cases = [
        (format!("hull() {{ {} }}", triangle.concat()), of_triangle),
        (format!("hull() {{ {} }}", corners(size, r)), rounded),
        (format!("{TURNED} hull() {{ {} }}", corners(size, r)), rounded),
        (format!("hull() {{ {TURNED} {{ {} }} }}", corners(size, r)), rounded),
        // A hull of hulls, colours and all.
        (
            format!(
                "hull() {{ hull() {{ {} }} color([1, 0, 0, 1]) {} }}",
                triangle[..2].concat(),
                triangle[2]
            ),
            of_triangle,
        ),
        (
            format!("linear_extrude(2) hull() {{ {} }}", each("circle(r = 1);")),
            2.0 * of_circles,
        ),
        (format!("hull() {{ {} }}", each("cylinder(r = 1, h = 2);")), 2.0 * of_circles),
        (
            format!(
                "hull() {{ {} multmatrix([[1,0,0,0],[0,1,0,0],[0,0,-1,2],[0,0,0,1]]) \
                 linear_extrude(2) polygon([[0, 0], [2, 2], [0, 8]]); }}",
                each("cylinder(r = 1, h = 2);")
            ),
            2.0 * of_circles,
        ),
        // Lying cylinders.
        (
            format!(
                "multmatrix([[0,0,1,0],[1,0,0,0],[0,1,0,0],[0,0,0,1]]) hull() {{ {} }}",
                each(
                    "multmatrix([[0,0,1,0],[1,0,0,0],[0,1,0,0],[0,0,0,1]]) \
                      multmatrix([[0,1,0,0],[0,0,1,0],[1,0,0,0],[0,0,0,1]]) \
                      cylinder(r = 1, h = 2);"
                )
            ),
            2.0 * of_circles,
        ),
    ];
    for (text, expected) in cases {
        let found = volume(&scene(&text), 1e-6);
        let off = found / expected - 1.0;
        assert!(off.abs() < 2e-6, "{off:.1e}: {text}");
    }
}

fn leaves(text: &str) -> usize {
    scene(text).leaf_count()
}

#[test]
fn hulls_have_no_more_leaves_than_they_need() {
    let count = |children: String| leaves(&format!("hull() {{ {children} }}"));
    // A polyhedron, twelve cylinders and eight balls.
    let rounded = corners([10.0, 20.0, 5.0], 2.0);
    assert_eq!(count(rounded.clone()), 21);
    assert_eq!(count(format!("{TURNED} {{ {rounded} }}")), 21);
    assert_eq!(count(rounded.clone() + &rounded), 21);
    assert_eq!(count(rounded + &sphere([3.0, 2.0, 1.0], 1.5)), 21);
    // Balls between others, in others and alone.
    let row: String = (0..5).map(|i| sphere([f64::from(i), 0.0, 0.0], 1.0)).collect();
    assert_eq!(count(row), 3);
    let drops: String = (0..5)
        .map(|i| sphere([0.0, 0.0, f64::from(i)], 1.0 + 0.5 * f64::from(i)))
        .collect();
    assert_eq!(count(drops), 3);
    assert_eq!(count(sphere([0.0; 3], 3.0) + &sphere([1.0, 0.0, 0.0], 2.0)), 1);
    assert_eq!(count(sphere([0.0; 3], 3.0) + "cube(1);"), 1);
    // Plates: discs and a prism.
    let circle = |x: f64, y: f64| at([x, y, 0.0]) + "circle(r = 1);";
    let plate = [circle(0.0, 0.0), circle(9.0, 0.0), circle(4.0, 0.0), circle(4.0, 9.0)];
    assert_eq!(leaves(&format!("linear_extrude(2) hull() {{ {} }}", plate.concat())), 4);
}

/// What becomes polygons or polyhedra anyway is one from the start.
#[test]
fn hulls_are_polyhedra_where_these_are_wanted() {
    let balls = sphere([0.0; 3], 1.0) + &sphere([9.0, 0.0, 0.0], 2.0);
    assert_eq!(leaves(&format!("minkowski() {{ hull() {{ {balls} }} cube(1); }}")), 1);
    let circles = "hull() { circle(r = 1); multmatrix([[1,0,0,9]]) circle(r = 2); }";
    let turned = format!("linear_extrude(1) offset(r = 1, $fn = 4) {circles}");
    assert_eq!(leaves(&turned), 1);
}

#[test]
fn other_hulls_are_polyhedra() {
    for text in [
        // A cone, an ellipsoid, a ball with a bite taken, cylinders of other heights.
        "hull() { cylinder(r1 = 2, r2 = 1, h = 3); cube(3); }",
        "hull() { multmatrix([[2,0,0,0],[0,1,0,0],[0,0,1,0]]) sphere(r = 1); cube(3); }",
        "hull() { difference() { sphere(r = 1); cube(1); } cube([3, 1, 1]); }",
        "hull() { cylinder(r = 1, h = 2); multmatrix([[1,0,0,9]]) cylinder(r = 1, h = 3); }",
        "hull() { cylinder(r = 1, h = 2); sphere(r = 3); }",
        "linear_extrude(1) hull() { multmatrix([[2,0,0,0]]) circle(r = 1); square(3); }",
        "linear_extrude(1) hull() { difference() { circle(r = 1); square(1); } square(3); }",
    ] {
        assert_eq!(leaves(text), 1, "{text}");
    }
}
