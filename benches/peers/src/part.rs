//! A solid as peers take it: operators, and leaves with the map from their frames.

use glam::{DAffine3, DVec3};
use serde_json::{Value, json};
use solidray::primitive::{Cuboid, Primitive, Profile, Quadric};
use solidray::{Op, Solid, View};

/// A node of a tree without maps between the operators.
#[derive(Debug)]
pub enum Part {
    /// A leaf, and the map from its frame to the world.
    Leaf(Primitive, DAffine3),
    /// An operator and its operands.
    Boolean(Op, Vec<Part>),
}

impl Part {
    /// The tree of a solid, or none if it has meshes.
    pub fn of(solid: &Solid) -> Option<Self> {
        Self::under(solid, &DAffine3::IDENTITY)
    }

    fn under(solid: &Solid, map: &DAffine3) -> Option<Self> {
        match solid.view() {
            View::Primitive(primitive) => Some(Self::Leaf(*primitive, *map)),
            View::Boolean(_, [only]) => Self::under(only, map),
            View::Boolean(op, operands) => {
                let parts = operands.iter().map(|part| Self::under(part, map));
                Some(Self::Boolean(op, parts.collect::<Option<_>>()?))
            }
            View::Mapped(inner, child) => Self::under(child, &(*map * *inner)),
            View::Tagged(child) => Self::under(child, map),
            _ => None,
        }
    }

    /// The tree as the program in `children/manifold.py` reads it.
    pub fn to_json(&self) -> Value {
        let (primitive, map) = match self {
            Self::Leaf(primitive, map) => (primitive, map),
            Self::Boolean(op, parts) => {
                let op = match op {
                    Op::Union => "union",
                    Op::Intersection => "intersection",
                    Op::Difference => "difference",
                };
                let parts: Vec<Value> = parts.iter().map(Self::to_json).collect();
                return json!({ "op": op, "parts": parts });
            }
        };
        let rows = map.matrix3.transpose();
        let row = |i: usize| {
            let DVec3 { x, y, z } = rows.col(i);
            [x, y, z, map.translation[i]]
        };
        let map = [row(0), row(1), row(2)];
        match *primitive {
            Primitive::Cuboid(Cuboid { min, max }) => {
                json!({ "leaf": "cuboid", "min": min.to_array(), "max": max.to_array(), "map": map })
            }
            Primitive::Quadric(Quadric { profile: Profile::Ball { radius }, .. }) => {
                json!({ "leaf": "ball", "radius": radius, "map": map })
            }
            Primitive::Quadric(Quadric { profile, bottom, top }) => {
                let [low, high] = [bottom, top].map(|z| radius_at(&profile, z));
                json!({ "leaf": "frustum", "radii": [low, high], "heights": [bottom, top],
                        "map": map })
            }
            Primitive::HalfSpace(_) | _ => json!({ "leaf": primitive.name() }),
        }
    }
}

/// The radius of a cylinder or cone at a height.
///
/// # Panics
///
/// If it is something else: no scene has one.
pub fn radius_at(profile: &Profile, z: f64) -> f64 {
    match profile {
        Profile::Cylinder { radius } => *radius,
        Profile::Cone { radius, slope } => radius + slope * z,
        _ => panic!("the peers are not told of {profile:?}"),
    }
}
