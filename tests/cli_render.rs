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

#[test]
fn marks_and_glass_are_seen_through() {
    let desk = Desk::new();
    let draw = |text: &str, more: &[&str]| {
        desk.put("tube.csg", text);
        picture(&desk, &[&ABOVE[..], more].concat())
    };
    let middle = |image: &RgbImage| image.get_pixel(120, 90).0;
    let cube = "cube([20, 20, 2], center = true);";
    let plain = draw(cube, &[]);
    // A grey plate before the yellow one; a pink hole; a blue pane.
    let above = "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,5],[0,0,0,1]])";
    let shown = draw(&format!("{cube} %{above} {{ {cube} }}"), &[]);
    let [r, g, b] = middle(&shown);
    assert!(r < 245 && g > 150 && b > 60, "{:?} and {:?}", middle(&plain), [r, g, b]);
    let hidden = draw(&format!("{cube} %{above} {{ {cube} }}"), &["--opaque"]);
    assert_eq!(middle(&hidden), middle(&plain));
    let pink = draw(&format!("difference() {{ {cube} #cylinder(h = 20, r = 3); }}"), &[]);
    let [r, g, b] = middle(&pink);
    assert!(r > 170 && g < 150 && b > 60, "{:?}", [r, g, b]);
    let pane =
        |alpha| format!("{cube} {above} {{ color([0, 0, 1, {alpha}]) {{ {cube} }} }}");
    let [r, _, b] = middle(&draw(&pane(0.5), &[]));
    assert!(r > 90 && b > 110, "{r} {b}");
    let [r, _, b] = middle(&draw(&pane(1.0), &[]));
    assert!(r < 60 && b > 150, "{r} {b}");
    assert_eq!(middle(&draw(&pane(0.0), &[])), middle(&plain));
    // Cut away like the rest; alone in view; and no part of what is measured.
    let cut = draw(&format!("{cube} %{above} {{ {cube} }}"), &["--cut", "z=3"]);
    assert_eq!(middle(&cut), middle(&plain));
    desk.put("alone.csg", &format!("%{cube}"));
    let done =
        desk.run(&["render", "alone.csg", "-o", "alone.png", "--imgsize", "80,60"]);
    assert_eq!(done.code, 0);
    assert!(done.err.contains("the model is empty"), "{}", done.err);
    let alone = image::open(desk.path("alone.png")).expect("a picture").into_rgb8();
    assert!(count(&alone, |p| p != [255, 255, 229]) > 500);
    assert!(desk.run(&["volume", "alone.csg"]).out.starts_with('0'));

    desk.put("beside.csg", "cube(2); %sphere(1e300);");
    let done =
        desk.run(&["render", "beside.csg", "-o", "beside.png", "--imgsize", "80,60"]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(done.err.contains("is left out"), "{}", done.err);
    desk.put("glass.csg", "color([0, 0, 1, 0.5]) { cube(10); }");
    let done =
        desk.run(&["render", "glass.csg", "-o", "glass.png", "--imgsize", "80,60"]);
    assert_eq!((done.code, done.err.as_str()), (0, ""));

    let many =
        |i: u32| format!("color([0, 0, {}, 0.5]) {{ cube({i}); }}", f64::from(i) / 64.0);
    desk.put("many.csg", &(1..41).map(many).collect::<String>());
    let done = desk.run(&["render", "many.csg", "-o", "many.png", "--imgsize", "80,60"]);
    assert_eq!(done.code, 0);
    assert!(done.err.contains("8 more are drawn as if they were opaque"), "{}", done.err);
}

#[test]
fn pictures_in_16_bits_say_what_they_mean() {
    let desk = Desk::new();
    let draw = |look: &str, more: &[&str]| {
        let args = ["render", "ball.csg", "-o", "d.png", "--look", look, "--bits", "16"];
        let more = [&args[..], &["--imgsize", "80,60", "--json"], more].concat();
        let done = desk.run(&more);
        assert_eq!(done.code, 0, "{}", done.err);
        let report: Value = serde_json::from_str(&done.out).expect("JSON");
        let [least, most] =
            [0, 1].map(|i| report["range"][i].as_f64().expect("a number"));
        let image::DynamicImage::ImageLuma16(image) =
            image::open(desk.path("d.png")).expect("a picture")
        else {
            panic!("16 bits of grey");
        };
        (image, least, most)
    };
    let above = ["--camera", "0,0,0,0,0,0,20"];
    let (image, least, most) = draw("depth", &above);
    assert_eq!(image.get_pixel(0, 0).0, [0]);
    assert_eq!(image.pixels().map(|p| p.0[0]).max(), Some(65535));
    assert_eq!(image.pixels().map(|p| p.0[0]).filter(|&g| g > 0).min(), Some(1));
    let grey = f64::from(image.get_pixel(40, 30).0[0]);
    let depth = most + (grey - 1.0) / 65534.0 * (least - most);
    assert!((depth - 17.0).abs() < 0.01, "{depth}");
    let bytes = std::fs::read(desk.path("d.png")).expect("a file");
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.contains("depth = 1") && text.contains("65534"), "a comment");

    let (image, _, most) = draw("thickness", &above);
    let grey = f64::from(image.get_pixel(40, 30).0[0]);
    assert!((most * (grey - 1.0) / 65534.0 - 6.0).abs() < 0.05);
    assert_eq!(image.get_pixel(0, 0).0, [0]);

    for (args, message) in [
        (["-o", "d.png", "--look", "leaf"], "have 16 bits"),
        (["-o", "d.tiff", "--look", "depth"], "have 32 bits"),
    ] {
        let all = [&["render", "ball.csg", "--bits", "16"], &args[..]].concat();
        let done = desk.run(&all);
        assert_eq!(done.code, 2);
        assert!(done.err.contains(message), "{}", done.err);
    }
}

