//! Boxes on the integer lattice, asked along its lines: every way in which faces, edges and
//! corners can meet, against a count of unit cubes.

#[expect(dead_code, reason = "boxes need neither dice nor other leaves")]
mod support;

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use proptest::collection::vec;
use proptest::prelude::*;
use solidray::{Op, Ray, Scene};
use support::leaf::{Leaf, Shared};
use support::model::Model;
use support::strategies::{op, symmetry};
use support::{ends_in, meshes, scene};

/// Boxes have coordinates from −3 to 3; maps move them by as much again.
const REACH: i32 = 3;

/// Everything is within this.
const EDGE: i32 = 32;

#[derive(Clone, Copy, Debug)]
enum Kind {
    Cuboid,
    HalfSpaces,
    Mesh,
}

fn integer_point() -> impl Strategy<Value = [i32; 3]> {
    [-REACH..=REACH, -REACH..=REACH, -REACH..=REACH]
}

fn real(p: [i32; 3]) -> DVec3 {
    DVec3::from_array(p.map(f64::from))
}

/// A box with integer corners, made in one of several ways.
fn integer_box(kinds: &'static [Kind]) -> impl Strategy<Value = Model> {
    let kind = prop::sample::select(kinds);
    (integer_point(), [1..=4_i32, 1..=4, 1..=4], kind).prop_map(|(min, size, kind)| {
        let (min, max) = (real(min), real(min) + real(size));
        match kind {
            Kind::Cuboid => Model::Leaf(Leaf::Cuboid { min, max }),
            Kind::Mesh => {
                Model::Leaf(Leaf::Mesh(Shared(Arc::new(meshes::grid_box(min, max, 1)))))
            }
            Kind::HalfSpaces => {
                let half = |normal: DVec3, offset: f64| {
                    Model::Leaf(Leaf::HalfSpace { normal, offset })
                };
                let sides = DVec3::AXES.into_iter().flat_map(|axis| {
                    [half(axis, axis.dot(max)), half(-2.0 * axis, -2.0 * axis.dot(min))]
                });
                Model::boolean(Op::Intersection, sides)
            }
        }
    })
}

fn map() -> impl Strategy<Value = DAffine3> {
    (symmetry(), integer_point()).prop_map(|(linear, offset)| {
        DAffine3::from_mat3_translation(linear, real(offset))
    })
}

/// A tree of boxes under moves, quarter turns and mirrors.
fn boxes(kinds: &'static [Kind]) -> impl Strategy<Value = Model> {
    let placed = (integer_box(kinds), map()).prop_map(|(b, map)| b.mapped(map));
    let leaf = prop_oneof![integer_box(kinds), placed];
    leaf.prop_recursive(3, 12, 4, |inner| {
        prop_oneof![
            5 => (op(), vec(inner.clone(), 1..=4))
                .prop_map(|(op, children)| Model::Boolean(op, children)),
            1 => (map(), inner).prop_map(|(map, child)| child.mapped(map)),
        ]
    })
}

/// The runs of unit cubes of a model along an axis, in the column of cubes whose corner
/// with the smallest coordinates is (`u`, `v`).
fn runs(model: &Model, axis: usize, [u, v]: [i32; 2]) -> Vec<[f64; 2]> {
    let mut runs: Vec<[f64; 2]> = Vec::new();
    for i in -EDGE..EDGE {
        let mut center = DVec3::splat(0.5);
        center[axis] += f64::from(i);
        center[(axis + 1) % 3] += f64::from(u);
        center[(axis + 2) % 3] += f64::from(v);
        if !model.holds(center).expect("no face is at a half-integer") {
            continue;
        }
        let (low, high) = (f64::from(i), f64::from(i + 1));
        match runs.last_mut() {
            Some(last) if last[1] >= low => last[1] = high,
            _ => runs.push([low, high]),
        }
    }
    runs
}

/// The line along an axis at these other coordinates, `t` being the coordinate along it.
fn axis_ray(axis: usize, [u, v]: [f64; 2]) -> Ray {
    let mut origin = DVec3::ZERO;
    (origin[(axis + 1) % 3], origin[(axis + 2) % 3]) = (u, v);
    Ray::new(origin, DVec3::AXES[axis])
}

/// Every third column in each of three directions: enough, as trees are many.
fn columns(shift: i32) -> impl Iterator<Item = (usize, [i32; 2])> {
    let range = move || (-6 - shift % 3..=6).step_by(3);
    (0..3).flat_map(move |axis| {
        range().flat_map(move |u| range().map(move |v| (axis, [u, v])))
    })
}

fn assert_runs(scene: &Scene, model: &Model, shift: i32, beside: f64) {
    for (axis, [u, v]) in columns(shift) {
        let ray = axis_ray(axis, [f64::from(u) + beside, f64::from(v) + beside]);
        assert_eq!(ends_in(scene, &ray), runs(model, axis, [u, v]), "{ray:?}");
    }
}

proptest! {
    #[test]
    fn rays_through_unit_cubes_count_them(
        model in boxes(&[Kind::Cuboid, Kind::HalfSpaces, Kind::Mesh]),
        shift in 0..3_i32,
    ) {
        assert_runs(&scene(&model.solid()), &model, shift, 0.5);
    }

    /// A line within faces and along edges counts as moved a little to the side where
    /// coordinates grow, so it sees the cubes there.
    #[test]
    fn rays_within_faces_and_edges_see_the_cubes_beside_them(
        model in boxes(&[Kind::Cuboid, Kind::HalfSpaces, Kind::Mesh]),
        shift in 0..3_i32,
    ) {
        assert_runs(&scene(&model.solid()), &model, shift, 0.0);
    }

    /// Through lattice points along no axis: faces meet at corners and edges, and whatever
    /// is decided there, no more than the corners is in doubt.
    #[test]
    fn oblique_rays_through_lattice_points_agree_with_the_formula(
        model in boxes(&[Kind::Cuboid, Kind::HalfSpaces, Kind::Mesh]),
        from in integer_point(),
        dir in integer_point(),
    ) {
        prop_assume!(dir != [0; 3]);
        let ray = Ray::new(real(from), real(dir));
        let list = ends_in(&scene(&model.solid()), &ray);
        for k in -40..40 {
            // Coordinates along the ray are integers at multiples of 1/2 and 1/3 only.
            let t = (f64::from(k) + 0.137) / 12.0;
            if let Some(inside) = model.holds(ray.at(t)) {
                prop_assert_eq!(support::covers(&list, t), inside, "{} of {:?}", t, ray);
            }
        }
    }
}
