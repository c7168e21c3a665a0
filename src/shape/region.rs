//! What leaves are to a whole region of space: around it, apart from it, or neither.
//!
//! A box around a leaf says little where leaves are long and slanted. Here it only cuts off
//! what is beyond its ends; then the leaf's own equations are bounded over what is left
//! (interval arithmetic in the leaf's own frame, of first order in the region's size).
//!
//! All bounds leave room for rounding: where a leaf counts as apart from a region or
//! around it, no line has a crossing with it there, as [`Surface`](super::Surface) computes
//! crossings.

use glam::DVec3;

use super::doubt::U;
use super::place::ToLocal;
use super::plane::Plane;
use super::wall::Wall;
use super::{ALL, Shape};
use crate::aabb::Aabb;
use crate::bvh::Slabs;

/// The points `center + r along + s sides[0] + t sides[1]` with r, s and t from −1 to 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Region {
    center: DVec3,
    along: DVec3,
    sides: [DVec3; 2],
    /// The coordinates of the largest corner of the two sides.
    breadth: DVec3,
    /// At most how far from where it should be rounding has put a point of a line here.
    rounding: f64,
    slabs: Slabs,
}

/// What a leaf is to a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Every point is inside of the leaf.
    In,
    /// Every point is outside.
    Out,
    /// Perhaps neither; every point is on the inner side of the faces whose bits are zero.
    Crossing(u32),
}

/// What a region lies beside a surface: from where to where its equation has values.
#[derive(Clone, Copy, Debug)]
struct Range {
    /// Over the part of the region that may meet the leaf.
    least: f64,
    /// Over all of the region.
    most: f64,
}

impl Region {
    /// A region of which no coordinate nor any edge is larger than `reach`.
    pub(crate) fn new(
        center: DVec3,
        along: DVec3,
        sides: [DVec3; 2],
        reach: f64,
    ) -> Self {
        let breadth = sides[0].abs() + sides[1].abs();
        // The line, the region and the equations of leaves are rounded a few times each.
        let rounding = 64.0 * U * reach;
        let slabs = Slabs::new(center, along, reach);
        Self { center, along, sides, breadth, rounding, slabs }
    }

    /// Half its longest edge.
    pub(crate) fn along(&self) -> DVec3 {
        self.along
    }

    /// How long it is along, and how wide.
    pub(crate) fn lengths(&self) -> [f64; 2] {
        [self.along.length(), self.sides[0].length().max(self.sides[1].length())]
    }

    /// From where to where along the region a box is in it, in steps of −1 to 1.
    pub(crate) fn part_in(&self, b: &Aabb, pad: f64) -> Option<[f64; 2]> {
        let room = self.breadth + pad;
        let [near, far] = self.slabs.range(&Aabb::new(b.min - room, b.max + room));
        let (near, far) = (near.max(-1.0), far.min(1.0));
        (near <= far).then_some([near, far])
    }

    /// Whether it may meet a box.
    pub(crate) fn meets(&self, b: &Aabb) -> bool {
        self.part_in(b, self.rounding).is_some()
    }

    /// Its middle, its half along and how far it comes beside that on each axis, in the frame
    /// of a leaf.
    pub(crate) fn seen_from(&self, to_local: &ToLocal) -> (DVec3, DVec3, DVec3) {
        let [a, b] = self.sides.map(|side| to_local.direction(side).abs());
        let room = to_local.linear.abs() * DVec3::splat(self.rounding);
        (to_local.point(self.center), to_local.direction(self.along), a + b + room)
    }

    /// What a leaf in a box is to it whose surfaces lie no farther than `slack` beside the true
    /// ones.
    pub(crate) fn side(&self, shape: &Shape, bounds: &Aabb, slack: f64) -> Side {
        /// How much farther than rounding a place has to be from a surface to be certainly
        /// on one side of it, for lines and for points.
        const ROOM: f64 = 4.0;
        let pad = ROOM * slack + self.rounding;
        let Some(part) = self.part_in(bounds, pad) else {
            return Side::Out;
        };
        let (planes, wall) = match shape {
            Shape::Sides(leaf) => leaf.planes_and_wall(),
            Shape::Polyhedron(_) => return Side::Crossing(ALL),
        };
        let mut open = self.of_planes(planes, part, pad);
        if let Some(wall) = wall
            && !open.apart
        {
            open.faces <<= 1;
            open.add(0, &self.of_wall(wall, part, pad));
        }
        open.side()
    }

