//! Polyhedra of curves that coincide are the same ones, however their leaves are turned.
//!
//! Two cylinders on one axis, with the same radius, may be turned about it against each other. Were
//! their polygons, too, the surfaces would pass through each other at every corner, and what is left of
//! their difference would be splinters. So corners start where the world says, not the leaf.

use glam::{DAffine3, DMat3, DVec3};

use crate::similar;

/// The map of a leaf about the z-axis, after a turn about that axis that brings what starts at +x to
/// the point of a circle that is farthest in a direction fixed in the world. Polygons of
/// this many segments are not turned by whole segments.
pub(super) fn circle(map: &DAffine3, segments: u32) -> DAffine3 {
    /// A direction will do that is not more than this part of the way along the axis, so that
    /// rounding seldom decides between two.
    const NEAR: f64 = 0.3;
    /// What is left of a segment by rounding is none.
    const NONE: f64 = 1e-6;
    // In a direction d the image of u is at `d · M u`, which is largest along `Mᵀ d`.
    let transposed = map.matrix3.transpose();
    let farthest = DVec3::AXES.map(|d| (transposed * d).truncate());
    let most = farthest.into_iter().map(|u| u.length()).fold(0.0, f64::max);
    let Some(start) = farthest.into_iter().find(|u| u.length() > NEAR * most) else {
        return *map;
    };
    let segment = std::f64::consts::TAU / f64::from(segments);
    let turn = start.to_angle().rem_euclid(segment);
    if turn < NONE * segment || turn > (1.0 - NONE) * segment {
        return *map;
    }
    *map * DAffine3::from_rotation_z(turn)
}

/// The map of a ball, without what turns it, if it keeps it a ball.
pub(super) fn ball(map: &DAffine3) -> DAffine3 {
    let Some(scale) = similar::exact_scale(&map.matrix3) else { return *map };
    let matrix3 = DMat3::from_diagonal(DVec3::splat(scale));
    DAffine3 { matrix3, translation: map.translation }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::round;

    /// Corners of the polygon of eight that a map makes, in an order of their own.
    fn corners(map: &DAffine3) -> Vec<DVec3> {
        let map = circle(map, 8);
        let mut corners: Vec<DVec3> = round::circle(8, 1.0)
            .into_iter()
            .map(|p| map.transform_point3(p.extend(0.0)))
            .collect();
        let along = DVec3::new(0.3, 0.5, 0.8);
        corners.sort_by(|a, b| a.dot(along).total_cmp(&b.dot(along)));
        corners
    }

    #[test]
    fn circles_have_the_same_corners_however_they_are_turned() {
        for place in [
            DMat3::IDENTITY,
            DMat3::from_rotation_y(0.7),
            DMat3::from_rotation_y(std::f64::consts::FRAC_PI_2),
            DMat3::from_diagonal(DVec3::new(1.0, 3.0, 1.0)) * DMat3::from_rotation_x(1.0),
        ] {
            let place = DAffine3::from_mat3_translation(place, DVec3::new(3.0, 4.0, 5.0));
            let expected = corners(&place);
            for i in 1..40 {
                let turn = DAffine3::from_rotation_z(0.17 * f64::from(i));
                let mirror = DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0));
                for map in [place * turn, place * turn * mirror] {
                    for (a, b) in corners(&map).iter().zip(&expected) {
                        assert!((a - b).abs().max_element() < 1e-14, "{i}: {a} {b}");
                    }
                }
            }
        }
    }

    #[test]
    fn circles_that_are_not_turned_stay_as_they_are() {
        for quarters in 0..4 {
            let angle = std::f64::consts::FRAC_PI_2 * f64::from(quarters);
            let map = DAffine3::from_rotation_z(angle);
            for segments in [8, 12, 28, 1000] {
                assert_eq!(circle(&map, segments), map);
            }
        }
        let turned =
            DAffine3::from_rotation_x(0.4) * DAffine3::from_scale(DVec3::splat(2.0));
        let mirrored = turned * DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        assert_eq!(ball(&turned).matrix3, ball(&mirrored).matrix3);
        let squashed = DAffine3::from_scale(DVec3::new(1.0, 2.0, 1.0));
        assert_eq!(ball(&squashed), squashed);
    }
}
