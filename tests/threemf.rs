//! `.3mf`: what archives mean, what is refused, and that hostile ones cost little.

use std::io::{Cursor, Write};
use std::path::Path;
use std::time::Instant;

use glam::{DVec3, dvec3};
use solidray::read::{self, Format, Model, ReadError, ReadErrorKind, ReadOptions};
use solidray::{CompileError, Scene, Solid};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

#[path = "support/openscad.rs"]
mod openscad;

const CORE: &str = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Target="/3D/3dmodel.model" Id="rel0"
  Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"#;

/// An archive of parts.
fn zipped<T: AsRef<[u8]>>(parts: &[(&str, T)]) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in parts {
        let options =
            SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
        archive.start_file(*name, options).expect("room");
        archive.write_all(text.as_ref()).expect("room");
    }
    archive.finish().expect("room").into_inner()
}

/// What OpenSCAD wants to know of archives.
const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
 <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
 <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>"#;

/// An archive with a model.
fn archive(model: &str) -> Vec<u8> {
    zipped(&[
        ("[Content_Types].xml", TYPES),
        ("_rels/.rels", RELATIONSHIPS),
        ("3D/3dmodel.model", model),
    ])
}

/// An archive with resources and a build.
fn holding(attributes: &str, resources: &str, build: &str) -> Vec<u8> {
    archive(&format!(
        "<?xml version=\"1.0\"?>\n<model {attributes} xmlns=\"{CORE}\">\n\
         <resources>{resources}</resources>\n<build>{build}</build></model>"
    ))
}

/// The mesh of a box from the origin.
fn cuboid(size: DVec3) -> String {
    let mut text = "<mesh><vertices>".to_owned();
    for corner in 0..8 {
        let [x, y, z] =
            [0, 1, 2].map(|i| if corner >> i & 1 == 1 { size[i] } else { 0.0 });
        text += &format!("<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>");
    }
    text += "</vertices><triangles>";
    for [a, b, c, d] in [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ] {
        for [i, j, k] in [[a, b, c], [a, c, d]] {
            text += &format!("<triangle v1=\"{i}\" v2=\"{j}\" v3=\"{k}\"/>");
        }
    }
    text + "</triangles></mesh>"
}

fn object(id: u32, more: &str, content: &str) -> String {
    format!("<object id=\"{id}\" {more}>{content}</object>")
}

fn bytes(archive: &[u8]) -> Result<Model, ReadError> {
    let path = Path::new("part.3mf");
    read::bytes(archive, path, Format::ThreeMf, &ReadOptions::default())
}

fn solid(archive: &[u8]) -> Solid {
    bytes(archive).expect("it is sound").solid
}

fn refused(archive: &[u8]) -> String {
    bytes(archive).expect_err("it is wrong").to_string()
}

#[track_caller]
fn assert_bounds(archive: &[u8], min: DVec3, max: DVec3) {
    let bounds = Scene::compile(&solid(archive)).expect("it is bounded").bounds();
    let is_near = (bounds.min - min).abs().max_element() < 1e-9
        && (bounds.max - max).abs().max_element() < 1e-9;
    assert!(is_near, "{bounds:?}");
}

#[test]
fn units_maps_and_components_place_meshes() {
    let one = object(1, "", &cuboid(dvec3(1.0, 2.0, 3.0)));
    let item = "<item objectid=\"1\"/>";
    let size = dvec3(1.0, 2.0, 3.0);
    assert_bounds(&holding("", &one, item), DVec3::ZERO, size);
    for (unit, length) in [
        ("micron", 0.001),
        ("millimeter", 1.0),
        ("centimeter", 10.0),
        ("inch", 25.4),
        ("foot", 304.8),
        ("meter", 1000.0),
    ] {
        let file = holding(&format!("unit=\"{unit}\""), &one, item);
        assert_bounds(&file, DVec3::ZERO, length * size);
    }
    // A quarter turn about the z-axis, then a step.
    let turned = "<item objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 10 20 30\"/>";
    let file = holding("", &one, turned);
    assert_bounds(&file, dvec3(8.0, 20.0, 30.0), dvec3(10.0, 21.0, 33.0));

    let two = "<components><component objectid=\"1\"/>\
               <component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 4 0 0\"/></components>";
    let both = one.clone() + &object(2, "name=\"pair\"", two);
    let item = "<item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 -1 0 0 0\"/>";
    let file = holding("unit=\"centimeter\"", &both, item);
    assert_bounds(&file, dvec3(0.0, 0.0, -30.0), dvec3(50.0, 20.0, 0.0));
    let volume = openscad::enclosed(&solid(&file));
    assert!((volume - 12_000.0).abs() < 1e-6, "{volume}");
}

