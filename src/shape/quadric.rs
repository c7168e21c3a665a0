//! Solids of revolution bounded by a quadric, under any affine map.
//!
//! # The roots
//!
//! Along a line, `q = x² + y² − ρ(z)` is `A t² + 2 B t + C`. Its roots lose all digits when
//! the line's origin is far away compared to the size of the solid, because C is then a
//! small difference of large squares; no care with the discriminant brings them back.
//! So the origin is moved: first to the point closest to the middle of the solid, then to
//! the vertex of the parabola, where B is zero but for rounding, the discriminant is
//! −A C without cancellation, and C is a product of a sum and a difference of lengths
//! (numbers for the closest approach: Haines, Günther, Akenine-Möller, Ray Tracing Gems,
//! ch. 7, 2019). The second move is left out when the vertex is far away: then the line is
//! almost parallel to the surface there, A is almost zero and |A C| is small against B².
//! The root of smaller size is C / q with q = −(B ± √D), as usual.

use glam::DVec3;

use super::place::{Frame, ToLocal};
use super::primitive::Profile;
use super::slab::Slab;
use super::{Line, Sink, Surface};
use crate::aabb::Aabb;

/// A quadric. Face 0 is the curved one, 1 the bottom and 2 the top.
#[derive(Clone, Debug)]
pub(crate) struct Quadric {
    profile: Profile,
    /// The middle of the solid is at this height on the axis.
    middle: f64,
    /// No point of the solid is farther from the middle.
    reach: f64,
    to_local: ToLocal,
    /// Absent where the profile ends by itself: a whole ball.
    slab: Option<Slab>,
}

impl Quadric {
    pub(crate) fn new(frame: &Frame, profile: Profile, bottom: f64, top: f64) -> Self {
        let whole = matches!(profile, Profile::Ball { radius } if bottom <= -radius && top >= radius);
        let slab = (!whole).then(|| Slab::new(frame, 2, bottom, top));
        let (bottom, top) = profile.extent(bottom, top);
        let radius = profile.largest_radius(bottom, top);
        Self {
            profile,
            middle: 0.5 * (bottom + top),
            reach: (0.5 * (top - bottom)).hypot(radius),
            to_local: frame.to_local(),
            slab,
        }
    }

    pub(crate) fn bounds(frame: &Frame, profile: Profile, bottom: f64, top: f64) -> Aabb {
        let (bottom, top) = profile.extent(bottom, top);
        match profile {
            Profile::Ball { radius } if bottom <= -radius && top >= radius => {
                frame.bounds_of_ball(radius)
            }
            // Where the radius is a convex function of height, the solid is within the
            // convex hull of its two ends.
            Profile::Cylinder { .. }
            | Profile::Cone { .. }
            | Profile::OneSheet { .. } => {
                frame.bounds_of_discs([bottom, top].map(|z| (z, profile.radius(z))))
            }
            Profile::Ball { .. }
            | Profile::Paraboloid { .. }
            | Profile::TwoSheets { .. } => {
                let radius = profile.largest_radius(bottom, top);
                frame.bounds_of_discs([(bottom, radius), (top, radius)])
            }
        }
    }

    pub(crate) fn kind(&self) -> &'static str {
        self.profile.name()
    }

    /// Where `q ≤ 0` on the local line `p + t d`: one or two stretches, perhaps infinite.
    fn inside(&self, origin: DVec3, dir: DVec3) -> [Option<[f64; 2]>; 2] {
        let to_middle = origin - DVec3::new(0.0, 0.0, self.middle);
        let mut moved = -to_middle.dot(dir) / dir.length_squared();
        let mut p = origin + moved * dir;
        let a = self.profile.quadratic(dir);
        let mut b = self.profile.linear(p, dir);
        let to_vertex = -b / a;
        if to_vertex.abs() * dir.length() <= NEAR * self.reach {
            p += to_vertex * dir;
            moved += to_vertex;
            b = self.profile.linear(p, dir);
        }
        let c = self.profile.value(p);
        let all = Some([f64::NEG_INFINITY, f64::INFINITY]);
        if a == 0.0 {
            let root = moved - 0.5 * c / b;
            return if b > 0.0 {
                [Some([f64::NEG_INFINITY, root]), None]
            } else if b < 0.0 {
                [Some([root, f64::INFINITY]), None]
            } else {
                [all.filter(|_| c < 0.0), None]
            };
        }
        let discriminant = b * b - a * c;
        if discriminant <= 0.0 {
            return [all.filter(|_| a < 0.0), None];
        }
        let root = discriminant.sqrt();
        let q = -(b + root.copysign(b));
        // Zero has a sign, but the line has no side to choose there: both roots by one
        // formula, so that the reversed line gives the same bits.
        let (first, second) =
            if b == 0.0 { (-root / a, root / a) } else { (q / a, c / q) };
        let (first, second) = (moved + first, moved + second);
        let (first, second) = (first.min(second), first.max(second));
        if a > 0.0 {
            [Some([first, second]), None]
        } else {
            [Some([f64::NEG_INFINITY, first]), Some([second, f64::INFINITY])]
        }
    }
}

/// The vertex counts as near within this many times the reach of the solid. With a root
/// in reach and the vertex farther away than `NEAR` reaches, the other root is at least
/// 2 `NEAR` − 1 reaches away, so the discriminant keeps more than half of B².
const NEAR: f64 = 4.0;

