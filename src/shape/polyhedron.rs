//! Closed meshes under any affine map, watertight for whole lines (why is said in `shear`).

use std::sync::Arc;

use glam::DVec3;

use super::doubt::{Local, Spot, U};
use super::line::inverse_power_of_two;
use super::pack::{Keep, Kept, Linear, Pack, Points, Sight};
use super::place::{Frame, ToLocal};
use super::shear::{Shear, crossing, level};
use super::{Line, Sink, Surface};
use crate::aabb::Aabb;
use crate::bvh::{Bvh, Visitor};
use crate::eight::{EIGHT, Eight, WithEight, with_eight};
use crate::mesh::Mesh;
use crate::ray::Sense;

/// A mesh and the hierarchy over its faces, shared by all its copies in a scene.
#[derive(Debug)]
pub(crate) struct IndexedMesh {
    pub(super) mesh: Arc<Mesh>,
    /// Over packs.
    pub(super) faces: Bvh,
    pub(super) packs: Vec<Pack>,
    /// The corners of the packs, one after the other.
    pub(super) points: Vec<DVec3>,
    /// The power of two that brings the coordinates to about 1, so that products of them
    /// are neither too large nor too small to be exact.
    pub(super) scale: f64,
}

impl IndexedMesh {
    pub(crate) fn new(mesh: Arc<Mesh>) -> Self {
        let corners = |i: u32| mesh.corners(i as usize);
        let boxes = (0..face_count(&mesh)).map(|i| (i, Aabb::around(corners(i))));
        // Packs are made when the tree is there: it takes more memory to be made than to be
        // kept.
        let mut in_order = Vec::with_capacity(mesh.faces().len());
        let mut ends = Vec::with_capacity(mesh.faces().len() / 4 + 2);
        ends.push(0);
        let faces = Bvh::grouped(boxes, EIGHT, |faces| {
            in_order.extend_from_slice(faces);
            ends.push(in_order.len());
            u32::try_from(ends.len() - 2).expect("there are fewer packs than faces")
        });
        let mut points = Points::new(&mesh);
        let mut pack = |ends: &[usize]| {
            Pack::new(&mesh, faces.unit(), &in_order[ends[0]..ends[1]], &mut points)
        };
        let packs = ends.windows(2).map(&mut pack).collect();
        let bounds = faces.bounds();
        let points = points.into_list();
        Self { mesh, faces, packs, points, scale: inverse_power_of_two(bounds.reach()) }
    }

    /// The largest coordinates.
    pub(crate) fn largest(&self) -> DVec3 {
        let bounds = self.faces.bounds();
        bounds.min.abs().max(bounds.max.abs())
    }

    /// No point is farther than this from the local origin.
    pub(crate) fn radius(&self) -> f64 {
        self.largest().length()
    }
}

/// A placed mesh; its faces are the triangles.
#[derive(Clone, Debug)]
pub(crate) struct Polyhedron {
    mesh: Arc<IndexedMesh>,
    pub(crate) to_local: ToLocal,
}

impl Polyhedron {
    pub(crate) fn new(frame: &Frame, mesh: Arc<IndexedMesh>) -> Self {
        Self { mesh, to_local: frame.to_local() }
    }

    /// The box around the placed points, closer than the box around the placed box.
    pub(crate) fn bounds(frame: &Frame, mesh: &IndexedMesh) -> Aabb {
        let mesh = &mesh.mesh;
        let used = mesh.faces().iter().flatten();
        Aabb::around(used.map(|&i| frame.point(mesh.points()[i as usize])))
    }

    /// The mesh and its hierarchy.
    pub(super) fn indexed(&self) -> &IndexedMesh {
        &self.mesh
    }

    /// A number that copies of one mesh share and others do not.
    pub(crate) fn mesh_address(&self) -> usize {
        Arc::as_ptr(&self.mesh).addr()
    }

    /// The middle of the mesh's box, in the world.
    pub(crate) fn middle(&self) -> DVec3 {
        let middle = self.mesh.faces.bounds().center();
        self.to_local.origin + self.to_local.linear_to_world() * middle
    }

