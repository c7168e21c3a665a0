//! A solid as a union of meshes in its own frame, curves as fine polyhedra.

use std::f64::consts::PI;

use glam::{DAffine3, DMat3, DVec3};

use super::in_phase;
use super::longest::longest;
use super::{Faceted, FacetsError, boundary, of};
use crate::aabb::Aabb;
use crate::mesh::{Mesh, MeshError, round};
use crate::op::Op;
use crate::primitive::{Cuboid, Describe, Facets};
use crate::progress::unwatched;
use crate::solid::{Kind, Solid};

/// What polyhedra stand for curves.
pub(crate) struct Fine<'a> {
    /// How many segments a circle gets by the largest radius that its map makes of it.
    pub(crate) circle: &'a dyn Fn(f64) -> u32,
    /// The same of a ball's equator.
    pub(crate) ball: &'a dyn Fn(f64) -> u32,
    /// How many triangles there may be in all.
    pub(crate) most_triangles: u64,
}

/// Meshes whose union is a solid. What is subtracted or intersected becomes one mesh; what is only
/// united is left as it is.
///
/// # Errors
///
/// If there would be too many triangles, or Manifold does not take a mesh.
pub(crate) fn parts(solid: &Solid, fine: &Fine<'_>) -> Result<Vec<Mesh>, FacetsError> {
    let mut making = Making { fine, triangles: 0, reach: reach(solid) };
    let mut parts = Vec::new();
    let mut open = vec![(solid, DAffine3::IDENTITY)];
    while let Some((solid, map)) = open.pop() {
        let children = solid.children();
        match solid.kind() {
            Kind::Mapped(own) => {
                open.extend(children.iter().map(|child| (child, map * **own)));
            }
            Kind::Tagged(_) | Kind::Boolean(Op::Union) => {
                open.extend(children.iter().rev().map(|child| (child, map)));
            }
            Kind::Boolean(_) if children.len() == 1 => {
                open.extend(children.iter().map(|child| (child, map)));
            }
            Kind::Boolean(_) => {
                let solid = making.tree(solid, map)?;
                let faceted = Faceted { solid, curves: 0, triangles: making.triangles };
                parts.extend(boundary(&faceted, &unwatched)?);
            }
            Kind::Primitive(_) | Kind::Mesh(_) => {
                parts.extend(making.leaf(solid, &map)?);
            }
        }
    }
    Ok(parts)
}

/// A solid whose leaves are meshes in its own frame, so that nothing in it is mapped or tagged.
///
/// # Errors
///
/// If there would be too many triangles.
pub(crate) fn of_meshes(solid: &Solid, fine: &Fine<'_>) -> Result<Solid, FacetsError> {
    let mut making = Making { fine, triangles: 0, reach: reach(solid) };
    making.tree(solid, DAffine3::IDENTITY)
}

/// Makes meshes of leaves.
struct Making<'a> {
    fine: &'a Fine<'a>,
    /// How many triangles were made so far.
    triangles: u64,
    /// How far from the origin anything reaches that has bounds.
    reach: f64,
}

impl Making<'_> {
    /// A subtree with meshes in the frame of the whole as leaves, none of them mapped.
    fn tree(&mut self, solid: &Solid, map: DAffine3) -> Result<Solid, FacetsError> {
        let mut values: Vec<Solid> = Vec::new();
        let mut open = vec![(solid, map, false)];
        while let Some((solid, map, seen)) = open.pop() {
            let children = solid.children();
            match solid.kind() {
                Kind::Mapped(own) => {
                    open.extend(children.iter().map(|c| (c, map * **own, false)));
                }
                Kind::Tagged(_) => {
                    open.extend(children.iter().map(|c| (c, map, false)));
                }
                Kind::Boolean(op) if seen => {
                    let operands = values.split_off(values.len() - children.len());
                    values.push(Solid::boolean(*op, operands));
                }
                Kind::Boolean(_) => {
                    open.push((solid, map, true));
                    open.extend(children.iter().rev().map(|c| (c, map, false)));
                }
                Kind::Primitive(_) | Kind::Mesh(_) => {
                    let mesh = self.leaf(solid, &map)?;
                    values.push(mesh.map_or_else(Solid::empty, Solid::mesh));
                }
            }
        }
        Ok(values.pop().unwrap_or_else(Solid::empty))
    }

    fn count(&mut self, more: u64) -> Result<(), FacetsError> {
        self.triangles = self.triangles.saturating_add(more);
        let (count, limit) = (self.triangles, self.fine.most_triangles);
        if count > limit { Err(FacetsError::TooMany { count, limit }) } else { Ok(()) }
    }

    /// A leaf under a map.
    fn leaf(
        &mut self,
        solid: &Solid,
        map: &DAffine3,
    ) -> Result<Option<Mesh>, FacetsError> {
        let mesh = match solid.kind() {
            Kind::Mesh(mesh) => {
                self.count(mesh.faces().len() as u64)?;
                moved(mesh.points().to_vec(), mesh.faces().to_vec(), map)?
            }
            Kind::Primitive(primitive) => match of(primitive)? {
                Facets::Polyhedron { points, faces } => {
                    self.count(faces.len() as u64)?;
                    moved(points, faces, map)?
                }
                Facets::Ball { radius } => {
                    let segments = (self.fine.ball)(radius * longest(&map.matrix3));
                    self.count(round::ball_triangles(segments))?;
                    mapped(&ball(segments, radius)?, &in_phase::ball(map))?
                }
                Facets::Frustum { radii, ends } => {
                    // Nothing moves along the axis, so it does not matter how that is stretched.
                    let flat =
                        map.matrix3 * DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0));
                    let segments =
                        (self.fine.circle)(radii[0].max(radii[1]) * longest(&flat));
                    self.count(round::frustum_triangles(segments))?;
                    let radii = radii.map(|r| r * with_area(segments));
                    let map = in_phase::circle(map, segments);
                    mapped(&round::frustum(segments, radii, ends)?, &map)?
                }
                Facets::HalfSpace { normal, offset } => {
                    self.count(12)?;
                    return self.half_space(normal, offset, map);
                }
                Facets::Unknown => return Err(FacetsError::NoFacets(primitive.name())),
            },
            Kind::Boolean(_) | Kind::Mapped(_) | Kind::Tagged(_) => return Ok(None),
        };
        Ok(Some(mesh))
    }

    /// As much of a half-space as there is of anything else, and more; of one beyond everything a
    /// box that is there as well.
    fn half_space(
        &self,
        normal: DVec3,
        offset: f64,
        map: &DAffine3,
    ) -> Result<Option<Mesh>, FacetsError> {
        let inverse = map.matrix3.inverse();
        let across = inverse.transpose() * normal;
        let offset = (offset + across.dot(map.translation)) / across.length();
        let far = 4.0 * self.reach;
        if offset.is_nan() {
            return Ok(None);
        }
        // One that reaches nothing is left as far away: a union with it has no bounds.
        let top = offset.clamp(-1.5 * far, far);
        let z = across.normalize_or(DVec3::Z);
        let (x, y) = z.any_orthonormal_pair();
        let frame = DAffine3::from_mat3(DMat3::from_cols(x, y, z));
        let corner = DVec3::new(far, far, top);
        let cuboid = Cuboid { min: -DVec3::splat(2.0 * far), max: corner };
        let Facets::Polyhedron { points, faces } = cuboid.facets() else {
            return Ok(None);
        };
        Ok(Some(moved(points, faces, &frame)?))
    }
}

