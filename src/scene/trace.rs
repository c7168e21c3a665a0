//! One ray through a scene: gather, sort, sweep.

use std::cmp::Ordering;

use glam::DVec3;

use super::Scene;
use super::points::{Around, Room};
use crate::ray::{Crossing, Ray, Sense, Span};
use crate::shape::{ALL, Event, Line, Sink};

/// Scratch memory for queries on a scene; make one for each thread.
///
/// Between queries every counter is back where it was, because every leaf is left as often
/// as it is entered; so a query costs what it meets, not what the scene holds.
#[derive(Debug)]
pub struct Tracer<'a> {
    pub(super) scene: &'a Scene,
    /// How many children of each node are true.
    pub(super) counts: Vec<u32>,
    /// How often each leaf has been entered and not yet left.
    winding: Vec<i32>,
    pub(super) events: Vec<Event>,
    /// The meshes that the line of the ray asked last can meet.
    pub(super) meshes: Vec<u32>,
    /// Where on that line one of them matters.
    pub(super) matters: Vec<[f64; 2]>,
    /// Of the events at one place, which are of leaves that had the root's value before, as
    /// had all nodes above them.
    followers: Vec<bool>,
    pub(super) spans: Vec<Span>,
    /// How many spans and gaps of the ray asked last have both ends at the same number.
    pub(super) collapsed: u64,
    /// Where points can be told from surfaces.
    pub(super) room: Option<Room>,
    /// The leaves around the point asked last.
    pub(super) around: Around,
}

/// What the solid does in a part of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Change {
    /// Nothing.
    None,
    /// This first.
    First(Crossing),
    /// Two things at one `t` of the ray.
    Collapsed,
}

/// The direction in which points are asked about, (√0.3, √0.1, √0.6): along no axis,
/// diagonal or other line that models are full of.
pub(super) const PROBE: DVec3 = DVec3::new(
    0.547_722_557_505_166_1,
    0.316_227_766_016_837_94,
    0.774_596_669_241_483_4,
);

