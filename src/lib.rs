//! Constructive solid geometry by rays.

mod aabb;
mod bvh;
mod color;
pub mod measure;
mod mesh;
mod op;
mod ray;
pub mod read;
mod sampling;
mod scene;
pub mod shape;
mod solid;

pub use aabb::Aabb;
pub use color::Color;
pub use mesh::{Mesh, MeshError, OpenEdge};
pub use op::Op;
pub use ray::{Crossing, Ray, Sense, Span};
pub use scene::{CompileError, Leaf, LeafName, Part, Scene, Tracer};
pub use solid::{Place, Solid};
