//! What is to be reached, in the units of the tables. The goals, and the times of the
//! yardstick, are from another machine with one core at 3.6 GHz and AVX-512.

/// Nanoseconds for a ray of a picture.
pub fn primary(scene: &str) -> Option<f64> {
    Some(match scene {
        "classic" => 15.0,
        "spheres-1k" => 52.0,
        "spheres-10k" => 77.0,
        "plate-1k" => 24.0,
        "plate-10k" => 29.0,
        "menger-3" => 56.0,
        "menger-4" => 89.0,
        "deep-50" => 42.0,
        "deep-200" => 90.0,
        _ => return None,
    })
}

/// How many times faster than fidget a picture has to be.
pub fn faster_than_fidget(scene: &str) -> f64 {
    match scene {
        "spheres-10k" | "plate-10k" => 20.0,
        "classic" | "spheres-1k" | "plate-1k" => 3.0,
        _ => 1.5,
    }
}

/// How many times the time of Embree's single rays the first hit may take.
pub const OF_EMBREE: f64 = 1.5;

/// Nanoseconds for a ray through a mesh: in a picture, single, at random, and all spans.
pub fn mesh(scene: &str) -> [f64; 4] {
    match scene {
        "blob-82k" => [60.0, 110.0, 200.0, 150.0],
        _ => [120.0, 150.0, 500.0, 240.0],
    }
}

/// Nanoseconds for a point.
pub fn membership(scene: &str) -> Option<f64> {
    Some(match scene {
        "classic" => 1.5,
        "spheres-1k" => 20.0,
        "spheres-10k" => 30.0,
        "plate-10k" => 15.0,
        "deep-200" => 25.0,
        "blob-82k" => 130.0,
        "blob-1310k" => 366.0,
        _ => return None,
    })
}

/// Nanoseconds for a point of a plain program: lists of intervals, merged from the leaves
/// up, and a box around each operator.
pub fn yardstick(scene: &str) -> Option<f64> {
    Some(match scene {
        "classic" => 38.0,
        "spheres-1k" => 200.0,
        "spheres-10k" => 362.0,
        "plate-10k" => 162.0,
        "deep-200" => 158.0,
        _ => return None,
    })
}

/// How many times faster than the yardstick points have to be.
pub const FASTER_THAN_YARDSTICK: f64 = 5.0;

/// Scenes of which volumes are measured, with the volume where there is no closed form,
/// milliseconds, and how many times faster than Manifold they have to be.
pub const VOLUMES: [(&str, Option<f64>, f64, Option<f64>); 4] = [
    ("classic", None, 0.3, Some(100.0)),
    ("spheres-1k", None, 12.0, Some(1000.0)),
    ("plate-1k", None, 1.5, Some(100.0)),
    ("deep-200", Some(2.540_190_3), 3.0, None),
];

/// How much more a ray may cost with ten times the leaves.
pub const GROWTH: f64 = 2.0;

/// Milliseconds to compile ten thousand leaves.
pub const COMPILE: f64 = 50.0;

/// How much faster two threads are than one.
pub const TWO_THREADS: f64 = 1.8;
