//! The chords of a block of rays of one direction, in a solid that is inside of some leaves
//! and outside of others.
//!
//! A ray is inside of all of the first from the last of their starts to the first of their ends,
//! and it does not matter which of them starts or ends it: they narrow one reach of the ray,
//! face by face. Of that the others take away theirs. So neither faces nor lists of events are
//! kept, and what depends on the direction alone is found once. Where the answer could depend on
//! more than places (pieces so thin that their errors are to be known), the ray is left to
//! others.

use std::slice;

use glam::DVec3;
use pulp::{Arch, Simd, WithSimd};

use super::block::{BLOCK, Block, Numbers, is_wanted, load, slots_of, store, zero};
use super::bunch::Chords;
use crate::lanes::{Lanes, Vec3, Vector, small};
use crate::shape::{Keeps, Plane, Profile, Shape, Wall};

/// The most stretches to be outside of for which chords are found.
pub(super) const MOST_CUTS: usize = 8;

/// The chords of rays of a block.
#[derive(Clone, Debug)]
pub(super) struct Lengths {
    /// The sum of the lengths, in steps of the ray.
    length: Numbers,
    /// How many there are, for [`small`] to read.
    count: Numbers,
    /// Where rays are inside of all leaves that they have to be inside of.
    within: Reach,
    /// Where they are inside of the others, as often as they can be.
    cuts: [Reach; MOST_CUTS],
    /// How many of these there are.
    used: usize,
    /// Whether there is a leaf that rays have to be inside of.
    is_kept: bool,
}

impl Lengths {
    pub(super) const EMPTY: Self = Self {
        length: [0.0; BLOCK],
        count: [0.0; BLOCK],
        within: Reach::ALL,
        cuts: [Reach::ALL; MOST_CUTS],
        used: 0,
        is_kept: false,
    };

    /// Forgets all leaves.
    pub(super) fn start(&mut self) {
        self.is_kept = false;
        self.used = 0;
    }

    /// Rays have to be inside of a leaf, as far as some of its faces say. They run the same way,
    /// and come out of it once.
    pub(super) fn keep(
        &mut self,
        arch: Arch,
        block: &Block,
        shape: &Shape,
        faces: u32,
        wanted: u64,
    ) {
        let reaches = slice::from_mut(&mut self.within);
        let afresh = !self.is_kept;
        arch.dispatch(Narrow { reaches, afresh, block, shape, faces, wanted });
        self.is_kept = true;
    }

    /// Rays have to be outside of a leaf. There are at most [`MOST_CUTS`] stretches of it and
    /// of others.
    pub(super) fn cut(
        &mut self,
        arch: Arch,
        block: &Block,
        shape: &Shape,
        faces: u32,
        wanted: u64,
    ) {
        let end = self.used + slots_of(shape, faces);
        let reaches = &mut self.cuts[self.used..end];
        arch.dispatch(Narrow { reaches, afresh: true, block, shape, faces, wanted });
        self.used = end;
    }

    /// Finds the chords between two depths. Says for which rays one of them, or of the gaps
    /// between them, may be no longer than the square root of `thin`.
    pub(super) fn find(
        &mut self,
        arch: Arch,
        block: &Block,
        wanted: u64,
        depth: [f64; 2],
        thin: f64,
    ) -> u64 {
        arch.dispatch(Find { lengths: self, block, wanted, depth, thin }) & wanted
    }

    /// The chords of a ray.
    pub(super) fn chords(&self, ray: usize) -> Chords {
        let spans = small(self.count[ray]) as u64;
        Chords { length: self.length[ray], spans, uncertain: 0 }
    }
}

/// A stretch of each line; empty where `from < to` does not hold.
#[derive(Clone, Debug)]
struct Reach {
    from: Numbers,
    to: Numbers,
}

