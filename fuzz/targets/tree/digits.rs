//! Boxes and quadrics under products of maps.

use glam::{DAffine3, DMat3, DQuat, DVec3, dvec3};
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use solidray::{Op, Ray};

use crate::bytes::{Parts, one_in_two, small, symmetry, three};
use crate::support::leaf::Leaf;
use crate::support::model::Model;
use crate::support::strategies::Aim;

/// A tree and rays at it.
pub(crate) fn case(bytes: &mut Unstructured) -> Result<(Model, Vec<Ray>)> {
    // First the rays, so that large trees leave bytes for them.
    let aims = (0..bytes.int_in_range(4..=12)?).map(|_| aim(bytes));
    let aims = aims.collect::<Result<Vec<_>>>()?;
    let model = Parts { leaf: placed_leaf, map }.tree(bytes)?;
    let rays = aims.iter().map(|aim| aim.ray(&model)).collect();
    Ok((model, rays))
}

/// Anything from `low` to `high`.
fn within(bytes: &mut Unstructured, low: f64, high: f64) -> Result<f64> {
    let part = f64::from(bytes.arbitrary::<u32>()?) / f64::from(u32::MAX);
    Ok(low + part * (high - low))
}

/// Half of a small integer, or anything of that size.
fn coordinate(bytes: &mut Unstructured) -> Result<f64> {
    if one_in_two(bytes)? { Ok(0.5 * small(bytes, 6)?) } else { within(bytes, -3.0, 3.0) }
}

fn length(bytes: &mut Unstructured) -> Result<f64> {
    if one_in_two(bytes)? {
        Ok(0.5 * f64::from(bytes.int_in_range(1..=6_u8)?))
    } else {
        within(bytes, 0.3, 3.0)
    }
}

fn place(bytes: &mut Unstructured) -> Result<DVec3> {
    three(bytes, coordinate)
}

/// Along an axis or a diagonal, or any.
fn direction(bytes: &mut Unstructured) -> Result<DVec3> {
    let dir = if one_in_two(bytes)? {
        three(bytes, |bytes| small(bytes, 1))?
    } else {
        three(bytes, |bytes| within(bytes, -1.0, 1.0))?
    };
    Ok(if dir.length() < 0.1 { DVec3::X } else { dir })
}

fn leaf(bytes: &mut Unstructured) -> Result<Leaf> {
    Ok(match bytes.int_in_range(0..=7)? {
        0 => {
            let min = place(bytes)?;
            Leaf::Cuboid { min, max: min + three(bytes, length)? }
        }
        1 => Leaf::Ball { radius: length(bytes)? },
        2 => Leaf::Cylinder { radius: length(bytes)?, height: length(bytes)? },
        3 => {
            let a = if one_in_two(bytes)? { 0.0 } else { length(bytes)? };
            let (b, height) = (length(bytes)?, length(bytes)?);
            let (bottom, top) = if one_in_two(bytes)? { (a, b) } else { (b, a) };
            Leaf::Frustum { bottom, top, height }
        }
        4 => Leaf::Paraboloid { radius: length(bytes)?, height: length(bytes)? },
        5 => {
            let (waist, more) = (length(bytes)?, within(bytes, 0.0, 2.0)?);
            Leaf::OneSheet { waist, radius: waist + more, height: length(bytes)? }
        }
        6 => {
            let sides = bytes.int_in_range(3..=8)?;
            let [a, b] = [length(bytes)?, length(bytes)?];
            let radii = *bytes.choose(&[[a, a], [a, b], [a, 0.0], [0.0, a]])?;
            Leaf::Prism { sides, radii, height: length(bytes)? }
        }
        _ => {
            let (vertex, slope) = (within(bytes, 0.2, 1.0)?, within(bytes, 0.3, 2.0)?);
            Leaf::TwoSheets { vertex, slope, height: 2.0 * (vertex + length(bytes)?) }
        }
    })
}

/// A leaf, cut by a half-space in one of eight cases, under a map in one of two.
fn placed_leaf(bytes: &mut Unstructured) -> Result<Model> {
    let mut model = Model::Leaf(leaf(bytes)?);
    if bytes.int_in_range(0..=7)? == 7 {
        let half =
            Leaf::HalfSpace { normal: direction(bytes)?, offset: coordinate(bytes)? };
        let op = *bytes.choose(&[Op::Difference, Op::Intersection])?;
        model = Model::boolean(op, [model, Model::Leaf(half)]);
    }
    Ok(if one_in_two(bytes)? { model } else { model.mapped(map(bytes)?) })
}

/// A product of up to three moves, turns, stretches and shears.
fn map(bytes: &mut Unstructured) -> Result<DAffine3> {
    let mut product = DAffine3::IDENTITY;
    for _ in 0..bytes.int_in_range(1..=3)? {
        product *= step(bytes)?;
    }
    Ok(product)
}

fn step(bytes: &mut Unstructured) -> Result<DAffine3> {
    let factor = |bytes: &mut Unstructured| {
        let factor = within(bytes, 0.5, 2.0)?;
        Ok(if one_in_two(bytes)? { factor } else { -factor })
    };
    Ok(match bytes.int_in_range(0..=4)? {
        0 => DAffine3::from_translation(place(bytes)?),
        1 => DAffine3::from_mat3(symmetry(bytes)?),
        2 => {
            let (axis, angle) = (direction(bytes)?, within(bytes, -3.0, 3.0)?);
            DAffine3::from_quat(DQuat::from_axis_angle(axis.normalize(), angle))
        }
        3 => DAffine3::from_scale(three(bytes, factor)?),
        _ => {
            let slope = |bytes: &mut Unstructured| within(bytes, -1.0, 1.0);
            let z = dvec3(slope(bytes)?, slope(bytes)?, 1.0);
            DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Y, z))
        }
    })
}

fn aim(bytes: &mut Unstructured) -> Result<Aim> {
    let feature = |bytes: &mut Unstructured| Ok(usize::from(bytes.arbitrary::<u8>()?));
    let axis = |bytes: &mut Unstructured| bytes.choose_index(3);
    Ok(match bytes.int_in_range(0..=7)? {
        0..=2 => Aim::Through(feature(bytes)?, feature(bytes)?),
        3 => Aim::Along(feature(bytes)?, axis(bytes)?),
        4 => Aim::Axis(feature(bytes)?, axis(bytes)?),
        5 => Aim::At(3.0 * place(bytes)?, feature(bytes)?),
        6 => Aim::Free(4.0 * place(bytes)?, direction(bytes)?),
        _ => {
            let from = 4.0 * place(bytes)?;
            Aim::Free(from, place(bytes)? - from)
        }
    })
}
