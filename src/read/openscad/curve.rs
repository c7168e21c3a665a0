//! Circles, cylinders and spheres: true curves or polygons.

use std::sync::Arc;

use super::super::error::{Located, ReadErrorKind};
use super::super::fineness::Fineness;
use super::super::options::Curves;
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

impl Round {
    /// The curve as the options ask for it.
    pub(super) fn solid(
        self,
        call: &Call<'_>,
        reading: &mut Reading<'_>,
    ) -> Result<Solid, Located> {
        let fineness = Fineness {
            count: call.number("$fn")?.unwrap_or(0.0),
            angle: call.number("$fa")?.unwrap_or(12.0),
            size: call.number("$fs")?.unwrap_or(2.0),
        };
        let segments = match reading.options.curves {
            Curves::Exact => None,
            Curves::Auto => fineness.polygon(self.radius()),
            Curves::Faceted => Some(fineness.segments(self.radius())),
        };
        let counts = &mut reading.model.counts;
        match (segments, reading.options.curves) {
            (None, _) => counts.curves += 1,
            (Some(_), Curves::Faceted) => counts.faceted += 1,
            (Some(_), Curves::Auto | Curves::Exact) => counts.polygons += 1,
        }
        let solid = match segments {
            None => self.curve(),
            Some(segments) => Solid::mesh(self.mesh(segments, call, reading)?),
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