impl Surface for Quadric {
    fn crossings(&self, line: &Line, sink: &mut Sink<'_>) {
        let (mut low, mut high) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
        if let Some(slab) = &self.slab {
            let stretch = slab.stretch(line);
            low = (stretch.enter, 1 + stretch.faces[0]);
            high = (stretch.exit, 1 + stretch.faces[1]);
        }
        if low.0 >= high.0 {
            return;
        }
        let origin = self.to_local.point(line.origin);
        let dir = self.to_local.direction(line.dir);
        for [enter, exit] in self.inside(origin, dir).into_iter().flatten() {
            let enter = if enter > low.0 { (enter, 0) } else { low };
            let exit = if exit < high.0 { (exit, 0) } else { high };
            sink.stretch(enter, exit);
        }
    }

    fn normal(&self, point: DVec3, face: u32) -> DVec3 {
        match &self.slab {
            Some(slab) if face > 0 => slab.outward(face - 1),
            _ => {
                let p = self.to_local.point(point);
                self.to_local.normal_to_world(self.profile.half_gradient(p))
            }
        }
    }

    fn faces(&self) -> u32 {
        if self.slab.is_some() { 3 } else { 1 }
    }
}

impl Profile {
    /// The heights between which there is anything, within two given ones.
    fn extent(&self, bottom: f64, top: f64) -> (f64, f64) {
        match *self {
            Self::Ball { radius } => (bottom.max(-radius), top.min(radius)),
            Self::Paraboloid { .. } => (bottom.max(0.0), top),
            Self::TwoSheets { vertex, .. } => (
                if bottom > -vertex { bottom.max(vertex) } else { bottom },
                if top < vertex { top.min(-vertex) } else { top },
            ),
            Self::Cylinder { .. } | Self::Cone { .. } | Self::OneSheet { .. } => {
                (bottom, top)
            }
        }
    }

    /// The radius at a height; zero where there is nothing.
    fn radius(&self, z: f64) -> f64 {
        match *self {
            Self::Cylinder { radius } => radius,
            Self::Cone { radius, slope } => (radius + slope * z).max(0.0),
            Self::Ball { .. }
            | Self::Paraboloid { .. }
            | Self::OneSheet { .. }
            | Self::TwoSheets { .. } => {
                let [a, b, c] = self.coefficients();
                (z * (a * z + 2.0 * b) + c).max(0.0).sqrt()
            }
        }
    }

    /// The largest radius between two heights: at an end, or at the equator of a ball.
    fn largest_radius(&self, bottom: f64, top: f64) -> f64 {
        match *self {
            Self::Ball { radius } if bottom <= 0.0 && top >= 0.0 => radius,
            Self::Ball { .. }
            | Self::Cylinder { .. }
            | Self::Cone { .. }
            | Self::Paraboloid { .. }
            | Self::OneSheet { .. }
            | Self::TwoSheets { .. } => self.radius(bottom).max(self.radius(top)),
        }
    }

    /// `x² + y² − ρ(z)` at a point, as a product where it is a difference of squares.
    fn value(&self, p: DVec3) -> f64 {
        let across = p.truncate().length();
        match *self {
            Self::Ball { radius } => difference_of_squares(p.length(), radius),
            Self::Cylinder { radius } => difference_of_squares(across, radius),
            Self::Cone { radius, slope } => {
                difference_of_squares(across, radius + slope * p.z)
            }
            Self::Paraboloid { scale } => across * across - scale * p.z,
            Self::OneSheet { waist, slope } => {
                difference_of_squares(across, waist.hypot(slope * p.z))
            }
            Self::TwoSheets { vertex, slope } => {
                difference_of_squares(across.hypot(slope * vertex), slope * p.z)
            }
        }
    }

    /// Half the gradient of [`Profile::value`].
    fn half_gradient(&self, p: DVec3) -> DVec3 {
        let z = match *self {
            Self::Ball { .. } => p.z,
            Self::Cylinder { .. } => 0.0,
            Self::Cone { radius, slope } => -slope * (radius + slope * p.z),
            Self::Paraboloid { scale } => -0.5 * scale,
            Self::OneSheet { slope, .. } | Self::TwoSheets { slope, .. } => {
                -slope * slope * p.z
            }
        };
        DVec3::new(p.x, p.y, z)
    }

    /// A: the quadratic coefficient along a direction.
    fn quadratic(&self, d: DVec3) -> f64 {
        match *self {
            Self::Ball { .. } => d.length_squared(),
            Self::Cylinder { .. } | Self::Paraboloid { .. } => {
                d.truncate().length_squared()
            }
            Self::Cone { slope, .. }
            | Self::OneSheet { slope, .. }
            | Self::TwoSheets { slope, .. } => {
                difference_of_squares(d.truncate().length(), slope * d.z)
            }
        }
    }

    /// B: half the derivative of the value along a direction.
    fn linear(&self, p: DVec3, d: DVec3) -> f64 {
        self.half_gradient(p).dot(d)
    }
}

/// `a² − b²` with a relative error of a few units for exact operands.
fn difference_of_squares(a: f64, b: f64) -> f64 {
    (a - b) * (a + b)
}
