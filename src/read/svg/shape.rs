//! The elements that are drawn.

use glam::DVec2;

use super::super::error::Located;
use super::super::xml::Element;
use super::Cut;
use super::path::{self, Pen};
use super::stroke::Stroke;

/// What an element draws, in its own units.
pub(super) enum Drawn {
    /// Closed lines, whose inside is even-odd.
    Lines(Vec<Vec<DVec2>>),
    /// A true ellipse.
    Ellipse { center: DVec2, radii: DVec2 },
}

impl Drawn {
    /// Of how many lines it is made.
    pub(super) fn size(&self) -> usize {
        match self {
            Self::Lines(paths) => paths.iter().map(Vec::len).sum(),
            Self::Ellipse { .. } => 1,
        }
    }
}

/// What is written at an element, as far as it matters.
#[derive(Debug, Default)]
pub(super) struct Attributes {
    pub(super) transform: String,
    stroke: Stroke,
    /// The lines of a path or the points of a polygon.
    lines: String,
    /// Lengths by their names.
    numbers: Vec<(&'static str, f64)>,
}

/// The names of lengths.
const LENGTHS: [&str; 13] =
    ["x", "y", "width", "height", "rx", "ry", "cx", "cy", "r", "x1", "y1", "x2", "y2"];

impl Attributes {
    pub(super) fn of(element: &Element<'_>) -> Result<Self, Located> {
        let (mut found, mut style) = (Self::default(), String::new());
        let lines = if element.name() == "path" { "d" } else { "points" };
        element.attributes(|name, value| {
            match name {
                "transform" => found.transform = value.into_owned(),
                "stroke-width" => found.stroke.width = value.into_owned(),
                "stroke-linecap" => found.stroke.cap = value.into_owned(),
                "stroke-linejoin" => found.stroke.join = value.into_owned(),
                "style" => style = value.into_owned(),
                _ if name == lines => found.lines = value.into_owned(),
                _ => {
                    let known = LENGTHS.iter().find(|known| **known == name);
                    found.numbers.extend(known.map(|known| (*known, number(&value))));
                }
            }
            Ok(())
        })?;
        let stroke = &mut found.stroke;
        for (name, place) in [
            ("stroke-width", &mut stroke.width),
            ("stroke-linecap", &mut stroke.cap),
            ("stroke-linejoin", &mut stroke.join),
        ] {
            if place.is_empty() {
                style_of(&style, name).clone_into(place);
            }
        }
        Ok(found)
    }

    fn number(&self, name: &str) -> f64 {
        let found = self.numbers.iter().rev().find(|(known, _)| *known == name);
        found.map_or(0.0, |(_, number)| *number)
    }

    fn point(&self, x: &str, y: &str) -> DVec2 {
        DVec2::new(self.number(x), self.number(y))
    }
}

/// The value of a property in a list of them; spaces belong to names and values.
fn style_of<'a>(style: &'a str, name: &str) -> &'a str {
    let pairs = style.split(';').filter_map(|pair| pair.split_once(':'));
    let mut values =
        pairs.filter(|(known, value)| *known == name && !value.contains(':'));
    values.next().map_or("", |(_, value)| value)
}

/// A number that is all of a text; other texts are 0.
pub(super) fn number(text: &str) -> f64 {
    text.parse().unwrap_or(0.0)
}

/// Whether elements of a name are drawn.
pub(super) fn is_known(name: &str) -> bool {
    let known = ["path", "rect", "circle", "ellipse", "line", "polyline", "polygon"];
    known.contains(&name)
}

/// What an element draws, or what about it is not understood.
pub(super) fn drawn(
    name: &str,
    attributes: &Attributes,
    cut: &Cut,
) -> Result<Drawn, String> {
    let stroke = &attributes.stroke;
    Ok(match name {
        "path" => Drawn::Lines(path::lines(&attributes.lines, stroke, cut)?),
        "rect" => rect(attributes, cut)?,
        "circle" => {
            let radius = attributes.number("r");
            ellipse(attributes.point("cx", "cy"), DVec2::splat(radius), cut)
        }
        "ellipse" => {
            ellipse(attributes.point("cx", "cy"), attributes.point("rx", "ry"), cut)
        }
        "line" => {
            let ends = [attributes.point("x1", "y1"), attributes.point("x2", "y2")];
            Drawn::Lines(stroke.around(&ends)?)
        }
        "polyline" => Drawn::Lines(stroke.around(&points(&attributes.lines))?),
        _ => Drawn::Lines(vec![points(&attributes.lines)]),
    })
}

/// The points of a polygon.
fn points(text: &str) -> Vec<DVec2> {
    let words = text.split([' ', ',']).filter(|word| !word.is_empty());
    let numbers: Vec<f64> = words.map(number).collect();
    let (pairs, _) = numbers.as_chunks::<2>();
    pairs.iter().map(|pair| DVec2::from_array(*pair)).collect()
}

fn ellipse(center: DVec2, radii: DVec2, cut: &Cut) -> Drawn {
    /// The corners of OpenSCAD's circles and ellipses, of whatever size.
    const CORNERS: u32 = 40;
    if cut.tolerance.is_some() {
        return Drawn::Ellipse { center, radii };
    }
    let corner = |i| {
        let angle = f64::from(i) * std::f64::consts::TAU / f64::from(CORNERS);
        center + radii * DVec2::new(angle.sin(), angle.cos())
    };
    Drawn::Lines(vec![(1..=CORNERS).map(corner).collect()])
}

/// A rectangle, with elliptic corners if it has radii: at most half its sides, and both equal if
/// one is missing.
fn rect(attributes: &Attributes, cut: &Cut) -> Result<Drawn, String> {
    let (low, size) = (attributes.point("x", "y"), attributes.point("width", "height"));
    let high = low + size;
    let mut radii = attributes.point("rx", "ry");
    let is_missing = |r: f64| r.abs() < 1e-8;
    if is_missing(radii.x) && is_missing(radii.y) {
        let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
        return Ok(Drawn::Lines(vec![corners.to_vec()]));
    }
    if is_missing(radii.x) {
        radii.x = radii.y;
    } else if is_missing(radii.y) {
        radii.y = radii.x;
    }
    let radii = radii.min(0.5 * size);
    let mut pen = Pen::default();
    pen.line(DVec2::new(low.x + radii.x, low.y));
    for (corner, from, to) in [
        (DVec2::new(high.x, low.y), DVec2::new(-1.0, 0.0), DVec2::new(0.0, 1.0)),
        (high, DVec2::new(0.0, -1.0), DVec2::new(-1.0, 0.0)),
        (DVec2::new(low.x, high.y), DVec2::new(1.0, 0.0), DVec2::new(0.0, -1.0)),
        (low, DVec2::new(0.0, 1.0), DVec2::new(1.0, 0.0)),
    ] {
        pen.line(corner + radii * from);
        pen.arc(radii, 0.0, [false, true], corner + radii * to, cut)?;
    }
    Ok(Drawn::Lines(vec![pen.into_points()]))
}
