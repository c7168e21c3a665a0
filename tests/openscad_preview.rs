//! Pictures beside OpenSCAD's own previews by the same camera.

#[expect(dead_code, reason = "only whether it is installed matters here")]
#[path = "support/openscad.rs"]
mod openscad;

use std::path::Path;
use std::process::Command;

use image::RgbImage;
use solidray::Scene;
use solidray::read::{self, Curves, ReadOptions};
use solidray::render::{Camera, Style, picture};

const SIZE: [u32; 2] = [512, 384];

/// Whether there is a screen for previews, if only in memory.
fn has_screen(without: &str) -> bool {
    let required = "SOLIDRAY_REQUIRE_OPENSCAD";
    openscad::program::is_installed("xvfb-run", "--help", required, without)
}

fn preview(file: &Path, camera: &str) -> RgbImage {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let image = folder.path().join("preview.png");
    let size = format!("{},{}", SIZE[0], SIZE[1]);
    let done = Command::new("xvfb-run")
        .args(["-a", "openscad", "--preview", "--imgsize", &size, "--camera", camera])
        .arg("-o")
        .args([&image, file])
        .output()
        .expect("it starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    image::open(image).expect("a picture").into_rgb8()
}

/// Where something other than the ground is.
fn outline(image: &RgbImage) -> Vec<bool> {
    let far = |p: &image::Rgb<u8>| {
        let ground = [255_u8, 255, 229];
        p.0.iter().zip(ground).any(|(&a, b)| a.abs_diff(b) > 2)
    };
    image.pixels().map(far).collect()
}

/// Of the pixels that differ, how many there are, and how many have none of the other kind beside
/// them.
fn differences(ours: &[bool], theirs: &[bool]) -> [usize; 2] {
    let [width, height] = SIZE.map(u32::cast_signed);
    let at = |x: i32, y: i32| {
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        inside.then(|| ours[(y * width + x).cast_unsigned() as usize])
    };
    let (mut differing, mut lost) = (0, 0);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let i = (y * width + x).cast_unsigned() as usize;
        if ours[i] != theirs[i] {
            differing += 1;
            let mut beside = (-1..=1).flat_map(|v| (-1..=1).map(move |u| (x + u, y + v)));
            lost += usize::from(!beside.any(|(x, y)| at(x, y) == Some(theirs[i])));
        }
    }
    [differing, lost]
}

#[test]
fn outlines_are_those_of_previews() {
    let without = "outlines are not compared with its own";
    if !openscad::is_installed(without) || !has_screen(without) {
        return;
    }
    let options = ReadOptions { curves: Curves::Faceted, ..ReadOptions::default() };
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    // Models in which OpenCSG, which draws previews, leaves no gaps and no remains.
    for (name, view) in [
        ("bolt", "55,0,25"),
        ("bracket", "55,0,25"),
        ("classic", "10,20,30"),
        ("die", "120,0,200"),
        ("dovetail", "55,0,25"),
        ("flange", "0,0,0"),
        ("gear", "55,0,25"),
        ("menger", "55,0,25"),
        ("pawn", "90,0,0"),
        ("pencils", "55,0,25"),
        ("pipes", "200,0,70"),
        ("tower", "55,0,25"),
    ] {
        let file = models.join(name).with_extension("csg");
        let model = read::file(&file, &options).expect("a model");
        let scene = Scene::compile(&model.solid).expect("a solid");
        let bounds = scene.bounds();
        let center = bounds.center();
        let distance = 2.6 * bounds.size().length();
        let text = format!(
            "{:.3},{:.3},{:.3},{view},{distance:.3}",
            center.x, center.y, center.z
        );
        let numbers: Vec<f64> =
            text.split(',').map(|n| n.parse().expect("a number")).collect();
        let camera = Camera::from_numbers(&numbers).expect("a camera");
        let image = picture(&scene, &camera, SIZE, &Style::default(), &|_| ());
        let ours = outline(&image);
        let covered = ours.iter().filter(|&&inside| inside).count();
        assert!(covered > 10_000, "{name}: {covered} pixels");
        let [differing, lost] = differences(&ours, &outline(&preview(&file, &text)));
        assert!(1000 * differing <= 2 * covered, "{name}: {differing} of {covered}");
        assert_eq!(lost, 0, "{name}: {differing} differ");
    }
}
