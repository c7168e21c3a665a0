//! Colours as models give them.

/// A colour as OpenSCAD prints it: red, green, blue and opacity in 0–1, the
/// first three in the sRGB encoding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color {
    /// Red, green, blue and opacity.
    pub rgba: [f32; 4],
}

impl Color {
    /// An opaque colour.
    pub const fn rgb(r: f32, g: f32, b: f32) -> Self {
        Self { rgba: [r, g, b, 1.0] }
    }
}
