//! What `#` and `%` mark in a `.csg`.

use std::path::Path;

use glam::{DVec3, dvec3};
use solidray::read::{self, Format, Model, ReadOptions};
use solidray::{Aabb, Scene, Solid};

fn model(text: &str) -> Model {
    let options = ReadOptions { marks: true, ..ReadOptions::default() };
    read::bytes(text.as_bytes(), Path::new("marks.csg"), Format::Csg, &options)
        .expect("a model")
}

fn bounds(solid: &Solid) -> Aabb {
    Scene::compile(solid).expect("a solid").bounds()
}

fn cube(min: DVec3, max: DVec3) -> Aabb {
    Aabb::new(min, max)
}

#[test]
fn what_is_marked_moves_with_the_maps_around_it() {
    let moved = |x: i32, what: &str| {
        format!("multmatrix([[1,0,0,{x}],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {{ {what} }}")
    };
    let inner = moved(10, "%cube(2); #cube(3);");
    let text = moved(
        100,
        &format!("difference() {{ cube(5); color([1,0,0,1]) {{ {inner} }} }}"),
    );
    let Model { solid, marks, warnings, .. } = model(&text);
    assert!(warnings.is_empty(), "{warnings:?}");
    let at = |x: f64, size: f64| {
        cube(dvec3(x, 0.0, 0.0), dvec3(x, 0.0, 0.0) + DVec3::splat(size))
    };
    assert_eq!(bounds(&solid), at(100.0, 5.0));
    assert_eq!(bounds(&marks.background), at(110.0, 2.0));
    assert_eq!(bounds(&marks.highlighted), at(110.0, 3.0));
}

#[test]
fn what_is_marked_in_a_hull_or_an_intersection_is_shown_whole() {
    for around in ["hull", "intersection", "minkowski", "render", "resize"] {
        let Model { marks, .. } =
            model(&format!("{around}() {{ cube(1); %sphere(4, $fn = 100); #cube(6); }}"));
        // A hull makes polygons of what is in it; what is beside it stays round.
        assert_eq!(bounds(&marks.background).max, DVec3::splat(4.0), "{around}");
        assert_eq!(bounds(&marks.highlighted).max, DVec3::splat(6.0), "{around}");
    }
}

#[test]
fn only_solids_are_shown_and_only_if_asked_for() {
    let text = "%square(2); #cube(1); %cylinder(h = 2, r = 1, $fn = 100);";
    let Model { solid, marks, counts, .. } = model(text);
    assert_eq!(bounds(&solid).max, DVec3::ONE);
    assert_eq!(bounds(&marks.background).max, dvec3(1.0, 1.0, 2.0));
    assert_eq!(bounds(&marks.highlighted).max, DVec3::ONE);
    assert_eq!(counts.curves, 0, "what is beside the model does not count");

    let plain = read::bytes(
        text.as_bytes(),
        Path::new("marks.csg"),
        Format::Csg,
        &ReadOptions::default(),
    );
    let Model { solid, marks, .. } = plain.expect("a model");
    assert_eq!(bounds(&solid).max, DVec3::ONE);
    assert!(
        bounds(&marks.background).is_empty() && bounds(&marks.highlighted).is_empty()
    );
}

#[test]
fn what_is_beside_the_model_cannot_spoil_it() {
    for wrong in [
        "%nonsense(1);",
        "%sphere(r = \"a\");",
        "%union() { cube(3); nonsense(); cube(4); }",
        "union() { %group() { cube(7); multmatrix(1) { sphere(1); } } }",
        "%import(file = \"missing.stl\");",
        "%multmatrix([[0,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,1]]) { cube(1); }",
    ] {
        let Model { solid, marks, warnings, .. } = model(&format!("{wrong} cube(2);"));
        assert_eq!(bounds(&solid).max, DVec3::splat(2.0), "{wrong}");
        assert!(bounds(&marks.background).is_empty(), "{wrong}");
        assert_eq!(warnings.len(), 1, "{wrong}: {warnings:?}");
        assert_eq!(warnings[0].place.map(|place| place.line), Some(1));
    }
    // A file that is not there is an error where nothing else is, and not when it is beside.
    assert!(bounds(&model("%import(file = \"missing.stl\");").solid).is_empty());
}

#[test]
fn marks_within_marks_are_read_once_each() {
    let depth = 20_000;
    for mark in ["%", "#", "%#"] {
        let open = format!("{mark}group() {{").repeat(depth);
        let Model { marks, .. } =
            model(&format!("{open} cube(1); {}", "}".repeat(depth)));
        let shown = marks.highlighted + marks.background;
        assert_eq!(bounds(&shown).max, DVec3::ONE, "{mark}");
        assert_eq!(shown.census().leaves, 1, "{mark}");
    }
    // What is taken away is shown by its own mark only.
    let Model { marks, .. } = model("#difference() { cube(4); #cube(2); }");
    assert_eq!(marks.highlighted.census().leaves, 3);
}

#[test]
fn what_is_beside_the_model_uses_up_nothing() {
    let twisted = |height: f64| {
        format!(
            "linear_extrude(height = {height}, twist = 90, slices = 40) {{ square(5); }}"
        )
    };
    let text = format!("%{} {}", twisted(5.0), twisted(6.0));
    let with = |marks, max_facets| {
        let options = ReadOptions { marks, max_facets, ..ReadOptions::default() };
        read::bytes(text.as_bytes(), Path::new("marks.csg"), Format::Csg, &options)
    };
    let enough = (1..).map(|i| 100 * i).find(|&limit| with(false, limit).is_ok());
    assert!(with(true, enough.expect("a limit")).is_ok());
}
