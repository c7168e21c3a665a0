//! What can be wrong with a mesh.

use glam::DVec3;
use thiserror::Error;

use crate::shown::Shown;

/// Why some points and faces are not the boundary of a solid.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There are no faces, or all of them were degenerate.
    #[error("the mesh has no faces")]
    NoFaces,
    /// A face names a point that does not exist.
    #[error("face {face} names point {index}, but there are {count} points")]
    NoSuchPoint {
        /// Which face.
        face: usize,
        /// The index it names.
        index: u64,
        /// How many points there are.
        count: usize,
    },
    /// A face has fewer than three corners.
    #[error(
        "face {face} has {corners} corners; faces are counted from 0 and have at least 3"
    )]
    TooFewCorners {
        /// Which face.
        face: usize,
        /// How many corners it has.
        corners: usize,
    },
    /// A point is infinite or not a number.
    #[error("point {index} is not finite: {}", shown(*.point))]
    NotFinite {
        /// Which point.
        index: usize,
        /// Its coordinates.
        point: DVec3,
    },
    /// Some edges lack the neighbour that runs the other way.
    #[error("the mesh is not closed and oriented: {} {} without the neighbour that runs the other way, first {}",
        .count, if *.count == 1 { "edge" } else { "edges" }, list_edges(.first))]
    OpenEdges {
        /// How many.
        count: usize,
        /// The first few of them, in order.
        first: Vec<OpenEdge>,
    },
    /// The faces are seen clockwise from outside.
    #[error("the mesh is inside out: its signed volume is {}; reverse its faces", Shown(*.volume))]
    InsideOut {
        /// The signed volume.
        volume: f64,
    },
    /// The paths of an outline cross more often than can be worked out, or so close to
    /// each other that rounded crossings make new ones.
    #[error("the outline crosses itself too often: {points} points after cutting it")]
    Tangled {
        /// How many points it had after its edges were cut where they cross.
        points: usize,
    },
    /// More points or faces than indices can count.
    #[error("the mesh has {count} points or faces; at most {limit} fit")]
    TooLarge {
        /// How many there are.
        count: usize,
        /// How many fit.
        limit: usize,
    },
}

/// An edge that is run along more often in one direction than in the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenEdge {
    /// The points it connects.
    pub points: [u32; 2],
    /// Where they are.
    pub ends: [DVec3; 2],
    /// How many faces too many run from the first point to the second.
    pub excess: u32,
}

fn shown(point: DVec3) -> String {
    let DVec3 { x, y, z } = point;
    format!("({}, {}, {})", Shown(x), Shown(y), Shown(z))
}

fn list_edges(edges: &[OpenEdge]) -> String {
    let texts: Vec<String> = edges
        .iter()
        .map(|e| {
            let [a, b] = e.ends;
            let times =
                if e.excess > 1 { format!(" ({}×)", e.excess) } else { String::new() };
            format!(
                "{}–{} from {} to {}{times}",
                e.points[0],
                e.points[1],
                shown(a),
                shown(b)
            )
        })
        .collect();
    texts.join("; ")
}
