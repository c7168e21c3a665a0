//! The cells of a grid that the surface of a mesh passes.
//!
//! A cell that no triangle touches is inside of the mesh or outside as a whole, and so are
//! two such cells side by side together. So a few lines tell those that are inside from those
//! that are outside.

use std::ops::Range;

use glam::DVec3;

use super::grid::{Grid, Places};
use crate::aabb::Aabb;
use crate::ray::{Ray, Sense};
use crate::scene::Scene;
use crate::scene::trace::PROBE;
use crate::shape::{ALL, Line, Polyhedron, Sink};

/// What some cells are to a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Passed {
    In,
    Out,
    /// Its surface may pass them, or is between them.
    Open,
}

/// What each cell is to a mesh.
#[derive(Debug)]
pub(super) struct Raster {
    /// The cells around it; others are outside.
    places: Places,
    /// Row by row.
    cells: Vec<Passed>,
}

/// Triangles that touch no more cells than this mark them all.
const FEW: usize = 8;

impl Raster {
    pub(super) fn new(scene: &Scene, grid: &Grid, leaf: u32, mesh: &Polyhedron) -> Self {
        let mut around = Aabb::EMPTY;
        let is_placed =
            mesh.for_each_face(|corners| around = around.hull(Aabb::around(corners)));
        if !is_placed {
            let places = grid.whole().places;
            return Self { places, cells: vec![Passed::Open; grid.len()] };
        }
        let places = grid.touched(&around);
        let len = places.iter().map(ExactSizeIterator::len).product();
        let mut raster = Self { places, cells: vec![Passed::Out; len] };
        mesh.for_each_face(|corners| raster.mark(grid, corners));
        raster.flood(grid, |point| is_inside(scene, leaf, point));
        raster
    }

    /// How many cells it takes.
    pub(super) fn len(&self) -> usize {
        self.cells.len()
    }

    /// Where the cells of a row begin.
    fn row(&self, y: u32, z: u32) -> usize {
        let [x_places, y_places, z_places] = &self.places;
        let rows = (z - z_places.start) as usize * y_places.len();
        (rows + (y - y_places.start) as usize) * x_places.len()
    }

    /// The cells with these places, row by row.
    fn rows(&self, [x, y, z]: &Places) -> impl Iterator<Item = Range<usize>> {
        let (x, y) = (x.clone(), y.clone());
        let first = self.places[0].start;
        let (start, end) = ((x.start - first) as usize, (x.end - first) as usize);
        z.clone()
            .flat_map(move |z| y.clone().map(move |y| self.row(y, z)))
            .map(move |row| row + start..row + end)
    }

    /// Notes which cells a triangle may touch: those which its box touches, and its plane
    /// passes.
    fn mark(&mut self, grid: &Grid, corners: [DVec3; 3]) {
        let places = grid.touched(&Aabb::around(corners));
        let [x, y, z] = places.clone();
        let count = x.len() * y.len() * z.len();
        if count == 0 {
            return;
        }
        if count <= FEW {
            let rows: Vec<_> = self.rows(&places).collect();
            rows.into_iter().for_each(|row| self.cells[row].fill(Passed::Open));
            return;
        }
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let edges = (b - a).length() * (c - a).length();
        for z in z {
            for y in y.clone() {
                let row = self.row(y, z);
                for x in x.clone() {
                    let cell = [x, y, z].map(|place| place..place + 1);
                    let around = grid.around(&cell);
                    let (away, half) = (around.center() - a, 0.5 * around.size());
                    // With room for the rounding of the normal.
                    let reach = normal.abs().dot(half) + 1e-12 * edges * away.length();
                    let is_beside = normal.dot(away).abs() > reach;
                    if !is_beside {
                        self.cells[row + (x - self.places[0].start) as usize] =
                            Passed::Open;
                    }
                }
            }
        }
    }

    /// Finds out what the cells are that no triangle touches.
    fn flood(&mut self, grid: &Grid, mut is_inside: impl FnMut(DVec3) -> bool) {
        let [x, y, z] = self.places.clone();
        let (to_y, to_z) = (x.len(), x.len() * y.len());
        let mut i = 0;
        for z in z.clone() {
            for y in y.clone() {
                for x in x.clone() {
                    if self.cells[i] != Passed::Open {
                        let [x0, y0, z0] = [0, 1, 2].map(|k| self.places[k].start);
                        let before = [(x > x0, 1), (y > y0, to_y), (z > z0, to_z)];
                        let known = before
                            .into_iter()
                            .filter(|(is_there, _)| *is_there)
                            .map(|(_, back)| self.cells[i - back])
                            .find(|&side| side != Passed::Open);
                        self.cells[i] = known.unwrap_or_else(|| {
                            let cell = [x, y, z].map(|place| place..place + 1);
                            let inside = is_inside(grid.around(&cell).center());
                            if inside { Passed::In } else { Passed::Out }
                        });
                    }
                    i += 1;
                }
            }
        }
    }

    /// What the mesh is to some cells.
    pub(super) fn side(&self, places: &Places) -> Passed {
        let mut common = places.clone();
        for (common, ours) in common.iter_mut().zip(&self.places) {
            *common = common.start.max(ours.start)..common.end.min(ours.end);
        }
        if common.iter().any(Range::is_empty) {
            return Passed::Out;
        }
        let first = if common == *places {
            self.rows(&common).next().map_or(Passed::Out, |row| self.cells[row.start])
        } else {
            Passed::Out
        };
        let is_all = self
            .rows(&common)
            .all(|row| self.cells[row].iter().all(|&cell| cell == first));
        if is_all { first } else { Passed::Open }
    }
}

/// Whether a point is inside of a leaf, as the line through it says.
pub(in super::super) fn is_inside(scene: &Scene, leaf: u32, point: DVec3) -> bool {
    let Some(line) = Line::new(&Ray::new(point, PROBE), &scene.stage) else {
        return false;
    };
    let events = &mut Vec::new();
    scene.shapes[leaf as usize].crossings(ALL, &line, &mut Sink { events, leaf });
    let before = events.iter().filter(|event| line.on_ray(event.t) <= 0.0);
    let winding: i32 = before
        .map(|event| match event.sense {
            Sense::Enter => 1,
            Sense::Exit => -1,
        })
        .sum();
    winding > 0
}
