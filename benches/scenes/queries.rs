//! What scenes are asked, and the ways of asking that are measured.
//!
//! Rays and points fill a space evenly, in an order that jumps about.

use std::f64::consts::TAU;

use glam::{DVec3, dvec3};
use rayon::prelude::*;
use solidray::render::{View, trace};
use solidray::{Aabb, Ray, Scene, Tracer};

/// Traces a picture and adds up its normals, on as many threads as there are: all that
/// shading needs.
pub(crate) fn normals(scene: &Scene, view: &View) -> DVec3 {
    let frame = trace(scene, view, [0.5; 2], &|_| ());
    let [width, height] = frame.size();
    let normal = |(x, y)| Some(scene.normal_at(&frame.ray(x, y), &frame.hit(x, y)?));
    let row = |y| (0..width).filter_map(|x| normal((x, y))).sum::<DVec3>();
    (0..height).into_par_iter().map(row).sum()
}

/// Adds up where single rays first hit.
pub(crate) fn first(tracer: &mut Tracer<'_>, rays: &[Ray]) -> f64 {
    rays.iter().filter_map(|ray| tracer.first_hit(ray)).map(|hit| hit.t).sum()
}

/// Counts the spans of rays.
pub(crate) fn spans(tracer: &mut Tracer<'_>, rays: &[Ray]) -> usize {
    rays.iter().map(|ray| tracer.spans(ray).len()).sum()
}

/// Counts the points inside.
pub(crate) fn inside(scene: &Scene, points: &[DVec3]) -> usize {
    scene.contains_all(points).into_iter().filter(|&inside| inside).count()
}

/// The rays through the centres of all pixels, row by row.
pub(crate) fn parallel(view: &View) -> Vec<Ray> {
    let [width, height] = view.size();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    pixels.map(|(x, y)| view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5)).collect()
}

/// Rays from one place on the sphere around a box towards another, both anywhere.
pub(crate) fn chords(bounds: &Aabb, count: u32) -> Vec<Ray> {
    let (center, radius) = (bounds.center(), 0.5 * bounds.size().length());
    let chord = |[u, v, s, t]: [f64; 4]| {
        let [from, to] = [on_sphere(u, v), on_sphere(s, t)];
        Ray::new(center + radius * from, (to - from).normalize_or(DVec3::Z))
    };
    (0..count).map(|i| chord(spread(i))).collect()
}

/// Points in a box.
pub(crate) fn points(bounds: &Aabb, count: u32) -> Vec<DVec3> {
    let point = |at: [f64; 3]| bounds.min + bounds.size() * DVec3::from_array(at);
    (0..count).map(|i| point(spread(i))).collect()
}

/// A place on the unit sphere for one in the unit square, evenly.
fn on_sphere(u: f64, v: f64) -> DVec3 {
    let (z, turn) = (2.0 * u - 1.0, TAU * v);
    let radius = (1.0 - z * z).sqrt();
    dvec3(radius * turn.cos(), radius * turn.sin(), z)
}

/// Place `i` of a sequence that fills the unit cube of `D` dimensions: multiples of the
/// powers of 1/g, where g > 1 solves g^(D + 1) = g + 1, without their whole parts.
fn spread<const D: usize>(i: u32) -> [f64; D] {
    let mut g = 1.0_f64;
    for _ in 0..64 {
        g = (1.0 + g).powf(1.0 / (D as f64 + 1.0));
    }
    let mut power = 1.0;
    [(); D].map(|()| {
        power /= g;
        (0.5 + power * f64::from(i + 1)).fract()
    })
}
