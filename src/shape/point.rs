//! Points beside leaves: on which side of each face, if that is beyond doubt.
//!
//! # Why the sign of an equation is what a line would say
//!
//! A point is inside of a leaf if the line through it along a fixed direction has passed into
//! the leaf at the point and not out again. The crossings of the line are rounded: each is the
//! exact crossing with a face whose equation was moved by at most ε there ([`doubt`]), and so
//! is the point itself, by the move of the line's origin. Where the equation at the point is
//! farther from zero than both, it has no zero between the point and its place on the
//! line, so the computed crossing lies on the side of it that the sign says.
//!
//! The tolerances here are not sharp: they only have to be larger than those of [`doubt`],
//! and points are as rarely in a band of 10⁻¹⁰ of the solid's size as in one of 10⁻¹⁵. So
//! they are simple, and bounded over a whole box of points at once. Equations are divided by
//! them: below −1 a point is inside for certain, above 1 outside, between them the line
//! has to be asked. With minimum for union, maximum for intersection and a change of sign
//! for a complement the numbers of leaves combine to one for the solid (V. L. Rvachev's functions), and
//! since minimum and maximum only choose, −1 and 1 bound the same doubt for it: it is Kleene's
//! logic of three values.
//!
//! [`doubt`]: super::doubt

use glam::DVec3;

use super::Shape;
use super::doubt::U;
use super::plane::Plane;
use super::wall::Wall;
use crate::aabb::Aabb;
use crate::lanes::{Lanes, Vec3};

/// The equation of a face, or of two opposite ones, divided by its tolerance; for a
/// complement with its sign changed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Equation {
    /// Nothing is certain.
    Unknown,
    /// `scale (x − offset)` for the coordinate on an axis.
    Side { axis: usize, offset: f64, scale: f64 },
    /// `scale (|x − middle| − half)` for the coordinate on an axis.
    Slab { axis: usize, middle: f64, half: f64, scale: f64 },
    /// `normal · p − offset`.
    Plane { normal: DVec3, offset: f64 },
    /// `scale |normal · p − middle| − half`.
    Band { normal: DVec3, middle: f64, half: f64, scale: f64 },
    /// `squares · d² − constant` with `d = p − origin`.
    Level { origin: DVec3, squares: DVec3, constant: f64 },
    /// `square d² − constant`.
    Round { origin: DVec3, square: f64, constant: f64 },
    /// The same without the square of one coordinate, `square` for the others.
    Disc { axis: usize, origin: DVec3, square: f64, constant: f64 },
    /// The largest of three slabs, for all axes.
    Cuboid { middle: DVec3, half: DVec3, scale: f64 },
    /// `squares · d² + products · (dy dz, dz dx, dx dy) + linear · d − constant`.
    Quadric {
        origin: DVec3,
        squares: DVec3,
        products: DVec3,
        linear: DVec3,
        constant: f64,
    },
}

impl Equation {
    /// Its value at points.
    #[inline(always)]
    pub(crate) fn at<L: Lanes>(&self, p: Vec3<L>) -> L {
        let like = p.x;
        match *self {
            Self::Unknown => like.same(0.0),
            Self::Side { axis, offset, scale } => {
                (on_axis(p, axis) - like.same(offset)) * like.same(scale)
            }
            Self::Slab { axis, middle, half, scale } => {
                let away = (on_axis(p, axis) - like.same(middle)).abs();
                (away - like.same(half)) * like.same(scale)
            }
            Self::Plane { normal, offset } => {
                Vec3::same(like, normal).dot(p) - like.same(offset)
            }
            Self::Band { normal, middle, half, scale } => {
                let away = (Vec3::same(like, normal).dot(p) - like.same(middle)).abs();
                away * like.same(scale) - like.same(half)
            }
            Self::Level { origin, squares, constant } => {
                let d = p - Vec3::same(like, origin);
                let d = Vec3 { x: d.x * d.x, y: d.y * d.y, z: d.z * d.z };
                Vec3::same(like, squares).dot(d) - like.same(constant)
            }
            Self::Round { origin, square, constant } => {
                let d = p - Vec3::same(like, origin);
                d.dot(d) * like.same(square) - like.same(constant)
            }
            Self::Disc { axis, origin, square, constant } => {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                let a = on_axis(p, i) - like.same(origin[i]);
                let b = on_axis(p, j) - like.same(origin[j]);
                (a * a + b * b) * like.same(square) - like.same(constant)
            }
            Self::Cuboid { middle, half, scale } => {
                let d = p - Vec3::same(like, middle);
                let (x, y) =
                    (d.x.abs() - like.same(half.x), d.y.abs() - like.same(half.y));
                let z = d.z.abs() - like.same(half.z);
                x.max(y).max(z) * like.same(scale)
            }
            Self::Quadric { origin, squares, products, linear, constant } => {
                let d = p - Vec3::same(like, origin);
                let (s, m) = (Vec3::same(like, squares), Vec3::same(like, products));
                let x = s.x * d.x + m.z * d.y + like.same(linear.x);
                let y = s.y * d.y + m.x * d.z + like.same(linear.y);
                let z = s.z * d.z + m.y * d.x + like.same(linear.z);
                Vec3 { x, y, z }.dot(d) - like.same(constant)
            }
        }
    }

