//! Which function makes which node.

use super::super::error::Located;
use super::super::outline::Outline;
use super::arguments::Call;
use super::evaluate::Reading;
use super::{
    combine, convex, extrude, import, offset, outlines, polyhedron, project, resize,
    revolve, solids, surface, text, transform,
};
use crate::solid::Solid;

/// What a statement stands for.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// Nothing, of either dimension.
    Empty,
    /// A plane shape.
    Flat(Outline),
    /// A solid.
    Solid(Solid),
}

/// How a node becomes a shape, given the shapes in its braces.
type Make = fn(&Call<'_>, Vec<Shape>, &mut Reading<'_>) -> Result<Shape, Located>;

/// A kind of node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// The names of its arguments, in the order in which those without a name come.
    pub(super) parameters: &'static [&'static str],
    pub(super) make: Make,
}

/// The nodes that can be read, by name.
pub(super) fn node(name: &str) -> Option<Node> {
    let (make, parameters): (Make, &[&str]) = match name {
        "cube" => (solids::cube, &["size", "center"]),
        "sphere" => (solids::sphere, &["r", "d"]),
        "cylinder" => {
            (solids::cylinder, &["h", "r1", "r2", "center", "r", "d", "d1", "d2"])
        }
        "polyhedron" => {
            (polyhedron::polyhedron, &["points", "faces", "convexity", "triangles"])
        }
        "square" => (outlines::square, &["size", "center"]),
        "circle" => (outlines::circle, &["r", "d"]),
        "polygon" => (outlines::polygon, &["points", "paths", "convexity"]),
        "import" => (
            import::import,
            &[
                "file",
                "layer",
                "convexity",
                "origin",
                "scale",
                "id",
                "center",
                "dpi",
                "timestamp",
            ],
        ),
        "offset" => (offset::offset, &["r", "delta", "chamfer"]),
        "surface" => {
            (surface::surface, &["file", "center", "convexity", "invert", "timestamp"])
        }
        "text" => (text::text, text::PARAMETERS),
        "group" | "union" => (combine::union, &[]),
        "render" => (combine::union, &["convexity"]),
        "difference" => (combine::difference, &[]),
        "intersection" => (combine::intersection, &[]),
        "multmatrix" => (transform::multmatrix, &["m"]),
        "color" => (transform::color, &["c", "alpha"]),
        "rotate_extrude" => (revolve::rotate_extrude, revolve::PARAMETERS),
        "linear_extrude" => (extrude::linear_extrude, extrude::PARAMETERS),
        "hull" => (convex::hull, &[]),
        "minkowski" => (convex::minkowski, &["convexity"]),
        "projection" => (project::projection, &["cut", "convexity"]),
        "resize" => (resize::resize, &["newsize", "auto", "convexity"]),
        _ => return None,
    };
    Some(Node { parameters, make })
}
