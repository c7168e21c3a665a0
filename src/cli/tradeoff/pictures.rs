//! The error of pictures against their cost: by how much outlines are off.

use std::time::{Duration, Instant};

use serde::Serialize;
use solidray::render::{self, Camera};
use solidray::{Scene, facets};

use super::super::interrupt::interrupted;
use super::fit::order;
use super::volumes::MOST_TRIANGLES;
use super::{Series, Study, Trial, on_one_thread};

/// How far outlines are off, in pixels of a picture [`WIDTH`] wide.
#[derive(Serialize)]
pub(super) struct Pictures {
    pub(super) series: Vec<Series>,
}

/// In pixels of pictures so wide errors are told, whatever the size is.
pub(super) const WIDTH: u32 = 1024;
/// The widths that are tried; heights are three quarters of them.
const WIDTHS: [u32; 4] = [256, 512, WIDTH, 2048];
const SAMPLES: [u32; 4] = [1, 4, 16, 64];
/// The rays through a pixel of what pictures are compared with.
const FINE: u32 = 233;
/// The rays through a pixel of pictures of facets and of what they are compared with: the same, so
/// that what they miss is the same.
const FACETED: [u32; 2] = [WIDTH / 2, 16];

impl Study<'_> {
    /// Nothing where the solid has no outline to be seen.
    pub(super) fn pictures(
        &self,
        facets: Option<&Series>,
        notes: &mut Vec<String>,
    ) -> anyhow::Result<Option<Pictures>> {
        let camera = Camera::framing(&self.scene.bounds());
        let view = |width, samples| {
            let size = [width, width / 4 * 3];
            render::coverage(self.scene, &camera, size, samples, &|rays| {
                // It cannot be stopped within a picture.
                let _ = (self.watch)(rays);
            })
        };
        let start = Instant::now();
        let limit = self.share(0.3);
        let per_ray = on_one_thread(|| {
            let start = Instant::now();
            view(WIDTHS[0], 4);
            start.elapsed().as_secs_f64() / (4.0 * pixels(WIDTHS[0]))
        })?;
        let mut series = Vec::new();
        for width in WIDTHS {
            let together = f64::from(FINE) / threads();
            let alone = f64::from(SAMPLES.iter().sum::<u32>());
            let rays = (together + alone) * pixels(width);
            let left = limit.saturating_sub(start.elapsed());
            if rays * per_ray > left.as_secs_f64() || interrupted() {
                notes.push(format!(
                    "pictures {width} pixels wide and more are left out for want of time"
                ));
                break;
            }
            let truth = view(width, FINE);
            let mut trials = Vec::new();
            for samples in SAMPLES {
                let (covered, seconds) = on_one_thread(|| {
                    let start = Instant::now();
                    (view(width, samples), start.elapsed().as_secs_f64())
                })?;
                let Some(error) = displacement(&covered, &truth, width) else {
                    return Ok(None);
                };
                trials.push(Trial {
                    setting: format!(
                        "--imgsize {width},{} --samples {samples}",
                        width / 4 * 3
                    ),
                    samples: covered.len() as u64 * u64::from(samples),
                    seconds,
                    error,
                    half_width: None,
                    runs: 1,
                });
            }
            let order = order(&trials, 0.0);
            let name = format!("{width} × {} pixels", width / 4 * 3);
            series.push(Series { name, unit: "rays", trials, order });
        }
        if let Some(facets) = facets {
            let trials =
                self.faceted(facets, &camera, limit.saturating_sub(start.elapsed()))?;
            let order = order(&trials, 0.0);
            let name = facets.name.clone();
            series.push(Series { name, unit: facets.unit, trials, order });
        }
        series.retain(|series| !series.trials.is_empty());
        Ok((!series.is_empty()).then_some(Pictures { series }))
    }

    /// How far the outlines of facets are off, which cost what it took to make them.
    fn faceted(
        &self,
        volumes: &Series,
        camera: &Camera,
        limit: Duration,
    ) -> anyhow::Result<Vec<Trial>> {
        let start = Instant::now();
        let [width, samples] = FACETED;
        let size = [width, width / 4 * 3];
        let see = |scene: &Scene| render::coverage(scene, camera, size, samples, &|_| ());
        let truth = see(self.scene);
        let mut trials = Vec::new();
        for trial in &volumes.trials {
            if start.elapsed() > limit || interrupted() {
                break;
            }
            let Some(segments) = trial.setting.strip_prefix("$fn = ") else { continue };
            let faceted = facets::faceted(self.solid, segments.parse()?, MOST_TRIANGLES)?;
            let scene = Scene::compile_with(&faceted.solid, &self.options)?;
            let Some(error) = displacement(&see(&scene), &truth, width) else { break };
            trials.push(Trial { error, ..trial.clone() });
        }
        Ok(trials)
    }
}

/// How many threads there are.
fn threads() -> f64 {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads() as f64;
    #[cfg(not(feature = "parallel"))]
    1.0
}

fn pixels(width: u32) -> f64 {
    f64::from(width) * f64::from(width / 4 * 3)
}

/// How far an outline is off on average, in pixels of a picture [`WIDTH`] wide: the area between
/// it and the true one over its length. An outline of length 1, in any direction, runs through
/// 4/π pixels on average.
fn displacement(covered: &[f32], truth: &[f32], width: u32) -> Option<f64> {
    let edge = truth.iter().filter(|&&c| c > 0.0 && c < 1.0 - f32::EPSILON * 512.0);
    let length = edge.count() as f64 * std::f64::consts::FRAC_PI_4;
    let between = |(a, b): (&f32, &f32)| f64::from((a - b).abs());
    let area: f64 = covered.iter().zip(truth).map(between).sum();
    let scale = f64::from(WIDTH) / f64::from(width);
    (length > 0.0).then(|| area / length * scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half planes whose edges run upright, a third of a pixel apart.
    #[test]
    fn outlines_that_are_moved_are_off_by_that() {
        let plane = |edge: f32| -> Vec<f32> {
            (0..64_u8).map(|i| (edge - f32::from(i % 8)).clamp(0.0, 1.0)).collect()
        };
        let (truth, moved) = (plane(3.5), plane(3.25));
        // Its length is not 8 but what slanted edges through as many pixels have.
        let expected = 0.25 * 4.0 / std::f64::consts::PI;
        let found = displacement(&moved, &truth, WIDTH).expect("there is an edge");
        assert!((found - expected).abs() < 1e-6, "{found}");
        let found = displacement(&moved, &truth, WIDTH / 4).expect("there is an edge");
        assert!((found - 4.0 * expected).abs() < 1e-6, "{found}");
        assert_eq!(displacement(&plane(3.0), &plane(3.0), WIDTH), None);
    }
}
