//! The curves of letters as lines.

use glam::DVec2;
use rustybuzz::ttf_parser::{Face, GlyphId, OutlineBuilder};

use super::super::curve;

/// Into how many lines a curve is cut.
#[derive(Clone, Copy)]
pub(super) enum Cut {
    Pieces(u32),
    /// So many that they are nowhere farther from it.
    Within(f64),
}

impl Cut {
    /// The number for a curve of which the second derivative is nowhere longer.
    fn pieces(self, bend: f64) -> u32 {
        match self {
            Self::Pieces(pieces) => pieces,
            Self::Within(tolerance) => {
                curve::part(1, (0.125 * bend / tolerance).sqrt().ceil()).min(256)
            }
        }
    }
}

/// Takes the curves of a glyph as lines.
pub(super) struct Drawing {
    scale: f64,
    cut: Cut,
    paths: Vec<Vec<DVec2>>,
    here: DVec2,
}

impl Drawing {
    /// The lines of a glyph, a unit of the font being so long.
    pub(super) fn of(
        face: &Face<'_>,
        glyph: GlyphId,
        scale: f64,
        cut: Cut,
    ) -> Vec<Vec<DVec2>> {
        let mut drawing = Self { scale, cut, paths: Vec::new(), here: DVec2::ZERO };
        let _ = face.outline_glyph(glyph, &mut drawing);
        drawing.paths
    }

    fn point(&self, x: f32, y: f32) -> DVec2 {
        self.scale * DVec2::new(x.into(), y.into())
    }

    fn to(&mut self, point: DVec2) {
        self.here = point;
        if let Some(path) = self.paths.last_mut() {
            path.push(point);
        }
    }
}

impl OutlineBuilder for Drawing {
    fn move_to(&mut self, x: f32, y: f32) {
        self.paths.push(Vec::new());
        self.to(self.point(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.to(self.point(x, y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let [a, b, c] = [self.here, self.point(x1, y1), self.point(x, y)];
        let pieces = self.cut.pieces((2.0 * (a - 2.0 * b + c)).length());
        for i in 1..=pieces {
            let t = f64::from(i) / f64::from(pieces);
            self.to(a.lerp(b, t).lerp(b.lerp(c, t), t));
        }
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let [a, b] = [self.here, self.point(x1, y1)];
        let [c, d] = [self.point(x2, y2), self.point(x, y)];
        let bend = (a - 2.0 * b + c).length().max((b - 2.0 * c + d).length());
        let pieces = self.cut.pieces(6.0 * bend);
        for i in 1..=pieces {
            let t = f64::from(i) / f64::from(pieces);
            let (low, high) = (a.lerp(b, t).lerp(b.lerp(c, t), t), b.lerp(c, t));
            self.to(low.lerp(high.lerp(c.lerp(d, t), t), t));
        }
    }

    fn close(&mut self) {}
}
