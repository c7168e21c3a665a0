//! What a picture shows of a surface.

use glam::{DVec3, Vec3};

use super::Scheme;
use super::light::reflection;
use super::scheme::{decoded, linear, oklch, srgb8};
use crate::color::Color;

/// What a picture shows of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Look {
    /// Its colour in soft light.
    #[default]
    Shaded,
    /// Its outward unit normal in world coordinates: red, green and blue are
    /// (x + 1) / 2, (y + 1) / 2 and (z + 1) / 2. Black where nothing is.
    Normal,
    /// How near it is: the nearest white, the farthest a dark grey, in equal steps of
    /// depth along the line of sight. Black where nothing is.
    Depth,
    /// Which leaf of the scene it is of, a colour for each, in soft light.
    Leaf,
}

/// All that looks want to know about the surface in one pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// The colour the model or the scheme gives it.
    pub(super) color: Color,
    /// Which leaf it is of.
    pub(super) leaf: u32,
    /// 1 for what is nearest in the picture, 0 for what is farthest.
    pub(super) nearness: f32,
    /// The outward unit normal.
    pub(super) normal: DVec3,
    /// The unit normal on the side that is seen, in eye coordinates: x right, y up, z out
    /// of the picture.
    pub(super) eye_normal: Vec3,
    /// The unit vector to the viewer, in eye coordinates.
    pub(super) to_viewer: Vec3,
    /// How much of the light that could fall on it does: 0–1.
    pub(super) openness: f32,
}

impl Look {
    /// All looks.
    pub const ALL: [Self; 4] = [Self::Shaded, Self::Normal, Self::Depth, Self::Leaf];

    /// Whether surfaces are shown in some light.
    pub(super) fn is_lit(self) -> bool {
        matches!(self, Self::Shaded | Self::Leaf)
    }

    /// The light, linear in sRGB's primaries, of a pixel in which a surface is seen.
    pub(super) fn paint(self, seen: &Seen) -> Vec3 {
        match self {
            Self::Shaded => lit(linear(seen.color), seen),
            Self::Normal => (0.5 * seen.normal + 0.5).as_vec3().map(decoded),
            Self::Depth => Vec3::splat(decoded(0.15 + 0.85 * seen.nearness)),
            Self::Leaf => lit(leaf_color(seen.leaf), seen),
        }
    }

    /// The light of a pixel in which nothing is seen, so far down in the picture: 0–1.
    pub(super) fn background(self, scheme: &Scheme, down: f32) -> Vec3 {
        match self {
            Self::Shaded | Self::Leaf => scheme.ground(down),
            Self::Normal | Self::Depth => Vec3::ZERO,
        }
    }
}

fn lit(color: Vec3, seen: &Seen) -> Vec3 {
    let light = reflection(seen.eye_normal, seen.to_viewer);
    seen.openness * (light.diffuse * color + light.specular)
}

/// A colour that is easily told from those of other numbers, as in [`Look::Leaf`].
pub fn distinct_color(number: u32) -> Color {
    let [r, g, b] = srgb8(leaf_color(number)).map(|byte| f32::from(byte) / 255.0);
    Color::rgb(r, g, b)
}

/// A colour for each leaf. Hues follow each other by the golden ratio of a turn, so that
/// any first few of them are spread well (Swierczkowski's three-distance theorem, 1958);
/// lightness and chroma take turns, so that near hues far apart in number differ too.
fn leaf_color(leaf: u32) -> Vec3 {
    let turns = f64::from(leaf) * 0.618_033_988_749_894_9 + 0.08;
    #[expect(clippy::cast_possible_truncation, reason = "a fraction of a turn")]
    let hue_turns = turns.fract() as f32;
    let (lightness, chroma) = match leaf % 3 {
        0 => (0.78, 0.13),
        1 => (0.70, 0.15),
        _ => (0.86, 0.09),
    };
    oklch(lightness, chroma, hue_turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_leaves_have_distinct_colors() {
        let colors: Vec<_> = (0..40).map(|leaf| leaf_color(leaf).to_array()).collect();
        for (i, &a) in colors.iter().enumerate() {
            for (j, &b) in colors.iter().enumerate().skip(i + 1) {
                let apart = (Vec3::from(a) - Vec3::from(b)).abs().max_element();
                assert!(apart > 0.01, "leaves {i} and {j}");
            }
        }
    }
}