/// By what the radius of a polygon is larger than that of a circle of the same area.
pub(super) fn with_area(segments: u32) -> f64 {
    let half = PI / f64::from(segments);
    (half / (half.sin() * half.cos())).sqrt()
}

/// A polyhedron with the volume of a ball.
pub(super) fn ball(segments: u32, radius: f64) -> Result<Mesh, MeshError> {
    let mesh = round::ball(segments, radius)?;
    let scale = (4.0 / 3.0 * PI * radius.powi(3) / mesh.volume()).cbrt();
    let points = mesh.points().iter().map(|&p| scale * p).collect();
    Mesh::new(points, mesh.faces().to_vec())
}

fn mapped(mesh: &Mesh, map: &DAffine3) -> Result<Mesh, MeshError> {
    moved(mesh.points().to_vec(), mesh.faces().to_vec(), map)
}

/// A mesh of points under a map, whose faces look outwards.
fn moved(
    mut points: Vec<DVec3>,
    mut faces: Vec<[u32; 3]>,
    map: &DAffine3,
) -> Result<Mesh, MeshError> {
    points.iter_mut().for_each(|p| *p = map.transform_point3(*p));
    if map.matrix3.determinant() < 0.0 {
        faces.iter_mut().for_each(|[a, b, _]| std::mem::swap(a, b));
    }
    Mesh::new(points, faces)
}

/// How far from the origin the leaves of a solid reach that have bounds.
pub(super) fn reach(solid: &Solid) -> f64 {
    let mut reach: f64 = 0.0;
    let mut open = vec![(solid, DAffine3::IDENTITY)];
    while let Some((solid, map)) = open.pop() {
        let children = solid.children();
        let (below, around) = match solid.kind() {
            Kind::Mapped(own) => (map * **own, None),
            Kind::Tagged(_) | Kind::Boolean(_) => (map, None),
            Kind::Mesh(mesh) => (map, Some(mesh.bounds())),
            Kind::Primitive(primitive) if primitive.check().is_err() => (map, None),
            Kind::Primitive(primitive) => {
                let around = primitive.describe().extent().mapped(&DAffine3::IDENTITY);
                (map, Some(around).filter(Aabb::is_bounded))
            }
        };
        open.extend(children.iter().map(|child| (child, below)));
        if let Some(around) = around {
            let corners = around.corners().map(|p| below.transform_point3(p).length());
            reach = corners.into_iter().fold(reach, f64::max);
        }
    }
    reach
}

/// The bounds of a solid that is a union, with curves as they are; `None` if something is
/// subtracted or intersected.
pub(crate) fn bounds_of_union(solid: &Solid) -> Option<Aabb> {
    let mut around = Aabb::EMPTY;
    let mut open = vec![(solid, DAffine3::IDENTITY)];
    while let Some((solid, map)) = open.pop() {
        let children = solid.children();
        let found = match solid.kind() {
            Kind::Mapped(own) => {
                open.extend(children.iter().map(|child| (child, map * **own)));
                continue;
            }
            Kind::Boolean(op) if *op != Op::Union && children.len() > 1 => return None,
            Kind::Tagged(_) | Kind::Boolean(_) => {
                open.extend(children.iter().map(|child| (child, map)));
                continue;
            }
            Kind::Mesh(mesh) => {
                let used = mesh.faces().iter().flatten();
                let points = used.map(|&i| mesh.points()[i as usize]);
                Aabb::around(points.map(|p| map.transform_point3(p)))
            }
            Kind::Primitive(primitive) => {
                let primitive = primitive.describe();
                match primitive.facets() {
                    Facets::Ball { .. } | Facets::Frustum { .. } => {
                        primitive.extent().mapped(&map)
                    }
                    Facets::Polyhedron { points, .. } => {
                        Aabb::around(points.into_iter().map(|p| map.transform_point3(p)))
                    }
                    Facets::HalfSpace { .. } | Facets::Unknown => return None,
                }
            }
        };
        around = around.hull(found);
    }
    Some(around)
}