    fn of_planes(&self, planes: &[Plane], part: [f64; 2], pad: f64) -> Open {
        let mut open = Open { faces: 0, apart: false };
        for (face, plane) in (0..).zip(planes) {
            open.add(face, &self.of_plane(plane, part, pad));
            if open.apart {
                break;
            }
        }
        open
    }

    fn of_plane(&self, plane: &Plane, [near, far]: [f64; 2], pad: f64) -> Range {
        let outward = plane.outward();
        let offset = if plane.above { -plane.offset } else { plane.offset };
        let middle = outward.dot(self.center) - offset;
        let along = outward.dot(self.along);
        let [a, b] = self.sides.map(|side| outward.dot(side).abs());
        let sides = a + b + pad * outward.abs().element_sum() + 16.0 * U * offset.abs();
        Range {
            least: middle + (near * along).min(far * along) - sides,
            most: middle + along.abs() + sides,
        }
    }

    /// With δ for the way from a point on the middle line, the equation is that at the
    /// point, plus twice the gradient there times δ, plus a quadratic form of δ. The first is a
    /// quadratic function along the middle line, the second is largest at one of its ends.
    fn of_wall(&self, wall: &Wall, part: [f64; 2], pad: f64) -> Range {
        let linear = &wall.to_local.linear;
        let [a, b, c] = wall.profile.coefficients();
        let weights = DVec3::new(1.0, 1.0, -a);
        let center = *linear * (self.center - wall.to_local.origin);
        let along = *linear * self.along;
        let sides = self.sides.map(|side| *linear * side);
        let room = linear.abs() * DVec3::splat(pad);
        let gradient = weights * center - DVec3::new(0.0, 0.0, b);
        let turn = weights * along;
        let (bend, slope) = (turn.dot(along), gradient.dot(along));
        let height = (weights * center).dot(center) - 2.0 * b * center.z - c;

        let wide = sides[0].abs() + sides[1].abs() + room;
        let squares = wide * wide;
        let flat = squares.x + squares.y;
        let [bulge_out, bulge_in] =
            [flat + (-a).max(0.0) * squares.z, a.max(0.0) * squares.z];
        let reach = center.abs() + along.abs() + wide;
        let terms = weights.abs().dot(reach * reach) + 2.0 * b.abs() * reach.z + c.abs();
        let rounding = 64.0 * U * terms;

        let at = |s: f64| height + s * (2.0 * slope + s * bend);
        let across = |[near, far]: [f64; 2]| {
            let ends = [gradient + near * turn, gradient + far * turn];
            let [p, q] =
                sides.map(|side| ends[0].dot(side).abs().max(ends[1].dot(side).abs()));
            2.0 * (p + q + ends[0].abs().max(ends[1].abs()).dot(room))
        };
        let vertex = -slope / bend;
        let [near, far] = part;
        let mut least = at(near).min(at(far));
        if bend > 0.0 && near < vertex && vertex < far {
            least = least.min(at(vertex));
        }
        let mut most = at(-1.0).max(at(1.0));
        if bend < 0.0 && vertex.abs() < 1.0 {
            most = most.max(at(vertex));
        }
        Range {
            least: least - across(part) - bulge_in - rounding,
            most: most + across([-1.0, 1.0]) + bulge_out + rounding,
        }
    }
}

/// The faces of a leaf on whose inner side not all of a region is.
struct Open {
    faces: u32,
    /// Whether all of it that may meet the leaf is outside of one.
    apart: bool,
}

impl Open {
    fn add(&mut self, face: u32, range: &Range) {
        self.apart |= range.least > 0.0;
        // What is not a number decides nothing.
        self.faces |= u32::from(range.most.is_nan() || range.most >= 0.0) << face;
    }

    fn side(&self) -> Side {
        match self.faces {
            _ if self.apart => Side::Out,
            0 => Side::In,
            faces => Side::Crossing(faces),
        }
    }
}
