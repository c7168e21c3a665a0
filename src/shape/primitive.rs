//! The primitives, as their makers describe them: sizes, no place.

use glam::DVec3;

/// A solid given by a formula, in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Primitive {
    /// The points with `min ≤ p ≤ max` on every axis.
    Cuboid {
        /// The corner with the smallest coordinates.
        min: DVec3,
        /// The corner with the largest coordinates.
        max: DVec3,
    },
    /// A solid of revolution about the z-axis, `x² + y² ≤ ρ(z)`, cut at two heights.
    Quadric {
        /// Which ρ.
        profile: Profile,
        /// The smallest z.
        bottom: f64,
        /// The largest z.
        top: f64,
    },
    /// The points with `normal · p ≤ offset`: unbounded, so of use inside an
    /// intersection or as what is subtracted.
    HalfSpace {
        /// The direction out of the solid, of any length.
        normal: DVec3,
        /// `normal · p` on the plane.
        offset: f64,
    },
}

/// The squared radius ρ as a function of height, for each family of quadrics.
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

/// A parameter out of its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BadParameter {
    /// Its name.
    pub parameter: &'static str,
    /// Its value.
    pub value: f64,
}

impl Primitive {
    /// What the primitive is called in reports.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Cuboid { .. } => "cuboid",
            Self::HalfSpace { .. } => "half-space",
            Self::Quadric { profile, .. } => profile.name(),
        }
    }

    /// Whether the sizes make a solid.
    ///
    /// # Errors
    ///
    /// The first parameter that is not finite or not in its range.
    pub fn check(&self) -> Result<(), BadParameter> {
        match *self {
            Self::Cuboid { min, max } => {
                for (parameter, (lo, hi)) in [
                    ("width", (min.x, max.x)),
                    ("depth", (min.y, max.y)),
                    ("height", (min.z, max.z)),
                ] {
                    positive(parameter, hi - lo)?;
                }
                Ok(())
            }
            Self::HalfSpace { normal, offset } => {
                finite("offset", offset)?;
                positive("length of the normal", normal.length())
            }
            Self::Quadric { profile, bottom, top } => {
                finite("bottom", bottom)?;
                finite("top", top)?;
                size("height", top - bottom)?;
                profile.check(bottom, top)
            }
        }
    }
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

    fn check(&self, bottom: f64, top: f64) -> Result<(), BadParameter> {
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
}

fn finite(parameter: &'static str, value: f64) -> Result<(), BadParameter> {
    if value.is_finite() { Ok(()) } else { Err(BadParameter { parameter, value }) }
}

/// The smallest and the largest size of a quadric: their squares are numbers still.
const SIZES: std::ops::RangeInclusive<f64> = 1e-140..=1e140;

/// A size of a quadric.
fn size(parameter: &'static str, value: f64) -> Result<(), BadParameter> {
    if SIZES.contains(&value) { Ok(()) } else { Err(BadParameter { parameter, value }) }
}

fn positive(parameter: &'static str, value: f64) -> Result<(), BadParameter> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(BadParameter { parameter, value })
    }
}

fn not_negative(parameter: &'static str, value: f64) -> Result<(), BadParameter> {
    if value.is_finite() && value >= 0.0 {
        Ok(())
    } else {
        Err(BadParameter { parameter, value })
    }
}
