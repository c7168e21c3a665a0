//! Outlines turned about an axis.
//!
//! The polygons are cut at the heights of their corners into trapezoids. Each is a piece of a cone
//! when it is turned, less another, so the solid is exact; pieces meet in planes that are the same.

use std::collections::HashMap;

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::Paths;
use crate::angle::{cos_deg, sin_deg};
use crate::mesh::{Ends, Mesh, MeshError, Quad, loft};
use crate::op::Op;
use crate::solid::Solid;

/// A part of a polygon between two heights and two edges.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Trapezoid {
    heights: [f64; 2],
    /// How far the inner edge is from the axis at the bottom and at the top.
    inner: [f64; 2],
    outer: [f64; 2],
}

/// The solid of polygons at x ≥ 0 turned once about the y-axis, which becomes the z-axis.
pub(in crate::read) fn revolved(paths: &Paths) -> Solid {
    let turned = |t: Trapezoid| {
        let frustum = |[a, b]: [f64; 2]| {
            let [low, high] = t.heights;
            Solid::frustum_between(a.max(0.0), b.max(0.0), low, high)
        };
        let is_hollow = t.inner[0].max(t.inner[1]) > 0.0;
        if is_hollow { frustum(t.outer) - frustum(t.inner) } else { frustum(t.outer) }
    };
    let mut solids: Vec<Solid> = trapezoids(paths).into_iter().map(turned).collect();
    match solids.len() {
        1 => solids.swap_remove(0),
        _ => Solid::boolean(Op::Union, solids),
    }
}

/// What of a solid lies in a wedge about the z-axis, between angles in degrees that are less than a
/// turn apart.
pub(in crate::read) fn in_wedge(solid: Solid, [from, to]: [f64; 2]) -> Solid {
    let right_of = |degrees: f64| {
        let normal = DVec3::new(-sin_deg(degrees), cos_deg(degrees), 0.0);
        Solid::half_space(normal, 0.0)
    };
    if to - from <= 180.0 {
        solid & (right_of(from + 180.0) & right_of(to))
    } else {
        solid - (right_of(from) & right_of(to + 180.0))
    }
}

/// The polyhedron of polygons at x ≥ 0 turned about the y-axis, which becomes the z-axis, by so
/// many sections: between angles in degrees, or all around from the first.
///
/// # Errors
///
/// If polygons are too tangled to be filled, or there are too many corners.
pub(in crate::read) fn turned(
    paths: &Paths,
    [from, to]: [f64; 2],
    segments: u32,
    ends: Ends,
) -> Result<Mesh, MeshError> {
    // Sections follow each other against the sense of angles: x, y and z of their frames are
    // outwards, along the axis, and that.
    let section = |i: u32| {
        let part = f64::from(i) / f64::from(segments);
        let angle = to + (from - to) * part;
        let (sin, cos) = (sin_deg(angle), cos_deg(angle));
        DAffine3::from_mat3(DMat3::from_cols(
            DVec3::new(cos, sin, 0.0),
            DVec3::Z,
            DVec3::new(sin, -cos, 0.0),
        ))
    };
    let count = match ends {
        Ends::Open => segments + 1,
        Ends::Joined => segments,
    };
    let sections: Vec<DAffine3> = (0..count).map(section).collect();
    // What is turned has plane sides.
    loft(paths, &sections, ends, Quad::short)
}

/// The polygons between the heights of their corners; what is between the same two edges at
/// several heights is one.
fn trapezoids(paths: &Paths) -> Vec<Trapezoid> {
    let mut edges: Vec<[DVec2; 2]> = Vec::new();
    for path in paths {
        let next = path.iter().cycle().skip(1);
        edges.extend(path.iter().zip(next).filter(|(a, b)| a.y < b.y || b.y < a.y).map(
            |(&a, &b)| {
                if a.y < b.y { [a, b] } else { [b, a] }
            },
        ));
    }
    edges.sort_by(|a, b| a[0].y.total_cmp(&b[0].y));
    let mut heights: Vec<f64> = edges.iter().flatten().map(|p| p.y).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();

    let mut found: Vec<Trapezoid> = Vec::new();
    // Those that end at the height that was reached, by their edges.
    let mut open: HashMap<[usize; 2], usize> = HashMap::new();
    let (mut next, mut active): (usize, Vec<usize>) = (0, Vec::new());
    for slab in heights.windows(2) {
        let &[low, high] = slab else { continue };
        active.retain(|&i| edges[i][1].y > low);
        while next < edges.len() && edges[next][0].y <= low {
            active.push(next);
            next += 1;
        }
        let middle = |i: usize| at_height(&edges[i], 0.5 * (low + high));
        active.sort_by(|&a, &b| middle(a).total_cmp(&middle(b)));
        let mut reached = HashMap::new();
        for pair in active.chunks_exact(2) {
            let &[left, right] = pair else { continue };
            let at = |i: usize, y: f64| at_height(&edges[i], y);
            let number = match open.get(&[left, right]) {
                Some(&number) => {
                    let old = &mut found[number];
                    old.heights[1] = high;
                    (old.inner[1], old.outer[1]) = (at(left, high), at(right, high));
                    number
                }
                None => {
                    found.push(Trapezoid {
                        heights: [low, high],
                        inner: [at(left, low), at(left, high)],
                        outer: [at(right, low), at(right, high)],
                    });
                    found.len() - 1
                }
            };
            reached.insert([left, right], number);
        }
        open = reached;
    }
    found.retain(|t| t.outer[0].max(t.outer[1]) > 0.0);
    found
}

/// Where an edge is at a height between its ends; exactly there at its ends.
fn at_height([a, b]: &[DVec2; 2], y: f64) -> f64 {
    let part = (y - a.y) / (b.y - a.y);
    if part >= 1.0 { b.x } else { a.x + (b.x - a.x) * part }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    #[test]
    fn polygons_are_cut_into_trapezoids() {
        // A square frame.
        let outer =
            vec![dvec2(1.0, 0.0), dvec2(5.0, 0.0), dvec2(5.0, 4.0), dvec2(1.0, 4.0)];
        let hole =
            vec![dvec2(2.0, 1.0), dvec2(2.0, 3.0), dvec2(4.0, 3.0), dvec2(4.0, 1.0)];
        let found = trapezoids(&vec![outer, hole]);
        assert_eq!(found.len(), 4);
        let area = |t: &Trapezoid| {
            let [low, high] = t.heights;
            0.5 * (t.outer[0] - t.inner[0] + t.outer[1] - t.inner[1]) * (high - low)
        };
        assert_eq!(found.iter().map(area).sum::<f64>().to_bits(), 12.0_f64.to_bits());
        // Corners of the left side do not divide what is on the right.
        let step = vec![
            dvec2(2.0, 0.0),
            dvec2(5.0, 0.0),
            dvec2(5.0, 4.0),
            dvec2(2.0, 4.0),
            dvec2(1.0, 2.0),
        ];
        assert_eq!(trapezoids(&vec![step]).len(), 2);
    }
}
