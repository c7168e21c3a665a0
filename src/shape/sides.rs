//! What is on the inner side of planes and at most one curved wall, under any affine map: every
//! primitive is.

use glam::{DMat3, DVec3};

use super::chain::Chain;
use super::doubt::{Local, Spot};
use super::line::{Rays, inverse_power_of_two};
use super::place::Frame;
use super::plane::Plane;
use super::stretch::Stretch;
use super::wall::{Course, Wall};
use super::{Identity, Placed, Shape, Slack, Surface};
use crate::aabb::Aabb;
use crate::lanes::{Lanes, Vec3};
use crate::primitive::{Curved, Describe, Extent, Flat, MOST_FACES};

/// A leaf of planes and walls. The wall, if there is one, is face 0, and the planes come after it.
#[derive(Clone, Debug)]
pub(crate) struct Sides {
    kind: &'static str,
    wall: Option<Box<Wall>>,
    planes: Box<[Plane]>,
}

/// The direction of lines, as the faces of a leaf see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Courses<L> {
    wall: Option<Course<L>>,
    /// Of the first planes.
    speeds: [L; KEPT],
}

/// Of how many planes it is kept how fast lines rise above them: those of a box. Of others it is
/// found again for each line.
const KEPT: usize = 6;

impl Sides {
    /// A primitive under a map; or the determinant of a map that cannot be inverted.
    pub(super) fn place(primitive: &dyn Describe, chain: &Chain) -> Result<Placed, f64> {
        let frame = Frame::new(chain.map)?;
        let extent = primitive.extent();
        let leaf = Self::new(primitive, &frame);
        let (bounds, slack, reach) = if let Extent::Unbounded = extent {
            let offsets = leaf.planes.iter().map(|plane| plane.offset.abs());
            let slack = Slack::Unbounded(Box::new((frame, *chain)));
            (leaf.bounds_by_planes(), slack, offsets.fold(0.0, f64::max))
        } else {
            let has_planes = !leaf.planes.is_empty();
            let slack = Slack::of(&frame, chain, extent.radius(), has_planes);
            let reach = frame.reach(extent.coordinates());
            // A prism of four sides, turned to the axes, has corners beside its planes by rounding.
            let is_box = leaf.is_box();
            let bounds =
                if is_box { leaf.bounds_by_planes() } else { frame.bounds(&extent) };
            (bounds, slack, reach)
        };
        let condition = frame.condition();
        Ok(Placed { shape: Shape::Sides(leaf), bounds, condition, slack, reach })
    }

    fn new(primitive: &dyn Describe, frame: &Frame) -> Self {
        let wall = primitive.wall().map(|wall| Self::wall(frame, wall).into());
        let of_plane =
            |Flat { normal, offset, point }| Plane::new(frame, normal, offset, point);
        let planes: Box<[Plane]> = primitive.planes().into_iter().map(of_plane).collect();
        debug_assert!(planes.len() + usize::from(wall.is_some()) <= MOST_FACES);
        Self { kind: primitive.name(), wall, planes }
    }

    /// The wall is kept in units of about its largest radius, a power of two, so that no
    /// square of a length is too large or too small to be a number.
    fn wall(frame: &Frame, Curved { profile, ends }: Curved) -> Wall {
        let unit = 1.0 / inverse_power_of_two(profile.largest_radius(ends));
        let profile = profile.in_units_of(unit);
        Wall::new(profile, frame.to_local_in_units_of(unit), ends.map(|z| z / unit))
    }

    /// Bounded where planes are square to an axis.
    fn bounds_by_planes(&self) -> Aabb {
        let mut bounds = Aabb::ALL;
        for plane in &self.planes {
            if let Some(axis) = plane.axis() {
                let Plane { offset, above, .. } = *plane;
                let side = if above { &mut bounds.min } else { &mut bounds.max };
                side[axis] =
                    if above { offset.max(side[axis]) } else { offset.min(side[axis]) };
            }
        }
        bounds
    }

