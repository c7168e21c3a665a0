//! The program as its users meet it: what it prints where, and its exit codes.
#![cfg(feature = "cli")]
#![expect(clippy::float_cmp, reason = "these answers are exact")]

mod desk;

use std::fs;
use std::path::Path;
use std::process::Command;

use desk::{BALL, Desk};
use serde::Deserialize;

#[test]
fn contains_answers_each_point_and_says_no_if_any_is_out() {
    let desk = Desk::new();
    let done = desk.run(&["contains", "tube.csg", "4,0,5", "0,0,5", "-4,0,5"]);
    assert_eq!(done.out, "4,0,5 in\n0,0,5 out\n-4,0,5 in\n");
    assert_eq!(done.code, 1);
    let done = desk.run(&["contains", "tube.csg", "4,0,5"]);
    assert_eq!((done.code, done.out.as_str()), (0, "4,0,5 in\n"));
    // The boundary is not out.
    let done = desk.run(&["contains", "tube.csg", "4,0,0"]);
    assert_eq!((done.code, done.out.as_str()), (0, "4,0,0 on\n"));
}

#[test]
fn contains_reads_points_from_standard_input() {
    let desk = Desk::new();
    let input = "# x y z\n4 0 5\n\n0,0,5 # the hole\n";
    let done = desk.run_with_input(&["contains", "tube.csg", "-q"], input);
    assert_eq!((done.code, done.out.as_str()), (1, "in\nout\n"));
    let done = desk.run_with_input(&["contains", "tube.csg"], "4 0 5\n1 2\n");
    assert_eq!(done.code, 2);
    assert_eq!(
        done.err,
        "solidray: error: standard input, line 2: expected 3 numbers separated by commas, found 2\n"
    );
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ContainsJson {
    schema: u32,
    points: Vec<PointJson>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PointJson {
    point: [f64; 3],
    r#where: String,
}

#[test]
fn contains_prints_one_json_object() {
    let desk = Desk::new();
    let done = desk.run(&["contains", "tube.csg", "4,0,5", "0,0,5", "--json"]);
    let json: ContainsJson = serde_json::from_str(&done.out).expect("one object");
    assert_eq!(json.schema, 1);
    assert_eq!(json.points[0].point, [4.0, 0.0, 5.0]);
    let answers: Vec<&str> = json.points.iter().map(|p| p.r#where.as_str()).collect();
    assert_eq!(answers, ["in", "out"]);
    let done = desk.run_with_input(&["contains", "tube.csg", "--json"], "");
    let json: ContainsJson = serde_json::from_str(&done.out).expect("one object");
    assert!(json.points.is_empty());
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RayJson {
    schema: u32,
    origin: [f64; 3],
    dir: [f64; 3],
    spans: Vec<SpanJson>,
    chord: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SpanJson {
    t: [f64; 2],
    chord: f64,
    enter: CrossingJson,
    exit: CrossingJson,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CrossingJson {
    error: Option<f64>,
    point: [f64; 3],
    normal: [f64; 3],
    leaf: u32,
    face: u32,
    kind: String,
    line: Option<u32>,
    column: Option<u32>,
}

#[test]
fn ray_lists_spans_with_points_normals_and_owners() {
    let desk = Desk::new();
    let args = ["ray", "tube.csg", "--origin", "-10,0,5", "--dir", "2,0,0", "--json"];
    let done = desk.run(&args);
    assert_eq!(done.code, 0, "{}", done.err);
    let json: RayJson = serde_json::from_str(&done.out).expect("one object");
    assert_eq!(
        (json.schema, json.origin, json.dir),
        (1, [-10.0, 0.0, 5.0], [2.0, 0.0, 0.0])
    );
    assert_eq!(json.chord, 4.0);
    let [first, second] = json.spans.as_slice() else { panic!("{}", done.out) };
    assert_eq!((first.t, first.chord), ([2.5, 3.5], 2.0));
    assert_eq!(second.t, [6.5, 7.5]);
    assert_eq!(first.enter.point, [-5.0, 0.0, 5.0]);
    assert_eq!(first.enter.normal, [-1.0, 0.0, 0.0]);
    assert_eq!((first.enter.leaf, first.enter.face), (0, 0));
    assert_eq!(
        (first.exit.leaf, first.exit.line, first.exit.column),
        (1, Some(4), Some(3))
    );
    assert_eq!(first.exit.kind, "cylinder");
    let error = first.enter.error.expect("a steep ray has a bound");
    assert!(0.0 < error && error < 1e-12, "{error:e}");
}

#[test]
fn ray_takes_many_rays_from_standard_input() {
    let desk = Desk::new();
    let input = "-10 0 5 1 0 0\n-10,0,50,1,0,0\n";
    let done = desk.run_with_input(&["ray", "tube.csg", "--json"], input);
    let counts: Vec<usize> = done
        .out
        .lines()
        .map(|line| serde_json::from_str::<RayJson>(line).expect("an object a line"))
        .map(|ray| ray.spans.len())
        .collect();
    assert_eq!(counts, [2, 0]);
    let done = desk.run_with_input(&["ray", "tube.csg"], "0 0 0 0 0 0\n");
    assert_eq!(done.code, 2);
    assert_eq!(done.err, "solidray: error: the direction is zero\n");
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(dead_code, reason = "the fields that must be there, and no others")]
struct EstimateJson {
    value: f64,
    interval: [f64; 2],
    rays: u64,
    method: String,
    target_met: bool,
    resolved: bool,
    spans: u64,
    uncertain: u64,
}

#[test]
fn volume_says_value_interval_and_how() {
    let desk = Desk::new();
    let args = ["volume", "ball.csg", "--json", "--rel-tol", "1e-3", "--seed", "5"];
    let done = desk.run(&args);
    let json: serde_json::Value = serde_json::from_str(&done.out).expect("one object");
    let number = |name: &str| json[name].as_f64().expect(name);
    let exact = 36.0 * std::f64::consts::PI;
    assert!((number("value") - exact).abs() < 1e-3 * exact);
    assert!(json["interval"][0].as_f64() <= Some(number("value")));
    assert_eq!(json["method"], "lattice");
    assert_eq!(json["target_met"], true);
    assert_eq!(json["seed"], 5);
    assert!(number("rays") > 0.0 && number("seconds") >= 0.0);
    assert!(number("spans") > 0.0 && number("spans") < number("rays"));
    assert_eq!(json["uncertain"], 0);
    let again = desk.run(&[&args[..], &["-j", "1"]].concat());
    let again: serde_json::Value = serde_json::from_str(&again.out).expect("one object");
    assert_eq!(json["value"], again["value"], "the same bits on one thread");
}

#[test]
fn volume_counts_what_is_thinner_than_rounding() {
    let desk = Desk::new();
    let slab = |x: &str| {
        format!(
            "multmatrix([[1, 0, 0, {x}], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) cube(size = [1, 1, 1], center = false);"
        )
    };
    desk.put("film.csg", &format!("{} {}", slab("-1"), slab("0.00000000000002")));
    let done = desk.run(&["volume", "film.csg", "-v", "--max-rays", "4000"]);
    let spans = done.out.lines().find(|line| line.starts_with("spans")).expect(&done.out);
    assert!(
        spans.ends_with("of them or of the gaps between shorter than rounding"),
        "{spans}"
    );
    desk.put("film.csg", &format!("{} {}", slab("-1"), slab("0.000001")));
    let done = desk.run(&["volume", "film.csg", "-v", "--max-rays", "4000"]);
    assert!(done.out.contains("none of them shorter than rounding"), "{}", done.out);
}

#[test]
fn volume_without_a_solid_is_not_resolved() {
    let desk = Desk::new();
    desk.put("none.csg", &format!("difference() {{ {BALL} {BALL} }}"));
    let done = desk.run(&["volume", "none.csg", "--max-rays", "10000"]);
    assert!(done.out.starts_with("not resolved: at most "), "{}", done.out);
    assert!(done.err.contains("was not met"), "{}", done.err);
    desk.put("empty.csg", "group();\n");
    assert_eq!(desk.run(&["volume", "empty.csg"]).out, "0\n");
}

#[test]
fn solids_that_only_touch_have_no_volume_in_common() {
    let desk = Desk::new();
    let cube = "cube(size = [1, 1, 1], center = false);";
    let moved = "multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])";
    desk.put("touch.csg", &format!("intersection() {{ {cube} {moved} {{ {cube} }} }}"));
    assert_eq!(desk.run(&["volume", "touch.csg"]).out, "0\n");
    desk.put("empty.csg", "group();\n");
    let done = desk.run(&["compare", "ball.csg", "empty.csg"]);
    assert_eq!(done.code, 1, "{}", done.err);
    assert!(done.out.contains("\nB      0\n"), "{}", done.out);
}

#[test]
fn standard_input_is_the_model_or_the_list() {
    let desk = Desk::new();
    for command in ["contains", "ray"] {
        let done = desk.run_with_input(&[command, "-", "--format", "csg"], BALL);
        assert_eq!(done.code, 2, "{}", done.out);
        assert!(done.err.contains("cannot be both"), "{}", done.err);
    }
}

#[test]
fn a_round_that_comes_too_late_is_given_up() {
    let desk = Desk::new();
    let done = desk.run(&["volume", "ball.csg", "--time-limit", "1e-9", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&done.out).expect("one object");
    assert_eq!((&json["resolved"], &json["rays"]), (&false.into(), &0.into()));
    assert!(json["interval"][1].as_f64() >= Some(216.0), "the whole box: {}", done.out);
}

#[test]
fn compare_tells_same_from_different() {
    let desk = Desk::new();
    desk.put("larger.csg", "sphere($fn = 0, $fa = 12, $fs = 2, r = 3.3);\n");
    let done = desk.run(&["compare", "ball.csg", "ball.csg"]);
    assert_eq!(done.code, 0, "{}{}", done.out, done.err);
    assert!(done.out.starts_with("the same within 0.001"), "{}", done.out);
    let done = desk.run(&["compare", "ball.csg", "larger.csg", "--json"]);
    assert_eq!(done.code, 1, "{}{}", done.out, done.err);
    let json: serde_json::Value = serde_json::from_str(&done.out).expect("one object");
    for name in ["a", "b", "a_minus_b", "b_minus_a", "difference", "iou"] {
        let estimate = json[name].clone();
        serde_json::from_value::<EstimateJson>(estimate).expect(name);
    }
    let iou = json["iou"]["value"].as_f64().expect("a number");
    assert!((iou - 1.0 / 1.331).abs() < 1e-3, "{iou}");
    assert_eq!(json["worst"]["only_in"], "B");
    assert_eq!(json["verdict"], "different");
}

#[test]
fn check_says_what_is_in_a_model() {
    let desk = Desk::new();
    let done = desk.run(&["check", "tube.csg", "--json"]);
    assert_eq!(done.code, 0);
    let json: serde_json::Value = serde_json::from_str(&done.out).expect("one object");
    assert_eq!(json["schema"], 1);
    assert_eq!(json["leaves"], 2);
    assert_eq!(json["faces"], 6);
    assert_eq!(json["differences"], 1);
    assert_eq!(json["bounds"]["max"], serde_json::json!([5.0, 5.0, 10.0]));
    assert_eq!(json["warnings"], serde_json::json!([]));
    assert!(desk.run(&["check", "tube.csg"]).out.contains("2 cylinder"));
}

#[test]
fn check_says_which_curves_are_true_and_by_which_rule() {
    let desk = Desk::new();
    desk.put(
        "nut.csg",
        "difference() { cylinder(h = 3, r1 = 8, r2 = 8, $fn = 6); cylinder(h = 9, r1 = 3, r2 = 3, center = true); }
        hull() { sphere(r = 1); multmatrix([[1, 0, 0, 20]]) cylinder(h = 1, r1 = 1, r2 = 1); }
        linear_extrude(height = 3, twist = 90) square(2);",
    );
    let check = |args: &[&str]| {
        let done = desk.run(&[&["check", "nut.csg"], args].concat());
        let starts =
            |line: &&str| line.starts_with("curves") || line.starts_with("facets");
        done.out.lines().filter(starts).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(
        check(&[]),
        "curves     3 true curves, 1 deliberate polygon ($fn up to 8; --curves exact makes them round)\n\
         facets     1 node with curves that have no exact solid: within 0.005 of them (--facet-tolerance), \
         1 extrusion in slices as OpenSCAD makes them"
    );
    assert_eq!(
        check(&["--curves", "exact"]).lines().next(),
        Some("curves     4 true curves")
    );
    assert_eq!(
        check(&["--curves", "faceted"]),
        "curves     0 true curves, 4 polygons as OpenSCAD makes them (--curves faceted)\n\
         facets     1 extrusion in slices as OpenSCAD makes them"
    );
    let json: serde_json::Value =
        serde_json::from_str(&desk.run(&["check", "nut.csg", "--json"]).out)
            .expect("one");
    let counts = ["true_curves", "polygons", "fine", "sliced", "made_by_openscad"];
    assert_eq!(counts.map(|name| json[name].as_u64()), [3, 1, 1, 1, 0].map(Some));
    assert_eq!(json["facet_tolerance"], 0.005);
}

#[test]
fn objects_are_told_apart_by_their_colors() {
    let desk = Desk::new();
    desk.put(
        "two.csg",
        "color([1, 0, 0]) { cube(2); }\n  multmatrix([[1, 0, 0, 5]]) difference() { cube(2); cube(1); }\n",
    );
    let render = ["render", "two.csg", "-o", "o.png", "--look", "object", "--json"];
    let done = desk.run(&render);
    assert_eq!(done.code, 0, "{}", done.err);
    let json: serde_json::Value = serde_json::from_str(&done.out).expect("one object");
    let objects = json["objects"].as_array().expect("a list");
    let names: Vec<_> = objects.iter().map(|object| object["name"].as_str()).collect();
    assert_eq!(names, [Some("1:20"), Some("2:45")]);
    assert_ne!(objects[0]["color"], objects[1]["color"]);
    let picture = image::open(desk.path("o.png")).expect("a picture").to_rgb8();
    // Red is not among them: the colours of the model are not looked at.
    let is_red = |p: &image::Rgb<u8>| p.0[0] > 100 && p.0[1] < 60 && p.0[2] < 60;
    assert!(!picture.pixels().any(is_red));
    let done = desk.run(&["render", "two.csg", "-o", "o.png", "--look", "object", "-v"]);
    assert!(done.err.contains(" is 2:45\n"), "{}", done.err);
}

#[test]
fn check_finds_faults_and_says_where() {
    let desk = Desk::new();
    desk.put("bad.csg", "union() {\n\tnonsense(r = 1);\n}\n");
    let done = desk.run(&["check", "bad.csg"]);
    assert_eq!(done.code, 1);
    assert!(done.out.starts_with("bad.csg:2:2: "), "{}", done.out);
    let done = desk.run(&["check", "missing.csg"]);
    assert_eq!((done.code, done.out.as_str()), (2, ""));
    assert!(done.err.starts_with("solidray: error: missing.csg: "), "{}", done.err);
}

#[test]
fn render_writes_a_whole_picture_or_none() {
    let desk = Desk::new();
    let done =
        desk.run(&["render", "tube.csg", "-o", "tube.png", "--imgsize=64,48", "--json"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let json: serde_json::Value = serde_json::from_str(&done.out).expect("one object");
    for part in ["read", "compile", "trace", "write"] {
        assert!(json["seconds"][part].as_f64() >= Some(0.0), "{part}");
    }
    let picture = image::open(desk.path("tube.png")).expect("a picture").to_rgb8();
    assert_eq!(picture.dimensions(), (64, 48));
    assert_ne!(picture.get_pixel(1, 1), picture.get_pixel(32, 36));

    for (args, message) in [
        (
            ["render", "tube.csg", "-o", "tube.jpg"],
            "tube.jpg: pictures are written as .png",
        ),
        (["render", "tube.csg", "-o", "no/t.png"], "no/t.png: there is no folder no"),
        (["render", "gone.csg", "-o", "gone.png"], "gone.csg: "),
    ] {
        let done = desk.run(&args);
        assert_eq!(done.code, 2);
        assert!(done.err.contains(message), "{}", done.err);
    }
    let left = fs::read_dir(desk.path("")).expect("the folder").count();
    assert_eq!(left, 3, "two models and one picture");
}

#[test]
fn render_takes_a_camera() {
    let desk = Desk::new();
    let camera = ["--camera=0,0,5,90,0,0,60", "--camera=0,-60,5,0,0,5"];
    let pictures: Vec<Vec<u8>> = camera
        .iter()
        .map(|camera| {
            let common = ["render", "tube.csg", "-o", "v.png", "--imgsize", "40,30"];
            let done = desk.run(&[&common[..], &[camera, "--projection=o"]].concat());
            assert_eq!(done.code, 0, "{}", done.err);
            fs::read(desk.path("v.png")).expect("a picture")
        })
        .collect();
    assert_eq!(pictures[0], pictures[1], "two ways to say the same camera");
    let done = desk.run(&["render", "tube.csg", "-o", "v.png", "--camera=1,2,3"]);
    assert_eq!(done.code, 2);
}

#[test]
fn whoever_asks_for_json_gets_an_object_even_of_an_error() {
    let desk = Desk::new();
    for args in [
        &["volume", "gone.csg"][..],
        &["render", "tube.csg", "-o", "no/t.png"],
        &["check", "gone.csg"],
        &["compare", "tube.csg", "gone.csg"],
    ] {
        let done = desk.run(&[args, &["--json"]].concat());
        assert_eq!(done.code, 2, "{args:?}");
        let json: serde_json::Value =
            serde_json::from_str(&done.out).expect("one object");
        assert_eq!(json["schema"], 1);
        assert!(json["error"].as_str().is_some_and(|e| done.err.contains(e)), "{json}");
    }
    let done =
        desk.run_with_input(&["contains", "tube.csg", "--json"], "x,y,z\n4,0,5\nbad\n");
    assert_eq!(done.code, 2);
    let json: serde_json::Value = serde_json::from_str(&done.out).expect("one object");
    assert_eq!(json["points"][0]["where"], "in");
    assert!(json["error"].as_str().is_some_and(|e| e.contains("line 3")), "{json}");
}

#[test]
fn plane_differences_leave_walls_like_any_other() {
    let desk = Desk::new();
    let circle = |r: u32| format!("circle($fn = 0, $fa = 12, $fs = 2, r = {r});");
    desk.put(
        "ring.csg",
        &format!(
            "linear_extrude(height = 3) {{ difference() {{ {} {} }} }}",
            circle(5),
            circle(3)
        ),
    );
    let colours = |file: &str| {
        let done = desk.run(&["render", file, "-o", "c.png", "--imgsize", "60,40"]);
        assert_eq!(done.code, 0, "{}", done.err);
        let picture = image::open(desk.path("c.png")).expect("a picture").to_rgb8();
        picture.pixels().filter(|p| p.0[1] > p.0[0] && p.0[0] > p.0[2]).count()
    };
    assert_eq!(colours("ring.csg"), 0, "no green");
    assert!(colours("tube.csg") > 0, "green where solids are cut");
}

/// Two boxes with a common face, turned by 30°, by matrices of six digits.
const TURNED: &str = "union() {
multmatrix([[0.866025, -0.5, 0, 0], [0.5, 0.866025, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
cube(size = [17.3, 5, 5], center = false);
multmatrix([[0.866025, -0.5, 0, 14.9823], [0.5, 0.866025, 0, 8.65], [0, 0, 1, 0], [0, 0, 0, 1]])
cube(size = [5, 5, 5], center = false);
}
";

#[test]
fn check_suggests_a_weld_and_lists_what_it_joins() {
    let desk = Desk::new();
    desk.put("turned.csg", TURNED);
    let json = |args: &[&str]| {
        let done = desk.run(args);
        assert_eq!(done.code, 0, "{}", done.err);
        serde_json::from_str::<serde_json::Value>(&done.out).expect("one object")
    };
    let plain = json(&["check", "turned.csg", "--json"]);
    assert_eq!(plain["welds"], serde_json::json!([]));
    let pair = &plain["near_misses"][0]["surfaces"];
    assert_eq!((&pair[0]["line"], &pair[1]["line"]), (&3.into(), &5.into()));
    let weld = plain["suggested_weld"].as_f64().expect("a number").to_string();
    let message = plain["warnings"][0].as_str().expect("a warning");
    assert!(message.contains(&format!("--weld {weld} makes them one")), "{message}");

    let welded = json(&["check", "turned.csg", "--json", "--weld", &weld]);
    assert_eq!(welded["warnings"], serde_json::json!([]));
    assert_eq!(welded["welds"][0]["surfaces"], *pair);
    let text = desk.run(&["check", "turned.csg", "--weld", &weld]).out;
    assert!(text.contains("\nwelds      "), "{text}");
    assert!(
        text.contains("\n  3:1 (cuboid, face 1) and 5:1 (cuboid, face 0), "),
        "{text}"
    );

    let ray = ["ray", "turned.csg", "--origin=-8.66025,-3.5,1", "--dir=0.866025,0.5,0"];
    let spans = |weld: &str| {
        json(&[&ray[..], &["--json", "--weld", weld]].concat())["spans"]
            .as_array()
            .map(Vec::len)
    };
    assert_eq!((spans("0"), spans(&weld)), (Some(2), Some(1)));
    let done = desk.run(&["check", "turned.csg", "--weld", "7"]);
    assert_eq!(done.code, 1, "{}", done.out);
    assert!(done.out.contains("a weld of 7 joins two faces of"), "{}", done.out);
    assert_eq!(desk.run(&["check", "turned.csg", "--weld=-1"]).code, 2);
}

#[test]
fn trees_larger_than_allowed_are_refused() {
    let desk = Desk::new();
    let done = desk.run(&["volume", "tube.csg", "--max-nodes", "3"]);
    assert_eq!(done.code, 2, "{}", done.out);
    let message = "tube.csg: the solid has more than 3 leaves, operators, maps and tags";
    assert!(done.err.contains(message), "{}", done.err);
    assert_eq!(desk.run(&["volume", "tube.csg", "--max-nodes", "30"]).code, 0);
}

#[test]
fn what_is_too_large_for_numbers_is_refused() {
    let desk = Desk::new();
    let cubes = |e: i32| {
        desk.put("cube.csg", &format!("cube(size = [1e{e}, 1e{e}, 1e{e}]);"));
        desk.put("half.csg", &format!("cube(size = [1e{e}, 1e{e}, 5e{}]);", e - 1));
    };
    for exponent in [-120, 120] {
        cubes(exponent);
        for args in [
            &["volume", "cube.csg"][..],
            &["measure", "cube.csg"],
            &["compare", "cube.csg", "half.csg"],
            &["overlaps", "cube.csg"],
        ] {
            let done = desk.run(args);
            assert_eq!(done.code, 2, "{args:?}: {}", done.out);
            let message = format!("the model is 1e{exponent} wide: ");
            assert!(done.err.contains(&message), "{args:?}: {}", done.err);
            assert!(done.err.contains("Scale it"), "{args:?}: {}", done.err);
        }
    }
    desk.put("long.csg", "cube(size = [1e110, 1, 1]);");
    assert_eq!(desk.run(&["volume", "long.csg"]).code, 0);
    assert_eq!(desk.run(&["measure", "long.csg"]).code, 2);
    desk.put("long.csg", "cube(size = [1e70, 1, 1]);");
    assert_eq!(desk.run(&["measure", "long.csg"]).code, 0);
    for exponent in [-90, 90] {
        cubes(exponent);
        let done = desk.run(&["volume", "cube.csg"]);
        assert_eq!(done.code, 0, "{}", done.err);
        assert_eq!(desk.run(&["measure", "cube.csg"]).code, 2);
        let done = desk.run(&["compare", "cube.csg", "half.csg"]);
        assert_eq!(done.code, 1, "{}", done.err);
        assert!(done.out.starts_with("different"), "{}", done.out);
    }
}

#[test]
fn wrong_usage_is_code_2() {
    let desk = Desk::new();
    for args in [
        &["volume"][..],
        &["volume", "ball.csg", "--rel-tol", "0"],
        &["ray", "ball.csg", "--origin", "1,2"],
        &["contains", "ball.csg", "1,2"],
        &["render", "ball.csg"],
        &["dance"],
    ] {
        let done = desk.run(args);
        assert_eq!(done.code, 2, "{args:?}: {}", done.out);
        assert!(done.out.is_empty() && !done.err.is_empty(), "{args:?}");
    }
}

#[test]
fn standard_input_can_be_the_model() {
    let desk = Desk::new();
    let done = desk.run_with_input(&["contains", "-", "--format", "csg", "0,0,0"], BALL);
    assert_eq!(done.out, "0,0,0 in\n", "{}", done.err);
    let done = desk.run_with_input(&["volume", "-"], BALL);
    assert_eq!(done.code, 2);
    assert!(done.err.contains("--format"), "{}", done.err);
}

#[test]
fn limits_of_reading_can_be_raised() {
    let desk = Desk::new();
    desk.put("round.csg", "sphere(r = 1, $fn = 100);\n");
    let faceted = ["check", "round.csg", "--curves", "faceted", "--max-facets"];
    let done = desk.run(&[&faceted[..], &["9999"]].concat());
    let said = "round.csg:1:1: with this one, curves and polygons have 10000 triangles, which is \
                more than the limit of 9999; --max-facets raises it";
    assert_eq!(done.code, 1);
    assert!(done.out.starts_with(said), "{}{}", done.out, done.err);
    assert_eq!(desk.run(&[&faceted[..], &["10000"]].concat()).code, 0);

    let length = BALL.len().to_string();
    let less = (BALL.len() - 1).to_string();
    let said = format!(
        "there are more bytes to read than the limit of {less}; --max-bytes raises it"
    );
    let point = ["--format", "csg", "0,0,0", "--max-bytes"];
    for (file, input) in [("ball.csg", ""), ("-", BALL)] {
        let contains = [&["contains", file], &point[..]].concat();
        let done = desk.run_with_input(&[&contains[..], &[&length]].concat(), input);
        assert_eq!(done.code, 0, "{file}: {}", done.err);
        let done = desk.run_with_input(&[&contains[..], &[&less]].concat(), input);
        assert_eq!(done.code, 2, "{file}");
        assert!(done.err.contains(&said), "{}", done.err);
    }
}

#[test]
#[cfg(unix)]
fn a_broken_pipe_is_no_failure() {
    let desk = Desk::new();
    let program = Path::new(env!("CARGO_BIN_EXE_solidray")).display().to_string();
    let script = format!(
        "yes '0 0 0' | head -n 200000 | {{ {program} contains ball.csg; echo $? >&2; }} | head -n 1"
    );
    let done = Command::new("sh")
        .args(["-c", &script])
        .current_dir(desk.path(""))
        .output()
        .expect("a shell");
    assert_eq!(String::from_utf8_lossy(&done.stdout), "0,0,0 in\n");
    assert_eq!(String::from_utf8_lossy(&done.stderr), "0\n");
}