    /// That of the complement.
    pub(crate) fn negated(self) -> Self {
        match self {
            Self::Unknown => self,
            Self::Side { axis, offset, scale } => {
                Self::Side { axis, offset, scale: -scale }
            }
            Self::Slab { axis, middle, half, scale } => {
                Self::Slab { axis, middle, half, scale: -scale }
            }
            Self::Plane { normal, offset } => {
                Self::Plane { normal: -normal, offset: -offset }
            }
            Self::Band { normal, middle, half, scale } => {
                Self::Band { normal, middle, half: -half, scale: -scale }
            }
            Self::Level { origin, squares, constant } => {
                Self::Level { origin, squares: -squares, constant: -constant }
            }
            Self::Round { origin, square, constant } => {
                Self::Round { origin, square: -square, constant: -constant }
            }
            Self::Disc { axis, origin, square, constant } => {
                Self::Disc { axis, origin, square: -square, constant: -constant }
            }
            Self::Cuboid { middle, half, scale } => {
                Self::Cuboid { middle, half, scale: -scale }
            }
            Self::Quadric { origin, squares, products, linear, constant } => {
                Self::Quadric {
                    origin,
                    squares: -squares,
                    products: -products,
                    linear: -linear,
                    constant: -constant,
                }
            }
        }
    }

    /// Itself if its numbers leave room for products with coordinates of any point it is for.
    fn checked(self, largest: f64, tolerance: f64) -> Self {
        const MOST: f64 = 1e100;
        let is_fit = tolerance > 1.0 / MOST && largest / tolerance < MOST;
        if is_fit { self } else { Self::Unknown }
    }
}

#[inline(always)]
fn on_axis<L: Lanes>(p: Vec3<L>, axis: usize) -> L {
    match axis {
        0 => p.x,
        1 => p.y,
        _ => p.z,
    }
}

/// On which side of something a point is, if that is certain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Beside {
    In,
    Out,
    Unsure,
}

/// An equation at one point and its tolerance.
type Valued = (f64, f64);

impl Shape {
    /// Hands over equations of which the largest is that of the leaf for all points of a box,
    /// if only some of its faces need to be looked at.
    ///
    /// Neither the line through a point nor the leaf is farther than `pad` / 4 from where
    /// it should be.
    pub(crate) fn equations(
        &self,
        faces: u32,
        within: &Aabb,
        pad: f64,
        mut put: impl FnMut(Equation),
    ) {
        let (planes, wall) = match self {
            Self::Sides(leaf) => leaf.planes_and_wall(),
            Self::Polyhedron(_) => return put(Equation::Unknown),
        };
        if let Some(wall) = wall
            && faces & 1 == 1
        {
            put(wall.equation(within, pad));
        }
        let wanted = if wall.is_some() { faces >> 1 } else { faces };
        let mut slabs = [None; 3];
        of_planes(planes, wanted, within, pad, &mut |equation| {
            if let Equation::Slab { axis, .. } = equation
                && slabs[axis].is_none()
            {
                slabs[axis] = Some(equation);
            } else {
                put(equation);
            }
        });
        match cuboid(slabs) {
            Some(equation) => put(equation),
            None => slabs.into_iter().flatten().for_each(put),
        }
    }

