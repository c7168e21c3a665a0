//! Quadrics and boxes under products of maps, against numbers of 200 bits.
//!
//! `PROPTEST_CASES=10000 cargo test --test digits` looks for longer.

#[expect(dead_code, reason = "lattices have tests of their own")]
mod oracle;
#[expect(dead_code, reason = "models are drawn by proptest")]
mod support;

use std::ops::RangeInclusive;

use glam::DAffine3;
use oracle::compare::{Tally, compare};
use oracle::placed::placed;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use support::leaf::{self, Leaf};
use support::model::Model;
use support::scene;
use support::strategies::{Aim, aims, map, op};

/// A leaf without triangles.
fn smooth_leaf() -> impl Strategy<Value = Leaf> {
    leaf::bounded().prop_filter("meshes are for whole numbers", |leaf| {
        !matches!(leaf, Leaf::Mesh(_))
    })
}

/// Under a product of maps.
fn mapped(model: Model, maps: Vec<DAffine3>) -> Model {
    maps.into_iter().fold(model, Model::mapped)
}

/// Each map is itself a product of up to three moves, turns, stretches and shears.
fn placed_leaf(maps: RangeInclusive<usize>) -> impl Strategy<Value = Model> {
    (smooth_leaf(), vec(map(), maps))
        .prop_map(|(leaf, maps)| mapped(Model::Leaf(leaf), maps))
}

fn tree() -> impl Strategy<Value = Model> {
    placed_leaf(0..=1).prop_recursive(3, 8, 3, |inner| {
        prop_oneof![
            4 => (op(), vec(inner.clone(), 1..=3))
                .prop_map(|(op, children)| Model::Boolean(op, children)),
            1 => (map(), inner).prop_map(|(map, child)| child.mapped(map)),
        ]
    })
}

/// Compares rays through many models: those that go anywhere, and those aimed at features.
fn tally(models: impl Strategy<Value = Model>, times: u32) -> [Tally; 2] {
    let mut runner = TestRunner::deterministic();
    let (cases, mut tally) = ((models, aims()), [Tally::default(); 2]);
    for _ in 0..times * ProptestConfig::default().cases {
        let case = cases.new_tree(&mut runner).expect("few leaves are rejected");
        let (model, aims) = case.current();
        let (scene, leaves) = (scene(&model.solid()), placed(&model));
        for aim in aims {
            let kind = usize::from(!matches!(aim, Aim::Free(..)));
            tally[kind].add(compare(&model, &leaves, &scene, &aim.ray(&model)));
        }
    }
    tally
}

/// Lines that go anywhere, in one of three cases through places that are simple numbers, are
/// almost all clear, and about half of those through rims and corners, along generators or
/// tangent.
fn assert_clear([free, aimed]: [Tally; 2]) {
    assert!(100 * free.clear_rays >= 90 * free.rays, "{free:?}");
    assert!(100 * aimed.clear_rays >= 45 * aimed.rays, "{aimed:?}");
    assert!(free.crossings >= free.rays / 8, "{free:?}");
    assert!(aimed.crossings >= aimed.rays / 4, "{aimed:?}");
}

#[test]
fn leaves_are_crossed_where_200_bits_say() {
    assert_clear(tally(placed_leaf(0..=2), 4));
}

#[test]
fn leaves_under_products_of_maps_are_crossed_where_200_bits_say() {
    assert_clear(tally(placed_leaf(6..=10), 4));
}

#[test]
fn trees_are_crossed_where_200_bits_say() {
    assert_clear(tally(tree(), 4));
}
