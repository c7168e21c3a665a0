//! Closed meshes.

use std::collections::HashMap;

use glam::{DAffine3, DVec3, dvec3};
use solidray::Mesh;

use super::dice::Dice;

/// A mesh of a convex solid around the origin: faces are turned outward here.
fn convex(points: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Mesh {
    let outward = |[a, b, c]: [u32; 3]| {
        let [p, q, r] = [a, b, c].map(|i| points[i as usize]);
        if p.dot(q.cross(r)) > 0.0 { [a, b, c] } else { [a, c, b] }
    };
    let faces = faces.into_iter().map(outward).collect();
    Mesh::new(points, faces).expect("a convex solid is closed")
}

/// All triples of points whose distances are `edge`.
fn regular(points: Vec<DVec3>, edge: f64) -> Mesh {
    let count = u32::try_from(points.len()).expect("few points");
    let near = |i: u32, j: u32| {
        (points[i as usize].distance(points[j as usize]) - edge).abs() < 1e-6
    };
    let mut faces = Vec::new();
    for i in 0..count {
        for j in i + 1..count {
            for k in j + 1..count {
                if near(i, j) && near(j, k) && near(i, k) {
                    faces.push([i, j, k]);
                }
            }
        }
    }
    convex(points, faces)
}

/// The regular tetrahedron on four corners of the cube from −1 to 1.
pub(crate) fn tetrahedron() -> Mesh {
    let corners =
        [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    regular(corners.map(DVec3::from_array).to_vec(), 8.0_f64.sqrt())
}

/// The regular octahedron with its corners on the axes.
pub(crate) fn octahedron() -> Mesh {
    let corners = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    regular(corners.collect(), 2.0_f64.sqrt())
}

/// The prism over a regular polygon of radius 1, from z = −1 to 1.
pub(crate) fn prism(sides: u32) -> Mesh {
    let point = |i: u32| {
        let (sin, cos) =
            (f64::from(i) / f64::from(sides) * std::f64::consts::TAU).sin_cos();
        [dvec3(cos, sin, -1.0), dvec3(cos, sin, 1.0)]
    };
    let points = (0..sides).flat_map(point).collect();
    let mut faces = Vec::new();
    for i in 0..sides {
        let j = (i + 1) % sides;
        faces.extend([[2 * i, 2 * j, 2 * j + 1], [2 * i, 2 * j + 1, 2 * i + 1]]);
        if i > 0 && j > 0 {
            faces.extend([[0, 2 * i, 2 * j], [1, 2 * i + 1, 2 * j + 1]]);
        }
    }
    convex(points, faces)
}

/// The icosahedron, its faces cut into four `levels` times, on the unit sphere.
pub(crate) fn icosphere(levels: u32) -> Mesh {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut points = Vec::new();
    for (x, y) in [(1.0, golden), (1.0, -golden), (-1.0, golden), (-1.0, -golden)] {
        points.extend([dvec3(0.0, x, y), dvec3(x, y, 0.0), dvec3(y, 0.0, x)]);
    }
    let mut mesh = regular(points, 2.0);
    for _ in 0..levels {
        mesh = quartered(&moved(&mesh, DVec3::normalize));
    }
    moved(&mesh, DVec3::normalize)
}

/// The same faces over other points.
fn moved(mesh: &Mesh, to: impl FnMut(DVec3) -> DVec3) -> Mesh {
    let points = mesh.points().iter().copied().map(to).collect();
    Mesh::new(points, mesh.faces().to_vec()).expect("the same faces are closed again")
}

/// The same solid, every face cut into four at the middles of its edges.
pub(crate) fn quartered(mesh: &Mesh) -> Mesh {
    let mut points = mesh.points().to_vec();
    let mut middles = HashMap::new();
    let mut faces = Vec::new();
    for &[a, b, c] in mesh.faces() {
        let mut middle = |i: u32, j: u32| {
            *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                points.push(0.5 * (points[i as usize] + points[j as usize]));
                u32::try_from(points.len() - 1).expect("few points")
            })
        };
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        faces.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    Mesh::new(points, faces).expect("halved edges match")
}

/// The same faces over points moved in or out at random.
pub(crate) fn jittered(mesh: &Mesh, amount: f64, seed: u64) -> Mesh {
    let mut dice = Dice::new(seed);
    moved(mesh, |p| p * (1.0 + dice.within(-amount, amount)))
}

/// The same faces over points moved to multiples of 2⁻²⁰, whose middles are numbers too.
pub(crate) fn rounded(mesh: &Mesh) -> Mesh {
    const GRID: f64 = (1_u32 << 20) as f64;
    moved(mesh, |p| (p * GRID).round() / GRID)
}

/// The same solid with its points and faces in another order, and the corners of each face
/// begun with another.
pub(crate) fn shuffled(mesh: &Mesh, seed: u64) -> Mesh {
    let mut dice = Dice::new(seed);
    let order = dice.order(mesh.points().len());
    let mut points = vec![DVec3::ZERO; order.len()];
    for (&to, &p) in order.iter().zip(mesh.points()) {
        points[to] = p;
    }
    let number = |i: u32| u32::try_from(order[i as usize]).expect("few points");
    let mut faces = vec![[0; 3]; mesh.faces().len()];
    for (to, face) in dice.order(faces.len()).into_iter().zip(mesh.faces()) {
        faces[to] = face.map(number);
        faces[to].rotate_left(dice.below(3));
    }
    Mesh::new(points, faces).expect("the same faces are closed")
}

/// The sphere of `rings` latitudes and `spokes` longitudes.
pub(crate) fn uv_sphere(spokes: u32, rings: u32) -> Mesh {
    let mut points = vec![DVec3::Z, -DVec3::Z];
    for ring in 1..rings {
        let (sin, cos) =
            (f64::from(ring) / f64::from(rings) * std::f64::consts::PI).sin_cos();
        for spoke in 0..spokes {
            let angle = f64::from(spoke) / f64::from(spokes) * std::f64::consts::TAU;
            points.push(dvec3(sin * angle.cos(), sin * angle.sin(), cos));
        }
    }
    let at = |ring: u32, spoke: u32| match ring {
        0 => 0,
        _ if ring == rings => 1,
        _ => 2 + (ring - 1) * spokes + spoke % spokes,
    };
    let mut faces = Vec::new();
    for ring in 0..rings {
        for spoke in 0..spokes {
            let (a, b) = (at(ring, spoke), at(ring, spoke + 1));
            let (c, d) = (at(ring + 1, spoke), at(ring + 1, spoke + 1));
            faces.extend(
                [[a, c, d], [a, d, b]]
                    .into_iter()
                    .filter(|[p, q, r]| p != q && q != r && r != p),
            );
        }
    }
    convex(points, faces)
}

/// The box between two corners, each face cut into `steps`² squares and those into two
/// triangles.
pub(crate) fn grid_box(min: DVec3, max: DVec3, steps: i32) -> Mesh {
    let mut numbers = HashMap::new();
    let mut points = Vec::new();
    let mut number = |cell: [i32; 3]| {
        *numbers.entry(cell).or_insert_with(|| {
            let part = DVec3::from_array(cell.map(f64::from)) / f64::from(steps);
            points.push(min + part * (max - min));
            u32::try_from(points.len() - 1).expect("few points")
        })
    };
    let mut faces = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for i in 0..steps {
            for j in 0..steps {
                let mut corner = |side: i32, di: i32, dj: i32| {
                    let mut cell = [0; 3];
                    (cell[axis], cell[u], cell[v]) = (side, i + di, j + dj);
                    number(cell)
                };
                let mut square = |side: i32| {
                    [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(di, dj)| corner(side, di, dj))
                };
                let [a, b, c, d] = square(steps);
                faces.extend([[a, b, c], [a, c, d]]);
                let [a, b, c, d] = square(0);
                faces.extend([[a, c, b], [a, d, c]]);
            }
        }
    }
    Mesh::new(points, faces).expect("a grid on a box is closed")
}

