//! Curves as polyhedra.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use super::FacetsError;
use crate::aabb::Aabb;
use crate::mesh::{Mesh, round};
use crate::shape::{Primitive, Profile};
use crate::solid::{Kind, Solid};

/// A solid whose leaves are meshes.
#[derive(Clone, Debug)]
pub struct Faceted {
    /// The solid, with the names, colours and places that it had.
    pub solid: Solid,
    /// How many leaves with curves were replaced.
    pub curves: u64,
    /// How many triangles its leaves have together.
    pub triangles: u64,
}

/// A solid with the polyhedra in place of balls, cylinders and cones that OpenSCAD 2021.01
/// makes of them with `$fn = segments`, and meshes in place of boxes. Their vertices lie on the
/// curves, so polyhedra are smaller than what they stand for.
///
/// Equal leaves share one mesh, and what occurs more than once in the tree still does; but
/// `most_triangles` counts each time that it occurs.
///
/// # Errors
///
/// If a leaf is none that OpenSCAD has (a half-space, say), its sizes are out of range, or there
/// would be too many triangles.
pub fn faceted(
    solid: &Solid,
    segments: u32,
    most_triangles: u64,
) -> Result<Faceted, FacetsError> {
    if segments < 3 {
        return Err(FacetsError::TooFewSegments(segments));
    }
    let mut replace = Replace { segments, most_triangles, meshes: HashMap::new() };
    let mut done: HashMap<usize, Faceted> = HashMap::new();
    let mut open = vec![(solid, false)];
    while let Some((solid, seen)) = open.pop() {
        if done.contains_key(&solid.address()) {
            continue;
        }
        if !seen {
            open.push((solid, true));
            open.extend(solid.children().iter().map(|child| (child, false)));
            continue;
        }
        let children: Vec<&Faceted> =
            solid.children().iter().map(|child| &done[&child.address()]).collect();
        let found = replace.node(solid, &children)?;
        done.insert(solid.address(), found);
    }
    done.remove(&solid.address()).ok_or(FacetsError::Stopped)
}

struct Replace {
    segments: u32,
    most_triangles: u64,
    /// The meshes made so far, by the bits of what they stand for.
    meshes: HashMap<[u64; 6], Arc<Mesh>>,
}

impl Replace {
    /// A node whose children are known.
    fn node(
        &mut self,
        solid: &Solid,
        below: &[&Faceted],
    ) -> Result<Faceted, FacetsError> {
        let sum = |of: fn(&Faceted) -> u64| {
            below.iter().fold(0_u64, |sum, child| sum.saturating_add(of(child)))
        };
        let (curves, triangles) = (sum(|f| f.curves), sum(|f| f.triangles));
        self.allow(triangles)?;
        if triangles == 0 && !below.is_empty() {
            return Ok(Faceted { solid: Solid::empty(), curves, triangles });
        }
        let children = || below.iter().map(|child| child.solid.clone());
        let only = || children().next().unwrap_or_else(Solid::empty);
        let solid = match solid.kind() {
            Kind::Primitive(primitive) => return self.primitive(primitive),
            Kind::Mesh(mesh) => {
                let triangles = mesh.faces().len() as u64;
                self.allow(triangles)?;
                return Ok(Faceted { solid: solid.clone(), curves: 0, triangles });
            }
            Kind::Boolean(op) => Solid::boolean(*op, children()),
            Kind::Mapped(map) => only().mapped(**map),
            Kind::Tagged(tag) => only().tagged(tag.clone()),
        };
        Ok(Faceted { solid, curves, triangles })
    }

    fn allow(&self, count: u64) -> Result<(), FacetsError> {
        let limit = self.most_triangles;
        if count > limit { Err(FacetsError::TooMany { count, limit }) } else { Ok(()) }
    }

    fn primitive(&mut self, primitive: &Primitive) -> Result<Faceted, FacetsError> {
        let segments = self.segments;
        let numbers = |kind: u64, n: [f64; 4]| {
            let [a, b, c, d] = n.map(f64::to_bits);
            [kind, a, b, c, d, 0]
        };
        let (key, curves, make): (_, _, Box<dyn Fn() -> Result<Mesh, _>>) =
            match *primitive {
                Primitive::Cuboid { min, max } => {
                    let mut key = [0; 6];
                    let corners = min.to_array().into_iter().chain(max.to_array());
                    key.iter_mut().zip(corners).for_each(|(k, x)| *k = x.to_bits());
                    (key, 0, Box::new(move || cuboid(min, max)))
                }
                Primitive::Quadric { profile: Profile::Ball { radius }, bottom, top }
                    if bottom <= -radius && top >= radius =>
                {
                    self.allow(round::ball_triangles(segments))?;
                    let key = numbers(u64::MAX, [radius, 0.0, 0.0, 0.0]);
                    (key, 1, Box::new(move || round::ball(segments, radius)))
                }
                Primitive::Quadric {
                    profile: profile @ (Profile::Cylinder { .. } | Profile::Cone { .. }),
                    bottom,
                    top,
                } => {
                    self.allow(round::frustum_triangles(segments))?;
                    let heights = [bottom, top];
                    let radii = heights.map(|z| radius_at(&profile, z));
                    let key = numbers(u64::MAX - 1, [radii[0], radii[1], bottom, top]);
                    (key, 1, Box::new(move || round::frustum(segments, radii, heights)))
                }
                Primitive::Quadric { .. } | Primitive::HalfSpace { .. } => {
                    return Err(FacetsError::NoFacets(primitive.name()));
                }
            };
        let mesh = match self.meshes.get(&key) {
            Some(mesh) => mesh.clone(),
            None => {
                let mesh = Arc::new(make()?);
                self.meshes.insert(key, mesh.clone());
                mesh
            }
        };
        let triangles = mesh.faces().len() as u64;
        Ok(Faceted { solid: Solid::mesh(mesh), curves, triangles })
    }
}

/// The radius of a cylinder or cone at a height.
pub(super) fn radius_at(profile: &Profile, z: f64) -> f64 {
    match *profile {
        Profile::Cylinder { radius } => radius,
        Profile::Cone { radius, slope } => (radius + slope * z).max(0.0),
        Profile::Ball { .. }
        | Profile::Paraboloid { .. }
        | Profile::OneSheet { .. }
        | Profile::TwoSheets { .. } => f64::NAN,
    }
}

/// The twelve triangles of a box.
pub(super) fn cuboid(min: DVec3, max: DVec3) -> Result<Mesh, crate::MeshError> {
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
    Mesh::new(Aabb::new(min, max).corners().to_vec(), faces.to_vec())
}
