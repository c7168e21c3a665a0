//! A small kernel, written once for both precisions.

use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::DVec3;

/// A number of either precision.
pub(crate) trait Real:
    Copy
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    fn of(x: f64) -> Self;
    fn wide(self) -> f64;
    fn root(self) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
}

impl Real for f32 {
    #[expect(clippy::cast_possible_truncation, reason = "that is what is measured")]
    fn of(x: f64) -> Self {
        x as Self
    }

    fn wide(self) -> f64 {
        f64::from(self)
    }

    fn root(self) -> Self {
        self.sqrt()
    }

    fn min(self, other: Self) -> Self {
        self.min(other)
    }

    fn max(self, other: Self) -> Self {
        self.max(other)
    }
}

impl Real for f64 {
    fn of(x: f64) -> Self {
        x
    }

    fn wide(self) -> f64 {
        self
    }

    fn root(self) -> Self {
        self.sqrt()
    }

    fn min(self, other: Self) -> Self {
        self.min(other)
    }

    fn max(self, other: Self) -> Self {
        self.max(other)
    }
}

/// A point or a direction.
pub(crate) type Triple<T> = [T; 3];

/// A vector, rounded.
pub(crate) fn triple<T: Real>(v: DVec3) -> Triple<T> {
    v.to_array().map(T::of)
}

