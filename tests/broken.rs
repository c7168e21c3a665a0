//! Fifty files that are broken as files get broken: cut off, mistyped, edited by hand, saved
//! under the wrong name. The snapshot has what a user is told of each.

use std::fmt::Write;
use std::fs;

use solidray::read::{self, ReadOptions};

/// A binary file of so many triangles that says it has another number of them.
fn binary_stl(declared: u32, present: usize) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(declared.to_le_bytes());
    bytes.extend(vec![0; 50 * present]);
    bytes
}

/// Each is a file, or a drawing or heights that a model imports.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let text = |(name, text): (&'static str, &str)| (name, text.as_bytes().to_vec());
    let mut files: Vec<_> = TEXTS.iter().copied().map(text).collect();
    files.extend([
        ("cut.stl", binary_stl(3, 1)),
        ("head.stl", vec![0; 60]),
        ("zeros.stl", binary_stl(0, 0)),
        ("flat.stl", binary_stl(2, 2)),
        ("zip.csg", b"PK\x03\x04\x14\0\0\0\x08\0".to_vec()),
        ("zip.stl", b"PK\x03\x04\x14\0\0\0\x08\0".to_vec()),
        ("utf16.csg", b"\xff\xfec\0u\0b\0e\0(\x001\0)\0;\0".to_vec()),
        ("picture.off", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec()),
    ]);
    files
}

const TEXTS: &[(&str, &str)] = &[
    ("unclosed.csg", "difference() {\n\tcube(size = [1, 1, 1]);\n\tsphere(r = 1"),
    ("comma.csg", "cube(size = [1, 2, 3,, 4]);"),
    ("brace.csg", "union() {\n\tcube(size = 1);\n}}\n"),
    ("equals.csg", "cube(size == 3);"),
    ("variable.csg", "w = 10;\ncube(size = w);"),
    ("expression.csg", "cube(size = 2 * 3);"),
    ("module.csg", "module foot() { cube(size = 1); }\nfoot();"),
    ("for.csg", "for (i = [0:3]) { cube(size = 1); }"),
    ("use.csg", "use <gears.scad>\ncube(size = 1);"),
    ("misspelt.csg", "group() {\n\tcylindre(h = 1, r = 1);\n}"),
    ("string.csg", "color(\"red) {\n\tcube(size = 1);\n}"),
    ("quote.csg", "import(file = \u{201c}part.stl\u{201d});"),
    ("matrix.csg", "multmatrix([[1, 0, 0, 0], [0, 1, 0]]) { cube(size = 1); }"),
    ("numbers.csg", "cube(size = [1, \"two\", 3]);"),
    ("decimal.csg", "cube(size = [1,5, 2, 3]);"),
    ("points.csg", "polyhedron(points = [[0, 0], [1, 0]], faces = [[0, 1, 2]]);"),
    (
        "index.csg",
        "polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], faces = [[0, 1, 7]]);",
    ),
    ("html.csg", "<!DOCTYPE html>\n<html><body>404: Not Found</body></html>\n"),
    ("missing.csg", "\n  import(file = \"nowhere.step\");"),
    ("flat.csg", "circle(r = 3);"),
    ("model.step", "ISO-10303-21;"),
    ("noending", "cube(1);"),
    ("point.obj", "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n"),
    ("letter.obj", "v 0 0 0\nv 1 0 O\n"),
    ("comma.obj", "v 0,0,0\n"),
    ("corner.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n"),
    ("slashes.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1/1 2 3\n"),
    ("beyond.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n# the fourth is lost\nf 1 2 3\nf 1 3 4\n"),
    ("zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"),
    ("back.obj", "v 0 0 0\nf -1 -2 -3\n"),
    ("line.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n"),
    ("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
    ("empty.obj", ""),
    ("infinite.obj", "v 0 0 1e999\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n"),
    ("word.stl", "solid part\n facet normal 0 0 1\n  outer loop\n   vertx 0 0 0\n"),
    (
        "number.stl",
        "solid part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 1.0.0\n",
    ),
    ("ends.stl", "solid part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n"),
    (
        "two.stl",
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
    ),
    ("nothing.stl", "solid nothing\nendsolid nothing\n"),
    ("empty.stl", ""),
    ("head.off", "3 1 0\n0 0 0\n"),
    ("counts.off", "OFF\nthree 1 0\n"),
    ("short.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n"),
    ("index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
    ("corners.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n"),
    ("fraction.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n"),
    ("code.dxf", "0\nSECTION\n2\nENTITIES\nnull\nLINE\n"),
    ("number.dxf", "0\nSECTION\n2\nENTITIES\n0\nLINE\n10\n1,5\n"),
    ("spline.dxf", "0\nSECTION\n2\nENTITIES\n0\nSPLINE\n8\n0\n0\nENDSEC\n0\nEOF\n"),
    ("binary.dxf", "AutoCAD Binary DXF\r\n\u{1a}\0"),
    ("word.dat", "1 2 3\n4 five 6\n"),
    ("comma.dat", "1, 2, 3\n4, 5, 6\n"),
    ("nan.dat", "1 2\nnan 4\n"),
];

#[test]
fn a_user_is_told_what_is_wrong_and_where() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let missing = Some("no-such-openscad".into());
    let options = ReadOptions { openscad: missing, ..ReadOptions::default() };
    let files = files();
    assert!(files.len() >= 50);
    let mut said = String::new();
    for (name, bytes) in files {
        let mut path = folder.path().join(name);
        fs::write(&path, bytes).expect("a file in a temporary folder");
        let uses = match path.extension().and_then(|e| e.to_str()) {
            Some("dxf") => Some("linear_extrude(height = 1) {\n\timport(file = "),
            Some("dat") => Some("group() {\n\tsurface(file = "),
            _ => None,
        };
        if let Some(uses) = uses {
            path = folder.path().join("uses.csg");
            fs::write(&path, format!("{uses}\"{name}\");\n}}")).expect("a file");
        }
        let told = match read::file(&path, &options) {
            Ok(model) => format!("{name} is read: {:?}", model.warnings),
            Err(error) => error.to_string(),
        };
        let prefix = format!("{}{}", folder.path().display(), std::path::MAIN_SEPARATOR);
        writeln!(said, "{}", told.replace(&prefix, "")).expect("room");
    }
    insta::assert_snapshot!(said);
}
