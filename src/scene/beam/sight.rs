//! Where in space rays of a fan are.

use glam::DVec3;

use crate::fan::Fan;
use crate::scene::Scene;
use crate::shape::{Region, inverse_power_of_two};

/// How rays of a fan pass the solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight<'a> {
    fan: &'a Fan,
    /// Between which `t` of all its rays the solid is.
    pub(super) depth: [f64; 2],
    /// No coordinate is larger.
    pub(super) reach: f64,
}

impl<'a> Sight<'a> {
    /// Of the rays of a fan between two places.
    pub(super) fn new(fan: &'a Fan, corners: [[f64; 2]; 2], scene: &Scene) -> Self {
        let steps = if fan.is_parallel() { &fan.origin } else { &fan.dir };
        // Its length does not matter, and the product of three lengths need not be a number.
        let level = |v: DVec3| v * inverse_power_of_two(v.abs().max_element());
        let across = level(steps.right).cross(level(steps.up));
        let axis = across / across.dot(fan.dir.middle);
        let bounds = &scene.stage.bounds;
        let depths =
            bounds.corners().map(|corner| (corner - fan.origin.middle).dot(axis));
        let near = depths.into_iter().fold(f64::INFINITY, f64::min);
        let far = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
        // Crossings are a little beside the bounds where rounding has put them there.
        let room = 1e-6 * (far - near) + 16.0 * scene.worst_slack * axis.length();
        let depth = [near - room, far + room];
        let all = scene.hierarchy.bounds();
        let largest = |v: DVec3| v.abs().max_element();
        let longest = near.abs().max(far.abs()) + room;
        let widest = corners.map(|[right, up]| {
            fan.origin.largest(right, up) + longest * fan.dir.largest(right, up)
        });
        let reach = largest(all.min).max(largest(all.max)) + widest[0].max(widest[1]);
        Self { fan, depth, reach }
    }

    /// The rays between two places of the fan and two depths, and some more.
    pub(super) fn region(&self, corners: [[f64; 2]; 2], depth: [f64; 2]) -> Region {
        let Fan { origin, dir } = self.fan;
        let ([a, b], [near, far]) = (corners, depth);
        let [right, up] = [0, 1].map(|axis| 0.5 * (a[axis] + b[axis]));
        let [middle, half] = [0.5 * (near + far), 0.5 * (far - near)];
        let forward = dir.at(right, up);
        let center = origin.at(right, up) + middle * forward;
        let side = |steps: f64, o: DVec3, d: DVec3| {
            let [p, q] = depth.map(|t| 0.5 * steps * (o + t * d));
            if p.length_squared() > q.length_squared() { p } else { q }
        };
        let sides = [
            side(b[0] - a[0], origin.right, dir.right),
            side(b[1] - a[1], origin.up, dir.up),
        ];
        Region::new(center, half * forward, sides, self.reach)
    }
}
