//! Compiled scenes: flat, checked, never changed, shared between threads.

mod beam;
mod blocks;
mod certainty;
mod classify;
mod compile;
mod copies;
mod depart;
mod digits;
mod equations;
mod first;
mod intern;
mod near;
mod options;
mod points;
mod program;
mod sheet;
mod trace;
mod weld;

use std::sync::OnceLock;

use glam::DVec3;

use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::parts::Part;
use crate::ray::{Crossing, Ray, Sense};
use crate::shape::{Line, Shape, Spot, Stage, inverse_power_of_two};
use crate::solid::{Place, Solid};
pub(crate) use beam::{Bunch, BunchTracer, Chords, Places, SIDE, Tile, TileTracer};
pub(crate) use blocks::{Blocks, Found, Leaves};
pub use classify::Membership;
pub use compile::{CompileError, LeafName};
pub(crate) use equations::{Equations, MOST_SURFACES, NotFew};
pub use options::CompileOptions;
use points::Cells;
use program::{Literal, Program};
pub use trace::Tracer;
pub use weld::{NearMisses, Weld};

/// A solid made ready for rays. No query on it can fail.
///
/// Memory: at most 420 bytes a leaf and 110 a triangle beyond the solid it was compiled
/// from, which can be dropped. While it is compiled, a leaf takes up to 1,500 and a triangle
/// no more than that. Once many points were asked about, a leaf takes up to 600 bytes more
/// and a triangle 110, and the scene 2 MiB; and 20 MiB while it learns. A prism of eight sides,
/// which has more faces than others, takes 600 bytes, 2,200 while it is compiled, and 1,200 for points.
#[derive(Debug)]
pub struct Scene {
    /// The box around the solid.
    stage: Stage,
    program: Program,
    /// The counts of the program's nodes where no leaf is near.
    far_away: Vec<u32>,
    literals: Vec<Literal>,
    shapes: Vec<Shape>,
    /// At most how far the surfaces of each leaf lie beside those that were said.
    slacks: Vec<f64>,
    /// The largest of them.
    worst_slack: f64,
    /// The largest condition number of a leaf's map.
    worst_condition: f64,
    /// Which part each leaf belongs to.
    parts: Vec<u32>,
    places: Vec<Option<Place>>,
    /// Which leaves take material away, as people see it.
    subtracted: Vec<bool>,
    part_list: Vec<Part>,
    /// The boxes of the leaves within the solid's reach.
    clipped: Vec<Aabb>,
    hierarchy: Bvh,
    /// What is known of its cells, once many points were asked about; nothing where points
    /// cannot be told from surfaces.
    cells: OnceLock<Option<Cells>>,
    welds: Vec<Weld>,
}

/// What a scene knows of one of its leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaf<'a> {
    /// What kind of shape it is.
    pub kind: &'static str,
    /// How many faces it has.
    pub faces: u32,
    /// Whether it takes material away: it stands under an odd number of subtractions,
    /// those within an outline not counted.
    pub subtracted: bool,
    /// The name and colour it was given.
    pub part: &'a Part,
    /// Where it stands in the file it was read from.
    pub place: Option<Place>,
}

impl Scene {
    /// Flattens, checks and indexes a solid, with the default [`CompileOptions`].
    ///
    /// # Errors
    ///
    /// Names the first leaf whose sizes or map make no solid, or says that the solid is not
    /// bounded.
    pub fn compile(solid: &Solid) -> Result<Self, CompileError> {
        Self::compile_with(solid, &CompileOptions::default())
    }

    /// Flattens, checks and indexes a solid.
    ///
    /// # Errors
    ///
    /// As [`Scene::compile`], and if the options do not allow it.
    pub fn compile_with(
        solid: &Solid,
        options: &CompileOptions,
    ) -> Result<Self, CompileError> {
        compile::compile(solid, options)
    }

    /// What [`CompileOptions::weld`] has joined, those farthest apart first: as few pairs as
    /// it takes. What coincided but for rounding is not among them.
    pub fn welds(&self) -> &[Weld] {
        &self.welds
    }

    /// Surfaces of a solid that nearly coincide when it is compiled, and are farther apart
    /// than rounding explains but not farther than printing its numbers with six digits may
    /// have moved them, as OpenSCAD does. Where they do, a ray may find a gap or a film that
    /// nobody meant.
    ///
    /// Numbers with fewer or more digits are taken as exact. Leaves are numbered as in
    /// [`Scene::compile_with`]. Faces of meshes are not considered.
    ///
    /// # Errors
    ///
    /// As [`Scene::compile_with`].
    pub fn near_misses(
        solid: &Solid,
        options: &CompileOptions,
    ) -> Result<NearMisses, CompileError> {
        compile::near_misses(solid, options)
    }

    /// A box around the solid, empty if the solid plainly is. It is found from the boxes of
    /// the leaves and may be larger than it need be where leaves are cut.
    pub fn bounds(&self) -> Aabb {
        self.stage.bounds
    }

    /// Boxes that hold the solid together: those of the operands of its unions, as far as
    /// they can be told apart.
    pub(crate) fn pieces(&self) -> Vec<Aabb> {
        let cutters = compile::cutters(&self.literals, &self.shapes, &self.clipped);
        self.program.pieces(&self.literals, &self.clipped, &cutters)
    }

    /// At most how far the surfaces of any leaf lie beside those that were said.
    pub(crate) fn worst_slack(&self) -> f64 {
        self.worst_slack
    }

