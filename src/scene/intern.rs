//! Surfaces that coincide are given equal bits.
//!
//! Two leaves can have a face in common and yet, because their maps were multiplied out in
//! another order, disagree on it by a rounding error. Then a line would find a gap or a film
//! there that nobody meant. So surfaces that cannot be told apart are collected in groups,
//! and all of a group take over the numbers of one of them, its leader. After that they
//! cross a line at equal `t`, and the sweep needs no tolerance. Of meshes it is the maps of
//! equal meshes that are made equal, not single faces.
//!
//! Surfaces are the same if nowhere on the leaf they are farther apart than what rounding can
//! have done ([`Extent::rounding`]). The distance is to the leader, never to a neighbour, so
//! groups do not creep. Leaves are gone through from the largest to the smallest, so that the
//! leader is the one whose direction is known best: another's plane may fit it on a small
//! leaf and miss it at the far end of a large one. Leaves of one size come in the order of
//! their numbers, so that operands can change places without changing a bit.

use std::collections::BTreeMap;
use std::ops::Bound::Included;

use super::sheet::{Extent, Sheet};
use crate::shape::{Plane, Polyhedron, Shape, Wall};

/// One leaf whose map is all but singular must not make all others look alike: surfaces of
/// leaves this many times less precise than a leaf are not considered for it.
const SLACK: f64 = 1024.0;

/// The surfaces of all leaves, and which of them are one.
pub(super) struct Surfaces {
    pub(super) planes: Sheets<Plane>,
    pub(super) walls: Sheets<Wall>,
    meshes: Sheets<Polyhedron>,
}

/// The surfaces of one kind.
pub(super) struct Sheets<T> {
    /// The largest coordinate of the scene.
    pub(super) scale: f64,
    /// In the order of leaves and faces.
    pub(super) faces: Vec<Face<T>>,
    /// The place of each in the order that does not depend on the leaves' order.
    pub(super) rank: Vec<u32>,
    /// For each the one whose numbers it takes over: the first of its group.
    pub(super) leader: Vec<u32>,
}

/// A surface and whose it is.
#[derive(Clone)]
pub(super) struct Face<T> {
    pub(super) surface: T,
    pub(super) leaf: u32,
    pub(super) face: u32,
}

impl Surfaces {
    /// Of these leaves, with what coincides in groups.
    pub(super) fn new(shapes: &mut [Shape], extents: &[Extent]) -> Self {
        let (mut planes, mut walls, mut meshes) = (Vec::new(), Vec::new(), Vec::new());
        for (leaf, shape) in (0..).zip(shapes) {
            let before = u32::from(shape.wall_mut().is_some());
            let own = (before..).zip(shape.planes_mut());
            planes.extend(own.map(|(face, &mut surface)| Face { surface, leaf, face }));
            let own =
                shape.wall_mut().map(|&mut surface| Face { surface, leaf, face: 0 });
            walls.extend(own);
            if let Shape::Polyhedron(mesh) = shape {
                meshes.push(Face { surface: Polyhedron::clone(mesh), leaf, face: 0 });
            }
        }
        Self {
            planes: Sheets::new(planes, extents),
            walls: Sheets::new(walls, extents),
            meshes: Sheets::new(meshes, extents),
        }
    }

    /// At most how far each leaf's surfaces are moved when they take over their leaders'
    /// numbers.
    fn moved(&self, extents: &[Extent]) -> Vec<f64> {
        let mut moved = vec![0.0; extents.len()];
        self.planes.add_moved(&mut moved, extents);
        self.walls.add_moved(&mut moved, extents);
        self.meshes.add_moved(&mut moved, extents);
        moved
    }

    /// Gives the leaves their leaders' numbers; says how far that moves their surfaces.
    pub(super) fn hand_out(self, shapes: &mut [Shape], extents: &[Extent]) -> Vec<f64> {
        let moved = self.moved(extents);
        let mut planes = self.planes.led();
        let mut meshes = self.meshes.led();
        let walls = self.walls.extended();
        let mut walls = self.walls.leader.iter().map(|&leader| walls[leader as usize]);
        for shape in shapes {
            for (plane, chosen) in shape.planes_mut().iter_mut().zip(&mut planes) {
                let same_way = plane.normal.dot(chosen.normal) > 0.0;
                *plane = Plane { above: plane.above == same_way, ..*chosen };
            }
            for (wall, chosen) in shape.wall_mut().into_iter().zip(&mut walls) {
                *wall = chosen;
            }
            if let Shape::Polyhedron(mesh) = shape {
                for (mesh, chosen) in [mesh].into_iter().zip(&mut meshes) {
                    mesh.to_local = chosen.to_local;
                }
            }
        }
        moved
    }
}

impl<T: Sheet> Sheets<T> {
    fn new(faces: Vec<Face<T>>, extents: &[Extent]) -> Self {
        let order = in_order(&faces, extents);
        let mut table = Table::new(extents);
        let mut sheets = Self {
            scale: table.scale,
            rank: vec![0; faces.len()],
            leader: vec![u32::MAX; faces.len()],
            faces,
        };
        for (rank, i) in (0..).zip(order) {
            sheets.rank[i as usize] = rank;
            sheets.gather(i, &mut table, extents);
        }
        sheets
    }

