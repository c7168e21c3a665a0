//! `render` as its users meet it.
#![cfg(feature = "cli")]

mod desk;

use desk::Desk;
use image::RgbImage;
use serde_json::Value;

fn picture(desk: &Desk, args: &[&str]) -> RgbImage {
    let all =
        [&["render", "tube.csg", "-o", "t.png", "--imgsize", "240,180"], args].concat();
    let done = desk.run(&all);
    assert_eq!(done.code, 0, "{}", done.err);
    image::open(desk.path("t.png")).expect("a picture").into_rgb8()
}

fn count(image: &RgbImage, is: impl Fn([u8; 3]) -> bool) -> usize {
    image.pixels().filter(|p| is(p.0)).count()
}

const ABOVE: [&str; 2] = ["--camera", "0,0,0,0,0,0,100"];

#[test]
fn cuts_take_away_what_is_before_them_and_are_hatched() {
    let desk = Desk::new();
    let ground = |image: &RgbImage| count(image, |p| p == [255, 255, 229]);
    let whole = picture(&desk, &ABOVE);
    // From above, a cut across z takes nothing from the outline, one across x half.
    let low = picture(&desk, &[&ABOVE[..], &["--cut", "z=5"]].concat());
    assert!(ground(&whole).abs_diff(ground(&low)) < 300);
    let half = picture(&desk, &[&ABOVE[..], &["--cut", "1,0,0,0"]].concat());
    let covered = |image: &RgbImage| 240 * 180 - ground(image);
    let share = covered(&half) as f64 / covered(&whole) as f64;
    assert!((0.45..0.55).contains(&share), "{share}");
    // Lines on the ring of the cut, and none on that of the top.
    let dark = |image: &RgbImage| count(image, |[r, g, _]| r < 190 && g < 170 && r > g);
    assert!(dark(&low) > dark(&whole) + 150, "{} and {}", dark(&low), dark(&whole));

    for wrong in ["z", "q=1", "1,2,3", "0,0,0,1", "z=nan"] {
        let done = desk.run(&["render", "tube.csg", "-o", "t.png", "--cut", wrong]);
        assert_eq!(done.code, 2);
        assert!(done.err.contains(wrong), "{}", done.err);
    }
}

#[test]
fn thickness_has_a_scale_and_can_be_measured() {
    let desk = Desk::new();
    let image = picture(&desk, &["--look", "thickness"]);
    assert!(count(&image, |p| p == [255; 3]) > 10_000, "white where nothing is");
    let line = |y| image.get_pixel(240 - 16, y).0;
    assert_ne!(line(30), line(150), "a bar from many colours");

    let args = ["render", "tube.csg", "-o", "t.tiff", "--look", "thickness", "--json"];
    let more = ["--imgsize", "80,60", "--projection", "o"];
    let done = desk.run(&[&args[..], &ABOVE, &more].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let report: Value = serde_json::from_str(&done.out).expect("JSON");
    assert_eq!(report["range"], serde_json::json!([0.0, 10.0]));
    let bytes = std::fs::read(desk.path("t.tiff")).expect("a file");
    let mut decoder =
        tiff::decoder::Decoder::new(std::io::Cursor::new(bytes)).expect("a TIFF");
    assert_eq!(decoder.dimensions().expect("a size"), (80, 60));
    let tiff::decoder::DecodingResult::F32(numbers) =
        decoder.read_image().expect("numbers")
    else {
        panic!("32-bit numbers");
    };
    // Their sum is the volume: 160 π.
    let pixel = 2.0 * 100.0 * 11.25_f64.to_radians().tan() / 60.0;
    let volume = numbers.iter().copied().map(f64::from).sum::<f64>() * pixel * pixel;
    assert!((volume / (160.0 * std::f64::consts::PI) - 1.0).abs() < 0.02, "{volume}");
}

#[test]
fn depths_are_numbers_where_they_are_wanted() {
    let desk = Desk::new();
    let args = ["render", "ball.csg", "-o", "d.tif", "--look", "depth", "--json"];
    let done = desk.run(&[&args[..], &["--camera", "0,0,0,0,0,0,50"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let report: Value = serde_json::from_str(&done.out).expect("JSON");
    let least = report["range"][0].as_f64().expect("a number");
    assert!((least - 47.0).abs() < 1e-3, "{report}");
    let done = desk.run(&["render", "ball.csg", "-o", "d.tif"]);
    assert_eq!(done.code, 2);
    assert!(done.err.contains("only --look depth and --look thickness"), "{}", done.err);
}

#[test]
fn turntables_turn_once() {
    let desk = Desk::new();
    desk.put("box.csg", "cube(size = [10, 1, 1], center = true);\n");
    let args =
        ["render", "box.csg", "-o", "t.png", "--turntable", "4", "--imgsize", "80,60"];
    let done = desk.run(&[&args[..], &["--camera", "0,0,0,90,0,0,60"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let width = |i: u32| {
        let path = desk.path(&format!("t-00{i}.png"));
        let image = image::open(path).expect("a picture").into_rgb8();
        count(&image, |p| p != [255, 255, 229])
    };
    let widths = [0, 1, 2, 3].map(width);
    assert!(widths[0] > 4 * widths[1], "{widths:?}");
    assert!(widths[0].abs_diff(widths[2]) < 8 && widths[1].abs_diff(widths[3]) < 8);
    assert!(!desk.path("t-004.png").exists() && !desk.path("t.png").exists());
    let done = desk.run(&["render", "box.csg", "-o", "-", "--turntable", "4"]);
    assert_eq!(done.code, 2);
    assert!(done.err.contains("standard output takes one picture"), "{}", done.err);
}