#[test]
fn objects_are_parts_with_names_and_colours() {
    let materials = "<basematerials id=\"7\"><base name=\"red\" displaycolor=\"#FF0000\"/>\
                     <base name=\"glass\" displaycolor=\"#0000FF80\"/></basematerials>";
    let cube = cuboid(DVec3::ONE);
    let objects = materials.to_owned()
        + &object(1, "name=\"left &amp; low\" pid=\"7\" pindex=\"0\"", &cube)
        + &object(2, "name=\"right\" pid=\"7\" pindex=\"1\"", &cube);
    let items = "<item objectid=\"1\"/>\
                 <item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/>";
    let file = holding("", &objects, items);
    let parts: Vec<String> = solid(&file)
        .parts()
        .iter()
        .map(|(part, _)| {
            let color = part.color.map(|color| color.rgba);
            format!("{:?} {color:?}", part.name)
        })
        .collect();
    assert_eq!(
        parts,
        [
            "Some(\"left & low\") Some([1.0, 0.0, 0.0, 1.0])",
            "Some(\"right\") Some([0.0, 0.0, 1.0, 0.5019608])"
        ]
    );
}

/// As programs write that keep every object in a file of its own.
#[test]
fn objects_may_be_in_other_parts() {
    let production = "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" \
                      requiredextensions=\"p\"";
    let two = "<components><component p:path=\"/3D/Objects/a.model\" objectid=\"1\" \
               transform=\"1 0 0 0 1 0 0 0 1 4 0 0\"/></components>";
    let main = |resources: &str| {
        format!(
            "<model {production} xmlns=\"{CORE}\"><resources>{resources}</resources>\
             <build><item objectid=\"2\"/></build></model>"
        )
    };
    let other = |resources: &str| {
        format!(
            "<m:model {production} xmlns:m=\"{CORE}\"><m:resources>{resources}</m:resources></m:model>"
        )
    };
    let cube = object(1, "", &cuboid(DVec3::ONE));
    let prefixed =
        cube.replace("</", "</m:").replace('<', "<m:").replace("<m:/m:", "</m:");
    let all = |main: &str, other: &str| {
        zipped(&[
            ("_rels/.rels", RELATIONSHIPS),
            ("3D/3dmodel.model", main),
            ("3D/Objects/a.model", other),
        ])
    };
    let main = main(&object(2, "", two));
    let file = all(&main, &other(&prefixed));
    assert_bounds(&file, dvec3(4.0, 0.0, 0.0), dvec3(5.0, 1.0, 1.0));

    let third = "<m:object id=\"1\"><m:components><m:component objectid=\"1\" \
                 p:path=\"/3D/b.model\"/></m:components></m:object>";
    assert!(
        refused(&all(&main, &other(third)))
            .ends_with("expected no reference to a third part, found `/3D/b.model`")
    );
    let itself = main.replace("/3D/Objects/a.model", "/3D/3dmodel.model");
    assert_eq!(
        refused(&archive(&itself)),
        "part.3mf: 3D/3dmodel.model:1:210: expected the id of an object before this, found `1`"
    );
    assert_eq!(
        refused(&archive(&main)),
        "part.3mf: 3D/3dmodel.model:1:210: the archive has no part `3D/Objects/a.model`"
    );
}

