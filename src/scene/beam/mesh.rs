//! The rays of a tile and the faces of a mesh.
//!
//! The faces that a tile may meet are looked up once and shown front first, each to the rays
//! that do not certainly pass it by. Whether and where a ray crosses a face is decided as
//! [`Polyhedron`] does for any line, so that the numbers are the same.

use pulp::Arch;

use glam::DVec3;

use super::block::{BLOCK, Block, Slot, bits};
use super::outline::{Entry, Lists, Show, Shown};
use super::sight::Sight;
use super::sighting::{Grid, Sighting};
use super::tile::{BLOCKS, Cell, Part, Tile};
use super::trial::Trials;
use crate::eight::with_eight;
use crate::ray::Sense;
use crate::shape::{Event, Kept, Line, Polyhedron, View};

/// In how many slices, one behind the other, a large mesh is looked at: what is behind the
/// faces that all rays meet need not be.
const SLICES: u32 = 4;

/// The faces of one mesh that the rays of a tile may cross.
#[derive(Debug, Default)]
pub(super) struct Facing {
    /// Nothing if the mesh cannot be looked at by tiles.
    view: Option<(Sighting, View)>,
    /// How many slices of the mesh have been looked at, and of how many.
    looked: u32,
    slices: u32,
    packs: Vec<u32>,
    /// All that have been found in slices, by number.
    known: Vec<u32>,
    /// Packs with faces that the tile may meet, front first, and how many have been shown.
    kept: Vec<Kept>,
    done: usize,
    /// Faces that have been shown to rays, and their corners.
    shown: Vec<(u32, [DVec3; 3])>,
    faces: Vec<Shown>,
    lists: Lists,
    /// For each ray of a block the crossings that were found.
    crossed: Vec<Vec<(f64, u32, Sense)>>,
}

/// What is asked for.
#[derive(Clone, Copy)]
pub(super) struct Asked<'a> {
    pub(super) arch: Arch,
    pub(super) mesh: &'a Polyhedron,
    pub(super) block: &'a Block,
    /// The number of its first ray in the tile.
    pub(super) first: usize,
    pub(super) open: u64,
}

impl Facing {
    /// Sees a mesh from a tile.
    pub(super) fn see(
        &mut self,
        mesh: &Polyhedron,
        tile: &Tile<'_>,
        sight: &Sight<'_>,
        grid: &Grid,
    ) {
        let Self { view, looked, slices, known, kept, done, shown, faces, lists, .. } =
            self;
        known.clear();
        kept.clear();
        shown.clear();
        faces.clear();
        lists.clear();
        (*looked, *done) = (0, 0);
        *slices = if mesh.is_large() { SLICES } else { 1 };
        let sighting = Sighting::new(mesh, tile.fan, grid, sight.reach);
        let view_of = |sighting: Sighting| (sighting, sighting.view(mesh, grid));
        *view = sighting.map(view_of).filter(|(_, view)| view.has_room());
    }

    /// The depth up to which all faces have been looked up that the tile may meet.
    fn looked_to(&self) -> f64 {
        match &self.view {
            Some((sighting, _)) if self.looked < self.slices => {
                let [near, far] = sighting.depth();
                let part = f64::from(self.looked) / f64::from(self.slices);
                if self.looked == 0 { near } else { near + part * (far - near) }
            }
            _ => f64::INFINITY,
        }
    }

    /// Looks up the faces that the tile may meet in the next slice of the mesh; says whether
    /// there was one.
    fn look(&mut self, mesh: &Polyhedron, part: &Part<'_>, grid: &Grid) -> bool {
        let near = self.looked_to();
        let Some((sighting, view)) = self.view.filter(|_| self.looked < self.slices)
        else {
            return false;
        };
        self.looked += 1;
        let far = self.looked_to().min(sighting.depth()[1]).max(near);
        let room = view.depth_room();
        let depth = [near - room, far + room];
        let Part { tile, sight, .. } = part;
        let slice = Cell { depth, ..Cell::WHOLE }.region(tile, sight);
        let Self { packs, known, kept, done, .. } = self;
        packs.clear();
        mesh.packs_in(slice.seen_from(&mesh.to_local), packs);
        if self.slices > 1 {
            packs.sort_unstable();
            packs.retain(|pack| known.binary_search(pack).is_err());
            known.extend_from_slice(packs);
            known.sort_unstable();
        }
        let (sides, depths) = (sighting.sides(mesh, grid), sighting.depths(mesh));
        let first = kept.len();
        mesh.keep(packs, &sides, &depths, kept);
        for kept in &mut kept[first..] {
            // No ray meets them in front of the slice.
            kept.range = kept.range.map(|depth| depth.max(near));
        }
        kept[*done..].sort_unstable_by(|a, b| {
            a.range[0].total_cmp(&b.range[0]).then(a.pack.cmp(&b.pack))
        });
        true
    }

    /// Whether its faces can be looked at by tiles.
    pub(super) fn is_seen(&self) -> bool {
        self.view.is_some()
    }

