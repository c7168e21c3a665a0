//! `hull`, `minkowski`, `projection` and `resize` against closed forms and OpenSCAD.

#[path = "support/openscad.rs"]
mod openscad;

use std::f64::consts::PI;
use std::path::Path;

use solidray::Scene;
use solidray::measure::{self, Sampling};
use solidray::read::{self, Curves, Format, Model, ReadOptions};

fn model(text: &str, curves: Curves) -> Model {
    let options = ReadOptions { curves, ..ReadOptions::default() };
    let read = read::bytes(text.as_bytes(), Path::new("test.csg"), Format::Csg, &options);
    read.unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn volume(model: &Model, rel_tol: f64) -> f64 {
    let scene = Scene::compile(&model.solid).expect("a solid");
    if scene.bounds().is_empty() {
        return 0.0;
    }
    measure::volume(&scene, &Sampling { rel_tol, ..Sampling::default() }).value
}

fn at(x: f64, y: f64, z: f64) -> String {
    format!("multmatrix([[1,0,0,{x}],[0,1,0,{y}],[0,0,1,{z}],[0,0,0,1]])")
}

/// `M(x, y, z)` is a translation.
fn written_out(text: &str) -> String {
    let mut parts = text.split("M(");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (numbers, rest) = part.split_once(')').expect("a parenthesis");
        let n: Vec<f64> =
            numbers.split(',').map(|n| n.trim().parse().expect("a number")).collect();
        out += &at(n[0], n[1], n[2]);
        out += rest;
    }
    out
}

#[test]
fn nodes_have_the_volumes_of_closed_forms() {
    let ball = |r: f64| 4.0 / 3.0 * PI * r.powi(3);
    let rounded = |[x, y, z]: [f64; 3], r: f64| {
        x * y * z + 2.0 * r * (x * y + y * z + z * x) + PI * r * r * (x + y + z) + ball(r)
    };
    let cases = [
        // A quarter of a cylinder.
        ("hull() rotate_extrude(angle = 90) square([5, 2]);", 12.5 * PI),
        // A half of a ring, and a box on the other side.
        (
            "hull() { rotate_extrude(angle = 180, start = 90) M(3, 0, 0) square(2); M(0, -5, 0) cube([1, 10, 2]); }",
            2.0 * (12.5 * PI + 10.0),
        ),
        // A capsule, along an axis and across.
        (
            "hull() { sphere(r = 10); M(30, 0, 0) sphere(r = 10); }",
            3000.0 * PI + ball(10.0),
        ),
        (
            "hull() { sphere(r = 10); M(0, 0, 30) sphere(r = 10); }",
            3000.0 * PI + ball(10.0),
        ),
        (
            "hull() { sphere(r = 10); M(10, 20, 20) sphere(r = 10); }",
            3000.0 * PI + ball(10.0),
        ),
        ("hull() { sphere(r = 3); }", ball(3.0)),
        ("hull() { cube(1); M(2, 0, 0) cube(1); }", 3.0),
        ("hull() { cube(1); M(2, 2, 2) cube(1); }", 1.0 + 3.0 * 2.0),
        ("hull() { cube(2); cube(0); group(); square(9); }", 8.0),
        ("hull() { difference() { cube(2); M(1, 1, 1) cube(2); } }", 8.0 - 1.0 / 6.0),
        ("hull() { M(0, 0, 1) sphere(r = 0); }", 0.0),
        (
            "minkowski() { cube([40, 30, 20]); sphere(r = 10); }",
            rounded([40.0, 30.0, 20.0], 10.0),
        ),
        ("minkowski() { sphere(r = 10); }", ball(10.0)),
        ("minkowski() { cube(2); group(); }", 8.0),
        ("minkowski() { cube(1); cube(2); cube(3); }", 216.0),
        (
            "minkowski() { cube(2); M(9, 0, 0) difference() { cube(4); cube(3); } }",
            216.0 - 27.0,
        ),
        // The sum of two corners of cubes.
        ("minkowski() { union() { cube(1); M(5, 0, 0) cube(1); } cube(1); }", 16.0),
        // A cube in a hollow one that it does not fill: the hollow shrinks.
        (
            "minkowski() { difference() { cube(9); M(2, 2, 2) cube(5); } cube(1); }",
            1000.0 - 64.0,
        ),
        (
            "minkowski() { difference() { cube(9); M(2, 2, 2) cube(5); } \
             difference() { cube(1); M(0.25, 0.25, 0.25) cube(0.5); } }",
            1000.0 - 64.0,
        ),
        (
            "linear_extrude(2) hull() { circle(r = 10); M(30, 0, 0) circle(r = 10); }",
            2.0 * (600.0 + 100.0 * PI),
        ),
        (
            "linear_extrude(2) minkowski() { square([30, 20]); circle(r = 10); }",
            2.0 * (600.0 + 1000.0 + 100.0 * PI),
        ),
        (
            "linear_extrude(2) minkowski() { difference() { square(10); M(2, 2, 0) square(6); } \
             square(2); }",
            2.0 * (144.0 - 16.0),
        ),
        (
            "linear_extrude(2) minkowski() { difference() { square(10); M(2, 2, 0) square(6); } \
             difference() { square(2); M(0.5, 0.5, 0) square(1); } }",
            2.0 * (144.0 - 16.0),
        ),
        ("linear_extrude(2) projection() { sphere(r = 10); }", 200.0 * PI),
        (
            "linear_extrude(2) projection(cut = true) { M(0, 0, 6) sphere(r = 10); }",
            128.0 * PI,
        ),
        ("linear_extrude(2) projection(cut = true) cylinder(h = 1, r = 5);", 50.0 * PI),
        (
            "linear_extrude(1) projection(cut = true) difference() { M(-5, -5, -5) cube(10); \
             cube([2, 3, 2]); }",
            94.0,
        ),
        (
            "linear_extrude(1) projection() difference() { cube(10); M(2, 2, -1) cube([3, 4, 12]); }",
            88.0,
        ),
        ("linear_extrude(1) projection(cut = true) M(0, 0, 1) cube(1);", 0.0),
        ("resize(newsize = [20, 0, 0], auto = [0, 1, 1]) sphere(r = 3);", ball(10.0)),
        ("resize(newsize = [20, 10, 30]) M(7, 7, 7) sphere(r = 3);", ball(1.0) * 750.0),
        (
            "resize(newsize = [4, 6, 8]) difference() { cube(4); M(2, -1, -1) cube(9); }",
            192.0,
        ),
        ("linear_extrude(1) resize(newsize = [20, 10, 0]) circle(r = 3);", 50.0 * PI),
        (
            "linear_extrude(1) resize([10, 0], true) difference() { square(4); M(2, -1, 0) square(9); }",
            200.0,
        ),
    ];
    for (text, expected) in cases {
        let found = volume(&model(&written_out(text), Curves::Auto), 1e-5);
        let room = if text.contains("projection") { 1e-3 } else { 1e-4 };
        assert!(
            (found - expected).abs() <= room * expected,
            "{text}: {found}, not {expected}, {:.1e}",
            found / expected - 1.0
        );
    }
}

