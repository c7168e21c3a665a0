//! Surfaces that do not coincide but were meant to are made one.
//!
//! Coincident surfaces have been brought together in groups before ([`super::intern`]). Here
//! two groups are *linked* if leaves of them touch and their surfaces are nowhere on the
//! smaller of the two leaves farther apart than the weld. What is linked, directly or
//! through others, becomes one group under the leader that comes first, the largest. Every
//! surface of it must be within the weld of that leader on its own leaf: nothing moves
//! farther than the weld allows. Where that fails the weld is refused, for to join some of a
//! chain and not others would leave to chance which. Nor may two faces of one leaf get into
//! one group, for the leaf would be gone.
//!
//! None of this depends on the order of the leaves.

use glam::DVec3;

use super::intern::{Face, Sheets, Surfaces};
use super::near::{Cell, Cells};
use super::sheet::{Extent, Sheet, foot, outside, width};
use crate::aabb::Aabb;
use crate::shape::{Plane, Wall};

/// Two surfaces that nearly coincide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weld {
    /// The two leaves, as in [`Scene::leaf`](crate::Scene::leaf).
    pub leaves: [u32; 2],
    /// The face of each.
    pub faces: [u32; 2],
    /// At most how far they are apart, measured square to them, anywhere on the smaller leaf.
    pub distance: f64,
}

/// Surfaces that nearly coincide and are not one.
#[derive(Clone, Debug, PartialEq)]
pub struct NearMisses {
    /// As few pairs as it takes to join all that nearly coincide, those farthest apart first.
    pub pairs: Vec<Weld>,
    /// A weld that makes one of every pair, with which the solid can be compiled, if one was
    /// found.
    pub weld: Option<f64>,
}

/// Two surfaces of different groups, by number, and how far apart they are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    /// The least weld that joins them: the distance of the surfaces or, where that is
    /// larger, of the leaves, beyond what rounding explains.
    needs: f64,
    /// The two, the one that comes first by rank before the other.
    near: u32,
    far: u32,
}

/// Why surfaces that are linked cannot be made one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Refusal {
    /// The leaf of the leader, of one linked with the last, and of the last, which is as far
    /// from the first as `apart`. If the first is the last, two of its faces would be one.
    pub(super) leaves: [u32; 3],
    pub(super) apart: f64,
    /// A smaller weld that does not fail; perhaps zero.
    pub(super) fine: f64,
}

/// How far from where they were given surfaces may be, by leaf.
pub(super) type Reach<'a> = &'a dyn Fn(u32) -> f64;

/// Where something is that has a box and lies somewhere else by up to `spread`.
fn cell(around: Aabb, place: [f64; 3], spread: f64) -> Cell {
    let [low, high] = [(around.min, -spread), (around.max, spread)].map(|(p, s)| {
        let [a, b, c] = place.map(|x| x + s);
        // No number is far away too.
        [p.x, p.y, p.z, a, b, c]
            .map(|x| if x.is_nan() { HUGE } else { x.clamp(-HUGE, HUGE) })
    });
    Cell { low, high }
}

/// Beyond this there is no telling where something is, and no need.
const HUGE: f64 = 1e300;

/// A surface that has a place by which near ones are found.
pub(super) trait Located: Sheet {
    /// Three numbers, and by how much they can differ from those of a surface that is within
    /// twice `moved` of this one on its leaf.
    fn located(&self, moved: f64, extent: &Extent, scale: f64) -> ([f64; 3], f64);
}

impl Located for Plane {
    /// As the key of a plane, but all of the foot.
    fn located(&self, moved: f64, extent: &Extent, scale: f64) -> ([f64; 3], f64) {
        let from = outside(scale);
        let distance = from.distance(extent.center) + extent.radius;
        (foot(self, from).to_array(), 2.0 * moved * (1.0 + distance / extent.radius))
    }
}

impl Located for Wall {
    fn located(&self, moved: f64, _extent: &Extent, _scale: f64) -> ([f64; 3], f64) {
        ([width(self), 0.0, 0.0], 2.0 * moved)
    }
}

