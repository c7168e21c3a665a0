//! `text`: shaped by `HarfBuzz`'s rules, in outlines of installed fonts.

use fontdb::{Database, Family, Query, Stretch, Style, Weight};
use glam::DVec2;
use rustybuzz::ttf_parser::{self, GlyphId, OutlineBuilder, Tag as Letters};
use rustybuzz::{Direction, Face, Language, Script, UnicodeBuffer};

use super::super::error::{Located, ReadErrorKind};
use super::super::outline::Outline;
use super::super::words::quoted;
use super::arguments::Call;
use super::curve;
use super::evaluate::Reading;
use super::node::Shape;
use crate::op::Op;
use crate::solid::Tag;

pub(super) const PARAMETERS: &[&str] = &[
    "text",
    "size",
    "font",
    "direction",
    "language",
    "script",
    "halign",
    "valign",
    "spacing",
];

/// What OpenSCAD writes with unless told otherwise.
const USUAL: &str = "Liberation Sans";

/// The letters of a text as outlines on the baseline that starts at the origin: where there is no
/// OpenSCAD to set it.
pub(super) fn text(
    call: &Call<'_>,
    _: Vec<Shape>,
    reading: &mut Reading<'_>,
) -> Result<Shape, Located> {
    let text = call.text("text")?.unwrap_or_default();
    let size = call.number("size")?.unwrap_or(10.0);
    let spacing = call.number("spacing")?.unwrap_or(1.0);
    let word = |name| call.text(name).map(Option::unwrap_or_default);
    let font = word("font")?;
    let align = [word("halign")?, word("valign")?];
    let mut buffer = UnicodeBuffer::new();
    buffer.push_str(&text);
    buffer.set_direction(match word("direction")?.as_str() {
        "rtl" => Direction::RightToLeft,
        "ttb" => Direction::TopToBottom,
        "btt" => Direction::BottomToTop,
        _ => Direction::LeftToRight,
    });
    let script = word("script")?;
    let letters = <[u8; 4]>::try_from(script.as_bytes()).ok();
    if let Some(script) =
        letters.and_then(|l| Script::from_iso15924_tag(Letters::from_bytes(&l)))
    {
        buffer.set_script(script);
    }
    if let Ok(language) = word("language")?.parse::<Language>() {
        buffer.set_language(language);
    }
    if text.is_empty() || !size.is_finite() || size <= 0.0 || !spacing.is_finite() {
        return Ok(Shape::Empty);
    }
    let message = "`text` was set without OpenSCAD, which was not found; it would place letters some \
                   hundredths of their size elsewhere where text is aligned, spaced or not left to right";
    reading.warn(call.place(), message);
    let cut = match curve::segments(size, call, reading)? {
        // The curves of letters are short: so many for a part of a turn.
        Some(segments) => Cut::Pieces((segments / 8 + 1).max(2)),
        None => Cut::Within(reading.options.facet_tolerance.min(1e-4 * size)),
    };
    let glyphs = written(buffer, &font, size, cut, call, reading)?;
    let corners: usize = glyphs.iter().flat_map(|g| &g.paths).map(Vec::len).sum();
    reading.count_facets(4 * corners as u64, call.place())?;
    Ok(placed(glyphs, spacing, &align, call))
}

