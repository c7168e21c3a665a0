//! Polygons become triangles: outlines with holes, concave faces, tangles.

use glam::{DVec2, DVec3, dvec2, dvec3};
use proptest::prelude::*;
use solidray::{Mesh, MeshError};

fn square(x: f64, y: f64, side: f64) -> Vec<DVec2> {
    vec![dvec2(x, y), dvec2(x + side, y), dvec2(x + side, y + side), dvec2(x, y + side)]
}

fn area(paths: &[Vec<DVec2>]) -> f64 {
    match Mesh::prism(paths, 0.0, 1.0) {
        Ok(mesh) => mesh.volume(),
        Err(MeshError::NoFaces) => 0.0,
        Err(error) => panic!("{error}"),
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * (a.abs() + b.abs())
}

#[test]
fn paths_fill_by_parity() {
    let (outer, hole, island) =
        (square(0.0, 0.0, 10.0), square(2.0, 2.0, 6.0), square(4.0, 4.0, 2.0));
    assert!(close(area(std::slice::from_ref(&outer)), 100.0));
    assert!(close(area(&[outer.clone(), hole.clone()]), 64.0));
    assert!(close(area(&[outer.clone(), hole.clone(), island]), 68.0));
    let mut turned = hole;
    turned.reverse();
    assert!(close(area(&[outer.clone(), turned]), 64.0));
    assert!(close(area(&[outer.clone(), square(5.0, 5.0, 10.0)]), 150.0));
    assert!(close(area(&[outer.clone(), square(10.0, 0.0, 10.0)]), 200.0));
    assert!(close(area(&[outer.clone(), square(10.0, 10.0, 10.0)]), 200.0));
    assert!(close(area(&[outer.clone(), outer.clone()]), 0.0));
    let twice = [outer.clone(), outer].concat();
    assert!(close(area(&[twice]), 0.0));
}

#[test]
fn a_bow_tie_is_two_triangles() {
    let bow = [[0.0, 0.0], [10.0, 10.0], [10.0, 0.0], [0.0, 10.0]].map(DVec2::from);
    assert!(close(area(&[bow.to_vec()]), 50.0));
}

/// The star {n/k} drawn in one stroke with k near n/2 has about n²/2 crossings.
#[test]
fn a_star_in_one_stroke_is_filled() {
    let corner = |i: usize| DVec2::from_angle(std::f64::consts::TAU * i as f64 / 41.0);
    let star: Vec<DVec2> = (0..41).map(|i| corner(i * 20 % 41)).collect();
    let filled = area(&[star]);
    assert!(filled > 0.5 && filled < std::f64::consts::PI, "{filled}");
}

/// A path through so many points, each anywhere in a square.
fn scribble(points: u64) -> Vec<DVec2> {
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..points).map(|_| dvec2(next(), next())).collect()
}

#[test]
fn a_scribble_is_filled_or_refused_soon() {
    for points in [150, 300] {
        let filled = area(&[scribble(points)]);
        assert!(filled > 0.3 && filled < 0.6, "{filled}");
    }
    for points in [3_000, 40_000] {
        let start = std::time::Instant::now();
        let refused = Mesh::prism(&[scribble(points)], 0.0, 1.0).unwrap_err();
        assert!(matches!(refused, MeshError::Tangled { .. }));
        // Two seconds at most on an idle machine; minutes if nothing bounds the work.
        assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
    }
}

#[test]
fn sizes_do_not_matter() {
    for scale in [1e-300, 1e-100, 1e-9, 1e9, 1e90] {
        let bow = [[0.0, 0.0], [10.0, 10.0], [10.0, 0.0], [0.0, 10.0]]
            .map(|p| scale * DVec2::from(p));
        let mesh = Mesh::prism(&[bow.to_vec()], 0.0, 1.0).unwrap();
        assert_eq!(mesh.faces().len(), 2 * 2 + 6 * 2, "at scale {scale}");
    }
    let refused = Mesh::prism(&[vec![dvec2(f64::NAN, 0.0)]], 0.0, 1.0).unwrap_err();
    assert!(matches!(refused, MeshError::NotFinite { .. }));
}

#[test]
fn lines_and_points_fill_nothing() {
    for path in
        [vec![], vec![DVec2::ZERO; 4], vec![DVec2::ZERO, DVec2::X, 2.0 * DVec2::X]]
    {
        assert_eq!(Mesh::prism(&[path], 0.0, 1.0), Err(MeshError::NoFaces));
    }
}

/// An L-shaped prism given by hexagons and quads.
fn bracket() -> (Vec<DVec3>, Vec<Vec<u32>>) {
    let outline = [[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]];
    let level = |z: f64| outline.map(|[x, y]| dvec3(f64::from(x), f64::from(y), z));
    let points = [level(0.0), level(2.0)].concat();
    let mut faces = vec![(0..6).rev().collect(), (6..12).collect()];
    faces.extend((0..6).map(|i| vec![i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6]));
    (points, faces)
}

