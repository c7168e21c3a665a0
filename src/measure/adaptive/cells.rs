//! The integral of the area over u, piece by piece.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use super::rule::{Node, Rest, error};
use super::slice::{Scratch, Slice, Stack, Sum, Wanted};
use crate::measure::lattice::in_order;
use crate::progress::Watch;
use crate::scene::Scene;

/// What there is to do with.
#[derive(Clone, Copy)]
pub(super) struct Budget<'a> {
    pub(super) rel_tol: f64,
    pub(super) rays: u64,
    pub(super) deadline: Option<Instant>,
    pub(super) watch: Watch<'a>,
}

/// A volume in units of u, v and w.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Whole {
    /// The sum of all pieces; the rays are those of all slices, also of such that were
    /// replaced by more.
    pub(super) sum: Sum,
    /// Whether the error is as small as was wanted, or rounding allows.
    pub(super) finished: bool,
}

/// A range of u.
#[derive(Clone, Debug)]
struct Piece {
    range: [f64; 2],
    /// How many rules were tried.
    tried: usize,
    /// By the last of them.
    sum: Sum,
}

impl Piece {
    fn new(range: [f64; 2]) -> Self {
        Self { range, tried: 0, sum: Sum { error: f64::INFINITY, ..Sum::default() } }
    }

    /// The rules to be tried next: a first one says nothing of its error.
    fn next_rules(&self) -> std::ops::Range<usize> {
        if self.tried == 0 { 0..2 } else { self.tried..self.tried + 1 }
    }
}

/// A slice to be found.
#[derive(Clone, Copy, Debug)]
struct Place {
    piece: usize,
    rule: usize,
    node: Node,
    u: f64,
}

/// More pieces than this are not worth while.
const MOST_PIECES: usize = 4096;

/// Slices are found in bunches; between them it is asked whether there is time for more.
const BUNCH: usize = 64;

/// The part of the error that may be of slices.
const PART_OF_SLICES: f64 = 0.1;

/// An integral over u on its way.
pub(super) struct Integral<'a> {
    stack: &'a Stack<'a>,
    scene: &'a Scene,
    budget: Budget<'a>,
    pieces: Vec<Piece>,
    /// Rays, spans and uncertain ones of all slices.
    spent: Sum,
    slices: usize,
    start: Instant,
}

impl<'a> Integral<'a> {
    /// Between critical heights.
    pub(super) fn new(
        stack: &'a Stack<'a>,
        scene: &'a Scene,
        heights: &[f64],
        budget: Budget<'a>,
    ) -> Self {
        let pieces = heights.windows(2).map(|pair| Piece::new([pair[0], pair[1]]));
        Self {
            stack,
            scene,
            budget,
            pieces: pieces.collect(),
            spent: Sum::default(),
            slices: 0,
            start: Instant::now(),
        }
    }

    /// Rules with more nodes and smaller pieces, where they are wanted most, until the errors
    /// add up to little enough or the budget is spent.
    pub(super) fn found(mut self) -> Whole {
        loop {
            let sum = self.sum();
            let floor = 2.0 * self.stack.rounding * sum.ends;
            let target = (self.budget.rel_tol * sum.value).max(floor);
            let finished = sum.error <= target;
            if finished || self.pieces.len() > MOST_PIECES {
                return Whole { sum, finished };
            }
            let share = target / (2 * self.pieces.len()) as f64;
            let open = self.refine(share);
            if open.is_empty() {
                return Whole { sum, finished };
            }
            // When slices are known well enough depends on the whole.
            let wide: f64 =
                self.pieces.iter().map(|piece| piece.range[1] - piece.range[0]).sum();
            let part = PART_OF_SLICES * self.budget.rel_tol;
            let error = if sum.error.is_finite() { part * sum.value / wide } else { 0.0 };
            if !self.try_next_rules(&open, Wanted { error, part }) {
                return Whole { sum, finished };
            }
        }
    }

    /// What is known by now.
    fn sum(&self) -> Sum {
        let mut sum = Sum::default();
        self.pieces.iter().for_each(|piece| sum.add(&piece.sum, 1.0));
        let Sum { rays, spans, uncertain, .. } = self.spent;
        Sum { rays, spans, uncertain, ..sum }
    }

    /// The pieces of which the error is larger than some share; those for which all rules have
    /// been tried are cut in two.
    fn refine(&mut self, share: f64) -> Vec<usize> {
        let mut open = Vec::new();
        let mut pieces = Vec::new();
        for piece in std::mem::take(&mut self.pieces) {
            let is_open = piece.sum.error > share;
            if is_open && piece.tried == self.stack.rules.len() {
                let [from, to] = piece.range;
                let middle = 0.5 * (from + to);
                open.extend([pieces.len(), pieces.len() + 1]);
                pieces.extend([[from, middle], [middle, to]].map(Piece::new));
                continue;
            }
            if is_open {
                open.push(pieces.len());
            }
            pieces.push(piece);
        }
        self.pieces = pieces;
        open
    }

