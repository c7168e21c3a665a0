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
        Self::in_order(&boxes, beams)
    }

    /// What is in each of some boxes and in none before it.
    pub(super) fn in_order(
        boxes: &[Aabb],
        beams: impl Fn(Aabb) -> Vec<Beam>,
    ) -> Vec<Self> {
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

/// Hulls of some boxes in which rays are not wasted, smaller ones first, at most `most`: one or none
/// if it does not pay to divide.
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

    /// In two: either each as close together as can be, or the small ones and the large ones,
    /// whichever costs less.
    fn split(self) -> [Self; 2] {
        let cost = |halves: &[Self; 2]| halves[0].cost() + halves[1].cost();
        let (near, alike) = (self.split_by_place(), self.split_by_size());
        if cost(&near) < cost(&alike) { near } else { alike }
    }

    /// Where hulls of so many are smallest.
    fn split_by_place(&self) -> [Self; 2] {
        let mut best: Option<(f64, [Self; 2])> = None;
        for axis in 0..3 {
            let sorted = self.sorted(|piece| piece.center()[axis]);
            let count = sorted.len();
            let mut behind = vec![0.0; count];
            let mut hull = Aabb::EMPTY;
            for (i, &piece) in sorted.iter().enumerate().rev() {
                hull = hull.hull(piece);
                behind[i] = (count - i) as f64 * hull.half_area();
            }
            hull = Aabb::EMPTY;
            let sum = |(i, behind): (usize, &f64)| {
                hull = hull.hull(sorted[i]);
                (i + 1, (i + 1) as f64 * hull.half_area() + behind)
            };
            let sums = behind[1..].iter().enumerate().map(sum);
            let Some((at, sum)) = sums.min_by(|(_, a), (_, b)| a.total_cmp(b)) else {
                continue;
            };
            if best.as_ref().is_none_or(|(least, _)| sum < *least) {
                best = Some((sum, Self::halves(sorted, at)));
            }
        }
        best.map_or_else(|| self.split_by_size(), |(_, halves)| halves)
    }

    /// Where it costs least of the places where sizes differ most.
    fn split_by_size(&self) -> [Self; 2] {
        const TRIED: usize = 4;
        let sorted = self.sorted(Aabb::half_area);
        let step = |i: &usize| sorted[*i].half_area() / sorted[*i - 1].half_area();
        let mut places: Vec<usize> = (1..sorted.len()).collect();
        places.sort_by(|i, j| step(j).total_cmp(&step(i)));
        let cost = |halves: &[Self; 2]| halves[0].cost() + halves[1].cost();
        let tried = places.iter().take(TRIED).map(|&i| Self::halves(sorted.clone(), i));
        let best = tried.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        best.unwrap_or_else(|| Self::halves(sorted, 0))
    }

    fn sorted(&self, key: impl Fn(&Aabb) -> f64) -> Vec<Aabb> {
        let mut sorted = self.pieces.clone();
        sorted.sort_by(|a, b| key(a).total_cmp(&key(b)));
        sorted
    }

    fn halves(mut pieces: Vec<Aabb>, at: usize) -> [Self; 2] {
        let rest = pieces.split_off(at);
        [Self { pieces }, Self { pieces: rest }]
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

#[cfg(test)]
mod tests {
    use glam::{DVec3, dvec3};
    use proptest::prelude::*;

    use super::*;
    use crate::ray::Sense;

    fn cube(center: DVec3, size: f64) -> Aabb {
        Aabb::new(center - 0.5 * size, center + 0.5 * size)
    }

    /// Boxes with corners on a grid, so that many have sides in common.
    fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
        let corner =
            || [0..8_i32, 0..8_i32, 0..8_i32].prop_map(|p| p.map(f64::from).into());
        let one = (corner(), corner()).prop_map(|(a, b): (DVec3, DVec3)| {
            let (min, max) = (a.min(b), a.max(b) + 0.5);
            Aabb::new(min, max)
        });
        prop::collection::vec(one, 1..12)
    }

    proptest! {
        /// However boxes lie: of each span every stretch is of one part, and each end as well.
        #[test]
        fn every_point_of_a_ray_is_of_one_part(
            mut boxes in boxes(),
            [x, y, z] in [-1.0..9.0_f64, -1.0..9.0, -1.0..9.0],
            [a, b, c] in [-1.0..1.0_f64, -1.0..1.0, 0.1..1.0],
            [from, length] in [-4.0..4.0_f64, 0.01..8.0],
        ) {
            boxes.push(cube(DVec3::splat(4.0), 100.0));
            let ray = Ray::new(dvec3(x, y, z), dvec3(a, b, c));
            let at = |t, sense| Crossing { t, leaf: 0, face: 0, sense };
            let enter = at(from, Sense::Enter);
            let exit = at(from + length, Sense::Exit);
            let (mut sum, mut ends, mut kept) = (0.0, [0, 0], Vec::new());
            for stratum in Stratum::in_order(&boxes, |_| Vec::new()) {
                stratum.clip(&ray, &[Span { enter, exit }], &mut kept, |stretch| {
                    sum += stretch.to - stretch.from;
                    for (count, end) in ends.iter_mut().zip(stretch.ends) {
                        *count += u32::from(end.is_some());
                    }
                });
            }
            prop_assert!((sum - length).abs() < 1e-12, "{sum} {length}");
            prop_assert_eq!(ends, [1, 1]);
        }

        /// Nothing is left out, whichever boxes there are and how many parts there may be.
        #[test]
        fn parts_hold_all_pieces(
            pieces in prop::collection::vec(
                ([-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], 0.0..9.0_f64), 1..60
            ),
            most in 1..80_u64,
        ) {
            let piece = |([x, y, z], e): ([f64; 3], f64)| {
                cube(dvec3(x, y, z), 10_f64.powf(-e))
            };
            let pieces: Vec<Aabb> = pieces.into_iter().map(piece).collect();
            let found = divided(pieces.clone(), most);
            prop_assert!(found.len() as u64 <= most);
            for piece in &pieces {
                let holds = |b: &Aabb| b.hull(*piece) == *b;
                prop_assert!(found.is_empty() || found.iter().any(holds));
            }
        }
    }

    #[test]
    fn what_is_close_together_is_not_divided() {
        let at = |x: i32, y: i32| cube(dvec3(f64::from(x), f64::from(y), 0.0), 0.2);
        let pins = || (0..10).flat_map(|x| (0..10).map(move |y| at(x, y)));
        let plate = Aabb::new(dvec3(-1.0, -1.0, -1.0), dvec3(10.0, 10.0, 0.0));
        let is_one = |pieces: Vec<Aabb>| divided(pieces, 64).len() < 2;
        assert!(is_one(pins().collect()));
        assert!(is_one(pins().chain([plate]).collect()));
        assert!(is_one(vec![at(0, 0), at(1, 0)]));
        // One of its kind is.
        let screw = cube(dvec3(3.0, 3.0, 0.3), 0.02);
        assert_eq!(divided(pins().chain([plate, screw]).collect(), 64).len(), 2);
        let far = pins().map(|pin| Aabb::new(pin.min + 1e3, pin.max + 1e3));
        assert_eq!(divided(pins().chain(far).collect(), 64).len(), 2);
    }
}
