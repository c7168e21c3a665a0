//! Lengths along the line of sight, as numbers rather than colours.

use std::ops::Range;

use super::frame::trace_rows;
use super::picture::{bands, spread};
use super::{Camera, View, chunks};
use crate::progress::Progress;
use crate::scene::Scene;

/// How deep in the picture the solid begins, through the middle of each pixel, row by row from the
/// upper left: in model units along the line of sight, from the eye, or for parallel rays from where
/// [`View`] has them start. Not a number where nothing is.
pub fn depth(
    scene: &Scene,
    camera: &Camera,
    size: [u32; 2],
    progress: Progress<'_>,
) -> Vec<f32> {
    depth_bands(scene, camera, size, progress).flatten().collect()
}

/// The same in bands of whole rows, each found when it is asked for: for pictures that are too large to
/// be held whole.
pub fn depth_bands<'a>(
    scene: &'a Scene,
    camera: &Camera,
    size: [u32; 2],
    progress: Progress<'a>,
) -> impl Iterator<Item = Vec<f32>> + 'a {
    let view = camera.view(size, &scene.bounds());
    bands(size, 1).map(move |rows| {
        let height = rows.end - rows.start;
        let frame = trace_rows(scene, &view, rows, [0.5, 0.5], progress);
        #[expect(clippy::cast_possible_truncation, reason = "a picture is no more exact")]
        let depth = |(x, y)| frame.hit(x, y).map_or(f32::NAN, |hit| hit.t as f32);
        let pixels = (0..height).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        pixels.map(depth).collect()
    })
}

/// How much of the solid the line of sight passes through in each pixel, row by row from the upper
/// left: the mean length inside, in model units, of `samples` rays through it, spread as
/// [`picture`](super::picture()) spreads them.
pub fn thickness(
    scene: &Scene,
    camera: &Camera,
    size: [u32; 2],
    samples: u32,
    progress: Progress<'_>,
) -> Vec<f32> {
    thickness_bands(scene, camera, size, samples, progress).flatten().collect()
}

/// The same in bands of whole rows, each found when it is asked for: for pictures that are too large to
/// be held whole.
pub fn thickness_bands<'a>(
    scene: &'a Scene,
    camera: &Camera,
    size: [u32; 2],
    samples: u32,
    progress: Progress<'a>,
) -> impl Iterator<Item = Vec<f32>> + 'a {
    let view = camera.view(size, &scene.bounds());
    let offsets = spread(samples.max(1));
    bands(size, 1)
        .map(move |rows| thickness_of_rows(scene, &view, &rows, &offsets, progress))
}

fn thickness_of_rows(
    scene: &Scene,
    view: &View,
    rows: &Range<u32>,
    offsets: &[[f64; 2]],
    progress: Progress<'_>,
) -> Vec<f32> {
    let [width, _] = view.size();
    let mut lengths = vec![0.0; width as usize * rows.len()];
    chunks::for_each(
        &mut lengths,
        width.max(1) as usize,
        || scene.tracer(),
        |tracer, y, row| {
            let y = f64::from(rows.start) + y as f64;
            for (pixel, x) in row.iter_mut().zip(0_u32..) {
                let mut sum = 0.0;
                for [right, down] in offsets {
                    let ray = view.ray(f64::from(x) + right, y + down);
                    // What is behind the eye is not in the picture.
                    let seen = |enter: f64, exit: f64| (exit - enter.max(0.0)).max(0.0);
                    let spans = tracer.spans(&ray).iter();
                    let inside: f64 = spans.map(|s| seen(s.enter.t, s.exit.t)).sum();
                    sum += inside * ray.dir.length();
                }
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "a picture is no more exact"
                )]
                let mean = (sum / offsets.len() as f64) as f32;
                *pixel = mean;
            }
            progress(u64::from(width) * offsets.len() as u64);
        },
    );
    lengths
}

#[cfg(test)]
mod tests {
    use super::super::Projection;
    use super::*;
    use crate::{Aabb, Solid};
    use glam::{DVec3, dvec3};

    const SIZE: [u32; 2] = [32, 24];

    /// From above, by parallel rays; a pixel is as wide as the number says.
    fn above(pixel: f64) -> Camera {
        let height = 0.5 * pixel * f64::from(SIZE[1]);
        let distance = height / (0.5 * Camera::FIELD_OF_VIEW_DEG).to_radians().tan();
        Camera { rotation_deg: DVec3::ZERO, distance, ..Camera::default() }
            .with_projection(Projection::Orthographic)
    }

    #[test]
    fn lengths_are_those_of_the_solid() {
        let hole = Solid::cuboid(dvec3(4.0, 4.0, 3.0));
        let scene = Scene::compile(&(Solid::cuboid(dvec3(8.0, 8.0, 10.0)) - hole))
            .expect("a box");
        let lengths = thickness(&scene, &above(0.5), SIZE, 4, &|_| ());
        let at = |x: usize, y: usize| lengths[y * SIZE[0] as usize + x];
        assert_eq!((at(0, 0), at(16, 12), at(16, 6)), (0.0, 7.0, 10.0));
        // All of them together are the volume.
        let volume = lengths.iter().sum::<f32>() * 0.25;
        assert!((volume - (640.0 - 48.0)).abs() < 1e-3, "{volume}");
        let eye = Camera { distance: 4.5, ..above(0.5) }
            .with_projection(Projection::Perspective);
        let inside = thickness(&scene, &eye, SIZE, 1, &|_| ());
        assert!((inside[12 * 32 + 16] - 6.5).abs() < 0.02, "{}", inside[12 * 32 + 16]);
    }

    #[test]
    fn depths_are_those_of_the_first_crossing() {
        let scene = Scene::compile(&Solid::cuboid(DVec3::splat(4.0))).expect("a box");
        let camera = above(0.5);
        let depths = depth(&scene, &camera, SIZE, &|_| ());
        assert!(depths[0].is_nan());
        let view = camera.view(SIZE, &Aabb::new(DVec3::splat(-2.0), DVec3::splat(2.0)));
        let point = view.ray(16.5, 12.5).at(f64::from(depths[12 * 32 + 16]));
        assert!((point.z - 2.0).abs() < 1e-5, "{point}");
    }
}
