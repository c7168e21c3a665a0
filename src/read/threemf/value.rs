//! The values of attributes.

use glam::DAffine3;

use super::super::error::Located;
use super::super::xml::Element;
use crate::color::Color;

/// How many millimetres a unit is.
pub(super) fn millimetres(unit: &str) -> Option<f64> {
    Some(match unit {
        "micron" => 0.001,
        "millimeter" => 1.0,
        "centimeter" => 10.0,
        "inch" => 25.4,
        "foot" => 304.8,
        "meter" => 1000.0,
        _ => return None,
    })
}

/// A number that counts something, or names an object.
pub(super) fn whole(element: &Element<'_>, value: &str) -> Result<u32, Located> {
    value.trim().parse().map_err(|_| element.unexpected("a count", value))
}

/// A length, or an element of a map.
pub(super) fn number(element: &Element<'_>, value: &str) -> Result<f64, Located> {
    let number = value.trim().parse().ok().filter(|x: &f64| x.is_finite());
    number.ok_or_else(|| element.unexpected("a finite number", value))
}

/// A map as the specification writes it: the images of the axes one after the other, and that of
/// the origin.
pub(super) fn transform(element: &Element<'_>, value: &str) -> Result<DAffine3, Located> {
    let mut columns = [0.0; 12];
    let mut words = value.split_ascii_whitespace();
    for column in &mut columns {
        let word =
            words.next().ok_or_else(|| element.unexpected("twelve numbers", value))?;
        *column = number(element, word)?;
    }
    if words.next().is_some() {
        return Err(element.unexpected("twelve numbers", value));
    }
    Ok(DAffine3::from_cols_array(&columns))
}

/// A colour as `#rrggbb` or `#rrggbbaa`.
pub(super) fn hex(text: &str) -> Option<Color> {
    let digits = text.strip_prefix('#')?;
    let value = u32::from_str_radix(digits, 16).ok()?;
    let value = match digits.len() {
        6 => value << 8 | 0xff,
        8 => value,
        _ => return None,
    };
    Some(Color { rgba: value.to_be_bytes().map(|byte| f32::from(byte) / 255.0) })
}
