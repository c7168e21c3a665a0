//! Planes in world coordinates, and what lies on the inner side of all of some.

use glam::{DMat3, DVec3};

use super::doubt::{Local, Spot, U};
use super::line::{Line, Rays};
use super::place::Frame;
use super::stretch::Stretch;
use crate::lanes::{Lanes, Vec3};

/// One side of a plane: the points with `normal · p ≤ offset`, or `≥` if it is `above`.
///
/// Planes are kept in world coordinates and in one form (see [`Plane::new`]), so that those
/// which coincide can be given equal bits and then give equal bits for every line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub(crate) normal: DVec3,
    pub(crate) offset: f64,
    pub(crate) above: bool,
}

/// What the inner side of a plane leaves of lines that are not all on one side of it, or of
/// those along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keeps {
    /// What comes before the plane.
    Before,
    /// What comes after it.
    After,
    /// All of a line that is on the inner side, and nothing of others.
    AllOrNothing,
}

impl Plane {
    /// The inner side of a plane of a leaf: `outward · p = offset` in the leaf's frame, where
    /// `point` is a point on it.
    ///
    /// The normal is divided by its largest component and its first component that is not
    /// zero is positive: one form for each direction, exact for directions along an axis and
    /// for those to which small whole numbers in front of a power of two belong. So is the
    /// offset: taken from the point where that is one coordinate of it, and where it is not
    /// from the local offset, which the foot of an oblique plane has not got exactly.
    pub(crate) fn new(frame: &Frame, outward: DVec3, offset: f64, point: DVec3) -> Self {
        let normal = frame.normal(outward);
        let size = normal.abs().max_element();
        let scaled = normal / size;
        let first = scaled.to_array().into_iter().find(|&c| c != 0.0).unwrap_or(1.0);
        let above = first < 0.0;
        let sign = if above { -1.0 } else { 1.0 };
        let mut plane = Self { normal: sign * scaled, offset: 0.0, above };
        plane.offset = match plane.axis() {
            Some(axis) => frame.point(point)[axis],
            None => sign * (offset / size) + plane.normal.dot(frame.origin()),
        };
        plane
    }

    /// The axis to which the plane is square, if it is.
    pub(crate) fn axis(&self) -> Option<usize> {
        (0..3).find(|axis| (1..3).all(|k| self.normal[(axis + k) % 3] == 0.0))
    }

    /// The numbers that describe it, whichever side is meant.
    pub(crate) fn numbers(&self) -> [f64; 4] {
        let DVec3 { x, y, z } = self.normal;
        [x, y, z, self.offset]
    }

    /// The equation at `origin + map · s`, with coefficients as those of a wall.
    pub(super) fn form(&self, origin: DVec3, map: DMat3) -> [f64; 10] {
        let slope = map.transpose() * self.normal;
        let value = self.normal.dot(origin) - self.offset;
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, slope.x, slope.y, slope.z, value]
    }

    /// The outward normal.
    pub(crate) fn outward(&self) -> DVec3 {
        if self.above { -self.normal } else { self.normal }
    }

    /// The equation of the plane at a place.
    ///
    /// The distance is a sum of four products of coordinates, and so is the speed, each
    /// rounded by at most 4 u times the sum of their absolute values.
    pub(super) fn local(&self, spot: &Spot<'_>) -> Local {
        let Spot { line, t, slack } = *spot;
        let (size, sign) = (self.normal.abs(), if self.above { -1.0 } else { 1.0 });
        let slope = self.normal.dot(line.dir);
        let slope_rounding = 4.0 * U * size.dot(line.dir.abs());
        let value = t * slope - self.height_above(line);
        let rounding = slack * self.normal.length()
            + size.dot(line.rounding() + 4.0 * U * line.origin.abs())
            + 4.0 * U * self.offset.abs()
            + t.abs() * slope_rounding;
        Local {
            value: sign * value,
            rounding,
            slope: sign * slope,
            slope_rounding,
            bend: 0.0,
            bend_rounding: 0.0,
        }
    }

    /// How far the plane is above the origin of a line, in lengths of the normal.
    fn height_above(&self, line: &Line) -> f64 {
        (self.offset - self.normal.dot(line.origin)) - self.normal.dot(line.rest)
    }

    /// From where to where lines are inside: half of each, all or nothing.
    ///
    /// A line within the plane is inside if it would be after a small move along the normal:
    /// solids on the two sides of a plane share such lines out.
    #[inline(always)]
    fn inside<L: Lanes>(&self, rays: &Rays<L>, speed: L) -> [L; 2] {
        let like = rays.origin.x;
        let (never, always) = (like.same(f64::INFINITY), like.same(f64::NEG_INFINITY));
        let zero = like.same(0.0);
        let to_plane = self.height(rays);
        let (parallel, rising) = (speed.equal(zero), zero.less(speed));
        let is_above = !zero.less(to_plane);
        let t = to_plane / speed;
        let (goes_in, stays) =
            if self.above { (rising, is_above) } else { (!rising, !is_above) };
        let none = parallel & !stays;
        let from = L::select(goes_in & !parallel, t, always);
        let to = L::select(goes_in | parallel, never, t);
        [L::select(none, never, from), L::select(none, always, to)]
    }

    /// How far the plane is above the origins of lines, in lengths of the normal.
    #[inline(always)]
    pub(crate) fn height<L: Lanes>(&self, rays: &Rays<L>) -> L {
        let Rays { origin, rest, .. } = *rays;
        let normal = Vec3::same(origin.x, self.normal);
        (origin.x.same(self.offset) - normal.dot(origin)) - normal.dot(rest)
    }

    /// The same of a plane square to an axis, from the coordinates along it.
    #[inline(always)]
    pub(crate) fn height_along_axis<L: Lanes>(&self, origin: L, rest: L) -> L {
        (origin.same(self.offset) - origin) - rest
    }

    /// What it leaves of lines that rise above it at one speed.
    pub(crate) fn keeps(&self, speed: f64) -> Keeps {
        if speed == 0.0 {
            Keeps::AllOrNothing
        } else if (speed > 0.0) == self.above {
            Keeps::After
        } else {
            Keeps::Before
        }
    }

    /// The stretches of lines on the inner side of all planes whose bits are `wanted`, the
    /// first plane's the lowest; may be empty or infinite. It is known how fast
    /// they rise above the first planes.
    #[inline(always)]
    pub(super) fn stretch<L: Lanes>(
        planes: &[Self],
        wanted: u32,
        rays: &Rays<L>,
        speeds: &[L],
    ) -> Stretch<L> {
        let mut stretch = Stretch::all(rays.origin.x);
        for (face, plane) in (0..).zip(planes) {
            if wanted >> face & 1 == 1 {
                let speed = match speeds.get(face as usize) {
                    Some(speed) => *speed,
                    None => plane.speed(rays.dir),
                };
                let [from, to] = plane.inside(rays, speed);
                stretch = stretch.cut(from, to, face);
            }
        }
        stretch
    }

    /// How fast lines rise above the plane, in lengths of the normal.
    #[inline(always)]
    pub(crate) fn speed<L: Lanes>(&self, dir: Vec3<L>) -> L {
        Vec3::same(dir.x, self.normal).dot(dir)
    }
}
