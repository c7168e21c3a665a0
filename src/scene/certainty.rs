//! How sure the spans of a ray are.

use super::Scene;
use super::trace::Tracer;
use crate::ray::Ray;
use crate::shape::U;

impl Tracer<'_> {
    /// How many of the spans and gaps that [`Tracer::spans`] just found along this ray are so
    /// short that rounding decides whether they are there: shorter than the bounds on the
    /// errors of their ends ([`Scene::error_at`](crate::Scene::error_at)). Those whose ends
    /// are one number `t`, which are left out of the list, count too.
    ///
    /// Only pieces shorter than about √ε are looked at, where ε is the largest displacement
    /// of any surface by rounding and lengths are fractions of the solid's size: no graze of
    /// a curved face is longer. A ray that runs along a plane within rounding, at an angle
    /// smaller than √ε, could have longer ones; they do not count.
    pub fn uncertain(&self, ray: &Ray) -> u64 {
        let mut count = self.collapsed;
        let origin = ray.origin.abs().max_element();
        let longest = self.scene.longest_thin(origin) / ray.dir.length_squared();
        let pieces = self.spans.windows(2).map(|pair| (pair[0].exit, pair[1].enter));
        let pieces = pieces.chain(self.spans.iter().map(|span| (span.enter, span.exit)));
        for (from, to) in pieces {
            let length = to.t - from.t;
            if length * length <= longest {
                let error = |crossing| self.scene.error_at(ray, crossing);
                count += u64::from(length <= error(&from) + error(&to));
            }
        }
        count
    }
}

impl Scene {
    /// The square of the length from which on pieces of a ray are certain whose origin has no
    /// larger coordinate than this.
    pub(super) fn longest_thin(&self, origin: f64) -> f64 {
        /// The bound of a graze is 2.5 √(ε R) at either end; the rest is room for solids of
        /// which R is not the largest length.
        const ROOM: f64 = 16.0;
        let bounds = self.hierarchy.bounds();
        let size = bounds.size().max_element();
        let far = bounds.reach();
        let far = 2.0 * far + origin;
        let moved = self.worst_slack + 16.0 * U * self.worst_condition * far;
        ROOM * moved * (ROOM * size)
    }
}
