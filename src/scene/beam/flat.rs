//! A block of rays through a solid that is inside of some leaves and outside of others.
//!
//! A ray is inside of all of the first from the last of their starts to the first of their ends;
//! of that the others take away theirs. That needs no list of events, so all rays of a packet
//! do it at once. Where the answer could depend on more than places (two things at one place of
//! the ray, pieces so thin that their errors are to be known), the ray is left to others.

use pulp::{Arch, Simd, WithSimd};

use super::block::{BLOCK, Block, Numbers, Slot, is_wanted, load, store};
use crate::lanes::{Lanes, Vector};

/// The most leaves to be outside of for which chords are found.
const MOST_CUTS: usize = 8;

/// Whether leaves, of which these are the slots, are of this kind.
pub(super) fn is_simple(slots: &[Slot]) -> bool {
    slots.iter().all(|slot| slot.is_cut() || slot.is_alone)
}

/// Whether they are few enough for chords.
pub(super) fn are_few(slots: &[Slot]) -> bool {
    slots.iter().filter(|slot| slot.is_cut()).count() <= MOST_CUTS
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

/// The chords of rays of a block.
#[derive(Clone, Debug)]
pub(super) struct Lengths {
    /// The sum of the lengths, in steps of the ray.
    pub(super) length: Numbers,
    /// How many there are.
    pub(super) count: Numbers,
    /// The square of the length of the shortest, or of the shortest gap between two.
    pub(super) thinnest: Numbers,
}

impl Lengths {
    pub(super) const EMPTY: Self =
        Self { length: [0.0; BLOCK], count: [0.0; BLOCK], thinnest: [0.0; BLOCK] };

    /// Finds them between two depths for the rays that are wanted, and perhaps some more.
    pub(super) fn find(
        &mut self,
        arch: Arch,
        block: &Block,
        slots: &[Slot],
        wanted: u64,
        depth: [f64; 2],
    ) {
        arch.dispatch(FindLengths { lengths: self, block, slots, wanted, depth });
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
                if !before.less(t).any() {
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

struct FindLengths<'a> {
    lengths: &'a mut Lengths,
    block: &'a Block,
    slots: &'a [Slot],
    wanted: u64,
    depth: [f64; 2],
}

impl WithSimd for FindLengths<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { lengths, block, slots, wanted, depth: [low, high] } = self;
        for i in 0..BLOCK / S::F64_LANES {
            if !is_wanted::<S>(wanted, i) {
                continue;
            }
            let like = load(simd, &block.offset, i);
            let never = like.same(f64::INFINITY);
            let (mut from, mut to) = (-never, never);
            let (mut enters, mut exits) = ([never; MOST_CUTS], [never; MOST_CUTS]);
            let mut cuts = 0;
            for slot in slots {
                let enter = load(simd, &slot.enter, i);
                let exit = load(simd, &slot.exit, i);
                if slot.is_cut() {
                    enters[cuts] = enter;
                    exits[cuts] = exit;
                    cuts += 1;
                } else {
                    from = from.max(enter);
                    to = to.min(exit);
                }
            }
            // Sorted by their starts: neighbours change places, now the even ones, now the odd.
            for pass in 0..cuts {
                let mut k = pass % 2;
                while k + 1 < cuts {
                    let wrong = enters[k + 1].less(enters[k]);
                    let (enter, exit) = (enters[k], exits[k]);
                    enters[k] = Vector::select(wrong, enters[k + 1], enter);
                    exits[k] = Vector::select(wrong, exits[k + 1], exit);
                    enters[k + 1] = Vector::select(wrong, enter, enters[k + 1]);
                    exits[k + 1] = Vector::select(wrong, exit, exits[k + 1]);
                    k += 2;
                }
            }
            let (zero, one) = (like.same(0.0), like.same(1.0));
            let (mut length, mut count, mut thinnest) = (zero, zero, never);
            // Where it is not known to have been left, and where it was left last.
            let (mut at, mut left) = (from, -never);
            for k in 0..=cuts {
                let until = if k < cuts { enters[k].min(to) } else { to };
                let enter = block.places_on_rays(simd, i, at);
                let exit = block.places_on_rays(simd, i, until);
                let outside = enter.less(like.same(low)) | like.same(high).less(exit);
                let is_span = at.less(until) & !outside;
                let (span, gap) = (exit - enter, enter - left);
                length = length + Vector::select(is_span, span, zero);
                count = count + Vector::select(is_span, one, zero);
                let thin = (span * span).min(gap * gap);
                thinnest = Vector::select(is_span, thinnest.min(thin), thinnest);
                left = Vector::select(is_span, exit, left);
                if k < cuts {
                    at = at.max(exits[k]);
                }
            }
            store(&mut lengths.length, i, length);
            store(&mut lengths.count, i, count);
            store(&mut lengths.thinnest, i, thinnest);
        }
    }
}
