//! Plane shapes, height fields and imports against the installed OpenSCAD and closed forms.

#[path = "support/openscad.rs"]
mod openscad;
#[expect(dead_code, reason = "texts need no random solids")]
mod support;

use std::f64::consts::PI;
use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use solidray::measure::{self, Sampling};
use solidray::read::{self, Curves, Format, ReadOptions};
use solidray::{Scene, Solid};

/// Texts whose solids OpenSCAD makes with the same volume.
const TEXTS: &[&str] = &[
    // Offsets: round, mitred, chamfered, out and in, of corners and of what has holes.
    "offset(r = 1, $fn = 0, $fa = 12, $fs = 2) { square([10, 5]); }",
    "offset(r = 3, $fn = 0, $fa = 12, $fs = 0.2) { square([10, 5]); }",
    "offset(r = 3, $fn = 6) { square([10, 5]); }",
    "offset(r = 3, $fn = 25) { polygon([[0, 0], [10, 1], [3, 9]]); }",
    "offset(r = -1, $fn = 32) { difference() { square(10); square(5); } }",
    "offset(r = -1, $fn = 0) { difference() { square(20); circle(r = 4, $fn = 7); } }",
    "offset(r = 2) { circle(r = 4, $fn = 40); }",
    "offset(delta = 1, chamfer = false) { polygon([[0, 0], [10, 1], [3, 9]]); }",
    "offset(delta = 2, chamfer = true) { polygon([[0, 0], [10, 1], [3, 9]]); }",
    "offset(delta = -0.5, chamfer = true) { difference() { square(10); square(5); } }",
    "offset(delta = -2) { square([3, 9]); multmatrix([[1, 0, 0, 1]]) square(8); }",
    "offset(delta = 1) { polygon([[0, 0], [10, 0], [10, 10], [5, 1]]); }",
    "offset(r = 1) { offset(delta = -1) { square([10, 5]); } }",
    "offset(r = 3, $fn = 3) { square([10, 5]); }",
    "offset(r = 2.7, $fn = 10) { square([10, 5]); }",
    "offset() { square(3); }",
    // Texts: letters, alignment (which a cut shows), spacing, direction.
    r#"text("Hag8&e", size = 10, font = "", $fn = 0, $fa = 12, $fs = 2);"#,
    r#"text("AVo€", size = 4, font = "Liberation Sans:style=Bold Italic", $fn = 64);"#,
    r#"text("o", font = "Liberation Serif", $fn = 5);"#,
    r#"intersection() { text("Agb", halign = "center", valign = "center"); square([7, 3]); }"#,
    r#"intersection() { text("Hxl", size = 7, halign = "right", valign = "top"); multmatrix([[1, 0, 0, -9], [0, 1, 0, -5]]) square([8, 3]); }"#,
    r#"intersection() { text("gyp", spacing = 1.5, valign = "bottom"); square([25, 5]); }"#,
    r#"intersection() { text("abc", direction = "rtl", font = "Liberation Mono"); square([11, 30]); }"#,
    r#"intersection() { text("Hig", direction = "ttb", spacing = 0.8); multmatrix([[1, 0, 0, 0], [0, 1, 0, -25]]) square([3, 24]); }"#,
    r#"intersection() { text("ab", direction = "btt", valign = "center", halign = "center"); multmatrix([[1, 0, 0, -9], [0, 1, 0, -9]]) square([8, 15]); }"#,
    r#"intersection() { text("WAo", direction = "ttb", valign = "top", halign = "right", font = "Liberation Serif:style=Bold"); multmatrix([[1, 0, 0, -9], [0, 1, 0, 9]]) square([8, 15]); }"#,
];

/// Texts that are solids by themselves.
const SOLIDS: &[&str] = &[
    r#"linear_extrude(height = 2) { import("a.dxf"); }"#,
    r#"linear_extrude(height = 2) { import("ellipse.dxf"); }"#,
    r#"linear_extrude(height = 2) { import("a.dxf", layer = "B", scale = 3, origin = [4, 5], $fn = 9); }"#,
    r#"surface("uneven.dat");"#,
    r#"surface("deep.dat", center = true);"#,
    r#"surface("grey.png", center = true);"#,
    r#"surface("grey.png", invert = true);"#,
    r#"surface("colour.png");"#,
    "hull() { cube(1); multmatrix([[1, 0, 0, 3]]) sphere(r = 1, $fn = 9); }",
    "linear_extrude(height = 2) { minkowski() { square(3); circle(r = 1, $fn = 12); } }",
];

