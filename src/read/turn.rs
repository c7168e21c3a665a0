//! Bodies of a mesh that are inside out, although the mesh as a whole is not.
//!
//! Inside is where a mesh winds around a point a positive number of times, so a body wound
//! the wrong way would vanish without a word next to one wound the right way. Only a
//! cavity may have a negative volume: a body that lies within an odd number of others. One
//! within none, or within a cavity, is turned.

use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

/// Turns the bodies that are inside out; whether there were any. The faces are closed.
///
/// Bodies are what hangs together by edges. A mesh of negative volume is turned as a whole
/// first, since its cavities are most likely as wrong as its shells.
pub(super) fn turn(points: &[DVec3], faces: &mut [[u32; 3]]) -> bool {
    let bodies = Bodies::new(points, faces);
    let whole = bodies.list.iter().map(|body| body.volume).sum::<f64>() < 0.0;
    let wrong = bodies.wrong(points, faces, whole);
    for (face, &body) in faces.iter_mut().zip(&bodies.of_face) {
        if whole != wrong[body as usize] {
            face.swap(1, 2);
        }
    }
    whole || wrong.contains(&true)
}

/// What hangs together by edges.
struct Bodies {
    of_face: Vec<u32>,
    list: Vec<Body>,
}

struct Body {
    /// Its first face.
    face: u32,
    /// Six times the volume, measured from a point of the body, and what rounding may have
    /// done to it.
    volume: f64,
    error: f64,
}

impl Bodies {
    fn new(points: &[DVec3], faces: &[[u32; 3]]) -> Self {
        let root = connected(faces);
        let mut number = vec![u32::MAX; faces.len()];
        let mut bodies = Self { of_face: Vec::with_capacity(faces.len()), list: vec![] };
        for ((index, face), root) in (0_u32..).zip(faces).zip(root) {
            let body = &mut number[root as usize];
            if *body == u32::MAX {
                *body = u32::try_from(bodies.list.len()).unwrap_or(u32::MAX);
                bodies.list.push(Body { face: index, volume: 0.0, error: 0.0 });
            }
            bodies.of_face.push(*body);
            let body = &mut bodies.list[*body as usize];
            let corner = |i: u32| points[i as usize];
            let base = corner(faces[body.face as usize][0]);
            let [a, b, c] = face.map(|i| corner(i) - base);
            let part = a.dot(b.cross(c));
            body.volume += part;
            body.error += 1e-12 * part.abs();
        }
        bodies
    }

    /// Which bodies are inside out, after the mesh has been turned as a whole if it was.
    fn wrong(&self, points: &[DVec3], faces: &[[u32; 3]], whole: bool) -> Vec<bool> {
        let is_negative =
            |body: &&Body| (if whole { -body.volume } else { body.volume }) < -body.error;
        let mut wrong: Vec<bool> =
            self.list.iter().map(|body| is_negative(&body)).collect();
        let asked: Vec<(u32, DVec3)> = (0_u32..)
            .zip(&self.list)
            .filter(|(_, body)| is_negative(body))
            .map(|(index, body)| (index, center(points, faces[body.face as usize])))
            .collect();
        if !asked.is_empty() && self.list.len() > 1 {
            for body in self.within_odd(points, faces, asked) {
                wrong[body as usize] = false;
            }
        }
        wrong
    }

    /// The bodies whose points lie within an odd number of other bodies, however those
    /// are wound.
    ///
    /// Faces straight above a point are counted, for all points in one pass over the
    /// faces; sorted by x, few points are looked at for each of them.
    fn within_odd(
        &self,
        points: &[DVec3],
        faces: &[[u32; 3]],
        mut asked: Vec<(u32, DVec3)>,
    ) -> Vec<u32> {
        asked.sort_by(|a, b| a.1.x.total_cmp(&b.1.x));
        let mut above: Vec<(u32, u32, i32)> = Vec::new();
        for (face, &around) in faces.iter().zip(&self.of_face) {
            let corners = face.map(|i| points[i as usize]);
            let [a, b, c] = corners;
            let (min, max) = (a.min(b).min(c), a.max(b).max(c));
            let start = asked.partition_point(|(_, p)| p.x < min.x);
            let near = asked[start..].iter().take_while(|(_, p)| p.x <= max.x);
            for &(body, p) in near {
                if body != around && p.y >= min.y && p.y <= max.y && p.z <= max.z {
                    match crossing(corners, p) {
                        0 => {}
                        sense => above.push((body, around, sense)),
                    }
                }
            }
        }
        above.sort_unstable();
        let windings = above.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
        let around: Vec<u32> = windings
            .filter(|chunk| chunk.iter().map(|c| c.2).sum::<i32>() != 0)
            .map(|chunk| chunk[0].0)
            .collect();
        let counts = around.chunk_by(|a, b| a == b);
        counts.filter(|c| c.len() % 2 == 1).map(|c| c[0]).collect()
    }
}

/// For each face another of the same body, the same for all: the body's root.
fn connected(faces: &[[u32; 3]]) -> Vec<u32> {
    let mut edges: Vec<([u32; 2], u32)> = (0_u32..)
        .zip(faces)
        .flat_map(|(face, &[a, b, c])| [[a, b], [b, c], [c, a]].map(|e| (e, face)))
        .map(|([a, b], face)| ([a.min(b), a.max(b)], face))
        .collect();
    edges.sort_unstable();
    let mut parent: Vec<u32> = (0_u32..).zip(faces).map(|(face, _)| face).collect();
    for pair in edges.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        let [a, b] = [pair[0].1, pair[1].1].map(|face| root(&mut parent, face));
        parent[a.max(b) as usize] = a.min(b);
    }
    // Roots come before what hangs on them, so one pass from the front reaches all.
    for face in 0..parent.len() {
        parent[face] = parent[parent[face] as usize];
    }
    parent
}

/// The root of a face, halving the way there for the next time.
fn root(parent: &mut [u32], mut face: u32) -> u32 {
    while parent[face as usize] != face {
        parent[face as usize] = parent[parent[face as usize] as usize];
        face = parent[face as usize];
    }
    face
}

fn center(points: &[DVec3], face: [u32; 3]) -> DVec3 {
    face.iter().map(|&i| points[i as usize] / 3.0).sum()
}

/// Whether a triangle is above a point, and which way it is wound there: ±1, or 0.
///
/// Of two triangles that share an edge above the point exactly one counts, because each
/// edge says the same to both whether the point is left or right of it.
fn crossing(corners: [DVec3; 3], p: DVec3) -> i32 {
    let flat = |p: DVec3| Coord { x: p.x, y: p.y };
    let solid = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    let [a, b, c] = corners;
    let mut winding = 0;
    for (from, to) in [(a, b), (b, c), (c, a)] {
        if (from.y > p.y) == (to.y > p.y) {
            continue;
        }
        let (low, high, sense) =
            if from.y < to.y { (from, to, 1) } else { (to, from, -1) };
        if orient2d(flat(low), flat(high), flat(p)) > 0.0 {
            winding += sense;
        }
    }
    // Positive below a triangle that is counter-clockwise seen from above, negative below
    // one that is clockwise.
    let side = orient3d(solid(a), solid(b), solid(c), solid(p));
    if f64::from(winding) * side > 0.0 { winding } else { 0 }
}
