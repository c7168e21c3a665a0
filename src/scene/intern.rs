//! Surfaces that coincide are given equal bits.
//!
//! Two leaves can have a face in common and yet, because their maps were multiplied out in
//! another order, disagree on it by a rounding error. Then a line would find a gap or a film
//! there that nobody meant. So planes and curved walls that cannot be told apart are
//! collected in groups, and all of a group take over the numbers of one of them. After that
//! they cross a line at equal `t`, and the sweep needs no tolerance. The one is chosen by its
//! numbers, not by its place in the tree, so that operands can change places without
//! changing a bit.
//!
//! Surfaces are the same if nowhere on the leaf they are farther apart than what rounding can
//! have done ([`ROUNDING`]). The distance is to the first of its group, never to a neighbour,
//! so groups do not creep.

use std::collections::BTreeMap;
use std::ops::Bound::Included;

use glam::DVec3;

use crate::aabb::Aabb;
use crate::shape::{Plane, Shape, Wall};

/// How far rounding moves a surface, in units of the largest coordinate of its leaf times
/// the condition number of its map.
///
/// A product of two maps rounds by at most 4 u in each entry, u = 2⁻⁵³, the inverse and the
/// plane's equation by some 16 u more; this leaves room for a dozen nested maps.
const ROUNDING: f64 = 64.0 * 0.5 * f64::EPSILON;

/// One leaf whose map is all but singular must not make all others look alike: surfaces of
/// leaves this many times less precise than a leaf are not considered for it.
const SLACK: f64 = 1024.0;

/// What a leaf says of its own precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    center: DVec3,
    radius: f64,
    rounding: f64,
}

impl Extent {
    /// Of a leaf within `bounds`, or within `scene` if it has no bounds itself.
    pub(super) fn new(bounds: &Aabb, scene: &Aabb, condition: f64) -> Self {
        let near = if bounds.is_bounded() { *bounds } else { *scene };
        let far = near.min.abs().max(near.max.abs()).max_element();
        let radius = 0.5 * near.size().length();
        Self { center: near.center(), radius, rounding: ROUNDING * condition * far }
    }
}

/// Gives equal bits to the surfaces that coincide.
pub(super) fn intern(shapes: &mut [Shape], extents: &[Extent]) {
    let far = extents.iter().map(|e| e.center.length() + e.radius).fold(0.0, f64::max);
    let (mut planes, mut walls) = (Table::new(far), Table::new(far));
    let (mut plane_groups, mut wall_groups) = (Vec::new(), Vec::new());
    for (shape, extent) in shapes.iter_mut().zip(extents) {
        // Faces of one leaf are never each other's: a leaf as thin as rounding would vanish.
        let before = planes.groups.len();
        for plane in shape.planes_mut() {
            plane_groups.push(planes.join_plane(plane, extent, before));
        }
        if let Some(wall) = shape.wall_mut() {
            wall_groups.push(walls.join_wall(wall, extent));
        }
    }
    let mut plane_groups = plane_groups.into_iter();
    let mut wall_groups = wall_groups.into_iter();
    for shape in shapes {
        for (plane, group) in shape.planes_mut().iter_mut().zip(&mut plane_groups) {
            let chosen = &planes.groups[group].chosen;
            let same_way = plane.normal.dot(chosen.normal) > 0.0;
            *plane = Plane { above: plane.above == same_way, ..*chosen };
        }
        for (wall, group) in shape.wall_mut().into_iter().zip(&mut wall_groups) {
            *wall = walls.groups[group].chosen;
        }
    }
}

/// The groups so far, sorted by a number that differs little between equal surfaces.
struct Table<T> {
    /// The largest coordinate.
    scale: f64,
    keys: BTreeMap<Key, Vec<usize>>,
    groups: Vec<Group<T>>,
}

