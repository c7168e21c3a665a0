//! Points: inside, outside, or so near to the boundary that rounding decides.

use glam::DVec3;

use super::trace::{PROBE, Tracer};
use crate::aabb::Aabb;
use crate::ray::Ray;
use crate::shape::{Identity, Line, Spot, U};

/// What a point is to a solid (R. B. Tilove, "Set Membership Classification: A Unified
/// Approach to Geometric Intersection Problems", IEEE Transactions on Computers C-29(10),
/// 1980).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Membership {
    /// Inside.
    In,
    /// Outside.
    Out,
    /// So near to the boundary that rounding decides on which side.
    On,
}

impl Membership {
    /// Its name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::In => "in",
            Self::Out => "out",
            Self::On => "on",
        }
    }
}

/// A leaf near a point, and the surfaces that may part it from the point: their numbers in a
/// list and on which side of each the leaf is.
struct Near {
    leaf: u32,
    faces: Vec<(usize, bool)>,
}

/// Where more surfaces than this come together, it is not looked at all the ways in which they can
/// part space: the point counts as on the boundary unless it does not matter at all what is near.
const MOST_SURFACES: usize = 8;

impl Tracer<'_> {
    /// Whether a point is inside, outside, or on the boundary within the bounds of rounding.
    ///
    /// The answer is that of [`Tracer::contains`], unless the point is nearer to surfaces
    /// than [`Scene::error_at`](crate::Scene::error_at) accounts for and the solid has both
    /// sides there. For each way in which the point may lie to those surfaces the solid is
    /// asked again. So a point on a face that two leaves share is inside, and one on a face
    /// that is buried in another leaf too.
    pub fn classify(&mut self, point: DVec3) -> Membership {
        if let Some(inside) = self.certain_of_all(point) {
            return if inside { Membership::In } else { Membership::Out };
        }
        let ray = Ray::new(point, PROBE);
        let inside = self.probe(point);
        let Some(line) = Line::new(&ray, &self.scene.stage) else {
            return Membership::Out;
        };
        let (near, surfaces) = self.near(point, &line);
        if surfaces > 0 && self.is_divided(&line, inside, &near, surfaces) {
            Membership::On
        } else if inside {
            Membership::In
        } else {
            Membership::Out
        }
    }

    /// The leaves whose surfaces the origin of a line may be on, and how many surfaces that
    /// are.
    fn near(&self, point: DVec3, line: &Line) -> (Vec<Near>, usize) {
        let scene = self.scene;
        let bounds = scene.hierarchy.bounds();
        let far = bounds.min.abs().max(bounds.max.abs()).max(point.abs()).max_element();
        let pad = 16.0 * (scene.worst_slack + U * scene.worst_condition * far);
        let (mut near, mut surfaces) = (Vec::new(), Vec::<Identity>::new());
        scene.hierarchy.around(&Aabb::new(point - pad, point + pad), |leaf| {
            let shape = &scene.shapes[leaf as usize];
            let slack = scene.slacks[leaf as usize];
            let spot = Spot { line, t: line.on_line(0.0), slack };
            let mut faces = Vec::new();
            shape.surface().near(&spot, &mut |face, _| {
                let (surface, above) = shape.identity(face);
                let known = surfaces.iter().position(|&s| s == surface);
                let number = known.unwrap_or_else(|| {
                    surfaces.push(surface);
                    surfaces.len() - 1
                });
                if !faces.contains(&(number, above)) {
                    faces.push((number, above));
                }
            });
            if !faces.is_empty() {
                near.push(Near { leaf, faces });
            }
        });
        (near, surfaces.len())
    }

    /// Whether the solid is, or may be, there on one side of the surfaces and not on another, for
    /// the line that was asked last.
    fn is_divided(
        &mut self,
        line: &Line,
        inside: bool,
        near: &[Near],
        surfaces: usize,
    ) -> bool {
        let scene = self.scene;
        let passed = self.pass_to_origin(line);
        let found: Vec<bool> = near.iter().map(|n| self.is_in(n.leaf)).collect();
        let mut now = found.clone();
        let mut differs = |wanted: &dyn Fn(&Near) -> bool| {
            for (near, now) in near.iter().zip(&mut now) {
                let wanted = wanted(near);
                if wanted != *now {
                    self.flip(near.leaf, wanted);
                    *now = wanted;
                }
            }
            self.root() != inside
        };
        let divided = if surfaces > MOST_SURFACES {
            // With complements at its leaves alone a solid has the least points where it has
            // the fewest of all leaves and complements, and the most where it has all.
            let is_complement =
                |near: &Near| scene.literals[near.leaf as usize].complement;
            differs(&is_complement) || differs(&|near| !is_complement(near))
        } else {
            (0..1_u32 << surfaces).any(|sides| {
                let holds = |&(number, above): &(usize, bool)| {
                    (sides >> number & 1 == 1) != above
                };
                differs(&|near| near.faces.iter().all(holds))
            })
        };
        for ((near, now), found) in near.iter().zip(now).zip(found) {
            if now != found {
                self.flip(near.leaf, found);
            }
        }
        self.pass_on_from(passed);
        divided
    }
}
