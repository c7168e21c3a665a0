//! What trees mean, asked point by point, and the vertices of faceted curves.

use std::path::Path;

use glam::{DVec3, dvec3};

use super::super::{Curves, Model, ReadOptions};
use super::read;
use crate::mesh::Mesh;
use crate::op::Op;
use crate::primitive::Curved;
use crate::solid::{Kind, Solid};

fn model(text: &str, curves: Curves) -> Model {
    let options = ReadOptions { curves, ..ReadOptions::default() };
    read(text.as_bytes(), Path::new("test.csg"), &options).unwrap()
}

/// Whether a point is inside, by the definitions and by recursion.
fn contains(solid: &Solid, p: DVec3) -> bool {
    let node = solid.node();
    let mut children = node.children.iter();
    match &node.kind {
        Kind::Primitive(primitive) => {
            let primitive = primitive.describe();
            let is_in_wall =
                primitive.wall().is_none_or(|Curved { profile, ends: [a, b] }| {
                    let [zz, z, one] = profile.coefficients();
                    (a..=b).contains(&p.z)
                        && p.truncate().length_squared()
                            <= (zz * p.z + 2.0 * z) * p.z + one
                });
            is_in_wall && primitive.planes().iter().all(|f| f.normal.dot(p) <= f.offset)
        }
        Kind::Mesh(mesh) => winding(mesh, p) > 0.5,
        Kind::Boolean(Op::Union) => children.any(|c| contains(c, p)),
        Kind::Boolean(Op::Intersection) => children.all(|c| contains(c, p)),
        Kind::Boolean(Op::Difference) => {
            children.next().is_some_and(|c| contains(c, p))
                && !children.any(|c| contains(c, p))
        }
        Kind::Mapped(map) => {
            contains(&node.children[0], map.inverse().transform_point3(p))
        }
        Kind::Tagged(_) => contains(&node.children[0], p),
    }
}

