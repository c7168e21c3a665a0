//! Soft light: how much of a wide lamp each surface sees.

use glam::{Vec3, dvec3};

use super::Frame;
use super::light::{KEY, lamp};
use super::look::Seen;
use crate::ray::{Ray, Sense};
use crate::scene::Tracer;

/// What light there is where no lamp can be seen.
const INDOORS: f32 = 0.25;

/// The share of the light of a lamp as wide as the sky, brightest where the key light is, that falls
/// on what is seen in a pixel, with what would without anything in between as 1.
///
/// The directions are the same in every pixel, others for each of a pixel's rays: no noise, but
/// shadows of that many lamps.
pub(super) fn openness(
    tracer: &mut Tracer<'_>,
    frame: &Frame,
    [x, y]: [u32; 2],
    seen: &Seen,
    rays: u32,
    sample: u32,
) -> f32 {
    let Some(hit) = frame.hit(x, y) else { return 1.0 };
    let ray = frame.ray(x, y);
    let point = ray.at(hit.t);
    let [right, up, forward] = frame.view().axes();
    let (mut all, mut seen_of_it) = (0.0, 0.0);
    for towards in directions(rays, sample) {
        let facing = seen.eye_normal.dot(towards);
        let light = facing * lamp(towards.dot(KEY));
        if facing <= 0.0 || light <= 0.0 {
            continue;
        }
        all += light;
        let d = towards.as_dvec3();
        let dir = d.x * right + d.y * up - d.z * forward;
        let away = Ray::new(point, dir);
        // From inside of the solid light comes through the wall that is seen.
        let blocked = hit.sense == Sense::Enter && tracer.next_hit(&away, &hit).is_some();
        if !blocked {
            seen_of_it += light;
        }
    }
    if all > 0.0 { INDOORS + (1.0 - INDOORS) * seen_of_it / all } else { 1.0 }
}

/// Directions spread evenly over the sphere, in eye coordinates: those of one of a pixel's rays are a
/// spiral (Swinbank and Purser, "Fibonacci grids", 2006), turned for each by the golden angle.
fn directions(count: u32, sample: u32) -> impl Iterator<Item = Vec3> {
    const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
    let turn = f64::from(sample) * 0.618_033_988_749_894_9;
    (0..count).map(move |i| {
        let i = f64::from(i);
        let height =
            1.0 - (2.0 * i + 2.0 * (turn.fract() - 0.5) + 1.0) / f64::from(count);
        let height = height.clamp(-1.0, 1.0);
        let around = GOLDEN_ANGLE * (i + 1.0) + std::f64::consts::TAU * turn;
        let flat = (1.0 - height * height).sqrt();
        dvec3(flat * around.cos(), flat * around.sin(), height).as_vec3()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_cover_the_sphere() {
        for count in [8, 32, 100] {
            let all: Vec<Vec3> =
                (0..4).flat_map(|sample| directions(count, sample)).collect();
            let mean = all.iter().sum::<Vec3>() / all.len() as f32;
            assert!(mean.length() < 0.1, "{count}: {mean}");
            assert!(all.iter().all(|d| (d.length() - 1.0).abs() < 1e-6));
        }
    }
}
