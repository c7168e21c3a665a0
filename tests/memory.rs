//! How much memory models take at most: the figures that [`Scene`] and the README give, on
//! smaller sizes. `examples/large.rs` measures full ones.
//!
//! In a program of its own, with one test, because it is the whole process that is measured.

#![cfg(target_os = "linux")]

use std::path::Path;

use glam::dvec3;
use solidray::read::{self, Format, ReadOptions};
use solidray::{Op, Scene, Solid};

/// The bytes that the process holds (`VmRSS`) or has held at most (`VmHWM`).
fn bytes(what: &str) -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("it is Linux");
    let line = status.lines().find(|line| line.starts_with(what)).expect("it is listed");
    let number = line.split_whitespace().nth(1).expect("it has a number");
    1024 * number.parse::<u64>().expect("it is a number")
}

/// What something makes, and how many bytes each of some items takes at most meanwhile.
fn peak<T>(items: u32, make: impl FnOnce() -> T) -> (T, u64) {
    let before = bytes("VmRSS");
    // Forgets the peaks before.
    std::fs::write("/proc/self/clear_refs", "5").expect("it is our own process");
    let made = make();
    (made, bytes("VmHWM").saturating_sub(before) / u64::from(items))
}

fn compile(solid: &Solid) -> Scene {
    Scene::compile(solid).expect("it is bounded")
}

/// A torus of `steps`² squares as binary `.stl`.
fn torus(steps: u32) -> Vec<u8> {
    let point = |i: u32, j: u32| {
        let [u, v] = [i, j]
            .map(|k| f64::from(k % steps) / f64::from(steps) * std::f64::consts::TAU);
        let radius = 3.0 + v.cos();
        dvec3(radius * u.cos(), radius * u.sin(), v.sin()).as_vec3()
    };
    let mut file = vec![b' '; 80];
    file.extend((2 * steps * steps).to_le_bytes());
    for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
        let [a, b] = [point(i, j), point(i + 1, j)];
        let [c, d] = [point(i + 1, j + 1), point(i, j + 1)];
        for triangle in [[a, b, c], [a, c, d]] {
            file.extend([0; 12]);
            file.extend(
                triangle.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes),
            );
            file.extend([0; 2]);
        }
    }
    file
}

#[test]
fn peaks_are_what_they_are_said_to_be() {
    let steps = 400;
    let stl = torus(steps);
    let (model, read) = peak(2 * steps * steps, || {
        let options = ReadOptions::default();
        read::bytes(&stl, Path::new("a.stl"), Format::Stl, &options)
            .expect("it is closed")
    });
    let (scene, compiled) = peak(2 * steps * steps, || compile(&model.solid));
    assert!(read <= 120 && compiled <= 110, "{read}, {compiled} bytes a triangle");
    drop((model, scene));

    let count = 200_000;
    let at = |i: u32| dvec3(f64::from(i % 1000), f64::from(i / 1000), 0.0);
    let ball = |i| Solid::ball(0.25).translated(at(i));
    let (union, said) = peak(count, || Solid::boolean(Op::Union, (0..count).map(ball)));
    let (scene, compiled) = peak(count, || compile(&union));
    assert!(said <= 400 && compiled <= 1000, "{said}, {compiled} bytes a leaf");
    drop((union, scene));

    let chain = (0..count).fold(Solid::ball(0.5), |rest, i| rest - ball(i));
    let (_, compiled) = peak(count, || compile(&chain));
    assert!(compiled <= 1000, "{compiled} bytes a leaf of a chain");
}
