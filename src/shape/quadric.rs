//! Solids of revolution bounded by a quadric and two planes, under any affine map.

use glam::DVec3;

use super::Surface;
use super::doubt::{Local, Spot};
use super::line::{Rays, inverse_power_of_two};
use super::place::Frame;
use super::plane::Plane;
use super::primitive::Profile;
use super::stretch::Stretch;
use super::wall::{Course, Wall};
use crate::aabb::Aabb;
use crate::lanes::{Lanes, Vec3};

/// A quadric. Face 0 is the curved one, 1 the bottom and 2 the top.
#[derive(Clone, Debug)]
pub(crate) struct Quadric {
    pub(super) wall: Wall,
    /// Absent where the profile ends by itself: a whole ball.
    pub(super) planes: Option<[Plane; 2]>,
}

/// The direction of lines, as the faces of a quadric see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Courses<L> {
    wall: Course<L>,
    /// If there are any.
    planes: [L; 2],
}

impl Quadric {
    /// The wall is kept in units of about its largest radius, a power of two, so that no
    /// square of a length is too large or too small to be a number.
    pub(crate) fn new(frame: &Frame, profile: Profile, bottom: f64, top: f64) -> Self {
        let whole = Self::is_whole(profile, bottom, top);
        let planes = (!whole).then(|| {
            [
                Plane::new(frame, -DVec3::Z, -bottom, DVec3::Z * bottom),
                Plane::new(frame, DVec3::Z, top, DVec3::Z * top),
            ]
        });
        let (bottom, top) = profile.extent(bottom, top);
        let unit = 1.0 / inverse_power_of_two(profile.largest_radius(bottom, top));
        let ends = [bottom / unit, top / unit];
        let wall =
            Wall::new(profile.in_units_of(unit), frame.to_local_in_units_of(unit), ends);
        Self { wall, planes }
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
        let planes = match &self.planes {
            Some(planes) => &planes[..],
            None => &[],
        };
        let mut between = Plane::stretch(planes, faces >> 1, rays, &courses.planes);
        // The faces of the planes come after that of the wall.
        let one = between.enter_face.same(1.0);
        between.enter_face = between.enter_face + one;
        between.exit_face = between.exit_face + one;
        if faces & 1 == 0 {
            return [between; 2];
        }
        let [[a, b], [c, d]] = self.wall.inside(rays, &courses.wall);
        [between.cut(a, b, 0), between.cut(c, d, 0)]
    }

    /// What depends on the direction of lines alone.
    #[inline(always)]
    pub(crate) fn courses<L: Lanes>(&self, dir: Vec3<L>) -> Courses<L> {
        let planes = match &self.planes {
            Some([bottom, top]) => [bottom.speed(dir), top.speed(dir)],
            None => [dir.x; 2],
        };
        Courses { wall: self.wall.course(dir), planes }
    }

    pub(crate) fn bounds(frame: &Frame, profile: Profile, bottom: f64, top: f64) -> Aabb {
        let (bottom, top) = profile.extent(bottom, top);
        match profile {
            Profile::Ball { radius } if bottom <= -radius && top >= radius => {
                frame.bounds_of_ball(radius)
            }
            // Where the radius is a convex function of height, the solid is within the
            // convex hull of its two ends.
            Profile::Cylinder { .. }
            | Profile::Cone { .. }
            | Profile::OneSheet { .. } => {
                frame.bounds_of_discs([bottom, top].map(|z| (z, profile.radius(z))))
            }
            Profile::Ball { .. }
            | Profile::Paraboloid { .. }
            | Profile::TwoSheets { .. } => {
                let radius = profile.largest_radius(bottom, top);
                frame.bounds_of_discs([(bottom, radius), (top, radius)])
            }
        }
    }

    /// Whether the profile ends by itself.
    pub(crate) fn is_whole(profile: Profile, bottom: f64, top: f64) -> bool {
        matches!(profile, Profile::Ball { radius } if bottom <= -radius && top >= radius)
    }

    /// No point is farther than this from the local origin.
    pub(crate) fn radius(profile: Profile, bottom: f64, top: f64) -> f64 {
        let (bottom, top) = profile.extent(bottom, top);
        profile.largest_radius(bottom, top).hypot(bottom.abs().max(top.abs()))
    }

    /// How many of its stretches a line can have, as far as some of the faces say.
    pub(crate) fn slots(&self, faces: u32) -> usize {
        if faces & 1 == 1 && self.wall.profile.can_be_left_twice() { 2 } else { 1 }
    }

    pub(crate) fn kind(&self) -> &'static str {
        self.wall.profile.name()
    }
}

impl Surface for Quadric {
    fn normal(&self, point: DVec3, face: u32) -> DVec3 {
        match &self.planes {
            Some(planes) if face > 0 => planes[(face as usize - 1) % 2].outward(),
            _ => self.wall.normal(point),
        }
    }

    fn local(&self, spot: &Spot<'_>, face: u32) -> Local {
        match &self.planes {
            Some(planes) if face > 0 => planes[(face as usize - 1) % 2].local(spot),
            _ => self.wall.local(spot),
        }
    }

    fn faces(&self) -> u32 {
        if self.planes.is_some() { 3 } else { 1 }
    }
}
