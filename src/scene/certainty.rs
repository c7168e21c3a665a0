//! How sure the spans of a ray are.

use super::trace::Tracer;
use crate::ray::Ray;

impl Tracer<'_> {
    /// How many of the spans and gaps that [`Tracer::spans`] just found along this ray are so
    /// short that rounding decides whether they are there: shorter than the bounds on the errors of
    /// their ends ([`Scene::error_at`](crate::Scene::error_at)). Those whose ends are one number `t`, which
    /// are left out of the list, count too.
    pub fn uncertain(&self, ray: &Ray) -> u64 {
        let error = |crossing| self.scene.error_at(ray, crossing);
        let mut count = self.collapsed;
        let mut previous: Option<(f64, f64)> = None;
        for span in &self.spans {
            let (enter, exit) = (error(&span.enter), error(&span.exit));
            count += u64::from(span.length() <= enter + exit);
            if let Some((t, error)) = previous {
                count += u64::from(span.enter.t - t <= enter + error);
            }
            previous = Some((span.exit.t, exit));
        }
        count
    }
}