    /// On which side of the leaf a point is that is no farther than `pad` from its box.
    pub(crate) fn beside(&self, p: DVec3, pad: f64) -> Beside {
        let (planes, wall) = match self {
            Self::Sides(leaf) => leaf.planes_and_wall(),
            Self::Polyhedron(_) => return Beside::Unsure,
        };
        match wall.map_or(Beside::In, |wall| of_one(wall.valued(p, pad))) {
            Beside::Out => Beside::Out,
            known @ (Beside::In | Beside::Unsure) => of_all(known, planes, p, pad),
        }
    }
}

/// On which side a face has a point.
fn of_one((value, tolerance): Valued) -> Beside {
    if value < -tolerance {
        Beside::In
    } else if value > tolerance {
        Beside::Out
    } else {
        Beside::Unsure
    }
}

/// On which side of all of some planes a point is of which something is known.
fn of_all(mut known: Beside, planes: &[Plane], p: DVec3, pad: f64) -> Beside {
    for plane in planes {
        match of_one(plane.valued(p, pad)) {
            Beside::In => {}
            Beside::Out => return Beside::Out,
            Beside::Unsure => known = Beside::Unsure,
        }
    }
    known
}

/// Those of planes of which each two that follow one another may be opposite.
fn of_planes(
    planes: &[Plane],
    faces: u32,
    within: &Aabb,
    pad: f64,
    put: &mut impl FnMut(Equation),
) {
    for (pair, planes) in planes.chunks(2).enumerate() {
        match (faces >> (2 * pair) & 3, planes) {
            (3, [a, b]) if a.normal == b.normal && a.above != b.above => {
                put(a.band(b, within, pad));
            }
            (wanted, planes) => {
                for (i, plane) in planes.iter().enumerate() {
                    if wanted >> i & 1 == 1 {
                        put(plane.equation(within, pad));
                    }
                }
            }
        }
    }
}

/// Slabs across all three axes as one, with the largest of their tolerances.
fn cuboid(slabs: [Option<Equation>; 3]) -> Option<Equation> {
    let (mut middles, mut halves, mut least) = (DVec3::ZERO, DVec3::ZERO, f64::INFINITY);
    for slab in slabs {
        let Some(Equation::Slab { axis, middle, half, scale }) = slab else {
            return None;
        };
        middles[axis] = middle;
        halves[axis] = half;
        least = least.min(scale);
    }
    Some(Equation::Cuboid { middle: middles, half: halves, scale: least })
}

/// The largest coordinates of a box.
fn largest(b: &Aabb) -> DVec3 {
    b.min.abs().max(b.max.abs())
}

impl Plane {
    fn tolerance(&self, pad: f64) -> f64 {
        pad * self.normal.abs().element_sum() + 512.0 * U * self.offset.abs()
    }

    fn valued(&self, p: DVec3, pad: f64) -> Valued {
        let above = self.normal.dot(p) - self.offset;
        (if self.above { -above } else { above }, self.tolerance(pad))
    }

    fn equation(&self, within: &Aabb, pad: f64) -> Equation {
        let tolerance = self.tolerance(pad);
        let scale = if self.above { -1.0 } else { 1.0 } / tolerance;
        let equation = match self.axis() {
            Some(axis) => {
                let scale = scale * self.normal[axis];
                Equation::Side { axis, offset: self.offset / self.normal[axis], scale }
            }
            None => {
                let (normal, offset) = (self.normal * scale, self.offset * scale);
                Equation::Plane { normal, offset }
            }
        };
        equation.checked(self.largest(within), tolerance)
    }

    /// That of this plane and the one opposite.
    fn band(&self, other: &Self, within: &Aabb, pad: f64) -> Equation {
        let tolerance = self.tolerance(pad).max(other.tolerance(pad));
        let (low, high) = if self.above { (self, other) } else { (other, self) };
        let (low, high) = (low.offset, high.offset);
        let (middle, half) = (0.5 * low + 0.5 * high, 0.5 * high - 0.5 * low);
        let scale = 1.0 / tolerance;
        let equation = match self.axis() {
            // The normal is divided by its largest component, and points up.
            Some(axis) => Equation::Slab { axis, middle, half, scale },
            None => {
                Equation::Band { normal: self.normal, middle, half: half * scale, scale }
            }
        };
        let largest = self.largest(within) + other.offset.abs();
        equation.checked(largest, tolerance)
    }

