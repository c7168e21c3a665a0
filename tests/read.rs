//! Reading: what is refused and how it is said, depth, garbage, mesh formats, `.scad`.

use std::path::{Path, PathBuf};

use glam::DVec3;
use proptest::prelude::*;
use solidray::read::{
    self, Curves, Format, Imports, Model, ReadError, ReadErrorKind, ReadOptions,
};
use solidray::{CompileError, Mesh, Scene, View};

#[path = "support/answers.rs"]
mod answers;
#[path = "support/valid.rs"]
mod valid;

fn bytes(text: impl AsRef<[u8]>, format: Format) -> Result<Model, ReadError> {
    read::bytes(text.as_ref(), Path::new("part.x"), format, &ReadOptions::default())
}

fn csg(text: &str) -> Model {
    bytes(text, Format::Csg).expect("the text is right")
}

fn refused(text: impl AsRef<[u8]>, format: Format) -> String {
    bytes(text, format).expect_err("the text is wrong").to_string()
}

/// A Debug text says what the topmost node is.
fn is_empty(model: &Model) -> bool {
    format!("{:?}", model.solid) == "Solid(Boolean(Union), 0 children)"
}

/// The mesh that is all of a model, under names and places alone.
fn mesh(model: &Model) -> &Mesh {
    let mut solid = &model.solid;
    loop {
        match solid.view() {
            View::Mesh(mesh) => return mesh,
            View::Tagged(child) => solid = child,
            View::Primitive(_) | View::Boolean(..) | View::Mapped(..) | _ => {
                panic!("no mesh: {solid:?}")
            }
        }
    }
}

/// That a model is the tetrahedron between the origin and 6 on each axis.
#[track_caller]
fn assert_tetrahedron(model: &Model) {
    let mesh = mesh(model);
    assert!((mesh.volume() - 36.0).abs() < 1e-12, "{}", mesh.volume());
    let bounds = mesh.bounds();
    assert_eq!((bounds.min, bounds.max), (DVec3::ZERO, DVec3::splat(6.0)));
}

#[test]
fn the_grammar_is_wider_than_what_openscad_prints() {
    for text in [
        "",
        " \t\r\n // nothing\n/* at * all */",
        "\u{feff}group();",
        ";;group(){;}",
        "%\t\tgroup() {\n\t}\n",
        "group() group() ;",
        "*#group();",
        "!group();",
        "cube(size = [1e-07, 3.33333e+9, -0, ], center = false,);",
        "cube([-inf, nan, +.5]);",
        "sphere(r = - - -1e0);",
        "polygon(points = [], paths = undef, convexity = 1);",
        "render(convexity=2);",
        "*text(\"a \\\" \\\\ \u{e9}\", [[[]], true, false, undef], x = -1);",
    ] {
        let model = csg(text);
        assert!(is_empty(&model), "{text}");
        assert!(model.warnings.is_empty(), "{text}: {:?}", model.warnings);
    }
    // Strings that are not UTF-8 are no reason to refuse a file.
    let latin = bytes(b"%text(\"\xe9\xff\"); cube(1);", Format::Csg).unwrap();
    assert!(!is_empty(&latin));
}

#[test]
fn refused_csg_is_located() {
    let numbers = "a number or a vector of 3 numbers";
    for (text, expected) in [
        ("cube(1)", ":1:8: expected `;`, `{` or a statement, found the end of the file"),
        (
            "group() {\n\tcube(1);\n",
            ":3:1: expected a statement or `}`, found the end of the file",
        ),
        ("cube(1);\n}", ":2:1: expected a statement, found `}`"),
        ("cube(1); x = 3;", ":1:12: expected `(`, found `=`"),
        ("cube(size 1);", ":1:11: expected `=`, found `1`"),
        ("cube(1 2);", ":1:8: expected `,` or `)`, found `2`"),
        ("cube([1 2]);", ":1:9: expected `,` or `]`, found `2`"),
        ("cube([1:2]);", ":1:8: expected `,` or `]`, found `:`"),
        ("cube([,]);", ":1:7: expected a value, found `,`"),
        ("cube(size = PI);", ":1:13: expected a value, found `PI`"),
        ("cube(-true);", ":1:7: expected a number, found `true`"),
        ("cube(1.2.3);", ":1:6: expected a number, found `1.2.3`"),
        ("cube(1e);", ":1:6: expected a number, found `1e`"),
        ("cube(\"a", ":1:6: expected `\"`, found a string that does not end"),
        ("/* cube(1);", ":1:1: expected `*/`, found a comment that does not end"),
        ("*;", ":1:2: expected a statement, found `;`"),
        ("/* ü */ é();", ":1:9: expected a statement, found `é`"),
        ("group() {\n\tbend() { cube(1); }\n}", ":2:2: `bend` is not supported yet"),
        (
            "cube(size = true);",
            &format!(":1:13: `size` of `cube` must be {numbers}, not true"),
        ),
        (
            "cube([1, 2]);",
            &format!(":1:6: `size` of `cube` must be {numbers}, not a vector of 2"),
        ),
        (
            "cube(1, center = \"yes\");",
            ":1:18: `center` of `cube` must be true or false, not the string `yes`",
        ),
        (
            "sphere(r = [1]);",
            ":1:12: `r` of `sphere` must be a number, not a vector of 1",
        ),
        (
            "polyhedron([[0, 0, undef]], [[0, 0, 0]]);",
            ":1:13: `points` of `polyhedron` must be triples of finite numbers, not a vector of 3",
        ),
        (
            "polygon([[0, nan]]);",
            ":1:10: `points` of `polygon` must be pairs of finite numbers, not a vector of 2",
        ),
        (
            "polyhedron(points = [[0, 0, 0]], faces = 3);",
            ":1:42: `faces` of `polyhedron` must be a vector, not 3",
        ),
        (
            "square(1);",
            ": the model is two-dimensional; --plate THICKNESS or linear_extrude gives it a thickness",
        ),
        (
            "\n  polyhedron([[0,0,0],[1,0,0],[0,1,0]], [[0,1,2]]);",
            ":2:3: the mesh is not closed and oriented: 3 edges without the neighbour that \
             runs the other way, first 1–0 from (1, 0, 0) to (0, 0, 0); 0–2 from (0, 0, 0) \
             to (0, 1, 0); 2–1 from (0, 1, 0) to (1, 0, 0)",
        ),
    ] {
        assert_eq!(refused(text, Format::Csg), format!("part.x{expected}"), "{text}");
    }
    let faceted = ReadOptions { curves: Curves::Faceted, ..ReadOptions::default() };
    let text = b"sphere(r = 1, $fn = 1e9);";
    let error = read::bytes(text, Path::new("a.csg"), Format::Csg, &faceted).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a.csg:1:1: with this one, curves and polygons have 1000000000000000000 triangles, \
         which is more than the limit of 30000000; --max-facets raises it"
    );
}