#[test]
fn large_pictures_are_made_in_bands() {
    let desk = Desk::new();
    let size = [2500, 1800];
    let solid = solidray::read::file(&desk.path("tube.csg"), &Default::default());
    let scene = solidray::Scene::compile(&solid.expect("a model").solid).expect("a tube");
    let camera = solidray::render::Camera::framing(&scene.bounds());
    let draw = |more: &[&str]| {
        let args = ["render", "tube.csg", "-o", "t.png", "--imgsize", "2500,1800"];
        let done = desk.run(&[&args[..], &["--samples", "1"], more].concat());
        assert_eq!(done.code, 0, "{}", done.err);
        image::open(desk.path("t.png")).expect("a picture").into_rgb8()
    };
    let style = solidray::render::Style::default();
    let expected = solidray::render::picture(&scene, &camera, size, &style, &|_| ());
    assert!(draw(&[]) == expected);

    let lengths = solidray::render::thickness(&scene, &camera, size, 1, &|_| ());
    let most = lengths.iter().copied().fold(0.0, f32::max);
    let expected = solidray::render::heat(&lengths, size, most);
    let image = draw(&["--look", "thickness"]);
    let differing = |(x, y, pixel): (u32, u32, &image::Rgb<u8>)| {
        (*pixel != *expected.get_pixel(x, y)).then_some(x)
    };
    let scale: Vec<u32> = image.enumerate_pixels().filter_map(differing).collect();
    assert!(scale.len() > 40 * 1000, "a scale");
    assert!(scale.iter().all(|&x| x >= 2500 - 400), "and nothing but a scale");
    let left: Vec<_> = std::fs::read_dir(desk.path("")).expect("a folder").collect();
    assert_eq!(left.len(), 3, "two models and a picture: {left:?}");
}

/// A picture of 201 MB is made in less memory.
#[test]
#[cfg(target_os = "linux")]
fn large_pictures_are_not_held_whole() {
    let desk = Desk::new();
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_solidray"))
        .args(["render", "ball.csg", "-o", "b.png", "--imgsize", "8192,8192"])
        .args(["--samples", "1", "--camera", "0,0,0,0,0,0,200", "-j", "2"])
        .current_dir(desk.path(""))
        .spawn()
        .expect("the program starts");
    let status = format!("/proc/{}/status", child.id());
    let mut most = 0;
    let end = loop {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kilobytes =
            line.and_then(|line| line.split_whitespace().next()?.parse().ok());
        most = most.max(kilobytes.unwrap_or(0_u64));
        if let Some(end) = child.try_wait().expect("it can be waited for") {
            break end;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    };
    assert!(end.success());
    assert!((10_000..150_000).contains(&most), "{most} KB");
}
