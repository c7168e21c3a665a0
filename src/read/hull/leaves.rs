//! What a hull is taken of.

use glam::{DAffine3, DVec3};

use super::balls::Ball;
use crate::facets::{self, FacetsError, Fine};
use crate::op::Op;
use crate::primitive::Facets;
use crate::similar;
use crate::solid::{Kind, Solid};

/// A part of a union.
#[derive(Clone, Debug)]
pub(super) enum Leaf {
    Ball(Ball),
    /// About the z-axis of its own frame, under a map.
    Cylinder {
        radius: f64,
        ends: [f64; 2],
        map: DAffine3,
    },
    /// The corners of a polyhedron.
    Points(Vec<DVec3>),
}

/// The parts of a union of balls, cylinders and polyhedra; `None` if there are others, or no
/// curves.
///
/// # Errors
///
/// If polyhedra cannot be cut.
pub(super) fn leaves(
    solid: &Solid,
    fine: &Fine<'_>,
) -> Result<Option<Vec<Leaf>>, FacetsError> {
    let mut found = Vec::new();
    let mut has_curves = false;
    let mut open = vec![(solid, DAffine3::IDENTITY)];
    while let Some((solid, map)) = open.pop() {
        let children = solid.children();
        match solid.kind() {
            Kind::Mapped(own) => {
                open.extend(children.iter().map(|child| (child, map * **own)));
            }
            Kind::Boolean(op) if *op != Op::Union && children.len() > 1 => {
                if !is_polyhedral(solid) {
                    return Ok(None);
                }
                let parts = facets::parts(solid, fine)?;
                let corners = parts.iter().flat_map(|mesh| mesh.points());
                found.push(points(corners.copied(), &map));
            }
            Kind::Boolean(_) | Kind::Tagged(_) => {
                open.extend(children.iter().map(|child| (child, map)));
            }
            Kind::Mesh(mesh) => found.push(points(mesh.points().iter().copied(), &map)),
            Kind::Primitive(primitive) => {
                let Some(leaf) = leaf(primitive.describe().facets(), map) else {
                    return Ok(None);
                };
                has_curves |= !matches!(leaf, Leaf::Points(_));
                found.push(leaf);
            }
        }
    }
    Ok(has_curves.then_some(found))
}

fn points(points: impl Iterator<Item = DVec3>, map: &DAffine3) -> Leaf {
    Leaf::Points(points.map(|p| map.transform_point3(p)).collect())
}

/// A whole ball, a cylinder or the corners of a polyhedron.
fn leaf(facets: Facets, map: DAffine3) -> Option<Leaf> {
    match facets {
        Facets::Ball { radius } => {
            let radius = radius * similar::scale(&map.matrix3)?;
            Some(Leaf::Ball(Ball { center: map.translation, radius }))
        }
        #[expect(clippy::float_cmp, reason = "a cone is none, however steep")]
        Facets::Frustum { radii: [radius, top], ends } if radius == top => {
            Some(Leaf::Cylinder { radius, ends, map })
        }
        Facets::Polyhedron { points: corners, .. } => {
            Some(points(corners.into_iter(), &map))
        }
        Facets::Frustum { .. } | Facets::HalfSpace { .. } | Facets::Unknown => None,
    }
}

/// Whether a solid is made of polyhedra and meshes.
fn is_polyhedral(solid: &Solid) -> bool {
    let mut open = vec![solid];
    while let Some(solid) = open.pop() {
        let is_polyhedron = match solid.kind() {
            Kind::Primitive(primitive) => {
                matches!(primitive.describe().facets(), Facets::Polyhedron { .. })
            }
            Kind::Mesh(_) | Kind::Boolean(_) | Kind::Mapped(_) | Kind::Tagged(_) => true,
        };
        if !is_polyhedron {
            return false;
        }
        open.extend(solid.children());
    }
    true
}