#[test]
fn what_is_not_the_model_is_left_out_and_said() {
    let cube = cuboid(DVec3::ONE);
    let objects = object(1, "", &cube)
        + &object(2, "type=\"support\"", &cube)
        + &object(3, "type=\"other\"", &cube)
        + &object(
            4,
            "",
            "<components><component objectid=\"1\"/><component objectid=\"3\"/></components>",
        );
    let items = "<item objectid=\"4\"/><item objectid=\"2\"/><item objectid=\"2\"/>";
    let model = bytes(&holding("", &objects, items)).expect("it is sound");
    assert_eq!(model.solid.census().leaves, 1);
    let said: Vec<String> = model.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        [
            "objects of type `support` are left out 2 times",
            "objects of type `other` are left out 1 times"
        ]
    );
}

#[test]
fn what_is_wrong_is_said_with_its_part_and_line() {
    let cube = cuboid(DVec3::ONE);
    let item = "<item objectid=\"1\"/>";
    let in_build = |item: &str| holding("", &object(1, "", &cube), item);
    let in_object = |text: &str| holding("", &object(1, "name=\"lid\"", text), item);
    let resources = |text: &str| holding("", text, "");
    let cases = [
        (b"no archive".to_vec(), ": not a sound zip archive: "),
        (zipped::<&str>(&[]), ": the archive has no part `_rels/.rels`"),
        (
            zipped(&[("_rels/.rels", RELATIONSHIPS)]),
            ": the archive has no part `3D/3dmodel.model`",
        ),
        (
            zipped(&[("_rels/.rels", "<Relationships/>")]),
            ": _rels/.rels:1:17: expected a relationship to a 3D model, found none",
        ),
        (
            archive(""),
            ": 3D/3dmodel.model:1:1: expected `model`, found the end of the file",
        ),
        (archive("<a/>"), ": 3D/3dmodel.model:1:1: expected `model`, found `a`"),
        (resources("</a>"), ":3:12: not sound XML: "),
        (
            archive("<model/>"),
            ": 3D/3dmodel.model:1:1: expected the namespace `http://schemas.microsoft.com/",
        ),
        (holding("unit=\"ell\"", "", ""), ":2:1: expected a unit of `micron`"),
        (
            holding("xmlns:b=\"beams\" requiredextensions=\"b\"", "", ""),
            ":2:1: the extension `beams` is not supported yet",
        ),
        (in_build("<item/>"), ":4:8: expected `objectid`, found `item` without"),
        (
            in_build("<item objectid=\"2\"/>"),
            ":4:8: expected the id of an object before this, found `2`",
        ),
        (
            in_build("<item objectid=\"1\" transform=\"1 2\"/>"),
            ":4:8: expected twelve numbers, found `1 2`",
        ),
        (
            in_build("<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 0 0 nan\"/>"),
            ":4:8: expected a finite number, found `nan`",
        ),
        (in_build("<item objectid=\"&huge;\"/>"), ":4:8: not sound XML: "),
        (resources("<object/>"), ":3:12: expected `id`, found `object` without"),
        (
            resources("<object id=\"1\"/><object id=\"1\"/>"),
            ":3:28: expected an id that no other object has, found `1`",
        ),
        (resources("<object id=\"1\" type=\"x\"/>"), ":3:12: expected a type of `model`"),
        (
            in_object("<components><component objectid=\"1\"/></components>"),
            ": expected the id of an object before this, found `1`",
        ),
        (in_object("<mesh/>"), ":3:12: object 1 `lid`: the mesh has no faces"),
        (
            in_object(&cube.replace("<triangle v1=\"0\" v2=\"2\" v3=\"3\"/>", "")),
            ":3:12: object 1 `lid`: ",
        ),
        (
            in_object(&cube.replace("v3=\"3\"", "v3=\"8\"")),
            ": expected the index of one of 8 vertices, found `8`",
        ),
        (in_object(&cube.replace("x=\"1\"", "")), ": expected `x`, `y` or `z`, found"),
        (
            in_object(&cube.replace("x=\"1\"", "x=\"1e999\"")),
            ": expected a finite number",
        ),
    ];
    for (file, expected) in cases {
        let said = refused(&file);
        assert!(said.starts_with("part.3mf: ") && said.contains(expected), "{said}");
    }
    let cut = archive(&format!("<model xmlns=\"{CORE}\">\n<resources>"));
    assert!(
        refused(&cut)
            .ends_with(":2:12: expected a closing tag, found the end of the file")
    );
}

