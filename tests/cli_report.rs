//! `compare --report` as its users meet it.
#![cfg(feature = "cli")]

mod desk;
#[path = "support/page.rs"]
mod page;

use desk::{BALL, Desk, Done};
use image::RgbImage;
use page::{Page, attribute};
use serde_json::Value;

/// An attribute of the tag with an id.
fn of<'a>(page: &'a Page, id: &str, name: &str) -> &'a str {
    let is_it = |attributes: &[(String, String)]| {
        attributes.iter().any(|(key, value)| key == "id" && value == id)
    };
    let found = page.tags.iter().find(|(_, attributes)| is_it(attributes));
    attribute(&found.expect(id).1, name)
}

/// Nothing of it is elsewhere, and nothing of it runs.
fn assert_self_contained(page: &Page) {
    for (tag, attributes) in &page.tags {
        let refused =
            ["script", "link", "iframe", "object", "embed", "base", "form", "a"];
        assert!(!refused.contains(&tag.as_str()), "{tag}");
        for (key, value) in attributes {
            assert!(!key.starts_with("on"), "{tag} {key}");
            let leads_away = ["src", "href", "srcset", "action"].contains(&key.as_str());
            assert!(!leads_away || value.starts_with("data:image/png;base64,"), "{tag}");
        }
    }
    for word in ["http:", "https:", "url(", "@import", "file:"] {
        assert!(!page.html.contains(word), "{word}");
    }
}

/// It without how long it took.
fn without_seconds(page: &Page) -> String {
    let (before, rest) = page.html.split_once("<dt>Seconds</dt>").expect("a time");
    let (_, after) = rest.split_once("</dd>").expect("its end");
    format!("{before}{after}")
}

fn json(done: &Done) -> Value {
    serde_json::from_str(&done.out).unwrap_or_else(|_| panic!("{}{}", done.out, done.err))
}

/// What a shell makes of a command in the folder of the desk.
fn pasted(desk: &Desk, command: &str) -> Done {
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_solidray"));
    let mut path = program.parent().expect("a folder").as_os_str().to_owned();
    path.push(":");
    path.push(std::env::var_os("PATH").unwrap_or_default());
    let done = std::process::Command::new("sh")
        .args(["-c", command])
        .env("PATH", path)
        .current_dir(desk.path(""))
        .stdin(std::process::Stdio::null())
        .output()
        .expect("a shell");
    Done {
        code: done.status.code().expect("it was not killed"),
        out: String::from_utf8(done.stdout).expect("text"),
        err: String::from_utf8(done.stderr).expect("text"),
    }
}

/// A plate with a hole, and one that lacks it.
fn plates(desk: &Desk, a: &str, b: &str) {
    let cube = "cube(size = [40, 20, 4], center = false);";
    let hole = "multmatrix([[1, 0, 0, 30], [0, 1, 0, 10], [0, 0, 1, -1], [0, 0, 0, 1]])
        cylinder($fn = 0, $fa = 12, $fs = 2, h = 6, r1 = 3, r2 = 3, center = false);";
    desk.put(a, &format!("difference() {{ {cube} {hole} }}\n"));
    desk.put(b, &format!("{cube}\n"));
}

#[test]
fn a_page_says_what_was_found() {
    let desk = Desk::new();
    plates(&desk, "plate.csg", "printed.csg");
    let args = ["compare", "plate.csg", "printed.csg", "--report", "out.html"];
    let done = desk.run(&[&args[..], &["--json"]].concat());
    assert_eq!(done.code, 1, "{}", done.err);
    let (found, page) = (json(&done), Page::read(&desk, "out.html"));
    assert_self_contained(&page);
    for id in ["a", "b", "a_minus_b", "b_minus_a", "difference", "iou"] {
        let [low, high] = [0, 1].map(|i| &found[id]["interval"][i]);
        for (name, value) in
            [("data-value", &found[id]["value"]), ("data-low", low), ("data-high", high)]
        {
            let shown: f64 = of(&page, id, name).parse().expect("a number");
            assert_eq!(Some(shown), value.as_f64(), "{id} {name}");
        }
    }
    let worst = found["worst"]["length"].as_f64().expect("a length");
    let title = page.all("title")[0];
    assert_eq!(title, "Different by more than 0.1\u{a0}%: plate.csg and printed.csg");
    assert_eq!(page.all("h1"), ["✗ Different by more than 0.1\u{a0}%"]);
    assert!(page.html.contains("B is solid there and A is not"));
    assert!(page.html.contains(&format!("<dd>{worst:.6}, ")));

    // The words of the command, digit for digit.
    let done = desk.run(&args);
    let cells = page.all("td");
    for (name, row) in [("A ", 0), ("B ", 1), ("A − B", 2), ("B − A", 3), ("inter", 5)]
    {
        let line = done.out.lines().find(|line| line.starts_with(name)).expect(name);
        let (value, confidence) = (cells[3 * row], cells[3 * row + 2]);
        let end = match confidence {
            "exact" => format!("  {value}"),
            _ => format!("  {value} ({confidence})"),
        };
        assert!(line.ends_with(&end), "{line:?}, not {end:?}");
    }
}

