//! Fonts by their descriptions.

use fontdb::{Database, Family, Query, Stretch, Style, Weight};

/// What OpenSCAD writes with unless told otherwise.
pub(super) const USUAL: &str = "Liberation Sans";

/// The face that a description such as `Liberation Sans:style=Bold` means, and the name of its
/// family if that is another.
pub(super) fn chosen(
    fonts: &Database,
    font: &str,
) -> Option<(fontdb::ID, Option<String>)> {
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