/// The glyphs of a text in the order in which they stand.
fn written(
    buffer: UnicodeBuffer,
    font: &str,
    size: f64,
    cut: Cut,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Vec<Glyph>, Located> {
    let fonts = reading.fonts.get_or_insert_with(|| {
        let mut fonts = Database::new();
        fonts.load_system_fonts();
        fonts
    });
    let missing = || Located::at(call.place(), ReadErrorKind::NoFont);
    let (id, instead) = chosen(fonts, font).ok_or_else(missing)?;
    let glyphs = fonts.with_face_data(id, |data, index| {
        let face = Face::from_slice(data, index)?;
        // Points at 100 dots to the inch.
        let scale = size * 100.0 / 72.0 / f64::from(face.units_per_em());
        let is_upright = !matches!(
            buffer.direction(),
            Direction::TopToBottom | Direction::BottomToTop
        );
        let shaped = rustybuzz::shape(&face, &[], buffer);
        let infos = shaped.glyph_infos().iter().zip(shaped.glyph_positions());
        let glyph = |(info, at): (&rustybuzz::GlyphInfo, &rustybuzz::GlyphPosition)| {
            let pair = |x: i32, y: i32| scale * DVec2::new(x.into(), y.into());
            let mut drawing =
                Drawing { scale, cut, paths: Vec::new(), here: DVec2::ZERO };
            let id = GlyphId(u16::try_from(info.glyph_id).unwrap_or(0));
            let face: &ttf_parser::Face<'_> = &face;
            let _ = face.outline_glyph(id, &mut drawing);
            Glyph {
                paths: drawing.paths,
                offset: pair(at.x_offset, at.y_offset),
                advance: pair(at.x_advance, at.y_advance),
                is_upright,
            }
        };
        Some(infos.map(glyph).collect())
    });
    let Some(Some(glyphs)) = glyphs else { return Err(missing()) };
    if let Some(instead) = instead {
        let (font, instead) = (quoted(font.as_bytes()), quoted(instead.as_bytes()));
        let font = if font == "``" { format!("`{USUAL}`") } else { font };
        let message =
            format!("the font {font} is not installed; `text` is written in {instead}");
        reading.warn(call.place(), message);
    }
    Ok(glyphs)
}

/// The face that a description such as `Liberation Sans:style=Bold` means, and the name of its
/// family if that is another.
fn chosen(fonts: &Database, font: &str) -> Option<(fontdb::ID, Option<String>)> {
    let mut parts = font.split(':');
    let family = parts.next().map(str::trim).filter(|f| !f.is_empty()).unwrap_or(USUAL);
    let style = parts.find_map(|p| p.trim().strip_prefix("style=")).unwrap_or_default();
    let style = style.to_ascii_lowercase();
    let has = |word| style.contains(word);
    let query = Query {
        families: &[Family::Name(family), Family::Name(USUAL), Family::SansSerif],
        weight: if has("bold") { Weight::BOLD } else { Weight::NORMAL },
        stretch: if has("narrow") || has("condensed") {
            Stretch::Condensed
        } else {
            Stretch::Normal
        },
        style: if has("italic") {
            Style::Italic
        } else if has("oblique") {
            Style::Oblique
        } else {
            Style::Normal
        },
    };
    let found = fonts.query(&query);
    let id = found.or_else(|| fonts.faces().next().map(|face| face.id))?;
    let families = &fonts.face(id)?.families;
    let is_it = families.iter().any(|(name, _)| name.eq_ignore_ascii_case(family));
    let name = families.first().map(|(name, _)| name.clone()).unwrap_or_default();
    Some((id, (!is_it).then_some(name)))
}

/// A glyph with its origin at (0, 0), and where it is put and the next one starts.
struct Glyph {
    paths: Vec<Vec<DVec2>>,
    offset: DVec2,
    advance: DVec2,
    is_upright: bool,
}

/// The glyphs one after the other, aligned.
fn placed(
    glyphs: Vec<Glyph>,
    spacing: f64,
    [horizontally, vertically]: &[String; 2],
    call: &Call<'_>,
) -> Shape {
    let (mut width, mut ascent, mut descent) = (0.0_f64, 0.0_f64, 0.0_f64);
    for glyph in &glyphs {
        let points = || glyph.paths.iter().flatten();
        let high = points().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let low = points().map(|p| p.y).fold(f64::INFINITY, f64::min);
        if glyph.is_upright {
            ascent = ascent.max(high);
            descent = descent.max(-low);
            width += spacing * glyph.advance.x;
        } else {
            let right = points().map(|p| p.x).fold(0.0, f64::max);
            let left = points().map(|p| p.x).fold(right, f64::min);
            width = width.max(right - left);
            ascent += spacing * glyph.advance.y;
        }
    }
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
    for glyph in glyphs {
        let origin = at + glyph.offset;
        at += spacing * glyph.advance;
        if !glyph.paths.is_empty() {
            let moved = |path: Vec<DVec2>| path.iter().map(|p| *p + origin).collect();
            outlines.push(Outline::paths(glyph.paths.into_iter().map(moved).collect()));
        }
    }
    if outlines.is_empty() {
        return Shape::Empty;
    }
    let outline = match outlines.len() {
        1 => outlines.swap_remove(0),
        _ => Outline::boolean(Op::Union, outlines),
    };
    Shape::Flat(outline.tagged(Tag::Place(call.place())))
}

/// Into how many lines a curve is cut.
#[derive(Clone, Copy)]
enum Cut {
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
struct Drawing {
    scale: f64,
    cut: Cut,
    paths: Vec<Vec<DVec2>>,
    here: DVec2,
}

impl Drawing {
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
