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

use pulp::{Arch, Simd, WithSimd};

use super::block::{BLOCK, Block, Numbers, is_wanted, load, slots_of, store, zero};
use super::bunch::Chords;
use super::reach::{Narrow, Reach, packets};
use crate::lanes::{Lanes, Vector, small};
use crate::shape::Shape;

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