#[test]
fn what_only_openscad_can_make_is_an_error_without_it() {
    let missing = Some(PathBuf::from("no-such-program"));
    let options = ReadOptions { openscad: missing, ..ReadOptions::default() };
    let ending = "is left to `no-such-program`, which was not found; install OpenSCAD \
                  (openscad.org, or `apt install openscad`)";
    for (text, expected) in [
        ("group() {\n\troof() { square(1); }\n}", "2:2: `roof`"),
        (
            "linear_extrude(height = 1, file = \"a.dxf\");",
            "1:1: `linear_extrude` with `file`",
        ),
    ] {
        let error =
            read::bytes(text.as_bytes(), Path::new("a.csg"), Format::Csg, &options)
                .expect_err(text);
        assert_eq!(error.to_string(), format!("a.csg:{expected} {ending}"));
    }
}

#[test]
fn what_is_ignored_is_said() {
    let texts = |text: &str| {
        csg(text).warnings.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(
        texts("cube(1, colour = 3);"),
        ["1:1: `cube` has no argument `colour`; it is ignored"]
    );
    assert_eq!(
        texts("group(3);"),
        ["1:1: `group` has at most 0 arguments without a name; more are ignored"]
    );
    assert_eq!(
        texts("cube(1, size = 2);"),
        ["1:1: `cube` has `size` more than once; the last one counts"]
    );
    assert_eq!(
        texts("multmatrix([[0,0,0,0]]) cube(1);"),
        ["1:1: the matrix is singular or not finite; what it maps is left out"]
    );
    assert_eq!(
        texts("linear_extrude(height = 1) cube(1);"),
        ["1:1: `linear_extrude` ignores three-dimensional children"]
    );
    assert_eq!(
        texts("polygon([[0,0],[1,0],[0,1]], [[0, 1, 7, -1]]);"),
        ["1:1: `polygon` names points that do not exist 2 times; they are left out"]
    );
}

#[test]
fn depth_costs_no_stack() {
    let depth = 1_000_000;
    for open in ["group() {", "difference() {", "multmatrix([[2,0,0,0]]) {", "union() "] {
        let close = if open.ends_with('{') { "}" } else { "" };
        let text = format!("{}cube(1);{}", open.repeat(depth), close.repeat(depth));
        assert!(!is_empty(&csg(&text)), "{open}");
    }
    let vector = format!("cube({}{});", "[".repeat(depth), "]".repeat(depth));
    assert!(refused(vector, Format::Csg).contains("not a vector of 1"));
    assert!(refused("[".repeat(depth), Format::Csg).contains("found `[`"));
    assert!(refused("group(){".repeat(depth), Format::Csg).contains("end of the file"));
}

/// The largest numbers have 309 digits.
#[test]
fn messages_show_large_numbers_with_a_power_of_ten() {
    assert_eq!(
        refused("v 1e308 0 0\nv 0 -1e308 0\nv 0 0 1e-308\nf 1 2 3", Format::Obj),
        "part.x: the mesh is not closed and oriented: 3 edges without the neighbour that \
         runs the other way, first 0–1 from (1e308, 0, 0) to (0, -1e308, 0); 2–0 from \
         (0, 0, 1e-308) to (1e308, 0, 0); 1–2 from (0, -1e308, 0) to (0, 0, 1e-308)"
    );
    assert_eq!(
        refused("polygon(1e308);", Format::Csg),
        "part.x:1:9: `points` of `polygon` must be a vector, not 1e308"
    );
}

/// Names in a text can be as long as the text, and of any characters.
#[test]
fn messages_show_only_the_start_of_long_names() {
    let long = "n".repeat(5_000);
    for text in [
        format!("{long}();"),
        format!("import(\"a.{long}\");"),
        format!("cube({long} = 1);"),
        "import(\"a.\u{1b}[2J\");".to_owned(),
    ] {
        let said = match bytes(&text, Format::Csg) {
            Ok(model) => model.warnings[0].to_string(),
            Err(error) => error.to_string(),
        };
        assert!(said.len() < 200, "{} bytes", said.len());
        assert!(!said.contains(char::is_control), "{said:?}");
    }
}

/// That a text describes a solid, which answers as it must.
#[track_caller]
fn assert_answers(text: &str, format: Format) {
    let model = bytes(text, format).expect("the text is right");
    let scene = Scene::compile(&model.solid).expect("the solid is right");
    answers::assert_answers_valid(&scene);
}

#[test]
fn corners_far_and_near_make_a_mesh_that_is_closed_for_every_line() {
    for text in [
        "v 0 0 0\nv 1e200 0 0\nv 0 1 0\nv 0 0 1\nf 3 2 1\nf 1 2 4\nf 2 3 4\nf 1 4 3",
        "v 1e300 0 1\nv 0 0 2\nv 0 1 1\nf 1 2 3 2",
    ] {
        assert_answers(text, Format::Obj);
    }
}

/// At 1e75 a cube is nothing but rounding: any plane might be one of its faces.
#[test]
fn a_leaf_lost_in_rounding_leaves_others_as_they_are() {
    let near = "cube(1); cylinder(); multmatrix([[1,1,1,1e75]]) cube(1);";
    assert_answers(&format!("multmatrix([[],[1]]) {{ {near} }}"), Format::Csg);
}

#[test]
fn what_is_as_large_or_small_as_numbers_go_is_refused() {
    for (text, leaf) in [
        ("multmatrix([[1,0,0,1e308]]) cube(1);", "1:29: leaf 0 (cuboid)"),
        ("multmatrix([[1e200]]) sphere(1e130);", "1:23: leaf 0 (ball)"),
        ("multmatrix([[1e200,-1e200]]) cube([1e200,1e200,1]);", "1:30: leaf 0 (cuboid)"),
        (
            "linear_extrude(1) polygon([[0,0],[1e305,0],[0,1e305]]);",
            "1:19: leaf 0 (mesh)",
        ),
        ("sphere(3e-307, $fn = 3);", "1:1: leaf 0 (mesh)"),
        (
            "cube(1); multmatrix([[1,0,0,1],[0,1],[0,0,1]]) cube(1e308);",
            "1:48: leaf 1 (cuboid)",
        ),
    ] {
        let error = Scene::compile(&csg(text).solid).expect_err(text);
        assert!(matches!(error, CompileError::BadParameter { .. }), "{error}");
        let expected = format!("{leaf}: the largest coordinate is ");
        assert!(error.to_string().starts_with(&expected), "{error}");
    }
}

/// Seen from the scene's middle such a leaf has no size, and its distance no square.
#[test]
fn a_speck_in_a_vast_scene_has_finite_ends() {
    for speck in ["cylinder(r2 = 0)", "cylinder(2, $fn = 5)", "sphere(1)", "cube(1)"] {
        let vast = format!("multmatrix([[1e77]]) cube([1e154,1,1]); {speck};");
        assert_answers(&vast, Format::Csg);
        let map = "[[1e-140],[0,1e-140],[0,0,1e-140]]";
        let vast = format!("cube([1e300,1,1]); multmatrix({map}) {speck};");
        assert_answers(&vast, Format::Csg);
    }
    let turned = "multmatrix([[3],[0,0,1],[0,1]]) { multmatrix([[1e8]]) cylinder(r2 = 0); \
                  multmatrix([[1e77]]) cube([1e154,1,1]); }";
    assert_answers(turned, Format::Csg);
}

/// The squares of such a cone's normals are no numbers.
#[test]
fn a_cone_as_tall_as_numbers_go_has_unit_normals() {
    let tall = "multmatrix([[],[],[1,0,1e155]]) cylinder(50, r2 = 0)";
    let cut = format!("difference() {{ cylinder(55, r1 = 17); {tall}; }}");
    assert_answers(&format!("multmatrix([[],[1,1,3],[1,1]]) {cut}"), Format::Csg);
}

const TETRAHEDRON: &str = "v 0 0 0\nv 6 0 0\nv 0 6 0\nv 0 0 6\n";

#[test]
fn mesh_formats_are_read() {
    let obj =
        format!("{TETRAHEDRON}f 3 2 1\nf 1/1 2/2/2 4//4\nf -3 -2 -1\nf 1 4 3 # end\n");
    let off = "OFF # tetrahedron\n4 4 6\n0 0 0\n6 0 0\n0 6 0\n0 0 6\n\
               3 2 1 0\n3 0 1 3 255 0 0\n3 1 2 3\n3 0 3 2\n";
    for (text, format) in [(obj.as_str(), Format::Obj), (off, Format::Off)] {
        let model = bytes(text, format).unwrap();
        assert_eq!(model.counts.turned, 0);
        assert_tetrahedron(&model);
    }
    let inside_out = format!("{TETRAHEDRON}f 1 2 3\nf 4 2 1\nf 4 3 2\nf 3 4 1\n");
    let turned = bytes(inside_out, Format::Obj).unwrap();
    assert_eq!(turned.counts.turned, 1);
    assert_tetrahedron(&turned);
    assert_eq!(turned.warnings[0].message, "the mesh was inside out and has been turned");
}

#[test]
fn colours_of_obj_points_are_skipped() {
    let faces = "f 3 2 1\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    for points in [
        "v 0 0 0\nv 6 0 0 1 .5 0\nv 0 6 0\nv 0 0 6\n",
        "v 0 0 0 1 1 1\nv 6 0 0 1 1 1\n v  0 6 0 1 1 1 \nv 0 0 6\n",
        "v 0 0 0 1 1 1 1\nv 6 0 0 1 1 1 .5\nv 0 6 \\\n0 1 1 1 1\nv\t0\t0\t6\t1\t1 1 1\n",
        "v 0 0 0 1\nv 6 0 0 1.0\nv 0 6 0 1\nv 0 0 12 2\n",
    ] {
        assert_tetrahedron(&bytes([points, faces].concat(), Format::Obj).unwrap());
    }
}

