//! Curves as polyhedra.

use std::collections::HashMap;
use std::sync::Arc;

use super::{FacetsError, of};
use crate::mesh::{Mesh, round};
use crate::primitive::{Facets, Primitive};
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
    meshes: HashMap<Vec<u64>, Arc<Mesh>>,
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
        let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect();
        // Keys of different kinds differ in length: 1, 4, and more.
        let (count, curves, key, make): (_, _, Vec<u64>, Box<dyn FnOnce() -> _>) =
            match of(primitive)? {
                Facets::Ball { radius } => (
                    round::ball_triangles(segments),
                    1,
                    bits(&[radius]),
                    Box::new(move || round::ball(segments, radius)),
                ),
                Facets::Frustum { radii: [a, b], ends: [c, d] } => (
                    round::frustum_triangles(segments),
                    1,
                    bits(&[a, b, c, d]),
                    Box::new(move || round::frustum(segments, [a, b], [c, d])),
                ),
                Facets::Polyhedron { points, faces } => {
                    let coordinates = points.iter().flat_map(|p| p.to_array());
                    let mut key: Vec<u64> = coordinates.map(f64::to_bits).collect();
                    key.extend(faces.iter().flatten().map(|&i| u64::from(i)));
                    let count = faces.len() as u64;
                    (count, 0, key, Box::new(move || Mesh::new(points, faces)))
                }
                Facets::HalfSpace { .. } | Facets::Unknown => {
                    return Err(FacetsError::NoFacets(primitive.name()));
                }
            };
        self.allow(count)?;
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
