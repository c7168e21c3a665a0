//! How far two answers are apart.

use glam::DVec3;
use solidray::{Mesh, Ray, Span};

/// How far two lists of spans of one ray are apart, in units in the last place of the
/// coordinates at hand.
///
/// A stretch that only one of them covers counts with its length or with its distance from
/// the surface, whichever is less: a surface that rounding moves by a little moves a crossing
/// by much more if the ray is almost parallel to it.
pub(crate) fn disagreement(mesh: &Mesh, ray: &Ray, a: &[Span], b: &[Span]) -> f64 {
    let bounds = mesh.bounds();
    let reach = bounds.min.abs().max(bounds.max.abs()).max(ray.origin.abs());
    let unit = f64::EPSILON * reach.max_element();
    let mut ends: Vec<f64> =
        a.iter().chain(b).flat_map(|span| [span.enter.t, span.exit.t]).collect();
    ends.sort_by(f64::total_cmp);
    let is_in = |spans: &[Span], t: f64| {
        let after = spans.partition_point(|span| span.exit.t <= t);
        spans.get(after).is_some_and(|span| span.enter.t <= t)
    };
    let apart = |pair: &[f64]| {
        let [from, to] = [pair[0], pair[1]];
        let length = (to - from) * ray.dir.abs().max_element() / unit;
        if length <= 1.0 || is_in(a, from) == is_in(b, from) {
            return 0.0;
        }
        let at = |part: f64| distance_to(mesh, ray.at(from + part * (to - from))) / unit;
        length.min([0.25, 0.5, 0.75].map(at).into_iter().fold(0.0, f64::max))
    };
    ends.windows(2).map(apart).fold(0.0, f64::max)
}

/// How far a point is from the surface of a mesh.
pub(crate) fn distance_to(mesh: &Mesh, p: DVec3) -> f64 {
    let corners = |face: &[u32; 3]| face.map(|i| mesh.points()[i as usize]);
    let distances = mesh.faces().iter().map(|face| distance(corners(face), p));
    distances.fold(f64::INFINITY, f64::min)
}

/// How far a point is from a triangle.
fn distance([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    let normal = (b - a).cross(c - a);
    let edges = [(a, b), (b, c), (c, a)];
    let is_beside =
        |(from, to): (DVec3, DVec3)| (to - from).cross(p - from).dot(normal) < 0.0;
    if normal != DVec3::ZERO && !edges.into_iter().any(is_beside) {
        return (p - a).dot(normal.normalize()).abs();
    }
    let to_edge = |(from, to): (DVec3, DVec3)| {
        let edge: DVec3 = to - from;
        let t = (p - from).dot(edge) / edge.length_squared();
        p.distance(from + if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 } * edge)
    };
    edges.map(to_edge).into_iter().fold(f64::INFINITY, f64::min)
}