/// Surfaces that coincide.
struct Group<T> {
    /// The first one, with which the others were compared.
    first: T,
    /// The rounding of its leaf.
    rounding: f64,
    /// The one whose numbers all take over.
    chosen: T,
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

/// No direction in which models have many surfaces: √0.3, √0.1, √0.6.
const MIXED: DVec3 = DVec3::new(
    0.547_722_557_505_166_1,
    0.316_227_766_016_837_94,
    0.774_596_669_241_483_4,
);

impl<T: Copy> Table<T> {
    fn new(scale: f64) -> Self {
        Self { scale, keys: BTreeMap::new(), groups: Vec::new() }
    }

    /// The entries whose key is within `width` of `key`, oldest first.
    fn near(&self, key: f64, width: f64) -> Vec<usize> {
        if !width.is_finite() || !key.is_finite() {
            // Numbers too large to compare are near nothing.
            return Vec::new();
        }
        let range = (Included(Key(key - width)), Included(Key(key + width)));
        let mut found: Vec<usize> =
            self.keys.range(range).flat_map(|(_, v)| v).copied().collect();
        found.sort_unstable();
        found
    }

    fn add(&mut self, key: f64, surface: T, rounding: f64) -> usize {
        let number = self.groups.len();
        self.groups.push(Group { first: surface, rounding, chosen: surface });
        self.keys.entry(Key(key)).or_default().push(number);
        number
    }
}

impl Table<Plane> {
    /// The group of a plane: the first one with which it coincides, or a new one. Groups
    /// from `before` on are of the same leaf.
    fn join_plane(&mut self, plane: &Plane, extent: &Extent, before: usize) -> usize {
        let key = plane.normal.dot(MIXED) + plane.offset / self.scale;
        // A turn by an angle moves the plane by that times the radius of the leaf.
        let width =
            8.0 * SLACK * extent.rounding * (1.0 / extent.radius + 1.0 / self.scale);
        for sign in [1.0, -1.0] {
            for number in self.near(sign * key, width) {
                let Group { first, rounding, chosen } = &mut self.groups[number];
                let apart =
                    distance(plane, sign * first.normal, sign * first.offset, extent);
                if number < before && apart <= extent.rounding + *rounding {
                    let numbers =
                        |p: &Plane| [p.normal.x, p.normal.y, p.normal.z, p.offset];
                    if comes_before(&numbers(plane), &numbers(chosen)) {
                        *chosen = *plane;
                    }
                    return number;
                }
            }
        }
        self.add(key, *plane, extent.rounding)
    }
}

/// An order of lists of numbers.
fn comes_before(a: &[f64], b: &[f64]) -> bool {
    let different = a.iter().zip(b).map(|(x, y)| x.total_cmp(y)).find(|o| o.is_ne());
    different == Some(std::cmp::Ordering::Less)
}

/// At most how far from another plane this one is, anywhere on the leaf.
fn distance(plane: &Plane, normal: DVec3, offset: f64, extent: &Extent) -> f64 {
    let height =
        (plane.normal.dot(extent.center) - plane.offset) / plane.normal.length_squared();
    let foot = extent.center - height * plane.normal;
    let apart = (normal.dot(foot) - offset).abs() / normal.length();
    let turned = (normal.normalize() - plane.normal.normalize()).length();
    // A face is at most two radii wide, however far from it the middle of the leaf is.
    apart + 2.0 * turned * extent.radius
}

impl Table<Wall> {
    /// The group of a wall: the first one with which it coincides, or a new one.
    fn join_wall(&mut self, wall: &Wall, extent: &Extent) -> usize {
        let key = wall.landmark(DVec3::ZERO).dot(MIXED) / self.scale;
        // The landmark of a slender wall moves more than the wall itself.
        let width = 8.0 * SLACK * extent.rounding * wall.slenderness() / self.scale;
        for number in self.near(key, width) {
            let Group { first, rounding, chosen } = &mut self.groups[number];
            if wall.distance(first) <= extent.rounding + *rounding {
                let wins = comes_before(&wall.numbers(), &chosen.numbers());
                *chosen = if wins {
                    wall.extended_by(chosen)
                } else {
                    chosen.extended_by(wall)
                };
                return number;
            }
        }
        self.add(key, *wall, extent.rounding)
    }
}
