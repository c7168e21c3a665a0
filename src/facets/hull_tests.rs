//! Hulls and sums against their definitions.

use glam::DVec3;
use robust::{Coord3D, orient3d};

use super::{Operand, hull, sum};
use crate::mesh::{Mesh, round};
use crate::support::dice::Dice;
use crate::{Op, Scene, Solid};

/// The sign of the volume of a tetrahedron: positive where d is above the triangle a b c.
fn above(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|DVec3 { x, y, z }| Coord3D { x, y, z });
    -orient3d(a, b, c, d)
}

/// The volume of a hull from its supporting planes, found by trying all triangles.
fn volume_by_planes(points: &[DVec3]) -> f64 {
    let n = points.len();
    let center = points.iter().sum::<DVec3>() / n as f64;
    let mut sixth = 0.0;
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                let (a, b, c) = (points[i], points[j], points[k]);
                if i == j || j == k || i == k || (b - a).cross(c - a) == DVec3::ZERO {
                    continue;
                }
                let sides: Vec<f64> = points.iter().map(|&p| above(a, b, c, p)).collect();
                if sides.iter().any(|s| *s > 0.0) {
                    continue;
                }
                let normal = (b - a).cross(c - a).normalize();
                let flat: Vec<usize> = (0..n).filter(|&l| sides[l] == 0.0).collect();
                // An edge of the face: all that is in its plane is on its left and not on it
                // beyond its ends; fans from the first corner of each.
                let edge = (b - a).normalize();
                let is_edge = flat.iter().all(|&l| {
                    let p = points[l] - a;
                    let side = edge.cross(p).dot(normal);
                    let along = p.dot(edge);
                    let room = 1e-9 * (b - a).length();
                    side > room
                        || (side > -room
                            && (-room..=(b - a).length() + room).contains(&along))
                });
                // Once only: with the first corner that is not on the edge.
                let room = 1e-9 * (b - a).length();
                let is_beside = |&&l: &&usize| edge.cross(points[l] - a).length() > room;
                let is_first = flat.iter().find(is_beside);
                if is_edge && is_first == Some(&k) {
                    let middle = flat.iter().map(|&l| points[l]).sum::<DVec3>()
                        / flat.len() as f64;
                    sixth += (a - center).dot((b - center).cross(middle - center));
                }
            }
        }
    }
    sixth / 6.0
}

/// That a hull has all points inside and none but these as corners; by how much of its size a
/// point is outside.
fn assert_hull(points: &[DVec3], hull: &Mesh) -> f64 {
    for corner in hull.points() {
        assert!(points.contains(corner), "{corner} is none of the points");
    }
    let size = hull.bounds().size().max_element();
    let mut worst: f64 = 0.0;
    for i in 0..hull.faces().len() {
        let [a, b, c] = hull.corners(i);
        let normal = (b - a).cross(c - a);
        // The height of a sliver has no digits.
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        if normal.length() < 1e-9 * longest * size {
            continue;
        }
        let normal = normal.normalize();
        for p in points {
            worst = worst.max((*p - a).dot(normal) / size);
        }
    }
    worst
}

#[test]
fn hulls_hold_all_points_and_no_more() {
    let mut dice = Dice::new(1);
    let mut worst: f64 = 0.0;
    for case in 0..600 {
        let count = 5 + case % 12;
        let turn = dice.rotation();
        let points: Vec<DVec3> = (0..count)
            .map(|_| {
                let p = dice.point(1.0);
                match case % 6 {
                    0 => p,
                    // Points of a grid, many of them the same or in a plane.
                    1 => (1.5 * p).round(),
                    2 => turn * (2.0 * p).round(),
                    3 => turn * (p * DVec3::new(1.0, 1.0, 1e-5)),
                    4 => p.normalize() + DVec3::splat(100.0),
                    _ => 1e-3 * DVec3::new(p.x.round(), p.y, p.z.round()),
                }
            })
            .collect();
        let mut different = points.clone();
        different.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap());
        different.dedup();
        let expected = volume_by_planes(&different);
        let found = hull(&points).unwrap();
        let volume = found.as_ref().map_or(0.0, Mesh::volume);
        let size = points.iter().map(|p| p.distance(points[0])).fold(0.0, f64::max);
        assert!(
            (volume - expected).abs() <= 1e-9 * expected + 1e-14 * size.powi(3),
            "case {case}: {volume}, not {expected}: {points:?}"
        );
        if let Some(found) = found {
            worst = worst.max(assert_hull(&points, &found));
        }
    }
    assert!(worst < 1e-9, "a point is outside by {worst:e}");
}