/// What OpenSCAD is asked as well.
const TEXTS: &[&str] = &[
    "hull() { cube(1); M(2, 3, 4) cube(2); }",
    "hull() { sphere(r = 3); M(9, 1, 0) sphere(r = 1); }",
    "hull() { cylinder(h = 2, r1 = 3, r2 = 0); M(5, 0, 3) cylinder(h = 1, r1 = 1, r2 = 1); }",
    "hull() { multmatrix([[-1,0,0,3],[0,2,0,0],[0,0,1,0],[0,0,0,1]]) cylinder(h = 2, r1 = 3, r2 = 1); \
     cube([9, 1, 1]); }",
    "hull() { group(); cube(0); M(1, 1, 1) sphere(r = 2); }",
    "hull() { hull() { cube(1); M(3, 0, 0) cube(1); } M(0, 0, 4) sphere(r = 1); }",
    "hull() { difference() { sphere(r = 4); M(0, 0, 4) cube(5, center = true); } cube([1, 9, 1]); }",
    "hull() { intersection() { sphere(r = 4); M(2, 0, 0) sphere(r = 4); } M(0, 9, 0) cube(1); }",
    "hull() { linear_extrude(height = 3) circle(r = 2); M(4, 4, 4) cube(1); square(2); }",
    "difference() { hull() { cube(3); M(3, 0, 0) cylinder(h = 3, r = 2); } M(1, 1, -1) cylinder(h = 9, r = 1); }",
    "linear_extrude(height = 2) hull() { circle(r = 2); M(5, 1, 0) square(2); cube(1); }",
    "linear_extrude(height = 2) hull() { difference() { square(5); M(3, 3, 0) square(5); } circle(r = 1); }",
    "minkowski() { cube([4, 3, 2]); sphere(r = 1); }",
    "minkowski() { cube([4, 3, 2]); cylinder(h = 1, r1 = 1, r2 = 1); }",
    "minkowski() { cylinder(h = 3, r1 = 2, r2 = 0); M(8, 0, 0) sphere(r = 1); }",
    "minkowski() { difference() { cube(6); M(1, 1, 1) cube(9); } M(5, 5, 5) cube(1); }",
    "minkowski() { difference() { cube(4); cube(3); } difference() { cube(3); cube(2); } }",
    "minkowski() { difference() { cube([8, 8, 2]); M(4, 4, -1) cylinder(h = 9, r = 2); } \
     cylinder(h = 1, r1 = 1, r2 = 0); }",
    "minkowski() { cube(1); sphere(r = 1); cube([3, 1, 1]); }",
    "minkowski() { group(); cube(2); group() { cube(0); } }",
    "minkowski() { union() { cube([5, 1, 1]); cube([1, 5, 1]); } multmatrix([[-1,0,0,0],[0,1,0,0],[0,0,2,0],[0,0,0,1]]) \
     cylinder(h = 1, r1 = 1, r2 = 0); }",
    "linear_extrude(height = 2) minkowski() { square([4, 3]); circle(r = 1); }",
    "linear_extrude(height = 2) minkowski() { difference() { square(9); M(2, 2, 0) square(5); } circle(r = 1); }",
    "linear_extrude(height = 2) minkowski() { difference() { square(9); M(1, 1, 0) square(9); } \
     difference() { square(3); M(1, 1, 0) square(3); } }",
    "linear_extrude(height = 2) projection() { sphere(r = 3); M(2, 0, 0) cube(4); }",
    "linear_extrude(height = 2) projection() rotate_extrude() M(4, 0, 0) circle(r = 1);",
    "linear_extrude(height = 2) projection() multmatrix([[1,0,0,0],[0,0.8,-0.6,0],[0,0.6,0.8,0],[0,0,0,1]]) \
     difference() { cylinder(h = 2, r = 5); M(0, 0, -1) cylinder(h = 9, r = 4); }",
    "linear_extrude(height = 2) projection(cut = true) { cube([2, 3, 1]); M(0, 0, -1) cube([1, 5, 1]); }",
    "linear_extrude(height = 2) projection(cut = true) M(0, 0, 1) sphere(r = 3);",
    "linear_extrude(height = 2) projection(cut = true) difference() { sphere(r = 5); M(0, 0, -3) cube(3); }",
    "linear_extrude(height = 2) projection(cut = true) difference() { M(-5, -5, -5) cube(10); cube([2, 3, 2]); }",
    "linear_extrude(height = 2) projection(cut = true) intersection() { M(-5, -5, -10) cube(10); sphere(r = 3); }",
    "linear_extrude(height = 2) projection(cut = true) multmatrix([[1,0,0,0],[0,0.8,-0.6,0],[0,-0.6,-0.8,0],[0,0,0,1]]) \
     cylinder(h = 8, r = 2, center = true);",
    "resize(newsize = [10, 0, 0], auto = [false, true, false]) cube([1, 2, 3]);",
    "resize(newsize = [4, 4, 0], auto = [true, true, true]) cube([1, 8, 3]);",
    "resize(newsize = [4, 9, 0], auto = true) cube([1, 8, 3]);",
    "resize(newsize = [-4, 2, 0], auto = [true, false, true]) cube([1, 8, 3]);",
    "resize(newsize = [10, 5, 30]) M(5, 0, 0) sphere(r = 3);",
    "resize(newsize = [10, 5, 0]) difference() { sphere(r = 3); M(1, -9, -9) cube(20); }",
    "resize(newsize = [7, 0, 7]) hull() { sphere(r = 3); M(9, 1, 0) cube(1); }",
    "linear_extrude(height = 1) resize(newsize = [10, 0, 7], auto = true) square([1, 2]);",
    "linear_extrude(height = 1) resize(newsize = [10, 3, 0]) difference() { circle(r = 2); M(1, -4, 0) square(9); }",
];

#[test]
fn nodes_have_the_volumes_of_openscad() {
    if !openscad::is_installed("hulls are not compared with it") {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.csg");
    let mut wrong = Vec::new();
    for text in TEXTS {
        let text = written_out(text);
        std::fs::write(&file, &text).expect("it is written");
        let expected = openscad::volume_of(&file);
        let found = volume(&model(&text, Curves::Faceted), 5e-5);
        if (found - expected).abs() > 3e-4 * expected {
            wrong.push(format!("{text}: {found}, not {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_has_no_end_is_refused_where_it_stands() {
    let options = ReadOptions { max_facets: 1000, ..ReadOptions::default() };
    let text = "cube(1);\n minkowski() { difference() { sphere(r = 1, $fn = 8); cube(1); } \
                difference() { sphere(r = 2, $fn = 8); cube(1); } }";
    let error =
        read::bytes(text.as_bytes(), Path::new("test.csg"), Format::Csg, &options)
            .expect_err("too many");
    assert!(error.to_string().starts_with("test.csg:2:2: "), "{error}");
    assert!(error.to_string().contains("more than the limit of 1000"), "{error}");
}
