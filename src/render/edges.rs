//! Where lines are drawn: at outlines, at steps in depth, and where a surface turns.
//!
//! That a leaf or a face ends somewhere is no reason for a line: flush faces, the triangles of a mesh
//! and the pieces of a rounded box pass into each other without one. What counts is what is seen.

use glam::DVec3;

use super::Frame;
use crate::ray::{Crossing, Sense};
use crate::scene::Scene;

/// The cosine of the angle by which a surface turns at a line: 20°, less than the 22.5° between the
/// faces of a prism with 16 sides.
const SHARP: f64 = 0.94;

/// Steps in depth begin at so many widths of a pixel.
const STEP: f64 = 2.0;

/// Whether a pixel is on an edge. Where something is behind it the nearer pixel is; where a surface
/// turns, the one on the left or above.
pub(super) fn is_edge(scene: &Scene, frame: &Frame, [x, y]: [u32; 2]) -> bool {
    let Some(here) = Patch::new(scene, frame, x, y) else { return false };
    let [width, height] = frame.size();
    let beside = [(x + 1, y), (x, y + 1), (x.wrapping_sub(1), y), (x, y.wrapping_sub(1))];
    beside.into_iter().enumerate().any(|(i, (x, y))| {
        if x >= width || y >= height {
            return false;
        }
        let Some(there) = Patch::new(scene, frame, x, y) else { return true };
        let is_step = here.is_before(&there, frame);
        let turns = here.normal.dot(there.normal) < SHARP;
        let recolors = here.color(scene) != there.color(scene);
        is_step || (i < 2 && (turns || recolors) && !there.is_before(&here, frame))
    })
}

/// What is seen in a pixel.
struct Patch {
    hit: Crossing,
    dir: DVec3,
    point: DVec3,
    /// On the side that is seen.
    normal: DVec3,
}

impl Patch {
    fn new(scene: &Scene, frame: &Frame, x: u32, y: u32) -> Option<Self> {
        let hit = frame.hit(x, y)?;
        let ray = frame.ray(x, y);
        let normal = scene.normal_at(&ray, &hit);
        let normal = match hit.sense {
            Sense::Enter => normal,
            Sense::Exit => -normal,
        };
        Some(Self { hit, dir: ray.dir, point: ray.at(hit.t), normal })
    }

    fn color(&self, scene: &Scene) -> Option<[u32; 4]> {
        scene.leaf(self.hit.leaf).part.key().1
    }

    /// Whether another patch begins behind the end of this one: neither lies in the plane of the
    /// other.
    fn is_before(&self, other: &Self, frame: &Frame) -> bool {
        let apart = other.point - self.point;
        let along = |patch: &Self| {
            let slope = patch.normal.dot(patch.dir);
            // How far it is, along the line of sight, to the plane of the patch.
            patch.normal.dot(apart) / slope
        };
        let step = STEP * frame.view().footprint(self.hit.t);
        let [a, b] = [along(self), along(other)];
        // Planes along the line of sight are as far as one likes.
        a > step && b > step
    }
}
