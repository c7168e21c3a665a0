//! Where versions of OpenSCAD make different polyhedra of the same text: `ReadOptions::rules`.

#[path = "support/openscad.rs"]
mod openscad;

use std::path::Path;

use solidray::read::{self, Curves, Format, ReadOptions, Rules};
use solidray::{Aabb, Scene, Solid};

fn solid(text: &str, rules: Rules) -> Solid {
    let options = ReadOptions { curves: Curves::Faceted, rules, ..Default::default() };
    let read = read::bytes(text.as_bytes(), Path::new("test.csg"), Format::Csg, &options);
    let model = read.unwrap_or_else(|error| panic!("{error}: {text}"));
    assert_eq!(model.warnings, [], "{text}");
    model.solid
}

fn bounds(solid: &Solid) -> Aabb {
    Scene::compile(solid).expect("a solid").bounds()
}

/// `M(x, y)` is a translation.
fn written_out(text: &str) -> String {
    let mut parts = text.split("M(");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (numbers, rest) = part.split_once(')').expect("a parenthesis");
        let (x, y) = numbers.split_once(',').expect("two numbers");
        out +=
            &format!("multmatrix([[1,0,0,{x}],[0,1,0,{y}],[0,0,1,0],[0,0,0,1]]){rest}");
    }
    out
}

/// Texts with the volume and the extents in x and y of the meshes that OpenSCAD 2025.07.18 makes of
/// them (with `--backend=manifold`, as OFF, of which it writes six digits).
const MADE_IN_2025: [(&str, f64, [f64; 2], [f64; 2]); 19] = [
    (
        "linear_extrude(height = 5, twist = 90) square(3);",
        46.583488795575335,
        [0.0, 4.19041],
        [-3.0, 3.0],
    ),
    (
        "linear_extrude(height = 5, twist = -90, $fn = 20) square(3);",
        45.192924257729004,
        [-3.0, 3.0],
        [0.0, 4.19041],
    ),
    (
        "linear_extrude(height = 5, twist = 90, segments = 10, slices = 3) square(3);",
        46.740453992636375,
        [0.0, 4.09808],
        [-3.0, 3.0],
    ),
    (
        "linear_extrude(height = 5, twist = 90, segments = 0, slices = 3) square(3);",
        50.49045468435695,
        [0.0, 4.09808],
        [-3.0, 3.0],
    ),
    (
        "linear_extrude(height = 10, scale = [2, 0.5], $fn = 30) M(4, 1) square([3, 2]);",
        64.99999809110159,
        [4.0, 14.0],
        [0.5, 3.0],
    ),
    (
        "linear_extrude(height = 10, scale = [2, 1], twist = 45) difference() { square(10, center = true); M(1, 1) square(3); }",
        1368.0000512140064,
        [-14.1421, 14.1421],
        [-7.07107, 7.07107],
    ),
    (
        "linear_extrude(height = 10, scale = 0.5, twist = 200) M(5, 0) square([6, 2], center = true);",
        70.95601878077882,
        [-4.6754, 8.0],
        [-6.45151, 1.83793],
    ),
    (
        "linear_extrude(height = 10, scale = [0, 1], twist = 60) square([6, 2], center = true);",
        61.12433711473059,
        [-3.0, 3.0],
        [-3.09808, 3.09808],
    ),
    (
        "linear_extrude(height = 10, twist = 100) circle($fn = 5.5, r = 4);",
        384.0794346316945,
        [-3.97139, 4.0],
        [-3.9916, 3.99398],
    ),
    ("linear_extrude(v = [1, 2, 3]) square(3);", 27.0, [0.0, 4.0], [0.0, 5.0]),
    (
        "linear_extrude(height = 4, v = [1, 2, 3], center = true, scale = 0.5) square(3);",
        16.837486603570003,
        [-0.534522, 2.46548],
        [-1.06904, 2.56904],
    ),
    (
        "linear_extrude(height = 4, v = [1, 2, 3], center = true, twist = 80) square(3);",
        29.929379618494284,
        [-0.534522, 4.36534],
        [-2.06355, 2.29813],
    ),
    (
        "rotate_extrude(angle = 100, $fn = 7) M(3, 0) square(2);",
        24.513453919149995,
        [-0.868241, 5.0],
        [0.0, 4.92404],
    ),
    (
        "rotate_extrude(angle = -100, $fn = 7) M(3, 0) square(2);",
        24.51345391915,
        [-0.868241, 5.0],
        [-4.92404, 0.0],
    ),
    (
        "rotate_extrude($fn = 5) M(3, 0) square(2);",
        76.08438632667998,
        [-5.0, 4.04508],
        [-4.75528, 4.75528],
    ),
    (
        "rotate_extrude(angle = 360, $fn = 5) M(3, 0) square(2);",
        76.08438632667998,
        [-4.04508, 5.0],
        [-4.75528, 4.75528],
    ),
    (
        "rotate_extrude(angle = 360, start = 20, $fn = 5) M(-5, 0) square(2);",
        76.08446530150601,
        [-4.69846, 4.80631],
        [-4.99695, 4.14519],
    ),
    (
        "rotate_extrude(angle = 100, start = 30) M(3, 0) square(2);",
        27.361605983999993,
        [-3.21394, 4.33013],
        [1.5, 5.0],
    ),
    (
        "rotate_extrude(angle = 200, start = 30) M(-5, 0) square(2);",
        54.46071368004001,
        [-4.33013, 4.97651],
        [-4.96619, 3.83022],
    ),
];