/// The triangles of a tetrahedron.
fn triangles() -> [[[f32; 3]; 3]; 4] {
    let p = [[0.0, 0.0, 0.0], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 6.0]];
    [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].map(|f| f.map(|i| p[i]))
}

fn binary_stl(header: &[u8]) -> Vec<u8> {
    let mut file = header.to_vec();
    file.resize(80, b' ');
    file.extend(4_u32.to_le_bytes());
    for triangle in triangles() {
        file.extend([0; 12]);
        for x in triangle.iter().flatten() {
            file.extend(x.to_le_bytes());
        }
        file.extend([0; 2]);
    }
    file
}

#[test]
fn stl_is_read_as_text_and_binary() {
    let mut text = "solid a b\n".to_owned();
    for triangle in triangles() {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in triangle {
            text += &format!("vertex {x} {y} {z:e}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text += "endsolid a b\n";
    let flat = text.replacen("normal 0 0 0", "normal -nan(ind) 1.#IND 0", 2);
    assert_tetrahedron(&bytes(flat, Format::Stl).unwrap());
    for file in [text.clone().into_bytes(), binary_stl(b"x"), binary_stl(b"solid x")] {
        let model = bytes(file, Format::Stl).unwrap();
        assert_tetrahedron(&model);
        assert_eq!(mesh(&model).points().len(), 4);
    }
    let mut short = binary_stl(b"");
    short[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert_eq!(
        refused(short, Format::Stl),
        "part.x: the file declares 4294967295 triangles, but has bytes for 4"
    );
    assert_eq!(
        refused("cube", Format::Stl),
        "part.x: expected `solid` or the head of a binary file, found 4 bytes"
    );
    let broken = text.replacen("vertex 6", "vertex six", 1);
    assert_eq!(
        refused(broken, Format::Stl),
        "part.x:6:8: expected a number, found `six`"
    );
    assert_eq!(refused("solid\nendsolid", Format::Stl), "part.x: the mesh has no faces");
}

/// Two tetrahedra of volumes 36 and 4/3 apart from each other, wound as is asked.
fn two_tetrahedra(turned: [bool; 2]) -> Model {
    let mut text =
        format!("{TETRAHEDRON}v 10 10 10\nv 12 10 10\nv 10 12 10\nv 10 10 12\n");
    for (first, turned) in [1, 5].into_iter().zip(turned) {
        for mut face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] {
            if turned {
                face.reverse();
            }
            let [a, b, c] = face.map(|i| i + first);
            text += &format!("f {a} {b} {c}\n");
        }
    }
    bytes(text, Format::Obj).expect("the text is right")
}

#[test]
fn each_body_that_is_inside_out_is_turned() {
    for turned in [[false, false], [false, true], [true, false], [true, true]] {
        let model = two_tetrahedra(turned);
        let volume = mesh(&model).volume();
        assert!((volume - (36.0 + 4.0 / 3.0)).abs() < 1e-12, "{turned:?}: {volume}");
        let any = usize::from(turned.contains(&true));
        assert_eq!((model.counts.turned, model.warnings.len()), (any, any));
    }
    let model = csg("polyhedron(points=[[0,0,0],[6,0,0],[0,6,0],[0,0,6],[10,10,10],\
         [12,10,10],[10,12,10],[10,10,12]],faces=[[0,1,2],[0,3,1],[1,3,2],[0,2,3],\
         [6,5,4],[5,7,4],[6,7,5],[7,6,4]]);");
    assert!((mesh(&model).volume() - (36.0 + 4.0 / 3.0)).abs() < 1e-12);
    assert_eq!(model.counts.turned, 1);
}

/// Cubes around one point, each within the one before, wound as the sizes' signs say.
fn nested(sizes: &[i32]) -> Model {
    let (mut text, mut first) = (String::new(), 1);
    for size in sizes {
        let half = size.abs();
        for i in 0..8 {
            let side = |bit: i32| if i & bit == 0 { -half } else { half };
            text += &format!("v {} {} {}\n", side(1), side(2), side(4));
        }
        for mut face in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            if *size < 0 {
                face.reverse();
            }
            let [a, b, c, d] = face.map(|i| i + first);
            text += &format!("f {a} {b} {c} {d}\n");
        }
        first += 8;
    }
    bytes(text, Format::Obj).expect("the text is right")
}

#[test]
fn cavities_stay() {
    for (sizes, volume, turned) in [
        (&[5, -4][..], 1000 - 512, 0),
        (&[-5, 4], 1000 - 512, 1),
        (&[5, -4, 3], 1000 - 512 + 216, 0),
        (&[5, -4, -3], 1000 - 512 + 216, 1),
        (&[5, -4, 3, -2], 1000 - 512 + 216 - 64, 0),
        (&[5, 4], 1000 + 512, 0),
    ] {
        let model = nested(sizes);
        let error = mesh(&model).volume() - f64::from(volume);
        assert!(error.abs() < 1e-9, "{sizes:?}: {error}");
        assert_eq!(model.counts.turned, turned, "{sizes:?}");
    }
}

#[test]
fn points_listed_several_times_are_kept_once() {
    let mut off = "OFF 12 4 0\n".to_owned();
    for [x, y, z] in triangles().into_iter().flatten() {
        off += &format!("{x} {y} {z}\n");
    }
    off += "3 0 1 2\n3 3 4 5\n3 6 7 8\n3 9 10 11\n";
    let model = bytes(off, Format::Off).unwrap();
    assert_tetrahedron(&model);
    assert_eq!(mesh(&model).points().len(), 4);
}

#[test]
fn refused_meshes_are_located() {
    for (text, format, expected) in [
        (
            "#\nv 1 2",
            Format::Obj,
            ":2:1: expected `v` and three numbers, as in `v 1 0.5 -2`",
        ),
        (
            "v 1 2 x",
            Format::Obj,
            ":1:1: expected `v` and three numbers, as in `v 1 0.5 -2`",
        ),
        (
            "v 1 2 3\nf 1 a 2",
            Format::Obj,
            ":2:1: expected `f` and the numbers of points, as in `f 1 2 3` or `f 1/1/1 2/2/2 3/3/3`",
        ),
        (
            "v 1 2 3\nf 1 1",
            Format::Obj,
            ": face 0 has 2 corners; faces are counted from 0 and have at least 3",
        ),
        (
            "v 1 2 3\nf 1 1 2",
            Format::Obj,
            ":2:1: a face names a point that is not in the file; the first `v` is 1, and -1 the last one before the face",
        ),
        (
            "v 1 2 3\nf 0 1 1",
            Format::Obj,
            ":2:1: a face names a point that is not in the file; the first `v` is 1, and -1 the last one before the face",
        ),
        ("v 1 2 3", Format::Obj, ": the mesh has no faces"),
        ("COFF 1 2 3", Format::Off, ":1:1: the format `COFF` is not supported yet"),
        ("PLY", Format::Off, ":1:1: expected `OFF`, found `PLY`"),
        (
            "OFF 9999999 9 9\n0 0",
            Format::Off,
            ":2:4: expected a number, found the end of the file",
        ),
        ("OFF 0 1 0\n3 0 -1 2", Format::Off, ":2:5: expected a count, found `-1`"),
    ] {
        assert_eq!(refused(text, format), format!("part.x{expected}"), "{text}");
    }
}

#[test]
fn files_and_imports_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("a b.STL"), binary_stl(b"")).unwrap();
    std::fs::write(path("bad.off"), "OFF\n0 0 x").unwrap();
    let read = |name: &str, text: &str| {
        std::fs::write(path(name), text).unwrap();
        read::file(&path(name), &ReadOptions::default())
    };
    let model = read("a.csg", "import(file = \"a b.STL\", timestamp = 1);").unwrap();
    assert!(!is_empty(&model));
    let start = folder.path().display();
    let error = read("a.csg", "\nimport(\"bad.off\");").unwrap_err();
    let expected = "expected a count, found `x`";
    assert_eq!(
        error.to_string(),
        format!("{start}/a.csg:2:1: import: {start}/bad.off:2:5: {expected}")
    );
    // What is not there is left out, as long as something is left.
    let model = read("a.csg", "cube(1);\nimport(\"none.off\");").unwrap();
    let message = model.warnings[0].to_string();
    assert!(message.starts_with("2:1: import: "), "{message}");
    assert!(message.ends_with("; it is left out, as by OpenSCAD"), "{message}");
    let error = read("a.csg", "import(\"none.off\");").unwrap_err().to_string();
    let expected =
        format!("{start}/a.csg:1:1: import: {start}/none.off: cannot be read: ");
    assert!(error.starts_with(&expected), "{error}");
    assert_eq!(
        read("a.step", "").unwrap_err().to_string(),
        format!(
            "{start}/a.step: the format is unknown; known are .csg, .scad, .obj, .stl, .off and .3mf"
        )
    );
}

