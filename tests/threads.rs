//! The same bits on any number of threads.

#![cfg(feature = "parallel")]

use std::path::Path;

use solidray::measure::{self, Sampling};
use solidray::read::{self, ReadOptions};
use solidray::render::{Camera, Frame, trace};
use solidray::{Scene, Sense, Solid, unwatched};

fn model(name: &str) -> Solid {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(name);
    read::file(&path, &ReadOptions::default()).expect("the model is right").solid
}

/// All answers that threads have a part in, with the bits of their numbers.
fn answers(solid: &Solid, other: &Solid) -> String {
    let scene = Scene::compile(solid).expect("the model is right");
    let sampling = Sampling { rel_tol: 1e-3, ..Sampling::default() };
    let volume = measure::volume(&scene, &sampling);
    let comparison = measure::compare(solid, other, 1e-3, &sampling, &unwatched)
        .expect("both are right");
    let camera = Camera::framing(&scene.bounds());
    let frame =
        trace(&scene, &camera.view([200, 150], &scene.bounds()), [0.5; 2], &|_| ());
    // Debug prints numbers with all their digits.
    format!("{volume:?}\n{comparison:?}\n{:?}", hits(&frame))
}

fn hits(frame: &Frame) -> Vec<Option<(f64, u32, u32, Sense)>> {
    let [width, height] = frame.size();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    pixels.map(|(x, y)| frame.hit(x, y).map(|c| (c.t, c.leaf, c.face, c.sense))).collect()
}

#[test]
fn n37_1_2_and_16_threads_give_the_same_bits() {
    for (a, b) in [("classic.csg", "die.csg"), ("vase.csg", "pipes.csg")] {
        let (a, b) = (model(a), model(b));
        let [one, two, many] = [1, 2, 16].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads can be had").install(|| answers(&a, &b))
        });
        assert!(one == two && one == many);
    }
}