    /// Where lines are inside, as far as some of the faces say. Only the
    /// first [slots](Self::slots) count.
    #[inline(always)]
    pub(crate) fn stretches<L: Lanes>(
        &self,
        faces: u32,
        rays: &Rays<L>,
        courses: &Courses<L>,
    ) -> [Stretch<L>; 2] {
        let (Some(wall), Some(course)) = (&self.wall, &courses.wall) else {
            return [Plane::stretch(&self.planes, faces, rays, &courses.speeds); 2];
        };
        let mut between = Plane::stretch(&self.planes, faces >> 1, rays, &courses.speeds);
        // The faces of the planes come after that of the wall.
        let one = between.enter_face.same(1.0);
        between.enter_face = between.enter_face + one;
        between.exit_face = between.exit_face + one;
        if faces & 1 == 0 {
            return [between; 2];
        }
        let [[a, b], [c, d]] = wall.inside(rays, course);
        [between.cut(a, b, 0), between.cut(c, d, 0)]
    }

    /// What depends on the direction of lines alone.
    #[inline(always)]
    pub(crate) fn courses<L: Lanes>(&self, dir: Vec3<L>) -> Courses<L> {
        let mut speeds = [dir.x; KEPT];
        for (speed, plane) in speeds.iter_mut().zip(&self.planes) {
            *speed = plane.speed(dir);
        }
        #[expect(
            clippy::manual_map,
            reason = "vectors stay in registers where nothing is called"
        )]
        let wall = match &self.wall {
            Some(wall) => Some(wall.course(dir)),
            None => None,
        };
        Courses { wall, speeds }
    }

    /// How many of its stretches a line can have, as far as some of the faces say.
    pub(crate) fn slots(&self, faces: u32) -> usize {
        match &self.wall {
            Some(wall) if faces & 1 == 1 && wall.profile.can_be_left_twice() => 2,
            _ => 1,
        }
    }

    /// How much memory it takes beside its own size.
    #[cfg(test)]
    pub(super) fn bytes(&self) -> usize {
        let of_wall = self.wall.as_deref().map_or(0, size_of_val);
        of_wall + size_of_val(&*self.planes)
    }

    /// What the primitive is called in reports.
    pub(super) fn kind(&self) -> &'static str {
        self.kind
    }

    pub(super) fn planes_and_wall(&self) -> (&[Plane], Option<&Wall>) {
        (&self.planes, self.wall.as_deref())
    }

    pub(super) fn wall_mut(&mut self) -> Option<&mut Wall> {
        self.wall.as_deref_mut()
    }

    pub(super) fn planes_mut(&mut self) -> &mut [Plane] {
        &mut self.planes
    }

    /// Whether it is a box along the axes: one plane on each side, and nothing else.
    pub(super) fn is_box(&self) -> bool {
        self.wall.is_none()
            && self.planes.len() == 6
            && self.bounds_by_planes().is_bounded()
    }

    /// The surface on which a face lies, and whether the leaf is on the side where that surface's
    /// equation is positive.
    pub(super) fn identity(&self, face: u32) -> (Identity, bool) {
        match self.face(face) {
            Face::Wall(wall) => (Identity::Wall(wall.numbers()), false),
            Face::Plane(plane) => (Identity::Plane(plane.numbers()), plane.above),
        }
    }

    /// The ten coefficients of a face's equation, as in [`Shape::form`].
    pub(super) fn form(&self, face: u32, origin: DVec3, map: DMat3) -> [f64; 10] {
        match self.face(face) {
            Face::Wall(wall) => wall.form(origin, map),
            Face::Plane(plane) => plane.form(origin, map),
        }
    }

    /// A face by its number. The numbers of faces come from answers about the leaf; others get any
    /// face.
    fn face(&self, face: u32) -> Face<'_> {
        let after_wall = match &self.wall {
            Some(wall) if face == 0 || self.planes.is_empty() => return Face::Wall(wall),
            Some(_) => face as usize - 1,
            None => face as usize,
        };
        Face::Plane(&self.planes[after_wall % self.planes.len()])
    }
}

enum Face<'a> {
    Wall(&'a Wall),
    Plane(&'a Plane),
}

impl Surface for Sides {
    fn normal(&self, point: DVec3, face: u32) -> DVec3 {
        match self.face(face) {
            Face::Wall(wall) => wall.normal(point),
            Face::Plane(plane) => plane.outward(),
        }
    }

    fn local(&self, spot: &Spot<'_>, face: u32) -> Local {
        match self.face(face) {
            Face::Wall(wall) => wall.local(spot),
            Face::Plane(plane) => plane.local(spot),
        }
    }

    fn faces(&self) -> u32 {
        let of_wall = usize::from(self.wall.is_some());
        u32::try_from(self.planes.len() + of_wall).unwrap_or(u32::MAX)
    }
}
