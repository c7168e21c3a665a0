//! Lines at the features of a mesh.

use glam::{DAffine3, DVec3};
use solidray::{Mesh, Ray};

use super::dice::Dice;

/// How many kinds of lines there are.
pub(crate) const KINDS: usize = 10;

/// The kind of lines that lie within a face but for rounding.
pub(crate) const WITHIN_A_FACE: usize = 8;

/// A line in the mesh's own frame: through a corner, an edge or two corners, along an axis
/// or an edge, or within a face.
pub(crate) fn at_feature(mesh: &Mesh, dice: &mut Dice, kind: usize) -> Ray {
    let face = mesh.faces()[dice.below(mesh.faces().len())];
    let turn = dice.below(3);
    let [a, b, c] =
        [0, 1, 2].map(|i: usize| mesh.points()[face[(i + turn) % 3] as usize]);
    let size = mesh.bounds().size().max_element();
    let from = mesh.bounds().center() + 2.0 * size * dice.direction();
    let axis = DVec3::AXES[dice.below(3)];
    let ray = match kind % KINDS {
        0 => Ray::new(from, a - from),
        1 => Ray::new(from, 0.5 * (a + b) - from),
        2 => Ray::new(from, a + dice.within(0.0, 1.0) * (b - a) - from),
        3 => Ray::new(a, axis),
        4 => Ray::new(0.5 * (a + b), -axis),
        5 => Ray::new(a - 2.0 * (b - a), b - a),
        6 => Ray::new(a, 0.5 * (b + c) - a),
        7 => Ray::new(a, mesh.points()[dice.below(mesh.points().len())] - a),
        WITHIN_A_FACE => within([a, b, c], dice),
        _ => Ray::new(0.25 * (a + b) + 0.5 * c, axis),
    };
    // Two corners may be one point.
    if ray.is_valid() { ray } else { Ray::new(a, axis) }
}

/// From outside a triangle through two points of it.
fn within([a, b, c]: [DVec3; 3], dice: &mut Dice) -> Ray {
    let mut point =
        || a + dice.within(0.0, 0.5) * (b - a) + dice.within(0.0, 0.5) * (c - a);
    let (p, q) = (point(), point());
    Ray::new(p - 3.0 * (q - p), q - p)
}

/// The image of a line.
pub(crate) fn mapped(ray: &Ray, map: &DAffine3) -> Ray {
    Ray::new(map.transform_point3(ray.origin), map.transform_vector3(ray.dir))
}
