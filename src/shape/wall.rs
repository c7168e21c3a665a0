//! Curved walls: where a line is inside a quadric, without regard to its ends.
//!
//! # The roots
//!
//! Along a line, `q = x² + y² − ρ(z)` is `A t² + 2 B t + C`. Its roots lose all digits when
//! the line's origin is far away compared to the size of the solid, because C is then a
//! small difference of large squares; no care with the discriminant brings them back.
//! So the origin is moved: first to the point closest to the middle of the solid, then to
//! the vertex of the parabola (for balls and cylinders the same point), where B is zero but for
//! rounding, the discriminant is
//! −A C without cancellation, and C is a product of a sum and a difference of lengths
//! (numbers for the closest approach: Haines, Günther, Akenine-Möller, Ray Tracing Gems,
//! ch. 7, 2019). The second move is left out when the vertex is far away: then the line is
//! almost parallel to the surface there, A is almost zero and |A C| is small against B².
//! The root of smaller size is C / q with q = −(B ± √D), as usual.

use glam::{DMat3, DVec3};

use super::doubt::{Local, Spot, U};
use super::line::Rays;
use super::place::ToLocal;
use crate::lanes::{Lanes, Vec3};
use crate::primitive::Profile;

/// A quadric that nothing cuts, `x² + y² ≤ ρ(z)` in its own frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wall {
    pub(crate) profile: Profile,
    pub(crate) to_local: ToLocal,
    /// The heights between which lines are looked for.
    pub(crate) ends: [f64; 2],
    /// The solid between the ends has its middle at this height on the axis.
    middle: f64,
    /// No point of the solid is farther from the middle.
    reach: f64,
}

impl Wall {
    /// The wall of which the part between two heights is wanted.
    pub(crate) fn new(profile: Profile, to_local: ToLocal, ends: [f64; 2]) -> Self {
        // The whole ball has the same middle in every frame.
        let ends =
            if let Profile::Ball { radius } = profile { [-radius, radius] } else { ends };
        let [bottom, top] = ends;
        let radius = profile.largest_radius(ends);
        let middle = 0.5 * (bottom + top);
        let reach = (0.5 * (top - bottom)).hypot(radius);
        Self { profile, to_local, ends, middle, reach }
    }

    /// This wall with its own profile, about which the caller knows more.
    #[inline(always)]
    pub(crate) fn with_profile(&self, profile: Profile) -> Self {
        Self { profile, ..*self }
    }

    /// A normal of any length, outward, at a world point.
    pub(crate) fn normal(&self, point: DVec3) -> DVec3 {
        let p = self.to_local.point(point);
        self.to_local.normal_to_world(self.profile.half_gradient(p.into()).into())
    }

    /// Where `q ≤ 0` on lines: one or two stretches of each, perhaps infinite, perhaps empty.
    #[inline(always)]
    pub(crate) fn inside<L: Lanes>(
        &self,
        rays: &Rays<L>,
        course: &Course<L>,
    ) -> [[L; 2]; 2] {
        let Approach { moved, p, b, .. } = self.approach(course, rays);
        let Course { a, step, .. } = *course;
        let c = self.profile.value(p);
        let like = a;
        let (never, always) = (like.same(f64::INFINITY), like.same(f64::NEG_INFINITY));
        let zero = like.same(0.0);
        let discriminant = b * b - a * c;
        let root = discriminant.sqrt();
        let falls = b.less(zero);
        let q = -(b + L::select(falls, -root, root));
        // Zero has a sign, but the line has no side to choose there: both roots by one
        // formula, so that the reversed line gives the same bits.
        let balanced = b.equal(zero);
        let one = L::select(balanced, -root, q) / a;
        let other = L::select(balanced, root, c) / L::select(balanced, a, q);
        let (one, other) = ((moved + one) * step, (moved + other) * step);
        let (first, second) = (one.min(other), one.max(other));
        // Not a number where the scene is too large for the leaf to be told from a point.
        let crosses = zero.less(discriminant) & discriminant.is_finite();
        let mut from = L::select(crosses, first, never);
        let mut to = L::select(crosses, second, always);
        if let Profile::Ball { .. } = self.profile {
            return [[from, to], [never, always]];
        }
        let linear = a.equal(zero);
        if L::any(linear) {
            let root = (moved - like.same(0.5) * c / b) * step;
            let holds = !balanced | c.less(zero);
            from = L::select(linear, L::select(falls, root, always), from);
            from = L::select(linear & !holds, never, from);
            to = L::select(linear, L::select(zero.less(b), root, never), to);
            to = L::select(linear & !holds, always, to);
        }
        if !self.profile.can_be_left_twice() {
            return [[from, to], [never, always]];
        }
        let opens = a.less(zero);
        from = L::select(opens, always, from);
        to = L::select(opens, L::select(crosses, first, never), to);
        let again = opens & crosses;
        [[from, to], [L::select(again, second, never), L::select(again, never, always)]]
    }

