//! From the tree that was said to the flat scene that is asked.

use std::collections::HashMap;
use std::sync::Arc;

use thiserror::Error;

use super::copies::Meshes;
use super::intern::Surfaces;
use super::options::CompileOptions;
use super::program::{Combine, Literal, Program};
use super::sheet::Extent;
use super::{Part, Scene};
use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::color::Color;
use crate::mesh::Mesh;
use crate::op::Op;
use crate::shape::{BadParameter, Chain, Placed, Primitive, Shape, Slack};
use crate::solid::{Kind, Place, Solid, Tag};

/// Why a solid cannot be compiled.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CompileError {
    /// A size is out of its range.
    #[error("{leaf}: the {parameter} is {value}, which is out of its range")]
    BadParameter {
        /// Which leaf.
        leaf: LeafName,
        /// Which size.
        parameter: &'static str,
        /// Its value.
        value: f64,
    },
    /// The map of a leaf cannot be inverted.
    #[error(
        "{leaf}: its map is singular or not finite, its determinant is {determinant}"
    )]
    SingularMap {
        /// Which leaf.
        leaf: LeafName,
        /// The determinant of the linear part.
        determinant: f64,
    },
    /// The solid reaches to infinity.
    #[error(
        "the solid is not bounded: a half-space needs an intersection with something bounded"
    )]
    Unbounded,
    /// Written out, with shared subtrees as often as they occur, the tree has more nodes
    /// than [`CompileOptions::most_nodes`] allows.
    #[error("the solid has more than {most_nodes} leaves, operators, maps and tags")]
    TooLarge {
        /// How many were allowed.
        most_nodes: u64,
    },
}

impl CompileError {
    /// The tree has more nodes than can be numbered, whatever is allowed.
    const BEYOND_NUMBERS: Self = Self::TooLarge { most_nodes: u32::MAX as u64 };
}

/// A leaf as errors name it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeafName {
    /// Its number in the order of the tree, from 0.
    pub number: u32,
    /// What it is.
    pub kind: &'static str,
    /// Its name, if it was given one.
    pub name: Option<Arc<str>>,
    /// Where it stands, if it was read from a file.
    pub place: Option<Place>,
}

impl std::fmt::Display for LeafName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Some(Place { line, column }) = self.place {
            write!(f, "{line}:{column}: ")?;
        }
        write!(f, "leaf {} ({}", self.number, self.kind)?;
        if let Some(name) = &self.name {
            write!(f, " of `{name}`")?;
        }
        write!(f, ")")
    }
}

/// What a subtree inherits from the maps and tags above it.
#[derive(Clone)]
struct Context {
    chain: Chain,
    name: Option<Arc<str>>,
    color: Option<Color>,
    place: Option<Place>,
    /// Within an outline: whether that is subtracted.
    subtracted: Option<bool>,
}

/// A subtree yet to be visited: below which node, and whether its complement is meant.
struct Task<'a> {
    solid: &'a Solid,
    parent: u32,
    complement: bool,
    context: u32,
}

/// A scene in the making.
struct Compiler {
    program: Program,
    literals: Vec<Literal>,
    shapes: Vec<Shape>,
    parts: Vec<u32>,
    places: Vec<Option<Place>>,
    subtracted: Vec<bool>,
    boxes: Vec<Aabb>,
    conditions: Vec<f64>,
    slacks: Vec<Slack>,
    part_list: Vec<Part>,
    part_numbers: HashMap<PartKey, u32>,
    meshes: Meshes,
}

/// A name, and the bits of a colour.
type PartKey = (Option<Arc<str>>, Option<[u32; 4]>);