#[test]
#[expect(clippy::print_stderr, reason = "a check left out is not left out in silence")]
fn scad_goes_through_openscad() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.scad");
    let text = "echo(\"hello\"); if ($preview) hull() cube(1); else import(\"m.off\");";
    std::fs::write(&path, text).unwrap();
    let mesh =
        "OFF 4 4 0\n0 0 0\n6 0 0\n0 6 0\n0 0 6\n3 2 1 0\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    std::fs::write(folder.path().join("m.off"), mesh).unwrap();

    let missing = PathBuf::from("/nowhere/openscad");
    let options = ReadOptions { openscad: Some(missing), ..ReadOptions::default() };
    let error = read::file(&path, &options).unwrap_err();
    assert_eq!(
        error.to_string(),
        format!(
            "{}: `/nowhere/openscad` is needed to read .scad files, but was not found; \
             install OpenSCAD (openscad.org, or `apt install openscad`) or export a .csg \
             with it elsewhere",
            path.display()
        )
    );

    let options = ReadOptions::default();
    let model = match read::file(&path, &options) {
        // Without the program the rest cannot be tested; where it must be there, that is a
        // failure.
        Err(ReadError { kind: ReadErrorKind::OpenscadMissing { .. }, .. }) => {
            let required = std::env::var_os("SOLIDRAY_REQUIRE_OPENSCAD").is_some();
            assert!(
                !required,
                "OpenSCAD is required here, but there is no `openscad` on PATH"
            );
            eprintln!(
                "openscad is not installed: conversion of .scad files was not tested"
            );
            return;
        }
        other => other.unwrap(),
    };
    assert!(!is_empty(&model));
    assert!(model.warnings.iter().any(|w| w.message.contains("hello")));
    let model = read::bytes(text.as_bytes(), &path, Format::Scad, &options).unwrap();
    assert!(!is_empty(&model));
    // Variables and sets of parameters are passed on.
    let sized = folder.path().join("sized.scad");
    std::fs::write(&sized, "size = 1; cube([size, 1, 1]);").unwrap();
    let sets = folder.path().join("sets.json");
    let json = r#"{"parameterSets": {"wide": {"size": "7"}}, "fileFormatVersion": "1"}"#;
    std::fs::write(&sets, json).unwrap();
    let width = |options: &ReadOptions| {
        let solid = read::file(&sized, options).unwrap().solid;
        Scene::compile(&solid).unwrap().bounds().size().x
    };
    let defined =
        ReadOptions { definitions: vec!["size = 3".to_owned()], ..options.clone() };
    let chosen =
        ReadOptions { parameters: Some((sets, "wide".to_owned())), ..options.clone() };
    let found = [&options, &defined, &chosen].map(width);
    assert_eq!(found.map(f64::to_bits), [1.0_f64, 3.0, 7.0].map(f64::to_bits));

    let error = read::bytes(b"cube(", &path, Format::Scad, &options).unwrap_err();
    assert!(error.to_string().contains("openscad could not convert it"), "{error}");
    let open = b"polyhedron([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]);";
    let error = read::bytes(open, &path, Format::Scad, &options).unwrap_err();
    assert!(error.to_string().contains("part.scad as .csg:1:1: the mesh"), "{error}");
}