    /// What depends on the direction of lines alone.
    #[inline(always)]
    pub(crate) fn course<L: Lanes>(&self, dir: Vec3<L>) -> Course<L> {
        let dir = dir.mapped(&self.to_local.linear);
        // Where the scene is far larger than the leaf, squares of steps are no numbers.
        let step = dir.largest().inverse_power_of_two();
        let dir = dir.scaled(step);
        Course { dir, step, a: self.profile.quadratic(dir) }
    }

    /// Moves the origins of lines to where the roots are best found.
    #[inline(always)]
    fn approach<L: Lanes>(&self, course: &Course<L>, rays: &Rays<L>) -> Approach<L> {
        let Course { dir, a, .. } = *course;
        let away = (rays.origin - Vec3::same(a, self.to_local.origin)) + rays.rest;
        let origin = away.mapped(&self.to_local.linear);
        let closest = self.closest_approach(origin, course);
        let p = origin + dir.scaled(closest);
        let b = self.profile.linear(p, dir);
        let near = Approach { origin, moved: closest, way: closest.abs(), p, b };
        if let Profile::Ball { .. } | Profile::Cylinder { .. } = self.profile {
            return near;
        }
        let to_vertex = -b / a;
        let reach = a.same(NEAR * self.reach);
        let is_near = !reach.less(to_vertex.abs() * dir.length());
        let move_on = L::select(is_near & to_vertex.is_finite(), to_vertex, a.same(0.0));
        let p = p + dir.scaled(move_on);
        let b = self.profile.linear(p, dir);
        Approach { origin, moved: closest + move_on, way: near.way + move_on.abs(), p, b }
    }
}

/// The direction of lines in the frame of a wall.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Course<L> {
    dir: Vec3<L>,
    /// `dir` in multiples of the lines' direction.
    step: L,
    /// A: the quadratic coefficient.
    a: L,
}

/// Lines in the frame of a wall.
struct Approach<L> {
    origin: Vec3<L>,
    /// From the origin to `p`, in multiples of the direction.
    moved: L,
    /// The length of that way, there and back.
    way: L,
    /// The point from which roots are sought.
    p: Vec3<L>,
    /// B there.
    b: L,
}