/// Of a part that is a thousand times as long as its archive no more is unpacked than may be.
#[test]
fn what_is_packed_is_counted_as_it_is_unpacked() {
    let long = format!("<model xmlns=\"{CORE}\">{}</model>", " ".repeat(50_000_000));
    let file = archive(&long);
    assert!(file.len() < 100_000);
    let limit = 1 << 20;
    let options = ReadOptions { max_bytes: limit, ..ReadOptions::default() };
    let path = Path::new("part.3mf");
    let error =
        read::bytes(&file, path, Format::ThreeMf, &options).expect_err("too long");
    assert!(matches!(error.kind, ReadErrorKind::TooManyBytes { limit: 1_048_576 }));
    assert!(bytes(&file).is_ok());
}

/// A chain of objects, each of which has the one before twice.
#[test]
fn objects_that_double_cost_nothing_until_they_are_compiled() {
    let start = Instant::now();
    let mut objects = object(1, "", &cuboid(DVec3::ONE));
    for id in 2..=20_000 {
        let before = format!("<component objectid=\"{}\"/>", id - 1);
        let twice = format!("<components>{before}{before}</components>");
        objects += &object(id, "", &twice);
    }
    let solid = solid(&holding("", &objects, "<item objectid=\"20000\"/>"));
    let error = Scene::compile(&solid).expect_err("it is too large");
    assert!(matches!(error, CompileError::TooLarge { .. }), "{error}");
    drop(solid);
    assert!(start.elapsed().as_secs() < 20);
}

/// Whatever the bytes are, the answer comes soon, and is one.
#[test]
fn damaged_archives_are_refused_or_read() {
    let file = holding("", &object(1, "", &cuboid(DVec3::ONE)), "<item objectid=\"1\"/>");
    for cut in 0..file.len() {
        let _ = bytes(&file[..cut]);
    }
    for at in 0..file.len() {
        for value in [0, 1, 0x7f, 0xff] {
            let mut file = file.clone();
            file[at] = value;
            let _ = bytes(&file);
        }
    }
}

/// Attributes, depth and names: nothing takes a time in the square of its length.
#[test]
fn long_texts_take_no_longer_than_their_length() {
    let start = Instant::now();
    let many: String = (0..300_000).map(|i| format!(" a{i}=\"\"")).collect();
    assert!(bytes(&holding(&many, "", "")).is_ok());
    let deep = format!("{}{}", "<a>".repeat(300_000), "</a>".repeat(300_000));
    assert!(bytes(&holding("", &deep, "")).is_ok());
    let spaces: String = (0..300_000).map(|i| format!(" xmlns:a{i}=\"b\"")).collect();
    assert!(bytes(&holding(&spaces, &"<a/>".repeat(300_000), "")).is_ok());
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}

#[test]
fn imports_take_meshes_as_openscad_does() {
    let cube = cuboid(dvec3(1.0, 2.0, 3.0));
    let far = object(2, "name=\"b\"", &cube.replace("x=\"0\"", "x=\"-4\""));
    let objects = object(1, "", &cube) + &far;
    let items = "<item objectid=\"1\" transform=\"2 0 0 0 1 0 0 0 1 10 0 0\"/>";
    let file = holding("unit=\"inch\"", &objects, items);
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("a.3mf"), file).expect("it is written");
    let model = folder.path().join("a.csg");
    std::fs::write(&model, "import(\"a.3mf\"); import(\"a.3mf\");")
        .expect("it is written");
    let read = read::file(&model, &ReadOptions::default()).expect("it is sound");
    let volume = openscad::enclosed(&read.solid);
    assert!((volume - 30.0).abs() < 1e-9, "{volume}");
    assert_eq!(read.warnings.len(), 1, "{:?}", read.warnings);
    if openscad::is_installed("nothing is compared with it") {
        let expected = openscad::volume_of(&model);
        assert!((volume - expected).abs() < 1e-6 * expected, "{volume}, not {expected}");
    }
}