#[test]
fn pictures_show_both_and_where_they_differ() {
    let desk = Desk::new();
    plates(&desk, "plate.csg", "printed.csg");
    let camera = ["--camera", "20,10,2,0,0,0,100", "--projection", "o"];
    let args = ["compare", "plate.csg", "printed.csg", "--report", "out.html"];
    let done = desk.run(&[&args[..], &camera].concat());
    assert_eq!(done.code, 1, "{}", done.err);
    let pictures = Page::read(&desk, "out.html").pictures();
    assert_eq!(
        pictures.iter().map(RgbImage::dimensions).collect::<Vec<_>>(),
        [(640, 480); 3]
    );
    // From above, the middle of the hole is 10 to the right of the centre: so many pixels.
    let pixel = 2.0 * 100.0 * 11.25_f64.to_radians().tan() / 480.0;
    let x = 440;
    assert!((320.0 + 10.0 / pixel - f64::from(x)).abs() < 1.0);
    let at = |picture: &RgbImage, x| picture.get_pixel(x, 240).0;
    let [a, b, difference] = &pictures[..] else { panic!("three pictures") };
    assert_eq!(at(a, x), [255, 255, 229], "through the hole one sees the ground");
    assert_ne!(at(b, x), [255, 255, 229]);
    let is_blue = |[r, _, b]: [u8; 3]| b.saturating_sub(r) > 60;
    assert!(is_blue(at(difference, x)), "what only B has is blue");
    let is_grey = |[r, g, b]: [u8; 3]| r.abs_diff(g) < 3 && g.abs_diff(b) < 3;
    assert!(is_grey(at(difference, 320)), "what both have is grey");
    let blue = difference.pixels().filter(|p| is_blue(p.0)).count() as f64;
    let disc = std::f64::consts::PI * (3.0 / pixel).powi(2);
    assert!((blue / disc - 1.0).abs() < 0.05, "{blue} pixels, not {disc}");

    let done = desk.run(&[&args[..3], &camera].concat());
    assert_eq!(done.code, 2);
    assert!(done.err.contains("only a --report has pictures"), "{}", done.err);
}

#[test]
fn commands_do_what_they_say() {
    let desk = Desk::new();
    plates(&desk, "plate.csg", "printed.csg");
    // What is marked or seen through takes no part in a comparison.
    let cube = std::fs::read_to_string(desk.path("printed.csg")).expect("a model");
    let marked = format!("color([0, 0, 1, 0.5]) {{ #{cube} }} %sphere(r = 30);");
    desk.put("printed.csg", &marked);
    let more =
        ["--tol", "0.002", "--seed", "7", "--rel-tol", "1e-3", "--curves", "faceted"];
    let args = ["compare", "plate.csg", "printed.csg", "--report", "out.html"];
    let done = desk.run(&[&args[..], &more].concat());
    assert_eq!(done.code, 1, "{}", done.err);
    let page = Page::read(&desk, "out.html");
    let commands = page.commands();
    let names = commands.iter().map(|line| line.split(' ').nth(1).expect("a name"));
    assert_eq!(names.collect::<Vec<_>>(), ["compare", "ray", "ray", "render", "render"]);
    assert!(
        commands.iter().all(|line| line.contains("--curves=faceted")),
        "{commands:?}"
    );

    std::fs::remove_file(desk.path("out.html")).expect("it is there");
    let again = pasted(&desk, commands[0]);
    assert_eq!((again.code, &again.out), (1, &done.out), "{}", again.err);
    // All but the time and the camera, which is the same in numbers.
    let second = Page::read(&desk, "out.html");
    assert_eq!(without_seconds(&second), without_seconds(&page));

    let inside = |command: &str| {
        let done = pasted(&desk, &format!("{command} --json"));
        assert_eq!(done.code, 0, "{}", done.err);
        // A tenth behind the start, where the worst is longer than that.
        let spans = json(&done)["spans"].clone();
        let ends =
            |span: &Value| [0, 1].map(|i| span["t"][i].as_f64().expect("a number"));
        let spans = spans.as_array().expect("spans");
        spans.iter().map(ends).any(|[enter, exit]| enter < 0.1 && 0.1 < exit)
    };
    assert_eq!([inside(commands[1]), inside(commands[2])], [false, true]);

    let pictures = page.pictures();
    for (i, name) in ["out-a.png", "out-b.png"].into_iter().enumerate() {
        let done = pasted(&desk, commands[3 + i]);
        assert_eq!(done.code, 0, "{}", done.err);
        let drawn = image::open(desk.path(name)).expect("a picture").into_rgb8();
        assert!(drawn == pictures[i], "{name} is another picture");
    }
}

