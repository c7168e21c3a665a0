//! Small things in large boxes, measured by rays of their own.
//!
//! The rays of a beam through the bounds of a scene are even over all of it, and next to none
//! meets a screw in a hall, or either of two balls far apart. So space is divided: boxes around
//! what is near to each other and of like size, in an order, and each point is of the first box
//! that holds it. The solid within each is measured by itself and the sums are added up. That is
//! right however the boxes lie, as long as they hold the solid together; nothing is cut but
//! the rays.
//!
//! # Why boxes are a little larger than what they hold
//!
//! A face that lies in a side of a box would be on either side of it, as rounding has it, and so
//! its area would count once, twice or not at all. Faces lie in the sides of the boxes of leaves
//! as a rule, but seldom beside them by an odd fraction of their size.

use super::beam::Beam;
use super::lattice::{FIRST, Sampling};
use super::spread::REPLICATES;
use crate::aabb::Aabb;
use crate::ray::{Crossing, Ray, Span};
use crate::scene::Scene;

/// A part of space, and beams through a box around it.
pub(super) struct Stratum {
    /// A box that the part is in.
    pub(super) bounds: Aabb,
    pub(super) beams: Vec<Beam>,
    /// Boxes that hold what is not of the part; nothing at all is cut where this is `None`.
    others: Option<Vec<Aabb>>,
}

/// A stretch of a span that is of a part of space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Clipped {
    pub(super) from: f64,
    pub(super) to: f64,
    /// Where the span begins and ends, if that is in it.
    pub(super) ends: [Option<Crossing>; 2],
}

impl Stratum {
    /// All of space, as far as something matters within these bounds.
    pub(super) fn whole(bounds: Aabb, beams: Vec<Beam>) -> Self {
        Self { bounds, beams, others: None }
    }

    /// The parts of space in which a scene is best measured apart. If few rays are allowed there
    /// are few.
    pub(super) fn divide(
        scene: &Scene,
        sampling: &Sampling,
        beams: impl Fn(Aabb) -> Vec<Beam>,
    ) -> Vec<Self> {
        /// First rounds of all strata may take this part of the rays that are allowed.
        const FIRST_ROUND: u64 = 8;
        const MOST: u64 = 64;
        let each = FIRST * (REPLICATES * beams(scene.bounds()).len()) as u64;
        let most = (sampling.max_rays / (FIRST_ROUND * each)).min(MOST);
        let boxes = divided(scene.pieces(), most);
        if boxes.len() < 2 {
            return vec![Self::whole(scene.bounds(), beams(scene.bounds()))];
        }
        let rounding = 64.0 * f64::EPSILON * scene.bounds().reach();
        let room = 4.0 * scene.worst_slack() + rounding;
        let boxes: Vec<Aabb> = boxes.iter().map(|b| with_room(b, room)).collect();
        let one = |(i, &bounds): (usize, &Aabb)| {
            let meets = |other: &&Aabb| !other.intersection(bounds).is_empty();
            let others = boxes[..i].iter().filter(meets).copied().collect();
            Self { bounds, beams: beams(bounds), others: Some(others) }
        };
        boxes.iter().enumerate().map(one).collect()
    }

    /// Calls `visit` with each stretch of some spans of a ray that is of the part. `kept` is
    /// scratch memory.
    pub(super) fn clip(
        &self,
        ray: &Ray,
        spans: &[Span],
        kept: &mut Vec<[f64; 2]>,
        mut visit: impl FnMut(Clipped),
    ) {
        if self.others.is_none() {
            for &Span { enter, exit } in spans {
                let ends = [Some(enter), Some(exit)];
                visit(Clipped { from: enter.t, to: exit.t, ends });
            }
            return;
        }
        self.keep(ray, kept);
        for &Span { enter, exit } in spans {
            for &[start, end] in &*kept {
                let (from, to) = (start.max(enter.t), end.min(exit.t));
                if from < to {
                    let here = |at: Crossing| (start <= at.t && at.t < end).then_some(at);
                    visit(Clipped { from, to, ends: [enter, exit].map(here) });
                }
            }
        }
    }

