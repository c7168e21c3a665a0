//! What of a model is looked at piece by piece: its parts, or the objects at its top.

use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use solidray::{Color, Part, Place, Solid};

/// Which pieces.
#[derive(
    ValueEnum, Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize,
)]
#[serde(rename_all = "lowercase")]
pub(super) enum By {
    /// What shares a name or a colour
    #[default]
    #[value(alias = "part")]
    Parts,
    /// The operands at the top of the model, named by the line:column of their first leaf
    #[value(alias = "object")]
    Objects,
}

impl By {
    /// What one of them is.
    pub(super) fn noun(self) -> &'static str {
        match self {
            Self::Parts => "part",
            Self::Objects => "object",
        }
    }
}

/// The pieces of a model with what they are called in reports.
pub(super) fn pieces(solid: &Solid, by: By) -> Vec<(String, Solid)> {
    let parts = || solid.parts().into_iter();
    match by {
        By::Parts => parts().map(|(part, solid)| (label(&part), solid)).collect(),
        By::Objects => {
            let name = |(number, (place, solid)): (usize, (Option<Place>, Solid))| {
                let name = match place {
                    Some(Place { line, column }) => format!("{line}:{column}"),
                    None => format!("object {number}"),
                };
                (name, solid)
            };
            (1..).zip(solid.objects()).map(name).collect()
        }
    }
}

/// What a part is called: its name, or else its colour.
pub(super) fn label(part: &Part) -> String {
    if let Some(name) = &part.name {
        return name.to_string();
    }
    part.color.map_or_else(|| "other".to_owned(), hex)
}

/// A colour as #rrggbb, or as #rrggbbaa if it is not opaque.
pub(super) fn hex(color: Color) -> String {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is rounded and between 0 and 255"
    )]
    let [r, g, b, a] = color.rgba.map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8);
    if a == 255 {
        format!("#{r:02x}{g:02x}{b:02x}")
    } else {
        format!("#{r:02x}{g:02x}{b:02x}{a:02x}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_are_labels_of_parts_without_names() {
        let red = Part { name: None, color: Some(Color::rgb(1.0, 0.0, 0.0)) };
        assert_eq!(label(&red), "#ff0000");
        let named = Part { name: Some("lid".into()), ..red };
        assert_eq!(label(&named), "lid");
        let clear =
            Part { name: None, color: Some(Color { rgba: [0.0, 0.0, 1.0, 0.5] }) };
        assert_eq!(label(&clear), "#0000ff80");
        assert_eq!(label(&Part::default()), "other");
    }
}