impl<'a> Tracer<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            counts: scene.far_away.clone(),
            winding: vec![0; scene.shapes.len()],
            events: Vec::new(),
            meshes: Vec::new(),
            matters: Vec::new(),
            followers: Vec::new(),
            spans: Vec::new(),
            collapsed: 0,
            room: Room::of(scene),
            around: Around::default(),
        }
    }

    /// The stretches of a ray inside the solid, over the whole line: in order, disjoint,
    /// none empty.
    ///
    /// Touching stretches are one; where the ray only touches the solid there is none. A
    /// ray within a face counts as moved a little to one side, the same for all faces that
    /// lie in one plane. Stretches whose ends are the same number `t` are left out, and so
    /// are such gaps.
    pub fn spans(&mut self, ray: &Ray) -> &[Span] {
        self.clear();
        if let Some(line) = Line::new(ray, &self.scene.stage) {
            self.gather(&line);
            self.sweep(&line, [f64::NEG_INFINITY, f64::INFINITY]);
            debug_assert!(self.counts == self.scene.far_away, "the counters are back");
        }
        &self.spans
    }

    /// The answer of [`Tracer::spans`] once more, for the ray that was asked last.
    pub(crate) fn spans_found(&self) -> &[Span] {
        &self.spans
    }

    /// All crossings with all leaves that the line can meet, in order.
    fn gather(&mut self, line: &Line) {
        let Self { scene, events, .. } = self;
        events.clear();
        let slabs = scene.hierarchy.slabs(line.origin, line.dir);
        scene.hierarchy.crossed(&slabs, |leaf| {
            scene.shapes[leaf as usize].crossings(ALL, line, &mut Sink { events, leaf });
        });
        events.sort_unstable_by(in_order);
    }

    /// Walks along the line, toggling all leaves that are crossed at one place before
    /// looking whether the solid was entered or left there.
    fn sweep(&mut self, line: &Line, within: [f64; 2]) {
        let mut entered = None;
        let mut from = 0;
        while from < self.events.len() {
            let group = self.group(from);
            from = group.end;
            if let Some((Event { t, leaf, face, .. }, sense)) = self.pass(group) {
                let crossing = Crossing { t: line.on_ray(t), leaf, face, sense };
                if is_within(crossing.t, within) {
                    self.change(&mut entered, crossing);
                }
            }
        }
        debug_assert!(entered.is_none(), "every leaf is left as often as it is entered");
    }

    /// Forgets the spans that were found.
    pub(super) fn clear(&mut self) {
        self.spans.clear();
        self.collapsed = 0;
    }

    /// Adds the next change to the spans. Between two of them it is kept where the solid was
    /// entered.
    pub(super) fn change(&mut self, entered: &mut Option<Crossing>, crossing: Crossing) {
        match entered.take() {
            None => *entered = Some(crossing),
            Some(enter) if enter.t < crossing.t => {
                self.append(Span { enter, exit: crossing });
            }
            Some(_) => self.collapsed += 1,
        }
    }

    /// As [`Tracer::spans`], if all of them are between two places of the ray and only some
    /// leaves need to be looked at there, with whose crossings a list is filled, and the
    /// counters of the others are given.
    pub(super) fn spans_among(
        &mut self,
        counts: &mut Vec<u32>,
        line: &Line,
        within: [f64; 2],
        fill: impl FnOnce(&mut Vec<Event>),
    ) {
        self.clear();
        self.events.clear();
        fill(&mut self.events);
        self.events.sort_unstable_by(in_order);
        std::mem::swap(&mut self.counts, counts);
        self.sweep(line, within);
        std::mem::swap(&mut self.counts, counts);
    }

    /// The first change of the solid whose place on the ray is in a range, if only some
    /// leaves need to be looked at, with whose crossings a list is filled, and the counters of the
    /// others are given.
    pub(super) fn first_change(
        &mut self,
        counts: &mut Vec<u32>,
        line: &Line,
        fill: impl FnOnce(&mut Vec<Event>),
        [low, high]: [f64; 2],
    ) -> Change {
        self.events.clear();
        fill(&mut self.events);
        self.events.sort_unstable_by(in_order);
        std::mem::swap(&mut self.counts, counts);
        let mut found = Change::None;
        let mut from = 0;
        while from < self.events.len() {
            let t = self.events[from].t;
            let place = line.on_ray(t);
            if found == Change::None && place >= high {
                break;
            }
            let group = self.group(from);
            let change = self.pass(group.clone());
            from = group.end;
            let Some((Event { leaf, face, .. }, sense)) = change else {
                continue;
            };
            match found {
                Change::None if place >= low => {
                    found = Change::First(Crossing { t: place, leaf, face, sense });
                }
                Change::None => {}
                Change::First(crossing) => {
                    if place <= crossing.t {
                        found = Change::Collapsed;
                    }
                    break;
                }
                Change::Collapsed => break,
            }
        }
        self.pass_on_from(from);
        std::mem::swap(&mut self.counts, counts);
        found
    }

    /// The events at the same place as one.
    pub(super) fn group(&self, from: usize) -> std::ops::Range<usize> {
        let t = self.events[from].t;
        #[expect(clippy::float_cmp, reason = "one place is one number")]
        let group = self.events[from..].iter().take_while(|event| event.t == t).count();
        from..from + group
    }

    /// Toggles the leaves of the events at one place; says what the solid does there, and to which
    /// event that is put down.
    #[inline]
    pub(super) fn pass(
        &mut self,
        group: std::ops::Range<usize>,
    ) -> Option<(Event, Sense)> {
        if group.len() == 1 {
            let event = self.events[group.start];
            let changes = self.cross(event.leaf, event.sense);
            return changes.then(|| (event, change_to(self.root())));
        }
        let before = self.root();
        self.note_followers(group.clone(), before);
        self.toggle(group.clone());
        let after = self.root();
        (before != after).then(|| (self.owner(group, after), change_to(after)))
    }

    /// Adds a span behind the others, or to the last one if there is no number between
    /// them: places that differ on the line can be one `t` of a ray that comes from afar.
    fn append(&mut self, span: Span) {
        match self.spans.last_mut() {
            Some(last) if last.exit.t >= span.enter.t => {
                last.exit = span.exit;
                self.collapsed += 1;
            }
            _ => self.spans.push(span),
        }
    }

    /// Toggles the leaves of some events.
    fn toggle(&mut self, group: std::ops::Range<usize>) {
        for event in group {
            let Event { leaf, sense, .. } = self.events[event];
            self.cross(leaf, sense);
        }
    }

    /// Tells the counters that a leaf is entered or left; says whether the solid is.
    #[inline]
    pub(super) fn cross(&mut self, leaf: u32, sense: Sense) -> bool {
        let Scene { program, literals, .. } = self.scene;
        let literal = literals[leaf as usize];
        let winding = &mut self.winding[leaf as usize];
        let was_inside = *winding > 0;
        *winding += match sense {
            Sense::Enter => 1,
            Sense::Exit => -1,
        };
        let is_inside = *winding > 0;
        let value = is_inside != literal.complement;
        was_inside != is_inside && program.toggle(&mut self.counts, literal.parent, value)
    }

    /// Goes back through the first events to before them all, which brings the counters back.
    pub(super) fn pass_back(&mut self, passed: usize) {
        for event in (0..passed).rev() {
            let Event { leaf, sense, .. } = self.events[event];
            self.cross(leaf, sense.reversed());
        }
    }

    /// Toggles what lies up to `t = 0` of the ray asked last, and says how many events that are.
    pub(super) fn pass_to_origin(&mut self, line: &Line) -> usize {
        let passed =
            self.events.iter().take_while(|event| line.on_ray(event.t) <= 0.0).count();
        self.toggle(0..passed);
        passed
    }

    /// Toggles the events from a number on, which brings the counters back.
    pub(super) fn pass_on_from(&mut self, passed: usize) {
        self.toggle(passed..self.events.len());
    }

    /// Whether the place passed last is inside a leaf.
    pub(super) fn is_in(&self, leaf: u32) -> bool {
        self.winding[leaf as usize] > 0
    }

    /// Tells the counters that a leaf counts as inside or outside, for a while.
    pub(super) fn flip(&mut self, leaf: u32, inside: bool) {
        let Scene { program, literals, .. } = self.scene;
        let literal = literals[leaf as usize];
        program.toggle(&mut self.counts, literal.parent, inside != literal.complement);
    }

    /// Whether the place passed last is inside the solid.
    pub(super) fn root(&self) -> bool {
        self.scene.program.root(&self.counts)
    }

    /// Notes which of some events are of leaves that have the root's value, as all nodes
    /// above them do.
    fn note_followers(&mut self, group: std::ops::Range<usize>, value: bool) {
        let mut followers = std::mem::take(&mut self.followers);
        followers.clear();
        let Scene { program, literals, .. } = self.scene;
        let follows = |event: &Event| {
            let literal = literals[event.leaf as usize];
            (self.is_in(event.leaf) != literal.complement) == value
                && program.agrees(&self.counts, literal.parent, value)
        };
        followers.extend(self.events[group].iter().map(follows));
        self.followers = followers;
    }

    /// The event to which a change of the root is put down: the first in the order of the
    /// tree whose leaf changed the same way, and so did all nodes above it.
    ///
    /// There is one, for a node changes only if a child does so the same way. Nodes that keep
    /// their value have no part in it; so it does not matter what is left out below nodes that are
    /// decided anyway.
    fn owner(&self, group: std::ops::Range<usize>, value: bool) -> Event {
        let Scene { program, literals, .. } = self.scene;
        let events = &self.events[group];
        let is_owner = |event: &Event| {
            let literal = literals[event.leaf as usize];
            let is_inside = self.is_in(event.leaf);
            let rises = (event.sense == Sense::Enter) != literal.complement;
            rises == value
                && (is_inside != literal.complement) == value
                && program.agrees(&self.counts, literal.parent, value)
        };
        let mut owners = events.iter().zip(&self.followers);
        owners
            .find(|(event, followed)| **followed && is_owner(event))
            .map_or(events[0], |(event, _)| *event)
    }
}

/// The sense in which the root takes this value.
fn change_to(value: bool) -> Sense {
    if value { Sense::Enter } else { Sense::Exit }
}

/// Whether a place is between two, of which one that is not a number sets no limit.
pub(super) fn is_within(t: f64, [near, far]: [f64; 2]) -> bool {
    !(t < near || t > far)
}

/// By place, then in the order of the tree.
pub(super) fn in_order(a: &Event, b: &Event) -> Ordering {
    a.t.partial_cmp(&b.t)
        .unwrap_or(Ordering::Equal)
        .then(a.leaf.cmp(&b.leaf))
        .then(a.face.cmp(&b.face))
}
