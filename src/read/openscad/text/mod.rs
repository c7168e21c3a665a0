//! `text`: shaped by `HarfBuzz`'s rules, in outlines of installed fonts.

mod drawing;
mod em;
mod font;
mod line;

use fontdb::Database;
use rustybuzz::ttf_parser::{GlyphId, Tag as Letters};
use rustybuzz::{
    Direction, Face, GlyphInfo, GlyphPosition, Language, Script, UnicodeBuffer,
};

use super::super::error::{Located, ReadErrorKind};
use super::super::words::quoted;
use super::arguments::Call;
use super::curve;
use super::evaluate::Reading;
use super::node::Shape;
use crate::solid::Tag;

use drawing::{Cut, Drawing};
use em::Em;
use font::{USUAL, chosen};
use line::{Glyph, Line};

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

/// The letters of a text as outlines.
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
    let cut = match curve::segments(size, call, reading)? {
        // The curves of letters are short: so many for a part of a turn.
        Some(segments) => Cut::Pieces((segments / 8 + 1).max(2)),
        None => {
            reading.is_fine.set(true);
            Cut::Within(reading.options.facet_tolerance.min(1e-4 * size))
        }
    };
    let line = written(buffer, &font, size, cut, call, reading)?;
    reading.count_facets(4 * line.corners() as u64, call.place())?;
    let outline = line.set(spacing, &align);
    Ok(match outline {
        Some(outline) => Shape::Flat(outline.tagged(Tag::Place(call.place()))),
        None => Shape::Empty,
    })
}

/// A text in its font.
fn written(
    buffer: UnicodeBuffer,
    font: &str,
    size: f64,
    cut: Cut,
    call: &Call<'_>,
    reading: &mut Reading<'_>,
) -> Result<Line, Located> {
    let fonts = reading.fonts.get_or_insert_with(|| {
        let mut fonts = Database::new();
        fonts.load_system_fonts();
        fonts
    });
    let missing = || Located::at(call.place(), ReadErrorKind::NoFont);
    let (id, instead) = chosen(fonts, font).ok_or_else(missing)?;
    let line = fonts.with_face_data(id, |data, index| {
        let face = Face::from_slice(data, index)?;
        let em = Em::new(&face, size);
        let direction = buffer.direction();
        let is_column =
            matches!(direction, Direction::TopToBottom | Direction::BottomToTop);
        let shaped = rustybuzz::shape(&face, &[], buffer);
        let infos = shaped.glyph_infos().iter().zip(shaped.glyph_positions());
        let glyph = |(info, at): (&GlyphInfo, &GlyphPosition)| {
            let id = GlyphId(u16::try_from(info.glyph_id).unwrap_or(0));
            let paths = Drawing::of(&face, id, em.unit(), cut);
            match is_column {
                true => Glyph::in_column(paths, id, em, &face),
                false => Glyph::in_line(paths, at, em),
            }
        };
        let glyphs = infos.map(glyph).collect();
        Some(Line { glyphs, em, is_column })
    });
    let Some(Some(line)) = line else { return Err(missing()) };
    if let Some(instead) = instead {
        let (font, instead) = (quoted(font.as_bytes()), quoted(instead.as_bytes()));
        let font = if font == "``" { format!("`{USUAL}`") } else { font };
        let message =
            format!("the font {font} is not installed; `text` is written in {instead}");
        reading.warn(call.place(), message);
    }
    Ok(line)
}