    /// At most how far any point of the mesh is from where another copy has it: affine maps
    /// differ most at the corners of a box.
    pub(crate) fn distance(&self, other: &Self) -> f64 {
        let [ours, theirs] = [self, other].map(|copy| copy.to_local.linear_to_world());
        let apart = |p: DVec3| {
            (self.to_local.origin - other.to_local.origin + (ours * p - theirs * p))
                .length()
        };
        self.mesh.faces.bounds().corners().into_iter().map(apart).fold(0.0, f64::max)
    }
}

impl Polyhedron {
    /// Hands over all crossings with a line.
    pub(super) fn crossings(&self, line: &Line, sink: &mut Sink<'_>) {
        with_eight(Through { mesh: self, line, sink });
    }
}

impl Polyhedron {
    /// How many triangles there are.
    pub(crate) fn face_count(&self) -> usize {
        self.mesh.mesh.faces().len()
    }

    /// Calls `visit` with the corners of each triangle in the world, if the way there can be
    /// found.
    pub(crate) fn for_each_face(&self, mut visit: impl FnMut([DVec3; 3])) -> bool {
        let Some(linear) = super::inverse(&self.to_local.linear) else { return false };
        for face in 0..self.face_count() {
            let corners = self.mesh.mesh.corners(face);
            visit(corners.map(|p| self.to_local.origin + linear * p));
        }
        true
    }
}

/// For rays that are looked at together.
impl Polyhedron {
    /// The box around the mesh in its own frame.
    pub(crate) fn local_bounds(&self) -> Aabb {
        self.mesh.faces.bounds()
    }

    /// Adds the numbers of the packs that a region may meet: the points
    /// `center + s along + b` with s from −1 to 1 and no coordinate of b larger than `breadth`,
    /// in the mesh's frame.
    pub(crate) fn packs_in(
        &self,
        (center, along, breadth): (DVec3, DVec3, DVec3),
        packs: &mut Vec<u32>,
    ) {
        let faces = &self.mesh.faces;
        faces.crossed_by(&faces.slabs(center, along), breadth, |pack| packs.push(pack));
    }

    /// The function `weights · (p − origin) + constant` of points of the mesh, which is off by
    /// `error` already.
    pub(crate) fn linear(
        &self,
        weights: DVec3,
        origin: DVec3,
        constant: f64,
        error: f64,
    ) -> Linear {
        Linear::new(self.mesh.faces.unit(), weights, origin, constant, error)
    }

    /// Sorts out the faces of packs that are on the positive side of a plane, and says between
    /// which depths the others are.
    pub(crate) fn keep(
        &self,
        numbers: &[u32],
        planes: &[Linear; 4],
        depth: &Linear,
        kept: &mut Vec<Kept>,
    ) {
        let packs = &self.mesh.packs;
        with_eight(Keep { packs, numbers, planes, depth, kept });
    }

    /// A pack by its number.
    #[inline(always)]
    pub(crate) fn pack(&self, number: u32) -> &Pack {
        &self.mesh.packs[number as usize]
    }

    /// Whether there are so many faces that it takes long to look at all of them.
    pub(crate) fn is_large(&self) -> bool {
        const LARGE: usize = 64;
        self.mesh.packs.len() > LARGE
    }

    /// The corners of a face of a pack, by the number of its bit.
    #[inline]
    pub(crate) fn corners_in_pack(&self, pack: u32, bit: u32) -> [DVec3; 3] {
        self.pack(pack).corners(bit, &self.mesh.points)
    }

    /// The power of two that brings its coordinates to about 1.
    pub(crate) fn scale(&self) -> f64 {
        self.mesh.scale
    }

    /// What says where a line crosses a face with these corners, and whether it goes in or
    /// out there, the same as among all crossings.
    pub(crate) fn crosser<'a>(
        &'a self,
        line: &Line,
    ) -> Option<impl FnMut([DVec3; 3]) -> Option<(f64, Sense)> + use<'a>> {
        let (origin, dir) = self.in_frame(line)?;
        let shear = Shear::new(self.mesh.scale, origin, dir, &self.to_local.linear);
        Some(move |corners: [DVec3; 3]| crossing(corners, &shear))
    }

    /// The origin and the direction of a line in the frame of the mesh; nothing of a mesh too
    /// small to be told from a point of the scene.
    #[inline(always)]
    pub(super) fn in_frame(&self, line: &Line) -> Option<(DVec3, DVec3)> {
        let origin = self.to_local.origin_of(line);
        let dir = self.to_local.direction(line.dir);
        (origin.is_finite() && dir.is_finite() && dir != DVec3::ZERO)
            .then_some((origin, dir))
    }
}

