//! Edges of outlines in pieces, as OpenSCAD 2025.07 divides them where what it draws along them is
//! not plane (its `src/geometry/linear_extrude.cc`). 2021.01 leaves them whole.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec2;

use crate::read::fineness::whole;

/// The edges of a path in so many pieces each, from that which begins at the first corner on; an
/// edge of no pieces is left out.
pub(in crate::read) fn split(path: &[DVec2], pieces: &[u32]) -> Vec<DVec2> {
    let next = path.iter().cycle().skip(1);
    let edges = path.iter().zip(next).zip(pieces);
    edges
        .flat_map(|((&a, &b), &n)| {
            (0..n).map(move |i| a.lerp(b, f64::from(i) / f64::from(n)))
        })
        .collect()
}

/// How many pieces make edges no longer than so much.
pub(in crate::read) fn by_length(lengths: &[f64], most: f64) -> Vec<u32> {
    lengths.iter().map(|length| whole((length / most).ceil())).collect()
}

/// How many pieces edges have, so that there are at most so many together: the longest are divided
/// first, and those that are about as long are divided together or not at all.
pub(in crate::read) fn by_number(lengths: &[f64], most: u32) -> Vec<u32> {
    /// Lengths with at least this ratio are about the same.
    const SAME: f64 = 0.999;
    let mut pieces = vec![1_u32; lengths.len()];
    // Between what its pieces have and would have if there were one more.
    let edge = |edge: usize, pieces: u32| Edge {
        length: lengths[edge] / (f64::from(pieces) + 0.5),
        edge,
    };
    let mut queue: BinaryHeap<Edge> = (0..lengths.len()).map(|i| edge(i, 1)).collect();
    let mut left = (most as usize).saturating_sub(lengths.len());
    while left > 0 {
        let Some(longest) = queue.pop() else { break };
        let mut group = vec![longest.edge];
        while let Some(next) = queue.peek()
            && next.length >= SAME * longest.length
        {
            group.push(next.edge);
            queue.pop();
        }
        let Some(after) = left.checked_sub(group.len()) else { break };
        left = after;
        for i in group {
            pieces[i] += 1;
            queue.push(edge(i, pieces[i]));
        }
    }
    pieces
}

/// An edge by how long its pieces are.
#[derive(Clone, Copy, Debug)]
struct Edge {
    length: f64,
    edge: usize,
}

impl Ord for Edge {
    fn cmp(&self, other: &Self) -> Ordering {
        self.length.total_cmp(&other.length).then(self.edge.cmp(&other.edge))
    }
}

impl PartialOrd for Edge {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Edge {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Edge {}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    #[test]
    fn long_edges_are_divided_first_and_like_ones_together() {
        assert_eq!(by_number(&[3.0, 2.0, 3.0, 2.0], 6), [2, 1, 2, 1]);
        // One more is not enough for two edges.
        assert_eq!(by_number(&[3.0, 2.0, 3.0, 2.0], 7), [2, 1, 2, 1]);
        assert_eq!(by_number(&[3.0, 2.0, 3.0, 2.0], 8), [2, 2, 2, 2]);
        assert_eq!(by_number(&[1.0; 4], 3), [1; 4]);
        assert_eq!(by_length(&[3.0, 2.0, 0.0], 2.0), [2, 1, 0]);
    }

    #[test]
    fn pieces_are_of_equal_length() {
        let path = [dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(0.0, 2.0)];
        let found = split(&path, &[2, 1, 0]);
        assert_eq!(found, [dvec2(0.0, 0.0), dvec2(2.0, 0.0), dvec2(4.0, 0.0)]);
    }
}