impl Wall {
    /// The equation of the wall at a place.
    ///
    /// A point moved by `m` changes `q` by at most `2 |g| m + m S m`, where `g` is half the
    /// gradient and `S` has the absolute values of the second derivatives. Roots are sought
    /// from a point `p` at a distance τ: there A, B and C are wrong by at most 4 u times the
    /// sums of the absolute values of their products, which moves `q` at τ by
    /// `ΔA τ² + 2 ΔB |τ| + ΔC`; and τ itself is rounded by 8 u.
    pub(super) fn local(&self, spot: &Spot<'_>) -> Local {
        let Spot { line, t, slack } = *spot;
        let course = self.course(line.dir.into());
        let Approach { origin, moved, way, p: vertex, .. } =
            self.approach(&course, &line.into());
        let Course { dir, step, a } = course;
        let (dir, origin, vertex): (DVec3, DVec3, DVec3) =
            (dir.into(), origin.into(), vertex.into());
        let t = t / step;
        let size = self.to_local.linear.abs();
        let away = (line.origin - self.to_local.origin).abs();
        let m = size
            * (line.rounding()
                + DVec3::splat(slack)
                + 6.0 * U * away
                + 4.0 * U * spot.t.abs() * line.dir.abs())
            + 4.0 * U * (origin.abs() + (way + t.abs()) * dir.abs());
        let [zz, z, _] = self.profile.coefficients();
        let weights = DVec3::new(1.0, 1.0, zz.abs());
        let p = origin + t * dir;
        let (gradient, d) = (self.profile.half_gradient(p.into()), dir.abs());
        let gradient = DVec3::from(gradient);
        let tau = (t - moved).abs();
        let of_a = 4.0 * U * weights.dot(d * d);
        let of_b = 4.0 * U * (weights.dot(vertex.abs() * d) + z.abs() * d.z);
        let slope = 2.0 * gradient.dot(dir);
        let rounding = (2.0 * gradient.abs() + weights * m).dot(m)
            + (of_a * tau + 2.0 * of_b) * tau
            + self.profile.value_rounding(vertex)
            + self.profile.value_rounding(p)
            + 8.0 * U * slope.abs() * (tau + way);
        Local {
            value: self.profile.value(p.into()),
            rounding,
            slope: slope / step,
            slope_rounding: (2.0 * weights.dot(m * d) + 2.0 * of_b) / step,
            bend: a / step / step,
            bend_rounding: of_a / step / step,
        }
    }

    /// How far along lines they come closest to the middle; to the axis of a cylinder, which
    /// has no middle: then it does not matter how much of the cylinder is wanted.
    #[inline(always)]
    fn closest_approach<L: Lanes>(&self, origin: Vec3<L>, course: &Course<L>) -> L {
        let Course { dir, a, .. } = *course;
        if let Profile::Cylinder { .. } = self.profile {
            let zero = a.same(0.0);
            let closest = -self.profile.linear(origin, dir) / a;
            return L::select(a.equal(zero), zero, closest);
        }
        let to_middle = Vec3 { z: origin.z - a.same(self.middle), ..origin };
        -to_middle.dot(dir) / dir.dot(dir)
    }
}

/// The vertex counts as near within this many times the reach of the solid. With a root
/// in reach and the vertex farther away than `NEAR` reaches, the other root is at least
/// 2 `NEAR` − 1 reaches away, so the discriminant keeps more than half of B².
const NEAR: f64 = 4.0;

impl Wall {
    /// No coordinate of the points from which roots are sought is larger for lines that come near
    /// the solid; zero where such points are no farther away than the points asked about.
    pub(super) fn vertex_reach(&self) -> f64 {
        match self.profile {
            Profile::Ball { .. } | Profile::Cylinder { .. } => 0.0,
            Profile::Cone { .. }
            | Profile::Paraboloid { .. }
            | Profile::OneSheet { .. }
            | Profile::TwoSheets { .. } => {
                self.middle.abs() + 2.0 * (NEAR + 1.0) * self.reach
            }
        }
    }
}

/// # What tells whether two walls are one
impl Wall {
    /// A point that walls on one quadric have in common: the centre, vertex or apex, or
    /// for cylinders the point of the axis closest to a given one.
    pub(crate) fn landmark(&self, near: DVec3) -> DVec3 {
        let world_from_local = self.to_local.linear_to_world();
        let at =
            |z: f64| self.to_local.origin + world_from_local * DVec3::new(0.0, 0.0, z);
        match self.profile {
            Profile::Cylinder { .. } => {
                let axis = world_from_local.z_axis;
                let origin = self.to_local.origin;
                origin - axis * ((origin - near).dot(axis) / axis.length_squared())
            }
            Profile::Cone { radius, slope } => at(-radius / slope),
            Profile::Ball { .. }
            | Profile::Paraboloid { .. }
            | Profile::OneSheet { .. }
            | Profile::TwoSheets { .. } => at(0.0),
        }
    }

