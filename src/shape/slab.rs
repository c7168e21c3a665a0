//! The space between two parallel planes.

use glam::DVec3;

use super::Line;
use super::place::Frame;

/// The points with `low ≤ normal · p ≤ high`, in world coordinates.
///
/// Planes are kept in world coordinates, and every normal in one form (see
/// [`Slab::new`]), so that faces which coincide because their coordinates are equal give
/// equal bits for every line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slab {
    normal: DVec3,
    low: f64,
    high: f64,
    /// Whether the normal points from the second of the two local planes to the first.
    flipped: bool,
}

/// The stretch of a line inside a slab, and through which of the two local planes it goes
/// in and comes out: 0 for the first, 1 for the second.
pub(crate) struct Stretch {
    pub(crate) enter: f64,
    pub(crate) exit: f64,
    pub(crate) faces: [u32; 2],
}

impl Slab {
    /// The slab between the local planes where coordinate `axis` is `low` and `high`.
    ///
    /// The normal is divided by its largest component and its first component that is not
    /// zero is positive: one form for each direction, exact for directions along an axis.
    pub(crate) fn new(frame: &Frame, axis: usize, low: f64, high: f64) -> Self {
        let normal = frame.normal(DVec3::AXES[axis]);
        let (normal, flipped) = one_form(normal);
        let offset = |at: f64| normal.dot(frame.point(DVec3::AXES[axis] * at));
        let (first, second) = (offset(low), offset(high));
        let (low, high) = if flipped { (second, first) } else { (first, second) };
        Self { normal, low, high, flipped }
    }

    /// The stretch of a line inside; may be empty or infinite.
    ///
    /// A line within one of the planes is inside if the plane is the low one: as if it were
    /// moved a little along the normal, which makes abutting slabs share such lines out.
    pub(crate) fn stretch(&self, line: &Line) -> Stretch {
        let speed = self.normal.dot(line.dir);
        let at = self.normal.dot(line.origin);
        let first = u32::from(self.flipped);
        if speed == 0.0 {
            let inside = self.low <= at && at < self.high;
            let (enter, exit) = if inside {
                (f64::NEG_INFINITY, f64::INFINITY)
            } else {
                (f64::INFINITY, f64::NEG_INFINITY)
            };
            return Stretch { enter, exit, faces: [0, 0] };
        }
        let (low, high) = ((self.low - at) / speed, (self.high - at) / speed);
        if speed > 0.0 {
            Stretch { enter: low, exit: high, faces: [first, 1 - first] }
        } else {
            Stretch { enter: high, exit: low, faces: [1 - first, first] }
        }
    }

    /// The outward normal of one of the two local planes.
    pub(crate) fn outward(&self, face: u32) -> DVec3 {
        let is_low = (face == 0) != self.flipped;
        if is_low { -self.normal } else { self.normal }
    }
}

/// A normal divided by its largest component, its first component that is not zero made
/// positive; and whether that turned it round.
pub(crate) fn one_form(normal: DVec3) -> (DVec3, bool) {
    let scaled = normal / normal.abs().max_element();
    let first = scaled.to_array().into_iter().find(|&c| c != 0.0).unwrap_or(1.0);
    if first < 0.0 { (-scaled, true) } else { (scaled, false) }
}