    /// Whether a point is inside. Points of the boundary may go either way.
    ///
    /// Makes a tracer for the occasion; for more points use [`Tracer::contains`], for
    /// many at once [`Scene::contains_all`].
    pub fn contains(&self, point: DVec3) -> bool {
        self.tracer().contains(point)
    }

    /// Scratch memory for bunches of rays, one for each thread.
    pub(crate) fn bunch_tracer(&self) -> BunchTracer<'_> {
        BunchTracer::new(self)
    }

    /// Scratch memory for tiles of rays, one for each thread.
    pub(crate) fn tile_tracer(&self) -> TileTracer<'_> {
        TileTracer::new(self)
    }

    /// Scratch memory for queries, one for each thread.
    pub fn tracer(&self) -> Tracer<'_> {
        Tracer::new(self)
    }

    /// The unit normal out of the solid at a crossing of this ray.
    ///
    /// It faces the ray where the ray enters: where rounding would have it otherwise on a
    /// surface that is all but parallel to the ray, it is turned.
    pub fn normal_at(&self, ray: &Ray, crossing: &Crossing) -> DVec3 {
        let Crossing { t, leaf, face, sense } = *crossing;
        let outward = self.shapes[leaf as usize].surface().normal(ray.at(t), face);
        let level = inverse_power_of_two(outward.abs().max_element());
        let unit = (level * outward)
            .try_normalize()
            .unwrap_or_else(|| ray.dir.normalize_or(DVec3::Z));
        let against = unit.dot(ray.dir) <= 0.0;
        if against == (sense == Sense::Enter) { unit } else { -unit }
    }

    /// At most how far, in multiples of the ray's direction, the `t` of a crossing of this
    /// ray is from that of the solid as it was said: sizes and maps taken for exact numbers,
    /// the maps multiplied out without rounding.
    ///
    /// Where the ray comes to an edge of a leaf, the bound is that of the worst face there;
    /// where it grazes a curved face, it is of the order of the root of the rounding. It is
    /// infinite where a ray within rounding of a plane runs along it.
    ///
    /// The bound is of the leaf's own crossing. A ray that runs within rounding of a face
    /// without crossing it, or two faces of different leaves that are as near to each other,
    /// can make a span appear or vanish; [`Tracer::classify`] says of a point that it is
    /// [`On`](Membership::On) there.
    pub fn error_at(&self, ray: &Ray, crossing: &Crossing) -> f64 {
        let Some(line) = Line::new(ray, &self.stage) else { return f64::INFINITY };
        let t = line.on_line(crossing.t);
        let slack = self.slacks[crossing.leaf as usize];
        let surface = self.shapes[crossing.leaf as usize].surface();
        let error = surface.error(&Spot { line: &line, t, slack }, crossing.face);
        line.error_on_ray(t, error)
    }

    /// A point a little before a crossing, for programs that start rays of their own there:
    /// back along the ray by twice the bound on the crossing's error, so that it is on the
    /// side from which the ray came.
    ///
    /// Rays that are traced here need no such thing: see [`Tracer::next_hit`]. Where the
    /// bound is not small, because the ray runs along a face, the step is a millionth of the
    /// size of the solid.
    pub fn point_before(&self, ray: &Ray, crossing: &Crossing) -> DVec3 {
        let most = 1e-6 * self.stage.bounds.size().length() / ray.speed();
        ray.at(crossing.t - (2.0 * self.error_at(ray, crossing)).min(most))
    }

    /// How many leaves there are.
    pub fn leaf_count(&self) -> usize {
        self.shapes.len()
    }

    /// How many nodes there are above the leaves, after flattening.
    pub fn node_count(&self) -> usize {
        self.program.len()
    }

    /// What is known of one leaf.
    ///
    /// # Panics
    ///
    /// If there is no such leaf.
    pub fn leaf(&self, leaf: u32) -> Leaf<'_> {
        let i = leaf as usize;
        Leaf {
            kind: self.shapes[i].kind(),
            faces: self.shapes[i].surface().faces(),
            subtracted: self.subtracted[i],
            part: &self.part_list[self.parts[i] as usize],
            place: self.places[i],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    /// The figures that the documentation of [`Scene`] gives.
    #[test]
    fn leaves_take_the_memory_they_are_said_to_take() {
        let at = |i: u32| {
            dvec3(f64::from(i % 100), f64::from(i / 100 % 100), f64::from(i / 10_000))
        };
        for (leaf, [kept, in_cells]) in [
            (Solid::ball(0.3), [420, 600]),
            (Solid::cylinder(0.3, 0.5), [420, 600]),
            (Solid::cuboid(DVec3::splat(0.5)), [420, 600]),
            (Solid::prism(8, 0.3, 0.5), [600, 1200]),
        ] {
            let leaves = (0..20_000).map(|i| leaf.clone().translated(at(i)));
            let scene = Scene::compile(&Solid::boolean(crate::Op::Union, leaves))
                .expect("leaves apart from each other");
            let bytes = scene.hierarchy.bytes()
                + size_of_val(&*scene.literals)
                + size_of_val(&*scene.clipped)
                + size_of_val(&*scene.shapes)
                + scene.shapes.iter().map(Shape::bytes).sum::<usize>()
                + size_of_val(&*scene.parts)
                + size_of_val(&*scene.places);
            assert!(bytes <= kept * 20_000, "{} bytes a leaf", bytes / 20_000);
            let cells = Cells::new(&scene).expect("there is room").bytes();
            assert!(cells <= in_cells * 20_000, "{} bytes a leaf", cells / 20_000);
        }
    }
}
