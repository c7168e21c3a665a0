//! `measure` and `merge` as their users meet them.
#![cfg(feature = "cli")]
#![expect(clippy::float_cmp, reason = "these numbers are equal to the bit")]

mod desk;

use desk::Desk;
use serde_json::Value;

/// A steel ball and a lighter cube beside it, and a plain cube that both leave alone.
const PARTS: &str = "group() {
color([1, 0, 0, 1]) { sphere($fn = 0, $fa = 12, $fs = 2, r = 3); }
color([0, 0, 1, 1]) {
multmatrix([[1, 0, 0, 10], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { cube(size = [2, 2, 2], center = true); }
}
multmatrix([[1, 0, 0, 20], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { cube(size = [1, 1, 1], center = true); }
}
";

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect(text)
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn measure_says_what_a_ball_is() {
    let desk = Desk::new();
    let done = desk.run(&["measure", "ball.csg", "--rel-tol", "1e-3", "--density", "2"]);
    assert_eq!((done.code, &*done.err), (0, ""));
    for line in ["volume     113.", "surface    113.", "centroid ", "mass       226."] {
        assert!(done.out.contains(line), "{line} {}", done.out);
    }
    let done = desk.run(&[
        "measure",
        "ball.csg",
        "--rel-tol",
        "1e-3",
        "--density",
        "2",
        "--json",
    ]);
    let found = json(&done.out);
    let whole = &found["whole"]["properties"];
    let truth = 36.0 * std::f64::consts::PI;
    assert!((number(&whole["volume"]["value"]) - truth).abs() < 3e-3 * truth);
    assert!((number(&whole["area"]["value"]) - truth).abs() < 3e-3 * truth);
    assert_eq!(whole["target_met"], true);
    let mass = number(&found["mass"]["mass"]["value"]);
    assert_eq!(mass, 2.0 * number(&whole["volume"]["value"]));
    assert_eq!(found["parts"], json("[]"));
}

#[test]
fn parts_are_measured_each_with_its_density() {
    let desk = Desk::new();
    desk.put("parts.csg", PARTS);
    let densities = ["--density", "1", "--density", "#ff0000=7.85"];
    let mut args = vec!["measure", "parts.csg", "--rel-tol", "1e-3", "--json"];
    args.extend(densities);
    let found = json(&desk.run(&args).out);
    let names = [0, 1, 2].map(|i| found["parts"][i]["name"].clone());
    assert_eq!(names, ["#ff0000", "#0000ff", "other"]);
    let ball = 36.0 * std::f64::consts::PI;
    let mass = 7.85 * ball + 8.0 + 1.0;
    assert!((number(&found["mass"]["mass"]["value"]) - mass).abs() < 3e-3 * mass);
    let middle = (80.0 + 20.0) / mass;
    let x = number(&found["mass"]["body"]["centroid"][0]["value"]);
    assert!((x - middle).abs() < 0.01, "{x} {middle}");
    // A part without a density, and a density without a part.
    let done = desk.run(&["measure", "parts.csg", "--density", "#ff0000=1"]);
    assert_eq!(done.code, 2);
    assert!(done.err.contains("some part has none"), "{}", done.err);
    let done = desk.run(&["measure", "parts.csg", "--density", "lid=1"]);
    assert!(done.err.contains("no part `lid`; there are: #ff0000"), "{}", done.err);
    // What is in two parts is said to be.
    desk.put(
        "both.csg",
        "color([1, 0, 0, 1]) { cube(size = 2, center = true); }
        color([0, 1, 0, 1]) { cube(size = 1, center = true); }",
    );
    let done = desk.run(&["measure", "both.csg", "--rel-tol", "1e-3"]);
    assert!(done.out.contains("they overlap: "), "{}", done.out);
}

#[test]
fn objects_are_measured_each_with_its_density() {
    let desk = Desk::new();
    desk.put(
        "two.csg",
        "cube(size = 2, center = true);\n  multmatrix([[1, 0, 0, 9]]) cube(size = 1, center = true);\n",
    );
    let measure = |more: &[&str]| {
        let args =
            ["measure", "two.csg", "--rel-tol", "1e-3", "--by", "object", "--density"];
        desk.run(&[&args, more].concat())
    };
    let densities = ["1", "--density", "2:30=5"];
    let found = json(&measure(&[&densities[..], &["--json"]].concat()).out);
    assert_eq!(found["by"], "objects");
    let names = [0, 1].map(|i| found["parts"][i]["name"].clone());
    assert_eq!(names, ["1:1", "2:30"]);
    assert!((number(&found["mass"]["mass"]["value"]) - 13.0).abs() < 0.05);
    let text = measure(&densities).out;
    assert!(text.contains("\nobjects, each by itself\n  1:1   volume "), "{text}");
    let done = measure(&["lid=1"]);
    assert!(done.err.contains("no object `lid`; there are: 1:1, 2:30"), "{}", done.err);
    // Runs of objects are merged like those of parts, but not with them.
    desk.put("0.json", &measure(&["1", "--seed", "0", "--json"]).out);
    desk.put("1.json", &measure(&["1", "--seed", "1", "--json"]).out);
    let merged = json(&desk.run(&["merge", "0.json", "1.json", "--json"]).out);
    assert_eq!(merged["parts"][1]["name"], "2:30");
    let parts = ["measure", "two.csg", "--rel-tol", "1e-3", "--density", "1", "--json"];
    desk.put("2.json", &desk.run(&[&parts[..], &["--seed", "2"]].concat()).out);
    let done = desk.run(&["merge", "0.json", "2.json"]);
    assert!(done.err.contains("other parts or densities"), "{}", done.err);
}

#[test]
fn merged_runs_have_the_bits_of_one_run() {
    let desk = Desk::new();
    desk.put("parts.csg", PARTS);
    let tolerance = ["--rel-tol", "3e-3", "--density", "0.3", "--json"];
    let mut files = Vec::new();
    for seed in ["5", "6", "7"] {
        let mut args = vec!["measure", "parts.csg", "--seed", seed];
        args.extend(tolerance);
        desk.put(&format!("{seed}.json"), &desk.run(&args).out);
        files.push(format!("{seed}.json"));
    }
    let mut args = vec!["measure", "parts.csg", "--seed", "5", "--seeds", "3"];
    args.extend(tolerance);
    let one = json(&desk.run(&args).out);
    let merged = desk.run(&["merge", "7.json", "5.json", "6.json", "--json"]);
    assert_eq!(merged.code, 0, "{}", merged.err);
    let merged = json(&merged.out);
    assert_eq!(merged["mass"], one["mass"]);
    assert_eq!(merged["whole"]["properties"], one["whole"]["properties"]);
    for i in 0..3 {
        assert_eq!(merged["parts"][i]["properties"], one["parts"][i]["properties"]);
    }
    // What was merged can be merged again.
    desk.put("57.json", &desk.run(&["merge", "7.json", "5.json", "--json"]).out);
    let again = json(&desk.run(&["merge", "57.json", "6.json", "--json"]).out);
    assert_eq!(again["mass"], one["mass"]);
    let text = desk.run(&["merge", "5.json", "6.json"]);
    assert!(text.out.starts_with("volume     122."), "{}", text.out);
}

#[test]
fn what_cannot_be_merged_is_said_to_be() {
    let desk = Desk::new();
    let measured = |file, seed| {
        desk.run(&["measure", file, "--rel-tol", "1e-2", "--seed", seed, "--json"]).out
    };
    desk.put("a.json", &measured("ball.csg", "1"));
    desk.put("tube.json", &measured("tube.csg", "2"));
    desk.put("volume.json", &desk.run(&["volume", "ball.csg", "--json"]).out);
    let fails = |files: &[&str], with: &str| {
        let done = desk.run(&[&["merge"], files].concat());
        assert!(done.code == 2 && done.err.contains(with), "{} {}", done.code, done.err);
    };
    fails(&["a.json", "a.json"], "the same seed 1");
    fails(&["a.json", "tube.json"], "different solids");
    fails(&["volume.json"], "volume.json: it is not what `measure --json` prints");
    fails(&["ball.csg"], "ball.csg: it is not what `measure --json` prints");
    fails(&["none.json"], "none.json");
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_with_the_numbers_found_so_far() {
    use std::process::{Command, Stdio};
    let desk = Desk::new();
    for command in ["measure", "volume"] {
        let child = Command::new(env!("CARGO_BIN_EXE_solidray"))
            .args([command, "tube.csg", "--rel-tol", "1e-12", "--json"])
            .args(["--max-rays", "1000000000000"])
            .current_dir(desk.path(""))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        // Long enough for it to start on a busy machine.
        std::thread::sleep(std::time::Duration::from_secs(3));
        let kill = format!("kill -INT {}", child.id());
        let kill = Command::new("sh").args(["-c", &kill]).status();
        assert!(kill.expect("there is a shell").success());
        let output = child.wait_with_output().expect("it ends");
        assert!(output.status.success(), "{output:?}");
        let found = json(&String::from_utf8(output.stdout).expect("text"));
        let volume = match command {
            "measure" => &found["whole"]["properties"]["volume"],
            _ => &found,
        };
        assert!((number(&volume["value"]) - 160.0 * std::f64::consts::PI).abs() < 1.0);
        assert_eq!(volume["target_met"], false);
    }
}

#[test]
fn overlaps_names_pairs_that_share_volume() {
    let desk = Desk::new();
    let cube = |x: f64, size: f64| {
        format!(
            "multmatrix([[1, 0, 0, {x}], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {{ cube(size = {size}, center = true); }}\n"
        )
    };
    let red = |inner: String| format!("color([1, 0, 0, 1]) {{ {inner} }}\n");
    // Two that overlap by half a unit, one that touches, and one far away.
    let all =
        [red(cube(0.0, 2.0)), cube(1.0, 1.0), cube(2.0, 1.0), cube(9.0, 1.0)].concat();
    desk.put("all.csg", &all);
    let done = desk.run(&["overlaps", "all.csg", "--rel-tol", "1e-3"]);
    assert_eq!(done.code, 1, "{}", done.err);
    assert!(done.out.starts_with("#ff0000 and other  0."), "{}", done.out);
    assert!(done.out.contains(", 0.500000 deep at 0."), "{}", done.out);
    assert_eq!(done.out.lines().count(), 1);
    let by_object =
        ["overlaps", "all.csg", "--rel-tol", "1e-3", "--by", "objects", "--json"];
    let done = json(&desk.run(&by_object).out);
    assert_eq!(done["looked_at"], 4);
    assert_eq!(done["overlaps"].as_array().map(Vec::len), Some(1));
    assert!((number(&done["overlaps"][0]["volume"]["value"]) - 0.5).abs() < 2e-3);
    desk.put("apart.csg", &[cube(0.0, 1.0), cube(1.0, 1.0), cube(5.0, 1.0)].concat());
    let done = desk.run(&["overlaps", "apart.csg"]);
    assert_eq!((done.code, &*done.out), (0, "none of the 3 overlaps another\n"));
}

#[test]
fn volumes_are_found_to_many_digits_where_surfaces_are_few() {
    let desk = Desk::new();
    let adaptive = ["volume", "ball.csg", "--method", "adaptive", "--rel-tol", "1e-12"];
    let done = desk.run(&[&adaptive[..], &["--json"]].concat());
    let found = json(&done.out);
    let truth = 36.0 * std::f64::consts::PI;
    assert!((number(&found["value"]) - truth).abs() < 1e-12 * truth, "{}", done.out);
    assert_eq!(
        (&found["method"], &found["target_met"]),
        (&"adaptive".into(), &true.into())
    );
    desk.put(
        "mesh.off",
        "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
    );
    let done = desk.run(&["volume", "mesh.off", "--method", "adaptive"]);
    assert_eq!(done.code, 2);
    assert!(done.err.contains("--method adaptive: "), "{}", done.err);
}