/// Pieces of the language in any order.
fn pieces() -> impl Strategy<Value = String> {
    let piece = prop::sample::select(vec![
        "cube",
        "sphere",
        "cylinder",
        "polyhedron",
        "polygon",
        "circle",
        "square",
        "group",
        "union",
        "difference",
        "intersection",
        "multmatrix",
        "linear_extrude",
        "color",
        "(",
        ")",
        "{",
        "}",
        "[",
        "]",
        ",",
        ";",
        "=",
        "-",
        "1",
        "2.5",
        "1e308",
        "-1",
        "inf",
        "nan",
        "undef",
        "true",
        "\"a\"",
        "points",
        "faces",
        "paths",
        "$fn",
        "r",
        "h",
        "%",
        "*",
        "!",
        "#",
        " ",
        "\n",
        "//",
        "/*",
        "*/",
        "();",
        "(1);",
        "(){",
        "[[0,0],[1,0],[0,1]]",
        "[0,1,2]",
        "[[0,1,2]]",
        "height=1",
        "([[0,0],[4,4],[4,0],[0,4]]);",
    ]);
    prop::collection::vec(piece, 0..40).prop_map(|pieces| pieces.concat())
}

proptest! {
    #[test]
    fn no_bytes_make_a_reader_panic(garbage in prop::collection::vec(any::<u8>(), 0..300)) {
        for format in [Format::Csg, Format::Obj, Format::Stl, Format::Off] {
            let _ = bytes(&garbage, format);
        }
        let _ = bytes([b"solid ", &garbage[..]].concat(), Format::Stl);
        let _ = bytes([b"OFF ", &garbage[..]].concat(), Format::Off);
        let _ = bytes([b"cube(\"", &garbage[..]].concat(), Format::Csg);
    }

    #[test]
    fn no_words_make_a_reader_panic(text in pieces()) {
        for format in [Format::Csg, Format::Obj, Format::Stl, Format::Off] {
            let _ = bytes(&text, format);
        }
        let options = ReadOptions { curves: Curves::Faceted, ..ReadOptions::default() };
        let _ = read::bytes(text.as_bytes(), Path::new("a"), Format::Csg, &options);
    }

    #[test]
    fn cut_files_are_refused_or_read(cut in 0_usize..284) {
        let _ = bytes(&binary_stl(b"solid")[..cut], Format::Stl);
    }
}