    /// The stretches of a ray that are of the part, each with its start and without its end,
    /// from the first to the last, into `kept`.
    fn keep(&self, ray: &Ray, kept: &mut Vec<[f64; 2]>) {
        kept.clear();
        let Some(others) = &self.others else { return };
        kept.extend(stretch(&self.bounds, ray));
        for other in others {
            let Some([from, to]) = stretch(other, ray) else { continue };
            let mut i = 0;
            while i < kept.len() {
                let [start, end] = kept[i];
                if to <= start || end <= from {
                    i += 1;
                    continue;
                }
                kept.remove(i);
                for left in [[start, from], [to, end]] {
                    if left[0] < left[1] {
                        kept.insert(i, left);
                        i += 1;
                    }
                }
            }
        }
    }
}

/// Where a ray is in a box: from a place on, and before another.
fn stretch(bounds: &Aabb, ray: &Ray) -> Option<[f64; 2]> {
    let [mut from, mut to] = [f64::NEG_INFINITY, f64::INFINITY];
    for axis in 0..3 {
        let at = |side: f64| (side - ray.origin[axis]) / ray.dir[axis];
        let [one, other] = [bounds.min[axis], bounds.max[axis]].map(at);
        (from, to) = (from.max(one.min(other)), to.min(one.max(other)));
    }
    (from < to).then_some([from, to])
}

/// A box that is larger by a part of its size that is no round number, another one on each
/// side, and by some room.
fn with_room(bounds: &Aabb, room: f64) -> Aabb {
    const BEFORE: f64 = 0.007_390_561;
    const BEHIND: f64 = 0.008_103_083;
    let size = bounds.size();
    let (before, behind) = (BEFORE * size + room, BEHIND * size + room);
    Aabb::new(bounds.min - before, bounds.max + behind)
}

/// More boxes than this are not looked at one by one.
const MOST_PIECES: usize = 1024;

/// A division must be worth so many times what it costs.
const GAIN: f64 = 4.0;

/// Hulls of some boxes in which rays are not wasted, smaller ones first, at most `most`: one if it
/// does not pay to divide.
fn divided(pieces: Vec<Aabb>, most: u64) -> Vec<Aabb> {
    let is_worth = !pieces.is_empty() && pieces.len() <= MOST_PIECES && most > 1;
    let cost = |of: &[Aabb]| Group { pieces: of.to_vec() }.cost();
    // Each group costs one at least, and there would be two.
    if !is_worth || cost(&pieces) < 2.0 * GAIN {
        return Vec::new();
    }
    let tree = Tree::over(pieces);
    let mut boxes = tree.best(most);
    boxes.sort_by(|a, b| a.half_area().total_cmp(&b.half_area()));
    boxes
}

/// Some boxes that are measured together.
struct Group {
    pieces: Vec<Aabb>,
}

impl Group {
    fn hull(&self) -> Aabb {
        self.pieces.iter().fold(Aabb::EMPTY, |hull, &piece| hull.hull(piece))
    }

    /// How many rays it takes for one of them to meet some piece of each size, as far as their
    /// boxes say.
    ///
    /// Sizes are alike up to a factor of two: of a thousand specks each may be missed, and all
    /// of them are not.
    fn cost(&self) -> f64 {
        /// Areas that are alike.
        const ALIKE: f64 = 4.0;
        let mut areas: Vec<f64> = self.pieces.iter().map(Aabb::half_area).collect();
        areas.sort_by(f64::total_cmp);
        let (mut first, mut end, mut sum) = (0, 0, 0.0);
        let mut least = f64::INFINITY;
        for &area in &areas {
            while end < areas.len() && areas[end] <= ALIKE * area {
                sum += areas[end];
                end += 1;
            }
            while areas[first] * ALIKE < area {
                sum -= areas[first];
                first += 1;
            }
            // Differences of sums may be off by rounding.
            least = least.min(sum.max(area));
        }
        (self.hull().half_area() / least).max(1.0)
    }

