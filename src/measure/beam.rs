//! Parallel rays through all of a box.

use glam::{DVec2, DVec3};

use crate::aabb::Aabb;
use crate::fan::{Fan, Linear};
use crate::lanes::whole;
use crate::scene::Bunch;

/// How many rays a bunch has on average. Rays near each other are traced together, and sums
/// are formed by bunches and added in their order; so this number is part of the answer's last
/// bits, and the number of threads is not.
const BUNCH: u64 = 192;

/// Parallel rays that cover a box, all but along one of its edges.
///
/// They lean a little. Models are full of faces and cylinders along the axes, and seen
/// exactly along one of them the length of a chord jumps at such a silhouette, which costs
/// a lattice a quarter of an order (error N^-3/4); seen at an angle it rises steadily.
pub(super) struct Beam {
    bounds: Aabb,
    /// The axes along and across the rays.
    axes: [usize; 3],
    /// The rays, at places from −½ to ½.
    pub(super) fan: Fan,
}

/// How far a ray leans on its way through the box, in widths of the box.
const LEAN: DVec2 = DVec2::new(0.31, 0.23);

impl Beam {
    /// All but along the longest edge.
    pub(super) fn new(bounds: Aabb) -> Self {
        Self::along(bounds, bounds.size().max_position())
    }

    /// All but along an axis.
    pub(super) fn along(bounds: Aabb, w: usize) -> Self {
        let size = bounds.size();
        let axes @ [_, u, v] = [w, (w + 1) % 3, (w + 2) % 3];
        // A ray advances by one along the axis for each step of its direction.
        let mut dir = DVec3::AXES[w];
        dir[u] = LEAN.x * size[u] / size[w];
        dir[v] = LEAN.y * size[v] / size[w];
        let origin = Linear {
            middle: bounds.center(),
            right: (1.0 + LEAN.x) * size[u] * DVec3::AXES[u],
            up: (1.0 + LEAN.y) * size[v] * DVec3::AXES[v],
        };
        Self { bounds, axes, fan: Fan { origin, dir: Linear::constant(dir) } }
    }

    /// The direction of the rays.
    pub(super) fn dir(&self) -> DVec3 {
        self.fan.dir.middle
    }

    /// The area that the rays cross at right angles to that edge: with room for those
    /// that lean into the box from the side.
    pub(super) fn area(&self) -> f64 {
        let [_, u, v] = self.axes;
        let (size, room) = (self.bounds.size(), DVec2::ONE + LEAN);
        size[u] * room.x * size[v] * room.y
    }

    /// How far the rays go through the box, in steps of their direction; so the volume is
    /// the mean chord in steps times the area.
    pub(super) fn depth(&self) -> f64 {
        self.bounds.size()[self.axes[0]]
    }

    /// How many columns and rows of bunches some rays make, about as wide as high.
    pub(super) fn grid(&self, rays: u64) -> [u64; 2] {
        let [_, u, v] = self.axes;
        let (size, bunches) = (self.bounds.size(), (rays / BUNCH).max(1) as f64);
        let aspect = (size[u] / size[v]).clamp(1.0 / bunches, bunches);
        let columns = (bunches * aspect).sqrt().round().max(1.0);
        let rows = (bunches / columns).round().max(1.0);
        [columns, rows].map(whole)
    }
}

/// Rays near each other, and which lattices they are of.
pub(super) struct Samples<'a> {
    /// The number of the stratum.
    pub(super) stratum: usize,
    pub(super) beam: &'a Beam,
    pub(super) bunch: Bunch<'a>,
    pub(super) replicates: &'a [u8],
}
