//! The surface of a solid as one mesh whose facets are near its curves.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

use super::parts::reach;
use super::{Faceted, FacetsError, Fine, boundary, of_meshes};
use crate::mesh::Mesh;
use crate::progress::Watch;
use crate::solid::Solid;

/// The surface of a solid, as one closed mesh; `None` of a solid that is empty.
///
/// Balls, cylinders and cones become polyhedra of the same volume that are nowhere farther
/// from them than `tolerance`, in the units of the solid as a whole however its leaves are
/// scaled. Where two surfaces meet at a small angle, the edge between them can be farther from where
/// it was: [`measure::apart`](crate::measure::apart()) looks for that.
///
/// Leaves have at most `most_triangles` together, and so has what goes into each Boolean
/// operation. `watch` is told how many these are, before it begins, and can stop the work
/// there.
///
/// What occurs more than once in the tree is made as often: compile the solid first, which
/// limits its nodes.
///
/// # Errors
///
/// If a leaf has no facets (a paraboloid, say), a mesh is not a manifold, half-spaces go farther
/// than all that has bounds by itself, there would be too many triangles, or it was stopped.
pub fn surface(
    solid: &Solid,
    tolerance: f64,
    most_triangles: u64,
    watch: Watch<'_>,
) -> Result<Option<Mesh>, FacetsError> {
    if tolerance.is_nan() || tolerance <= 0.0 {
        return Err(FacetsError::BadTolerance(tolerance));
    }
    let circle = |radius: f64| segments(OF_CIRCLE * tolerance / radius);
    let ball = |radius: f64| segments(OF_BALL * tolerance / radius);
    let fine = Fine { circle: &circle, ball: &ball, most_triangles };
    let faceted = Faceted { solid: of_meshes(solid, &fine)?, curves: 0, triangles: 0 };
    let largest = AtomicU64::new(0);
    let limited = |triangles| {
        largest.fetch_max(triangles, Ordering::Relaxed);
        if triangles > most_triangles { ControlFlow::Break(()) } else { watch(triangles) }
    };
    let surface = boundary(&faceted, &limited);
    let (count, limit) = (largest.into_inner(), most_triangles);
    if count > limit {
        return Err(FacetsError::TooMany { count, limit });
    }
    let surface = surface?;
    // Half-spaces are cut off at four times the reach, and facets go little beyond it.
    let farthest = 2.0 * reach(solid);
    let is_cut_off = |mesh: &Mesh| mesh.points().iter().any(|p| p.length() >= farthest);
    if surface.as_ref().is_some_and(is_cut_off) {
        Err(FacetsError::Unbounded)
    } else {
        Ok(surface)
    }
}

/// A polygon of the same area as a circle is off by a third of tan² h of the radius at most, h
/// half the angle of a segment: by h²/3 in its corners, and half of that in the middle of its
/// sides.
const OF_CIRCLE: f64 = 3.0;

/// The same of a polyhedron of the same volume as a ball: four corners of it with sides of 2 h
/// are h² above what is between them, of which volume takes 5/9.
const OF_BALL: f64 = 1.8;

/// The segments for which tan² h is at most so much.
///
/// Curves of nearly the same size often share an edge. So numbers are four times 2 to 4 times
/// a power of two, and there are few of them; multiples of four have corners on the axes.
fn segments(square: f64) -> u32 {
    /// As many, however large the tolerance is.
    const FEWEST: f64 = 8.0;
    /// More than there can be.
    const MOST: f64 = (1_u64 << 32) as f64;
    let least = (PI / square.sqrt().atan()).clamp(FEWEST, MOST);
    let power = (0.125 * least).log2().floor().exp2();
    let quarters = (0.25 * least / power * 2.0).ceil() * 0.5 * power;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "conversion saturates, and what is too large is refused later"
    )]
    let segments = (4.0 * quarters.ceil()) as u32;
    segments
}

#[cfg(test)]
mod tests {
    use super::super::parts::{ball, with_area};
    use super::*;

    /// What counts for distances is the corners and the planes of the faces.
    #[test]
    fn polyhedra_are_as_near_as_is_said() {
        for exponent in 1..=40 {
            let tolerance = 0.5_f64.powf(0.3 * f64::from(exponent));
            let n = segments(OF_CIRCLE * tolerance);
            let (corner, half) = (with_area(n), PI / f64::from(n));
            let off = (corner - 1.0).max(1.0 - corner * half.cos());
            assert!(off <= tolerance, "{n} segments for {tolerance}, off by {off}");

            let n = segments(OF_BALL * tolerance);
            let mesh = ball(n, 1.0).expect("a ball");
            let highest = mesh.points().iter().fold(0.0_f64, |m, p| m.max(p.length()));
            let lowest = (0..mesh.faces().len()).fold(1.0_f64, |least, face| {
                let [a, b, c] = mesh.corners(face);
                least.min((b - a).cross(c - a).normalize().dot(a))
            });
            let off = (highest - 1.0).max(1.0 - lowest);
            assert!(off <= tolerance, "{n} segments for {tolerance}, off by {off}");
            assert!(n <= 8 || off > 0.3 * tolerance, "{n} are too many for {tolerance}");
        }
    }

    #[test]
    fn segments_are_multiples_of_four_and_few_numbers() {
        let numbers: std::collections::BTreeSet<u32> =
            (1..2000).map(|i| segments(0.01 * 0.995_f64.powi(i))).collect();
        assert!(numbers.iter().all(|n| n % 4 == 0), "{numbers:?}");
        assert!(numbers.len() < 60, "{numbers:?}");
        assert_eq!(segments(f64::INFINITY), 8);
        assert_eq!(segments(0.0), u32::MAX);
    }
}