    /// How much farther than the wall itself the landmark can be moved by what moves the
    /// wall: the ratio of the lengths along and across the axis.
    pub(crate) fn slenderness(&self) -> f64 {
        let [bottom, top] = self.ends;
        let radius = self.profile.largest_radius(self.ends);
        let far = match self.profile {
            Profile::Cone { radius, slope } => (radius / slope).abs() + (top - bottom),
            Profile::Ball { .. }
            | Profile::Cylinder { .. }
            | Profile::Paraboloid { .. }
            | Profile::OneSheet { .. }
            | Profile::TwoSheets { .. } => top - bottom,
        };
        let m = self.to_local.linear;
        let stretch = |v: DVec3| 1.0 / v.length();
        let condition = m.col(0).length().max(m.col(1).length()).max(m.col(2).length())
            * stretch(m.col(0)).max(stretch(m.col(1))).max(stretch(m.col(2)));
        condition * (1.0 + (far / radius).powi(2))
    }

    /// At most how far from another wall this one is anywhere between its ends, to first
    /// order.
    ///
    /// Both equations are written in coordinates in which this wall is about 1 wide and 1
    /// high; where their coefficients differ by δ the walls are about δ/2 apart.
    pub(crate) fn distance(&self, other: &Self) -> f64 {
        let [bottom, top] = self.ends;
        let radius = self.profile.largest_radius(self.ends);
        let scale = DVec3::new(radius, radius, 0.5 * (top - bottom));
        let back = self.to_local.linear_to_world();
        let origin = self.to_local.origin + back * DVec3::new(0.0, 0.0, self.middle);
        let map = back * DMat3::from_diagonal(scale);
        let (ours, theirs) = (self.form(origin, map), other.form(origin, map));
        let ratio = (theirs[0] + theirs[1]) / (ours[0] + ours[1]);
        // Walls with the same equation turned round are no walls of one solid.
        if ratio.is_nan() || ratio <= 0.0 {
            return f64::INFINITY;
        }
        let apart: f64 =
            ours.iter().zip(theirs).map(|(a, b)| (b / ratio - a).abs()).sum();
        let size = (ours[0] + ours[1]).abs();
        let narrowest = map.col(0).length().min(map.col(1).length());
        let along = map.col(2).length();
        apart / size * narrowest.max(f64::MIN_POSITIVE) * (1.0 + narrowest / along)
    }

    /// The ten coefficients of the equation at `origin + map · s`: of s₀², s₁², s₂², s₀s₁,
    /// s₁s₂, s₂s₀, s₀, s₁, s₂ and 1.
    pub(super) fn form(&self, origin: DVec3, map: DMat3) -> [f64; 10] {
        let [a, b, _] = self.profile.coefficients();
        let (p, m) = (self.to_local.point(origin), self.to_local.linear * map);
        let weigh = |v: DVec3| DVec3::new(v.x, v.y, -a * v.z);
        let product = |i: usize, j: usize| weigh(m.col(i)).dot(m.col(j));
        let gradient = weigh(p) - DVec3::new(0.0, 0.0, b);
        let slope = |i: usize| 2.0 * gradient.dot(m.col(i));
        [
            product(0, 0),
            product(1, 1),
            product(2, 2),
            2.0 * product(0, 1),
            2.0 * product(1, 2),
            2.0 * product(2, 0),
            slope(0),
            slope(1),
            slope(2),
            self.profile.value(p.into()),
        ]
    }

    /// The numbers that describe it, ends apart.
    pub(crate) fn numbers(&self) -> [f64; 15] {
        let mut numbers = [0.0; 15];
        numbers[..9].copy_from_slice(&self.to_local.linear.to_cols_array());
        numbers[9..12].copy_from_slice(&self.to_local.origin.to_array());
        numbers[12..].copy_from_slice(&self.profile.coefficients());
        numbers
    }

    /// This wall, long enough for another one on the same quadric too.
    pub(crate) fn extended_by(&self, other: &Self) -> Self {
        if let Profile::Ball { .. } = self.profile {
            return *self;
        }
        let back = other.to_local.linear_to_world();
        let here = |z: f64| {
            self.to_local.point(other.to_local.origin + back * DVec3::new(0.0, 0.0, z)).z
        };
        let same_frame = self.to_local == other.to_local;
        let [a, b] = if same_frame { other.ends } else { other.ends.map(here) };
        let [bottom, top] = self.ends;
        let ends = [bottom.min(a).min(b), top.max(a).max(b)];
        Self::new(self.profile, self.to_local, ends)
    }
}