impl Surfaces {
    /// Makes one of the surfaces that a weld joins; says which, those farthest apart first,
    /// and how far the surfaces of each leaf have moved.
    pub(super) fn weld(
        &mut self,
        weld: f64,
        extents: &[Extent],
        boxes: &[Aabb],
    ) -> Result<(Vec<Weld>, Vec<f64>), Refusal> {
        let reach = |_| 0.5 * weld;
        let mut moved = vec![0.0; boxes.len()];
        let planes = self.planes.links(extents, boxes, &reach);
        let walls = self.walls.links(extents, boxes, &reach);
        let (welds, _) = self.pairs(&planes, &walls, extents);
        let joined = self.planes.join(&planes, weld, extents, &mut moved);
        let joined =
            joined.and_then(|()| self.walls.join(&walls, weld, extents, &mut moved));
        if let Err(refusal) = joined {
            // What is fine for planes may not be for walls, so both are asked in turn.
            let (mut fine, mut before) = (weld, f64::INFINITY);
            while fine < before {
                before = fine;
                fine = self.planes.largest_fine(&planes, fine, extents);
                fine = self.walls.largest_fine(&walls, fine, extents);
            }
            return Err(Refusal { fine, ..refusal });
        }
        Ok((welds, moved))
    }

    /// The least weld, no smaller than this, that is not refused, as far as larger ones are
    /// refused because surfaces are too far apart: then as large a one is tried as it takes.
    pub(super) fn large_enough(
        &self,
        weld: f64,
        extents: &[Extent],
        boxes: &[Aabb],
    ) -> Option<f64> {
        /// How often a larger weld is tried.
        const TRIES: usize = 8;
        let mut tried = rounded_up(weld);
        for _ in 0..TRIES {
            let reach = |_| 0.5 * tried;
            let planes = self.planes.links(extents, boxes, &reach);
            let walls = self.walls.links(extents, boxes, &reach);
            let needs = self.planes.takes(&planes, tried, extents)?;
            let needs = needs.max(self.walls.takes(&walls, tried, extents)?);
            if needs <= tried {
                return Some(tried);
            }
            tried = rounded_up(needs);
        }
        None
    }

    /// Pairs of surfaces that are no farther apart than some have moved: what the two have
    /// together, by leaf. Also the least weld that joins each pair.
    pub(super) fn near_misses(
        &self,
        extents: &[Extent],
        boxes: &[Aabb],
        moved: &[f64],
    ) -> (Vec<Weld>, f64) {
        if moved.iter().all(|&by| by <= 0.0) {
            return (Vec::new(), 0.0);
        }
        let reach = |leaf: u32| moved[leaf as usize];
        let planes = self.planes.links(extents, boxes, &reach);
        let walls = self.walls.links(extents, boxes, &reach);
        self.pairs(&planes, &walls, extents)
    }

    /// As few pairs as it takes to join what is linked, those farthest apart first, and the
    /// least weld that joins each.
    fn pairs(
        &self,
        planes: &[Link],
        walls: &[Link],
        extents: &[Extent],
    ) -> (Vec<Weld>, f64) {
        let (planes, walls) = (self.planes.tree(planes), self.walls.tree(walls));
        let needs = planes.iter().chain(&walls).map(|link| link.needs);
        let needs = needs.fold(0.0, f64::max);
        let mut pairs: Vec<Weld> =
            planes.iter().map(|link| self.planes.weld(link, extents)).collect();
        pairs.extend(walls.iter().map(|link| self.walls.weld(link, extents)));
        pairs.sort_by(|a, b| {
            let place = |weld: &Weld| (weld.leaves, weld.faces);
            b.distance.total_cmp(&a.distance).then_with(|| place(a).cmp(&place(b)))
        });
        (pairs, needs)
    }
}

impl<T: Located> Sheets<T> {
    /// The surfaces of different groups that are within reach of each other, the nearest
    /// first. The boxes are those of the leaves.
    pub(super) fn links(
        &self,
        extents: &[Extent],
        boxes: &[Aabb],
        reach: Reach<'_>,
    ) -> Vec<Link> {
        let places = self.places(extents, reach);
        let company = self.company(&places);
        let (mut asked, mut cells) = (Vec::new(), Vec::new());
        for ((i, face), &(place, spread)) in (0..).zip(&self.faces).zip(&places) {
            if !company[self.leader[i as usize] as usize] {
                continue;
            }
            let own = reach(face.leaf) + extents[face.leaf as usize].rounding;
            let grown = boxes[face.leaf as usize].grown(own);
            if !grown.is_empty() {
                asked.push(i);
                cells.push(cell(grown, place, spread));
            }
        }
        let mut links = Vec::new();
        Cells::new(cells).overlaps(|i, k| {
            links.extend(self.link([asked[i], asked[k]], extents, boxes, reach));
        });
        links.sort_unstable_by(|a, b| {
            let ranks =
                |link: &Link| [link.near, link.far].map(|i| self.rank[i as usize]);
            a.needs.total_cmp(&b.needs).then_with(|| ranks(a).cmp(&ranks(b)))
        });
        links
    }

