//! From the tree that was said to the flat scene that is asked.

use std::collections::HashMap;
use std::ops::RangeInclusive;
use std::sync::{Arc, OnceLock};

use thiserror::Error;

use super::copies::Meshes;
use super::intern::Surfaces;
use super::options::CompileOptions;
use super::program::{Combine, Literal, Program};
use super::sheet::Extent;
use super::weld::{NearMisses, Refusal, Weld};
use super::{Scene, digits};
use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::mesh::Mesh;
use crate::op::Op;
use crate::parts::Part;
use crate::primitive::{BadParameter, Primitive};
use crate::shape::{Chain, Placed, Plane, Shape, Slack, Stage};
use crate::shown::Shown;
use crate::solid::{Kind, Place, Solid, Tag};

/// Why a solid cannot be compiled.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CompileError {
    /// A size is out of its range, or the largest coordinate is.
    #[error("{leaf}: the {parameter} is {}, which is out of its range", Shown(*.value))]
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
        "{leaf}: its map is singular or not finite, its determinant is {}",
        Shown(*.determinant)
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
    /// The weld is no length.
    #[error("the weld is {weld}, which is not a finite length of at least zero")]
    BadWeld {
        /// What was asked for.
        weld: f64,
    },
    /// The weld joins surfaces in turn of which some are too far apart to be one.
    #[error(
        "{}, {} and {} have surfaces that nearly coincide in turn, but the first and the \
         last are {apart:.2e} apart, farther than the weld of {weld}; {}",
        leaves[0], leaves[1], leaves[2], Advice(*fine)
    )]
    ChainOfWelds {
        /// The first, one between and the last.
        leaves: Box<[LeafName; 3]>,
        /// How far the surfaces of the first and the last are apart.
        apart: f64,
        /// What was asked for.
        weld: f64,
        /// A smaller weld that is not refused; zero if only that is not.
        fine: f64,
    },
    /// The weld joins two faces of one leaf by way of another's.
    #[error(
        "a weld of {weld} joins two faces of {}, which are {apart:.2e} apart, by way of {}; \
         {}",
        leaves[0], leaves[1], Advice(*fine)
    )]
    WeldOfThinLeaf {
        /// The leaf, and the other.
        leaves: Box<[LeafName; 2]>,
        /// How far apart its faces are.
        apart: f64,
        /// What was asked for.
        weld: f64,
        /// A smaller weld that is not refused; zero if only that is not.
        fine: f64,
    },
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

/// The largest coordinate of a leaf, if it is not zero: sums of a few such are numbers still,
/// and what rounding does to them is in proportion to them.
const REACH: RangeInclusive<f64> = 1e-301..=1e301;

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

/// Which weld to ask for instead.
struct Advice(f64);

impl std::fmt::Display for Advice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0 > 0.0 {
            write!(f, "a weld of {} would do", self.0)
        } else {
            f.write_str("no smaller one joins anything")
        }
    }
}

/// What a subtree inherits from the maps and tags above it.
#[derive(Clone)]
struct Context {
    chain: Chain,
    part: Part,
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
    /// How far interning has moved each leaf's surfaces.
    moved: Vec<f64>,
    part_list: Vec<Part>,
    part_numbers: HashMap<PartKey, u32>,
    meshes: Meshes,
}

/// Where the leaves of a solid are that can matter.
struct Outline {
    extents: Vec<Extent>,
    /// The leaves' boxes within the solid's reach.
    boxes: Vec<Aabb>,
}

/// A name, and the bits of a colour.
type PartKey = (Option<Arc<str>>, Option<[u32; 4]>);

/// A scene of a solid.
pub(super) fn compile(
    solid: &Solid,
    options: &CompileOptions,
) -> Result<Scene, CompileError> {
    visit(solid, options)?.finish(options.weld)
}

/// What of a solid nearly coincides after it has been compiled.
pub(super) fn near_misses(
    solid: &Solid,
    options: &CompileOptions,
) -> Result<NearMisses, CompileError> {
    visit(solid, options)?.near_misses(options.weld, &digits::moved(solid))
}