/// Two cubes of edge 1 that touch at the origin and have `shared` points in common: one
/// for a corner, two for an edge along z.
pub(crate) fn touching_cubes(shared: usize) -> Mesh {
    let low = if shared == 1 { -DVec3::ONE } else { dvec3(-1.0, -1.0, 0.0) };
    let (a, b) =
        (grid_box(DVec3::ZERO, DVec3::ONE, 1), grid_box(low, low + DVec3::ONE, 1));
    let mut points = a.points().to_vec();
    let mut number = |p: DVec3| {
        let found = points.iter().position(|&q| q == p).unwrap_or_else(|| {
            points.push(p);
            points.len() - 1
        });
        u32::try_from(found).expect("few points")
    };
    let moved = b.faces().iter().map(|face| face.map(|i| number(b.points()[i as usize])));
    let faces: Vec<[u32; 3]> = a.faces().iter().copied().chain(moved).collect();
    assert_eq!(points.len(), 16 - shared);
    Mesh::new(points, faces).expect("two closed meshes are one")
}

/// Two cubes of edge 1, one upon the other, each with a face of its own between them.
pub(crate) fn stacked_cubes() -> Mesh {
    let (low, high) = (grid_box(DVec3::ZERO, DVec3::ONE, 2), dvec3(1.0, 1.0, 2.0));
    let top = grid_box(DVec3::Z, high, 2);
    let first = u32::try_from(low.points().len()).expect("few points");
    let points = [low.points(), top.points()].concat();
    let moved = top.faces().iter().map(|face| face.map(|i| i + first));
    let faces = low.faces().iter().copied().chain(moved).collect();
    Mesh::new(points, faces).expect("two closed meshes are one")
}

/// The same solid with a second corner beside one end of every edge, at this part of its
/// length: faces become needles, or have no area at all if the part is zero.
pub(crate) fn with_slivers(mesh: &Mesh, part: f64) -> Mesh {
    let mut points = mesh.points().to_vec();
    let mut doubled = HashMap::new();
    let mut faces = Vec::new();
    for &face in mesh.faces() {
        let mut ring = Vec::new();
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let (a, b) = (face[i], face[j]);
            let (low, high) = (a.min(b), a.max(b));
            let near = *doubled.entry((low, high)).or_insert_with(|| {
                let p = points[low as usize];
                points.push(p + part * (points[high as usize] - p));
                u32::try_from(points.len() - 1).expect("few points")
            });
            ring.extend([a, near]);
        }
        let [a, ab, b, bc, c, ca] = ring[..] else { unreachable!("three edges") };
        faces.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    Mesh::new(points, faces).expect("cut edges match")
}

/// A tetrahedron `length` long and 1 wide.
pub(crate) fn needle(length: f64) -> Mesh {
    mapped(&tetrahedron(), &DAffine3::from_scale(dvec3(length, 1.0, 1.0)))
}

/// The image of a mesh under a map that is not mirrored.
pub(crate) fn mapped(mesh: &Mesh, map: &DAffine3) -> Mesh {
    moved(mesh, |p| map.transform_point3(p))
}
