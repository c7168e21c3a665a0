//! Along one ray of a block, through few leaves.

use std::cmp::Ordering;

use super::block::Slot;

/// A way through a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outcome {
    /// The solid's boundary is not crossed.
    Nothing,
    /// It is first crossed there.
    Crossed(Step),
    /// Stretches end at the same place.
    Tied,
    /// Two crossings are one number on the ray.
    Collapsed,
}

/// The ends of stretches: places, and which end of which slot (2 i or 2 i + 1).
pub(super) type Ends = Vec<(f64, u32)>;

/// The solid in a region, as a function of being inside or outside of the leaves that matter
/// there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Logic {
    /// For each combination one bit. The state has a bit for each leaf that one is inside of.
    Table(u64),
    /// All literals have to hold. The state counts those that do not.
    All {
        /// How many those are outside of all leaves.
        start: u64,
    },
    /// One literal has to hold. The state counts those that do.
    Any {
        /// How many those are outside of all leaves.
        start: u64,
    },
}

/// With at most this many leaves the solid is a table of their states.
pub(super) const FEW: usize = 6;

impl Logic {
    /// From the answers for the numbers whose bits are the states. They are asked for in an
    /// order in which one bit differs from the one before (a Gray code).
    pub(super) fn table(leaves: usize, mut flipped: impl FnMut(usize) -> bool) -> Self {
        let mut table = 0;
        let mut state = 0_u32;
        for i in 0..1_u32 << leaves {
            let bit = if i == 0 { leaves } else { i.trailing_zeros() as usize };
            let is_inside = flipped(bit);
            if i > 0 {
                state ^= 1 << bit;
            }
            table |= u64::from(is_inside) << state;
        }
        Self::Table(table)
    }

    /// What entering a leaf adds to the state, and leaving it takes away; `number` is the
    /// leaf's in the table.
    pub(super) fn weight(self, number: usize, complement: bool) -> u64 {
        let rises = match self {
            Self::Table(_) => return 1 << number,
            Self::All { .. } => complement,
            Self::Any { .. } => !complement,
        };
        // In arithmetic modulo 2⁶⁴, this is one less.
        if rises { 1 } else { u64::MAX }
    }

    fn start(self) -> u64 {
        match self {
            Self::Table(_) => 0,
            Self::All { start } | Self::Any { start } => start,
        }
    }

    fn holds(self, state: u64) -> bool {
        match self {
            Self::Table(table) => table >> state & 1 == 1,
            Self::All { .. } => state == 0,
            Self::Any { .. } => state > 0,
        }
    }
}

/// The changes of the solid along one ray of a block.
pub(super) struct Walk<'a> {
    logic: Logic,
    slots: &'a [Slot],
    ends: &'a [(f64, u32)],
    next: usize,
    state: u64,
    inside: bool,
}

/// A change of the solid at a place on a line, at an end of a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    pub(super) t: f64,
    /// The start (2 i) or the end (2 i + 1) of the stretch in slot i.
    pub(super) end: u32,
    /// Whether others end at the same place.
    pub(super) tied: bool,
    /// Whether the solid is entered.
    pub(super) enters: bool,
}

impl<'a> Walk<'a> {
    /// From the start of a line. What was in `ends` does not matter.
    pub(super) fn new(
        logic: Logic,
        slots: &'a [Slot],
        ray: usize,
        ends: &'a mut Ends,
    ) -> Self {
        ends.clear();
        let passed = match logic {
            Logic::All { .. } => gather_within(slots, ray, ends),
            Logic::Table(_) | Logic::Any { .. } => {
                (0..).zip(slots).for_each(|(i, slot)| gather(i, slot, ray, ends));
                0
            }
        };
        settle(ends);
        let state = logic.start().wrapping_sub(passed);
        Self { logic, slots, ends, next: 0, state, inside: logic.holds(state) }
    }

    /// The place of the next end, whatever it does to the solid.
    fn peek(&self) -> Option<f64> {
        self.ends.get(self.next).map(|&(t, _)| t)
    }
}

impl Iterator for Walk<'_> {
    type Item = Step;

    fn next(&mut self) -> Option<Step> {
        while let Some(&(t, end)) = self.ends.get(self.next) {
            let first = self.next;
            #[expect(clippy::float_cmp, reason = "one place is one number")]
            while let Some(&(_, end)) = self.ends.get(self.next).filter(|e| e.0 == t) {
                let weight = self.slots[end as usize / 2].weight;
                let weight = if end % 2 == 0 { weight } else { weight.wrapping_neg() };
                self.state = self.state.wrapping_add(weight);
                self.next += 1;
            }
            let enters = self.logic.holds(self.state);
            if enters != self.inside {
                self.inside = enters;
                return Some(Step { t, end, tied: self.next > first + 1, enters });
            }
        }
        None
    }
}