    /// Shows the next faces to some rays: those in front of which there is nothing more, up
    /// to a depth at which there is none. Says whether there were any.
    pub(super) fn go_on(
        &mut self,
        mesh: &Polyhedron,
        part: &Part<'_>,
        grid: &Grid,
        open: &[u64; BLOCKS],
    ) -> bool {
        while self.done == self.kept.len() {
            if !self.look(mesh, part, grid) {
                return false;
            }
        }
        let (mut far, from) = (self.kept[self.done].range[1], self.done);
        loop {
            while let Some(kept) =
                self.kept.get(self.done).filter(|kept| kept.range[0] <= far)
            {
                far = far.max(kept.range[1]);
                self.done += 1;
            }
            if self.looked_to() > far || !self.look(mesh, part, grid) {
                break;
            }
        }
        let Self { view, kept, done, shown, faces, lists, .. } = self;
        let Some((_, view)) = view else { return false };
        let kept = &kept[from..*done];
        with_eight(Show { mesh, view, grid, kept, open, faces, lists });
        // All at once: what is not at hand is waited for together.
        let first = shown.len();
        shown.extend(
            faces[first..].iter().map(|&Shown { face, pack, bit }| {
                (face, mesh.corners_in_pack(pack, bit))
            }),
        );
        true
    }

    /// Where faces begin that have not been shown yet.
    pub(super) fn horizon(&self) -> f64 {
        let next = self.kept.get(self.done).map(|kept| kept.range[0]);
        next.unwrap_or(f64::INFINITY).min(self.looked_to())
    }

    /// Those of some rays of a block that may meet faces that have been shown.
    pub(super) fn rays(&self, first: usize, open: u64) -> u64 {
        let mut rays = 0;
        for ray in bits(open) {
            rays |= u64::from(self.lists.first(first + ray).is_some()) << ray;
        }
        rays
    }

    /// Finds where rays first come into the mesh, as far as its faces have been shown, if
    /// that is after a depth and the mesh is all that matters; `found` is called with the ray,
    /// the place on it and the face. Says of which rays it is not sure.
    pub(super) fn enter(
        &mut self,
        asked: &Asked<'_>,
        trials: &mut Trials,
        low: f64,
        mut found: impl FnMut(usize, f64, u32),
    ) -> u64 {
        let horizon = self.horizon();
        let mut rays = self.rays(asked.first, asked.open);
        let Self { shown, lists, .. } = self;
        if rays == 0 {
            return 0;
        }
        let sure = trials.take(asked.arch, asked.block, asked.mesh, rays);
        let mut doubt = rays & !sure;
        rays = sure;
        while rays != 0 {
            for ray in bits(rays) {
                if let Some(Entry { number, .. }) = lists.first(asked.first + ray) {
                    trials.put(ray, &shown[number as usize].1);
                }
            }
            trials.ask(asked.arch, rays);
            for ray in bits(rays) {
                let (t, answer) = (trials.t[ray], trials.answer[ray]);
                let in_tile = asked.first + ray;
                let Some(entry) = lists.first(in_tile) else { continue };
                if answer <= Trials::MISSED {
                    lists.forget_first(in_tile);
                    rays &= !(u64::from(lists.first(in_tile).is_none()) << ray);
                    continue;
                }
                rays &= !(1 << ray);
                let next = lists.after(&entry).map_or(horizon, |entry| entry.near);
                let place = asked.block.on_ray(ray, t);
                // All that follows is farther along the ray.
                if answer <= Trials::ENTERED && low <= place && place < next {
                    found(ray, place, shown[entry.number as usize].0);
                } else {
                    doubt |= 1 << ray;
                }
            }
        }
        doubt
    }

    /// Finds all crossings of rays with faces that have been shown. Says at most how often
    /// any of them is inside of the mesh, and of which rays that is not sure: those that do not
    /// come in and out by turns, and in different places.
    pub(super) fn cross(
        &mut self,
        asked: &Asked<'_>,
        trials: &mut Trials,
    ) -> (usize, u64) {
        let mut rays = self.rays(asked.first, asked.open);
        let Self { shown, lists, crossed, .. } = self;
        crossed.resize_with(BLOCK, Vec::new);
        crossed.iter_mut().for_each(Vec::clear);
        if rays == 0 {
            return (0, 0);
        }
        let sure = trials.take(asked.arch, asked.block, asked.mesh, rays);
        let mut doubt = rays & !sure;
        rays = sure;
        let all = rays;
        let mut at = [None; BLOCK];
        for ray in bits(rays) {
            at[ray] = lists.first(asked.first + ray);
        }
        while rays != 0 {
            for ray in bits(rays) {
                if let Some(Entry { number, .. }) = at[ray] {
                    trials.put(ray, &shown[number as usize].1);
                }
            }
            trials.ask(asked.arch, rays);
            for ray in bits(rays) {
                let (t, answer) = (trials.t[ray], trials.answer[ray]);
                let Some(entry) = at[ray] else { continue };
                if answer > Trials::MISSED {
                    let (face, _) = shown[entry.number as usize];
                    let is_in = answer <= Trials::ENTERED;
                    let sense = if is_in { Sense::Enter } else { Sense::Exit };
                    let crossed = &mut crossed[ray];
                    let place = crossed.partition_point(|&(other, ..)| other < t);
                    crossed.insert(place, (t, face, sense));
                    doubt |= u64::from(answer >= Trials::DOUBT) << ray;
                }
                at[ray] = lists.after(&entry);
                rays &= !(u64::from(at[ray].is_none()) << ray);
            }
        }
        let mut most = 0;
        for ray in bits(all & !doubt) {
            let crossed = &crossed[ray];
            let is_apart = crossed.windows(2).all(|two| two[0].0 < two[1].0);
            let takes_turns = crossed
                .iter()
                .enumerate()
                .all(|(i, &(.., sense))| (sense == Sense::Enter) == (i % 2 == 0));
            if is_apart && takes_turns {
                most = most.max(crossed.len().div_ceil(2));
            } else {
                doubt |= 1 << ray;
            }
        }
        (most, doubt)
    }

