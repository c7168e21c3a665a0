//! The even-odd fill of closed paths in the plane, as triangles.
//!
//! The edges of all paths, counted modulo two, are a cycle, and a cycle in the plane is
//! the boundary of exactly one bounded set: the points that a walk from infinity reaches
//! after an odd number of edges. So a constrained Delaunay triangulation that has every
//! edge as a side of triangles answers the question by a flood fill from outside, without
//! a test of any point, and what it fills is closed whatever rounding did to the points.
//!
//! Edges that cross are cut at the crossing first. A cut moves an edge by a rounding
//! error, which can make it cross a neighbour it only passed; so cutting is repeated until
//! nothing crosses. The splitting built into spade is not used because it asserts that one
//! round is enough.

use std::collections::{HashMap, HashSet};

use glam::DVec2;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::error::MeshError;

/// How often edges are cut before the outline is refused; two rounds are usual.
const ROUNDS: usize = 50;

/// The work after which an outline is refused, which is a second or so: [`CUT`] for each
/// crossing that is cut, and 1 for each point that cuts have made whenever all points are
/// triangulated again. The points of the outline itself are free.
const WORK: usize = 200_000;

/// The work of cutting two edges where they cross.
const CUT: usize = 2;

/// A filled outline.
#[derive(Debug)]
pub(super) struct Fill {
    /// The distinct corners in the order of the paths, then the crossings.
    pub(super) points: Vec<DVec2>,
    /// The filled triangles, counter-clockwise.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The edges of the filled set, which lies on their left.
    pub(super) boundary: Vec<[u32; 2]>,
}

type Plane = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// The points that lie within an odd number of the paths, whatever their direction.
///
/// # Errors
///
/// [`MeshError::NotFinite`], and [`MeshError::Tangled`] when crossings are too many or too
/// close to each other for the precision of coordinates.
pub(super) fn even_odd(paths: &[Vec<DVec2>]) -> Result<Fill, MeshError> {
    filled(paths, WORK)
}

/// The same for a path whose edges do not cross; [`MeshError::Tangled`] for any other, found
/// without cutting it.
pub(super) fn without_crossings(path: Vec<DVec2>) -> Result<Fill, MeshError> {
    filled(&[path], 0)
}

/// The fill, if it takes no more than some work.
fn filled(paths: &[Vec<DVec2>], work: usize) -> Result<Fill, MeshError> {
    let mut points = Points::new(paths)?;
    let mut edges = Vec::new();
    for path in paths {
        let corners: Vec<u32> =
            path.iter().map(|&p| points.add(p)).collect::<Result<_, _>>()?;
        let next = corners.iter().cycle().skip(1);
        edges.extend(corners.iter().zip(next).map(|(&a, &b)| [a, b]));
    }
    let (given, mut left) = (points.exact.len(), work);
    for _ in 0..ROUNDS {
        let mut edges_once = modulo_two(std::mem::take(&mut edges));
        let Some(mut plane) = plane(&points) else { break };
        let crossing = constrain(&mut plane, &mut edges_once, &mut edges);
        if crossing.is_empty() {
            return Ok(flood(&plane, points.exact, &modulo_two(edges)));
        }
        cut(&plane, &mut points, &mut edges, &crossing, &mut left)?;
        match left.checked_sub(points.exact.len() - given) {
            Some(rest) => left = rest,
            None => break,
        }
    }
    Err(MeshError::Tangled { points: points.exact.len() })
}

/// The distinct points, as given and in the triangulation's units.
struct Points {
    exact: Vec<DVec2>,
    scaled: Vec<DVec2>,
    found: HashMap<[u64; 2], u32>,
    /// A power of two that brings all coordinates into −1…1, so that products of them
    /// neither overflow nor underflow.
    scale: f64,
}

