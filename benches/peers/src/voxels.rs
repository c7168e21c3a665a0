//! fidget: implicit functions, compiled at run time, drawn by voxels in single precision.

use anyhow::Result;
use fidget::context::Tree;
use fidget::eval::{BulkEvaluator, Function};
use fidget::jit::{JitFunction, JitShape};
use fidget::raster::voxel::{EvalConfig, Image, RenderConfig};
use fidget::render::VoxelSize;
use fidget::shape::{BoundShape, ShapeTape};
use glam::{DAffine3, DVec3};
use nalgebra::{Matrix4, Vector4};
use solidray::Op;
use solidray::primitive::{Cuboid, HalfSpace, Primitive, Profile, Quadric};
use solidray::render::View;

use crate::part::{Part, radius_at};

/// A scene as fidget takes it.
pub struct Voxels {
    shape: JitShape,
    /// The function for many points, compiled.
    tape: ShapeTape<JitFloatSliceTape>,
}

type JitFloatSliceTape =
    <<JitFunction as Function>::FloatSliceEval as BulkEvaluator>::Tape;

impl Voxels {
    /// Writes a tree as a function that is negative inside.
    pub fn new(part: &Part) -> Self {
        let axes = <[Tree; 3]>::from(Tree::axes());
        let shape = JitShape::from(function(part, &axes));
        let tape = shape.float_slice_tape(Default::default());
        Self { shape, tape }
    }

    /// Draws what a square view shows in a cube of voxels as wide as the view: depths and
    /// gradients.
    pub fn draw(&self, view: &View, center: DVec3, half: f64) -> Result<Image> {
        let [right, up, forward] = view.axes();
        let column = |v: DVec3, w: f32| {
            let [x, y, z] = v.as_vec3().to_array();
            Vector4::new(x, y, z, w)
        };
        let columns = [
            column(half * right, 0.0),
            column(half * up, 0.0),
            column(-half * forward, 0.0),
            column(center, 1.0),
        ];
        let image_size = VoxelSize::from(view.size()[0]);
        let camera =
            RenderConfig { image_size, world_to_model: Matrix4::from_columns(&columns) };
        let one_thread = EvalConfig { threads: None, ..EvalConfig::default() };
        let bound: BoundShape<'_, JitFunction, f32> = self.shape.clone().try_into()?;
        let image = fidget::raster::voxel::render(bound, &camera, &one_thread);
        image.ok_or_else(|| anyhow::anyhow!("fidget was not cancelled"))
    }

    /// How many points are inside, asked in pieces that stay in the cache.
    pub fn inside(&self, [x, y, z]: &[Vec<f32>; 3]) -> Result<usize> {
        const PIECE: usize = 2048;
        let mut evaluator = JitShape::new_float_slice_eval();
        let mut inside = 0;
        for ((x, y), z) in x.chunks(PIECE).zip(y.chunks(PIECE)).zip(z.chunks(PIECE)) {
            let values = evaluator.eval(&self.tape, x, y, z)?;
            inside += values.iter().filter(|&&value| value < 0.0).count();
        }
        Ok(inside)
    }
}

fn function(part: &Part, axes: &[Tree; 3]) -> Tree {
    match part {
        Part::Leaf(primitive, map) => leaf(primitive, map, axes),
        Part::Boolean(op, parts) => {
            let mut trees = parts.iter().map(|part| function(part, axes));
            match op {
                Op::Union => balanced(trees.collect(), Tree::min),
                Op::Intersection => balanced(trees.collect(), Tree::max),
                Op::Difference => {
                    let first = trees.next().unwrap_or_else(nothing);
                    let rest: Vec<Tree> = trees.collect();
                    if rest.is_empty() {
                        return first;
                    }
                    first.max(balanced(rest, Tree::min).neg())
                }
            }
        }
    }
}

fn nothing() -> Tree {
    Tree::constant(1.0)
}

/// Pairs of pairs, so that the function is wide and not deep.
fn balanced(mut trees: Vec<Tree>, of: fn(&Tree, Tree) -> Tree) -> Tree {
    while trees.len() > 1 {
        trees = trees
            .chunks(2)
            .map(|pair| match pair {
                [a, b] => of(a, b.clone()),
                _ => pair[0].clone(),
            })
            .collect();
    }
    trees.pop().unwrap_or_else(nothing)
}

fn leaf(primitive: &Primitive, map: &DAffine3, axes: &[Tree; 3]) -> Tree {
    let inverse = map.inverse();
    let rows = inverse.matrix3.transpose();
    let [x, y, z] = [0, 1, 2].map(|i| linear(rows.col(i), inverse.translation[i], axes));
    let between = |at: &Tree, low: f64, high: f64| {
        (constant(low) - at.clone()).max(at.clone() - constant(high))
    };
    match *primitive {
        Primitive::Cuboid(Cuboid { min, max }) => {
            let [x, y, z] = [(x, 0), (y, 1), (z, 2)]
                .map(|(at, axis)| between(&at, min[axis], max[axis]));
            x.max(y).max(z)
        }
        Primitive::Quadric(Quadric { profile: Profile::Ball { radius }, .. }) => {
            x.square() + y.square() + z.square() - constant(radius * radius)
        }
        Primitive::Quadric(Quadric { profile, bottom, top }) => {
            let squared = match profile {
                Profile::Cone { radius, slope } => {
                    (constant(radius) + constant(slope) * z.clone()).square()
                }
                _ => constant(radius_at(&profile, 0.0).powi(2)),
            };
            (x.square() + y.square() - squared).max(between(&z, bottom, top))
        }
        Primitive::HalfSpace(HalfSpace { normal, offset }) => {
            linear(normal, -offset, &[x, y, z])
        }
        _ => panic!("voxels are not told of {primitive:?}"),
    }
}

/// A sum of multiples of the axes and a number, without what is multiplied by zero or one.
fn linear(factors: DVec3, add: f64, axes: &[Tree; 3]) -> Tree {
    let mut sum: Option<Tree> = None;
    for (factor, axis) in factors.to_array().into_iter().zip(axes) {
        let term = match factor {
            0.0 => continue,
            1.0 => axis.clone(),
            -1.0 => axis.neg(),
            _ => axis.clone() * constant(factor),
        };
        sum = Some(sum.map_or_else(|| term.clone(), |sum| sum + term.clone()));
    }
    let sum = sum.unwrap_or_else(|| constant(0.0));
    if add == 0.0 { sum } else { sum + constant(add) }
}

fn constant(value: f64) -> Tree {
    Tree::constant(value as f32)
}
