//! Circles, cylinders and spheres: true curves or polygons.

use std::f64::consts::PI;
use std::sync::Arc;

use super::super::error::{Located, ReadErrorKind};
pub(super) use super::super::fineness::Fineness;
use super::super::options::Curves;
use super::super::outline::{Outline, Shape};
use super::arguments::Call;
use super::evaluate::Reading;
use crate::mesh::{Mesh, round};
use crate::solid::Solid;

/// A faceted curve with all its sizes: equal ones share one mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Key {
    segments: u32,
    sizes: [u64; 4],
}

/// The sizes of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) enum Round {
    /// A sphere around the origin.
    Ball { radius: f64 },
    /// A cylinder or cone about the z-axis: radii and heights at bottom and top.
    Frustum { radii: [f64; 2], heights: [f64; 2] },
}

/// The circle as the options ask for it.
pub(super) fn circle(
    radius: f64,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Outline, Located> {
    let Some(segments) = segments(radius, call, reading)? else {
        return Ok(Outline::shape(Shape::Circle { radius }));
    };
    reading.count_facets(round::frustum_triangles(segments), call.place())?;
    Ok(Outline::paths(vec![round::circle(segments, radius)]))
}

/// `$fn`, `$fa` and `$fs`.
pub(super) fn fineness(call: &Call<'_>) -> Result<Fineness, Located> {
    Ok(Fineness {
        count: call.number("$fn")?.unwrap_or(0.0),
        angle: call.number("$fa")?.unwrap_or(12.0),
        size: call.number("$fs")?.unwrap_or(2.0),
    })
}

/// The segments of a circle that stands for a true one where there is no exact solid: polygons of
/// the same area are nowhere farther from it than the tolerance, and never coarse.
pub(super) fn fine(radius: f64, tolerance: f64, reading: &Reading<'_>) -> u32 {
    /// The fewest and the most segments.
    const FEWEST: f64 = 48.0;
    const MOST: f64 = 1440.0;
    reading.is_fine.set(true);
    let half = (1.0 - (tolerance / radius).min(1.0)).acos();
    // Multiples of four have corners on the axes.
    let quarters = (0.25 * (PI / half).clamp(FEWEST, MOST)).ceil();
    part(4, quarters)
}

/// A number of segments times a factor, at least one; fractions are cut off.
pub(super) fn part(segments: u32, factor: f64) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "conversion saturates, and what is too large is refused later"
    )]
    let part = (f64::from(segments) * factor) as u32;
    part.max(1)
}

/// The segments of a curve that the options make a polygon, and counts it.
pub(super) fn segments(
    radius: f64,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Option<u32>, Located> {
    let fineness = fineness(call)?;
    let segments = match reading.options.curves {
        Curves::Exact => None,
        Curves::Auto => fineness.polygon(radius),
        Curves::Faceted => Some(fineness.segments(radius)),
    };
    let counts = &mut reading.model.counts;
    match (segments, reading.options.curves) {
        (None, _) => counts.curves += 1,
        (Some(_), Curves::Faceted) => counts.faceted += 1,
        (Some(_), Curves::Auto | Curves::Exact) => counts.polygons += 1,
    }
    Ok(segments)
}

impl Round {
    /// The curve as the options ask for it.
    pub(super) fn solid(
        self,
        call: &Call<'_>,
        reading: &mut Reading<'_>,
    ) -> Result<Solid, Located> {
        let solid = match (segments(self.radius(), call, reading)?, self) {
            (None, _) => self.curve(),
            // As a mesh, where the very triangles are wanted.
            (Some(sides), Self::Frustum { radii, heights })
                if reading.options.curves != Curves::Faceted =>
            {
                Solid::prism_between(sides, radii, heights)
            }
            (Some(segments), _) => Solid::mesh(self.mesh(segments, call, reading)?),
        };
        Ok(solid.placed(call.place()))
    }

    fn radius(self) -> f64 {
        match self {
            Self::Ball { radius } => radius,
            Self::Frustum { radii, .. } => radii[0].max(radii[1]),
        }
    }

    fn curve(self) -> Solid {
        match self {
            Self::Ball { radius } => Solid::ball(radius),
            Self::Frustum { radii: [a, b], heights: [low, high] } => {
                Solid::frustum_between(a, b, low, high)
            }
        }
    }

    fn mesh(
        self,
        segments: u32,
        call: &Call<'_>,
        reading: &mut Reading<'_>,
    ) -> Result<Arc<Mesh>, Located> {
        let (sizes, triangles) = match self {
            // No frustum has its bottom above its top.
            Self::Ball { radius } => {
                ([radius, radius, 1.0, -1.0], round::ball_triangles(segments))
            }
            Self::Frustum { radii: [a, b], heights: [low, high] } => {
                ([a, b, low, high], round::frustum_triangles(segments))
            }
        };
        let key = Key { segments, sizes: sizes.map(f64::to_bits) };
        if let Some(mesh) = reading.curves.get(&key) {
            return Ok(mesh.clone());
        }
        reading.count_facets(triangles, call.place())?;
        let fault = |kind| Located::at(call.place(), kind);
        let mesh = match self {
            Self::Ball { radius } => round::ball(segments, radius),
            Self::Frustum { radii, heights } => round::frustum(segments, radii, heights),
        };
        let mesh = Arc::new(mesh.map_err(|e| fault(ReadErrorKind::Mesh(e)))?);
        reading.curves.insert(key, mesh.clone());
        Ok(mesh)
    }
}