#[test]
fn concave_faces_are_covered_once() {
    let (points, faces) = bracket();
    for turn in 0..6 {
        // The fan of some corners of an L is not inside it; any start must give the L.
        let mut faces = faces.clone();
        faces[0].rotate_left(turn);
        faces[1].rotate_left(turn);
        let mesh = Mesh::from_polygons(points.clone(), &faces).unwrap();
        assert!(close(mesh.volume(), 12.0));
        for f in &mesh.faces()[..8] {
            let [a, b, c] = f.map(|i| mesh.points()[i as usize]);
            let area = (b - a).cross(c - a).z;
            assert!(if f[0] < 6 { area < 0.0 } else { area > 0.0 }, "{f:?}");
        }
    }
}

#[test]
fn faults_of_faces_are_named() {
    let (points, mut faces) = bracket();
    faces[3] = vec![1, 2];
    let error = Mesh::from_polygons(points.clone(), &faces).unwrap_err();
    assert_eq!(
        error.to_string(),
        "face 3 has 2 corners; faces are counted from 0 and have at least 3"
    );
    faces[3] = vec![1, 2, 99];
    let error = Mesh::from_polygons(points, &faces).unwrap_err();
    assert_eq!(error.to_string(), "face 3 names point 99, but there are 12 points");
}

#[test]
fn faces_that_touch_themselves_keep_a_mesh_closed() {
    // The top of a cube with a spike run along twice, and one that repeats a corner.
    let cube = |top: Vec<u32>| {
        let mut points: Vec<DVec3> = (0..8)
            .map(|i| {
                let (x, y) = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)][i % 4];
                dvec3(x, y, if i < 4 { 0.0 } else { 1.0 })
            })
            .collect();
        points.push(dvec3(0.5, 0.5, 1.0));
        let mut faces = vec![vec![3, 2, 1, 0], top];
        faces.extend((0..4).map(|i| vec![i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4]));
        Mesh::from_polygons(points, &faces).unwrap().volume()
    };
    assert!(close(cube(vec![4, 5, 6, 7]), 1.0));
    assert!(close(cube(vec![4, 8, 4, 5, 6, 7]), 1.0));
    assert!(close(cube(vec![4, 4, 5, 6, 6, 7, 4]), 1.0));
}

/// The even-odd rule, point by point.
fn odd(paths: &[Vec<DVec2>], p: DVec2) -> bool {
    let mut inside = false;
    for path in paths {
        for (i, &a) in path.iter().enumerate() {
            let b = path[(i + 1) % path.len()];
            if (a.y > p.y) != (b.y > p.y) {
                inside ^= p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
            }
        }
    }
    inside
}

proptest! {
    /// Tangled paths on a small lattice: crossings, overlaps and repeats abound.
    #[test]
    fn the_fill_is_where_the_parity_is_odd(
        paths in prop::collection::vec(
            prop::collection::vec((0_u8..7, 0_u8..7), 1..12), 1..4),
    ) {
        let paths: Vec<Vec<DVec2>> = paths
            .iter()
            .map(|p| p.iter().map(|&(x, y)| dvec2(f64::from(x), f64::from(y))).collect())
            .collect();
        let mesh = match Mesh::prism(&paths, 0.0, 1.0) {
            Err(MeshError::NoFaces) => None,
            other => Some(other.unwrap()),
        };
        let filled = |p: DVec2| mesh.iter().any(|mesh| mesh.faces().iter().any(|f| {
            let [a, b, c] = f.map(|i| mesh.points()[i as usize]);
            let left = |a: DVec3, b: DVec3| (b - a).truncate().perp_dot(p - a.truncate()) > 0.0;
            f.iter().all(|&i| mesh.points()[i as usize].z > 0.5) && left(a, b) && left(b, c) && left(c, a)
        }));
        for x in 0..12 {
            for y in 0..12 {
                // No edge of the lattice, and no line between crossings of two of them
                // that matters, comes near these points.
                let p = dvec2(f64::from(x) / 2.0 + 0.2371, f64::from(y) / 2.0 + 0.2719);
                prop_assert_eq!(filled(p), odd(&paths, p), "at {}", p);
            }
        }
    }

    #[test]
    fn no_numbers_make_it_fail(
        path in prop::collection::vec(
            (prop::num::f64::ANY, prop::num::f64::ANY), 0..9),
    ) {
        let path: Vec<DVec2> = path.into_iter().map(DVec2::from).collect();
        let _ = Mesh::prism(&[path], 0.0, 1.0);
    }
}
