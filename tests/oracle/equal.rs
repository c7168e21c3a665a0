//! The spans that the kernel finds against those in whole numbers.

use solidray::{Ray, Scene, Sense};

use super::lattice::Lattice;
use super::sweep::sweep;
use crate::support::model::Model;
use crate::support::{ends_in, spans};

/// The list is that of the whole numbers: as long, each place the closest number but for one
/// rounding of the place as seen from the middle of the scene, each owner the same leaf.
pub(crate) fn assert_equal_lists(
    scene: &Scene,
    model: &Model,
    lattice: &Lattice,
    ray: &Ray,
) {
    let exact = sweep(model, &lattice.passages(ray));
    let found: Vec<_> =
        spans(scene, ray).iter().flat_map(|s| [s.enter, s.exit]).collect();
    assert_eq!(found.len(), exact.len(), "{ray:?}: {found:?} instead of {exact:?}");
    let size = scene.bounds().size().length() / ray.speed();
    for (found, exact) in found.iter().zip(exact) {
        let t = exact.t.rounded();
        let error = (found.t - t).abs();
        assert!(error <= f64::EPSILON * (t.abs() + size), "{ray:?}: {found:?}, {t}");
        assert_eq!(found.sense == Sense::Enter, exact.enters, "{ray:?}: {found:?}");
        assert_eq!(found.leaf as usize, exact.owner, "{ray:?}: {found:?}");
    }
}

/// The same for trees with meshes. Where a line passes a triangle is a quotient of sums of
/// products, so that faces of meshes that coincide with others can be a few roundings apart.
/// Directions of which the largest component is a power of two are sheared without rounding:
/// then it is exact which triangles they pass, and only these are looked at.
pub(crate) fn assert_equal_but_for_slivers(
    scene: &Scene,
    model: &Model,
    lattice: &Lattice,
    ray: &Ray,
) {
    if ray.dir.abs().max_element().log2().fract() != 0.0 {
        return;
    }
    let exact = sweep(model, &lattice.passages(ray));
    let size = scene.bounds().size().length() / ray.speed();
    let far = exact.iter().map(|c| c.t.rounded().abs()).fold(size, f64::max);
    let least = 16.0 * f64::EPSILON * far;
    let found = without_slivers(ends_in(scene, ray), least);
    let found: Vec<f64> = found.into_iter().flatten().collect();
    assert_eq!(found.len(), exact.len(), "{ray:?}: {found:?} instead of {exact:?}");
    for (t, exact) in found.iter().zip(exact) {
        let error = (t - exact.t.rounded()).abs();
        assert!(error <= least, "{ray:?}: {t} instead of {exact:?}");
    }
}

/// The list without what is shorter than the rounding of places inside triangles.
fn without_slivers(list: Vec<[f64; 2]>, least: f64) -> Vec<[f64; 2]> {
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for span in list {
        match joined.last_mut() {
            Some(last) if span[0] - last[1] < least => last[1] = span[1],
            _ => joined.push(span),
        }
    }
    joined.retain(|[enter, exit]| exit - enter >= least);
    joined
}
