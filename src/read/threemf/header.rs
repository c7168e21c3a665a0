//! The outermost element of a part.

use std::collections::BTreeMap;

use super::super::error::{Located, ReadErrorKind};
use super::super::words::quoted;
use super::super::xml::Element;
use super::value::millimetres;

/// The names of the core specification and of extensions that leave geometry as it is, or are
/// read: materials, objects in other parts, and names for groups of triangles.
const CORE: &str = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
const PRODUCTION: &str =
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
const HARMLESS: [&str; 2] = [
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
];

/// What names mean in a part, and how long its lengths are.
#[derive(Default)]
pub(super) struct Header {
    /// What stands before the names of elements.
    pub(super) core: String,
    /// What stands before the names of attributes of the production extension, if it is known.
    pub(super) production: Option<String>,
    /// Millimetres in a unit.
    pub(super) unit: f64,
}

impl Header {
    /// What an element says, if it is a model that can be read.
    pub(super) fn of(element: &Element<'_>) -> Result<Self, Located> {
        let (mut spaces, mut required) = (BTreeMap::new(), String::new());
        let mut unit = "millimeter".to_owned();
        element.attributes(|name, value| {
            match (name, name.strip_prefix("xmlns:")) {
                ("xmlns", _) => drop(spaces.insert(String::new(), value.into_owned())),
                (_, Some(prefix)) => {
                    spaces.insert(prefix.to_owned(), value.into_owned());
                }
                ("unit", _) => unit = value.into_owned(),
                ("requiredextensions", _) => required = value.into_owned(),
                _ => {}
            }
            Ok(())
        })?;
        let name = element.name();
        let (core, local) = name.split_once(':').unwrap_or(("", name));
        if local != "model" {
            return Err(element.unexpected("`model`", name));
        }
        let space = spaces.get(core).map_or("", String::as_str);
        if space != CORE {
            return Err(element.unexpected(&format!("the namespace `{CORE}`"), space));
        }
        for prefix in required.split_ascii_whitespace() {
            let space = spaces.get(prefix).map_or(prefix, String::as_str);
            if ![CORE, PRODUCTION].contains(&space) && !HARMLESS.contains(&space) {
                let what = format!("the extension {}", quoted(space.as_bytes()));
                let kind = ReadErrorKind::Unsupported(what);
                return Err(Located::at(element.place(), kind));
            }
        }
        let unit = millimetres(&unit).ok_or_else(|| {
            let known = "a unit of `micron`, `millimeter`, `centimeter`, `inch`, `foot` or `meter`";
            element.unexpected(known, &unit)
        })?;
        let mut spaces = spaces.iter();
        let production = spaces.find(|(_, known)| *known == PRODUCTION);
        let production = production.map(|(prefix, _)| prefix.clone());
        Ok(Self { core: core.to_owned(), production, unit })
    }
}
