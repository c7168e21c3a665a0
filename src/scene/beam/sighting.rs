//! How a mesh is seen by the rays of a fan.
//!
//! In the plane in which the rays are points, faces are triangles.

use glam::{DMat3, DVec2, DVec3};

use super::tile::{SIDE, Tile};
use crate::eight::EIGHT;
use crate::fan::Fan;
use crate::shape::{Linear, Polyhedron, View, inverse};

/// Places and maps are off by less than this part of the largest coordinate at hand, 2⁻⁴⁰,
/// which is 8192 u: more than all roundings of lines, maps and shears together.
const OFF: f64 = 1.0 / 1_099_511_627_776.0;

/// How many vectors of numbers go along the side of a tile.
pub(super) const PARTS: usize = SIDE as usize / EIGHT;

/// The rays of a tile as points of a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// How far to the right the rays of each column are, from −1 to 1; beyond the last
    /// column it is far away.
    pub(super) columns: [[f32; EIGHT]; PARTS],
    /// The same upward.
    pub(super) rows: [[f32; EIGHT]; PARTS],
    center: DVec2,
    half: DVec2,
}

impl Grid {
    #[expect(clippy::cast_possible_truncation, reason = "there is room for rounding")]
    pub(super) fn new(tile: &Tile<'_>) -> Self {
        let [width, height] = tile.size;
        let (first, last) = ((tile.at)(0, 0), (tile.at)(width - 1, height - 1));
        let [a, b] = [first, last].map(DVec2::from_array);
        let center = 0.5 * (a + b);
        // One ray alone is a point; a part of a millionth is enough to divide by.
        let half = (0.5 * (b - a)).abs().max(1e-6 * (center.abs() + 1e-6));
        let far = [[1e30; EIGHT]; PARTS];
        let mut grid = Self { columns: far, rows: far, center, half };
        for i in 0..width {
            let place = ((tile.at)(i, 0)[0] - center.x) / half.x;
            grid.columns[i / EIGHT][i % EIGHT] = place as f32;
        }
        for j in 0..height {
            let place = ((tile.at)(0, j)[1] - center.y) / half.y;
            grid.rows[j / EIGHT][j % EIGHT] = place as f32;
        }
        grid
    }
}

/// How a mesh is seen by a fan.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sighting {
    /// Takes a point of the mesh, seen from the middle of the fan's origins, to the place on the
    /// ray through it and, for rays that run apart times this place, to the ray's place in the fan.
    to_fan: DMat3,
    origin: DVec3,
    is_parallel: bool,
    /// Between which places on the rays the mesh is.
    depth: [f64; 2],
    /// What a step by the rounding of places does to each number that `to_fan` makes.
    off: DVec3,
}

impl Sighting {
    /// Nothing if there is no map, or rays start within the mesh's box or behind it and run
    /// apart. No coordinate of a ray is larger than `reach`.
    pub(super) fn new(
        mesh: &Polyhedron,
        fan: &Fan,
        grid: &Grid,
        reach: f64,
    ) -> Option<Self> {
        let to_local = &mesh.to_local;
        let is_parallel = fan.is_parallel();
        let steps = if is_parallel { &fan.origin } else { &fan.dir };
        let from_fan = DMat3::from_cols(
            to_local.direction(fan.dir.middle),
            to_local.direction(steps.right),
            to_local.direction(steps.up),
        );
        let to_fan = inverse(&from_fan)?;
        let origin = to_local.point(fan.origin.middle);
        let bounds = mesh.local_bounds();
        let largest = |v: DVec3| v.abs().max_element();
        let far = (to_local.linear.abs()
            * DVec3::splat(reach + largest(to_local.origin)))
        .max_element()
            + largest(bounds.min).max(largest(bounds.max));
        let off = to_fan.abs() * DVec3::splat(OFF * far);
        let depths = bounds.corners().map(|corner| (to_fan * (corner - origin)).x);
        let near = depths.into_iter().fold(f64::INFINITY, f64::min) - off.x;
        let far = depths.into_iter().fold(f64::NEG_INFINITY, f64::max) + off.x;
        // How far the inverse is from being one, in the units of its rows and columns.
        let residual = (to_fan * from_fan - DMat3::IDENTITY).abs();
        let widest = grid.center.abs() + grid.half;
        let widest = if is_parallel { widest } else { far.abs() * widest };
        let off = off + residual * DVec3::new(far.abs() + near.abs(), widest.x, widest.y);
        let is_seen = is_parallel || near > 1e-3 * far;
        let depth = [near, far];
        let sighting = Self { to_fan, origin, is_parallel, depth, off };
        (is_seen && off.is_finite()).then_some(sighting)
    }

    /// Between which places on the rays the mesh is.
    pub(super) fn depth(&self) -> [f64; 2] {
        self.depth
    }

    /// The planes beyond which there are no rays of a tile.
    pub(super) fn sides(&self, mesh: &Polyhedron, grid: &Grid) -> [Linear; 4] {
        let rows = self.to_fan.transpose();
        let sides = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)];
        sides.map(|(axis, sign)| {
            let row = [rows.y_axis, rows.z_axis][axis];
            let off = [self.off.y, self.off.z][axis];
            let border = grid.center[axis] + sign * 1.000_001 * grid.half[axis];
            if self.is_parallel {
                mesh.linear(sign * row, self.origin, -sign * border, off)
            } else {
                let weights = sign * (row - border * rows.x_axis);
                let off = off + border.abs() * self.off.x;
                mesh.linear(weights, self.origin, 0.0, off)
            }
        })
    }

    /// The place on a ray.
    pub(super) fn depths(&self, mesh: &Polyhedron) -> Linear {
        let row = self.to_fan.transpose().x_axis;
        mesh.linear(row, self.origin, 0.0, 4.0 * self.off.x)
    }

    /// How far to the right and how far up points are seen in a grid; times the place on the
    /// ray for rays that run apart.
    fn across(&self, mesh: &Polyhedron, grid: &Grid) -> [Linear; 2] {
        let rows = self.to_fan.transpose();
        [0, 1].map(|axis| {
            let row = [rows.y_axis, rows.z_axis][axis];
            let off = [self.off.y, self.off.z][axis];
            let (center, half) = (grid.center[axis], grid.half[axis]);
            if self.is_parallel {
                mesh.linear(row / half, self.origin, -center / half, off / half)
            } else {
                let weights = (row - center * rows.x_axis) / half;
                let off = off + center.abs() * self.off.x;
                mesh.linear(weights, self.origin, 0.0, off / half)
            }
        })
    }

    /// Where a grid sees the mesh.
    pub(super) fn view(&self, mesh: &Polyhedron, grid: &Grid) -> View {
        let nearest = (!self.is_parallel).then_some(self.depth[0]);
        View::new(self.across(mesh, grid), self.depths(mesh), nearest)
    }
}
