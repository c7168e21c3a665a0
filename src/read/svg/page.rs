//! The `svg` element: how long its units are, and where they are counted from.

use glam::{DAffine2, DVec2};

use super::super::error::Located;
use super::super::xml::Element;

const INCH: f64 = 25.4;

/// Where a drawing goes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Page {
    /// The map from the drawing, whose y-axis points down, to millimetres.
    pub(super) map: DAffine2,
    /// The corner of the view box, in millimetres, as far as it is in the map.
    pub(super) corner: DVec2,
}

/// A length as it is written.
#[derive(Clone, Copy)]
enum Length {
    Missing,
    /// Millimetres.
    Known(f64),
    /// In units of which OpenSCAD takes as many as the view box has.
    OfBox,
}

impl Page {
    /// The page that an element makes, with so many units in an inch.
    pub(super) fn of(element: &Element<'_>, dpi: f64) -> Result<Self, Located> {
        let mut size = [Length::Missing; 2];
        let (mut view, mut fit) = (None, Fit::default());
        element.attributes(|name, value| {
            match name {
                "width" => size[0] = length(&value, dpi),
                "height" => size[1] = length(&value, dpi),
                "viewBox" => view = view_box(&value),
                "preserveAspectRatio" => fit = Fit::of(&value),
                _ => {}
            }
            Ok(())
        })?;
        let millimetres = |axis: usize| match (size[axis], view) {
            (Length::Known(length), _) => length,
            (Length::Missing, Some((_, view))) => INCH * view[axis] / dpi,
            (Length::OfBox, Some((_, view))) => view[axis],
            (Length::Missing | Length::OfBox, None) => 0.0,
        };
        let size = DVec2::new(millimetres(0), millimetres(1));
        let (mut scale, mut align, mut corner) = (DVec2::ONE, DVec2::ZERO, DVec2::ZERO);
        if let Some((from, extent)) = view {
            corner = from;
            scale = size / extent;
            if let Some(part) = fit.part {
                let even =
                    if fit.is_whole { scale.min_element() } else { scale.max_element() };
                scale = DVec2::splat(even);
                align = part * (size - scale * extent);
            }
        }
        // What is written as the corner's height is added, not taken off.
        let corner = scale * corner;
        let origin = DVec2::new(align.x - corner.x, size.y - align.y - corner.y);
        let mirror = DVec2::new(scale.x, -scale.y);
        let map = DAffine2::from_scale_angle_translation(mirror, 0.0, origin);
        Ok(Self { map, corner })
    }
}

/// How a view box is fitted into a page of another shape.
struct Fit {
    /// Which part of the room that is left is before it; without one it is stretched.
    part: Option<DVec2>,
    /// Whether all of it is on the page, or it covers all of the page.
    is_whole: bool,
}

impl Default for Fit {
    fn default() -> Self {
        Self { part: Some(DVec2::splat(0.5)), is_whole: true }
    }
}

impl Fit {
    fn of(text: &str) -> Self {
        let part = |name: &str| match name {
            "Min" => Some(0.0),
            "Mid" => Some(0.5),
            "Max" => Some(1.0),
            _ => None,
        };
        let mut words = text.split_ascii_whitespace().peekable();
        words.next_if_eq(&"defer");
        let align = words.next().unwrap_or_default();
        let is_whole = match words.next() {
            None | Some("meet") => true,
            Some("slice") => false,
            Some(_) => return Self::default(),
        };
        if words.next().is_some() {
            return Self::default();
        }
        if align == "none" {
            return Self { part: None, is_whole };
        }
        let parts = align.strip_prefix('x').and_then(|rest| rest.split_once('Y'));
        let parts = parts.and_then(|(x, y)| Some(DVec2::new(part(x)?, part(y)?)));
        match parts {
            Some(parts) => Self { part: Some(parts), is_whole },
            None => Self::default(),
        }
    }
}

fn length(text: &str, dpi: f64) -> Length {
    let text = text.trim();
    let unit = text
        .trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-'));
    // An exponent is not a unit.
    let unit = match unit.strip_prefix(['e', 'E']) {
        Some(rest) if !rest.starts_with(['m', 'x']) => rest
            .trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-')),
        _ => unit,
    };
    let number = text[..text.len() - unit.len()].parse::<f64>().ok();
    let Some(number) = number.filter(|x| x.is_finite()) else { return Length::Missing };
    Length::Known(match unit.trim_start() {
        "" => INCH * number / dpi,
        "px" => INCH * number / 96.0,
        "pt" => INCH * number / 72.0,
        "pc" => INCH * number / 6.0,
        "in" => INCH * number,
        "cm" => 10.0 * number,
        "mm" => number,
        "em" | "ex" | "%" => return Length::OfBox,
        _ => return Length::Missing,
    })
}

/// The corner and the size of a view box, if it is one.
fn view_box(text: &str) -> Option<(DVec2, DVec2)> {
    let words = text.split([' ', ',']).filter(|word| !word.is_empty());
    let numbers: Vec<f64> =
        words.take(5).map(str::parse).collect::<Result<_, _>>().ok()?;
    let [x, y, width, height] = numbers[..] else { return None };
    let is_box = numbers.iter().all(|x| x.is_finite()) && width >= 0.0 && height >= 0.0;
    is_box.then(|| (DVec2::new(x, y), DVec2::new(width, height)))
}
