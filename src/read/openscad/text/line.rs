//! Where the letters of a text stand.

use glam::{DVec2, dvec2};
use rustybuzz::GlyphPosition;
use rustybuzz::ttf_parser::{Face, GlyphId};

use super::super::super::outline::Outline;
use super::em::Em;
use crate::op::Op;

/// A glyph with its origin at (0, 0), and where it is put and the next one starts.
pub(super) struct Glyph {
    paths: Vec<Vec<DVec2>>,
    offset: DVec2,
    advance: DVec2,
}

impl Glyph {
    /// One beside others.
    pub(super) fn in_line(paths: Vec<Vec<DVec2>>, at: &GlyphPosition, em: Em) -> Self {
        let pair = |x: i32, y: i32| dvec2(em.length(x), em.length(y));
        Self {
            paths,
            offset: pair(at.x_offset, at.y_offset),
            advance: pair(at.x_advance, at.y_advance),
        }
    }

    /// One above others, centred in its share of the column as `FreeType` does it for fonts that say
    /// nothing of columns (`TT_Load_Glyph`, in whole units).
    pub(super) fn in_column(
        paths: Vec<Vec<DVec2>>,
        id: GlyphId,
        em: Em,
        face: &Face<'_>,
    ) -> Self {
        let ascent = face.typographic_ascender().unwrap_or_else(|| face.ascender());
        let descent = face.typographic_descender().unwrap_or_else(|| face.descender());
        let height = i32::from(ascent) - i32::from(descent);
        let [low, high] = face
            .glyph_bounding_box(id)
            .map_or([0; 2], |b| [i32::from(b.y_min), i32::from(b.y_max)]);
        let top = high + (height - (high - low)) / 2;
        let middle = 0.5 * f64::from(face.glyph_hor_advance(id).unwrap_or(0));
        Self {
            paths,
            offset: -dvec2(em.length(middle), em.length(top)),
            advance: dvec2(0.0, -em.length(height)),
        }
    }
}

/// Glyphs one after the other.
pub(super) struct Line {
    pub(super) glyphs: Vec<Glyph>,
    pub(super) em: Em,
    /// Whether they stand below each other.
    pub(super) is_column: bool,
}

impl Line {
    /// How many points its curves have.
    pub(super) fn corners(&self) -> usize {
        self.glyphs.iter().flat_map(|glyph| &glyph.paths).map(Vec::len).sum()
    }

    /// Its letters, aligned to the origin; nothing if there are none.
    pub(super) fn set(
        self,
        spacing: f64,
        [horizontally, vertically]: &[String; 2],
    ) -> Option<Outline> {
        let Size { width, ascent, descent } = self.size(spacing);
        let mut at = DVec2::new(
            match horizontally.as_str() {
                "right" => -width,
                "center" => -0.5 * width,
                _ => 0.0,
            },
            match vertically.as_str() {
                "top" => -ascent,
                "center" => 0.5 * (descent - ascent),
                "bottom" => descent,
                _ => 0.0,
            },
        );
        let mut outlines = Vec::new();
        for glyph in self.glyphs {
            let origin = at + glyph.offset;
            at += spacing * glyph.advance;
            if !glyph.paths.is_empty() {
                let moved = |path: Vec<DVec2>| path.iter().map(|p| *p + origin).collect();
                outlines
                    .push(Outline::paths(glyph.paths.into_iter().map(moved).collect()));
            }
        }
        match outlines.len() {
            0 | 1 => outlines.pop(),
            _ => Some(Outline::boolean(Op::Union, outlines)),
        }
    }

    /// How much room it takes; a column has a (negative) ascent that is its length.
    fn size(&self, spacing: f64) -> Size {
        let mut size = Size { width: 0.0, ascent: 0.0, descent: 0.0 };
        for glyph in &self.glyphs {
            let points = || glyph.paths.iter().flatten();
            // How far it reaches from its origin: right, left, up, down.
            let reach = |along: DVec2| {
                let farthest = points().map(|p| p.dot(along)).reduce(f64::max);
                farthest.map(|length| self.em.reach(length))
            };
            if self.is_column {
                let both =
                    [DVec2::X, DVec2::NEG_X].map(|along| reach(along).unwrap_or(0.0));
                size.width = size.width.max(both[0] + both[1]);
                size.ascent += spacing * glyph.advance.y;
            } else {
                size.width += spacing * glyph.advance.x;
                size.ascent = size.ascent.max(reach(DVec2::Y).unwrap_or(0.0));
                size.descent = size.descent.max(reach(DVec2::NEG_Y).unwrap_or(0.0));
            }
        }
        size
    }
}

struct Size {
    width: f64,
    ascent: f64,
    descent: f64,
}