impl Reach {
    const ALL: Self =
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
struct Narrow<'a> {
    reaches: &'a mut [Reach],
    /// Whether they are the whole lines before.
    afresh: bool,
    block: &'a Block,
    shape: &'a Shape,
    faces: u32,
    wanted: u64,
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
fn packets<S: Simd>(wanted: u64) -> usize {
    (BLOCK - wanted.leading_zeros() as usize).div_ceil(S::F64_LANES)
}

struct Find<'a> {
    lengths: &'a mut Lengths,
    block: &'a Block,
    wanted: u64,
    depth: [f64; 2],
    thin: f64,
}

impl WithSimd for Find<'_> {
    type Output = u64;

    /// As many places for cuts as there are, or a few more.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> u64 {
        match self.lengths.used {
            0 => self.find::<S, 0>(simd),
            1 => self.find::<S, 1>(simd),
            2 => self.find::<S, 2>(simd),
            3 => self.find::<S, 3>(simd),
            _ => self.find::<S, MOST_CUTS>(simd),
        }
    }
}

impl Find<'_> {
    #[inline(always)]
    fn find<S: Simd, const CUTS: usize>(self, simd: S) -> u64 {
        let Self { lengths, block, wanted, depth: [low, high], thin } = self;
        let mut doubt = 0;
        let (zero, one) = (zero(simd), zero(simd).same(1.0));
        let (low, high) = (zero.same(low), zero.same(high));
        let (never, none) = (zero.same(f64::INFINITY), zero.small());
        let cuts = &lengths.cuts[..lengths.used.min(CUTS)];
        for i in 0..packets::<S>(wanted) {
            if !is_wanted::<S>(wanted, i) {
                continue;
            }
            let (mut from, mut to) = (-never, never);
            if lengths.is_kept {
                from = load(simd, &lengths.within.from, i);
                to = load(simd, &lengths.within.to, i);
            }
            // Those that are empty begin nowhere.
            let (mut enters, mut exits) = ([never; CUTS], [never; CUTS]);
            for k in 0..CUTS {
                if let Some(cut) = cuts.get(k) {
                    let (enter, exit) =
                        (load(simd, &cut.from, i), load(simd, &cut.to, i));
                    let is_one = enter.less(exit);
                    enters[k] = Vector::select(is_one, enter, never);
                    exits[k] = Vector::select(is_one, exit, never);
                }
            }
            // Sorted by their starts: neighbours change places, now the even ones, now the odd.
            for pass in 0..CUTS {
                let mut k = pass % 2;
                while k + 1 < CUTS {
                    let wrong = enters[k + 1].less(enters[k]);
                    let (enter, exit) = (enters[k], exits[k]);
                    enters[k] = Vector::select(wrong, enters[k + 1], enter);
                    exits[k] = Vector::select(wrong, exits[k + 1], exit);
                    enters[k + 1] = Vector::select(wrong, enter, enters[k + 1]);
                    exits[k + 1] = Vector::select(wrong, exit, exits[k + 1]);
                    k += 2;
                }
            }
            let (mut length, mut count, mut thinnest) = (zero, none, never);
            // Where it is not known to have been left, and where it was left last.
            let (mut at, mut left) = (from, -never);
            for k in 0..=CUTS {
                let until = if k < CUTS { enters[k].min(to) } else { to };
                let enter = block.places_on_rays(simd, i, at);
                let exit = block.places_on_rays(simd, i, until);
                let outside = enter.less(low) | high.less(exit);
                let is_span = at.less(until) & !outside;
                let (span, gap) = (exit - enter, enter - left);
                length = length + Vector::select(is_span, span, zero);
                count = count + Vector::select(is_span, one, zero);
                let thin = (span * span).min(gap * gap);
                thinnest = Vector::select(is_span, thinnest.min(thin), thinnest);
                left = Vector::select(is_span, exit, left);
                if k < CUTS {
                    at = at.max(exits[k]);
                }
            }
            store(&mut lengths.length, i, length);
            store(&mut lengths.count, i, count);
            let is_thin = !zero.same(thin).less(thinnest);
            if Vector::any(is_thin) {
                doubt |= is_thin.bits() << (i * S::F64_LANES);
            }
        }
        doubt
    }
}
