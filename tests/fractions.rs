//! Boxes, half-spaces and meshes on a lattice, asked along lines through its points: equal
//! lists, against whole numbers and their fractions.
//!
//! Coordinates are −2, −1, 0, 1 or 2 quarters, so that faces, edges and corners meet as
//! often as they can. `PROPTEST_CASES=100000 cargo test --test fractions` looks for longer.

#[expect(dead_code, reason = "whole numbers are enough here")]
mod oracle;
#[expect(dead_code, reason = "lattices take the exact among the strategies")]
mod support;

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use oracle::equal::{self, assert_equal_lists};
use oracle::lattice::Lattice;
use proptest::collection::vec;
use proptest::prelude::*;
use solidray::{Mesh, Op, Ray};
use support::algebra::{equal_pairs, in_common_frame, union};
use support::dice::Dice;
use support::leaf::{Leaf, Shared};
use support::model::Model;
use support::strategies::{op, symmetry};
use support::{ends_in, meshes, scene};

/// How many rays each tree is asked along: with the usual 1024 trees, 100,000.
const RAYS: usize = 100;

fn many() -> ProptestConfig {
    let usual = ProptestConfig::default();
    ProptestConfig { cases: 4 * usual.cases, ..usual }
}

fn quarter() -> impl Strategy<Value = f64> {
    (-2..=2_i32).prop_map(|i| 0.25 * f64::from(i))
}

fn point() -> impl Strategy<Value = DVec3> {
    [quarter(), quarter(), quarter()].prop_map(DVec3::from_array)
}

/// Two of the five coordinates, the smaller one first.
fn interval() -> impl Strategy<Value = [f64; 2]> {
    (-2..2_i32, 1..=4_i32)
        .prop_map(|(low, size)| [low, (low + size).min(2)].map(|i| 0.25 * f64::from(i)))
}

/// The smallest and the largest corner of a box.
fn corners() -> impl Strategy<Value = [DVec3; 2]> {
    [interval(), interval(), interval()]
        .prop_map(|[x, y, z]| [0, 1].map(|end| DVec3::new(x[end], y[end], z[end])))
}

fn cuboid() -> impl Strategy<Value = Leaf> {
    corners().prop_map(|[min, max]| Leaf::Cuboid { min, max })
}

fn half_space() -> impl Strategy<Value = Leaf> {
    let component = || (-2..=2_i32).prop_map(f64::from);
    ([component(), component(), component()], quarter()).prop_map(|(normal, offset)| {
        let normal = DVec3::from_array(normal);
        let normal = if normal == DVec3::ZERO { DVec3::Y } else { normal };
        Leaf::HalfSpace { normal, offset }
    })
}

/// A tetrahedron with corners on the lattice, or a box with triangles.
fn mesh() -> impl Strategy<Value = Leaf> {
    let tetrahedron = [point(), point(), point(), point()].prop_filter_map(
        "its corners are in one plane",
        |[a, b, c, d]| {
            let volume = (b - a).dot((c - a).cross(d - a));
            let (c, d) = if volume > 0.0 { (c, d) } else { (d, c) };
            let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
            let mesh = Mesh::new(vec![a, b, c, d], faces);
            (volume != 0.0).then(|| mesh.expect("a tetrahedron is closed"))
        },
    );
    let grid = (corners(), 1..=2_i32)
        .prop_map(|([min, max], steps)| meshes::grid_box(min, max, steps));
    prop_oneof![tetrahedron, grid].prop_map(|mesh| Leaf::Mesh(Shared(Arc::new(mesh))))
}

/// A map that rounds nothing.
fn exact_map() -> impl Strategy<Value = DAffine3> {
    (symmetry(), -1..=1_i32, point()).prop_map(|(turn, power, offset)| {
        DAffine3::from_mat3_translation(turn * 2.0_f64.powi(power), offset)
    })
}

/// A tree of up to a dozen leaves.
fn tree(leaf: impl Strategy<Value = Leaf> + 'static) -> impl Strategy<Value = Model> {
    leaf.prop_map(Model::Leaf).prop_recursive(4, 12, 3, |inner| {
        prop_oneof![
            3 => (op(), vec(inner.clone(), 1..=4))
                .prop_map(|(op, children)| Model::Boolean(op, children)),
            1 => (exact_map(), inner).prop_map(|(map, child)| child.mapped(map)),
        ]
    })
}