/// A line that is to be looked for in a mesh.
struct Through<'a, 'b> {
    mesh: &'a Polyhedron,
    line: &'a Line,
    sink: &'a mut Sink<'b>,
}

impl WithEight for Through<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_eight<S: Eight>(self, simd: S) {
        let Self { mesh, line, sink } = self;
        let Some((origin, dir)) = mesh.in_frame(line) else { return };
        let IndexedMesh { faces, packs, points, scale, .. } = &*mesh.mesh;
        let slabs = faces.slabs(origin, dir);
        if !slabs.cross(&faces.bounds()) {
            return;
        }
        let shear = Shear::new(*scale, origin, dir, &mesh.to_local.linear);
        let probe = faces.probe(&slabs);
        let sight = Sight::new(&probe, shear.axes, shear.shift);
        let mut crossed = Crossed { packs, points, sight, shear, sink };
        faces.visited(simd, &probe, &mut crossed);
    }
}

/// Finds the faces that a line crosses.
struct Crossed<'a, 'b> {
    packs: &'a [Pack],
    points: &'a [DVec3],
    sight: Sight,
    shear: Shear<'a>,
    sink: &'a mut Sink<'b>,
}

impl Visitor for Crossed<'_, '_> {
    #[inline(always)]
    fn end<S: Eight>(&mut self, simd: S, end: u32) {
        let near = self.packs[end as usize].near(simd, &self.sight);
        if near != 0 {
            self.look_at(end, near);
        }
    }
}

impl Crossed<'_, '_> {
    /// Looks at the faces of a pack whose bits are set.
    #[inline(always)]
    fn look_at(&mut self, pack: u32, mut near: u32) {
        let pack = &self.packs[pack as usize];
        while near != 0 {
            if let Some((face, corners)) = pack.exact(near.trailing_zeros(), self.points)
                && let Some((t, sense)) = crossing(corners, &self.shear)
            {
                self.sink.crossing(t, face, sense);
            }
            near &= near - 1;
        }
    }
}

impl Surface for Polyhedron {
    fn normal(&self, _point: DVec3, face: u32) -> DVec3 {
        let [a, b, c] = self.mesh.mesh.corners(face as usize);
        self.to_local.normal_to_world(level(b - a).cross(level(c - a)))
    }

    /// The plane of a triangle, its value not divided by the length of its normal.
    ///
    /// Beside what moves the point, corners are moved by the shear: by at most 10 u times
    /// their distance from the line's origin. The crossing is found between points of two
    /// edges that are interpolated along them, which leaves it at most 16 u times an edge beside
    /// the triangle. The normal is wrong by at most 16 u times the product of two edges.
    fn local(&self, spot: &Spot<'_>, face: u32) -> Local {
        let (origin, dir, moved) = self.seen_from(spot);
        let [a, b, c] = self.mesh.mesh.corners(face as usize);
        let (ab, ac) = (b - a, c - a);
        let (normal, edge) = (ab.cross(ac), ab.length().max(ac.length()));
        let far = [a, b, c].map(|p| (p - origin).abs().max_element());
        let sheared = 26.0 * U * far.into_iter().fold(edge, f64::max);
        let to_point = origin + spot.t * dir - a;
        let slope = normal.dot(dir);
        let normal_rounding = 16.0 * U * ab.length() * ac.length();
        let rounding = normal.abs().dot(moved + DVec3::splat(sheared))
            + normal_rounding * to_point.length();
        Local {
            value: normal.dot(to_point),
            rounding,
            slope,
            slope_rounding: normal_rounding * dir.length(),
            bend: 0.0,
            bend_rounding: 0.0,
        }
    }

    fn faces(&self) -> u32 {
        face_count(&self.mesh.mesh)
    }

