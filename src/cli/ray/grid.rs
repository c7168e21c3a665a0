//! Grids of rays: through a picture, or through a face of the bounding box.

use anyhow::bail;
use clap::{Args, ValueEnum};
use glam::DVec3;
use solidray::render::{Camera, Projection, View};
use solidray::{Aabb, Ray};

use super::super::render;

/// Which grid of rays.
#[derive(Args, Debug)]
pub(super) struct GridArgs {
    /// Shoot W times H rays, row by row, through the pixels of the picture that `render` would
    /// draw in this size, upper left first; or through the bounding box with --along
    #[arg(
        long,
        value_name = "W,H",
        value_parser = size,
        conflicts_with = "origin",
        help_heading = "Grid"
    )]
    grid: Option<[u32; 2]>,
    /// Rays along an axis from the face of the bounding box where they enter, t in model units.
    /// Of the other two axes, x, y and z in this order, the first runs along rows, from low to
    /// high, and the second from row to row
    #[arg(
        long,
        value_enum,
        value_name = "AXIS",
        allow_hyphen_values = true,
        requires = "grid",
        conflicts_with_all = ["camera", "projection"],
        help_heading = "Grid"
    )]
    along: Option<Along>,
    /// Where to look from, as in `render`, where `--help` says it [default: the whole model]
    #[arg(
        long,
        value_name = "NUMBERS",
        value_parser = render::camera,
        requires = "grid",
        help_heading = "Grid"
    )]
    camera: Option<Camera>,
    /// o or orthogonal: parallel rays; p or perspective: rays from the eye [default: p]
    #[arg(
        long,
        value_name = "o|p",
        value_parser = render::projection,
        requires = "grid",
        help_heading = "Grid"
    )]
    projection: Option<Projection>,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum Along {
    X,
    Y,
    Z,
    #[value(name = "-x")]
    MinusX,
    #[value(name = "-y")]
    MinusY,
    #[value(name = "-z")]
    MinusZ,
}

/// The rays of a grid, none of which is kept.
pub(super) struct Grid {
    size: [u32; 2],
    rays: Pattern,
}

enum Pattern {
    /// Through the pixels of a picture.
    Picture(View),
    /// From a face of a box.
    Face {
        /// The corner of the face where both coordinates along it are least.
        corner: DVec3,
        /// From there along the face, across all of it.
        sides: [DVec3; 2],
        dir: DVec3,
    },
}

impl GridArgs {
    pub(super) fn is_wanted(&self) -> bool {
        self.grid.is_some()
    }

    /// The grid that is wanted of something within these bounds, if one is.
    pub(super) fn over(&self, bounds: &Aabb) -> anyhow::Result<Option<Grid>> {
        let Some(size) = self.grid else { return Ok(None) };
        let rays = match self.along {
            None => {
                let camera = self.camera.unwrap_or_else(|| Camera::framing(bounds));
                let projection = self.projection.unwrap_or_default();
                let camera = camera.with_projection(projection);
                Pattern::Picture(camera.view(size, bounds))
            }
            Some(_) if bounds.is_empty() => {
                bail!("the model is empty: there is no box for --along")
            }
            Some(along) => along.face(bounds),
        };
        Ok(Some(Grid { size, rays }))
    }
}

impl Along {
    fn face(self, bounds: &Aabb) -> Pattern {
        let (axis, sign) = match self {
            Self::X => (0, 1.0),
            Self::Y => (1, 1.0),
            Self::Z => (2, 1.0),
            Self::MinusX => (0, -1.0),
            Self::MinusY => (1, -1.0),
            Self::MinusZ => (2, -1.0),
        };
        let size = bounds.size();
        let side = |axis: usize| DVec3::AXES[axis] * size[axis];
        let sides = match axis {
            0 => [side(1), side(2)],
            1 => [side(0), side(2)],
            _ => [side(0), side(1)],
        };
        let mut corner = bounds.min;
        if sign < 0.0 {
            corner[axis] = bounds.max[axis];
        }
        Pattern::Face { corner, sides, dir: sign * DVec3::AXES[axis] }
    }
}

impl Grid {
    /// How many rays there are.
    pub(super) fn count(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    /// The rays through the middles of the cells, row by row.
    pub(super) fn rays(&self) -> impl Iterator<Item = Ray> {
        let [width, height] = self.size;
        let cells = (0..height).flat_map(move |j| (0..width).map(move |i| [i, j]));
        cells.map(|cell| self.ray(cell.map(|n| f64::from(n) + 0.5)))
    }

    /// The ray through a place, in cells.
    fn ray(&self, [x, y]: [f64; 2]) -> Ray {
        match self.rays {
            Pattern::Picture(view) => view.ray(x, y),
            Pattern::Face { corner, sides: [along, across], dir } => {
                let [width, height] = self.size.map(f64::from);
                Ray::new(corner + (x / width) * along + (y / height) * across, dir)
            }
        }
    }
}

/// How many rays in a row, and how many rows. There may be any number: none is kept.
fn size(text: &str) -> Result<[u32; 2], String> {
    let parts: Result<Vec<u32>, _> =
        text.split([',', 'x']).map(|n| n.trim().parse()).collect();
    match parts.as_deref() {
        Ok(&[w, h]) if w > 0 && h > 0 => Ok([w, h]),
        _ => Err(format!("`{text}` is not a width and a height, as in 80,60")),
    }
}
