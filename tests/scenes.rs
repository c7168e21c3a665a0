//! The scenes that speed is measured on are those that they are meant to be.

#[path = "../benches/scenes/mod.rs"]
mod scenes;

use glam::dvec3;
use scenes::{FORMULAS, MESHES, Subject};
use solidray::Scene;
use solidray::measure::{self, Sampling};

const LEAVES: [usize; 9] = [5, 1001, 10_649, 1001, 10_101, 220, 1756, 51, 201];

/// Volumes of scenes without a closed form, measured by other programs, and how far these
/// may be off.
const MEASURED: [(&str, f64, f64); 2] =
    [("deep-50", 1.382_707_7, 3e-7), ("deep-200", 2.540_190_3, 5e-7)];

#[test]
fn scenes_have_their_leaves_and_volumes() {
    for (name, leaves) in FORMULAS.into_iter().zip(LEAVES) {
        let subject = Subject::named(name);
        let scene = Scene::compile(&subject.solid).expect("the scene is right");
        assert_eq!(scene.leaf_count(), leaves, "{name}");
        let measured = MEASURED.iter().find(|(of, ..)| *of == name);
        let known = measured.map(|(_, volume, error)| (*volume, *error));
        let (exact, error) = subject.volume.map(|v| (v, 0.0)).or(known).expect("known");
        let sampling = Sampling { rel_tol: 1e-3, ..Sampling::default() };
        let volume = measure::volume(&scene, &sampling);
        let [low, high] = volume.interval;
        assert!(volume.target_met, "{name}");
        assert!(low - error <= exact && exact <= high + error, "{name}: {volume:?}");
    }
}

#[test]
fn blobs_are_closed_and_bitten() {
    let scene = Scene::compile(&Subject::named("blob-5k").solid).expect("a scene");
    assert_eq!(scene.leaf_count(), 2);
    assert_eq!(scene.leaf(0).faces, 20 << 8);
    assert!(scene.contains(dvec3(-0.5, -0.4, -0.3)));
    assert!(!scene.contains(dvec3(0.55, 0.45, 0.6)));
    assert_eq!(MESHES.map(|name| name.starts_with("blob")), [true; 2]);
}

#[test]
fn pictures_show_whole_scenes_from_above_a_corner() {
    let subject = Subject::named("classic");
    let view = subject.view(64);
    let [right, up, forward] = view.axes();
    assert!(forward.distance(dvec3(-0.62, -0.53, -0.58).normalize()) < 1e-12);
    assert!(right.z.abs() < 1e-12 && up.z > 0.0);
    let [left_edge, right_edge] = [0.0, 64.0].map(|x| view.ray(x, 32.0).origin);
    let width = left_edge.distance(right_edge);
    assert!((width - 2.0 * 1.02 * 3.0_f64.sqrt()).abs() < 1e-12);
}