    /// The faces on which the place is, give or take rounding: those whose planes it is near and
    /// which have it above their inside, or nearer to an edge than rounding.
    fn near(&self, spot: &Spot<'_>, visit: &mut dyn FnMut(u32, &Local)) {
        let (origin, dir, moved) = self.seen_from(spot);
        let bounds = self.mesh.faces.bounds();
        let far = bounds.min.abs().max(bounds.max.abs()).max(origin.abs());
        let pad = 4.0 * (moved + DVec3::splat(20.0 * U * far.max_element()));
        let point = origin + spot.t * dir;
        self.mesh.faces.around(&Aabb::new(point - pad, point + pad), |pack| {
            for face in self.mesh.packs[pack as usize].faces() {
                let local = self.local(spot, face);
                let corners = self.mesh.mesh.corners(face as usize);
                if local.is_near() && is_beside(point, corners, pad.length()) {
                    visit(face, &local);
                }
            }
        });
    }

    /// As for other leaves; but no crossing with a triangle is beyond its corners.
    fn error(&self, spot: &Spot<'_>, face: u32) -> f64 {
        let (origin, dir, moved) = self.seen_from(spot);
        let steps = dir.length_squared();
        let extent = |face: u32| {
            let corners = self.mesh.mesh.corners(face as usize);
            let away = corners.map(|p| ((p - origin).dot(dir) / steps - spot.t).abs());
            away.into_iter().fold(4.0 * moved.length() / steps.sqrt(), f64::max)
        };
        let mut error = self.local(spot, face).reach().min(extent(face));
        self.near(spot, &mut |face, local| {
            error = error.max(local.reach().min(extent(face)));
        });
        error
    }
}

impl Polyhedron {
    /// The numbers that tell it from others.
    pub(super) fn numbers(&self) -> (usize, [f64; 12]) {
        let mut numbers = [0.0; 12];
        numbers[..9].copy_from_slice(&self.to_local.linear.to_cols_array());
        numbers[9..].copy_from_slice(&self.to_local.origin.to_array());
        (Arc::as_ptr(&self.mesh).addr(), numbers)
    }

    /// A line in the frame of the mesh: its origin, its direction, and at most how far rounding has
    /// moved its point at the spot on each axis.
    fn seen_from(&self, spot: &Spot<'_>) -> (DVec3, DVec3, DVec3) {
        let Spot { line, t, slack } = *spot;
        let away = line.origin - self.to_local.origin;
        let moved = self.to_local.linear.abs()
            * (line.rounding()
                + DVec3::splat(slack)
                + 6.0 * U * away.abs()
                + 4.0 * U * t.abs() * line.dir.abs());
        (self.to_local.origin_of(line), self.to_local.direction(line.dir), moved)
    }
}

fn face_count(mesh: &Mesh) -> u32 {
    u32::try_from(mesh.faces().len()).expect("a mesh has at most u32::MAX faces")
}

/// Whether a point near the plane of a triangle is over it or this near to an edge.
fn is_beside(point: DVec3, [a, b, c]: [DVec3; 3], near: f64) -> bool {
    let normal = (b - a).cross(c - a);
    let edges = [(a, b), (b, c), (c, a)];
    let is_over = normal != DVec3::ZERO
        && edges.iter().all(|(a, b)| normal.cross(b - a).dot(point - a) >= 0.0);
    is_over || edges.iter().any(|&(a, b)| distance_to_edge(point, a, b) <= near)
}

fn distance_to_edge(point: DVec3, a: DVec3, b: DVec3) -> f64 {
    let (edge, away) = (b - a, point - a);
    let part = away.dot(edge) / edge.length_squared();
    let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
    (away - part * edge).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The figure that the documentation of [`Scene`](crate::Scene) gives.
    #[test]
    fn triangles_take_the_memory_they_are_said_to_take() {
        // Many tetrahedra in a row are a mesh like any other.
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
        let step = |i: u32| DVec3::new(f64::from(i), f64::from(i % 7), f64::from(i % 13));
        let points =
            (0..5_000).flat_map(|i| corners.map(|p| p + 2.0 * step(i))).collect();
        let faces =
            (0..5_000).flat_map(|i| faces.map(|f| f.map(|k| k + 4 * i))).collect();
        let mesh = Arc::new(Mesh::new(points, faces).expect("tetrahedra are closed"));
        let indexed = IndexedMesh::new(mesh);
        let bytes = indexed.faces.bytes()
            + size_of_val(&*indexed.packs)
            + size_of_val(&*indexed.points);
        assert!(bytes <= 110 * 20_000, "{} bytes a triangle", bytes / 20_000);
    }
}