/// The winding number as a sum of solid angles (A. van Oosterom, J. Strackee, "The solid
/// angle of a plane triangle", 1983).
fn winding(mesh: &Mesh, p: DVec3) -> f64 {
    let angle = |f: &[u32; 3]| {
        let [a, b, c] = f.map(|i| (mesh.points()[i as usize] - p).normalize());
        let cosines = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
        2.0 * a.dot(b.cross(c)).atan2(cosines)
    };
    mesh.faces().iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// The answers for points on the x-axis at 0.5, 1.5, 2.5 … slightly off the symmetry.
fn row(text: &str) -> String {
    let solid = model(text, Curves::Auto).solid;
    (0..6)
        .map(|i| contains(&solid, dvec3(f64::from(i) + 0.5, 0.03, 0.02)))
        .map(|inside| if inside { '#' } else { '.' })
        .collect()
}

/// The volume of the only mesh in a tree without maps.
fn volume(text: &str) -> f64 {
    let mut solid = model(text, Curves::Faceted).solid;
    loop {
        if let Kind::Mesh(mesh) = &solid.node().kind {
            return mesh.volume();
        }
        let child = solid.node().children[0].clone();
        solid = child;
    }
}

const LONG: &str = "cube([6, 2, 2], center = true);";
const BALL: &str = "sphere(r = 2, $fn = 0);";
const NONE: &str = "cube(0);";

#[test]
fn operators_follow_openscad() {
    let cases = [
        (format!("{LONG} {BALL}"), "###..."),
        (format!("difference() {{ {LONG} {BALL} }}"), "..#..."),
        (format!("intersection() {{ {LONG} {BALL} }}"), "##...."),
        (format!("difference() {{ {LONG} }}"), "###..."),
        (format!("difference() {{ {NONE} {LONG} }}"), "......"),
        (format!("difference() {{ {LONG} {NONE} }}"), "###..."),
        (format!("difference() {{ group(); {LONG} }}"), "......"),
        (format!("intersection() {{ {LONG} group(); }}"), "......"),
        (format!("union() {{ group(); {BALL} }}"), "##...."),
        (format!("difference() {{ %{LONG} {BALL} {LONG} }}"), "......"),
        (
            format!("difference() {{\n%\t\thull() {{ {LONG} }}\n{LONG} {BALL} }}"),
            "..#...",
        ),
        (format!("intersection() {{ %{LONG} {BALL} }}"), "##...."),
        (format!("difference() {{ {LONG} *{BALL} }}"), "###..."),
        (format!("difference() {{ {LONG} #{BALL} }}"), "..#..."),
        (format!("difference() {{ {LONG} !{BALL} }} {LONG}"), "##...."),
        (format!("*group() {{ !{LONG} }} {BALL}"), "##...."),
        (format!("render(convexity = 2) color([1, 0, 0]) {BALL}"), "##...."),
        (
            "sphere(r = -1); sphere(r = nan); cylinder(h = inf); square(0);".into(),
            "......",
        ),
        (
            format!("multmatrix([[1,0,0,3],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {BALL}"),
            ".####.",
        ),
        (
            format!("multmatrix([[1,0,0,3],[0,1,0,0],[0,0,1,0],[0,0,0,2]]) {BALL}"),
            ".#....",
        ),
        (
            format!("multmatrix([[1,0,0,0],[0,0,0,0],[0,0,1,0],[0,0,0,1]]) {BALL}"),
            "......",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(row(&text), expected, "{text}");
    }
}

#[test]
fn plane_shapes_are_extruded() {
    let flat = [
        ("circle(r = 3);", "###..."),
        ("difference() { square([10, 6], center = true); circle(r = 2); }", "..###."),
        // 5 − (4 − (3 − 1)): the rings 1…3 and 4…5.
        (
            "difference() { circle(r = 5); difference() { circle(r = 4); \
             difference() { circle(r = 3); circle(r = 1); } } }",
            ".##.#.",
        ),
        ("intersection() { circle(r = 5); square(3); }", "###..."),
        (
            "multmatrix([[1,0,0,3],[0,1,0,0],[0,0,0,9],[0,0,0,1]]) circle(r = 2);",
            ".####.",
        ),
        ("square(2, center = true); cube(9);", "#....."),
        ("polygon([[-1,-1],[3,-1],[3,1],[-1,1]], paths = []);", "###..."),
        ("polygon([[-1,-1],[3,-1],[3,1],[-1,1]], paths = [[]]);", "......"),
        (
            "polygon([[-1,-1],[6,-1],[6,1],[-1,1],[1,-.5],[1,.5],[3,.5],[3,-.5]], \
          [[0,1,2,3],[4,5,6,7]]);",
            "#..###",
        ),
    ];
    for (text, expected) in flat {
        let text = format!("linear_extrude(height = 4, center = true) {{ {text} }}");
        assert_eq!(row(&text), expected, "{text}");
    }
    let ends = model("linear_extrude(height = 3) square(2);", Curves::Auto).solid;
    for (z, inside) in [(-0.1, false), (0.1, true), (2.9, true), (3.1, false)] {
        assert_eq!(contains(&ends, dvec3(1.0, 1.0, z)), inside, "at {z}");
    }
}

#[test]
fn dimensions_are_not_mixed() {
    let read = model("difference() { cube(2); square(1); }", Curves::Auto);
    assert!(contains(&read.solid, DVec3::splat(0.5)));
    let message = "1:1: `difference` starts three-dimensional; 1 two-dimensional child \
                   counts as nothing";
    assert_eq!(read.warnings[0].to_string(), message);
    for text in [
        "intersection() { cube(2); square(1); }",
        "intersection() { cube(2); cube(1); group() { square(1); } }",
        "linear_extrude(height = 3) intersection() { square(1); cube(2); }",
    ] {
        assert_eq!(row(text), "......", "{text}");
        assert_eq!(model(text, Curves::Auto).warnings.len(), 1, "{text}");
    }
}

#[test]
fn faceted_curves_have_openscads_volumes() {
    let close = |a: f64, b: f64| (a - b).abs() < 5e-6 * b;
    assert!(close(volume("sphere(r = 10);"), 4112.86));
    assert!((volume("sphere(r = 1);") - 2.402).abs() < 5e-4);
    let ngon = |n: f64| 0.5 * n * (std::f64::consts::TAU / n).sin();
    assert!(close(volume("cylinder(h = 2, r1 = 3, r2 = 3, $fn = 6);"), 18.0 * ngon(6.0)));
    assert!(close(
        volume("cylinder(h = 3, r1 = 2, r2 = 0, $fn = 7.9);"),
        4.0 * ngon(7.0)
    ));
    assert!(close(volume("cylinder(h = 3, r1 = 0, r2 = 2, $fn = 1);"), 4.0 * ngon(3.0)));
    assert!(close(volume("cylinder(h = 3, r1 = 1, r2 = 2);"), 7.0 * ngon(7.0)));
}

#[test]
fn curves_are_what_the_options_ask_for() {
    let text = "cylinder(r = 1, $fn = 6); cylinder(r = 1, $fn = 9); sphere(r = 5); \
                linear_extrude(1) circle(r = 1, $fn = 8);";
    for (curves, expected) in [
        (Curves::Auto, [2, 2, 0]),
        (Curves::Exact, [4, 0, 0]),
        (Curves::Faceted, [0, 0, 4]),
    ] {
        let counts = model(text, curves).counts;
        assert_eq!([counts.curves, counts.polygons, counts.faceted], expected);
    }
}

#[test]
fn equal_faceted_curves_share_a_mesh() {
    let solid = model("sphere(r = 5); sphere(r = 5);", Curves::Faceted).solid;
    let mesh = |i: usize| match &solid.node().children[i].node().children[0].node().kind {
        Kind::Mesh(mesh) => Some(mesh.clone()),
        Kind::Primitive(_) | Kind::Boolean(_) | Kind::Mapped(_) | Kind::Tagged(_) => None,
    };
    let (a, b) = (mesh(0).unwrap(), mesh(1).unwrap());
    assert!(std::sync::Arc::ptr_eq(&a, &b));
}

#[test]
fn polyhedra_are_clockwise_and_put_right() {
    let points = "[[0,0,0],[6,0,0],[0,6,0],[0,0,6]]";
    let good = "[[0,1,2],[0,3,1],[1,3,2],[0,2,3]]";
    let turned = "[[2,1,0],[1,3,0],[2,3,1],[3,2,0]]";
    let clean = model(&format!("polyhedron({points}, {good});"), Curves::Auto);
    assert!(clean.warnings.is_empty());
    let put_right = model(&format!("polyhedron({points}, {turned});"), Curves::Auto);
    assert_eq!(put_right.counts.turned, 1);
    assert_eq!(
        put_right.warnings[0].to_string(),
        "1:1: the mesh was inside out and has been turned"
    );
    for text in [
        format!("polyhedron(points = {points}, triangles = {good});"),
        format!("polyhedron(points = {points}, faces = {turned});"),
        format!(
            "polyhedron(points = {points}, faces = [[0,1,1,9,2],[0,3,1,0],[1,3,2],[0,2,3]]);"
        ),
        // Every face with points of its own.
        "polyhedron(points = [[0,0,0],[6,0,0],[0,6,0],[0,0,0],[0,0,6],[6,0,0],[6,0,0],\
         [0,0,6],[0,6,0],[-0,0,0],[0,6,0],[0,0,6]], \
         faces = [[0,1,2],[3,4,5],[6,7,8],[9,10,11]]);"
            .to_owned(),
    ] {
        assert!((volume(&text) - 36.0).abs() < 1e-12, "{text}");
    }
    for text in ["polyhedron();", "polyhedron(points = [], faces = []);"] {
        assert_eq!(row(text), "......");
    }
}

/// By rays, to a hundred-thousandth.
fn volume_of(solid: &Solid) -> f64 {
    let scene = crate::Scene::compile(solid).expect("a solid");
    let sampling = crate::measure::Sampling { rel_tol: 1e-5, ..Default::default() };
    crate::measure::volume(&scene, &sampling).value
}

#[test]
fn outlines_are_turned_about_an_axis() {
    let ngon = |n: f64| 0.5 * n * (std::f64::consts::TAU / n).sin();
    let exact = |text: &str| volume_of(&model(text, Curves::Auto).solid);
    let faceted = |text: &str| volume(text);
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 4e-5, "{a} {b}");
    let pi = std::f64::consts::PI;
    // A ring of rectangular section, a part of it, and one that is turned the other way.
    let ring = "translate2 { square([1, 2]); }"
        .replace("translate2", "multmatrix([[1,0,0,3],[0,1,0,0],[0,0,1,0],[0,0,0,1]])");
    near(exact(&format!("rotate_extrude() {{ {ring} }}")), pi * 7.0 * 2.0);
    for angle in [90.0, -90.0, 200.0] {
        let text = format!("rotate_extrude(angle = {angle}) {{ {ring} }}");
        near(exact(&text), pi * 14.0 * f64::abs(angle) / 360.0);
    }
    let text = format!("rotate_extrude($fn = 12) {{ {ring} }}");
    near(faceted(&text), ngon(12.0) * 14.0);
    let text = format!("rotate_extrude(angle = 90, $fn = 12) {{ {ring} }}");
    near(faceted(&text), ngon(12.0) * 14.0 / 4.0);
    // A torus by Pappus, whose section is a polygon of the same area.
    let disc = ring.replace("square([1, 2])", "circle(r = 1)");
    near(exact(&format!("rotate_extrude() {{ {disc} }}")), 2.0 * pi * 3.0 * pi);
    // A cone with its tip on the axis, on either side; and what crosses it.
    let cone = "rotate_extrude() { polygon([[0, 0], [-2, 0], [0, 3]]); }";
    near(exact(cone), 4.0 * pi);
    near(faceted(&cone.replace("()", "($fn = 8)")), 4.0 * ngon(8.0));
    let found = model("rotate_extrude() { square(2, center = true); }", Curves::Auto);
    assert_eq!(found.solid.census().leaves, 0);
    assert!(
        found.warnings[0].message.contains("crosses its axis"),
        "{:?}",
        found.warnings
    );
    // Circles with a small $fn are meant to be polygons.
    near(exact(&format!("rotate_extrude($fn = 6) {{ {ring} }}")), ngon(6.0) * 14.0);
}

#[test]
fn extrusions_taper_and_twist() {
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 4e-5, "{a} {b}");
    let exact = |text: &str| volume_of(&model(text, Curves::Auto).solid);
    let pi = std::f64::consts::PI;
    // Frusta of a square, of a circle beside the axis, and of what is cut from it.
    let shape = "difference() { square(4, center = true); SHIFT circle(r = 1); }"
        .replace("SHIFT", "multmatrix([[1,0,0,0.5],[0,1,0,0.5],[0,0,1,0],[0,0,0,1]])");
    for (scale, factor) in [(0.5, 1.75 / 3.0), (0.0, 1.0 / 3.0), (2.0, 7.0 / 3.0)] {
        let text = format!("linear_extrude(height = 3, scale = {scale}) {{ {shape} }}");
        near(exact(&text), 3.0 * (16.0 - pi) * factor);
        let centered = text.replace("scale", "center = true, scale");
        near(exact(&centered), 3.0 * (16.0 - pi) * factor);
    }
    // Where the tip of a cone is, and that it leans.
    let text = "linear_extrude(height = 4, scale = 0) multmatrix([[1,0,0,5],[0,1,0,0],\
                [0,0,1,0],[0,0,0,1]]) circle(r = 1);";
    let cone = model(text, Curves::Auto).solid;
    assert!(contains(&cone, DVec3::new(1.3, 0.0, 3.0)));
    assert!(!contains(&cone, DVec3::new(5.0, 0.0, 3.0)));
    // A wedge, with one edge at the top.
    near(
        exact("linear_extrude(height = 3, scale = [1, 0]) square(2, center = true);"),
        6.0,
    );
    // The sides are divided as OpenSCAD divides them: its volume. Half way it is turned half.
    let text =
        "linear_extrude(height = 4, twist = 90, slices = 64) square(2, center = true);";
    near(exact(text), 16.129_27);
    let twisted = model(text, Curves::Auto).solid;
    let at = |x: f64, y: f64| contains(&twisted, DVec3::new(x, y, 2.0));
    assert!(at(1.3, 0.0) && at(0.0, -1.3) && !at(0.95, 0.95));
    // Clockwise as seen from above.
    let eighth = |y: f64| contains(&twisted, DVec3::new(1.08, y, 0.7));
    assert!(eighth(0.5) && !eighth(-0.5));
}

#[test]
fn open_polyhedra_are_left_out() {
    let open = "polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], \
                faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2]]);";
    let found = model(&format!("cube(2);\n{open}"), Curves::Auto);
    assert_eq!(found.solid.census().leaves, 1);
    let message = found.warnings[0].to_string();
    assert!(message.starts_with("2:1: the mesh is not closed"), "{message}");
    assert!(message.ends_with("it is left out, as by OpenSCAD"), "{message}");
    // Points apart by less than OpenSCAD can tell are one, where that closes the mesh.
    let nearly = "polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], \
                  [-2e-16, 0, 0]], faces = [[0, 1, 2], [4, 3, 1], [1, 3, 2], [0, 2, 3]]);";
    assert!((volume(nearly) - 1.0 / 6.0).abs() < 1e-12);
    // For a hull its corners are enough.
    assert!((volume(&format!("hull() {{ {open} }}")) - 1.0 / 6.0).abs() < 1e-12);
    // What cuts with it cuts with nothing; what it is cut from is nothing.
    let cut = model(&format!("difference() {{ cube(2); {open} }}"), Curves::Auto);
    assert_eq!(cut.solid.census().leaves, 1);
}
