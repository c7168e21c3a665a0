//! Outlines drawn along a row of sections: prisms, twisted and revolved bodies.

use glam::{DAffine3, DVec2, DVec3};

use super::{Mesh, MeshError, fill};

/// Whether the last section is followed by the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    /// It is not: the first and the last are filled.
    Open,
    /// It is.
    Joined,
}

/// Four corners between two sections, which need not be planar.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quad {
    /// How many sections are before them.
    pub(crate) before: usize,
    /// Whether they are the wall of a hole.
    pub(crate) is_hole: bool,
    /// How long the diagonal is that goes forwards along the edge and to the next section.
    pub(crate) forwards: f64,
    /// How long the other one is.
    pub(crate) backwards: f64,
}

/// One of the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Diagonal {
    Forwards,
    Backwards,
}

impl Quad {
    /// The shorter diagonal; none if they are as long, as OpenSCAD sees it.
    pub(crate) fn shorter(&self) -> Option<Diagonal> {
        /// Lengths that differ by less than this part are taken for equal.
        const EQUAL: f64 = 1e-5;
        let (more, both) =
            (self.forwards - self.backwards, self.forwards + self.backwards);
        if 2.0 * more.abs() <= EQUAL * both {
            return None;
        }
        Some(if more > 0.0 { Diagonal::Backwards } else { Diagonal::Forwards })
    }

    /// A diagonal that is not the longer one.
    pub(crate) fn short(&self) -> Diagonal {
        self.shorter().unwrap_or(Diagonal::Forwards)
    }
}

/// The body between sections, which are images of the even-odd fill of paths in the plane z = 0:
/// the next one lies where z points to. A corner that stays where it is makes faces without area.
///
/// The four corners between two sections are divided along a diagonal of the caller's choice. Paths
/// that run clockwise are those of holes.
///
/// # Errors
///
/// [`MeshError::NoFaces`] when the outline is empty, [`MeshError::NotFinite`],
/// [`MeshError::Tangled`] when paths cross too often to be told apart, and others if sections
/// pass through each other so that the body is inside out.
pub(crate) fn loft(
    paths: &[Vec<DVec2>],
    sections: &[DAffine3],
    ends: Ends,
    diagonal: impl Fn(&Quad) -> Diagonal,
) -> Result<Mesh, MeshError> {
    let fill::Fill { points: outline, triangles, boundary } = fill::even_odd(paths)?;
    let count = outline.len().saturating_mul(sections.len());
    if u32::try_from(count).is_err() {
        return Err(MeshError::TooLarge { count, limit: u32::MAX as usize });
    }
    let section = |map: &DAffine3| -> Vec<DVec3> {
        outline.iter().map(|p| map.transform_point3(p.extend(0.0))).collect()
    };
    let points: Vec<DVec3> = sections.iter().flat_map(section).collect();
    #[expect(clippy::cast_possible_truncation, reason = "all numbers of points fit")]
    let [step, all] = [outline.len() as u32, points.len() as u32];
    let mut faces = Vec::new();
    if ends == Ends::Open {
        let last = all - step.min(all);
        for [a, b, c] in triangles {
            faces.push([c, b, a]);
            faces.push([a + last, b + last, c + last]);
        }
    }
    let joined = match ends {
        Ends::Open => sections.len().saturating_sub(1),
        Ends::Joined => sections.len(),
    };
    let at = |i: u32| points[i as usize];
    let in_holes = in_holes(paths, &outline);
    for (before, start) in (0..joined).zip((0..).step_by(outline.len().max(1))) {
        for &[a, b] in &boundary {
            let is_hole = in_holes[a as usize];
            let [a, b] = [a + start, b + start];
            let [c, d] =
                [a, b].map(|i| if i + step < all { i + step } else { i + step - all });
            let quad = Quad {
                before,
                is_hole,
                forwards: at(a).distance(at(d)),
                backwards: at(b).distance(at(c)),
            };
            faces.extend(match diagonal(&quad) {
                Diagonal::Forwards => [[a, b, d], [a, d, c]],
                Diagonal::Backwards => [[a, b, c], [b, d, c]],
            });
        }
    }
    Mesh::new(points, faces)
}

/// Of each point whether the first path through it is a hole; points where paths cross are not.
fn in_holes(paths: &[Vec<DVec2>], points: &[DVec2]) -> Vec<bool> {
    // Distinct points are in the order of the paths.
    let mut found = Vec::with_capacity(points.len());
    for path in paths {
        let next = path.iter().cycle().skip(1);
        let area: f64 = path.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum();
        for point in path {
            if points.get(found.len()) == Some(point) {
                found.push(area < 0.0);
            }
        }
    }
    found.resize(points.len(), false);
    found
}
