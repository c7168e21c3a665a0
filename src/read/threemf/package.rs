//! The parts of an archive, by the rules of open packages (ECMA-376, part 2).

use std::io::Cursor;

use zip::ZipArchive;
use zip::result::ZipError;

use super::super::error::{Located, ReadErrorKind};
use super::super::load::Budget;
use super::super::xml::{Tag, Xml};

/// Where the part that says what the archive is about is named.
const RELATIONSHIPS: &str = "_rels/.rels";
/// The kind of the part with the model.
const MODEL: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/// An open archive.
pub(super) struct Package<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
}

impl<'a> Package<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Located> {
        match ZipArchive::new(Cursor::new(bytes)) {
            Ok(archive) => Ok(Self { archive }),
            Err(error) => Err(Located::nowhere(fault(&error))),
        }
    }

    /// The name of the part that describes the model.
    pub(super) fn start(&mut self, budget: &mut Budget) -> Result<String, Located> {
        let bytes = self.part(RELATIONSHIPS, budget).map_err(Located::nowhere)?;
        start(&bytes).map_err(|error| error.within(RELATIONSHIPS))
    }

    /// The bytes of a part. How many there are is not known before they are there, whatever the
    /// archive declares.
    pub(super) fn part(
        &mut self,
        name: &str,
        budget: &mut Budget,
    ) -> Result<Vec<u8>, ReadErrorKind> {
        let name = name.strip_prefix('/').unwrap_or(name);
        let Some(index) = self.archive.index_for_name(name) else {
            return Err(ReadErrorKind::NoPart(name.into()));
        };
        let file = self.archive.by_index(index).map_err(|error| fault(&error))?;
        match budget.drain(file, 0) {
            Err(ReadErrorKind::Io(error)) => {
                Err(ReadErrorKind::Archive(error.to_string()))
            }
            drained => drained,
        }
    }
}

/// The target of the relationship to the model.
fn start(bytes: &[u8]) -> Result<String, Located> {
    let mut xml = Xml::new(bytes)?;
    while let Some(tag) = xml.next()? {
        let Tag::Open(element) = tag else { continue };
        if element.name() != "Relationship" {
            continue;
        }
        let (mut kind, mut target) = (String::new(), None);
        element.attributes(|name, value| {
            match name {
                "Type" => kind = value.into_owned(),
                "Target" => target = Some(value.into_owned()),
                _ => {}
            }
            Ok(())
        })?;
        if kind == MODEL {
            return target.ok_or_else(|| element.without("Target"));
        }
    }
    Err(Located::syntax(xml.place(), "a relationship to a 3D model", "none"))
}

fn fault(error: &ZipError) -> ReadErrorKind {
    ReadErrorKind::Archive(error.to_string())
}