/// The first crossing whose place on the ray is in a range.
pub(super) fn first(
    mut walk: Walk<'_>,
    [low, high]: [f64; 2],
    on_ray: impl Fn(f64) -> f64,
) -> Outcome {
    while let Some(step) = walk.next() {
        let place = on_ray(step.t);
        if place >= high {
            break;
        }
        if place >= low {
            if step.tied {
                return Outcome::Tied;
            }
            if walk.peek().is_some_and(|next| on_ray(next) <= place) {
                return Outcome::Collapsed;
            }
            return Outcome::Crossed(step);
        }
    }
    Outcome::Nothing
}

/// Collects the ends of the stretch in slot i.
#[inline]
fn gather(i: u32, slot: &Slot, ray: usize, ends: &mut Ends) {
    let (enter, exit) = (slot.enter[ray], slot.exit[ray]);
    if enter < exit {
        ends.extend([(enter, 2 * i), (exit, 2 * i + 1)]);
    }
}

/// Collects ends where the ray has to be inside of some leaves and outside of others, as far
/// as they can matter: says how many of the first it has come into before that.
///
/// It is inside of all of the first between the last of their starts and the first of their
/// ends; what comes before and after does not matter.
fn gather_within(slots: &[Slot], ray: usize, ends: &mut Ends) -> u64 {
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for leaf in slots.chunk_by(|a, b| a.leaf == b.leaf).filter(|s| !s[0].is_cut()) {
        let first = leaf.iter().map(|slot| slot.enter[ray]).fold(f64::INFINITY, f64::min);
        let is_there = |slot: &&Slot| slot.enter[ray] < slot.exit[ray];
        let exits = leaf.iter().filter(is_there).map(|slot| slot.exit[ray]);
        let last = exits.fold(f64::NEG_INFINITY, f64::max);
        (from, to) = (from.max(first), to.min(last));
    }
    if from >= to {
        return 0;
    }
    let mut passed = 0;
    for (i, slot) in (0..).zip(slots) {
        let (enter, exit) = (slot.enter[ray], slot.exit[ray]);
        if slot.is_cut() {
            if exit >= from && enter <= to {
                gather(i, slot, ray, ends);
            }
        } else if slot.is_alone {
            if enter < from {
                passed += 1;
            } else {
                ends.push((enter, 2 * i));
            }
            if exit <= to {
                ends.push((exit, 2 * i + 1));
            }
        } else {
            gather(i, slot, ray, ends);
        }
    }
    passed
}

/// Puts ends in the order in which they come, those at one place as they were collected. Leaves come
/// about in the order in which rays meet them, so that few have far to go; but where very many surfaces
/// coincide, all that is left has to go past all of what is entered.
#[inline]
fn settle(ends: &mut Ends) {
    /// As many ends are put in order by hand in the time that a sort takes to begin.
    const BY_HAND: usize = 64;
    if ends.len() > BY_HAND {
        ends.sort_by(|a, b| a.0.partial_cmp(&b.0).unwrap_or(Ordering::Equal));
        return;
    }
    for i in 1..ends.len() {
        let end = ends[i];
        let mut place = i;
        while place > 0 && ends[place - 1].0 > end.0 {
            ends[place] = ends[place - 1];
            place -= 1;
        }
        ends[place] = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_come_in_order_and_equal_ones_as_they_were_collected() {
        for count in [0_u32, 1, 2, 63, 64, 65, 66, 1000] {
            // Places that repeat, and two zeros that are one place.
            let place = |i: u32| match i.wrapping_mul(2_654_435_761) >> 28 {
                0 if i.is_multiple_of(2) => -0.0,
                place => f64::from(place),
            };
            let mut ends: Ends = (0..count).map(|i| (place(i), i)).collect();
            settle(&mut ends);
            assert_eq!(ends.len(), count as usize);
            let is_before = |pair: &[(f64, u32)]| {
                let [(a, i), (b, j)] = pair else { return false };
                a < b || (a <= b && i < j)
            };
            assert!(ends.windows(2).all(is_before), "{count}");
        }
    }
}
