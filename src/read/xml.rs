//! The elements of XML texts, with their places.
//!
//! Text between elements, comments and whatever a document type declares are passed over. Of
//! entities only those that XML itself has are known: others are an error where an attribute that
//! is looked at names one, so that nothing is ever expanded.

use std::borrow::Cow;

use quick_xml::XmlVersion;
use quick_xml::events::attributes::AttrError;
use quick_xml::events::{BytesStart, Event};

use super::error::{Located, ReadErrorKind};
use super::words::quoted;
use crate::solid::Place;

/// A cursor over the tags of a text.
pub(super) struct Xml<'a> {
    reader: quick_xml::Reader<&'a [u8]>,
    text: &'a str,
    /// Where the tag that was read last begins.
    at: usize,
    /// How many elements are open.
    depth: usize,
}

/// A tag. Elements without content are opened and closed like others.
pub(super) enum Tag<'a> {
    Open(Element<'a>),
    Close,
}

/// An element that is opened.
pub(super) struct Element<'a> {
    tag: BytesStart<'a>,
    text: &'a str,
    at: usize,
}

impl<'a> Xml<'a> {
    /// The tags of a text in UTF-8.
    pub(super) fn new(bytes: &'a [u8]) -> Result<Self, Located> {
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let known = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
            Located::at(place(&known, known.len()), ReadErrorKind::NotUtf8)
        })?;
        let mut reader = quick_xml::Reader::from_str(text);
        reader.config_mut().expand_empty_elements = true;
        Ok(Self { reader, text, at: 0, depth: 0 })
    }

    /// The next tag; `None` at the end of the text.
    pub(super) fn next(&mut self) -> Result<Option<Tag<'a>>, Located> {
        loop {
            self.at = offset(self.reader.buffer_position());
            let event = self.reader.read_event().map_err(|error| {
                let at = offset(self.reader.error_position());
                fault(place(self.text, at), &error)
            })?;
            match event {
                Event::Start(tag) => {
                    self.depth += 1;
                    let (text, at) = (self.text, self.at);
                    return Ok(Some(Tag::Open(Element { tag, text, at })));
                }
                Event::End(_) => {
                    self.depth = self.depth.saturating_sub(1);
                    return Ok(Some(Tag::Close));
                }
                Event::Eof if self.depth > 0 => {
                    let found = "the end of the file";
                    return Err(Located::syntax(self.place(), "a closing tag", found));
                }
                Event::Eof => return Ok(None),
                Event::Empty(_)
                | Event::Text(_)
                | Event::CData(_)
                | Event::Comment(_)
                | Event::Decl(_)
                | Event::PI(_)
                | Event::DocType(_)
                | Event::GeneralRef(_) => {}
            }
        }
    }

    /// Where the tag that was read last begins.
    pub(super) fn place(&self) -> Place {
        self.place_at(self.at)
    }

    /// The place of a byte. To find it takes as long as the text before it.
    pub(super) fn place_at(&self, at: usize) -> Place {
        place(self.text, at)
    }
}

impl Element<'_> {
    /// The name, with its prefix if it has one.
    pub(super) fn name(&self) -> &str {
        self.tag.name().into_inner()
    }

    /// Calls `each` with the names and values of the attributes, as they are written but for
    /// entities and line breaks.
    pub(super) fn attributes(
        &self,
        mut each: impl FnMut(&str, Cow<'_, str>) -> Result<(), Located>,
    ) -> Result<(), Located> {
        // To look for names given twice would take a time in the square of their number.
        for attribute in self.tag.attributes().with_checks(false) {
            let attribute = attribute
                .map_err(|error: AttrError| fault(self.place(), &error.into()))?;
            let value = attribute
                .normalized_value(XmlVersion::Implicit1_0)
                .map_err(|error| fault(self.place(), &error))?;
            each(attribute.key.into_inner(), value)?;
        }
        Ok(())
    }

    /// The byte where it begins.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Where it begins.
    pub(super) fn place(&self) -> Place {
        place(self.text, self.at)
    }

    /// That something stands in it where something else was due.
    pub(super) fn unexpected(&self, expected: &str, found: &str) -> Located {
        Located::syntax(self.place(), expected, quoted(found.as_bytes()))
    }

    /// That it has no attribute of a name.
    pub(super) fn without(&self, attribute: &str) -> Located {
        let found = quoted(self.name().as_bytes());
        Located::syntax(
            self.place(),
            format!("`{attribute}`"),
            format!("{found} without"),
        )
    }
}

fn fault(place: Place, error: &quick_xml::Error) -> Located {
    // The message may show as much of the text as there is.
    let message: String = error.to_string().chars().take(200).collect();
    Located::at(place, ReadErrorKind::Xml(message))
}

fn offset(position: u64) -> usize {
    usize::try_from(position).unwrap_or(usize::MAX)
}

/// The place of a byte. Lines are counted when somebody asks, which is once a file.
fn place(text: &str, at: usize) -> Place {
    let before = text.get(..at).unwrap_or(text);
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX).saturating_add(1);
    let lines = before.bytes().filter(|&b| b == b'\n').count();
    let line = before.rsplit('\n').next().unwrap_or_default();
    Place { line: count(lines), column: count(line.chars().count()) }
}
