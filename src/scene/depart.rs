//! Rays that start on the surface of the solid.

use super::trace::Tracer;
use crate::aabb::Aabb;
use crate::ray::{Crossing, Ray, Sense};
use crate::shape::{Identity, Line, Spot};

impl Tracer<'_> {
    /// The first crossing of a ray that starts at a crossing of another ray: reflected there,
    /// refracted, or sent anywhere else.
    ///
    /// The point at `t = 0` counts as a point of the surface that was crossed, whatever
    /// rounding has made of it, and that surface is not met there again. It is known by its
    /// identity; there is no smallest distance. The ray leaves into the solid or out of it,
    /// as the normal says, and what it meets next is a crossing the other way. So where it
    /// starts in a corner, nearer to the other wall than rounding or even behind it, it
    /// meets that wall at `t = 0`.
    pub fn next_hit(&mut self, ray: &Ray, start: &Crossing) -> Option<Crossing> {
        self.spans(ray);
        let start = Departure::new(self, ray, start)?;
        let list = || self.spans.iter().flat_map(|span| [span.enter, span.exit]);
        if let Some(i) = list().position(|c| start.is(self, &c)) {
            return list().nth(i + 1).map(ahead);
        }
        let next = list().find(|c| c.t > 0.0);
        match next {
            Some(c) if c.sense != start.sense => Some(c),
            // The start itself, put down to a neighbour.
            Some(c) if start.is_beside(self, &c) => {
                list().find(|next| next.t > c.t).map(ahead)
            }
            None if start.sense == Sense::Exit => None,
            Some(_) | None => Some(start.corner(self)),
        }
    }

    /// What a sense with regard to a leaf is with regard to the solid, and the other way
    /// round.
    fn turned(&self, leaf: u32, sense: Sense) -> Sense {
        let complement = self.scene.literals[leaf as usize].complement;
        if complement { sense.reversed() } else { sense }
    }

    fn surface_of(&self, crossing: &Crossing) -> Identity {
        self.scene.shapes[crossing.leaf as usize].identity(crossing.face).0
    }
}

/// A crossing that rounding has put behind the start is at the start.
fn ahead(crossing: Crossing) -> Crossing {
    Crossing { t: crossing.t.max(0.0), ..crossing }
}

/// A ray and the surface on which it starts.
struct Departure<'a> {
    ray: &'a Ray,
    line: Line,
    crossing: Crossing,
    surface: Identity,
    /// Which way the line passes through the surface, as its leaf sees it.
    in_leaf: Sense,
    /// The same as the solid sees it.
    sense: Sense,
    /// Where on the ray the surface is, but for rounding at zero.
    at: f64,
}

impl<'a> Departure<'a> {
    fn new(tracer: &Tracer<'_>, ray: &'a Ray, start: &Crossing) -> Option<Self> {
        let line = Line::new(ray, &tracer.scene.stage)?;
        let surface = tracer.scene.shapes[start.leaf as usize].surface();
        let spot = Spot { line: &line, t: line.on_line(0.0), slack: 0.0 };
        let local = surface.local(&spot, start.face);
        let in_leaf = if local.slope > 0.0 { Sense::Exit } else { Sense::Enter };
        Some(Self {
            ray,
            line,
            crossing: *start,
            surface: tracer.surface_of(start),
            in_leaf,
            sense: tracer.turned(start.leaf, in_leaf),
            at: line.on_ray(spot.t - local.value / local.slope),
        })
    }

    /// Whether a crossing of the new line is the start. A line crosses a plane once, a
    /// triangle once, and a quadric once each way.
    fn is(&self, tracer: &Tracer<'_>, c: &Crossing) -> bool {
        let same = match self.surface {
            Identity::Plane(_) => true,
            Identity::Wall(_) => tracer.turned(c.leaf, c.sense) == self.in_leaf,
            Identity::Mesh(_) => {
                c.leaf == self.crossing.leaf && c.face == self.crossing.face
            }
        };
        same && c.sense == self.sense && tracer.surface_of(c) == self.surface
    }

    /// Whether a crossing is no farther from the start than the start is from its surface, or
    /// than rounding.
    fn is_beside(&self, tracer: &Tracer<'_>, c: &Crossing) -> bool {
        /// Two faces at an edge are as far away as each other, but not at the same angle.
        const ROOM: f64 = 16.0;
        c.t <= ROOM * (self.at.abs() + tracer.scene.error_at(self.ray, c))
    }

    /// The wall of a corner in which the ray starts so deep that it never leaves it.
    fn corner(&self, tracer: &Tracer<'_>) -> Crossing {
        let scene = tracer.scene;
        let off = self.at.abs() * self.ray.speed();
        let reach = 2.0 * off + 16.0 * scene.worst_slack;
        let (p, t) = (self.ray.origin, self.line.on_line(0.0));
        let wanted = self.sense.reversed();
        let mut best = (f64::INFINITY, self.crossing.leaf, self.crossing.face);
        scene.hierarchy.around(&Aabb::new(p - reach, p + reach), |leaf| {
            let shape = &scene.shapes[leaf as usize];
            let slack = scene.slacks[leaf as usize] + off;
            let spot = Spot { line: &self.line, t, slack };
            shape.surface().near(&spot, &mut |face, local| {
                let in_leaf = if local.slope > 0.0 { Sense::Exit } else { Sense::Enter };
                let away = (local.value / local.slope).abs();
                if tracer.turned(leaf, in_leaf) == wanted && away < best.0 {
                    best = (away, leaf, face);
                }
            });
        });
        let (_, leaf, face) = best;
        Crossing { t: 0.0, leaf, face, sense: wanted }
    }
}
