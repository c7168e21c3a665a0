//! The lights that show a surface's shape. They are fixed to the camera.
//!
//! OpenSCAD has two white lamps, one before the solid, upper left, and one behind it,
//! lower right. Here the first is a softer key light, the second a weak fill light that
//! has come to the front, and a sky brightens what faces up, so that no face is black and
//! no two faces of a box are alike.

use glam::Vec3;

/// The light that a surface reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reflection {
    /// The share of its colour, 0–1.
    pub(super) diffuse: f32,
    /// White light on top of it.
    pub(super) specular: f32,
}

/// Towards the key light, in eye coordinates: x right, y up, z out of the picture.
pub(super) const KEY: Vec3 = Vec3::new(-0.485, 0.566, 0.667);
/// Towards the fill light.
const FILL: Vec3 = Vec3::new(0.873, -0.218, 0.436);

/// How the light that falls on surfaces is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Light {
    /// From lamps that nothing stands in front of: no rays beside those of the picture.
    #[default]
    Plain,
    /// From a lamp as wide as the sky, to which so many rays go from each surface that is seen, for
    /// each of a pixel's rays: holes are darker, and solids stand on their shadows.
    Soft {
        /// How many.
        rays: u32,
    },
}

/// The brightness of the wide lamp of soft light in a direction whose cosine to the key light's is
/// given.
pub(super) fn lamp(cosine: f32) -> f32 {
    let toward = cosine.max(0.0);
    0.35 + 0.65 * toward * toward
}

/// The reflection of a surface with unit normal `n`, towards a viewer in the unit
/// direction `v`, both in eye coordinates.
pub(super) fn reflection(n: Vec3, v: Vec3) -> Reflection {
    let sky = 0.5 + 0.5 * n.y;
    let key = half_lambert(n.dot(KEY));
    let fill = n.dot(FILL).max(0.0);
    // Blinn's highlight (1977): the normal against the bisector of light and viewer.
    let highlight = n.dot((KEY + v).normalize_or(n)).max(0.0).powi(40);
    Reflection {
        diffuse: 0.10 + 0.13 * sky + 0.70 * key + 0.14 * fill,
        specular: 0.07 * highlight,
    }
}

/// A light that reaches around the edge of night: the square of the cosine stretched
/// from −1…1 to 0…1 (Mitchell et al., "Shading in Valve's Source Engine",
/// SIGGRAPH 2006, §8.2.1).
fn half_lambert(cosine: f32) -> f32 {
    let stretched = 0.5 + 0.5 * cosine;
    stretched * stretched
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_black_and_nothing_is_blown_out() {
        for i in 0..1000_u16 {
            let z = 1.0 - f32::from(i) / 500.0;
            let (sin, cos) = (f32::from(i) * 2.4).sin_cos();
            let flat = (1.0 - z * z).max(0.0).sqrt();
            let light = reflection(Vec3::new(flat * cos, flat * sin, z), Vec3::Z);
            assert!((0.1..=1.0).contains(&light.diffuse), "{light:?}");
        }
    }

    #[test]
    fn lamps_are_unit_vectors() {
        assert!((KEY.length() - 1.0).abs() < 1e-3);
        assert!((FILL.length() - 1.0).abs() < 1e-3);
    }
}
