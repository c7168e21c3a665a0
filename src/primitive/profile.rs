//! The quadrics of revolution.

use super::BadParameter;
use super::parameter::{finite, not_negative, positive, size};
use crate::rounded::Rounded;

/// The squared radius ρ as a function of height, for each family of quadrics
/// of revolution: there are no others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Profile {
    /// `ρ = radius² − z²`
    Ball {
        /// The radius of the ball.
        radius: f64,
    },
    /// `ρ = radius²`
    Cylinder {
        /// The radius of the cylinder.
        radius: f64,
    },
    /// `ρ = (radius + slope · z)²`: a cone with its apex where this is zero.
    Cone {
        /// The radius at z = 0.
        radius: f64,
        /// How much the radius grows per unit of height.
        slope: f64,
    },
    /// `ρ = scale · z`
    Paraboloid {
        /// Squared radius per height.
        scale: f64,
    },
    /// `ρ = waist² + (slope · z)²`: a hyperboloid of one sheet.
    OneSheet {
        /// The radius at z = 0, the smallest.
        waist: f64,
        /// The slope of the asymptotic cone.
        slope: f64,
    },
    /// `ρ = slope² · (z² − vertex²)`: a hyperboloid of two sheets.
    TwoSheets {
        /// The height of the upper vertex.
        vertex: f64,
        /// The slope of the asymptotic cone.
        slope: f64,
    },
}

impl Profile {
    /// What the quadric is called in reports.
    pub(crate) const fn name(&self) -> &'static str {
        match self {
            Self::Ball { .. } => "ball",
            Self::Cylinder { .. } => "cylinder",
            Self::Cone { .. } => "cone",
            Self::Paraboloid { .. } => "paraboloid",
            Self::OneSheet { .. } => "hyperboloid of one sheet",
            Self::TwoSheets { .. } => "hyperboloid of two sheets",
        }
    }

    /// ρ as the polynomial `a z² + 2 b z + c`: its `[a, b, c]`.
    pub(crate) fn coefficients(&self) -> [f64; 3] {
        match *self {
            Self::Ball { radius } => [-1.0, 0.0, radius * radius],
            Self::Cylinder { radius } => [0.0, 0.0, radius * radius],
            Self::Cone { radius, slope } => {
                [slope * slope, radius * slope, radius * radius]
            }
            Self::Paraboloid { scale } => [0.0, 0.5 * scale, 0.0],
            Self::OneSheet { waist, slope } => [slope * slope, 0.0, waist * waist],
            Self::TwoSheets { vertex, slope } => {
                [slope * slope, 0.0, -(slope * vertex) * (slope * vertex)]
            }
        }
    }

    /// The same solid in units of `unit`.
    pub(crate) fn in_units_of(&self, unit: f64) -> Self {
        match *self {
            Self::Ball { radius } => Self::Ball { radius: radius / unit },
            Self::Cylinder { radius } => Self::Cylinder { radius: radius / unit },
            Self::Cone { radius, slope } => Self::Cone { radius: radius / unit, slope },
            Self::Paraboloid { scale } => Self::Paraboloid { scale: scale / unit },
            Self::OneSheet { waist, slope } => {
                Self::OneSheet { waist: waist / unit, slope }
            }
            Self::TwoSheets { vertex, slope } => {
                Self::TwoSheets { vertex: vertex / unit, slope }
            }
        }
    }

    pub(super) fn check(&self, bottom: f64, top: f64) -> Result<(), BadParameter> {
        match *self {
            Self::Ball { radius } | Self::Cylinder { radius } => size("radius", radius),
            Self::Cone { radius, slope } => {
                finite("slope", slope)?;
                let (a, b) = (radius + slope * bottom, radius + slope * top);
                not_negative("bottom radius", a)?;
                not_negative("top radius", b)?;
                size("larger radius", a.max(b))
            }
            Self::Paraboloid { scale } => size("scale", scale),
            Self::OneSheet { waist, slope } => {
                size("waist", waist)?;
                not_negative("slope", slope)
            }
            Self::TwoSheets { vertex, slope } => {
                size("vertex", vertex)?;
                size("slope", slope)?;
                positive("height beyond the vertex", top.abs().max(bottom.abs()) - vertex)
            }
        }
    }

    /// The heights between which there is anything, within two given ones.
    pub(crate) fn extent(&self, bottom: f64, top: f64) -> [f64; 2] {
        match *self {
            Self::Ball { radius } => [bottom.max(-radius), top.min(radius)],
            Self::Paraboloid { .. } => [bottom.max(0.0), top],
            Self::TwoSheets { vertex, .. } => [
                if bottom > -vertex { bottom.max(vertex) } else { bottom },
                if top < vertex { top.min(-vertex) } else { top },
            ],
            Self::Cylinder { .. } | Self::Cone { .. } | Self::OneSheet { .. } => {
                [bottom, top]
            }
        }
    }

    /// The radius at a height; zero where there is nothing.
    pub(crate) fn radius(&self, z: f64) -> f64 {
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
    pub(crate) fn largest_radius(&self, [bottom, top]: [f64; 2]) -> f64 {
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

    /// Whether a line can come out of it twice.
    pub(crate) const fn can_be_left_twice(&self) -> bool {
        match self {
            Self::Ball { .. } | Self::Cylinder { .. } | Self::Paraboloid { .. } => false,
            Self::Cone { .. } | Self::OneSheet { .. } | Self::TwoSheets { .. } => true,
        }
    }

    /// The integral of the squared radius ρ over the height.
    ///
    /// Each ρ is a product of two functions linear in z, of one sign each where the solid is, so
    /// that nothing cancels; that of one sheet is a square and such a product.
    pub(super) fn squares(&self, bottom: f64, top: f64) -> Rounded {
        let at = Rounded::exact;
        let between =
            |bottom: f64, top: f64, factors: &dyn Fn(Rounded) -> [Rounded; 2]| {
                if bottom < top {
                    product(at(bottom), at(top), factors)
                } else {
                    Rounded::ZERO
                }
            };
        match *self {
            Self::Ball { radius } => {
                let r = at(radius);
                between(bottom.max(-radius), top.min(radius), &|z| [r - z, r + z])
            }
            Self::Cylinder { radius } => between(bottom, top, &|_| [at(radius); 2]),
            Self::Cone { radius, slope } => {
                // The makers of frusta round heights and slopes.
                let (r, slope) = (at(radius), Rounded::nearly(slope));
                let [bottom, top] = [bottom, top].map(Rounded::nearly);
                product(bottom, top, &|z| [r + slope * z; 2])
            }
            Self::Paraboloid { scale } => {
                between(bottom.max(0.0), top, &|z| [Rounded::nearly(scale), z])
            }
            Self::OneSheet { waist, slope } => {
                let slope = Rounded::nearly(slope);
                between(bottom, top, &|_| [at(waist); 2])
                    + between(bottom, top, &|z| [slope * z; 2])
            }
            Self::TwoSheets { vertex, slope } => {
                let (slope, v) = (at(slope), at(vertex));
                let factors = |z| [slope * (z - v), slope * (z + v)];
                between(bottom, top.min(-vertex), &factors)
                    + between(bottom.max(vertex), top, &factors)
            }
        }
    }
}

/// The integral of the product of two linear functions between two heights.
fn product(
    bottom: Rounded,
    top: Rounded,
    factors: &dyn Fn(Rounded) -> [Rounded; 2],
) -> Rounded {
    let ([a, b], [c, d]) = (factors(bottom), factors(top));
    let (ends, across) = (a * b + c * d, a * d + b * c);
    (top - bottom) * Rounded::SIXTH * (ends + ends + across)
}
