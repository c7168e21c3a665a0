//! Solids of revolution bounded by a quadric and two planes.

use glam::DVec3;

use super::parameter::{finite, size};
use super::{BadParameter, Curved, Describe, Extent, Facets, Flat, Profile};
use crate::rounded::Rounded;

/// A solid of revolution about the z-axis, `x² + y² ≤ ρ(z)`, cut at two heights. Its face 0 is the
/// curved one, 1 the bottom and 2 the top; a whole ball has the first alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadric {
    /// Which ρ.
    pub profile: Profile,
    /// The smallest z.
    pub bottom: f64,
    /// The largest z.
    pub top: f64,
}

impl Quadric {
    /// Whether the profile ends by itself.
    fn is_whole(&self) -> bool {
        let Self { profile, bottom, top } = *self;
        matches!(profile, Profile::Ball { radius } if bottom <= -radius && top >= radius)
    }

    /// The heights between which there is anything.
    fn ends(&self) -> [f64; 2] {
        self.profile.extent(self.bottom, self.top)
    }
}

impl Describe for Quadric {
    fn name(&self) -> &'static str {
        self.profile.name()
    }

    fn check(&self) -> Result<(), BadParameter> {
        let Self { profile, bottom, top } = *self;
        finite("bottom", bottom)?;
        finite("top", top)?;
        size("height", top - bottom)?;
        profile.check(bottom, top)
    }

    fn planes(&self) -> Vec<Flat> {
        if self.is_whole() {
            return Vec::new();
        }
        let Self { bottom, top, .. } = *self;
        vec![
            Flat { normal: -DVec3::Z, offset: -bottom, point: DVec3::Z * bottom },
            Flat { normal: DVec3::Z, offset: top, point: DVec3::Z * top },
        ]
    }

    fn wall(&self) -> Option<Curved> {
        Some(Curved { profile: self.profile, ends: self.ends() })
    }

    fn extent(&self) -> Extent {
        let Self { profile, .. } = *self;
        let ends = self.ends();
        match profile {
            Profile::Ball { radius } if self.is_whole() => Extent::Ball { radius },
            // Where the radius is a convex function of height, the solid is within the
            // convex hull of its two ends.
            Profile::Cylinder { .. }
            | Profile::Cone { .. }
            | Profile::OneSheet { .. } => {
                Extent::Discs { radii: ends.map(|z| profile.radius(z)), ends }
            }
            Profile::Ball { .. }
            | Profile::Paraboloid { .. }
            | Profile::TwoSheets { .. } => {
                Extent::Discs { radii: [profile.largest_radius(ends); 2], ends }
            }
        }
    }

    fn facets(&self) -> Facets {
        let Self { profile, bottom, top } = *self;
        match profile {
            Profile::Ball { radius } if self.is_whole() => Facets::Ball { radius },
            Profile::Cylinder { .. } | Profile::Cone { .. } => {
                let ends = [bottom, top];
                Facets::Frustum { radii: ends.map(|z| profile.radius(z)), ends }
            }
            Profile::Ball { .. }
            | Profile::Paraboloid { .. }
            | Profile::OneSheet { .. }
            | Profile::TwoSheets { .. } => Facets::Unknown,
        }
    }

    fn is_convex(&self) -> bool {
        match self.profile {
            Profile::Ball { .. }
            | Profile::Cylinder { .. }
            | Profile::Cone { .. }
            | Profile::Paraboloid { .. } => true,
            Profile::OneSheet { .. } | Profile::TwoSheets { .. } => false,
        }
    }

    fn volume(&self) -> Option<Rounded> {
        Some(Rounded::PI * self.profile.squares(self.bottom, self.top))
    }

    fn lengths(&self) -> [Vec<f64>; 3] {
        let Self { profile, bottom, top } = *self;
        let radii = match profile {
            Profile::Ball { radius } | Profile::Cylinder { radius } => vec![radius],
            Profile::Cone { radius, slope } => {
                [bottom, top].map(|z| radius + slope * z).to_vec()
            }
            // No file has these.
            Profile::Paraboloid { .. }
            | Profile::OneSheet { .. }
            | Profile::TwoSheets { .. } => Vec::new(),
        };
        [radii.clone(), radii, vec![bottom, top, top - bottom]]
    }
}