    /// Puts into slots where rays are inside of the mesh, as [`Facing::cross`] has found. A
    /// ray that is in it after the last crossing comes out at infinity.
    pub(super) fn fill(&self, slots: &mut [Slot], rays: u64) {
        for (i, slot) in slots.iter_mut().enumerate() {
            slot.enter = [f64::INFINITY; BLOCK];
            slot.exit = [f64::INFINITY; BLOCK];
            for ray in bits(rays) {
                let crossed = &self.crossed[ray];
                if let Some(&(t, face, _)) = crossed.get(2 * i) {
                    (slot.enter[ray], slot.enter_face[ray]) = (t, f64::from(face));
                    let never = (f64::INFINITY, 0, Sense::Exit);
                    let &(t, face, _) = crossed.get(2 * i + 1).unwrap_or(&never);
                    (slot.exit[ray], slot.exit_face[ray]) = (t, f64::from(face));
                }
            }
        }
    }

    /// All crossings of a ray with faces that have been shown. Where the ray is in the mesh
    /// after them it comes out at infinity, so that it goes in as often as out.
    pub(super) fn crossings(
        &self,
        mesh: &Polyhedron,
        leaf: u32,
        ray: usize,
        line: &Line,
        events: &mut Vec<Event>,
    ) {
        let Some(mut crosser) = mesh.crosser(line) else { return };
        let mut winding = 0;
        for Entry { number, .. } in self.lists.of(ray) {
            let (face, corners) = self.shown[number as usize];
            if let Some((t, sense)) = crosser(corners) {
                winding += if sense == Sense::Enter { 1 } else { -1 };
                events.push(Event { t, leaf, face, sense });
            }
        }
        let sense = if winding > 0 { Sense::Exit } else { Sense::Enter };
        for _ in 0..i32::abs(winding) {
            events.push(Event { t: f64::INFINITY, leaf, face: 0, sense });
        }
    }

    /// The first crossing of a ray whose place is in a range, if the mesh is all that
    /// matters.
    pub(super) fn first(
        &self,
        mesh: &Polyhedron,
        leaf: u32,
        ray: usize,
        line: &Line,
        [low, high]: [f64; 2],
        events: &mut Vec<Event>,
    ) -> First {
        let horizon = self.horizon();
        let Some(mut crosser) = mesh.crosser(line) else { return First::Nothing };
        events.clear();
        let (mut passed, mut winding) = (0, 0);
        for entry in self.lists.of(ray) {
            let (face, corners) = self.shown[entry.number as usize];
            if let Some((t, sense)) = crosser(corners) {
                let place = events.partition_point(|event| event.t < t);
                events.insert(place, Event { t, leaf, face, sense });
            }
            let next = self.lists.after(&entry).map_or(horizon, |entry| entry.near);
            let Some(last) = events.last() else { continue };
            if line.on_ray(last.t) >= next {
                continue;
            }
            // What follows is farther along the ray than all of these.
            while let Some(event) = events.get(passed) {
                let after = events.get(passed + 1);
                if after.is_some_and(|after| after.t <= event.t) {
                    return First::Unsure;
                }
                let was_inside = winding > 0;
                winding += if event.sense == Sense::Enter { 1 } else { -1 };
                passed += 1;
                if was_inside == (winding > 0) {
                    continue;
                }
                let place = line.on_ray(event.t);
                if place >= high {
                    return First::Nothing;
                }
                if place >= low {
                    if after.is_some_and(|after| line.on_ray(after.t) <= place) {
                        return First::Unsure;
                    }
                    return First::Crossed(*event, place, winding > 0);
                }
            }
        }
        First::Nothing
    }
}

/// What a ray that can meet only one mesh meets first.
#[derive(Clone, Copy, Debug)]
pub(super) enum First {
    /// Nothing that has been shown.
    Nothing,
    /// This, at this place on the ray, and whether it is in the mesh after that.
    Crossed(Event, f64, bool),
    /// There are crossings in one place, or in one place of the ray.
    Unsure,
}