    fn largest(&self, within: &Aabb) -> f64 {
        self.normal.abs().dot(largest(within)) + self.offset.abs()
    }
}

impl Wall {
    fn valued(&self, p: DVec3, pad: f64) -> Valued {
        let [a, b, c] = self.profile.coefficients();
        let DVec3 { x, y, z } = self.to_local.point(p);
        let value = x * x + y * y - z * (a * z + 2.0 * b) - c;
        let (tolerance, _) = self.tolerance(DVec3::new(x, y, z).abs(), pad);
        (value, tolerance)
    }

    /// How large the equation has to be to have a sign where no coordinate in the leaf's frame
    /// is larger than `reach`, and a bound for the equation there.
    ///
    /// A point moved by `m` changes it by `2 |g| m + m S m` as in [`Wall::local`]; its
    /// terms, and those at the vertex from which roots are sought, are rounded. The sum of the
    /// absolute values of the map bounds any norm of it.
    fn tolerance(&self, reach: DVec3, pad: f64) -> (f64, f64) {
        let [a, b, c] = self.profile.coefficients();
        let (a, b) = (a.abs(), b.abs());
        let linear = self.to_local.linear.abs();
        let moved = pad * (linear.x_axis + linear.y_axis + linear.z_axis).element_sum();
        let gradient = reach.x + reach.y + a * reach.z + b;
        let terms = reach.x * reach.x
            + reach.y * reach.y
            + reach.z * (a * reach.z + 2.0 * b)
            + c.abs();
        let vertex = self.vertex_reach();
        let at_vertex = vertex * ((2.0 + a) * vertex + 2.0 * b);
        let rounding = 512.0 * U * (terms + at_vertex);
        ((2.0 * gradient + (2.0 + a) * moved) * moved + rounding, terms)
    }

    fn equation(&self, within: &Aabb, pad: f64) -> Equation {
        let [a, b, c] = self.profile.coefficients();
        let (linear, origin) = (self.to_local.linear, self.to_local.origin);
        let away = (within.center() - origin).abs() + 0.5 * within.size();
        let (mut tolerance, terms) = self.tolerance(linear.abs() * away, pad);
        let weights = DVec3::new(1.0, 1.0, -a);
        let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
        let form = |p: DVec3, q: DVec3| (weights * p).dot(q);
        let squares = DVec3::new(form(x, x), form(y, y), form(z, z));
        let products = 2.0 * DVec3::new(form(y, z), form(z, x), form(x, y));
        let gradient = -2.0 * b * linear.row(2);
        // What is left of products where axes are square to each other is rounding.
        let DVec3 { x, y, z } = away;
        let rest = products.abs().dot(DVec3::new(y * z, z * x, x * y));
        let is_level = rest < 0.25 * tolerance && gradient == DVec3::ZERO;
        if is_level {
            tolerance += rest;
        }
        let scale = 1.0 / tolerance;
        let constant = c * scale;
        let squares = squares * scale;
        let equation = if is_level {
            level(origin, squares, constant, away)
        } else {
            let (products, linear) = (products * scale, gradient * scale);
            Equation::Quadric { origin, squares, products, linear, constant }
        };
        equation.checked(terms, tolerance)
    }
}

/// An equation of squares alone. Those that differ, or are there, by less than a sixteenth of
/// the tolerance for all points up to `away` are equal, or not there.
fn level(origin: DVec3, squares: DVec3, constant: f64, away: DVec3) -> Equation {
    const NEGLIGIBLE: f64 = 0.0625 / 3.0;
    let parts = squares * away * away;
    let are_one = |i: usize, j: usize| {
        let rest = (squares[i] - squares[j]).abs() * away[j] * away[j];
        rest < NEGLIGIBLE
    };
    if are_one(0, 1) && are_one(0, 2) {
        return Equation::Round { origin, square: squares.x, constant };
    }
    for axis in 0..3 {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        if parts[axis].abs() < NEGLIGIBLE && are_one(i, j) {
            return Equation::Disc { axis, origin, square: squares[i], constant };
        }
    }
    Equation::Level { origin, squares, constant }
}
