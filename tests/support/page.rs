//! The pages that `compare --report` writes, as a strict reader sees them.

use std::io::Cursor;

use base64::prelude::{BASE64_STANDARD, Engine};
use image::RgbImage;
use quick_xml::escape::unescape;
use quick_xml::events::{BytesStart, Event};

use super::desk::Desk;

/// A page, taken apart.
pub(crate) struct Page {
    pub(crate) html: String,
    /// Name and attributes of every tag.
    pub(crate) tags: Vec<(String, Vec<(String, String)>)>,
    /// What is within each tag, without the tags in it.
    texts: Vec<(String, String)>,
}

impl Page {
    pub(crate) fn read(desk: &Desk, name: &str) -> Self {
        let html = std::fs::read_to_string(desk.path(name)).expect("a page");
        let mut reader = quick_xml::Reader::from_str(&html);
        let (mut tags, mut texts) = (Vec::new(), Vec::new());
        let mut open: Vec<(String, String)> = Vec::new();
        loop {
            // Tags that are not closed in order are an error here.
            match reader.read_event().expect("a well-formed page") {
                Event::Start(tag) => {
                    let (name, attributes) = parts(&tag);
                    open.push((name.clone(), String::new()));
                    tags.push((name, attributes));
                }
                Event::Empty(tag) => tags.push(parts(&tag)),
                Event::End(_) => texts.extend(open.pop()),
                Event::Text(text) => {
                    if let Some((_, all)) = open.last_mut() {
                        all.push_str(&text);
                    }
                }
                Event::GeneralRef(name) => {
                    let text =
                        unescape(&format!("&{};", &*name)).expect("known").into_owned();
                    open.last_mut().expect("in a tag").1.push_str(&text);
                }
                Event::DocType(_) => {}
                Event::Eof => break,
                other @ (Event::CData(_)
                | Event::Comment(_)
                | Event::Decl(_)
                | Event::PI(_)) => panic!("{other:?}"),
            }
        }
        assert!(open.is_empty());
        Self { html, tags, texts }
    }

    pub(crate) fn all(&self, tag: &str) -> Vec<&str> {
        self.texts
            .iter()
            .filter(|(name, _)| name == tag)
            .map(|(_, text)| text.as_str())
            .collect()
    }

    /// The commands in it.
    pub(crate) fn commands(&self) -> Vec<&str> {
        self.all("code")
            .into_iter()
            .filter(|text| text.starts_with("solidray "))
            .collect()
    }

    pub(crate) fn pictures(&self) -> Vec<RgbImage> {
        let images = self.tags.iter().filter(|(name, _)| name == "img");
        let sources = images.map(|(_, attributes)| attribute(attributes, "src"));
        sources
            .map(|source| {
                let png =
                    source.strip_prefix("data:image/png;base64,").expect("in the page");
                let bytes = BASE64_STANDARD.decode(png).expect("base64");
                let format = image::ImageFormat::Png;
                let picture = image::load(Cursor::new(bytes), format).expect("a picture");
                picture.into_rgb8()
            })
            .collect()
    }
}

fn parts(tag: &BytesStart<'_>) -> (String, Vec<(String, String)>) {
    let name = tag.name().as_ref().to_owned();
    let attributes = tag.attributes().map(|attribute| {
        let attribute = attribute.expect("well-formed");
        let key = attribute.key.as_ref().to_owned();
        (key, unescape(&attribute.value).expect("known references").into_owned())
    });
    (name, attributes.collect())
}

pub(crate) fn attribute<'a>(attributes: &'a [(String, String)], name: &str) -> &'a str {
    let found = attributes.iter().find(|(key, _)| key == name);
    &found.unwrap_or_else(|| panic!("no {name} in {attributes:?}")).1
}