/// Visits the tree in its own order with a list of what is left, not by recursion.
pub(super) fn compile(
    solid: &Solid,
    options: &CompileOptions,
) -> Result<Scene, CompileError> {
    let &CompileOptions { most_nodes } = options;
    if solid.size() > most_nodes {
        return Err(CompileError::TooLarge { most_nodes });
    }
    let mut compiler = Compiler {
        program: Program::new(),
        literals: Vec::new(),
        shapes: Vec::new(),
        parts: Vec::new(),
        places: Vec::new(),
        subtracted: Vec::new(),
        boxes: Vec::new(),
        conditions: Vec::new(),
        slacks: Vec::new(),
        part_list: Vec::new(),
        part_numbers: HashMap::new(),
        meshes: Meshes::default(),
    };
    let mut contexts = vec![Context {
        chain: Chain::NOTHING,
        name: None,
        color: None,
        place: None,
        subtracted: None,
    }];
    let mut tasks = vec![Task { solid, parent: 0, complement: false, context: 0 }];
    while let Some(task) = tasks.pop() {
        let Task { solid, complement, context, .. } = task;
        let node = solid.node();
        match &node.kind {
            Kind::Primitive(primitive) => {
                compiler.add_primitive(primitive, &task, &contexts[context as usize])?;
            }
            Kind::Mesh(mesh) => {
                compiler.add_mesh(mesh, &task, &contexts[context as usize])?;
            }
            Kind::Mapped(_) | Kind::Tagged(_) => {
                let inner = contexts[context as usize].inside(&node.kind, complement);
                let context = u32::try_from(contexts.len())
                    .map_err(|_| CompileError::BEYOND_NUMBERS)?;
                contexts.push(inner);
                tasks.extend(node.children.iter().map(|solid| Task {
                    solid,
                    context,
                    ..task
                }));
            }
            Kind::Boolean(op) => {
                // An intersection of nothing is nothing, as in OpenSCAD.
                let of_all = match op {
                    Op::Union => false,
                    Op::Intersection | Op::Difference => !node.children.is_empty(),
                };
                // De Morgan: the complement of a union is an intersection of complements.
                let combine =
                    if of_all == complement { Combine::Any } else { Combine::All };
                let parent = compiler
                    .program
                    .node_below(task.parent, combine)
                    .ok_or(CompileError::BEYOND_NUMBERS)?;
                let first_task = tasks.len();
                tasks.extend(node.children.iter().enumerate().map(|(i, solid)| {
                    let subtracted = *op == Op::Difference && i > 0;
                    Task { solid, parent, complement: complement != subtracted, context }
                }));
                tasks[first_task..].reverse();
            }
        }
    }
    drop(contexts);
    compiler.finish()
}

impl Context {
    /// The context of the child of a map or a tag: the outermost colour and outline and the
    /// innermost name and place hold.
    fn inside(&self, kind: &Kind, complement: bool) -> Self {
        let mut inner = self.clone();
        match kind {
            Kind::Mapped(map) => inner.chain = self.chain.then(map),
            Kind::Tagged(Tag::Name(name)) => inner.name = Some(name.clone()),
            Kind::Tagged(Tag::Color(color)) => inner.color = inner.color.or(Some(*color)),
            Kind::Tagged(Tag::Place(place)) => inner.place = Some(*place),
            Kind::Tagged(Tag::Outline) => {
                inner.subtracted = inner.subtracted.or(Some(complement));
            }
            Kind::Primitive(_) | Kind::Mesh(_) | Kind::Boolean(_) => {}
        }
        inner
    }
}

impl Compiler {
    fn add_primitive(
        &mut self,
        primitive: &Primitive,
        task: &Task<'_>,
        context: &Context,
    ) -> Result<(), CompileError> {
        let leaf = || self.leaf_name(primitive.name(), context);
        primitive.check().map_err(|BadParameter { parameter, value }| {
            CompileError::BadParameter { leaf: leaf(), parameter, value }
        })?;
        let placed = Shape::place(primitive, &context.chain);
        let placed = placed.map_err(|determinant| CompileError::SingularMap {
            leaf: leaf(),
            determinant,
        })?;
        self.add_leaf(placed, task, context)
    }

