//! A solid of boxes and meshes as Manifold sees it: the volume of its boundary.

use glam::{DAffine3, DVec3};
use manifold_rust::linalg::{Mat3x4, Vec3};
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{Error, MeshGLP, OpType};
use solidray::shape::Primitive;
use solidray::{Aabb, Mesh, Op, Solid, View};

/// The solid as a Manifold. The trees of tests are shallow, so this may recurse.
pub(crate) fn manifold(solid: &Solid) -> Manifold {
    match solid.view() {
        View::Primitive(Primitive::Cuboid { min, max }) => cuboid(*min, *max),
        View::Mesh(mesh) => from_mesh(mesh),
        View::Boolean(op, children) => {
            boolean(op, children.iter().map(manifold).collect())
        }
        View::Mapped(map, child) => mapped(&manifold(child), map),
        View::Tagged(child) => manifold(child),
        View::Primitive(_) | _ => panic!("{solid:?} has no facets"),
    }
}

fn boolean(op: Op, mut parts: Vec<Manifold>) -> Manifold {
    match op {
        Op::Union => union(parts),
        Op::Intersection => Manifold::batch_boolean(&parts, OpType::Intersect),
        Op::Difference if parts.is_empty() => Manifold::empty(),
        Op::Difference => {
            let rest = parts.split_off(1);
            parts[0].difference(&union(rest))
        }
    }
}

/// Pairs of pairs: the cost of a Boolean grows with the size of its operands.
fn union(mut parts: Vec<Manifold>) -> Manifold {
    while parts.len() > 1 {
        parts = parts
            .chunks(2)
            .map(|pair| if let [a, b] = pair { a.union(b) } else { pair[0].clone() })
            .collect();
    }
    parts.pop().unwrap_or_else(Manifold::empty)
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

fn from_mesh(mesh: &Mesh) -> Manifold {
    let gl = MeshGLP::<f64, u32> {
        num_prop: 3,
        vert_properties: mesh.points().iter().flat_map(DVec3::to_array).collect(),
        tri_verts: mesh.faces().iter().flatten().copied().collect(),
        ..Default::default()
    };
    let manifold = Manifold::from_mesh_glp(&gl);
    assert_eq!(manifold.status(), Error::NoError);
    manifold
}

fn cuboid(min: DVec3, max: DVec3) -> Manifold {
    let points = Aabb::new(min, max).corners().to_vec();
    let faces = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    from_mesh(&Mesh::new(points, faces.to_vec()).expect("a box is closed"))
}
