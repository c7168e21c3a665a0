//! Along one ray of a block, through few leaves.

use super::packet::Slot;

/// A leaf that matters in a cell, and which of its faces do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) leaf: u32,
    pub(super) faces: u32,
}

/// A way through a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outcome {
    /// The solid's boundary is not crossed.
    Nothing,
    /// It is first crossed at this place of the line, at the start (end 2 i) or the end (2 i + 1)
    /// of the stretch in slot i; after that it is inside or not.
    Crossed { t: f64, end: u32, after: bool },
    /// Stretches end at the same place.
    Tied,
    /// Two crossings are one number on the ray.
    Collapsed,
}

/// With at most this many leaves the solid is a table of their states.
pub(super) const FEW: usize = 6;

/// The ends of stretches: places, and which end of which slot (2 i or 2 i + 1). Each of so few
/// leaves has at most four.
pub(super) type Ends = [(f64, u32); 4 * FEW];

pub(super) const NO_ENDS: Ends = [(0.0, 0); 4 * FEW];

/// For each combination of being inside or outside of some leaves, whether the solid is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Table(u64);

impl Table {
    /// From the answers for the numbers whose bits are the states. They are asked for in an
    /// order in which one bit differs from the one before (a Gray code).
    pub(super) fn new(leaves: usize, mut flipped: impl FnMut(usize) -> bool) -> Self {
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
        Self(table)
    }

    fn holds(self, state: u32) -> bool {
        self.0 >> state & 1 == 1
    }
}

/// The first crossing whose place on the ray is in a range. What was in `ends` does not matter.
pub(super) fn first(
    table: Table,
    slots: &[(Slot, u32)],
    ray: usize,
    [low, high]: [f64; 2],
    on_ray: impl Fn(f64) -> f64,
    ends: &mut Ends,
) -> Outcome {
    let mut count = 0;
    for (i, (slot, _)) in (0..).zip(slots) {
        let (enter, exit) = (slot.enter[ray], slot.exit[ray]);
        if enter < exit {
            for end in [(enter, 2 * i), (exit, 2 * i + 1)] {
                let mut place = count;
                while place > 0 && ends[place - 1].0 > end.0 {
                    ends[place] = ends[place - 1];
                    place -= 1;
                }
                ends[place] = end;
                count += 1;
            }
        }
    }
    let ends = &ends[..count];
    let (mut state, mut before, mut i) = (0, table.holds(0), 0);
    while let Some(&(t, end)) = ends.get(i) {
        let group = i;
        #[expect(clippy::float_cmp, reason = "one place is one number")]
        while let Some(&(_, end)) = ends.get(i).filter(|(other, _)| *other == t) {
            state ^= 1 << slots[end as usize / 2].1;
            i += 1;
        }
        let after = table.holds(state);
        if after == before {
            continue;
        }
        before = after;
        let place = on_ray(t);
        if place >= high {
            break;
        }
        if place >= low {
            if i > group + 1 {
                return Outcome::Tied;
            }
            if ends.get(i).is_some_and(|&(next, _)| on_ray(next) <= place) {
                return Outcome::Collapsed;
            }
            return Outcome::Crossed { t, end, after };
        }
    }
    Outcome::Nothing
}
