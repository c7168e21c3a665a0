//! Pairs of trees that are the same solid, whatever their parts are.

use glam::DVec3;
use solidray::{Op, Scene};

use super::leaf::Leaf;
use super::model::Model;
use super::scene;

pub(crate) fn union(children: impl IntoIterator<Item = Model>) -> Model {
    Model::boolean(Op::Union, children)
}

pub(crate) fn intersection(children: impl IntoIterator<Item = Model>) -> Model {
    Model::boolean(Op::Intersection, children)
}

pub(crate) fn minus(a: &Model, b: &Model) -> Model {
    Model::boolean(Op::Difference, [a.clone(), b.clone()])
}

pub(crate) fn or(a: &Model, b: &Model) -> Model {
    union([a.clone(), b.clone()])
}

pub(crate) fn and(a: &Model, b: &Model) -> Model {
    intersection([a.clone(), b.clone()])
}

/// What is in one of two and not in the other.
pub(crate) fn xor(a: &Model, b: &Model) -> Model {
    or(&minus(a, b), &minus(b, a))
}

pub(crate) fn cube(center: f64, size: f64) -> Model {
    let (center, half) = (DVec3::splat(center), DVec3::splat(0.5 * size));
    Model::Leaf(Leaf::Cuboid { min: center - half, max: center + half })
}

/// Every line's reference point depends on the bounds of its scene. With two small cubes
/// far out all scenes have the same bounds, so equal surfaces give equal bits.
pub(crate) fn in_common_frame(model: &Model) -> Scene {
    let corners = [-1.0, 1.0].map(|sign| cube(sign * FAR, 1.0));
    scene(&union(std::iter::once(model.clone()).chain(corners)).solid())
}

/// Where the corners of the common frame are.
pub(crate) const FAR: f64 = 4096.0;

/// Commutativity, associativity, idempotence, absorption, distributivity, De Morgan's laws,
/// the double complement and what is subtracted from itself.
pub(crate) fn equal_pairs(a: &Model, b: &Model, c: &Model) -> Vec<(Model, Model)> {
    let (abc, nothing) = ([a, b, c].map(Model::clone), || union([]));
    // Surfaces of b that coincide with those of a but for rounding have to be there on both sides.
    let a_beside_b = || or(a, &minus(b, b));
    vec![
        (or(a, b), or(b, a)),
        (and(a, b), and(b, a)),
        (or(a, a), a.clone()),
        (and(a, a), a.clone()),
        (or(a, &and(a, b)), a_beside_b()),
        (and(a, &or(a, b)), a_beside_b()),
        (minus(a, &minus(a, b)), and(a, b)),
        (minus(c, &minus(c, &minus(c, a))), minus(c, a)),
        (minus(c, &or(a, b)), and(&minus(c, a), &minus(c, b))),
        (minus(c, &and(a, b)), or(&minus(c, a), &minus(c, b))),
        (and(a, &or(b, c)), or(&and(a, b), &and(a, c))),
        (or(a, &and(b, c)), and(&or(a, b), &or(a, c))),
        (union(abc.clone()), or(c, &or(b, a))),
        (intersection(abc.clone()), and(c, &and(b, a))),
        (Model::boolean(Op::Difference, abc), minus(a, &or(c, b))),
        (xor(a, b), minus(&or(a, b), &and(a, b))),
        (minus(a, a), nothing()),
        (xor(a, a), nothing()),
        (and(a, &minus(b, a)), nothing()),
    ]
}