/// Boxes full of points, prisms, balls, turned and moved so that nothing is round.
#[test]
fn hulls_of_many_points_in_few_planes() {
    let turn = Dice::new(3).rotation();
    let grid = || {
        (0..1000).map(|i| {
            DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100))
        })
    };
    let ball = round::ball(96, 3.0).unwrap();
    let prism = round::frustum(200, [3.0, 3.0], [0.0, 1.0]).unwrap();
    let cone = round::frustum(200, [3.0, 0.0], [0.0, 1e-4]).unwrap();
    let volume = |m: &Mesh| m.volume();
    let cases: Vec<(Vec<DVec3>, f64)> = vec![
        (grid().collect(), 729.0),
        (ball.points().to_vec(), volume(&ball)),
        (prism.points().to_vec(), volume(&prism)),
        (cone.points().to_vec(), volume(&cone)),
        (
            prism
                .points()
                .iter()
                .flat_map(|p| grid().map(move |q| *p + q))
                .step_by(7)
                .collect(),
            f64::NAN,
        ),
    ];
    for (points, expected) in cases {
        for place in 0..3 {
            let moved: Vec<DVec3> = points
                .iter()
                .map(|&p| match place {
                    0 => p,
                    1 => turn * p,
                    _ => turn * p + DVec3::new(100.0, 20.0, 3.0),
                })
                .collect();
            let found = hull(&moved).unwrap().unwrap();
            let off = assert_hull(&moved, &found);
            assert!(off < 1e-9, "{off:e} at {place}");
            let error = found.volume() / expected - 1.0;
            assert!(expected.is_nan() || error.abs() < 1e-9, "{error:e} at {place}");
        }
    }
    assert_eq!(hull(&[]).unwrap(), None);
    let flat: Vec<DVec3> = grid().take(100).collect();
    assert_eq!(hull(&flat).unwrap(), None);
    assert_eq!(hull(&vec![DVec3::ONE; 9]).unwrap(), None);
    assert_eq!(hull(&[DVec3::ZERO, DVec3::X, DVec3::Y]).unwrap(), None);
}

/// Where it is known which cells a sum has: those from the sum of two cells' numbers to one more,
/// along all axes.
#[test]
fn sums_of_bodies_of_cells_are_bodies_of_cells() {
    let mut dice = Dice::new(2);
    for _ in 0..12 {
        let [a, b] = [3, 2].map(|side: u32| {
            let mut cells = Vec::new();
            for i in 0..side.pow(3) {
                if dice.below(10) < 7 {
                    cells.push([i % side, i / side % side, i / side / side]);
                }
            }
            cells
        });
        let body = |cells: &[[u32; 3]]| {
            let mut solid = Solid::empty();
            for c in cells {
                let low = DVec3::from_array(c.map(f64::from));
                solid = solid + Solid::cuboid_between(low, low + 1.0);
            }
            let faceted = crate::facets::faceted(&solid, 8, 1 << 20).unwrap();
            crate::facets::boundary(&faceted, &crate::unwatched).unwrap()
        };
        let (Some(p), Some(q)) = (body(&a), body(&b)) else { continue };
        let shift = DVec3::new(10.0, -20.0, 5.0);
        let q = Mesh::new(
            q.points().iter().map(|p| *p + shift).collect(),
            q.faces().to_vec(),
        );
        let operands = [p, q.unwrap()].map(|m| Operand::new(m).unwrap());
        let meshes = sum(&operands[0], &operands[1]).unwrap();
        let all = Solid::boolean(Op::Union, meshes.into_iter().map(Solid::mesh));
        let scene = Scene::compile(&all).unwrap();
        for i in 0..7_u32.pow(3) {
            let cell = [i % 7, i / 7 % 7, i / 49];
            let expected = a.iter().any(|a| {
                b.iter().any(|b| {
                    (0..3).all(|k| {
                        (0..2).contains(&(i64::from(cell[k]) - i64::from(a[k] + b[k])))
                    })
                })
            });
            let p = shift
                + DVec3::from_array(cell.map(f64::from))
                + DVec3::new(0.4, 0.53, 0.61);
            assert_eq!(scene.contains(p), expected, "{cell:?} of {a:?} and {b:?}");
        }
    }
}