/// The files that the texts name; the pictures have three by two pixels.
const FILES: &[(&str, &[u8])] = &[
    ("uneven.dat", b"10 12 8\n5 6 7 20\n"),
    ("deep.dat", b"# heights\n10 12 8 9\n\n5 6 7 20\n3 -2 4 4\n"),
    // An arc with a line, a circle in a polyline with a bulge, and a loose line.
    (
        "a.dxf",
        b"0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n0\n10\n0\n20\n0\n11\n10\n21\n0\n\
          0\nARC\n8\nA\n10\n5\n20\n0\n40\n5\n50\n0\n51\n180\n0\nLWPOLYLINE\n8\n\
          B\n90\n4\n70\n1\n10\n0\n20\n-9\n10\n10\n20\n-9\n42\n1\n10\n10\n20\n\
          -1\n10\n0\n20\n-1\n0\nCIRCLE\n8\nB\n10\n5\n20\n-5\n40\n2\n0\nLINE\n8\n\
          0\n10\n20\n20\n0\n11\n30\n21\n5\n0\nENDSEC\n0\nEOF\n",
    ),
    (
        "ellipse.dxf",
        b"0\nSECTION\n2\nENTITIES\n0\nELLIPSE\n8\n0\n10\n0\n20\n0\n11\n10\n21\n\
          0\n40\n0.5\n41\n0\n42\n6.283185307179586\n0\nENDSEC\n0\nEOF\n",
    ),
    (
        "grey.png",
        &[
            137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 3, 0,
            0, 0, 2, 8, 0, 0, 0, 0, 184, 31, 57, 198, 0, 0, 0, 16, 73, 68, 65, 84, 120,
            156, 99, 224, 18, 249, 197, 144, 210, 196, 14, 0, 7, 223, 2, 6, 119, 232, 30,
            68, 0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130,
        ],
    ),
    (
        "colour.png",
        &[
            137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 3, 0,
            0, 0, 2, 8, 2, 0, 0, 0, 18, 22, 241, 77, 0, 0, 0, 27, 73, 68, 65, 84, 120,
            156, 99, 224, 18, 249, 149, 210, 196, 206, 0, 4, 255, 255, 255, 23, 177, 9,
            248, 207, 192, 0, 0, 62, 221, 6, 162, 1, 140, 114, 62, 0, 0, 0, 0, 73, 69,
            78, 68, 174, 66, 96, 130,
        ],
    ),
];