fn minus<T: Real>(a: Triple<T>, b: Triple<T>) -> Triple<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot<T: Real>(a: Triple<T>, b: Triple<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross<T: Real>(a: Triple<T>, b: Triple<T>) -> Triple<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A line as both precisions have it.
#[derive(Clone, Copy)]
pub(crate) struct Ray<T> {
    pub(crate) origin: Triple<T>,
    pub(crate) dir: Triple<T>,
}

impl<T: Real> Ray<T> {
    pub(crate) fn of(ray: &solidray::Ray) -> Self {
        Self { origin: triple(ray.origin), dir: triple(ray.dir) }
    }
}

/// Where a convex solid begins and ends on a ray; nowhere if the end is first.
type Stretch<T> = [T; 2];

#[derive(Clone, Copy)]
pub(crate) struct Ball<T> {
    pub(crate) center: Triple<T>,
    pub(crate) radius: T,
}

impl<T: Real> Ball<T> {
    /// From the point of the ray closest to the center, which is the form that loses least.
    pub(crate) fn stretch(&self, ray: &Ray<T>) -> Option<Stretch<T>> {
        let from = minus(ray.origin, self.center);
        let square = dot(ray.dir, ray.dir);
        let middle = -dot(from, ray.dir) / square;
        let at = |k: usize| from[k] + middle * ray.dir[k];
        let away = dot([at(0), at(1), at(2)], [at(0), at(1), at(2)]).root();
        let rest = (self.radius - away) * (self.radius + away);
        (rest > T::default()).then(|| {
            let half = (rest / square).root();
            [middle - half, middle + half]
        })
    }

    pub(crate) fn contains(&self, point: Triple<T>) -> bool {
        let from = minus(point, self.center);
        dot(from, from) < self.radius * self.radius
    }
}

/// Many lines, coordinate by coordinate, so that a compiler can compute some side by side.
pub(crate) struct Many<T> {
    origins: [Vec<T>; 3],
    dirs: [Vec<T>; 3],
}

impl<T: Real> Many<T> {
    pub(crate) fn of(rays: &[solidray::Ray]) -> Self {
        let each = |of: fn(&solidray::Ray) -> DVec3| {
            [0, 1, 2].map(|k| rays.iter().map(|ray| T::of(of(ray)[k])).collect())
        };
        Self { origins: each(|ray| ray.origin), dirs: each(|ray| ray.dir) }
    }
}

impl<T: Real> Ball<T> {
    /// How much of each ray is inside, without a branch.
    pub(crate) fn lengths(&self, rays: &Many<T>) -> Vec<T> {
        let Many { origins: [ox, oy, oz], dirs: [dx, dy, dz] } = rays;
        let origins = ox.iter().zip(oy).zip(oz);
        let dirs = dx.iter().zip(dy).zip(dz);
        let both = origins.zip(dirs);
        both.map(|(((ox, oy), oz), ((dx, dy), dz))| {
            let from = minus([*ox, *oy, *oz], self.center);
            let dir = [*dx, *dy, *dz];
            let square = dot(dir, dir);
            let middle = -dot(from, dir) / square;
            let at = [0, 1, 2].map(|k| from[k] + middle * dir[k]);
            let away = dot(at, at).root();
            let rest = ((self.radius - away) * (self.radius + away)).max(T::default());
            (rest / square).root() + (rest / square).root()
        })
        .collect()
    }
}

#[derive(Clone, Copy)]
struct Cuboid<T> {
    min: Triple<T>,
    max: Triple<T>,
}

impl<T: Real> Cuboid<T> {
    fn stretch(&self, ray: &Ray<T>) -> Option<Stretch<T>> {
        let mut found = [T::of(f64::NEG_INFINITY), T::of(f64::INFINITY)];
        for k in 0..3 {
            let inverse = T::of(1.0) / ray.dir[k];
            let a = (self.min[k] - ray.origin[k]) * inverse;
            let b = (self.max[k] - ray.origin[k]) * inverse;
            found = [found[0].max(a.min(b)), found[1].min(a.max(b))];
        }
        (found[0] < found[1]).then_some(found)
    }
}

/// A cylinder without ends along an axis.
#[derive(Clone, Copy)]
struct Rod<T> {
    axis: usize,
    center: Triple<T>,
    radius: T,
}

impl<T: Real> Rod<T> {
    /// As that of a ball, in the plane across the axis.
    fn stretch(&self, ray: &Ray<T>) -> Option<Stretch<T>> {
        let (u, v) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let from = [ray.origin[u] - self.center[u], ray.origin[v] - self.center[v]];
        let dir = [ray.dir[u], ray.dir[v]];
        let square = dir[0] * dir[0] + dir[1] * dir[1];
        let middle = -(from[0] * dir[0] + from[1] * dir[1]) / square;
        let at = [from[0] + middle * dir[0], from[1] + middle * dir[1]];
        let away = (at[0] * at[0] + at[1] * at[1]).root();
        let rest = (self.radius - away) * (self.radius + away);
        (rest > T::default()).then(|| {
            let half = (rest / square).root();
            [middle - half, middle + half]
        })
    }
}

/// A cube that is rounded by a ball and bored along the axes.
#[derive(Clone, Copy)]
pub(crate) struct Part<T> {
    cuboid: Cuboid<T>,
    ball: Ball<T>,
    rods: [Rod<T>; 3],
}

/// The sizes of the part, which both precisions have exactly.
pub(crate) const HALF: f64 = 1.0;
pub(crate) const BALL: f64 = 1.375;
pub(crate) const BORE: f64 = 0.6875;

impl<T: Real> Part<T> {
    pub(crate) fn at(center: DVec3) -> Self {
        let cuboid = Cuboid { min: triple(center - HALF), max: triple(center + HALF) };
        let center = triple(center);
        let ball = Ball { center, radius: T::of(BALL) };
        let rods = [0, 1, 2].map(|axis| Rod { axis, center, radius: T::of(BORE) });
        Self { cuboid, ball, rods }
    }

    /// How much of a ray is inside.
    pub(crate) fn length(&self, ray: &Ray<T>) -> T {
        let (Some(a), Some(b)) = (self.cuboid.stretch(ray), self.ball.stretch(ray))
        else {
            return T::default();
        };
        let [mut from, to] = [a[0].max(b[0]), a[1].min(b[1])];
        let mut bores = self.rods.map(|rod| rod.stretch(ray).unwrap_or([from, from]));
        for (i, j) in [(0, 1), (1, 2), (0, 1)] {
            if bores[j][0] < bores[i][0] {
                bores.swap(i, j);
            }
        }
        let mut sum = T::default();
        for [begin, end] in bores {
            let before = begin.min(to);
            if from < before {
                sum = sum + (before - from);
            }
            from = from.max(end);
        }
        if from < to { sum + (to - from) } else { sum }
    }
}

pub(crate) type Triangle<T> = [Triple<T>; 3];

/// Whether a line passes through a triangle, edges included (T. Möller, B. Trumbore, "Fast,
/// Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools 2(1), 1997).
pub(crate) fn meets<T: Real>([a, b, c]: Triangle<T>, ray: &Ray<T>) -> bool {
    let (ab, ac) = (minus(b, a), minus(c, a));
    let across = cross(ray.dir, ac);
    let per_volume = T::of(1.0) / dot(ab, across);
    let from = minus(ray.origin, a);
    let u = dot(from, across) * per_volume;
    let v = dot(ray.dir, cross(from, ab)) * per_volume;
    let zero = T::default();
    u >= zero && v >= zero && u + v <= T::of(1.0)
}
