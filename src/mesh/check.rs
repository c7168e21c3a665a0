//! Whether points and faces bound a solid.

use glam::DVec3;

use super::error::{MeshError, OpenEdge};

/// How many bad edges an error lists.
const LISTED: usize = 3;

/// Points are finite and countable, and faces name only points that exist.
pub(super) fn indices(points: &[DVec3], faces: &[[u32; 3]]) -> Result<(), MeshError> {
    let limit = u32::MAX as usize;
    let count = points.len().max(faces.len());
    if count > limit {
        return Err(MeshError::TooLarge { count, limit });
    }
    if faces.is_empty() {
        return Err(MeshError::NoFaces);
    }
    for (face, corners) in faces.iter().enumerate() {
        for &index in corners {
            if index as usize >= points.len() {
                let (index, count) = (u64::from(index), points.len());
                return Err(MeshError::NoSuchPoint { face, index, count });
            }
        }
    }
    match points.iter().position(|p| !p.is_finite()) {
        Some(index) => Err(MeshError::NotFinite { index, point: points[index] }),
        None => Ok(()),
    }
}

/// Every directed edge is matched by one that runs the other way.
///
/// Edges are sorted rather than hashed: 12 bytes an edge, and errors in a fixed order.
pub(super) fn closed(points: &[DVec3], faces: &[[u32; 3]]) -> Result<(), MeshError> {
    let mut edges: Vec<([u32; 2], bool)> = faces
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .filter(|[a, b]| a != b)
        .map(|[a, b]| ([a.min(b), a.max(b)], a < b))
        .collect();
    edges.sort_unstable();
    let (mut count, mut first) = (0, Vec::new());
    for same in edges.chunk_by(|a, b| a.0 == b.0) {
        let ([a, b], total) = (same[0].0, same.len());
        let up = same.iter().filter(|edge| edge.1).count();
        let down = total - up;
        if up == down {
            continue;
        }
        count += 1;
        if first.len() < LISTED {
            let points_in_order = if up > down { [a, b] } else { [b, a] };
            first.push(OpenEdge {
                points: points_in_order,
                ends: points_in_order.map(|i| points[i as usize]),
                excess: u32::try_from(up.abs_diff(down)).unwrap_or(u32::MAX),
            });
        }
    }
    if count == 0 { Ok(()) } else { Err(MeshError::OpenEdges { count, first }) }
}