    /// In two, each as close together as can be.
    fn split(mut self) -> [Self; 2] {
        let count = self.pieces.len();
        let keys: [fn(&Aabb) -> f64; 4] =
            [|b| b.center().x, |b| b.center().y, |b| b.center().z, Aabb::half_area];
        let mut best = (f64::INFINITY, 0, 1_usize);
        let mut behind = vec![0.0; count];
        for (k, key) in keys.iter().enumerate() {
            self.pieces.sort_by(|a, b| key(a).total_cmp(&key(b)));
            let mut hull = Aabb::EMPTY;
            for i in (1..count).rev() {
                hull = hull.hull(self.pieces[i]);
                behind[i] = (count - i) as f64 * hull.half_area();
            }
            hull = Aabb::EMPTY;
            for ((i, behind), &piece) in (1_u32..).zip(&behind[1..]).zip(&self.pieces) {
                hull = hull.hull(piece);
                let sum = f64::from(i) * hull.half_area() + behind;
                if sum < best.0 {
                    best = (sum, k, i as usize);
                }
            }
        }
        let (_, k, at) = best;
        self.pieces.sort_by(|a, b| keys[k](a).total_cmp(&keys[k](b)));
        let rest = self.pieces.split_off(at);
        [self, Self { pieces: rest }]
    }
}

/// Groups in two, and these in two again, as far as it can pay.
struct Tree {
    nodes: Vec<Node>,
}

struct Node {
    hull: Aabb,
    cost: f64,
    /// Nodes with higher numbers.
    halves: Option<[usize; 2]>,
}

impl Tree {
    fn over(pieces: Vec<Aabb>) -> Self {
        let node = |group: &Group| {
            let (hull, cost) = (group.hull(), group.cost());
            Node { hull, cost, halves: None }
        };
        let all = Group { pieces };
        let mut nodes = vec![node(&all)];
        let mut open = vec![(0, all)];
        while let Some((number, group)) = open.pop() {
            if group.pieces.len() < 2 || nodes[number].cost < 2.0 * GAIN {
                continue;
            }
            let halves = group.split();
            nodes[number].halves = Some([nodes.len(), nodes.len() + 1]);
            for half in halves {
                nodes.push(node(&half));
                open.push((nodes.len() - 1, half));
            }
        }
        let mut tree = Self { nodes };
        tree.prune();
        tree
    }

    /// Takes back divisions that do not pay.
    fn prune(&mut self) {
        let mut costs = vec![0.0; self.nodes.len()];
        for i in (0..self.nodes.len()).rev() {
            let Node { cost, halves, .. } = &mut self.nodes[i];
            let apart = halves.map(|halves| halves.map(|half| costs[half]));
            costs[i] = match apart {
                Some([a, b]) if GAIN * (a + b) <= *cost => a + b,
                _ => {
                    *halves = None;
                    *cost
                }
            };
        }
    }

    /// The hulls of at most so many groups, of which those are divided first that cost most.
    fn best(&self, most: u64) -> Vec<Aabb> {
        let mut groups = vec![0];
        while (groups.len() as u64) < most {
            let cost = |i: &usize| self.nodes[*i].cost;
            let worst = (0..groups.len())
                .filter(|&k| self.nodes[groups[k]].halves.is_some())
                .max_by(|&j, &k| cost(&groups[j]).total_cmp(&cost(&groups[k])));
            let Some(worst) = worst else { break };
            if let Some([a, b]) = self.nodes[groups[worst]].halves {
                groups[worst] = a;
                groups.push(b);
            }
        }
        groups.iter().map(|&i| self.nodes[i].hull).collect()
    }
}