impl Points {
    fn new(paths: &[Vec<DVec2>]) -> Result<Self, MeshError> {
        let mut largest = 0.0_f64;
        for (index, p) in paths.iter().flatten().enumerate() {
            if !p.is_finite() {
                return Err(MeshError::NotFinite { index, point: p.extend(0.0) });
            }
            largest = largest.max(p.abs().max_element());
        }
        // Powers beyond ±1000 would make the scale itself infinite or subnormal.
        let exponent = if largest > 0.0 { largest.log2().ceil() } else { 0.0 };
        let scale = (-exponent.clamp(-1000.0, 1000.0)).exp2();
        Ok(Self { exact: Vec::new(), scaled: Vec::new(), found: HashMap::new(), scale })
    }

    fn add(&mut self, exact: DVec2) -> Result<u32, MeshError> {
        let scaled = (exact * self.scale).map(flushed);
        self.add_scaled(exact, scaled)
    }

    /// Crossings are rounded to a grid 2^-44 of the outline's size, so that many edges
    /// through one point meet in one point.
    fn add_crossing(&mut self, scaled: DVec2) -> Result<u32, MeshError> {
        const GRID: f64 = (1_u64 << 44) as f64;
        let scaled = (scaled * GRID).round() / GRID + DVec2::ZERO;
        self.add_scaled(scaled / self.scale, scaled)
    }

    fn add_scaled(&mut self, exact: DVec2, scaled: DVec2) -> Result<u32, MeshError> {
        let count = self.exact.len();
        let Ok(index) = u32::try_from(count) else {
            return Err(MeshError::TooLarge { count, limit: u32::MAX as usize });
        };
        let index =
            *self.found.entry(scaled.to_array().map(f64::to_bits)).or_insert(index);
        if index as usize == count {
            self.exact.push(exact);
            self.scaled.push(scaled);
        }
        Ok(index)
    }
}

/// Zero for what is too small for exact predicates (and for −0, to have one zero).
fn flushed(x: f64) -> f64 {
    if x.abs() < spade::MIN_ALLOWED_VALUE { 0.0 } else { x }
}

/// Each edge that occurs an odd number of times, once, with its smaller end first.
fn modulo_two(mut edges: Vec<[u32; 2]>) -> Vec<[u32; 2]> {
    edges.retain(|[a, b]| a != b);
    for edge in &mut edges {
        edge.sort_unstable();
    }
    edges.sort_unstable();
    edges.chunk_by(|a, b| a == b).filter(|c| c.len() % 2 == 1).map(|c| c[0]).collect()
}

/// The triangulation of the points alone; none when spade refuses one of them.
fn plane(points: &Points) -> Option<Plane> {
    let mut plane = Plane::new();
    for (index, p) in points.scaled.iter().enumerate() {
        let vertex = plane.insert(Point2::new(p.x, p.y)).ok()?;
        debug_assert_eq!(vertex.index(), index, "points are distinct");
    }
    Some(plane)
}

fn vertex(index: u32) -> FixedVertexHandle {
    FixedVertexHandle::from_index(index as usize)
}

fn index(vertex: FixedVertexHandle) -> u32 {
    u32::try_from(vertex.index()).unwrap_or(u32::MAX)
}

/// Makes edges sides of triangles. `done` receives them in pieces where they run through
/// points; those that cross an edge made before are returned.
fn constrain(
    plane: &mut Plane,
    edges: &mut Vec<[u32; 2]>,
    done: &mut Vec<[u32; 2]>,
) -> Vec<[u32; 2]> {
    let mut crossing = Vec::new();
    for [a, b] in edges.drain(..) {
        let pieces = plane.try_add_constraint(vertex(a), vertex(b));
        if pieces.is_empty() {
            crossing.push([a, b]);
        }
        for piece in pieces {
            let piece = plane.directed_edge(piece);
            done.push([index(piece.from().fix()), index(piece.to().fix())]);
        }
    }
    crossing
}