/// The part of a tree that is in a large box: half-spaces have no end.
fn bounded(tree: Model) -> Model {
    let guard = Leaf::Cuboid { min: DVec3::splat(-16.0), max: DVec3::splat(16.0) };
    Model::boolean(Op::Intersection, [tree, Model::Leaf(guard)])
}

/// Rays at what is there: through two features, from one along an axis or a lattice
/// direction, or through any points of the lattice.
struct Rays {
    dice: Dice,
    features: Vec<DVec3>,
}

impl Rays {
    fn new(model: &Model, seed: u64) -> Self {
        let on_lattice = |p: &DVec3| (256.0 * p).fract() == DVec3::ZERO;
        let features = model.features().into_iter().map(|f| f.point);
        Self { dice: Dice::new(seed), features: features.filter(on_lattice).collect() }
    }

    fn small(&mut self, steps: i32) -> f64 {
        let range = usize::try_from(2 * steps + 1).expect("it is not negative");
        let i = i32::try_from(self.dice.below(range)).expect("it is small");
        f64::from(i - steps)
    }

    fn lattice_point(&mut self, reach: i32) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.small(reach)))
    }

    fn feature(&mut self) -> DVec3 {
        if self.features.is_empty() {
            return 0.25 * self.lattice_point(2);
        }
        self.features[self.dice.below(self.features.len())]
    }

    fn next(&mut self) -> Ray {
        let (from, axis) = (self.feature(), DVec3::AXES[self.dice.below(3)]);
        let (from, dir) = match self.dice.below(5) {
            0 | 1 => (from, self.feature() - from),
            2 => (from, axis * [1.0, -0.5][self.dice.below(2)]),
            3 => (from, self.lattice_point(2)),
            _ => (0.125 * self.lattice_point(4), self.lattice_point(4)),
        };
        let dir = if dir == DVec3::ZERO { axis } else { dir };
        Ray::new(from + self.small(3) * dir, dir)
    }
}

/// Asks along many rays. Where a mesh is passed is compared but for slivers.
fn assert_equal_but_for_slivers(model: &Model, seed: u64) {
    let (scene, lattice) = (scene(&model.solid()), Lattice::new(model));
    let mut rays = Rays::new(model, seed);
    for _ in 0..RAYS {
        equal::assert_equal_but_for_slivers(&scene, model, &lattice, &rays.next());
    }
}

fn assert_equal(model: &Model, seed: u64) {
    let (scene, lattice) = (scene(&model.solid()), Lattice::new(model));
    let mut rays = Rays::new(model, seed);
    for _ in 0..RAYS {
        assert_equal_lists(&scene, model, &lattice, &rays.next());
    }
}

proptest! {
    #![proptest_config(many())]

    #[test]
    fn boxes_on_a_lattice_give_the_lists_of_exact_fractions(
        model in tree(cuboid()),
        seed in any::<u64>(),
    ) {
        assert_equal(&model, seed);
    }

    #[test]
    fn half_spaces_on_a_lattice_give_the_lists_of_exact_fractions(
        tree in tree(prop_oneof![cuboid(), half_space()]),
        seed in any::<u64>(),
    ) {
        assert_equal(&bounded(tree), seed);
    }

    #[test]
    fn n24_the_algebra_holds_bit_by_bit_on_a_lattice(
        a in tree(prop_oneof![cuboid(), half_space()]),
        b in tree(cuboid()),
        c in tree(cuboid()),
        seed in any::<u64>(),
    ) {
        let (a, all) = (bounded(a.clone()), union([a, b.clone(), c.clone()]));
        let mut rays = Rays::new(&all, seed);
        for (left, right) in equal_pairs(&a, &b, &c) {
            let (left, right) = (in_common_frame(&left), in_common_frame(&right));
            for _ in 0..4 {
                let ray = rays.next();
                prop_assert_eq!(ends_in(&left, &ray), ends_in(&right, &ray), "{:?}", ray);
            }
        }
    }

    #[test]
    fn meshes_on_a_lattice_give_the_lists_of_exact_fractions_but_for_slivers(
        tree in tree(prop_oneof![1 => cuboid(), 1 => half_space(), 2 => mesh()]),
        seed in any::<u64>(),
    ) {
        assert_equal_but_for_slivers(&bounded(tree), seed);
    }
}