#[test]
fn the_rules_of_2025_make_the_meshes_of_2025() {
    let mut wrong = Vec::new();
    for (text, volume, x, y) in MADE_IN_2025 {
        let solid = solid(&written_out(text), Rules::V2025);
        let found = openscad::enclosed(&solid);
        let bounds = bounds(&solid);
        let extents = [bounds.min.x - x[0], bounds.max.x - x[1]];
        let extents = [extents, [bounds.min.y - y[0], bounds.max.y - y[1]]];
        let farthest = extents.into_iter().flatten().map(f64::abs).fold(0.0, f64::max);
        if (found - volume).abs() > 1e-5 * volume || farthest > 1e-4 {
            wrong.push(format!("{text}: {found} for {volume}, {bounds:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_rules_of_2021_make_the_meshes_of_the_installed_program() {
    if !openscad::is_installed("the rules of 2021 are not compared with it") {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut wrong = Vec::new();
    for (text, ..) in MADE_IN_2025 {
        // These it does not know, and of the last it makes an open mesh.
        let unknown = ["v =", "start =", "segments =", "[0, 1]"];
        if unknown.iter().any(|new| text.contains(new)) {
            continue;
        }
        let text = written_out(text);
        let file = folder.path().join("test.csg");
        std::fs::write(&file, &text).expect("it can be written");
        let expected = openscad::volume_of(&file);
        let found = openscad::enclosed(&solid(&text, Rules::V2021));
        if (found - expected).abs() > 1e-5 * expected {
            wrong.push(format!("{text}: {found} for {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What versions print is read by either's rules.
#[test]
fn both_syntaxes_are_read() {
    let old = "linear_extrude(height = 5, center = false, convexity = 1, scale = [1, 1], $fn = 0, $fa = 12, $fs = 2) square(size = [3, 3], center = false);";
    let new =
        "linear_extrude(height = 5, $fn = 0, $fa = 12, $fs = 2) square(size = [3, 3]);";
    let leaning = "linear_extrude(height = 3.74166, v = [ 0.267261, 0.534522, 0.801784], $fn = 0, $fa = 12, $fs = 2) square(3);";
    for rules in [Rules::V2021, Rules::V2025] {
        assert_eq!(bounds(&solid(old, rules)), bounds(&solid(new, rules)));
        let top = bounds(&solid(leaning, rules)).max.to_array();
        for (found, expected) in top.into_iter().zip([4.0, 5.0, 3.0]) {
            assert!((found - expected).abs() < 1e-4, "{found} {expected}");
        }
        // As printed by each for a full turn; a pentagon shows where it starts.
        let start = |text: &str| {
            let text = written_out(&format!(
                "rotate_extrude({text}, $fn = 5, $fa = 12, $fs = 2) M(3, 0) square(2);"
            ));
            if bounds(&solid(&text, rules)).min.x < -4.5 { "left" } else { "right" }
        };
        let of_2021 = if rules == Rules::V2021 { "left" } else { "right" };
        assert_eq!(start("angle = 360, convexity = 2"), of_2021);
        assert_eq!(start("angle = 360, start = 180, convexity = 2"), "left");
        assert_eq!(start("angle = 360, start = 0, convexity = 2"), "right");
        assert_eq!(start("convexity = 2"), "left");
    }
}

#[test]
fn divided_edges_are_counted_before_they_are_made() {
    let text =
        "linear_extrude(height = 5, twist = 90, segments = 4e9, slices = 2) square(3);";
    let options = ReadOptions { rules: Rules::V2025, ..Default::default() };
    let read = read::bytes(text.as_bytes(), Path::new("test.csg"), Format::Csg, &options);
    let error = read.expect_err("they are too many").to_string();
    assert!(error.starts_with("test.csg:1:1: with this one, curves"), "{error}");
}