impl Profile {
    /// `x² + y² − ρ(z)` at points, as a product where it is a difference of squares.
    #[inline(always)]
    fn value<L: Lanes>(&self, p: Vec3<L>) -> L {
        let like = p.x;
        match *self {
            Self::Ball { radius } => difference_of_squares(p.length(), like.same(radius)),
            Self::Cylinder { radius } => {
                difference_of_squares(p.across(), like.same(radius))
            }
            Self::Cone { radius, slope } => difference_of_squares(
                p.across(),
                like.same(radius) + like.same(slope) * p.z,
            ),
            Self::Paraboloid { scale } => {
                (p.x * p.x + p.y * p.y) - like.same(scale) * p.z
            }
            Self::OneSheet { waist, slope } => difference_of_squares(
                p.across(),
                hypot(like.same(waist), like.same(slope) * p.z),
            ),
            Self::TwoSheets { vertex, slope } => difference_of_squares(
                hypot(p.across(), like.same(slope * vertex)),
                like.same(slope) * p.z,
            ),
        }
    }

    /// At most how wrong [`Profile::value`] is for an exact point: it is a product of a sum and a
    /// difference of two lengths, each of which is rounded by 3 u of itself, that of the
    /// cone by u of the two numbers whose sum it is.
    fn value_rounding(&self, p: DVec3) -> f64 {
        let across = p.truncate().length();
        let of_product =
            |a: f64, b: f64, b_rounding: f64| 2.0 * (a + b) * (3.0 * U * a + b_rounding);
        match *self {
            Self::Ball { radius } => of_product(p.length(), radius, 0.0),
            Self::Cylinder { radius } => of_product(across, radius, 0.0),
            Self::Cone { radius, slope } => of_product(
                across,
                (radius + slope * p.z).abs(),
                2.0 * U * (radius.abs() + (slope * p.z).abs()),
            ),
            Self::Paraboloid { scale } => {
                4.0 * U * (across * across + (scale * p.z).abs())
            }
            Self::OneSheet { waist, slope } => {
                let b = waist.hypot(slope * p.z);
                of_product(across, b, 3.0 * U * b)
            }
            Self::TwoSheets { vertex, slope } => {
                let a = across.hypot(slope * vertex);
                let b = (slope * p.z).abs();
                of_product(a, b, 3.0 * U * b)
            }
        }
    }

    /// Half the gradient of [`Profile::value`].
    #[inline(always)]
    fn half_gradient<L: Lanes>(&self, p: Vec3<L>) -> Vec3<L> {
        let like = p.x;
        let z = match *self {
            Self::Ball { .. } => p.z,
            Self::Cylinder { .. } => like.same(0.0),
            Self::Cone { radius, slope } => {
                like.same(-slope) * (like.same(radius) + like.same(slope) * p.z)
            }
            Self::Paraboloid { scale } => like.same(-0.5 * scale),
            Self::OneSheet { slope, .. } | Self::TwoSheets { slope, .. } => {
                like.same(-slope * slope) * p.z
            }
        };
        Vec3 { z, ..p }
    }

    /// A: the quadratic coefficient along directions.
    #[inline(always)]
    fn quadratic<L: Lanes>(&self, d: Vec3<L>) -> L {
        match *self {
            Self::Ball { .. } => d.dot(d),
            Self::Cylinder { .. } | Self::Paraboloid { .. } => d.x * d.x + d.y * d.y,
            Self::Cone { slope, .. }
            | Self::OneSheet { slope, .. }
            | Self::TwoSheets { slope, .. } => {
                difference_of_squares(d.across(), d.z.same(slope) * d.z)
            }
        }
    }

    /// B: half the derivative of the value along directions.
    #[inline(always)]
    fn linear<L: Lanes>(&self, p: Vec3<L>, d: Vec3<L>) -> L {
        self.half_gradient(p).dot(d)
    }
}

/// `a² − b²` with a relative error of a few units for exact operands.
#[inline(always)]
fn difference_of_squares<L: Lanes>(a: L, b: L) -> L {
    (a - b) * (a + b)
}

/// The length of (a, b), which are neither too large nor too small for their squares.
#[inline(always)]
fn hypot<L: Lanes>(a: L, b: L) -> L {
    (a * a + b * b).sqrt()
}
