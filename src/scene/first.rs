//! What a ray meets first.
//!
//! Leaves with few faces hand over all their crossings, meshes only those up to the first
//! one ahead. These are swept. If the solid has not changed by then, as where the mesh is
//! within another leaf, meshes are asked for more. It is the answer of [`Tracer::spans`] to
//! the bit: all crossings up to the next place on the ray are known, so none of them can be
//! at the same place.

use super::Scene;
use super::trace::{Change, Tracer, in_order};
use crate::eight::{Eight, WithEight, with_eight};
use crate::ray::{Crossing, Ray};
use crate::shape::{ALL, Ahead, Event, Line, Shape, Sink};

/// How often meshes are asked for a few crossings before they are asked for all.
const PATIENCE: u32 = 4;

/// A ray whose first hit is asked for.
struct Asking<'a, 'b> {
    tracer: &'a mut Tracer<'b>,
    ray: &'a Ray,
}

impl WithEight for Asking<'_, '_> {
    type Output = Change;

    #[inline(always)]
    fn with_eight<S: Eight>(self, simd: S) -> Change {
        let Self { tracer, ray } = self;
        match Line::new(ray, &tracer.scene.stage) {
            None => Change::None,
            Some(line) => tracer.first_ahead(simd, &line),
        }
    }
}

impl Tracer<'_> {
    /// The first crossing at `t ≥ 0`: where the ray enters, or where it comes out if it
    /// starts inside.
    pub fn first_hit(&mut self, ray: &Ray) -> Option<Crossing> {
        match with_eight(Asking { tracer: self, ray }) {
            Change::None => None,
            Change::First(crossing) => Some(crossing),
            Change::Collapsed => {
                let spans = self.spans(ray);
                spans.iter().flat_map(|span| [span.enter, span.exit]).find(|c| c.t >= 0.0)
            }
        }
    }

    /// The first change of the solid at `t ≥ 0`.
    #[inline(always)]
    fn first_ahead<S: Eight>(&mut self, simd: S, line: &Line) -> Change {
        self.gather_all_but_meshes(line);
        let matters = self.where_mesh_matters(line);
        let mut ahead = Ahead::new(line, &matters);
        let mut passed = 0;
        let mut found = Change::None;
        for asked in 1.. {
            self.gather_meshes(simd, line, &mut ahead);
            self.events[passed..].sort_unstable_by(in_order);
            let horizon = line.on_ray(ahead.horizon);
            while let Some(&Event { t, .. }) = self.events.get(passed) {
                let place = line.on_ray(t);
                if place > horizon {
                    break;
                }
                if let Change::First(crossing) = found
                    && place > crossing.t
                {
                    break;
                }
                ahead.known = t;
                let group = self.group(passed);
                passed = group.end;
                let Some((Event { leaf, face, .. }, sense)) = self.pass(group) else {
                    continue;
                };
                if found != Change::None {
                    found = Change::Collapsed;
                    break;
                }
                if place >= 0.0 {
                    found = Change::First(Crossing { t: place, leaf, face, sense });
                }
            }
            if found != Change::None || ahead.horizon == f64::INFINITY {
                break;
            }
            self.forget_meshes_from(passed);
            ahead.known = ahead.known.max(ahead.horizon);
            ahead.horizon = f64::INFINITY;
            ahead.stops = asked < PATIENCE;
        }
        self.pass_back(passed);
        self.matters = matters;
        debug_assert!(self.counts == self.scene.far_away, "the counters are back");
        found
    }

    /// All crossings with leaves of few faces; notes the others.
    #[inline(always)]
    fn gather_all_but_meshes(&mut self, line: &Line) {
        let Self { scene, events, meshes, .. } = self;
        events.clear();
        meshes.clear();
        let slabs = scene.hierarchy.slabs(line.origin, line.dir);
        scene.hierarchy.crossed(&slabs, |leaf| {
            let shape = &scene.shapes[leaf as usize];
            if matches!(shape, Shape::Polyhedron(_)) {
                meshes.push(leaf);
            } else {
                shape.crossings(ALL, line, &mut Sink { events, leaf });
            }
        });
    }

    /// Where on the line the solid depends on the mesh, if there is one and other leaves have
    /// been crossed.
    #[inline(always)]
    fn where_mesh_matters(&mut self, line: &Line) -> Vec<[f64; 2]> {
        let mut matters = std::mem::take(&mut self.matters);
        matters.clear();
        let [mesh] = self.meshes[..] else { return matters };
        let (start, mut from) = (line.on_line(0.0), f64::NEG_INFINITY);
        let Scene { program, literals, .. } = self.scene;
        let literal = literals[mesh as usize];
        if self.events.is_empty() {
            return matters;
        }
        self.events.sort_unstable_by(in_order);
        for i in 0..self.events.len() {
            let Event { t, leaf, sense, .. } = self.events[i];
            let depends =
                program.depends(&self.counts, literal.parent, literal.complement);
            if t >= start && depends {
                matters.push([from, t]);
            }
            self.cross(leaf, sense);
            from = t;
        }
        if from > f64::NEG_INFINITY {
            matters.push([from, f64::INFINITY]);
        }
        matters
    }

    /// The crossings of meshes up to a horizon.
    #[inline(always)]
    fn gather_meshes<S: Eight>(&mut self, simd: S, line: &Line, ahead: &mut Ahead<'_>) {
        let Self { scene, events, meshes, .. } = self;
        for &leaf in &*meshes {
            if let Shape::Polyhedron(mesh) = &scene.shapes[leaf as usize] {
                mesh.crossings_ahead(simd, line, ahead, &mut Sink { events, leaf });
            }
        }
    }

    /// Drops the crossings of meshes from a number on.
    fn forget_meshes_from(&mut self, passed: usize) {
        let Self { scene, events, .. } = self;
        let mut number = 0;
        events.retain(|event| {
            number += 1;
            let shape = &scene.shapes[event.leaf as usize];
            number <= passed || !matches!(shape, Shape::Polyhedron(_))
        });
    }
}
