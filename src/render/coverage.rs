//! How much of each pixel a solid covers.

use super::Camera;
use super::frame::trace_rows;
use super::picture::{bands, spread};
use crate::progress::Progress;
use crate::scene::Scene;

/// The part of each pixel in which the solid is seen, from 0 to 1, row by row from the upper left:
/// the part of `samples` rays through it that hit, spread as [`picture`](super::picture()) spreads
/// them. An edge that is straight within the pixel is then known to be where it is but for a
/// fraction of a pixel.
pub fn coverage(
    scene: &Scene,
    camera: &Camera,
    size: [u32; 2],
    samples: u32,
    progress: Progress<'_>,
) -> Vec<f32> {
    let view = camera.view(size, &scene.bounds());
    let offsets = spread(samples.max(1));
    let each = 1.0 / samples.max(1) as f32;
    let mut covered = Vec::with_capacity(size[0] as usize * size[1] as usize);
    for rows in bands(size, 1) {
        let start = covered.len();
        covered.resize(start + size[0] as usize * rows.len(), 0.0);
        for &offset in &offsets {
            let frame = trace_rows(scene, &view, rows.clone(), offset, progress);
            let mut pixels = covered[start..].iter_mut();
            for y in 0..rows.end - rows.start {
                for (x, pixel) in (0..size[0]).zip(&mut pixels) {
                    *pixel += if frame.hit(x, y).is_some() { each } else { 0.0 };
                }
            }
        }
    }
    covered
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Solid;

    /// A ball of radius 1 seen by parallel rays fills a disc; with more rays its area is nearer
    /// to π.
    #[test]
    fn a_disc_has_its_area() {
        let scene = Scene::compile(&Solid::ball(1.0)).expect("a ball");
        let camera = Camera::framing(&scene.bounds())
            .with_projection(super::super::Projection::Orthographic);
        let size = [128, 96];
        let area = |samples| {
            let covered = coverage(&scene, &camera, size, samples, &|_| ());
            assert_eq!(covered.len(), 128 * 96);
            assert!(covered.iter().all(|c| (0.0..=1.000_01).contains(c)));
            covered.iter().sum::<f32>()
        };
        let truth = area(144);
        let error = |samples| (area(samples) / truth - 1.0).abs();
        assert!(error(1) < 0.02 && error(16) < 0.002, "{} {}", error(1), error(16));
        // The rows above and below the ball are empty, its middle is full.
        let covered = coverage(&scene, &camera, size, 4, &|_| ());
        assert!(covered[..128].iter().all(|&c| c < 0.001));
        assert!(covered[48 * 128 + 64] > 0.999);
    }
}