/// Cuts the crossing edges and those they cross, and adds the former to the edges. The
/// work that is left is counted down.
fn cut(
    plane: &Plane,
    points: &mut Points,
    edges: &mut Vec<[u32; 2]>,
    crossing: &[[u32; 2]],
    left: &mut usize,
) -> Result<(), MeshError> {
    let mut cuts: Vec<([u32; 2], u32)> = Vec::new();
    for &edge in crossing {
        let [a, b] = edge.map(vertex);
        for other in plane.get_conflicting_edges_between_vertices(a, b) {
            let Some(rest) = left.checked_sub(CUT) else {
                return Err(MeshError::Tangled { points: points.exact.len() });
            };
            *left = rest;
            let mut crossed = [other.from(), other.to()].map(|v| index(v.fix()));
            crossed.sort_unstable();
            let ends = [edge, crossed].map(|e| e.map(|i| points.scaled[i as usize]));
            let point = points.add_crossing(meeting(ends[0], ends[1]))?;
            cuts.push((edge, point));
            cuts.push((crossed, point));
        }
    }
    edges.extend(crossing);
    // An edge [a, b] and its pieces [a, c], [c, b] bound a triangle without area.
    for (edge, mut at) in along(points, cuts) {
        at.insert(0, edge[0]);
        at.push(edge[1]);
        edges.push(edge);
        edges.extend(at.windows(2).map(|w| [w[0], w[1]]));
    }
    Ok(())
}

/// The cuts of each edge in their order from its first end to its second.
fn along(points: &Points, mut cuts: Vec<([u32; 2], u32)>) -> Vec<([u32; 2], Vec<u32>)> {
    cuts.sort_unstable();
    cuts.dedup();
    let cuts_of = |chunk: &[([u32; 2], u32)]| {
        let edge = chunk[0].0;
        let [a, b] = edge.map(|i| points.scaled[i as usize]);
        let mut at: Vec<u32> = chunk.iter().map(|c| c.1).collect();
        let place = |i: u32| (points.scaled[i as usize] - a).dot(b - a);
        at.sort_by(|&i, &j| place(i).total_cmp(&place(j)));
        (edge, at)
    };
    cuts.chunk_by(|a, b| a.0 == b.0).map(cuts_of).collect()
}

/// Where two edges that cross meet, within both.
fn meeting([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> DVec2 {
    let (u, v) = (b - a, d - c);
    let t = (c - a).perp_dot(v) / u.perp_dot(v);
    // Nearly parallel edges leave t to rounding: any point of the edge will do.
    let t = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.5 };
    a + t * u
}

/// Colours triangles from outside: each edge that counts changes the colour.
fn flood(plane: &Plane, points: Vec<DVec2>, edges: &[[u32; 2]]) -> Fill {
    let counted: HashSet<[u32; 2]> = edges.iter().copied().collect();
    let ends = |from: FixedVertexHandle, to: FixedVertexHandle| [index(from), index(to)];
    let counts = |[a, b]: [u32; 2]| counted.contains(&[a.min(b), a.max(b)]);

    let mut filled: Vec<Option<bool>> = vec![None; plane.num_all_faces()];
    let outside = plane.outer_face().fix().index();
    filled[outside] = Some(false);
    let mut open: Vec<_> =
        plane.directed_edges().filter(|e| e.is_outer_edge()).map(|e| e.fix()).collect();
    while let Some(edge) = open.pop() {
        let edge = plane.directed_edge(edge);
        let there = edge.rev();
        let (from, to) = (edge.face().fix().index(), there.face().fix().index());
        if filled[to].is_some() {
            continue;
        }
        let side = filled[from] == Some(true);
        filled[to] = Some(side != counts(ends(edge.from().fix(), edge.to().fix())));
        open.extend([there.next(), there.prev()].map(|e| e.fix()));
    }

    let is_filled = |face: usize| filled[face] == Some(true);
    let mut fill = Fill { points, triangles: Vec::new(), boundary: Vec::new() };
    for face in plane.inner_faces().filter(|f| is_filled(f.fix().index())) {
        fill.triangles.push(face.vertices().map(|v| index(v.fix())));
        for edge in face.adjacent_edges() {
            if !is_filled(edge.rev().face().fix().index()) {
                fill.boundary.push(ends(edge.from().fix(), edge.to().fix()));
            }
        }
    }
    fill
}
