//! A block of rays through a solid that is inside of some leaves and outside of others.
//!
//! A ray is inside of all of the first from the last of their starts to the first of their ends;
//! of that the others take away theirs. That needs no list of events, so all rays of a packet
//! do it at once. Where the answer could depend on more than places (two things at one place of
//! the ray), the ray is left to others.

use pulp::{Arch, Simd, WithSimd};

use super::block::{BLOCK, Block, Numbers, Slot, is_wanted, load, store};
use crate::lanes::{Lanes, Vector};

/// Whether leaves, of which these are the slots, are of this kind.
pub(super) fn is_simple(slots: &[Slot]) -> bool {
    slots.iter().all(|slot| slot.is_cut() || slot.is_alone)
}

/// Where rays of a block first come into the solid.
#[derive(Clone, Debug)]
pub(super) struct Firsts {
    /// The place on the line.
    pub(super) t: Numbers,
    /// The end of a stretch there, as walks number them.
    pub(super) end: Numbers,
    /// What is known: see the constants.
    pub(super) answer: Numbers,
}

impl Firsts {
    /// The solid is not entered between the depths.
    pub(super) const NOTHING: f64 = 0.0;
    /// It is, at that place.
    pub(super) const ENTERED: f64 = 1.0;
    /// The ray is to be walked along.
    pub(super) const DOUBT: f64 = 2.0;

    pub(super) const EMPTY: Self =
        Self { t: [0.0; BLOCK], end: [0.0; BLOCK], answer: [0.0; BLOCK] };

    /// Finds them between two depths for the rays that are wanted, and perhaps some more.
    pub(super) fn find(
        &mut self,
        arch: Arch,
        block: &Block,
        slots: &[Slot],
        wanted: u64,
        depth: [f64; 2],
    ) {
        arch.dispatch(FindFirsts { firsts: self, block, slots, wanted, depth });
    }
}

struct FindFirsts<'a> {
    firsts: &'a mut Firsts,
    block: &'a Block,
    slots: &'a [Slot],
    wanted: u64,
    depth: [f64; 2],
}

impl WithSimd for FindFirsts<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { firsts, block, slots, wanted, depth: [low, high] } = self;
        for i in 0..BLOCK / S::F64_LANES {
            if !is_wanted::<S>(wanted, i) {
                continue;
            }
            let like = load(simd, &block.offset, i);
            let (mut t, mut end) = (like.same(f64::NEG_INFINITY), like.same(0.0));
            let mut last = like.same(f64::INFINITY);
            let mut number = 0.0;
            for slot in slots {
                if !slot.is_cut() {
                    let enter = load(simd, &slot.enter, i);
                    let later = t.less(enter);
                    t = Vector::select(later, enter, t);
                    end = Vector::select(later, like.same(number), end);
                    last = last.min(load(simd, &slot.exit, i));
                }
                number += 2.0;
            }
            // Rays that are inside of all of the first before the near depth are inside of
            // another leaf there, if they have not come in before.
            let near = like.same(low);
            let mut early = block.places_on_rays(simd, i, t).less(near);
            number = 1.0;
            for slot in slots {
                if slot.is_cut() {
                    let (enter, exit) =
                        (load(simd, &slot.enter, i), load(simd, &slot.exit, i));
                    let starts_before = block.places_on_rays(simd, i, enter).less(near);
                    let ends_before = block.places_on_rays(simd, i, exit).less(near);
                    let holds = early & starts_before & !ends_before;
                    t = Vector::select(holds, exit, t);
                    end = Vector::select(holds, like.same(number), end);
                    early = early & !holds;
                }
                number += 2.0;
            }
            // Each leaf that is left can be the start of another.
            for _ in 0..=slots.len() {
                let before = t;
                number = 1.0;
                for slot in slots {
                    if slot.is_cut() {
                        let enter = load(simd, &slot.enter, i);
                        let exit = load(simd, &slot.exit, i);
                        let within = !t.less(enter) & t.less(exit);
                        t = Vector::select(within, exit, t);
                        end = Vector::select(within, like.same(number), end);
                    }
                    number += 2.0;
                }
                if !Vector::any(before.less(t)) {
                    break;
                }
            }
            let place = block.places_on_rays(simd, i, t);
            let mut here = like.same(0.0);
            let (zero, one) = (like.same(0.0), like.same(1.0));
            for slot in slots {
                let enter = block.places_on_rays(simd, i, load(simd, &slot.enter, i));
                let exit = block.places_on_rays(simd, i, load(simd, &slot.exit, i));
                here = here + Vector::select(enter.equal(place), one, zero);
                here = here + Vector::select(exit.equal(place), one, zero);
            }
            let comes = t.less(last) & place.less(like.same(high));
            let sure = here.equal(one) & !place.less(like.same(low));
            let [nothing, entered, doubt] =
                [Firsts::NOTHING, Firsts::ENTERED, Firsts::DOUBT];
            let answer = Vector::select(sure, like.same(entered), like.same(doubt));
            let answer = Vector::select(comes, answer, like.same(nothing));
            store(&mut firsts.t, i, t);
            store(&mut firsts.end, i, end);
            store(&mut firsts.answer, i, answer);
        }
    }
}
