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

/// The body between sections, which are images of the even-odd fill of paths in the plane z = 0:
/// the next one lies where z points to. A corner that stays where it is makes faces without area.
///
/// The four corners between two sections need not be planar; they are divided along the shorter
/// diagonal, as OpenSCAD does it.
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
    for (_, start) in (0..joined).zip((0..).step_by(outline.len().max(1))) {
        for &[a, b] in &boundary {
            let [a, b] = [a + start, b + start];
            let [c, d] =
                [a, b].map(|i| if i + step < all { i + step } else { i + step - all });
            /// Diagonals that differ by less than this part are taken for equal.
            const EQUAL: f64 = 1e-5;
            let [falling, rising] = [at(b).distance(at(c)), at(a).distance(at(d))];
            if falling < rising * (1.0 - EQUAL) {
                faces.extend([[a, b, c], [b, d, c]]);
            } else {
                faces.extend([[a, b, d], [a, d, c]]);
            }
        }
    }
    Mesh::new(points, faces)
}
