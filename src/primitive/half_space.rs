//! Half-spaces.

use glam::DVec3;

use super::parameter::{finite, positive};
use super::{BadParameter, Describe, Extent, Facets, Flat};

/// The points with `normal · p ≤ offset`. Its only face is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// The direction out of the solid, of any length.
    pub normal: DVec3,
    /// `normal · p` on the plane.
    pub offset: f64,
}

impl Describe for HalfSpace {
    fn name(&self) -> &'static str {
        "half-space"
    }

    fn check(&self) -> Result<(), BadParameter> {
        finite("offset", self.offset)?;
        positive("length of the normal", self.normal.length())
    }

    fn planes(&self) -> Vec<Flat> {
        let Self { normal, offset } = *self;
        let point = normal * (offset / normal.length_squared());
        vec![Flat { normal, offset, point }]
    }

    fn extent(&self) -> Extent {
        Extent::Unbounded
    }

    fn facets(&self) -> Facets {
        let Self { normal, offset } = *self;
        Facets::HalfSpace { normal, offset }
    }
}
