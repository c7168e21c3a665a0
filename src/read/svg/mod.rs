//! `.svg` drawings as OpenSCAD 2021.01 takes them: shapes by their outlines, filled even-odd
//! whatever colour they have or have not, and open lines by their strokes.
//!
//! ```text
//!  xml ── page ──► what a unit is, and where
//!   └──── shape ──► lines of each element ── mod ──► Outline
//!          path, transform, stroke
//! ```
//!
//! What it does not know (`use`, `style` elements, `display`, units at shapes) is as nothing, what
//! it ignores is ignored, and its page is the last `svg` element of the text. Drawings of which it
//! makes something that no rule explains are left to it.
//!
//! The crate `usvg` is not used: it draws what the specification says, which is another thing,
//! and `svgtypes` reads numbers and lengths that OpenSCAD takes for zero.

mod page;
mod path;
mod shape;
mod stroke;
mod transform;

use glam::{DAffine2, DVec2};

use super::error::{Located, ReadErrorKind};
use super::outline::{Outline, Shape};
use super::xml::{Element, Tag, Xml};
use crate::op::Op;
use page::Page;
use shape::Drawn;

/// How a drawing is imported.
#[derive(Clone, Copy, Debug)]
pub(super) struct Import {
    /// The units that have no name in an inch.
    pub(super) dpi: f64,
    /// Whether the middle of the drawing goes to the origin.
    pub(super) center: bool,
    /// How far lines may be from curves; without it curves are cut as OpenSCAD does.
    pub(super) tolerance: Option<f64>,
}

/// How curves are cut where they are drawn.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// How far lines may be from curves, in the units there.
    tolerance: Option<f64>,
}

/// The plane shape that a text draws, if any. `count` is told how many lines there are.
pub(super) fn read(
    bytes: &[u8],
    import: &Import,
    count: &mut dyn FnMut(usize) -> Result<(), Located>,
) -> Result<Option<Outline>, Located> {
    let page = page(bytes, import)?;
    let mut xml = Xml::new(bytes)?;
    let mut shapes = Vec::new();
    // The maps within the open elements, and how many of these are containers.
    let mut open: Vec<(DAffine2, usize)> = vec![(DAffine2::IDENTITY, 0)];
    let mut names: Vec<bool> = Vec::new();
    let mut is_defined = false;
    while let Some(tag) = xml.next()? {
        let Tag::Open(element) = tag else {
            open.pop();
            if names.pop() == Some(true) {
                is_defined = false;
            }
            continue;
        };
        let (outer, depth) = open.last().copied().unwrap_or((DAffine2::IDENTITY, 0));
        let name = element.name();
        names.push(name == "defs");
        is_defined |= name == "defs";
        let is_container = matches!(name, "svg" | "g" | "text" | "tspan");
        let is_drawn = !is_defined && shape::is_known(name);
        if !is_container && !is_drawn {
            open.push((outer, depth));
            continue;
        }
        let attributes = shape::Attributes::of(&element)?;
        // The outermost element has no map, and pages have none.
        let own = if depth == 0 || name == "svg" {
            DAffine2::IDENTITY
        } else {
            transform::map(&attributes.transform)
        };
        let map = outer * own;
        if is_container {
            open.push((map, depth + 1));
            continue;
        }
        open.push((outer, depth));
        let in_page = page.map * map;
        let cut = Cut { tolerance: import.tolerance.map(|t| t / stretch(&in_page)) };
        let drawn = shape::drawn(name, &attributes, &cut)
            .map_err(|what| unsupported(&element, &what))?;
        count(drawn.size())?;
        shapes.extend(
            placed(drawn, &in_page)
                .ok_or_else(|| unsupported(&element, "a shape without finite places"))?,
        );
    }
    if shapes.is_empty() {
        return Ok(None);
    }
    let all = Outline::boolean(Op::Union, shapes);
    if !import.center {
        return Ok(Some(all));
    }
    let Some([low, high]) = all.bounds_of_union() else { return Ok(Some(all)) };
    let middle = 0.5 * (low + high) - page.map.translation;
    // The corner of the page's box is taken off twice, or not at all: so OpenSCAD does it.
    let shift = -page.map.translation - middle - page.corner;
    Ok(Some(all.mapped(DAffine2::from_translation(shift))))
}

/// The page of a text: the last one counts.
fn page(bytes: &[u8], import: &Import) -> Result<Page, Located> {
    let mut xml = Xml::new(bytes)?;
    let mut page = None;
    while let Some(tag) = xml.next()? {
        if let Tag::Open(element) = tag
            && element.name() == "svg"
        {
            page = Some(Page::of(&element, import.dpi)?);
        }
    }
    Ok(page.unwrap_or_default())
}

/// How much longer a map makes lengths, at most.
fn stretch(map: &DAffine2) -> f64 {
    let [x, y] = [map.matrix2.x_axis, map.matrix2.y_axis];
    (x.length_squared() + y.length_squared()).sqrt()
}

/// A shape in its place; nothing if it has no area, `None` if it is nowhere.
fn placed(drawn: Drawn, map: &DAffine2) -> Option<Option<Outline>> {
    match drawn {
        Drawn::Ellipse { center, radii } => {
            let scale = DAffine2::from_scale_angle_translation(radii, 0.0, center);
            let map = *map * scale;
            if !map.is_finite() {
                return None;
            }
            let disc = Outline::shape(Shape::Circle { radius: 1.0 });
            let has_area = map.matrix2.determinant().abs() > 0.0;
            Some(has_area.then(|| disc.mapped(map)))
        }
        Drawn::Lines(mut paths) => {
            let points = paths.iter_mut().flatten();
            points.for_each(|p: &mut DVec2| *p = map.transform_point2(*p));
            if !paths.iter().flatten().all(|p| p.is_finite()) {
                return None;
            }
            paths.retain(|path| path.len() > 2);
            Some((!paths.is_empty()).then(|| Outline::paths(paths)))
        }
    }
}

fn unsupported(element: &Element<'_>, what: &str) -> Located {
    let kind = ReadErrorKind::Unsupported(format!("{what} in .svg files"));
    Located::at(element.place(), kind)
}