    /// Where each surface lies, and how far from there those within its reach may be.
    fn places(&self, extents: &[Extent], reach: Reach<'_>) -> Vec<([f64; 3], f64)> {
        let place = |(i, face): (u32, &Face<T>)| {
            let extent = &extents[face.leaf as usize];
            let own = reach(face.leaf) + extent.rounding;
            self.led_by(i).located(own, extent, self.scale)
        };
        (0..).zip(&self.faces).map(place).collect()
    }

    /// By leader: whether there is another group that lies alike, wherever its leaves are.
    fn company(&self, places: &[([f64; 3], f64)]) -> Vec<bool> {
        let mut spreads = vec![0.0_f64; places.len()];
        for (&leader, &(_, spread)) in self.leader.iter().zip(places) {
            let most = &mut spreads[leader as usize];
            *most = most.max(spread);
        }
        let is_leader = |i: &usize| self.leader[*i] as usize == *i;
        let leaders: Vec<usize> = (0..places.len()).filter(is_leader).collect();
        let anywhere = Aabb::new(DVec3::ZERO, DVec3::ZERO);
        let cells = leaders.iter().map(|&i| cell(anywhere, places[i].0, spreads[i]));
        let found = Cells::new(cells.collect()).have_company();
        let mut company = vec![false; places.len()];
        leaders.into_iter().zip(found).for_each(|(i, has)| company[i] = has);
        company
    }

    /// The link of two surfaces, if they are within reach of each other.
    fn link(
        &self,
        [i, k]: [u32; 2],
        extents: &[Extent],
        boxes: &[Aabb],
        reach: Reach<'_>,
    ) -> Option<Link> {
        let [leaf, other] = [i, k].map(|i| self.faces[i as usize].leaf);
        if leaf == other || self.leader[i as usize] == self.leader[k as usize] {
            return None;
        }
        let first = self.rank[i as usize] < self.rank[k as usize];
        let (near, far) = if first { (i, k) } else { (k, i) };
        let [own, others] = [leaf, other].map(|leaf| leaf as usize);
        let rounding = extents[own].rounding + extents[others].rounding;
        let gap = boxes[own].gap(&boxes[others]) - rounding;
        let needs = self.needs(far, near, extents).max(gap);
        let within = reach(leaf) + reach(other);
        (needs <= within && within > 0.0).then_some(Link { needs, near, far })
    }

    /// How far one surface is from another beyond what rounding explains.
    fn needs(&self, i: u32, other: u32, extents: &[Extent]) -> f64 {
        let [own, far] =
            [i, other].map(|i| &extents[self.faces[i as usize].leaf as usize]);
        let distance = self.led_by(i).distance(self.led_by(other), own);
        (distance - own.rounding - far.rounding).max(0.0)
    }

    /// How far apart linked surfaces are.
    fn distance(&self, link: &Link, extents: &[Extent]) -> f64 {
        let extent = &extents[self.faces[link.far as usize].leaf as usize];
        self.led_by(link.far).distance(self.led_by(link.near), extent)
    }

    /// As few links as it takes to join what is linked, the nearest where there is a choice.
    fn tree(&self, links: &[Link]) -> Vec<Link> {
        let mut groups = self.leader.clone();
        links.iter().filter(|link| self.unite(&mut groups, link)).copied().collect()
    }

    fn weld(&self, link: &Link, extents: &[Extent]) -> Weld {
        let faces = [link.near, link.far].map(|i| &self.faces[i as usize]);
        Weld {
            leaves: faces.map(|face| face.leaf),
            faces: faces.map(|face| face.face),
            distance: self.distance(link, extents),
        }
    }

    /// Makes one group of the groups of two surfaces; whether there were two. A group's
    /// number is that of its leader, or one that leads there.
    fn unite(&self, groups: &mut [u32], link: &Link) -> bool {
        let [a, b] = [link.near, link.far].map(|i| root(groups, i));
        let first = self.rank[a as usize] < self.rank[b as usize];
        let (leader, led) = if first { (a, b) } else { (b, a) };
        groups[led as usize] = leader;
        a != b
    }

    /// Joins what is linked, up to a weld, and says how far each leaf's surfaces have moved.
    pub(super) fn join(
        &mut self,
        links: &[Link],
        weld: f64,
        extents: &[Extent],
        moved: &mut [f64],
    ) -> Result<(), Refusal> {
        let leader = self.joined(links, weld, extents)?;
        for (i, face) in (0..).zip(&self.faces) {
            if leader[i as usize] != self.leader[i as usize] {
                let other = &self.faces[leader[i as usize] as usize].surface;
                let extent = &extents[face.leaf as usize];
                let by = self.led_by(i).distance(other, extent);
                let moved = &mut moved[face.leaf as usize];
                *moved = moved.max(by);
            }
        }
        self.leader = leader;
        Ok(())
    }

