//! `tradeoff` as its users meet it.
#![cfg(feature = "cli")]

mod desk;

use desk::Desk;
use serde_json::Value;

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect(text)
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn errors_fall_with_what_they_cost() {
    let desk = Desk::new();
    let args = [
        "tradeoff",
        "tube.csg",
        "-o",
        "t.png",
        "--csv",
        "t.csv",
        "--time-limit",
        "6",
        "--json",
    ];
    let done = desk.run(&args);
    assert_eq!(done.code, 0, "{}", done.err);
    let report = json(&done.out);
    let reference = &report["volumes"]["reference"];
    let truth = 160.0 * std::f64::consts::PI;
    assert!((number(&reference["value"]) / truth - 1.0).abs() < 1e-9, "{reference}");

    let series = report["volumes"]["series"].as_array().expect("methods");
    let names: Vec<&str> = series.iter().filter_map(|s| s["name"].as_str()).collect();
    assert_eq!(names, ["lattice", "adaptive", "points", "bracket", "facets (Manifold)"]);
    let of = |name: &str| series.iter().find(|s| s["name"] == name).expect("it is there");
    let errors = |name: &str| -> Vec<f64> {
        let trials = of(name)["trials"].as_array().expect("trials");
        trials.iter().map(|trial| number(&trial["error"])).collect()
    };
    assert!(number(&of("lattice")["order"]) < -0.7, "{}", of("lattice"));
    // Points have order −½; only the first budgets are sure to get all their runs.
    let points = number(&of("points")["order"]);
    assert!((-0.8..-0.2).contains(&points), "{}", of("points"));
    // What n segments miss of a circle falls like 1/n², and tubes are made of circles.
    let facets = errors("facets (Manifold)");
    assert!(facets.len() >= 3, "{facets:?}");
    for pair in facets.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((3.5..4.5).contains(&ratio), "{facets:?}");
    }
    let eight = 1.0 - 4.0 * std::f64::consts::FRAC_PI_4.sin() / std::f64::consts::PI;
    assert!((facets[0] / eight - 1.0).abs() < 1e-6, "{facets:?}");

    let outlines = report["pictures"]["series"].as_array().expect("pictures");
    for series in outlines {
        let trials = series["trials"].as_array().expect("trials");
        for pair in trials.windows(2) {
            assert!(number(&pair[1]["error"]) < number(&pair[0]["error"]), "{series}");
        }
    }

    let csv = std::fs::read_to_string(desk.path("t.csv")).expect("a table");
    let trials = series.iter().chain(outlines).map(|s| &s["trials"]);
    let count: usize = trials.map(|t| t.as_array().map_or(0, Vec::len)).sum();
    assert_eq!(csv.lines().count(), 1 + count);
    let png = image::open(desk.path("t.png")).expect("a picture").into_rgb8();
    // The colours of the first method and of facets are there.
    for color in [[0, 114, 178], [213, 94, 0]] {
        assert!(png.pixels().filter(|p| p.0 == color).count() > 500, "{color:?}");
    }
}

#[test]
fn it_says_why_something_is_left_out() {
    let desk = Desk::new();
    desk.put(
        "tetra.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
    );
    let done = desk.run(&["tradeoff", "tetra.obj", "--time-limit", "1"]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(done.out.starts_with("volume 1.66666666666666"), "{}", done.out);
    assert!(done.err.contains("adaptive is left out: leaf 0 is a mesh"), "{}", done.err);
    assert!(done.err.contains("the model has no curves"), "{}", done.err);
}

#[test]
fn what_cannot_be_done_is_said_at_once() {
    let desk = Desk::new();
    desk.put("empty.csg", "group();\n");
    let error = |args: &[&str]| {
        let done = desk.run(args);
        assert_eq!((done.code, &*done.out), (2, ""));
        done.err
    };
    let text = error(&["tradeoff", "empty.csg"]);
    assert!(text.contains("empty.csg: the model is empty"), "{text}");
    let text = error(&["tradeoff", "ball.csg", "-o", "plot.gif"]);
    assert!(text.contains("plot.gif: plots are written as .png"), "{text}");
    let text = error(&["tradeoff", "ball.csg", "--csv", "no/where.csv"]);
    assert!(text.contains("there is no folder no"), "{text}");
}
