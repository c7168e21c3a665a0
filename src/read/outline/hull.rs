//! Convex hulls of polygons, and their sums by Minkowski.

use glam::DVec2;
use robust::{Coord, orient2d};

use super::{Paths, filled};

/// The convex hull of points, counter-clockwise; empty if they are on a line.
pub(in crate::read) fn hull(points: impl IntoIterator<Item = DVec2>) -> Vec<DVec2> {
    // A. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.
    let mut points: Vec<DVec2> = points.into_iter().collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let mut hull: Vec<DVec2> = Vec::new();
    let mut chain = |points: &mut dyn Iterator<Item = &DVec2>| {
        let start = hull.len();
        for &p in points {
            while let [.., a, b] = hull[start..] {
                if turns_left(a, b, p) {
                    break;
                }
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
    };
    chain(&mut points.iter());
    chain(&mut points.iter().rev());
    if hull.len() < 3 { Vec::new() } else { hull }
}

fn turns_left(a: DVec2, b: DVec2, c: DVec2) -> bool {
    let [a, b, c] = [a, b, c].map(|p| Coord { x: p.x, y: p.y });
    orient2d(a, b, c) > 0.0
}

/// The sum of two outlines by Minkowski: all points that are the sum of a point of each. Where
/// both are not convex it is the sum of their edges, edge by edge, and of each with a point of every
/// piece of the other.
pub(in crate::read) fn sum(a: &Paths, b: &Paths) -> Paths {
    let convex = |paths: &Paths| match &paths[..] {
        [path] => {
            let hull = hull(path.iter().copied());
            let is_convex = (area(&hull) - area(path)).abs() <= 1e-9 * area(&hull);
            is_convex.then_some(hull)
        }
        _ => None,
    };
    match (convex(a), convex(b)) {
        (Some(a), Some(b)) => vec![hull_of_sums(&a, &b)],
        (None, Some(b)) => swept(a, &b),
        (Some(a), None) => swept(b, &a),
        (None, None) => {
            let firsts = |paths: &Paths| paths.iter().map(|path| path[0]).collect();
            let mut found = translates(a, firsts(b));
            found.extend(translates(b, firsts(a)));
            for e in edges(a) {
                found.extend(edges(b).map(|f| hull_of_sums(&e, &f)));
            }
            filled(&found)
        }
    }
}

/// The sum of any polygons and a convex one.
fn swept(any: &Paths, convex: &[DVec2]) -> Paths {
    let mut found = translates(any, vec![convex[0]]);
    found.extend(edges(any).map(|edge| hull_of_sums(&edge, convex)));
    filled(&found)
}

fn translates(paths: &Paths, by: Vec<DVec2>) -> Paths {
    let moved = |offset: DVec2| {
        paths.iter().map(move |path| path.iter().map(|p| p + offset).collect())
    };
    by.into_iter().flat_map(moved).collect()
}

fn hull_of_sums(a: &[DVec2], b: &[DVec2]) -> Vec<DVec2> {
    hull(a.iter().flat_map(|p| b.iter().map(move |q| p + q)))
}

fn edges(paths: &Paths) -> impl Iterator<Item = [DVec2; 2]> + '_ {
    paths.iter().flat_map(|path| {
        let next = path.iter().cycle().skip(1);
        path.iter().zip(next).map(|(&a, &b)| [a, b])
    })
}

fn area(path: &[DVec2]) -> f64 {
    let next = path.iter().cycle().skip(1);
    0.5 * path.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}
