//! Shadows and sections of meshes: closed paths that wind around what is covered.

use std::collections::HashMap;

use glam::{DVec2, DVec3, Vec3Swizzles};

use crate::mesh::Mesh;

/// The outlines of the shadow on the plane z = 0 of light along the z-axis: the paths between
/// faces that look up and others. They wind around a point as often as there are such faces above
/// each other.
pub(crate) fn shadow(mesh: &Mesh) -> Vec<Vec<DVec2>> {
    let points = mesh.points();
    let looks_up = |face: &&[u32; 3]| {
        let [a, b, c] = face.map(|i| points[i as usize].xy());
        (b - a).perp_dot(c - a) > 0.0
    };
    let mut edges = Vec::new();
    for &[a, b, c] in mesh.faces().iter().filter(looks_up) {
        edges.extend([[a, b], [b, c], [c, a]]);
    }
    loops(&without_opposites(edges), |i| points[i as usize].xy())
}

/// The section with the plane z = 0, faces that lie in it included.
pub(crate) fn section(mesh: &Mesh) -> Vec<Vec<DVec2>> {
    // That just above the plane and that just below it.
    let mut paths = section_with(mesh, |z| z > 0.0);
    paths.extend(section_with(mesh, |z| z >= 0.0));
    paths
}

/// The section between points that are above and others.
fn section_with(mesh: &Mesh, is_above: fn(f64) -> bool) -> Vec<Vec<DVec2>> {
    let points = mesh.points();
    let above = |i: u32| is_above(points[i as usize].z);
    let mut numbers: HashMap<[u32; 2], u32> = HashMap::new();
    let mut crossings: Vec<DVec2> = Vec::new();
    let mut number = |low: u32, high: u32| {
        *numbers.entry([low, high]).or_insert_with(|| {
            crossings.push(crossing(points[low as usize], points[high as usize]));
            u32::try_from(crossings.len() - 1).unwrap_or(u32::MAX)
        })
    };
    let mut edges = Vec::new();
    for &[a, b, c] in mesh.faces() {
        // The inside is on the left on the way from the edge that goes down to that which goes up.
        let (mut down, mut up) = (None, None);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            match (above(from), above(to)) {
                (true, false) => down = Some(number(to, from)),
                (false, true) => up = Some(number(from, to)),
                (true, true) | (false, false) => {}
            }
        }
        if let (Some(down), Some(up)) = (down, up) {
            edges.push([down, up]);
        }
    }
    loops(&edges, |i| crossings[i as usize])
}

/// Where the plane crosses an edge.
fn crossing(low: DVec3, high: DVec3) -> DVec2 {
    let part = low.z / (low.z - high.z);
    low.xy() + (high.xy() - low.xy()) * part.clamp(0.0, 1.0)
}

/// Directed edges without those that are run along both ways.
fn without_opposites(mut edges: Vec<[u32; 2]>) -> Vec<[u32; 2]> {
    let line = |&[a, b]: &[u32; 2]| [a.min(b), a.max(b)];
    edges.sort_unstable_by_key(|edge| (line(edge), *edge));
    let mut left = Vec::new();
    for same in edges.chunk_by(|a, b| line(a) == line(b)) {
        let [low, high] = line(&same[0]);
        let ups = same.iter().filter(|edge| edge[0] == low).count();
        let downs = same.len() - ups;
        left.extend(std::iter::repeat_n([low, high], ups.saturating_sub(downs)));
        left.extend(std::iter::repeat_n([high, low], downs.saturating_sub(ups)));
    }
    left
}

/// The closed paths along directed edges, of which as many start in a corner as end there.
fn loops(edges: &[[u32; 2]], point: impl Fn(u32) -> DVec2) -> Vec<Vec<DVec2>> {
    let mut next: HashMap<u32, Vec<u32>> = HashMap::new();
    for &[from, to] in edges {
        next.entry(from).or_default().push(to);
    }
    let mut paths = Vec::new();
    for &[start, _] in edges {
        let (mut path, mut at) = (Vec::new(), start);
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            path.push(point(at));
            at = to;
        }
        if path.len() > 2 {
            paths.push(path);
        }
    }
    paths
}
