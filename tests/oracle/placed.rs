//! Leaves in their places, in numbers of 200 bits: where lines meet them, and how far
//! rounding can move that.

use glam::{DAffine3, DMat3, DVec3};
use solidray::Ray;

use super::real::{Map, Real, Vector};
use super::surface::{Polynomial, Surface, surfaces};
use crate::support::leaf::Leaf;
use crate::support::model::Model;

/// A leaf under a chain of maps, each taken as exact.
#[derive(Debug)]
pub(crate) struct Placed {
    surfaces: Vec<Surface>,
    origin: Vector,
    rows: [Vector; 3],
    /// The condition number of the map.
    pub(crate) condition: f64,
    /// No point of the leaf is farther from its origin than this, as placed.
    pub(crate) reach: f64,
    /// The largest coordinate that occurs while the maps are multiplied out, times one for
    /// the leaf and a half for each map.
    pub(crate) spread: f64,
}

/// What a line meets of one surface.
#[derive(Debug)]
pub(crate) struct Pass {
    pub(crate) starts_inside: bool,
    /// Where it passes through, in order, to the last digit.
    pub(crate) roots: Vec<Real>,
    /// The same as rounding may find it.
    pub(crate) meetings: Vec<Meeting>,
}

/// A place where a line meets a surface.
#[derive(Clone, Debug)]
pub(crate) struct Meeting {
    pub(crate) t: Real,
    /// How far off rounding may find it.
    pub(crate) error: f64,
    /// Whether it comes in or goes out; else it all but touches the surface there, and
    /// rounding may find two crossings or none.
    pub(crate) crosses: bool,
}

/// The unit of rounding.
pub(crate) const U: f64 = 0.5 * f64::EPSILON;

/// How many roundings of the lengths at hand an error is made of.
const ROUNDINGS: f64 = 4.0;

/// The leaves of a model in the order of the tree.
pub(crate) fn placed(model: &Model) -> Vec<Placed> {
    let mut leaves = Vec::new();
    place(model, &[], &mut leaves);
    leaves
}

fn place(model: &Model, maps: &[DAffine3], leaves: &mut Vec<Placed>) {
    match model {
        Model::Leaf(leaf) => leaves.push(Placed::new(leaf, maps)),
        Model::Mapped(map, child) => {
            let maps: Vec<DAffine3> = maps.iter().copied().chain([*map]).collect();
            place(child, &maps, leaves);
        }
        Model::Boolean(_, children) => {
            children.iter().for_each(|child| place(child, maps, leaves));
        }
    }
}

impl Placed {
    /// A leaf under maps of which the last is applied first.
    pub(crate) fn new(leaf: &Leaf, maps: &[DAffine3]) -> Self {
        let identity = Map::exact(&DAffine3::IDENTITY);
        let map =
            maps.iter().fold(identity, |product, map| product.after(&Map::exact(map)));
        let rows = map.inverse_rows();
        let norm = |vectors: &[Vector; 3]| {
            let squares = vectors.iter().map(|v| v.rounded().length().powi(2));
            squares.sum::<f64>().sqrt()
        };
        let largest = maps
            .iter()
            .rev()
            .fold(DVec3::splat(leaf.size()), |p, map| absolute(map).transform_point3(p));
        let stretch = norm(&map.columns);
        Self {
            surfaces: surfaces(leaf),
            condition: stretch * norm(&rows),
            reach: stretch * leaf.size(),
            spread: largest.length() * (1.0 + 0.5 * maps.len() as f64),
            origin: map.offset,
            rows,
        }
    }

    /// What a line meets of the leaf's surfaces, of which the leaf is the common inside, in
    /// a scene with coordinates up to `largest`.
    pub(crate) fn passes(&self, ray: &Ray, largest: f64) -> Vec<Pass> {
        let from = Vector::exact(ray.origin).minus(&self.origin);
        let dir = Vector::exact(ray.dir);
        let to_local = |v: &Vector| Vector(self.rows.each_ref().map(|row| row.dot(v)));
        let (origin, dir) = (to_local(&from), to_local(&dir));
        let line = Local { origin, dir, ray, origin_beside: from, largest };
        self.surfaces.iter().map(|surface| self.pass(surface, &line)).collect()
    }

    /// Where a line comes in (true) and goes out, in order, to the last digit.
    pub(crate) fn crossings(&self, ray: &Ray) -> Vec<(Real, bool)> {
        let passes = self.passes(ray, 0.0);
        let mut inside: Vec<bool> =
            passes.iter().map(|pass| pass.starts_inside).collect();
        let roots = |(i, pass): (usize, &Pass)| {
            pass.roots.iter().map(move |t| (t.clone(), i)).collect::<Vec<_>>()
        };
        let mut roots: Vec<(Real, usize)> =
            passes.iter().enumerate().flat_map(roots).collect();
        roots.sort_by(|a, b| a.0.partial_cmp(&b.0).expect("these are numbers"));
        let mut crossings = Vec::new();
        for group in roots.chunk_by(|a, b| a.0 == b.0) {
            let before = inside.iter().all(|&inside| inside);
            group.iter().for_each(|&(_, i)| inside[i] ^= true);
            let after = inside.iter().all(|&inside| inside);
            if before != after {
                crossings.push((group[0].0.clone(), after));
            }
        }
        crossings
    }

    /// How far a place on a ray is from a face, to first order.
    pub(crate) fn distance(&self, face: u32, ray: &Ray, t: f64) -> f64 {
        let surface = &self.surfaces[face as usize];
        let p = self.to_local(ray, t);
        let none = Vector::exact(DVec3::ZERO);
        let value = surface.along(&p, &none).c.rounded().abs();
        value / (2.0 * self.to_world(&surface.half_gradient(&p)).length())
    }

