//! The program beside the OpenSCAD that it runs: here a script that does as it is told.
#![cfg(all(feature = "cli", unix))]

mod desk;

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::time::{Duration, Instant};

use desk::{Desk, Done};

/// A desk with a model for OpenSCAD and one with a node for it, and a script in its place.
fn desk(script: &str) -> Desk {
    let desk = Desk::new();
    desk.put("part.scad", "cube(2);\n");
    desk.put("roof.csg", "cube(1);\n  roof() { square(2); }\n");
    desk.put("fake", &format!("#!/bin/sh\n{script}\n"));
    let may_run = fs::Permissions::from_mode(0o755);
    fs::set_permissions(desk.path("fake"), may_run).expect("it is there");
    desk
}

fn asked(desk: &Desk, file: &str, more: &[&str]) -> Done {
    let args = ["contains", file, "1,1,1", "--openscad", "./fake"];
    desk.run(&[&args, more].concat())
}

#[test]
fn what_takes_too_long_is_stopped() {
    let desk = desk("exec sleep 60");
    for (file, place) in [("part.scad", "part.scad"), ("roof.csg", "roof.csg:2:3")] {
        let start = Instant::now();
        let done = asked(&desk, file, &["--openscad-limit", "0.2"]);
        let said = format!(
            "solidray: error: {place}: openscad was stopped after 0.2 seconds; --openscad-limit gives it more\n"
        );
        assert!(done.code == 2 && done.err.starts_with(&said), "{}", done.err);
        assert!(start.elapsed() < Duration::from_secs(30));
    }
    // That nothing is known of a model is no fault of it.
    let done = desk.run(&[
        "check",
        "part.scad",
        "--openscad",
        "./fake",
        "--openscad-limit",
        "0.2",
    ]);
    assert_eq!(done.code, 2);
    // A long text that nobody reads does not make it wait.
    let text = "cube(2);\n".repeat(100_000);
    let args = ["--format", "scad", "--openscad", "./fake", "--openscad-limit", "0.2"];
    let done = desk.run_with_input(&[&["volume", "-"], &args[..]].concat(), &text);
    assert!(done.err.contains("stopped after 0.2 seconds"), "{}", done.err);
    let done = asked(&desk, "part.scad", &["--openscad-limit", "0"]);
    assert!(done.err.contains("is not a finite number above zero"), "{}", done.err);
}

#[test]
fn warnings_are_passed_on() {
    let desk = desk(
        "echo 'WARNING: no such thing' >&2; echo >&2; echo 'ECHO: 7' >&2; echo 'cube(2);' > \"$3\"",
    );
    let done = asked(&desk, "part.scad", &[]);
    assert_eq!(done.out, "1,1,1 in\n");
    assert_eq!(
        done.err,
        "solidray: warning: part.scad: openscad: WARNING: no such thing\nsolidray: warning: part.scad: openscad: ECHO: 7\n"
    );
    let done = asked(&desk, "part.scad", &["-q"]);
    assert_eq!(done.err, "");
    // Those about a node have its place, and are said once though it is asked twice.
    let desk = self::desk(
        r#"echo 'WARNING: thin ice' >&2
        case "$3" in
        *.off) echo 'Current top level object is not a 3D object.' >&2; exit 1;;
        *) echo '<path d="M 0,0 L 2,0 L 2,2 z" stroke="black"/>' > "$3";;
        esac"#,
    );
    desk.put("roof.csg", "linear_extrude(height = 2)\n  fill() { square(2); }\n");
    let done = asked(&desk, "roof.csg", &[]);
    assert_eq!(
        done.err,
        "solidray: warning: roof.csg:2:3: openscad: WARNING: thin ice\n\
         solidray: warning: roof.csg:2:3: `fill` is left to OpenSCAD, which makes facets\n"
    );
}

#[test]
fn what_it_says_when_it_fails_is_told() {
    let desk = desk("echo 'ERROR: out of cheese' >&2; exit 3");
    let done = asked(&desk, "part.scad", &[]);
    assert_eq!(
        (done.code, done.err.as_str()),
        (
            2,
            "solidray: error: part.scad: openscad could not convert it (exit status: 3): ERROR: out of cheese\n"
        )
    );
    let desk = self::desk("exit 0");
    let done = asked(&desk, "part.scad", &[]);
    assert!(done.err.contains("it ended well, but wrote nothing"), "{}", done.err);
}

/// Ctrl-C on a terminal is for all processes of the group.
#[test]
fn it_stays_in_the_group_of_processes() {
    let desk = desk("ps -o pgid= -p $$ > group; echo 'cube(2);' > \"$3\"");
    let done = asked(&desk, "part.scad", &[]);
    assert_eq!(done.code, 0, "{}", done.err);
    let group = fs::read_to_string(desk.path("group")).expect("it was written");
    let own = std::process::Command::new("ps")
        .args(["-o", "pgid=", "-p", &std::process::id().to_string()])
        .output()
        .expect("it runs");
    assert_eq!(group.trim(), String::from_utf8_lossy(&own.stdout).trim());
}