fn limited(text: &str, max_bytes: u64, max_facets: u64) -> Result<Model, ReadError> {
    let options = ReadOptions {
        curves: Curves::Faceted,
        max_bytes,
        max_facets,
        ..ReadOptions::default()
    };
    read::bytes(text.as_bytes(), Path::new("a.csg"), Format::Csg, &options)
}

#[test]
fn facets_are_limited() {
    // A cylinder of 6 sides has 20 triangles, but is counted as 24; a prism over a square 12.
    let text = "cylinder(r = 1, $fn = 6);\n linear_extrude(1) polygon([[0,0],[1,0],[1,1],[0,1]]);";
    assert!(limited(text, 1000, 36).is_ok());
    let expected = |place: &str, count: u32, limit: u32| {
        format!(
            "a.csg:{place}: with this one, curves and polygons have {count} triangles, which \
             is more than the limit of {limit}; --max-facets raises it"
        )
    };
    let error = limited(text, 1000, 35).expect_err("there is one too many");
    assert_eq!(error.to_string(), expected("2:20", 36, 35));
    let error = limited(text, 1000, 23).expect_err("there is one too many");
    assert_eq!(error.to_string(), expected("1:1", 24, 23));
    // Equal curves share a mesh.
    assert!(limited(&"cylinder(r = 1, $fn = 6);".repeat(9), 1000, 24).is_ok());
    for text in ["cylinder(r = 1, $fn = 1e9);", "cylinder(r = 1, $fn = 1e300);"] {
        assert!(limited(text, 1000, 30_000_000).is_err());
    }
}

