//! What random tests are made of: places, maps, leaves, trees and rays.

use glam::{DAffine3, DMat3, DQuat, DVec3, dvec3};
use proptest::collection::vec;
use proptest::prelude::*;
use solidray::{Op, Ray};

use super::leaf::{self, Leaf};
use super::model::Model;

/// A coordinate: half of a small integer, or anything of that size.
pub(crate) fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![(-6..=6_i32).prop_map(|i| 0.5 * f64::from(i)), -3.0..3.0_f64]
}

/// A point with such coordinates.
pub(crate) fn place() -> impl Strategy<Value = DVec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from_array)
}

/// A length: half of a small integer, or anything of that size.
pub(crate) fn length() -> impl Strategy<Value = f64> {
    prop_oneof![(1..=6_i32).prop_map(|i| 0.5 * f64::from(i)), 0.3..3.0_f64]
}

/// A direction: along an axis or a diagonal, or any.
pub(crate) fn direction() -> impl Strategy<Value = DVec3> {
    let small = || (-1..=1_i32).prop_map(f64::from);
    let real = || -1.0..1.0_f64;
    prop_oneof![
        [small(), small(), small()].prop_map(DVec3::from_array),
        [real(), real(), real()].prop_map(DVec3::from_array),
    ]
    .prop_map(|d| if d.length() < 0.1 { DVec3::X } else { d })
}

/// One of the 48 maps of the cube onto itself, exact in every bit.
pub(crate) fn symmetry() -> impl Strategy<Value = DMat3> {
    (0..6_usize, any::<[bool; 3]>()).prop_map(|(order, mirrored)| {
        let axes = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        let column = |i: usize| {
            let sign = if mirrored[i] { -1.0 } else { 1.0 };
            DVec3::AXES[axes[order][i]] * sign
        };
        DMat3::from_cols(column(0), column(1), column(2))
    })
}

/// A well-conditioned affine map: a few moves, turns, stretches, mirrors and shears.
pub(crate) fn map() -> impl Strategy<Value = DAffine3> {
    let factor =
        || (0.5..2.0_f64, any::<bool>()).prop_map(|(f, m)| if m { -f } else { f });
    let step = prop_oneof![
        place().prop_map(DAffine3::from_translation),
        symmetry().prop_map(DAffine3::from_mat3),
        (direction(), -3.0..3.0_f64).prop_map(|(axis, angle)| {
            DAffine3::from_quat(DQuat::from_axis_angle(axis.normalize(), angle))
        }),
        [factor(), factor(), factor()]
            .prop_map(|f| DAffine3::from_scale(DVec3::from_array(f))),
        (-1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y)| {
            DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Y, dvec3(x, y, 1.0)))
        }),
    ];
    vec(step, 1..=3).prop_map(|steps| {
        steps.into_iter().fold(DAffine3::IDENTITY, |product, step| product * step)
    })
}

/// A bounded leaf under a map, or cut by a half-space.
pub(crate) fn placed_leaf() -> impl Strategy<Value = Model> {
    let cut = (direction(), coordinate(), any::<bool>());
    (leaf::bounded(), prop::option::of(map()), prop::option::weighted(0.2, cut)).prop_map(
        |(leaf, map, cut)| {
            let mut model = Model::Leaf(leaf);
            if let Some((normal, offset, subtracted)) = cut {
                let half = Model::Leaf(Leaf::HalfSpace { normal, offset });
                let op = if subtracted { Op::Difference } else { Op::Intersection };
                model = Model::boolean(op, [model, half]);
            }
            match map {
                Some(map) => model.mapped(map),
                None => model,
            }
        },
    )
}

/// One of the operators.
pub(crate) fn op() -> impl Strategy<Value = Op> {
    prop::sample::select(vec![Op::Union, Op::Intersection, Op::Difference])
}

/// A tree of a few placed leaves, maps and operators of up to four operands.
pub(crate) fn model() -> impl Strategy<Value = Model> {
    placed_leaf().prop_recursive(3, 10, 3, |inner| {
        prop_oneof![
            4 => (op(), vec(inner.clone(), 1..=4))
                .prop_map(|(op, children)| Model::Boolean(op, children)),
            1 => (map(), inner).prop_map(|(map, child)| child.mapped(map)),
        ]
    })
}

/// How to make a ray for a model.
#[derive(Clone, Debug)]
pub(crate) enum Aim {
    /// Any line.
    Free(DVec3, DVec3),
    /// From somewhere to a feature.
    At(DVec3, usize),
    /// Through two features.
    Through(usize, usize),
    /// Through a feature along an axis of its leaf: within faces, along edges, tangent to
    /// balls, through apexes.
    Along(usize, usize),
    /// Through a feature along a coordinate axis.
    Axis(usize, usize),
}

/// A few ways to aim.
pub(crate) fn aims() -> impl Strategy<Value = Vec<Aim>> {
    let which = || 0..1000_usize;
    let aim = prop_oneof![
        (place(), direction()).prop_map(|(from, dir)| Aim::Free(4.0 * from, dir)),
        (place(), place()).prop_map(|(from, to)| Aim::Free(4.0 * from, to - 4.0 * from)),
        (place(), which()).prop_map(|(from, at)| Aim::At(3.0 * from, at)),
        (which(), which()).prop_map(|(a, b)| Aim::Through(a, b)),
        (which(), 0..3_usize).prop_map(|(at, axis)| Aim::Along(at, axis)),
        (which(), 0..3_usize).prop_map(|(at, axis)| Aim::Axis(at, axis)),
    ];
    vec(aim, 4..=8)
}

impl Aim {
    /// The ray.
    pub(crate) fn ray(&self, model: &Model) -> Ray {
        let features = model.features();
        let feature = |i: usize| features[i % features.len()];
        let ray = match *self {
            Self::Free(origin, dir) => Ray::new(origin, dir),
            Self::At(from, at) => Ray::new(from, feature(at).point - from),
            Self::Through(a, b) => {
                let (a, b) = (feature(a).point, feature(b).point);
                Ray::new(a, b - a)
            }
            Self::Along(at, axis) => {
                let at = feature(at);
                Ray::new(at.point - 4.0 * at.axes[axis], at.axes[axis])
            }
            Self::Axis(at, axis) => {
                Ray::new(feature(at).point - 8.0 * DVec3::AXES[axis], DVec3::AXES[axis])
            }
        };
        if ray.dir.length() < 1e-3 { Ray::new(ray.origin, DVec3::X) } else { ray }
    }
}
