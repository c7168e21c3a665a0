//! Along one ray of a block, through few leaves.

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

/// The changes of the solid along one ray of a block.
pub(super) struct Walk<'a> {
    table: Table,
    slots: &'a [Slot],
    ends: &'a [(f64, u32)],
    next: usize,
    state: u32,
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
        table: Table,
        slots: &'a [Slot],
        ray: usize,
        ends: &'a mut Ends,
    ) -> Self {
        let mut count = 0;
        for (i, slot) in (0..).zip(slots) {
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
        let inside = table.holds(0);
        Self { table, slots, ends: &ends[..count], next: 0, state: 0, inside }
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
                self.state ^= 1 << self.slots[end as usize / 2].candidate;
                self.next += 1;
            }
            let enters = self.table.holds(self.state);
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
