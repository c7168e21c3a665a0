//! The crossings of a line with a mesh, the nearest first, no more of them than are wanted.

use glam::DVec3;

use super::line::Line;
use super::pack::{Pack, Sight};
use super::polyhedron::Polyhedron;
use super::shear::{Shear, crossing};
use super::{IndexedMesh, Sink};
use crate::bvh::{Probe, Visitor};
use crate::eight::Eight;

/// Which crossings of a line are wanted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ahead<'a> {
    /// The place of the ray's origin.
    pub(crate) start: f64,
    /// Those up to here are known.
    pub(crate) known: f64,
    /// Those up to here are handed over, of all meshes that have been asked: there is a
    /// crossing here at `start` or behind it, or it is infinite. Others come later on the ray, not
    /// only on the line.
    pub(crate) horizon: f64,
    /// Whether the horizon may come nearer.
    pub(crate) stops: bool,
    /// Where crossings matter, so that the horizon may come there; anywhere if these are none.
    pub(crate) matters: &'a [[f64; 2]],
}

impl<'a> Ahead<'a> {
    /// All of them, or those up to the first at which the ray has started.
    pub(crate) fn new(line: &Line, matters: &'a [[f64; 2]]) -> Self {
        let (known, horizon) = (f64::NEG_INFINITY, f64::INFINITY);
        Self { start: line.on_line(0.0), known, horizon, stops: true, matters }
    }

    /// Whether the horizon can come to a crossing.
    #[inline(always)]
    fn stops_at(&self, t: f64) -> bool {
        let is_ahead = t >= self.start && t < self.horizon;
        let matters = || self.matters.iter().any(|&[from, to]| from <= t && t <= to);
        self.stops && is_ahead && (self.matters.is_empty() || matters())
    }

    /// Whether none of what is wanted is between two places: what is beyond the horizon has
    /// to be beyond it on the ray, too.
    #[inline(always)]
    fn is_beside(&self, line: &Line, [near, far]: [f64; 2]) -> bool {
        /// More than rounding: a line is about as long as the scene is large.
        const ROOM: f64 = 1e-6;
        let from = near - ROOM;
        far < self.start.max(self.known) - ROOM
            || (from > self.horizon && line.on_ray(from) > line.on_ray(self.horizon))
    }
}

impl Polyhedron {
    /// Hands over the crossings behind what is known up to the horizon, and perhaps others
    /// beyond that; brings the horizon nearer. Where all crossings are behind the start there
    /// are none: it is as often entered as left there.
    #[inline(always)]
    pub(crate) fn crossings_ahead<S: Eight>(
        &self,
        simd: S,
        line: &Line,
        ahead: &mut Ahead<'_>,
        sink: &mut Sink<'_>,
    ) {
        let mesh = self;
        let Some((origin, dir)) = mesh.in_frame(line) else { return };
        let IndexedMesh { faces, packs, points, scale, .. } = mesh.indexed();
        let slabs = faces.slabs(origin, dir);
        let [near, far] = slabs.range(&faces.bounds());
        let is_met = near <= far;
        if !is_met || ahead.is_beside(line, [near, far]) {
            return;
        }
        let shear = Shear::new(*scale, origin, dir, &mesh.to_local.linear);
        let mut probe = faces.probe(&slabs);
        if ahead.known > near {
            probe = probe.starting(ahead.known);
        }
        let sight = Sight::new(&probe, shear.axes, shear.shift);
        let limit = f32::INFINITY;
        let probe = &probe;
        let mut search =
            Search { packs, points, sight, shear, line, probe, ahead, limit, sink };
        if search.ahead.horizon < f64::INFINITY {
            search.stop_at(search.ahead.horizon);
        }
        faces.visited_in_order(simd, probe, &mut search);
    }
}

/// Finds the faces that a line crosses up to the horizon.
struct Search<'a, 'b, 'c> {
    packs: &'a [Pack],
    points: &'a [DVec3],
    sight: Sight,
    shear: Shear<'a>,
    line: &'a Line,
    probe: &'a Probe,
    ahead: &'a mut Ahead<'c>,
    limit: f32,
    sink: &'a mut Sink<'b>,
}

impl Visitor for Search<'_, '_, '_> {
    #[inline(always)]
    fn end<S: Eight>(&mut self, simd: S, end: u32) {
        let near = self.packs[end as usize].near(simd, &self.sight);
        if near != 0 {
            self.look_at(end, near);
        }
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        self.limit
    }
}

impl Search<'_, '_, '_> {
    /// Looks at the faces of a pack whose bits are set.
    #[inline(always)]
    fn look_at(&mut self, pack: u32, mut near: u32) {
        let pack = &self.packs[pack as usize];
        while near != 0 {
            if let Some((face, corners)) = pack.exact(near.trailing_zeros(), self.points)
                && let Some((t, sense)) = crossing(corners, &self.shear)
                && t > self.ahead.known
            {
                self.sink.crossing(t, face, sense);
                if self.ahead.stops_at(t) {
                    self.stop_at(t);
                }
            }
            near &= near - 1;
        }
    }

    /// Brings the horizon to a place, if what is beyond the limit is farther on the ray.
    #[inline(always)]
    fn stop_at(&mut self, t: f64) {
        if let Some((limit, room)) = self.probe.limit(t)
            && self.line.on_ray(t + room) > self.line.on_ray(t)
        {
            self.ahead.horizon = t;
            self.limit = limit;
        }
    }
}
