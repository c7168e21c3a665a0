//! Convex hulls of points (C. Barber, D. Dobkin, H. Huhdanpaa, "The quickhull algorithm for convex
//! hulls", 1996).
//!
//! Whether a point is above a face is decided exactly, and one in its plane is not. So hulls are
//! right for any points, also many in few planes or nearly all in one. (Manifold's hull takes
//! points within a ten-millionth of the size for points on a face: of a plate that is a ten-thousandth
//! as high as wide the volume is wrong in the third digit.)

use std::collections::HashMap;

use glam::DVec3;
use robust::{Coord3D, orient3d};

/// A triangle of the hull so far.
struct Face {
    corners: [u32; 3],
    /// The faces beyond the edges that start in each corner.
    beyond: [usize; 3],
    /// Points above it that are above no face before it in the order in which they were tried.
    above: Vec<u32>,
    is_left: bool,
}

/// The triangles of the hull of points, counter-clockwise seen from outside; none if all points
/// are in a plane.
pub(super) fn faces(points: &[DVec3]) -> Vec<[u32; 3]> {
    let Some(start) = tetrahedron(points) else { return Vec::new() };
    let mut hull = Hull { points, faces: Vec::new() };
    for corners in start {
        hull.faces.push(Face {
            corners,
            beyond: [0; 3],
            above: Vec::new(),
            is_left: true,
        });
    }
    hull.connect(&[0, 1, 2, 3]);
    let all = (0..).take(points.len()).collect();
    hull.share(all, &[0, 1, 2, 3]);
    let mut open: Vec<usize> = vec![0, 1, 2, 3];
    while let Some(number) = open.pop() {
        let face = &hull.faces[number];
        if !face.is_left {
            continue;
        }
        let height = |&&i: &&u32| hull.height(number, i);
        let by_height = |a: &&u32, b: &&u32| height(a).total_cmp(&height(b));
        if let Some(&highest) = face.above.iter().max_by(by_height) {
            open.extend(hull.add(highest, number));
        }
    }
    hull.faces.iter().filter(|face| face.is_left).map(|face| face.corners).collect()
}

struct Hull<'a> {
    points: &'a [DVec3],
    faces: Vec<Face>,
}

impl Hull<'_> {
    /// How high a point is above a face, times a size of the face; of the right sign.
    fn height(&self, face: usize, point: u32) -> f64 {
        let [a, b, c] = self.faces[face].corners.map(|i| self.points[i as usize]);
        height(a, b, c, self.points[point as usize])
    }

    /// Adds a point above a face: faces that it is above give way to those between it and their
    /// outline. These are returned.
    fn add(&mut self, point: u32, from: usize) -> Vec<usize> {
        let (mut orphans, mut outline) = (Vec::new(), Vec::new());
        let mut hidden: HashMap<usize, bool> = HashMap::from([(from, true)]);
        let mut open = vec![from];
        while let Some(number) = open.pop() {
            self.faces[number].is_left = false;
            orphans.append(&mut self.faces[number].above);
            for i in 0..3 {
                let beyond = self.faces[number].beyond[i];
                let is_hidden = match hidden.get(&beyond) {
                    Some(is_hidden) => *is_hidden,
                    None => {
                        let is_hidden = self.height(beyond, point) > 0.0;
                        hidden.insert(beyond, is_hidden);
                        if is_hidden {
                            open.push(beyond);
                        }
                        is_hidden
                    }
                };
                if !is_hidden {
                    let corners = self.faces[number].corners;
                    outline.push(([corners[i], corners[(i + 1) % 3]], beyond));
                }
            }
        }
        let mut touched: Vec<usize> = Vec::with_capacity(2 * outline.len());
        let mut made = Vec::with_capacity(outline.len());
        for ([a, b], beyond) in outline {
            made.push(self.faces.len());
            touched.push(beyond);
            self.faces.push(Face {
                corners: [a, b, point],
                beyond: [beyond; 3],
                above: Vec::new(),
                is_left: true,
            });
        }
        touched.extend(&made);
        self.connect(&touched);
        orphans.retain(|&i| i != point);
        self.share(orphans, &made);
        made
    }

    /// Tells faces about each other where they share edges.
    fn connect(&mut self, faces: &[usize]) {
        let mut sides: HashMap<[u32; 2], usize> = HashMap::new();
        for &face in faces {
            let [a, b, c] = self.faces[face].corners;
            sides.extend([([a, b], face), ([b, c], face), ([c, a], face)]);
        }
        for &face in faces {
            let corners = self.faces[face].corners;
            for i in 0..3 {
                let opposite = [corners[(i + 1) % 3], corners[i]];
                if let Some(&beyond) = sides.get(&opposite) {
                    self.faces[face].beyond[i] = beyond;
                }
            }
        }
    }

    /// Gives points to the first of some faces that they are above.
    fn share(&mut self, points: Vec<u32>, faces: &[usize]) {
        for point in points {
            let face = faces.iter().find(|&&face| self.height(face, point) > 0.0);
            if let Some(&face) = face {
                self.faces[face].above.push(point);
            }
        }
    }
}

/// Positive where d is above the triangle a b c: on the side from which it is counter-clockwise.
fn height(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|DVec3 { x, y, z }| Coord3D { x, y, z });
    -orient3d(a, b, c, d)
}

/// The faces of a large tetrahedron of points; `None` if they are in a plane.
fn tetrahedron(points: &[DVec3]) -> Option<[[u32; 3]; 4]> {
    let farthest = |distance: &dyn Fn(DVec3) -> f64| {
        let by_distance = |a: &(u32, &DVec3), b: &(u32, &DVec3)| {
            distance(*a.1).total_cmp(&distance(*b.1))
        };
        (0..).zip(points).max_by(by_distance).map(|(i, p)| (i, *p))
    };
    let (i, a) = farthest(&|p| -p.x)?;
    let (j, b) = farthest(&|p| p.distance_squared(a))?;
    let (k, c) = farthest(&|p| (p - a).cross(b - a).length_squared())?;
    let (l, d) = farthest(&|p| height(a, b, c, p).abs())?;
    let (j, k) = match height(a, b, c, d) {
        h if h < 0.0 => (j, k),
        h if h > 0.0 => (k, j),
        _ => return None,
    };
    Some([[i, j, k], [i, l, j], [j, l, k], [k, l, i]])
}