    /// Tries the next rules on some pieces; says whether there was time for all.
    fn try_next_rules(&mut self, open: &[usize], wanted: Wanted) -> bool {
        let mut places = Vec::new();
        for &piece in open {
            let [from, to] = self.pieces[piece].range;
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            for rule in self.pieces[piece].next_rules() {
                places.extend(self.stack.rules[rule].nodes.iter().map(|node| Place {
                    piece,
                    rule,
                    node: *node,
                    u: middle + half * node.x,
                }));
            }
        }
        let mut slices = Vec::new();
        for bunch in places.chunks(BUNCH) {
            let Some(found) = self.slices(bunch, wanted) else { return false };
            slices.extend(found);
        }
        let mut from = 0;
        let mut cuts = Vec::new();
        for &i in open {
            let count =
                places[from..].iter().take_while(|place| place.piece == i).count();
            let found = from..from + count;
            from += count;
            let (places, slices) = (&places[found.clone()], &slices[found]);
            self.pieces[i].take(places, slices);
            if let Some(cut) = self.change(i, places, slices) {
                cuts.push((i, cut));
            }
        }
        for (i, cut) in cuts.into_iter().rev() {
            let [low, high] = self.pieces[i].range;
            let parts = [[low, cut], [cut, high]].map(Piece::new);
            self.pieces.splice(i..=i, parts);
        }
        true
    }

    /// Some slices, unless there is no time for them.
    fn slices(&mut self, places: &[Place], wanted: Wanted) -> Option<Vec<Slice>> {
        let Self { stack, scene, budget, .. } = *self;
        let ahead = places.len() as f64 / self.slices.max(1) as f64;
        if self.spent.rays as f64 * (1.0 + ahead) > budget.rays as f64 {
            return None;
        }
        let is_late = |more: f64| {
            budget.deadline.is_some_and(|deadline| {
                let ahead = self.start.elapsed().mul_f64(more);
                Instant::now().checked_add(ahead).is_none_or(|then| then > deadline)
            })
        };
        if is_late(ahead.min(1e6)) && self.slices > 0 {
            return None;
        }
        let late = AtomicBool::new(false);
        let slices = in_order(
            places.len() as u64,
            &|| Scratch::new(scene.tracer()),
            |scratch, i| {
                if late.load(Ordering::Relaxed) || is_late(0.0) {
                    late.store(true, Ordering::Relaxed);
                    return Slice::default();
                }
                let u = usize::try_from(i).map_or(f64::NAN, |i| places[i].u);
                let slice = stack.area(u, wanted, scratch);
                if (budget.watch)(slice.sum.rays).is_break() {
                    late.store(true, Ordering::Relaxed);
                }
                slice
            },
        );
        if late.load(Ordering::Relaxed) {
            return None;
        }
        self.slices += slices.len();
        for Slice { sum, .. } in &slices {
            self.spent.rays += sum.rays;
            self.spent.spans += sum.spans;
            self.spent.uncertain += sum.uncertain;
        }
        Some(slices)
    }

    /// Where in a piece the corners of slices change, which they should not do: an unknown
    /// critical height.
    fn change(&self, piece: usize, places: &[Place], slices: &[Slice]) -> Option<f64> {
        /// As near as this to a critical height corners are too slight to be told apart.
        const MARGIN: f64 = 1e-4;
        let [from, to] = self.pieces[piece].range;
        if to - from <= 2.0 * MARGIN || self.pieces.len() > MOST_PIECES {
            return None;
        }
        let mut seen: Vec<(f64, u64)> = places
            .iter()
            .zip(slices)
            .map(|(place, slice)| (place.u, slice.corners))
            .filter(|(u, _)| (from + MARGIN..to - MARGIN).contains(u))
            .collect();
        seen.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let pair = seen.windows(2).find(|pair| pair[0].1 != pair[1].1)?;
        let ((mut low, corners), (mut high, _)) = (pair[0], pair[1]);
        let mut scratch = Scratch::new(self.scene.tracer());
        loop {
            let middle = 0.5 * (low + high);
            if !(middle > low && middle < high) {
                return Some(high);
            }
            if self.stack.corners(middle, &mut scratch) == corners {
                low = middle;
            } else {
                high = middle;
            }
        }
    }
}

impl Piece {
    /// Takes over what the next rules found.
    fn take(&mut self, places: &[Place], slices: &[Slice]) {
        let rules = self.next_rules();
        let half = 0.5 * (self.range[1] - self.range[0]);
        self.tried = rules.end;
        for rule in rules {
            let (mut now, mut rest) = (Sum::default(), Rest::default());
            for (Place { node, .. }, slice) in
                places.iter().zip(slices).filter(|(place, _)| place.rule == rule)
            {
                now.add(&slice.sum, half * node.weight);
                rest.add(node, slice.sum.value);
            }
            now.error += error(self.sum.value, now.value, half * rest.largest());
            self.sum = now;
        }
    }
}
