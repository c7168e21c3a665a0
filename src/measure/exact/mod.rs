//! Volumes by formulas, without a single ray.

mod apart;
mod star;

use glam::{DAffine3, DVec3};

use super::estimate::{Estimate, Method};
use crate::op::Op;
use crate::rounded::{Rounded, Sum};
use crate::scene::CompileOptions;
use crate::shape::{Chain, IndexedMesh, Shape, Slack, U};
use crate::solid::{Kind, Solid};
use apart::Boxed;

/// The volume of what formulas give: primitives and star-shaped meshes under affine maps, and
/// unions of such whose boxes overlap by no more than rounding. `None` of everything else: of
/// what has to be cut, of half-spaces, of meshes that may pass through themselves, and of
/// what [`Scene::compile`](crate::Scene::compile) refuses.
///
/// The interval is that of rounding, which is proven: sizes and maps are taken for exact
/// numbers.
///
/// ```
/// use solidray::{Solid, measure};
///
/// let ball = measure::exact(&Solid::ball(3.0)).expect("there is a formula");
/// assert!((ball.value - 36.0 * std::f64::consts::PI).abs() < 1e-12);
/// assert_eq!(ball.rays, 0);
/// ```
pub fn exact(solid: &Solid) -> Option<Estimate> {
    let leaves = leaves(solid)?;
    let mut sum = Sum::default();
    leaves.iter().for_each(|leaf| sum.add(leaf.volume));
    let total = sum.total();
    let [low, high] = total.interval();
    let low = (low - apart::overlap(&leaves, total.value)?).next_down();
    let interval = [low.max(0.0), high];
    (high.is_finite() && !low.is_nan()).then_some(Estimate {
        interval,
        method: Method::Exact,
        ..Estimate::exact(total.value)
    })
}

/// The leaves of which a solid is the union, with their volumes.
fn leaves(solid: &Solid) -> Option<Vec<Boxed>> {
    if solid.size() > CompileOptions::default().most_nodes {
        return None;
    }
    let mut leaves = Vec::new();
    let mut tasks = vec![(solid, Chain::NOTHING)];
    while let Some((solid, chain)) = tasks.pop() {
        let node = solid.node();
        match &node.kind {
            Kind::Primitive(shape) => {
                shape.check().ok()?;
                let placed = Shape::place(shape, &chain).ok()?;
                let volume = shape.describe().volume()? * determinant(&chain);
                leaves.push(Boxed::new(volume, &placed)?);
            }
            Kind::Mesh(mesh) if mesh.faces().is_empty() => {}
            Kind::Mesh(mesh) => {
                let volume = star::volume(mesh)? * determinant(&chain);
                let placed =
                    Shape::place_mesh(IndexedMesh::new(mesh.clone()).into(), &chain);
                leaves.push(Boxed::new(volume, &placed.ok()?)?);
            }
            Kind::Mapped(map) => {
                let chain = chain.then(map);
                tasks.extend(node.children.iter().map(|child| (child, chain)));
            }
            Kind::Boolean(Op::Intersection | Op::Difference)
                if node.children.len() > 1 =>
            {
                return None;
            }
            Kind::Tagged(_) | Kind::Boolean(_) => {
                tasks.extend(node.children.iter().map(|child| (child, chain)));
            }
        }
    }
    Some(leaves)
}

/// By how much a product of maps enlarges volumes.
///
/// If columns of a matrix are wrong by at most e, its determinant is by at most the product
/// of their lengths and e each, less the product of their lengths (expanded column by column,
/// each part is at most the product of lengths: Hadamard).
fn determinant(chain: &Chain) -> Rounded {
    let DAffine3 { matrix3: m, .. } = chain.map;
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.to_array());
    let term = |i: usize, j: usize, k: usize| {
        Rounded::exact(x[i]) * Rounded::exact(y[j]) * Rounded::exact(z[k])
    };
    let sum = term(0, 1, 2) - term(0, 2, 1)
        + (term(1, 2, 0) - term(1, 0, 2))
        + (term(2, 0, 1) - term(2, 1, 0));
    let lengths = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::length);
    let [a, b, c] = lengths;
    let e = chain.linear_error();
    // (a + e) (b + e) (c + e) − a b c, without the difference; with room for its rounding.
    let moved = e * (a * b + b * c + c * a + e * (a + b + c + e)) * (1.0 + 32.0 * U);
    Rounded { value: sum.value.abs(), error: sum.error + moved }
}

impl Boxed {
    /// A leaf and a box that it does not leave.
    fn new(volume: Rounded, placed: &crate::shape::Placed) -> Option<Self> {
        let Slack::Bounded(slack) = placed.slack else { return None };
        let room = 4.0 * slack + 64.0 * U * placed.reach;
        let bounds = placed.bounds.grown(room);
        bounds.is_bounded().then_some(Self { volume, bounds })
    }
}