    /// Puts a surface into the first group whose leader it coincides with, or a new one.
    ///
    /// Faces of one leaf are never each other's: a leaf as thin as rounding would vanish.
    fn gather(&mut self, i: u32, table: &mut Table, extents: &[Extent]) {
        let Face { surface, leaf, .. } = &self.faces[i as usize];
        let extent = &extents[*leaf as usize];
        let key = surface.key(table.scale);
        let apart = extent.rounding + table.rounding.min(SLACK * extent.rounding);
        let width = surface.key_width(apart, extent, table.scale);
        let mut near = table.near(surface.class(), key, width);
        near.sort_unstable_by_key(|&leader| self.rank[leader as usize]);
        let found = near.into_iter().find(|&leader| {
            let other = &self.faces[leader as usize];
            let rounding = extent.rounding + extents[other.leaf as usize].rounding;
            surface.distance(&other.surface, extent) <= rounding
                && self.of_leaf(i).all(|own| self.leader[own as usize] != leader)
        });
        if found.is_none() {
            table.add(surface.class(), key, i);
            table.rounding = table.rounding.max(extent.rounding);
        }
        self.leader[i as usize] = found.unwrap_or(i);
    }

    /// The surfaces of the leaf of one of them.
    pub(super) fn of_leaf(&self, i: u32) -> impl Iterator<Item = u32> {
        let leaf = self.faces[i as usize].leaf;
        let is_own = move |&k: &u32| {
            self.faces.get(k as usize).is_some_and(|other| other.leaf == leaf)
        };
        (0..i).rev().take_while(is_own).chain((i..).take_while(is_own))
    }

    /// The surface that one takes over.
    pub(super) fn led_by(&self, i: u32) -> &T {
        &self.faces[self.leader[i as usize] as usize].surface
    }

    /// Raises a length for each leaf to how far its surfaces are from their leaders.
    ///
    /// The distance is a small difference of large numbers and itself rounded, by less than
    /// the room that [`Extent::rounding`] has for other things.
    fn add_moved(&self, moved: &mut [f64], extents: &[Extent]) {
        for (i, Face { surface, leaf, .. }) in (0..).zip(&self.faces) {
            let extent = &extents[*leaf as usize];
            let leader = self.led_by(i);
            if compare(&surface.numbers(), &leader.numbers()).is_ne() {
                let distance = surface.distance(leader, extent) + extent.rounding / 4.0;
                let moved = &mut moved[*leaf as usize];
                *moved = moved.max(distance);
            }
        }
    }

    fn led(&self) -> impl Iterator<Item = &T> {
        (0..).zip(&self.faces).map(|(i, _)| self.led_by(i))
    }
}

impl Sheets<Wall> {
    /// All walls, the leaders long enough for all that they lead.
    fn extended(&self) -> Vec<Wall> {
        let mut walls: Vec<Wall> = self.faces.iter().map(|face| face.surface).collect();
        for (face, &leader) in self.faces.iter().zip(&self.leader) {
            let wall = &mut walls[leader as usize];
            *wall = wall.extended_by(&face.surface);
        }
        walls
    }
}

/// The numbers of the faces from the largest leaf to the smallest. Leaves of one size come
/// in the order of what is known of them, and the faces of a leaf in that of their numbers.
fn in_order<T: Sheet>(faces: &[Face<T>], extents: &[Extent]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..).zip(faces).map(|(i, _)| i).collect();
    let numbers = |&i: &u32| faces[i as usize].surface.numbers();
    let mut leaves: Vec<&mut [u32]> = order
        .chunk_by_mut(|&a, &b| faces[a as usize].leaf == faces[b as usize].leaf)
        .collect();
    for own in &mut leaves {
        own.sort_by(|a, b| compare(&numbers(a), &numbers(b)));
    }
    leaves.sort_by(|a, b| {
        let [near, far] =
            [a, b].map(|own| &extents[faces[own[0] as usize].leaf as usize]);
        let known =
            |e: &Extent| [-e.radius, e.center.x, e.center.y, e.center.z, e.rounding];
        let surfaces = || a.iter().map(numbers).zip(b.iter().map(numbers));
        let differ =
            || surfaces().map(|(a, b)| compare(&a, &b)).find(|order| order.is_ne());
        compare(&known(near), &known(far))
            .then_with(|| differ().unwrap_or(a.len().cmp(&b.len())))
    });
    leaves.into_iter().flat_map(|own| own.iter().copied()).collect()
}

/// An order of lists of numbers.
fn compare(a: &[f64], b: &[f64]) -> std::cmp::Ordering {
    let different = a.iter().zip(b).map(|(x, y)| x.total_cmp(y)).find(|o| o.is_ne());
    different.unwrap_or(std::cmp::Ordering::Equal)
}

/// The leaders so far, sorted by a number that differs little between equal surfaces.
struct Table {
    /// The largest coordinate.
    scale: f64,
    /// The largest rounding of a leader's leaf.
    rounding: f64,
    keys: BTreeMap<(usize, Key), Vec<u32>>,
}

/// A float in its natural order.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key(f64);

impl Eq for Key {}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Key {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl Table {
    fn new(extents: &[Extent]) -> Self {
        let scale =
            extents.iter().map(|e| e.center.length() + e.radius).fold(0.0, f64::max);
        Self { scale, rounding: 0.0, keys: BTreeMap::new() }
    }

    /// The leaders whose key is within `width` of `key`.
    fn near(&self, class: usize, key: f64, width: f64) -> Vec<u32> {
        if !width.is_finite() || !key.is_finite() {
            // Numbers too large to compare are near nothing.
            return Vec::new();
        }
        let range =
            (Included((class, Key(key - width))), Included((class, Key(key + width))));
        self.keys.range(range).flat_map(|(_, leaders)| leaders).copied().collect()
    }

    fn add(&mut self, class: usize, key: f64, leader: u32) {
        self.keys.entry((class, Key(key))).or_default().push(leader);
    }
}