    /// The leaders of all surfaces when what is linked is joined.
    fn united(&self, links: &[Link]) -> Vec<u32> {
        let mut groups = self.leader.clone();
        for link in links {
            self.unite(&mut groups, link);
        }
        for i in 0..groups.len() {
            let above = groups[i];
            groups[i] = root(&mut groups, above);
        }
        groups
    }

    /// The surfaces that get another leader.
    fn changed(&self, groups: &[u32]) -> Vec<u32> {
        let pairs = (0..).zip(groups).zip(&self.leader);
        pairs.filter(|((_, new), old)| new != old).map(|((i, _), _)| i).collect()
    }

    /// Which weld it takes to join what is linked, up to this weld; `None` if two faces of
    /// one leaf would be one.
    fn takes(&self, links: &[Link], weld: f64, extents: &[Extent]) -> Option<f64> {
        let links = &links[..links.partition_point(|link| link.needs <= weld)];
        let groups = self.united(links);
        self.changed(&groups).into_iter().try_fold(0.0_f64, |most, i| {
            let leader = groups[i as usize];
            self.twin(&groups, i)
                .is_none()
                .then(|| most.max(self.needs(i, leader, extents)))
        })
    }

    /// Another face of the same leaf in the same group.
    fn twin(&self, groups: &[u32], i: u32) -> Option<u32> {
        let leader = groups[i as usize];
        self.of_leaf(i).find(|&own| own != i && groups[own as usize] == leader)
    }

    /// The leaders of all surfaces when those are joined whose links need no more than the
    /// weld.
    fn joined(
        &self,
        links: &[Link],
        weld: f64,
        extents: &[Extent],
    ) -> Result<Vec<u32>, Refusal> {
        let links = &links[..links.partition_point(|link| link.needs <= weld)];
        let groups = self.united(links);
        let mut changed = self.changed(&groups);
        changed.sort_unstable_by_key(|&i| self.rank[i as usize]);
        for i in changed {
            let leader = groups[i as usize];
            let leaf = |i: u32| self.faces[i as usize].leaf;
            let neighbor = || {
                let link = links.iter().find_map(|link| {
                    let ends = [link.near, link.far];
                    let own = self.leader[i as usize];
                    let is_own = ends.map(|end| self.leader[end as usize] == own);
                    match is_own {
                        [true, _] => Some(link.far),
                        [_, true] => Some(link.near),
                        [false, false] => None,
                    }
                });
                leaf(link.unwrap_or(leader))
            };
            let twin =
                self.of_leaf(i).find(|&own| own != i && groups[own as usize] == leader);
            if let Some(twin) = twin {
                let extent = &extents[leaf(i) as usize];
                let apart = self.led_by(i).distance(self.led_by(twin), extent);
                return Err(Refusal {
                    leaves: [leaf(i), neighbor(), leaf(i)],
                    apart,
                    fine: 0.0,
                });
            }
            if self.needs(i, leader, extents) > weld {
                let extent = &extents[leaf(i) as usize];
                let apart = self.led_by(i).distance(self.led_by(leader), extent);
                return Err(Refusal {
                    leaves: [leaf(leader), neighbor(), leaf(i)],
                    apart,
                    fine: 0.0,
                });
            }
        }
        Ok(groups)
    }

    /// This weld or, if that fails, a smaller one of three digits that does not, though one
    /// a little larger does; zero if nothing that joins anything is found.
    fn largest_fine(&self, links: &[Link], weld: f64, extents: &[Extent]) -> f64 {
        if self.joined(links, weld, extents).is_ok() {
            return weld;
        }
        let Some(least) = links.first() else { return 0.0 };
        let (mut fine, mut refused) = (least.needs.max(1e-9 * weld), weld);
        loop {
            let tried = three_digits((fine * refused).sqrt());
            if tried <= fine || tried >= refused {
                break;
            }
            if self.joined(links, tried, extents).is_ok() {
                fine = tried;
            } else {
                refused = tried;
            }
        }
        if fine > least.needs { fine } else { 0.0 }
    }
}

/// About the same, with three digits.
fn three_digits(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

/// The first number with three digits that is no smaller.
pub(super) fn rounded_up(x: f64) -> f64 {
    if x <= 0.0 || !x.is_finite() {
        return x.max(0.0);
    }
    let near = three_digits(x);
    if near >= x {
        near
    } else {
        three_digits(x + 10.0_f64.powf(x.log10().floor() - 2.0))
    }
}

/// The first of the group of a surface, halving the way there for the next time.
fn root(groups: &mut [u32], mut i: u32) -> u32 {
    while groups[i as usize] != i {
        groups[i as usize] = groups[groups[i as usize] as usize];
        i = groups[i as usize];
    }
    i
}