#[test]
fn bytes_are_limited() {
    let message = |limit: usize| {
        format!(
            "there are more bytes to read than the limit of {limit}; --max-bytes raises it"
        )
    };
    assert!(limited("cube(1);", 8, 0).is_ok());
    let error = limited("cube(1);", 7, 0).expect_err("it is too long");
    assert_eq!(error.to_string(), format!("a.csg: {}", message(7)));

    let folder = tempfile::tempdir().expect("a folder");
    let (mesh, other) = (folder.path().join("a.obj"), folder.path().join("b.obj"));
    let obj = format!("{TETRAHEDRON}f 3 2 1\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    for path in [&mesh, &other] {
        std::fs::write(path, &obj).expect("room");
    }
    let with = |max_bytes| ReadOptions { max_bytes, ..ReadOptions::default() };
    assert!(read::file(&mesh, &with(obj.len() as u64)).is_ok());
    let error =
        read::file(&mesh, &with(obj.len() as u64 - 1)).expect_err("it is too long");
    assert_eq!(
        error.to_string(),
        format!("{}: {}", mesh.display(), message(obj.len() - 1))
    );

    // What is imported counts too, each file once.
    let csg = "import(\"a.obj\");\nimport(\"a.obj\");\n import(\"b.obj\");";
    let model = folder.path().join("model.csg");
    std::fs::write(&model, csg).expect("room");
    let all = csg.len() + 2 * obj.len();
    assert!(read::file(&model, &with(all as u64)).is_ok());
    let error = read::file(&model, &with(all as u64 - 1)).expect_err("it is too long");
    let place = format!("{}:3:2: import: {}", model.display(), other.display());
    assert_eq!(error.to_string(), format!("{place}: {}", message(all - 1)));
}

/// It says that it has no length, and does not end.
#[test]
#[cfg(target_os = "linux")]
fn a_device_without_end_is_too_long() {
    let options = ReadOptions {
        format: Some(Format::Stl),
        max_bytes: 1 << 20,
        ..ReadOptions::default()
    };
    let error = read::file(Path::new("/dev/zero"), &options).expect_err("it has no end");
    assert!(matches!(error.kind, ReadErrorKind::TooManyBytes { limit: 1_048_576 }));
}

/// Numbers in a file are promises: none of these takes memory for what it announces.
#[test]
fn counts_without_content_cost_nothing() {
    let obj = "v 0 0 0\nf 1 2 4294967295\n";
    assert_eq!(
        refused(obj, Format::Obj),
        "part.x:2:1: a face names a point that is not in the file; the first `v` is 1, and -1 the \
         last one before the face"
    );
    for text in ["OFF 4294967295 4294967295 4294967295\n", "OFF 0 1 0\n4294967295 0 0\n"]
    {
        assert!(
            refused(text, Format::Off).contains("found the end of the file"),
            "{text}"
        );
    }
    let mut stl = vec![b' '; 84];
    stl[80..].copy_from_slice(&u32::MAX.to_le_bytes());
    assert_eq!(
        refused(stl, Format::Stl),
        "part.x: the file declares 4294967295 triangles, but has bytes for 0"
    );
    let csg = "polyhedron([[0,0,0],[1,0,0],[0,1,0]], [[0, 1, 4294967295, 1e300]]);";
    assert!(bytes(csg, Format::Csg).is_ok_and(|model| model.warnings.len() == 1));
}

/// A face that crosses itself is no polygon. That is seen at the first crossing; to cut its
/// edges at all of them would take thousands of times as long.
#[test]
fn faces_that_cross_themselves_take_no_longer_than_others() {
    const CORNERS: u32 = 300;
    /// A face and its reverse, many times: the corners are on a circle and a smaller one in
    /// turn, and each is joined to the one so many steps on.
    fn seconds(step: u32) -> f64 {
        let mut off = format!("OFF {CORNERS} 100 0\n");
        for i in 0..CORNERS {
            let angle = f64::from(i) / f64::from(CORNERS) * std::f64::consts::TAU;
            let radius = if i % 2 == 0 { 1.0 } else { 0.9 };
            off += &format!("{} {} 0\n", radius * angle.cos(), radius * angle.sin());
        }
        let mut ring: Vec<String> =
            (0..CORNERS).map(|i| (i * step % CORNERS).to_string()).collect();
        for _ in 0..100 {
            off += &format!("{CORNERS} {}\n", ring.join(" "));
            ring.reverse();
        }
        let start = std::time::Instant::now();
        assert!(bytes(off, Format::Off).is_ok());
        start.elapsed().as_secs_f64()
    }
    let (simple, star) = (seconds(1), seconds(149));
    assert!(star < 20.0 * simple, "{star} s for stars, {simple} s for polygons");
}

#[test]
fn plane_models_are_plates_if_that_is_wanted() {
    let options = ReadOptions { plate: Some(2.5), ..ReadOptions::default() };
    let read = read::bytes(b"square([2, 3]);", Path::new("a.csg"), Format::Csg, &options);
    let scene = Scene::compile(&read.expect("a plate").solid).expect("a box");
    assert_eq!(scene.bounds().size(), glam::dvec3(2.0, 3.0, 2.5));
}

