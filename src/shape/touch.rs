//! Whether the surface of a mesh may touch a box.

use glam::DVec3;

use super::Polyhedron;
use super::doubt::U;
use super::region::Region;
use crate::aabb::Aabb;

impl Polyhedron {
    /// Whether any triangle may touch a region, as seen in the mesh's own frame: its box does
    /// and its plane passes it. Surfaces lie no farther than `pad` beside the true ones.
    pub(crate) fn touches(&self, region: &Region, pad: f64) -> bool {
        let (center, along, breadth) = region.seen_from(&self.to_local);
        let room = self.to_local.linear.abs() * DVec3::splat(pad);
        let breadth = breadth + room;
        let reach = along.abs() + breadth;
        let place = Aabb::new(center - reach, center + reach);
        let indexed = self.indexed();
        let mut touches = false;
        indexed.faces.around(&place, |pack| {
            touches = touches
                || self.pack(pack).faces().any(|face| {
                    let corners = indexed.mesh.corners(face as usize);
                    let around = Aabb::around(corners);
                    !around.intersection(place).is_empty()
                        && passes(corners, center, along, breadth)
                });
        });
        touches
    }
}

/// Whether the plane of a triangle may pass a region.
fn passes([a, b, c]: [DVec3; 3], center: DVec3, along: DVec3, breadth: DVec3) -> bool {
    let (ab, ac, away) = (b - a, c - a, center - a);
    let normal = ab.cross(ac);
    let reach = normal.dot(along).abs() + normal.abs().dot(breadth);
    // The normal is rounded by a few units of the product of two edges.
    let far = away.length() + along.length() + breadth.length();
    let rounding = 64.0 * U * ab.length() * ac.length() * far;
    let is_beside = normal.dot(away).abs() > reach + rounding;
    !is_beside
}