    fn add_mesh(
        &mut self,
        mesh: &Arc<Mesh>,
        task: &Task<'_>,
        context: &Context,
    ) -> Result<(), CompileError> {
        let indexed = self.meshes.indexed(mesh);
        let placed =
            Shape::place_mesh(indexed, &context.chain).map_err(|determinant| {
                CompileError::SingularMap {
                    leaf: self.leaf_name("mesh", context),
                    determinant,
                }
            })?;
        self.add_leaf(placed, task, context)
    }

    fn add_leaf(
        &mut self,
        Placed { shape, bounds, condition, slack }: Placed,
        task: &Task<'_>,
        context: &Context,
    ) -> Result<(), CompileError> {
        if self.shapes.len() >= u32::MAX as usize {
            return Err(CompileError::BEYOND_NUMBERS);
        }
        self.program.expect_child(task.parent);
        self.literals.push(Literal { parent: task.parent, complement: task.complement });
        self.shapes.push(shape);
        self.boxes.push(bounds);
        self.conditions.push(condition);
        self.slacks.push(slack);
        self.places.push(context.place);
        self.subtracted.push(context.subtracted.unwrap_or(task.complement));
        let part = self.part(context);
        self.parts.push(part);
        Ok(())
    }

    fn part(&mut self, context: &Context) -> u32 {
        let Context { name, color, .. } = context;
        let key = (name.clone(), color.map(|c| c.rgba.map(f32::to_bits)));
        *self.part_numbers.entry(key).or_insert_with(|| {
            self.part_list.push(Part { name: name.clone(), color: *color });
            u32::try_from(self.part_list.len() - 1)
                .expect("there are no more parts than leaves")
        })
    }

    fn leaf_name(&self, kind: &'static str, context: &Context) -> LeafName {
        let number = u32::try_from(self.shapes.len()).unwrap_or(u32::MAX);
        LeafName { number, kind, name: context.name.clone(), place: context.place }
    }

    /// Keeps for the search only what can matter: within the solid's reach, a leaf is as
    /// good as its part inside it, and outside nothing is inside anyway, whatever the
    /// complements are. (For the narrower bounds that would not be true: what cuts them must be
    /// found by lines that pass beside them.)
    fn finish(mut self) -> Result<Scene, CompileError> {
        let reach = self.program.bounds(&self.literals, &self.boxes, &[]);
        if !reach.is_empty() && !reach.is_bounded() {
            return Err(CompileError::Unbounded);
        }
        // An empty solid is asked nothing.
        if reach.is_bounded() {
            let leaves = self.boxes.iter().zip(&self.conditions);
            let extents: Vec<Extent> =
                leaves.map(|(leaf, &c)| Extent::new(leaf, &reach, c)).collect();
            Surfaces::new(&mut self.shapes, &extents).hand_out(&mut self.shapes);
        }
        let cutters: Vec<(u32, Aabb)> = self
            .literals
            .iter()
            .zip(self.shapes.iter().zip(&self.boxes))
            .filter(|(literal, (shape, _))| {
                literal.complement && shape.fills_its_bounds()
            })
            .map(|(literal, (_, leaf))| (literal.parent, *leaf))
            .collect();
        let bounds = self.program.bounds(&self.literals, &self.boxes, &cutters);
        let clipped: Vec<Aabb> =
            self.boxes.iter().map(|b| b.intersection(reach)).collect();
        let near = (0..).zip(&clipped).filter(|(_, b)| !b.is_empty()).map(|(i, _)| i);
        let hierarchy = Bvh::over(near.collect(), &clipped);
        let slacks: Vec<f64> =
            self.slacks.iter().map(|slack| slack.within(&reach)).collect();
        let worst = |numbers: &[f64]| numbers.iter().copied().fold(0.0, f64::max);
        Ok(Scene {
            bounds,
            worst_slack: worst(&slacks),
            worst_condition: worst(&self.conditions),
            slacks,
            far_away: self.program.counts_far_away(&self.literals),
            program: self.program,
            literals: self.literals,
            shapes: self.shapes,
            parts: self.parts,
            places: self.places,
            subtracted: self.subtracted,
            part_list: self.part_list,
            hierarchy,
        })
    }
}