/// Visits the tree in its own order with a list of what is left, not by recursion.
fn visit(solid: &Solid, options: &CompileOptions) -> Result<Compiler, CompileError> {
    let &CompileOptions { weld, most_nodes } = options;
    if !(weld.is_finite() && weld >= 0.0) {
        return Err(CompileError::BadWeld { weld });
    }
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
        moved: Vec::new(),
        part_list: Vec::new(),
        part_numbers: HashMap::new(),
        meshes: Meshes::default(),
    };
    let mut contexts = vec![Context {
        chain: Chain::NOTHING,
        part: Part::default(),
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
    Ok(compiler)
}

impl Context {
    /// The context of the child of a map or a tag: the outermost colour and outline and the
    /// innermost name and place hold.
    fn inside(&self, kind: &Kind, complement: bool) -> Self {
        let mut inner = self.clone();
        match kind {
            Kind::Mapped(map) => inner.chain = self.chain.then(map),
            Kind::Tagged(tag @ (Tag::Name(_) | Tag::Color(_))) => {
                inner.part = inner.part.tagged(tag);
            }
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
        Placed { shape, bounds, condition, slack, reach }: Placed,
        task: &Task<'_>,
        context: &Context,
    ) -> Result<(), CompileError> {
        if self.shapes.len() >= u32::MAX as usize {
            return Err(CompileError::BEYOND_NUMBERS);
        }
        if reach != 0.0 && !REACH.contains(&reach) {
            return Err(CompileError::BadParameter {
                leaf: self.leaf_name(shape.kind(), context),
                parameter: "largest coordinate",
                value: reach,
            });
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
        *self.part_numbers.entry(context.part.key()).or_insert_with(|| {
            self.part_list.push(context.part.clone());
            u32::try_from(self.part_list.len() - 1)
                .expect("there are no more parts than leaves")
        })
    }

    fn leaf_name(&self, kind: &'static str, context: &Context) -> LeafName {
        let number = u32::try_from(self.shapes.len()).unwrap_or(u32::MAX);
        LeafName { number, kind, name: context.part.name.clone(), place: context.place }
    }

    /// Where the leaves are that can matter, and how well; `None` if the solid is empty and
    /// is asked nothing.
    fn outline(&self) -> Result<Option<Outline>, CompileError> {
        let reach = self.program.bounds(&self.literals, &self.boxes, &[]);
        if reach.is_empty() {
            return Ok(None);
        }
        if !reach.is_bounded() {
            return Err(CompileError::Unbounded);
        }
        let leaves = self.boxes.iter().zip(&self.conditions).zip(&self.slacks);
        let extents = leaves
            .map(|((leaf, &c), slack)| Extent::new(leaf, &reach, c, slack.within(&reach)))
            .collect();
        let boxes = self.boxes.iter().map(|b| b.intersection(reach)).collect();
        Ok(Some(Outline { extents, boxes }))
    }

    /// Makes one of what coincides and what the weld joins; says what that was.
    fn join(&mut self, weld: f64) -> Result<Vec<Weld>, CompileError> {
        let Some(Outline { extents, boxes }) = self.outline()? else {
            return Ok(Vec::new());
        };
        let mut surfaces = Surfaces::new(&mut self.shapes, &extents);
        if weld <= 0.0 {
            self.moved = surfaces.hand_out(&mut self.shapes, &extents);
            return Ok(Vec::new());
        }
        let welded = surfaces.weld(weld, &extents, &boxes);
        let (welds, moved) = welded.map_err(|refusal| self.refused(&refusal, weld))?;
        self.moved = surfaces.hand_out(&mut self.shapes, &extents);
        for (leaf, by) in (0..).zip(moved).filter(|&(_, by)| by > 0.0) {
            self.move_box(leaf, by);
        }
        Ok(welds)
    }

    /// Fits the box of a leaf to its surfaces after some have moved by as much as this.
    ///
    /// Where surfaces meet at an angle their edge moves farther than they do, by no more than
    /// the condition number says.
    fn move_box(&mut self, leaf: usize, by: f64) {
        let (shape, around) = (&mut self.shapes[leaf], &mut self.boxes[leaf]);
        if shape.fills_its_bounds() {
            for Plane { normal, offset, above } in shape.planes_mut() {
                let axis = normal.abs().max_position();
                let side = if *above { &mut around.min } else { &mut around.max };
                side[axis] = *offset;
            }
        } else {
            *around = around.grown(6.0 * self.conditions[leaf] * by);
        }
    }

    fn refused(&self, refusal: &Refusal, weld: f64) -> CompileError {
        let Refusal { leaves, apart, fine } = *refusal;
        let [first, middle, last] = leaves.map(|leaf| {
            let i = leaf as usize;
            LeafName {
                number: leaf,
                kind: self.shapes[i].kind(),
                name: self.part_list[self.parts[i] as usize].name.clone(),
                place: self.places[i],
            }
        });
        if leaves[0] == leaves[2] {
            let leaves = Box::new([first, middle]);
            CompileError::WeldOfThinLeaf { leaves, apart, weld, fine }
        } else {
            let leaves = Box::new([first, middle, last]);
            CompileError::ChainOfWelds { leaves, apart, weld, fine }
        }
    }

    /// The pairs that six digits may have parted, and a weld that joins them. That is tried,
    /// for it may join other things too, and be refused for that.
    fn near_misses(
        mut self,
        weld: f64,
        moved: &[f64],
    ) -> Result<NearMisses, CompileError> {
        let nothing = NearMisses { pairs: Vec::new(), weld: None };
        let Some(Outline { extents, boxes }) = self.outline()? else {
            return Ok(nothing);
        };
        let mut surfaces = Surfaces::new(&mut self.shapes, &extents);
        if weld > 0.0 {
            let welded = surfaces.weld(weld, &extents, &boxes);
            welded.map_err(|refusal| self.refused(&refusal, weld))?;
        }
        let (pairs, needs) = surfaces.near_misses(&extents, &boxes, moved);
        if pairs.is_empty() {
            return Ok(nothing);
        }
        // They are to be joined from where they were, each up to a weld away.
        let least = needs + 2.0 * weld;
        let surfaces = Surfaces::new(&mut self.shapes, &extents);
        let weld = surfaces.large_enough(least, &extents, &boxes);
        Ok(NearMisses { pairs, weld })
    }

    /// Keeps for the search only what can matter: within the solid's reach, a leaf is as good
    /// as its part inside it, and outside nothing is inside anyway, whatever the complements
    /// are. (For the narrower bounds that would not be true: what cuts them must be found by
    /// lines that pass beside them.)
    fn finish(mut self, weld: f64) -> Result<Scene, CompileError> {
        let welds = self.join(weld)?;
        let reach = self.program.bounds(&self.literals, &self.boxes, &[]);
        let cutters = cutters(&self.literals, &self.shapes, &self.boxes);
        let bounds = self.program.bounds(&self.literals, &self.boxes, &cutters);
        let clipped: Vec<Aabb> =
            self.boxes.iter().map(|b| b.intersection(reach)).collect();
        let near = (0..).zip(&clipped).filter(|(_, b)| !b.is_empty()).map(|(i, _)| i);
        let hierarchy = Bvh::over(near.collect(), &clipped);
        let moved = self.moved.into_iter().chain(std::iter::repeat(0.0));
        let slacks = self.slacks.iter().zip(moved);
        let slacks: Vec<f64> =
            slacks.map(|(slack, moved)| slack.within(&reach) + moved).collect();
        let worst = |numbers: &[f64]| numbers.iter().copied().fold(0.0, f64::max);
        Ok(Scene {
            stage: Stage::new(bounds),
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
            clipped,
            hierarchy,
            cells: OnceLock::new(),
            welds,
        })
    }
}

/// The leaves that are boxes to be taken away, and from which node.
pub(super) fn cutters(
    literals: &[Literal],
    shapes: &[Shape],
    boxes: &[Aabb],
) -> Vec<(u32, Aabb)> {
    literals
        .iter()
        .zip(shapes.iter().zip(boxes))
        .filter(|(literal, (shape, _))| literal.complement && shape.fills_its_bounds())
        .map(|(literal, (_, leaf))| (literal.parent, *leaf))
        .collect()
}
