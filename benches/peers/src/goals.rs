//! What is to be reached, in the units of the tables.
//!
//! Goals and the times of a yardstick were set on another machine, with one core at 3.6 GHz and
//! AVX-512, beside those of the peers there. What counts here are ratios to the same peers.

/// A goal, and what a peer took where it was set.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    ours: f64,
    peer: f64,
}

impl Goal {
    fn new(ours: f64, peer: f64) -> Self {
        Self { ours, peer }
    }

    /// How many times faster than the peer it is.
    pub fn faster(&self) -> f64 {
        self.peer / self.ours
    }
}

/// Nanoseconds for a ray of a picture, and fidget's.
pub fn primary(scene: &str) -> Option<Goal> {
    Some(match scene {
        "classic" => Goal::new(15.0, 121.0),
        "spheres-1k" => Goal::new(52.0, 521.0),
        "spheres-10k" => Goal::new(77.0, 3075.0),
        "plate-1k" => Goal::new(24.0, 360.0),
        "plate-10k" => Goal::new(29.0, 2858.0),
        "menger-3" => Goal::new(56.0, 279.0),
        "menger-4" => Goal::new(89.0, 890.0),
        "deep-50" => Goal::new(42.0, 295.0),
        "deep-200" => Goal::new(90.0, 722.0),
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

/// Nanoseconds for a ray through a mesh, and Embree's: in a picture, single, at random, and all
/// spans.
pub fn mesh(scene: &str) -> [Goal; 4] {
    match scene {
        "blob-82k" => [(60.0, 32.0), (110.0, 109.0), (200.0, 146.0), (150.0, 213.0)],
        _ => [(120.0, 70.0), (150.0, 145.0), (500.0, 434.0), (240.0, 322.0)],
    }
    .map(|(ours, peer)| Goal::new(ours, peer))
}

/// Nanoseconds for a point, and fidget's, or Embree's where there is a mesh.
pub fn membership(scene: &str) -> Option<Goal> {
    Some(match scene {
        "classic" => Goal::new(1.5, 3.8),
        "spheres-1k" => Goal::new(20.0, 262.0),
        "spheres-10k" => Goal::new(30.0, 2358.0),
        "plate-10k" => Goal::new(15.0, 2899.0),
        "deep-200" => Goal::new(25.0, 222.0),
        _ => return None,
    })
}

/// A fifth of the nanoseconds for a point of a plain program (lists of intervals, merged from
/// the leaves up, and a box around each operator), and fidget's.
pub fn yardstick(scene: &str) -> Option<Goal> {
    let fidget = membership(scene)?.peer;
    let time = match scene {
        "classic" => 38.0,
        "spheres-1k" => 200.0,
        "spheres-10k" => 362.0,
        "plate-10k" => 162.0,
        "deep-200" => 158.0,
        _ => return None,
    };
    Some(Goal::new(time / 5.0, fidget))
}

/// Scenes of which volumes are measured, with the volume where there is no closed form,
/// milliseconds and Manifold's, and how many times faster than Manifold they have to be.
pub const VOLUMES: [(&str, Option<f64>, Goal, Option<f64>); 4] = [
    ("classic", None, Goal { ours: 0.3, peer: 340.0 }, Some(100.0)),
    ("spheres-1k", None, Goal { ours: 12.0, peer: 850e3 }, Some(1000.0)),
    ("plate-1k", None, Goal { ours: 1.5, peer: 7700.0 }, Some(100.0)),
    ("deep-200", Some(2.540_190_3), Goal { ours: 3.0, peer: 10_200.0 }, None),
];

/// How much more a ray may cost with ten times the leaves.
pub const GROWTH: f64 = 2.0;

/// Milliseconds to compile ten thousand leaves.
pub const COMPILE: f64 = 50.0;

/// How much faster two threads are than one.
pub const TWO_THREADS: f64 = 1.8;
