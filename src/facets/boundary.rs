//! The surface of a solid of meshes.

use glam::{DAffine3, DVec3};
use manifold_rust::linalg::{Mat3x4, Vec3};
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{Error, MeshGLP, OpType};

use super::{Faceted, FacetsError};
use crate::mesh::Mesh;
use crate::op::Op;
use crate::progress::Watch;
use crate::solid::Kind;

/// The surface of a solid that is made of meshes, as one mesh; `None` of a solid that is empty.
/// Faces that were cut are triangulated anew. `watch` is told how many triangles went into each Boolean operation, before
/// it begins, and can stop the work there.
///
/// # Errors
///
/// If a mesh is not a manifold, or it was stopped.
pub fn boundary(
    faceted: &Faceted,
    watch: Watch<'_>,
) -> Result<Option<Mesh>, FacetsError> {
    // The operands of nodes that are not finished.
    let mut values: Vec<Manifold> = Vec::new();
    let mut open = vec![(&faceted.solid, false)];
    while let Some((solid, seen)) = open.pop() {
        let children = solid.children();
        if !seen && !children.is_empty() {
            open.push((solid, true));
            open.extend(children.iter().rev().map(|child| (child, false)));
            continue;
        }
        let operands = values.split_off(values.len() - children.len());
        values.push(match solid.kind() {
            Kind::Primitive(primitive) => {
                return Err(FacetsError::NoFacets(primitive.name()));
            }
            Kind::Mesh(mesh) => from_mesh(mesh)?,
            Kind::Boolean(op) => boolean(*op, operands, watch)?,
            Kind::Mapped(map) => {
                operands.first().map_or_else(Manifold::empty, |below| mapped(below, map))
            }
            Kind::Tagged(_) => {
                operands.into_iter().next().unwrap_or_else(Manifold::empty)
            }
        });
    }
    to_mesh(&checked(values.pop().unwrap_or_else(Manifold::empty))?)
}

fn boolean(
    op: Op,
    mut parts: Vec<Manifold>,
    watch: Watch<'_>,
) -> Result<Manifold, FacetsError> {
    match op {
        Op::Union => in_pairs(parts, OpType::Add, watch),
        Op::Intersection => in_pairs(parts, OpType::Intersect, watch),
        Op::Difference if parts.is_empty() => Ok(Manifold::empty()),
        Op::Difference => {
            let rest = parts.split_off(1);
            let rest = in_pairs(rest, OpType::Add, watch)?;
            pair(&parts[0], &rest, OpType::Subtract, watch)
        }
    }
}

/// Pairs of pairs: the cost of an operation grows with the size of its operands.
fn in_pairs(
    mut parts: Vec<Manifold>,
    op: OpType,
    watch: Watch<'_>,
) -> Result<Manifold, FacetsError> {
    while parts.len() > 1 {
        parts = parts
            .chunks(2)
            .map(|two| match two {
                [a, b] => pair(a, b, op, watch),
                one => Ok(one[0].clone()),
            })
            .collect::<Result<_, _>>()?;
    }
    Ok(parts.pop().unwrap_or_else(Manifold::empty))
}

fn pair(
    a: &Manifold,
    b: &Manifold,
    op: OpType,
    watch: Watch<'_>,
) -> Result<Manifold, FacetsError> {
    if watch((a.num_tri() + b.num_tri()) as u64).is_break() {
        return Err(FacetsError::Stopped);
    }
    checked(a.boolean(b, op))
}

fn mapped(solid: &Manifold, map: &DAffine3) -> Manifold {
    let column = |v: DVec3| Vec3::new(v.x, v.y, v.z);
    let m = map.matrix3;
    solid.transform(&Mat3x4::from_cols(
        column(m.x_axis),
        column(m.y_axis),
        column(m.z_axis),
        column(map.translation),
    ))
}

fn from_mesh(mesh: &Mesh) -> Result<Manifold, FacetsError> {
    let gl = MeshGLP::<f64, u32> {
        num_prop: 3,
        vert_properties: mesh.points().iter().flat_map(DVec3::to_array).collect(),
        tri_verts: mesh.faces().iter().flatten().copied().collect(),
        ..Default::default()
    };
    checked(Manifold::from_mesh_glp(&gl))
}

fn to_mesh(manifold: &Manifold) -> Result<Option<Mesh>, FacetsError> {
    if manifold.is_empty() {
        return Ok(None);
    }
    let gl: MeshGLP<f64, u32> = manifold.get_mesh_glp(-1);
    let points = gl.vert_properties.chunks_exact(gl.num_prop as usize);
    let points = points.map(|p| DVec3::new(p[0], p[1], p[2])).collect();
    let faces = gl.tri_verts.chunks_exact(3).map(|f| [f[0], f[1], f[2]]).collect();
    Ok(Some(Mesh::new(points, faces)?))
}

fn checked(manifold: Manifold) -> Result<Manifold, FacetsError> {
    let status = manifold.status();
    if status == Error::NoError {
        Ok(manifold)
    } else {
        Err(FacetsError::NotTaken(format!("{status:?}")))
    }
}