    /// The unit normal out of a face at a place on a ray.
    pub(crate) fn normal(&self, face: u32, ray: &Ray, t: f64) -> DVec3 {
        let half_gradient =
            self.surfaces[face as usize].half_gradient(&self.to_local(ray, t));
        self.to_world(&half_gradient).normalize()
    }

    /// A place on a ray as the leaf sees it.
    fn to_local(&self, ray: &Ray, t: f64) -> Vector {
        let step = Vector::exact(ray.dir).times(&Real::exact(t));
        let beside = Vector::exact(ray.origin).plus(&step).minus(&self.origin);
        Vector(self.rows.each_ref().map(|row| row.dot(&beside)))
    }

    fn pass(&self, surface: &Surface, line: &Local) -> Pass {
        let Polynomial { a, b, c } = surface.along(&line.origin, &line.dir);
        let zero = Real::exact(0.0);
        let blur = |t: &Real| self.blur(surface, line, t);
        let bend = self.to_world(&surface.weighed(&line.dir)).length();
        let slope_blur = |t: &Real| bend * self.rounding(line, t);
        if a.is_zero() && b.is_zero() {
            // Parallel: in or out for good, unless it runs as near as rounding.
            let t = line.closest();
            let is_near = c.rounded().abs() <= 4.0 * blur(&t);
            let meeting = Meeting { t, error: f64::INFINITY, crosses: false };
            let meetings = if is_near { vec![meeting] } else { Vec::new() };
            return Pass { starts_inside: c <= zero, roots: Vec::new(), meetings };
        }
        if a.is_zero() {
            let t = -(c / (&b + &b));
            let is_steep = b.rounded().abs() >= 16.0 * slope_blur(&t);
            let error =
                if is_steep { blur(&t) / b.rounded().abs() } else { f64::INFINITY };
            let roots = vec![t.clone()];
            let meetings = vec![Meeting { t, error, crosses: true }];
            return Pass { starts_inside: b > zero, roots, meetings };
        }
        let starts_inside = a < zero;
        let discriminant = b.squared() - &a * &c;
        let mut roots = Vec::new();
        if discriminant > zero {
            let root = discriminant.sqrt();
            let sum = if b < zero { &root - &b } else { -(&root + &b) };
            let (first, second) = (&sum / &a, &c / &sum);
            roots =
                if first < second { vec![first, second] } else { vec![second, first] };
            let gap = (&roots[1] - &roots[0]).rounded();
            let meeting = |t: &Real| {
                let error = 1.1 * blur(t) / root.rounded();
                Meeting { t: t.clone(), error, crosses: true }
            };
            let meetings: Vec<Meeting> = roots.iter().map(meeting).collect();
            let is_steep = |m: &Meeting| {
                16.0 * m.error < gap && root.rounded() >= 16.0 * slope_blur(&m.t)
            };
            if meetings.iter().any(is_steep) {
                return Pass { starts_inside, roots, meetings };
            }
        }
        // The parabola's vertex, and how far above or below the surface the line is there.
        // A cone's gradient vanishes at its apex, but grows along a line through it.
        let t = -(&b / &a);
        let height = (&c - &b * &b / &a).rounded().abs();
        let (a, slope_blur, blur) = (a.rounded().abs(), slope_blur(&t), 2.0 * blur(&t));
        let touches = !roots.is_empty()
            || height <= 16.0 * blur
            || a * height <= (16.0 * slope_blur).powi(2);
        let error = 2.0 * (((height + blur) / a).sqrt() + 2.0 * slope_blur / a);
        let meeting = Meeting { t, error, crosses: false };
        let meetings = if touches { vec![meeting] } else { Vec::new() };
        Pass { starts_inside, roots, meetings }
    }

    /// By how much half the value of a surface at a place on a line is uncertain: the length
    /// of half its gradient in the world times the rounding of the place.
    fn blur(&self, surface: &Surface, line: &Local, t: &Real) -> f64 {
        let p = line.origin.plus(&line.dir.times(t));
        let normal = self.to_world(&surface.half_gradient(&p));
        normal.length() * self.rounding(line, t)
    }

    /// How far rounding moves a place on a line or the leaf there: a few units of all
    /// lengths that are added up on the way, those in the leaf's frame times its condition.
    fn rounding(&self, line: &Local, t: &Real) -> f64 {
        let beside = line.origin_beside.plus(&Vector::exact(line.ray.dir).times(t));
        let in_world = line.ray.origin.length() + t.rounded().abs() * line.ray.speed();
        let in_leaf = self.condition * (beside.rounded().length() + self.reach);
        ROUNDINGS * U * (in_world + line.largest + self.spread + in_leaf)
    }

    /// A normal of the leaf's frame in the world.
    fn to_world(&self, normal: &Vector) -> DVec3 {
        let [x, y, z] = [0, 1, 2].map(|i| self.rows[i].times(&normal.0[i]));
        x.plus(&y).plus(&z).rounded()
    }
}

/// A line in the frame of a leaf.
struct Local<'a> {
    origin: Vector,
    dir: Vector,
    ray: &'a Ray,
    /// The ray's origin as seen from that of the leaf.
    origin_beside: Vector,
    /// The largest coordinate of the scene.
    largest: f64,
}

impl Local<'_> {
    /// Where it comes closest to the origin of the leaf.
    fn closest(&self) -> Real {
        -(self.origin.dot(&self.dir) / self.dir.dot(&self.dir))
    }
}

fn absolute(map: &DAffine3) -> DAffine3 {
    let m = map.matrix3;
    let linear = DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
    DAffine3::from_mat3_translation(linear, map.translation.abs())
}
