//! Boxes, half-spaces and meshes with coordinates of −2, −1, 0, 1 or 2 quarters.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use solidray::{Mesh, Op, Ray};

use crate::bytes::{Parts, one_in_two, small, some, symmetry, three};
use crate::support::leaf::{Leaf, Shared};
use crate::support::meshes;
use crate::support::model::Model;

/// A bounded tree and rays at it.
pub(crate) fn case(bytes: &mut Unstructured) -> Result<(Model, Vec<Ray>)> {
    // Lists of trees without meshes are compared to the last bit and for every ray.
    let leaf = if one_in_two(bytes)? { convex } else { convex_or_mesh };
    let tree = Parts { leaf, map }.tree(bytes)?;
    let guard = Leaf::Cuboid { min: DVec3::splat(-16.0), max: DVec3::splat(16.0) };
    let model = Model::boolean(Op::Intersection, [tree, Model::Leaf(guard)]);
    let on_lattice = |p: &DVec3| (256.0 * p).fract() == DVec3::ZERO;
    let features = model.features().into_iter().map(|feature| feature.point);
    let features: Vec<DVec3> = features.filter(on_lattice).collect();
    let rays = some(bytes, 24, |bytes| ray(bytes, &features))?;
    Ok((model, rays))
}

fn point(bytes: &mut Unstructured) -> Result<DVec3> {
    Ok(0.25 * three(bytes, |bytes| small(bytes, 2))?)
}

/// The smallest and the largest corner of a box.
fn corners(bytes: &mut Unstructured) -> Result<[DVec3; 2]> {
    let (a, b) = (point(bytes)?, point(bytes)?);
    let (min, max) = (a.min(b), a.max(b));
    // Where the two agree, the box is a quarter thick.
    let thin = DVec3::select(min.cmpeq(max), DVec3::splat(0.25), DVec3::ZERO);
    Ok([min, max + thin])
}

/// A box or a half-space.
fn convex(bytes: &mut Unstructured) -> Result<Model> {
    if bytes.int_in_range(0..=2)? < 2 {
        let [min, max] = corners(bytes)?;
        return Ok(Model::Leaf(Leaf::Cuboid { min, max }));
    }
    let (normal, offset) = (4.0 * point(bytes)?, 0.25 * small(bytes, 2)?);
    let normal = if normal == DVec3::ZERO { DVec3::Y } else { normal };
    Ok(Model::Leaf(Leaf::HalfSpace { normal, offset }))
}

fn convex_or_mesh(bytes: &mut Unstructured) -> Result<Model> {
    Ok(match bytes.int_in_range(0..=3)? {
        0 | 1 => return convex(bytes),
        2 => {
            let ([min, max], steps) = (corners(bytes)?, bytes.int_in_range(1..=2)?);
            Model::Leaf(Leaf::Mesh(Shared(Arc::new(meshes::grid_box(min, max, steps)))))
        }
        _ => {
            let corners = [point(bytes)?, point(bytes)?, point(bytes)?, point(bytes)?];
            Model::Leaf(tetrahedron(corners))
        }
    })
}

/// A tetrahedron, or a small box if the four points are in one plane.
fn tetrahedron([a, b, c, d]: [DVec3; 4]) -> Leaf {
    let volume = (b - a).dot((c - a).cross(d - a));
    if volume == 0.0 {
        return Leaf::Cuboid { min: a.min(b), max: a.min(b) + 0.25 };
    }
    let (c, d) = if volume > 0.0 { (c, d) } else { (d, c) };
    let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let mesh = Mesh::new(vec![a, b, c, d], faces).expect("a tetrahedron is closed");
    Leaf::Mesh(Shared(Arc::new(mesh)))
}

/// A map that rounds nothing.
fn map(bytes: &mut Unstructured) -> Result<DAffine3> {
    let factor = *bytes.choose(&[1.0, 0.5, 2.0])?;
    Ok(DAffine3::from_mat3_translation(symmetry(bytes)? * factor, point(bytes)?))
}

/// Through two features, from one along an axis or a lattice direction, or through any points
/// of the lattice.
fn ray(bytes: &mut Unstructured, features: &[DVec3]) -> Result<Ray> {
    let kind = bytes.int_in_range(0..=4)?;
    let (from, axis) = (*bytes.choose(features)?, *bytes.choose(&DVec3::AXES)?);
    let (from, dir) = match kind {
        0 | 1 => (from, bytes.choose(features)? - from),
        2 => (from, axis * bytes.choose(&[1.0, -0.5])?),
        3 => (from, three(bytes, |bytes| small(bytes, 2))?),
        _ => {
            let from = 0.125 * three(bytes, |bytes| small(bytes, 4))?;
            (from, three(bytes, |bytes| small(bytes, 4))?)
        }
    };
    let dir = if dir == DVec3::ZERO { axis } else { dir };
    Ok(Ray::new(from + small(bytes, 3)? * dir, dir))
}
