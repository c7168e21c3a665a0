//! Whether points and faces bound a solid.

use std::cmp::Ordering;

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
/// Edges are sorted rather than hashed, those that run up to a larger index and those that
/// run down apart: 8 bytes an edge, and errors in a fixed order.
pub(super) fn closed(points: &[DVec3], faces: &[[u32; 3]]) -> Result<(), MeshError> {
    let half = faces.len() + faces.len() / 2;
    let (mut up, mut down) = (Vec::with_capacity(half), Vec::with_capacity(half));
    for [a, b] in faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]) {
        match a.cmp(&b) {
            Ordering::Less => up.push(key([a, b])),
            Ordering::Greater => down.push(key([b, a])),
            Ordering::Equal => {}
        }
    }
    up.sort_unstable();
    down.sort_unstable();
    let (mut up, mut down) = (up.as_slice(), down.as_slice());
    let (mut count, mut first) = (0, Vec::new());
    while let Some(&next) = up.iter().take(1).chain(down.iter().take(1)).min() {
        let [ups, downs] = [take(&mut up, next), take(&mut down, next)];
        if ups == downs {
            continue;
        }
        count += 1;
        if first.len() < LISTED {
            let [a, b] = ends(next);
            let points_in_order = if ups > downs { [a, b] } else { [b, a] };
            first.push(OpenEdge {
                points: points_in_order,
                ends: points_in_order.map(|i| points[i as usize]),
                excess: u32::try_from(ups.abs_diff(downs)).unwrap_or(u32::MAX),
            });
        }
    }
    if count == 0 { Ok(()) } else { Err(MeshError::OpenEdges { count, first }) }
}

/// Takes all that equal a key off the front of a sorted list; says how many they were.
fn take(list: &mut &[u64], key: u64) -> usize {
    let count = list.iter().take_while(|&&k| k == key).count();
    *list = &list[count..];
    count
}

/// The ends of an edge as one number, in the order of the smaller end and then the larger.
fn key([low, high]: [u32; 2]) -> u64 {
    (u64::from(low) << 32) | u64::from(high)
}

#[expect(clippy::cast_possible_truncation, reason = "the halves of a key are indices")]
fn ends(key: u64) -> [u32; 2] {
    [(key >> 32) as u32, key as u32]
}