/// Drawings, and what stands behind their names where they are imported.
const DRAWINGS: &[(&str, &str)] = &[
    // Pages: units, boxes of other shapes and with corners, the origin in the middle.
    (r#"<svg><rect x="1" y="1" width="4" height="3"/></svg>"#, ""),
    (r#"<svg width="50%" viewBox="0 0 20 10"><circle cx="5" cy="5" r="4"/></svg>"#, ""),
    (
        r#"<svg viewBox="0 0 20 10"><rect x="1" y="2" width="4" height="3"/></svg>"#,
        ", dpi = 96",
    ),
    (
        r#"<svg width="1in" height="2pc" viewBox="1 2 20 10"><ellipse cx="5" cy="4" rx="3" ry="2"/></svg>"#,
        "",
    ),
    (
        r#"<svg width="100mm" height="2cm" viewBox="0,0 20,10" preserveAspectRatio="xMaxYMin slice"><rect x="1" y="1" width="4" height="3"/></svg>"#,
        "",
    ),
    (
        r#"<svg width="90px" height="40pt" viewBox="1 2 20 10" preserveAspectRatio="none"><rect x="1" y="1" width="4" height="3"/></svg>"#,
        ", center = true",
    ),
    (
        r#"<svg width="60" height="1e1" viewBox="3 4 20 10"><rect x="1" y="1" width="4" height="3"/></svg>"#,
        ", center = true, $fn = 100",
    ),
    // Shapes: corners that are round, points, lines by their strokes.
    (r#"<svg><rect x="1" y="2" width="9" height="4" rx="1" ry="3"/></svg>"#, ""),
    (
        r#"<svg><rect width="4mm" height="5"/><rect width="4" height="5" ry="9"/></svg>"#,
        "",
    ),
    (r#"<svg><polygon points="5-3,8,3 9-2 1.5 5"/></svg>"#, ""),
    (r#"<svg><polyline points="0,0 10,0 10,10 0,9" stroke-width="2"/></svg>"#, ""),
    (
        r#"<svg><polyline points="0,0 10,0 10,10 0,1" style="stroke-width:3;stroke-linejoin:bevel;stroke-linecap:butt"/></svg>"#,
        "",
    ),
    (
        r#"<svg><line x2="10" y2="5" stroke-width="3" stroke-linecap="round"/><path d="M20 0L30 0L20 1" stroke-linejoin="round"/></svg>"#,
        "",
    ),
    // Maps, groups, what is defined and what is not known.
    (
        r#"<svg viewBox="0 0 99 99" width="99mm"><g transform="translate(20,5) rotate(30)"><rect x="1" y="2" width="5" height="6" transform="skewX(20) scale(1,2)"/></g><g transform="matrix(1 .5 -.5 1 9 9) rotate(45, 3, 4)"><path d="M0 0h4v3z"/></g></svg>"#,
        "",
    ),
    (
        r##"<svg><defs><rect id="a" width="9" height="9"/></defs><use href="#a" x="20"/><g style="display:none"><rect width="2" height="3"/></g><a><clipPath><rect x="3" width="2" height="2"/></clipPath></a></svg>"##,
        "",
    ),
    (
        r#"<svg viewBox="0 0 20 10"><rect width="2" height="3"/><svg x="9" viewBox="0 0 40 30"><rect x="3" width="1" height="1"/></svg></svg>"#,
        "",
    ),
    // Paths: all commands, lines within lines, numbers without spaces, lines left open.
    (
        r#"<svg><path d="M0 0h9v9h-9z M2 2H5V5H2zm1 1l1 0 0 1z"/><rect x="3" y="3" width="1" height="1"/></svg>"#,
        "",
    ),
    (r#"<svg><path d="M1.5.5h5v1.25.5z M1E1-3h1E1v5z m1e+1 7l100e-1-3v5z"/></svg>"#, ""),
    (
        r#"<svg><path d="M0 0C0 8 4 9 9 9S20 2 20 0c1-3-2-5-5-5s-9 1-9 2zM30 0Q35 9 40 0T50 0q2-9 4-5t3-9z"/></svg>"#,
        "",
    ),
    (
        r#"<svg><path d="M0 0A5 5 0 0 1 10 0L5-9zM20 0a8 3 30 1 0 3 4zm30 0a2 2 0 0 1 9 9z"/></svg>"#,
        "",
    ),
    (
        r#"<svg><path d="M0 0L10 0L10 10 M20 20C20 30 30 30 30 20z l0 9 9 9 A"/></svg>"#,
        "",
    ),
    (r#"<svg><path d="M0 0L5 0L5 5L0 .05"/><path d=""/><path/></svg>"#, ""),
];

fn solid(text: &str, curves: Curves) -> Solid {
    solid_in(text, curves, Path::new("a.csg"))
}

fn solid_in(text: &str, curves: Curves, file: &Path) -> Solid {
    let options = ReadOptions { curves, ..ReadOptions::default() };
    let model = read::bytes(text.as_bytes(), file, Format::Csg, &options);
    model.unwrap_or_else(|error| panic!("{text}: {error}")).solid
}

fn thick(text: &str) -> String {
    format!("linear_extrude(height = 2) {{ {text} }}")
}

#[test]
fn faceted_texts_have_the_volume_of_openscads_polyhedra() {
    if !openscad::is_installed("nothing is compared with it") {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.csg");
    let mut wrong = Vec::new();
    for (name, bytes) in FILES {
        std::fs::write(folder.path().join(name), bytes).expect("it is written");
    }
    let thick = TEXTS.iter().map(|text| thick(text));
    for text in thick.chain(SOLIDS.iter().map(|&text| text.to_owned())) {
        std::fs::write(&file, &text).expect("it is written");
        let expected = openscad::volume_of(&file);
        let volume = openscad::enclosed(&solid_in(&text, Curves::Faceted, &file));
        let is_near = (volume - expected).abs() <= 3e-4 * expected;
        if !is_near {
            wrong.push(format!("{text}: {volume}, not {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn drawings_are_where_openscad_has_them() {
    if !openscad::is_installed("nothing is compared with it") {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.csg");
    let mut wrong = Vec::new();
    for (drawing, arguments) in DRAWINGS {
        std::fs::write(folder.path().join("a.svg"), drawing).expect("it is written");
        let text = thick(&format!("import(\"a.svg\"{arguments});"));
        std::fs::write(&file, &text).expect("it is written");
        let expected = openscad::made_of(&file).expect(drawing);
        let read = read::file(
            &file,
            &ReadOptions { curves: Curves::Faceted, ..ReadOptions::default() },
        );
        let read = read.unwrap_or_else(|error| panic!("{drawing}: {error}"));
        assert!(read.warnings.is_empty(), "{drawing}: {:?}", read.warnings);
        let [found, made] = [&read.solid, &expected].map(|solid| {
            let bounds = support::scene(solid).bounds();
            (openscad::enclosed(solid), bounds.min, bounds.max)
        });
        let is_near = (found.0 - made.0).abs() <= 3e-4 * made.0;
        let reach = (found.1 - made.1).abs().max((found.2 - made.2).abs());
        if !is_near || reach.max_element() > 1e-3 {
            wrong.push(format!("{drawing}: {found:?}, not {made:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn true_drawings_have_the_area_of_their_curves() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.csg");
    for (drawing, area) in [
        (r#"<circle cx="5" cy="5" r="4"/>"#, 16.0 * PI),
        (r#"<ellipse rx="6" ry="2" transform="rotate(30)"/>"#, 12.0 * PI),
        (r#"<path d="M0 0A5 5 0 0 1 10 0z"/>"#, 12.5 * PI),
        (r#"<rect width="9" height="7" rx="2"/>"#, 63.0 - 16.0 + 4.0 * PI),
        // A parabola over a chord: two thirds of the parallelogram around it.
        (r#"<path d="M0 0Q3 9 6 0z"/>"#, 18.0),
        (r#"<path d="M0 0C2 6 4 6 6 0z"/>"#, 18.0),
    ] {
        let svg = format!(
            "<svg viewBox=\"0 0 9 9\" width=\"9mm\" height=\"9mm\"><g>{drawing}</g></svg>"
        );
        std::fs::write(folder.path().join("a.svg"), svg).expect("it is written");
        let text = thick("import(\"a.svg\");");
        let options = ReadOptions { facet_tolerance: 1e-4, ..ReadOptions::default() };
        let read = read::bytes(text.as_bytes(), &file, Format::Csg, &options);
        let solid = read.unwrap_or_else(|error| panic!("{drawing}: {error}")).solid;
        let sampling = Sampling { rel_tol: 3e-4, ..Sampling::default() };
        let volume = measure::volume(&support::scene(&solid), &sampling);
        let off = (volume.value - 2.0 * area).abs();
        assert!(off <= 1e-3 * area, "{drawing}: {volume:?}, not {}", 2.0 * area);
    }
}

/// What OpenSCAD makes something of that no rule explains is left to it.
#[test]
fn strange_drawings_are_left_to_openscad() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.csg");
    let options =
        ReadOptions { openscad: Some("/nonexistent".into()), ..ReadOptions::default() };
    let refused = |drawing: &str| {
        std::fs::write(folder.path().join("a.svg"), drawing).expect("it is written");
        let text = b"\nimport(\"a.svg\");";
        let error = read::bytes(text, &file, Format::Csg, &options);
        error.map(|_| ()).expect_err(drawing).to_string()
    };
    for drawing in [
        r#"<path d="M0 0a5 5 0 015 5z"/>"#,
        r#"<path d="M+5+3h5v5z"/>"#,
        r#"<path d="M0 0A0 5 0 0 1 5 5L0 9z"/>"#,
        r#"<path d="M0 0L5 0z 5 5"/>"#,
        r#"<path d="M0 0X"/>"#,
        r#"<rect width="1e300" height="1" transform="scale(1e300)"/>"#,
    ] {
        let said = refused(&format!("<svg><g>{drawing}</g></svg>"));
        let expected = " in .svg files is left to `/nonexistent`, which was not found";
        assert!(said.contains(":2:1: ") && said.contains(expected), "{said}");
    }
    let said = refused("<svg>\n<g></svg>");
    assert!(
        said.contains("a.csg:2:1: import: ") && said.contains("a.svg:2:4: "),
        "{said}"
    );
    let said = refused("<svg><rect width='&big;'/></svg>");
    assert!(said.contains("a.svg:1:6: not sound XML: "), "{said}");
}

/// That a plane shape has an area.
#[track_caller]
fn assert_area(text: &str, area: f64) {
    let solid = solid(&thick(text), Curves::Auto);
    let sampling = Sampling { rel_tol: 3e-4, ..Sampling::default() };
    let volume = measure::volume(&support::scene(&solid), &sampling);
    assert!(volume.target_met);
    let is_near = (volume.value - 2.0 * area).abs() <= 1.91 * volume.half_width();
    assert!(is_near, "{text}: {volume:?}, exact {}", 2.0 * area);
}

#[test]
fn offsets_have_true_arcs() {
    let square = "square([10, 5]);";
    assert_area(&format!("offset(r = 2) {square}"), 50.0 + 60.0 + 4.0 * PI);
    assert_area(&format!("offset(r = -2) {square}"), 6.0);
    assert_area("offset(r = 2) circle(r = 3);", 25.0 * PI);
    assert_area("offset(r = -2) multmatrix([[1, 0, 0, 5]]) circle(r = 3);", PI);
    assert_area(
        "offset(r = -1) difference() { square(10); square(5); }",
        64.0 - 25.0 + 1.0 - PI / 4.0,
    );
    assert_area(&format!("offset(delta = 2) {square}"), 14.0 * 9.0);
    assert_area(
        &format!("offset(delta = 2, chamfer = true) {square}"),
        14.0 * 9.0 - 4.0 * (8.0_f64.sqrt() - 2.0).powi(2),
    );
    for nothing in ["offset(r = -3) square(5);", "offset(r = -3) circle(r = 3);"] {
        let scene = Scene::compile(&solid(&thick(nothing), Curves::Auto)).expect(nothing);
        assert!(scene.bounds().is_empty(), "{nothing}");
    }
}

#[test]
fn surfaces_have_the_volume_under_their_cells() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("a.dat"), "1 2 3\n4 5 6").expect("it is written");
    let file = folder.path().join("a.csg");
    let volume =
        openscad::enclosed(&solid_in("surface(\"a.dat\");", Curves::Auto, &file));
    assert!((volume - 7.0).abs() < 1e-12, "{volume}");
}

#[test]
fn true_text_has_the_area_of_its_curves() {
    if !openscad::is_installed("nothing is compared with it") {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.csg");
    let text = thick("text(\"Sol8\", $fn = 2000);");
    std::fs::write(&file, &text).expect("it is written");
    let expected = openscad::volume_of(&file);
    let volume = openscad::enclosed(&solid(&text, Curves::Exact));
    assert!((volume / expected - 1.0).abs() < 3e-4, "{volume}, not {expected}");
}

/// What is wrong with files of other formats that a text names is said with their names, and with
/// lines where they have lines.
#[test]
fn broken_drawings_heights_and_pictures_are_refused() {
    const PNG: &[u8] = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x02\0\0\0\x02\x08\0\0\0\0\x57\xdd\x52\xf8";
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.csg");
    for (name, bytes, expected) in [
        (
            "words.dat",
            &b"1 2 3\n4 five 6\n"[..],
            "words.dat:2:3: expected a number, found `five`",
        ),
        (
            "nan.dat",
            b"# heights\n\n1 2\nnan 3\n",
            "nan.dat:4:1: expected a finite number, found `nan`",
        ),
        (
            "code.dxf",
            b"0\nSECTION\n2\nENTITIES\nzero\nLINE\n",
            "code.dxf:5:1: expected the code of a group, found `zero`",
        ),
        (
            "number.dxf",
            b"0\nSECTION\n2\nENTITIES\n0\nLINE\n10\nfar\n",
            "number.dxf:8:1: expected a finite number, found `far`",
        ),
        ("short.png", &PNG[..20], "short.png: cannot be read: "),
        ("empty.png", PNG, "empty.png: cannot be read: "),
    ] {
        std::fs::write(folder.path().join(name), bytes).expect("it is written");
        let node = if name.ends_with("dxf") { "import" } else { "surface" };
        let text = format!("linear_extrude(height = 1) {{\n  {node}(\"{name}\"); }}");
        let options = ReadOptions::default();
        let read = read::bytes(text.as_bytes(), &file, Format::Csg, &options);
        let error = read.expect_err(name).to_string();
        let folder = folder.path().display();
        let start = format!("{folder}/a.csg:2:3: import: {folder}/{expected}");
        assert!(error.starts_with(&start), "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Whatever is in such files, they are read or refused.
    #[test]
    fn bytes_that_were_changed_are_read_or_refused(
        chosen in any::<prop::sample::Index>(),
        changes in vec((any::<prop::sample::Index>(), any::<u8>()), 1..9),
        length in any::<prop::sample::Index>(),
    ) {
        let (name, bytes) = FILES[chosen.index(FILES.len())];
        let mut bytes = bytes.to_vec();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        bytes.truncate(1 + length.index(bytes.len()));
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(folder.path().join(name), bytes).expect("it is written");
        let node = if name.ends_with("dxf") { "import" } else { "surface" };
        let text = format!("linear_extrude(height = 1) {{ {node}(\"{name}\"); }}");
        let options = ReadOptions {
            max_facets: 100_000,
            openscad: Some("no-such-program".into()),
            ..ReadOptions::default()
        };
        let file = folder.path().join("a.csg");
        let _ = read::bytes(text.as_bytes(), &file, Format::Csg, &options);
    }
}

#[test]
fn a_font_that_is_missing_is_replaced_with_a_warning() {
    let text = thick("text(\"ab\", font = \"No Such Font\", $fn = 12);");
    let alone =
        ReadOptions { openscad: Some("no-such-program".into()), ..Default::default() };
    let read = read::bytes(text.as_bytes(), Path::new("a.csg"), Format::Csg, &alone);
    match read {
        Ok(model) => {
            let said = |w: &read::Warning| {
                w.message.starts_with(
                    "the font `No Such Font` is not installed; `text` is written in `",
                )
            };
            assert!(model.warnings.iter().any(said), "{:?}", model.warnings);
        }
        // Where there are no fonts at all.
        Err(error) => {
            assert!(error.to_string().contains("there is no font to write"), "{error}");
        }
    }
}

/// More arcs than are worth a leaf each become facets, and those are counted.
#[test]
fn offsets_of_many_corners_are_facets() {
    let corner = |i: u32| {
        let angle = f64::from(i) * PI / 600.0;
        let radius = if i.is_multiple_of(2) { 300.0 } else { 290.0 };
        format!("[{},{}]", radius * angle.cos(), radius * angle.sin())
    };
    let corners: Vec<String> = (0..1200).map(corner).collect();
    let star = format!("offset(r = 1) polygon([{}]);", corners.join(","));
    let options = |max_facets| ReadOptions { max_facets, ..ReadOptions::default() };
    let read = |max_facets| {
        let text = thick(&star);
        read::bytes(
            text.as_bytes(),
            Path::new("a.csg"),
            Format::Csg,
            &options(max_facets),
        )
    };
    let model = read(30_000_000).expect("there is room");
    assert_eq!(model.solid.census().leaves, 1);
    assert_eq!(model.counts.fine, 1);
    let error = read(20_000).expect_err("there is not").to_string();
    assert!(error.contains("which is more than the limit of 20000"), "{error}");
}
