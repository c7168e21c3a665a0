//! 3MF archives, `.3mf`: objects with names and colours, in millimetres.
//!
//! An archive holds what the core specification asks for (3MF Consortium, "3MF Core
//! Specification" 1.3): the types of its parts, where the model is, and the model. That lists a
//! material for each colour, an object for each mesh, and, if there are several, one object with
//! all of them as components, so that programs that place objects keep these together.

use std::io::{self, Cursor, Write};

use quick_xml::escape::escape;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, System, ZipWriter};

use super::WriteError;
use crate::color::Color;
use crate::mesh::Mesh;
use crate::parts::Part;
use crate::shown::Shown;

/// The parts before the model, which are always the same.
const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
 <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
 <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"#;
const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;
const HEAD: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
 <metadata name="Application">solidray</metadata>
 <resources>
"#;

/// The number of the list of materials; those of objects follow.
const MATERIALS: usize = 1;

/// The level of compression: files are a fifth larger than by default, in a third of the time.
const FASTEST: i64 = 1;

/// An archive with an object for each mesh. Equal meshes make equal bytes.
pub(super) fn bytes(objects: &[(Part, &Mesh)]) -> Result<Vec<u8>, WriteError> {
    let archive = |error: io::Error| WriteError::Archive(error.to_string());
    zipped(objects).map_err(archive)
}

fn zipped(objects: &[(Part, &Mesh)]) -> io::Result<Vec<u8>> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    // Nothing depends on when and where the archive is made.
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(FASTEST))
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644)
        .system(System::Unix);
    for (name, text) in [("[Content_Types].xml", TYPES), ("_rels/.rels", RELATIONSHIPS)] {
        archive.start_file(name, options)?;
        archive.write_all(text.as_bytes())?;
    }
    // Older programs do not know the form that parts of more than 4 GiB need.
    let is_large = most_bytes(objects) > u64::from(u32::MAX);
    archive.start_file("3D/3dmodel.model", options.large_file(is_large))?;
    let mut text = io::BufWriter::new(&mut archive);
    model(&mut text, objects)?;
    text.flush()?;
    drop(text);
    Ok(archive.finish()?.into_inner())
}

/// No less than the length of the text of the model.
fn most_bytes(objects: &[(Part, &Mesh)]) -> u64 {
    /// Three numbers of 24 characters, or of 10 digits, and what is around them; a name and what
    /// else is said of an object.
    const OF: [u64; 3] = [128, 80, 1 << 16];
    let each = objects.iter().map(|(_, mesh)| {
        let counts = [mesh.points().len(), mesh.faces().len(), 1];
        OF.iter().zip(counts).map(|(bytes, count)| bytes * count as u64).sum::<u64>()
    });
    each.sum()
}

/// The text of the model.
fn model(out: &mut dyn Write, objects: &[(Part, &Mesh)]) -> io::Result<()> {
    out.write_all(HEAD.as_bytes())?;
    let colors = colors(objects);
    if !colors.is_empty() {
        writeln!(out, "  <basematerials id=\"{MATERIALS}\">")?;
        for color in &colors {
            writeln!(out, "   <base name=\"{color}\" displaycolor=\"{color}\"/>")?;
        }
        writeln!(out, "  </basematerials>")?;
    }
    for (id, (part, mesh)) in (MATERIALS + 1..).zip(objects) {
        write!(out, "  <object id=\"{id}\" type=\"model\"")?;
        let name = part.name.as_deref().map(printable).unwrap_or_default();
        if !name.is_empty() {
            write!(out, " name=\"{}\"", escape(name.as_str()))?;
        }
        let color = part.color.map(hex);
        if let Some(index) = colors.iter().position(|known| Some(known) == color.as_ref())
        {
            write!(out, " pid=\"{MATERIALS}\" pindex=\"{index}\"")?;
        }
        writeln!(out, ">")?;
        write_mesh(out, mesh)?;
        writeln!(out, "  </object>")?;
    }
    let mut whole = MATERIALS + objects.len();
    if objects.len() > 1 {
        let ids = MATERIALS + 1..=whole;
        whole += 1;
        writeln!(out, "  <object id=\"{whole}\" type=\"model\">\n   <components>")?;
        for id in ids {
            writeln!(out, "    <component objectid=\"{id}\"/>")?;
        }
        writeln!(out, "   </components>\n  </object>")?;
    }
    writeln!(out, " </resources>\n <build>")?;
    if !objects.is_empty() {
        writeln!(out, "  <item objectid=\"{whole}\"/>")?;
    }
    writeln!(out, " </build>\n</model>")
}

fn write_mesh(out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
    writeln!(out, "   <mesh>\n    <vertices>")?;
    for point in mesh.points() {
        let [x, y, z] = point.to_array().map(Shown);
        writeln!(out, "     <vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>")?;
    }
    writeln!(out, "    </vertices>\n    <triangles>")?;
    for [a, b, c] in mesh.faces() {
        writeln!(out, "     <triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>")?;
    }
    writeln!(out, "    </triangles>\n   </mesh>")
}

/// The colours that occur, each once, in the order of the objects.
fn colors(objects: &[(Part, &Mesh)]) -> Vec<String> {
    let mut colors: Vec<String> = Vec::new();
    for color in objects.iter().filter_map(|(part, _)| part.color.map(hex)) {
        if !colors.contains(&color) {
            colors.push(color);
        }
    }
    colors
}

/// A colour as `#RRGGBB`, or as `#RRGGBBAA` if it is not opaque.
fn hex(color: Color) -> String {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is rounded and between 0 and 255"
    )]
    let [r, g, b, a] = color.rgba.map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8);
    let opacity = if a == 255 { String::new() } else { format!("{a:02X}") };
    format!("#{r:02X}{g:02X}{b:02X}{opacity}")
}

/// What XML can write of a name, without control characters and as far as anybody reads it.
fn printable(name: &str) -> String {
    /// The most characters.
    const LONGEST: usize = 1000;
    let is_written = |c: &char| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    name.chars().filter(is_written).take(LONGEST).collect()
}
