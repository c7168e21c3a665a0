//! Constructive solid geometry by rays.
//!
//! A solid is a tree of quadrics, boxes and closed meshes under affine maps, combined by
//! union, intersection and difference. No answer needs a mesh: the only geometric operation
//! is a ray, whose answer is the exact list of stretches inside the solid. Pictures,
//! volumes and membership are built on that.
//!
//! # Three stages
//!
//! A [`Solid`] is what you say: sizes, maps, operators. [`Scene::compile`] checks it and
//! makes it ready; after that no query can fail. A [`Tracer`] is the scratch memory of one
//! thread, and answers.
//!
//! ```
//! use glam::{DVec3, dvec3};
//! use solidray::{Ray, Scene, Solid, measure};
//!
//! // A plate with a countersunk hole.
//! let plate = Solid::cuboid_between(dvec3(-20.0, -10.0, 0.0), dvec3(20.0, 10.0, 5.0));
//! let hole = Solid::cylinder(3.0, 7.0).translated(dvec3(0.0, 0.0, -1.0));
//! let sink = Solid::frustum_between(3.0, 6.0, 2.0, 5.0);
//! let part = plate - (hole + sink);
//!
//! let scene = Scene::compile(&part)?;
//! assert!(scene.contains(dvec3(10.0, 0.0, 2.5)));
//! assert!(!scene.contains(dvec3(0.0, 0.0, 2.5)));
//!
//! // Along the middle of the plate, one millimetre above its bottom.
//! let ray = Ray::new(dvec3(-100.0, 0.0, 1.0), DVec3::X);
//! let spans: Vec<[f64; 2]> =
//!     scene.tracer().spans(&ray).iter().map(|s| [s.enter.t, s.exit.t]).collect();
//! assert_eq!(spans, [[80.0, 97.0], [103.0, 120.0]]);
//!
//! // 4000 less a cylinder of 2 π 9 and a frustum of 3 π (9 + 18 + 36) / 3.
//! let volume = measure::volume(&scene, &measure::Sampling::default());
//! let exact = 4000.0 - 81.0 * std::f64::consts::PI;
//! assert!((volume.value - exact).abs() < 2.0 * volume.half_width());
//! # Ok::<(), solidray::CompileError>(())
//! ```
//!
//! # What to ask
//!
//! | for | there is |
//! |---|---|
//! | a picture | [`render::picture()`], and [`render::trace`] for what is seen before any colour |
//! | a cut, or how thick something is | [`Solid::section`], [`render::thickness`] |
//! | one ray | [`Tracer::spans`], [`Tracer::first_hit`], [`Tracer::next_hit`] |
//! | points | [`Scene::contains`], [`Scene::contains_all`], [`Tracer::classify`] |
//! | a volume | [`measure::volume()`]; [`measure::adaptive`] for twelve digits, [`measure::bracket`] for certain bounds |
//! | surface, centroid, inertia, mass | [`measure::properties`] |
//! | whether two solids are one | [`measure::compare()`] |
//! | parts that collide | [`measure::overlaps`] |
//! | a mesh for printing | [`facets::surface()`], [`measure::apart`], [`write`](mod@write) |
//!
//! # Files
//!
//! [`read::file`] takes OpenSCAD's `.csg` and `.scad` and the mesh formats `.obj`, `.stl`,
//! `.off` and `.3mf`. [`facets::surface()`] and [`write`](mod@write)
//! make meshes for those who need some.
//!
//! # Numbers
//!
//! Coordinates are `f64`. Lengths are whatever unit the model uses, millimetres by
//! OpenSCAD's custom; angles are radians unless a name ends in `_deg`. The Boolean algebra
//! has no tolerance: crossings at the same `t` are toggled together, and a boundary is
//! reported only where the solid's inside changes. Surfaces that coincide but for rounding
//! are made one when a scene is compiled.
//!
//! [`Scene::error_at`] bounds the error of a crossing, with regard to the solid as it was
//! said. [`Tracer::uncertain`] counts spans that are thinner than that. [`Tracer::classify`]
//! tells points that are as near to the boundary from those inside and outside.
//! [`Tracer::next_hit`] starts a ray where another ended. How errors grow towards the
//! extremes, for six kinds of solids, is drawn by `cargo run --release --example stability`.
//!
//! # Features
//!
//! All are on by default. `parallel` uses all cores in [`measure`] and [`render`], with the
//! same results to the last bit; `image` shades pictures; `cli` is the program. Users of the
//! library alone take `default-features = false`.

// Tests of private parts share models and meshes with tests from outside.
#[cfg(test)]
extern crate self as solidray;

#[cfg(test)]
#[expect(dead_code, reason = "the tests from outside need more of it")]
#[path = "../tests/support/mod.rs"]
mod support;

mod aabb;
mod angle;
mod bvh;
mod census;
mod color;
mod eight;
pub mod facets;
mod fan;
mod lanes;
pub mod measure;
mod mesh;
mod op;
mod parts;
pub mod primitive;
mod progress;
mod ray;
pub mod read;
pub mod render;
mod rounded;
mod sampling;
mod scene;
mod section;
mod shape;
mod shown;
mod similar;
mod solid;
pub mod write;

pub use aabb::Aabb;
pub use census::Census;
pub use color::Color;
pub use mesh::{Mesh, MeshError, OpenEdge};
pub use op::Op;
pub use parts::Part;
pub use progress::{Progress, Watch, unwatched};
pub use ray::{Crossing, Ray, Sense, Span};
pub use scene::{
    CompileError, CompileOptions, Leaf, LeafName, Membership, NearMisses, Scene, Tracer,
    Weld,
};
pub use solid::{Place, Solid, View};
