//! How long things are in letters.

use rustybuzz::ttf_parser::{Face, Tag};

/// The size of letters, with the lengths that OpenSCAD 2021.01 gives them (measured; the numbers
/// stand in its `FreetypeRenderer.cc`).
///
/// It asks `FreeType` for letters of 100,000 / 64 points at 100 dots to the inch, in 64ths of a dot.
/// Curves are divided by 100,000, but the places of letters by 64 · 16 · 100: letters
/// stand closer together, and are aligned as if they were smaller, by 1000 / 1024.
#[derive(Clone, Copy)]
pub(super) struct Em {
    size: f64,
    /// 64ths of a dot in a unit of the font, for places.
    grains: f64,
    /// The same for curves.
    drawn: f64,
}

/// 64ths of a dot in what has a size of 1.
const CURVES: f64 = 100_000.0;
const PLACES: f64 = 64.0 * 16.0 * 100.0;

impl Em {
    pub(super) fn new(face: &Face<'_>, size: f64) -> Self {
        let units = f64::from(face.units_per_em());
        let grains = CURVES * 100.0 / 72.0;
        // The flag of fonts that want an em of whole dots (OpenType 1.9, "head", flags, bit 3).
        let head = face.raw_face().table(Tag::from_bytes(b"head"));
        let is_whole = head.and_then(|h| h.get(17)).is_some_and(|flags| flags & 8 != 0);
        let drawn = if is_whole { 64.0 * (grains / 64.0).round() } else { grains };
        Self { size, grains: grains / units, drawn: drawn / units }
    }

    /// How long a unit of the font is in curves.
    pub(super) fn unit(&self) -> f64 {
        self.size * self.drawn / CURVES
    }

    /// How far apart things are that many units apart.
    pub(super) fn length(&self, units: impl Into<f64>) -> f64 {
        self.size * (self.grains * units.into()).round() / PLACES
    }

    /// How far something of the curves reaches, for alignment: to the next dot.
    pub(super) fn reach(&self, length: f64) -> f64 {
        // Ends on a dot are not moved to the next one by rounding.
        let grains = (length / self.size * CURVES).round();
        self.size * 64.0 * (grains / 64.0).ceil() / PLACES
    }
}
