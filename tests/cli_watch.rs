//! `solidray render --watch`.
#![cfg(feature = "cli")]

mod desk;

use std::fs;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use desk::{BALL, Desk, TUBE};

/// A program that is stopped at the end of the test, however that ends.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Waits until something is the case, on a busy machine for long.
fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < Duration::from_secs(60), "{what}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn a_picture_follows_its_model_through_errors() {
    let desk = Desk::new();
    desk.put("part.csg", BALL);
    let log = fs::File::create(desk.path("log")).expect("a file");
    let child = Command::new(env!("CARGO_BIN_EXE_solidray"))
        .args(["render", "part.csg", "-o", "part.png", "--watch", "--imgsize", "64,48"])
        .current_dir(desk.path(""))
        .stdin(Stdio::null())
        .stderr(log)
        .spawn()
        .expect("the program starts");
    let mut running = Running(child);
    let said = || fs::read_to_string(desk.path("log")).unwrap_or_default();
    let drawn = || said().matches("is drawn").count();
    until("the first picture", || drawn() == 1);
    let ball = fs::read(desk.path("part.png")).expect("a picture");

    desk.put("part.csg", "cube(size = 1");
    until("the error", || said().contains("part.csg:1:14: expected `,` or `)`"));
    assert_eq!(fs::read(desk.path("part.png")).expect("a picture"), ball);

    desk.put("part.csg", TUBE);
    until("the next picture", || drawn() == 2);
    assert_ne!(fs::read(desk.path("part.png")).expect("a picture"), ball);

    // What it may import is in its folder; the picture there is no reason to draw again.
    desk.put("heights.dat", "1 2\n3 4\n");
    until("another", || drawn() == 3);
    std::thread::sleep(Duration::from_secs(1));
    assert_eq!(drawn(), 3);

    assert!(running.0.try_wait().expect("it can be asked").is_none(), "it goes on");
}

#[test]
fn what_cannot_be_watched_is_refused_at_once() {
    let desk = Desk::new();
    for (file, output, said) in [
        ("-", "a.png", "not -"),
        ("ball.csg", "-", "not -"),
        ("ball.csg", "a.jpg", ".png"),
        ("nowhere.csg", "a.png", "nowhere.csg"),
    ] {
        let done = desk.run(&["render", file, "-o", output, "--watch"]);
        assert_eq!((done.code, done.out.as_str()), (2, ""), "{file} {output}");
        assert!(done.err.contains(said), "{}", done.err);
    }
}