/// A folder with a model's folder in it, and a mesh in both.
fn nested_folders() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("room");
    std::fs::create_dir_all(folder.path().join("model/parts")).expect("room");
    let off = "OFF 4 4 0\n0 0 0 6 0 0 0 6 0 0 0 6\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    for name in ["a.off", "model/a.off", "model/parts/a.off"] {
        std::fs::write(folder.path().join(name), off).expect("room");
    }
    std::fs::write(folder.path().join("a.dat"), "1 2\n3 4\n").expect("room");
    folder
}

#[test]
fn models_name_files_in_their_own_folder_unless_others_are_allowed() {
    let folder = nested_folders();
    let model = folder.path().join("model/m.csg");
    let read = |text: &str, imports: Imports| {
        let options = ReadOptions { imports, ..ReadOptions::default() };
        read::bytes(text.as_bytes(), &model, Format::Csg, &options)
    };
    for name in ["a.off", "./a.off", "parts/a.off", "parts/../a.off"] {
        let text = format!("import(\"{name}\");");
        assert_tetrahedron(&read(&text, Imports::Folder).expect(name));
    }
    let absolute = folder.path().join("model/a.off");
    let absolute = absolute.to_str().unwrap();
    for name in ["../a.off", "parts/../../a.off", "../model/a.off", absolute] {
        let text = format!("cube(1);\nimport(\"{name}\");");
        let error = read(&text, Imports::Folder).expect_err(name).to_string();
        let path = model.with_file_name(name);
        let expected = format!(
            "{}:2:1: {} is outside of the folder of the model; --allow-outside reads it all the same",
            model.display(),
            path.display()
        );
        assert_eq!(error, expected);
        let text = format!("import(\"{name}\");");
        assert_tetrahedron(&read(&text, Imports::Anywhere).expect(name));
    }
    // Whether there is a file is not told, and no other way leads there.
    for text in [
        "import(\"../none.off\");",
        "import(\"../none.dxf\");",
        "import(\"../none.3mf\");",
        "import(\"../none.amf\");",
        "surface(\"../a.dat\");",
        "linear_extrude(1) fill() import(\"../a.svg\");",
        "fill() linear_extrude(\"../a.dxf\", filename = \"../a.dxf\");",
    ] {
        let error = read(text, Imports::Folder).expect_err(text);
        assert!(matches!(error.kind, ReadErrorKind::Outside(_)), "{text}: {error}");
    }
    assert!(read("surface(\"../a.dat\");", Imports::Anywhere).is_ok());
}

#[test]
#[cfg(unix)]
fn links_out_of_the_folder_are_ways_out_of_it() {
    use std::os::unix::fs::symlink;
    let folder = nested_folders();
    let model = folder.path().join("model/m.csg");
    symlink("../a.off", model.with_file_name("out.off")).unwrap();
    symlink("parts/a.off", model.with_file_name("in.off")).unwrap();
    symlink("..", model.with_file_name("up")).unwrap();
    symlink("model", folder.path().join("linked")).unwrap();
    let read = |model: &Path, text: &str| {
        read::bytes(text.as_bytes(), model, Format::Csg, &ReadOptions::default())
    };
    for name in ["out.off", "up/a.off"] {
        let text = format!("import(\"{name}\");");
        let error = read(&model, &text).expect_err(name);
        assert!(matches!(error.kind, ReadErrorKind::Outside(_)), "{error}");
    }
    // The folder itself may be a link.
    for folder in [model.clone(), folder.path().join("linked/m.csg")] {
        assert_tetrahedron(&read(&folder, "import(\"in.off\");").unwrap());
    }
}

/// A pipe to which nobody writes would be waited for, a device has no end.
#[test]
#[cfg(target_os = "linux")]
fn what_models_name_is_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("m.csg");
    std::fs::create_dir(folder.path().join("folder.stl")).unwrap();
    let pipe = folder.path().join("pipe.stl");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|status| status.success()));
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("zero.stl")).unwrap();
    let options = ReadOptions { imports: Imports::Anywhere, ..ReadOptions::default() };
    for name in ["folder.stl", "pipe.stl", "zero.stl", "/dev/zero", "/dev/full"] {
        for node in ["import", "surface"] {
            let text = format!("{node}(\"{name}\");");
            let error = read::bytes(text.as_bytes(), &model, Format::Csg, &options);
            let error = error.expect_err(name);
            let is_it = matches!(error.kind, ReadErrorKind::NoFile(_))
                || error.to_string().contains("must be a file that ends in");
            assert!(is_it, "{error}");
        }
    }
}

/// A file that says to be long, and has nothing in it, is not read to see.
#[test]
#[cfg(target_os = "linux")]
fn files_of_holes_are_too_long() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.stl");
    let file = std::fs::File::create(&path).unwrap();
    file.set_len(10_000_000_000).unwrap();
    for name in ["a.stl", "a.3mf", "a.csg"] {
        let other = folder.path().join(name);
        if other != path {
            std::fs::hard_link(&path, &other).unwrap();
        }
        let error = read::file(&other, &ReadOptions::default()).expect_err(name);
        assert!(matches!(error.kind, ReadErrorKind::TooManyBytes { .. }), "{error}");
    }
    // A head that declares ten gigabytes of triangles is no reason to make room for them.
    let mut stl = vec![0; 84 + 50];
    stl[80..84].copy_from_slice(&200_000_000_u32.to_le_bytes());
    assert_eq!(
        refused(stl, Format::Stl),
        "part.x: the file declares 200000000 triangles, but has bytes for 1"
    );
}