#[test]
fn names_of_files_are_text_and_nothing_else() {
    let desk = Desk::new();
    let hostile = "<b>&\"'$(touch gotcha)`touch gotcha`<script>x()</script>;.csg";
    // A slash would be a folder.
    let hostile = hostile.replace('/', "");
    let names = [hostile.as_str(), "-two  words\n--json.csg"];
    plates(&desk, names[0], names[1]);
    let report = "<i> & 'out'.html";
    let dashed = format!("./{}", names[1]);
    for b in [dashed.as_str(), names[1]] {
        let done = desk.run(&["compare", "--report", report, "--", names[0], b]);
        assert_eq!(done.code, 1, "{}", done.err);
        let page = Page::read(&desk, report);
        assert_self_contained(&page);
        let shown = page.all("span");
        assert!(shown.contains(&names[0]) && shown.contains(&b), "{shown:?}");
        assert!(page.all("title")[0].ends_with(names[1]));
        assert!(!page.html.contains("<script") && !page.html.contains("<i>"));
        for (command, code) in page.commands().iter().zip([1, 0, 0, 0, 0]) {
            let done = pasted(&desk, command);
            assert_eq!(done.code, code, "{command}: {}", done.err);
        }
        assert_eq!(page.commands().len(), 5);
    }
    assert!(!desk.path("gotcha").exists());
}

#[test]
fn every_verdict_has_its_page() {
    let desk = Desk::new();
    desk.put("like.csg", &BALL.replace("r = 3", "r = 3.0015"));
    desk.put("empty.csg", "");
    desk.put("nothing.csg", "group();\n");
    let page = |args: &[&str], code: i32| {
        let done = desk.run(&[&["compare"], args, &["--report", "out.html"]].concat());
        assert_eq!(done.code, code, "{}", done.err);
        let page = Page::read(&desk, "out.html");
        assert_self_contained(&page);
        page
    };
    let same = page(&["ball.csg", "ball.csg"], 0);
    assert_eq!(same.all("h1"), ["✓ The same within 0.1\u{a0}%"]);
    assert_eq!((same.pictures().len(), same.commands().len()), (3, 3), "no line to show");
    let pictures = same.pictures();
    let colorful = pictures[2].pixels().filter(|p| p.0[0].abs_diff(p.0[2]) > 12).count();
    assert_eq!((pictures[0] == pictures[1], colorful), (true, 0));

    let undecided =
        page(&["ball.csg", "like.csg", "--tol", "1.4985e-3", "--max-rays", "9999"], 2);
    assert_eq!(
        undecided.all("h1"),
        ["? Undecided whether the same within 0.14985\u{a0}%"]
    );
    assert!(undecided.commands()[0].contains("--max-rays=9999"));

    let one = page(&["ball.csg", "empty.csg"], 1);
    assert!(one.html.contains("B is empty and A is not."));
    assert_eq!(one.pictures().len(), 3);
    let none = page(&["nothing.csg", "empty.csg"], 0);
    assert!(none.html.contains("Both are empty."));
    assert_eq!((none.pictures().len(), none.commands().len()), (0, 1));

    let args = ["compare", "-", "ball.csg", "--format", "csg", "--report", "out.html"];
    let done = desk.run_with_input(&args, BALL);
    assert_eq!(done.code, 0, "{}", done.err);
    let page = Page::read(&desk, "out.html");
    assert!(page.html.contains("A is standard input"));
    assert!(page.html.contains("it reads that model from standard input"));
}

#[test]
fn a_page_is_written_whole_or_not_at_all() {
    let desk = Desk::new();
    desk.put("out.html", "before");
    for (report, b, said) in [
        ("out.png", "tube.csg", "out.png: reports are written as .html"),
        ("-", "tube.csg", "-: reports are written as .html"),
        ("no/out.html", "tube.csg", "there is no folder no"),
        ("out.html", "gone.csg", "gone.csg"),
    ] {
        let done = desk.run(&["compare", "ball.csg", b, "--report", report]);
        assert_eq!(done.code, 2);
        assert!(done.err.contains(said), "{}", done.err);
        assert_eq!(done.out, "");
    }
    assert_eq!(std::fs::read_to_string(desk.path("out.html")).expect("a file"), "before");
    // Numbers are not lost with the page.
    std::fs::create_dir(desk.path("folder.html")).expect("a folder");
    let done = desk.run(&["compare", "ball.csg", "tube.csg", "--report", "folder.html"]);
    assert_eq!(done.code, 2);
    assert!(done.out.starts_with("different within"), "{}", done.out);
    assert!(done.err.contains("folder.html"), "{}", done.err);
    let left = std::fs::read_dir(desk.path("")).expect("a folder").count();
    assert_eq!(left, 4, "two models, the file and the folder");
}
