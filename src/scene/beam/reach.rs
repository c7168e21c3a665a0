//! Where the rays of a block, which run the same way, are inside of leaves: from where to where,
//! and not by which face.

use glam::DVec3;
use pulp::{Simd, WithSimd};

use super::block::{BLOCK, Block, Numbers, is_wanted, load, store, zero};
use crate::lanes::{Lanes, Vec3, Vector};
use crate::primitive::Profile;
use crate::shape::{Keeps, Plane, Shape, Wall};

/// A stretch of each line; empty where `from < to` does not hold.
#[derive(Clone, Debug)]
pub(super) struct Reach {
    pub(super) from: Numbers,
    pub(super) to: Numbers,
}

impl Reach {
    pub(super) const ALL: Self =
        Self { from: [f64::NEG_INFINITY; BLOCK], to: [f64::INFINITY; BLOCK] };

    /// What of packet `i` is between two places.
    #[inline(always)]
    fn narrow<S: Simd>(&mut self, i: usize, from: Vector<S>, to: Vector<S>) {
        let simd = from.0;
        let from = from.max(load(simd, &self.from, i));
        let to = to.min(load(simd, &self.to, i));
        store(&mut self.from, i, from);
        store(&mut self.to, i, to);
    }
}

/// Narrows the stretch of each line, or both, to what is inside of a leaf.
pub(super) struct Narrow<'a> {
    pub(super) reaches: &'a mut [Reach],
    /// Whether they are the whole lines before.
    pub(super) afresh: bool,
    pub(super) block: &'a Block,
    pub(super) shape: &'a Shape,
    pub(super) faces: u32,
    pub(super) wanted: u64,
}

impl WithSimd for Narrow<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { reaches, afresh, block, shape, faces, wanted } = self;
        let Some(dir) = block.common_dir() else { return };
        let Some((first, others)) = reaches.split_first_mut() else { return };
        if afresh {
            let never = zero(simd).same(f64::INFINITY);
            for i in 0..packets::<S>(wanted) {
                store(&mut first.from, i, -never);
                store(&mut first.to, i, never);
            }
        }
        let (planes, wall) = shape.sides();
        let of_planes = if wall.is_some() { faces >> 1 } else { faces };
        for (face, plane) in (0..).zip(planes) {
            if of_planes >> face & 1 == 1 {
                first.narrow_to_plane(simd, block, wanted, plane, dir);
            }
        }
        if let Some(wall) = wall
            && faces & 1 == 1
        {
            first.narrow_to_wall(simd, block, wanted, wall, dir, others.first_mut());
        }
    }
}

impl Reach {
    /// Narrows it to the inner side of a plane.
    #[inline(always)]
    fn narrow_to_plane<S: Simd>(
        &mut self,
        simd: S,
        block: &Block,
        wanted: u64,
        plane: &Plane,
        dir: DVec3,
    ) {
        let speed = plane.speed(dir.into());
        let (keeps, axis) = (plane.keeps(speed), plane.axis());
        let like = zero(simd);
        let (never, always) = (like.same(f64::INFINITY), like.same(f64::NEG_INFINITY));
        for i in 0..packets::<S>(wanted) {
            let height = match axis {
                Some(axis) => {
                    let (origin, rest) = block.coordinates(simd, i, axis);
                    plane.height_along_axis(origin, rest)
                }
                None => plane.height(&block.rays(simd, i, Some(Vec3::same(like, dir)))),
            };
            let place = height / like.same(speed);
            match keeps {
                Keeps::Before => {
                    let to = place.min(load(simd, &self.to, i));
                    store(&mut self.to, i, to);
                }
                Keeps::After => {
                    let from = place.max(load(simd, &self.from, i));
                    store(&mut self.from, i, from);
                }
                Keeps::AllOrNothing => {
                    let is_above = !like.less(height);
                    let stays = if plane.above { is_above } else { !is_above };
                    let from = Vector::select(stays, always, never);
                    let to = Vector::select(stays, never, always);
                    self.narrow(i, from, to);
                }
            }
        }
    }

    /// Narrows it to what is inside of a wall, and the other one to what is again.
    #[inline(always)]
    fn narrow_to_wall<S: Simd>(
        &mut self,
        simd: S,
        block: &Block,
        wanted: u64,
        wall: &Wall,
        dir: DVec3,
        again: Option<&mut Self>,
    ) {
        // The frequent families have loops of their own, in which nothing is asked of others.
        match wall.profile {
            Profile::Ball { radius } => {
                let wall = wall.with_profile(Profile::Ball { radius });
                self.narrow_to_known_wall(simd, block, wanted, &wall, dir, again);
            }
            Profile::Cylinder { radius } => {
                let wall = wall.with_profile(Profile::Cylinder { radius });
                self.narrow_to_known_wall(simd, block, wanted, &wall, dir, again);
            }
            Profile::Cone { .. }
            | Profile::Paraboloid { .. }
            | Profile::OneSheet { .. }
            | Profile::TwoSheets { .. } => {
                self.narrow_to_known_wall(simd, block, wanted, wall, dir, again);
            }
        }
    }

    /// The same, where the family may be known.
    #[inline(always)]
    fn narrow_to_known_wall<S: Simd>(
        &mut self,
        simd: S,
        block: &Block,
        wanted: u64,
        wall: &Wall,
        dir: DVec3,
        mut again: Option<&mut Self>,
    ) {
        let dir = Vec3::same(zero(simd), dir);
        let course = wall.course(dir);
        for i in 0..packets::<S>(wanted) {
            if !is_wanted::<S>(wanted, i) {
                continue;
            }
            let [[a, b], [c, d]] = wall.inside(&block.rays(simd, i, Some(dir)), &course);
            if let Some(again) = again.as_deref_mut() {
                store(&mut again.from, i, load(simd, &self.from, i));
                store(&mut again.to, i, load(simd, &self.to, i));
                again.narrow(i, c, d);
            }
            self.narrow(i, a, b);
        }
    }
}

/// How many packets there are up to the last one of which a ray is wanted.
#[inline(always)]
pub(super) fn packets<S: Simd>(wanted: u64) -> usize {
    (BLOCK - wanted.leading_zeros() as usize).div_ceil(S::F64_LANES)
}
