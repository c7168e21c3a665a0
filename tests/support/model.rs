//! Trees of which every point can be asked directly, without rays.
//!
//! A [`Model`] is both a [`Solid`] for the kernel and a formula: the point is taken into
//! each leaf's frame by one inverse map after the other, the leaf's inequality is looked at
//! there, and the operators combine the answers. It shares no code with the kernel.

use glam::{DAffine3, DVec3};
use solidray::{Op, Ray, Solid};

use super::leaf::Leaf;

/// A solid that can be asked without rays.
#[derive(Clone, Debug)]
pub(crate) enum Model {
    Leaf(Leaf),
    Boolean(Op, Vec<Self>),
    Mapped(DAffine3, Box<Self>),
}

/// A place worth aiming at, and the directions of the leaf's axes there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Feature {
    pub(crate) point: DVec3,
    pub(crate) axes: [DVec3; 3],
}

impl Model {
    pub(crate) fn boolean(op: Op, children: impl IntoIterator<Item = Self>) -> Self {
        Self::Boolean(op, children.into_iter().collect())
    }

    pub(crate) fn mapped(self, map: DAffine3) -> Self {
        Self::Mapped(map, Box::new(self))
    }

    /// The same for the kernel.
    pub(crate) fn solid(&self) -> Solid {
        match self {
            Self::Leaf(leaf) => leaf.solid(),
            Self::Boolean(op, children) => {
                Solid::boolean(*op, children.iter().map(Self::solid))
            }
            Self::Mapped(map, child) => child.solid().mapped(*map),
        }
    }

    /// Whether a point is inside; nothing if it is too near to a surface that matters.
    pub(crate) fn holds(&self, point: DVec3) -> Option<bool> {
        match self {
            Self::Leaf(leaf) => leaf.holds(point),
            Self::Mapped(map, child) => {
                child.holds(map.inverse().transform_point3(point))
            }
            Self::Boolean(_, children) if children.is_empty() => Some(false),
            Self::Boolean(op, children) => {
                let mut answers = children.iter().map(|child| child.holds(point));
                match op {
                    Op::Union => not(all(answers.map(not))),
                    Op::Intersection => all(answers),
                    Op::Difference => {
                        let first = answers.next().flatten();
                        all(std::iter::once(first).chain(answers.map(not)))
                    }
                }
            }
        }
    }

    /// The leaves with their maps.
    pub(crate) fn leaves(&self) -> Vec<(&Leaf, DAffine3)> {
        match self {
            Self::Leaf(leaf) => vec![(leaf, DAffine3::IDENTITY)],
            Self::Boolean(_, children) => {
                children.iter().flat_map(Self::leaves).collect()
            }
            Self::Mapped(map, child) => {
                child.leaves().into_iter().map(|(leaf, m)| (leaf, *map * m)).collect()
            }
        }
    }

    /// What rays should be aimed at.
    pub(crate) fn features(&self) -> Vec<Feature> {
        let of_leaf = |(leaf, map): (&Leaf, DAffine3)| {
            let axes = DVec3::AXES.map(|axis| map.transform_vector3(axis));
            let place = move |p| Feature { point: map.transform_point3(p), axes };
            leaf.features().into_iter().map(place).collect::<Vec<_>>()
        };
        self.leaves().into_iter().flat_map(of_leaf).collect()
    }
}

/// True if all are, whatever the open ones turn out to be; false if one is.
fn all(answers: impl Iterator<Item = Option<bool>>) -> Option<bool> {
    let mut sum = Some(true);
    for answer in answers {
        match answer {
            Some(false) => return Some(false),
            Some(true) => {}
            None => sum = None,
        }
    }
    sum
}

fn not(answer: Option<bool>) -> Option<bool> {
    answer.map(|value| !value)
}

/// Where a ray passes through the surfaces of all leaves, in order: each leaf asked alone,
/// half-spaces by their formula.
pub(crate) fn crossings_of_leaves(model: &Model, ray: &Ray) -> Vec<f64> {
    let mut all: Vec<f64> = model
        .leaves()
        .into_iter()
        .flat_map(|(leaf, map)| alone(leaf, map, ray))
        .collect();
    all.sort_by(f64::total_cmp);
    all
}

fn alone(leaf: &Leaf, map: DAffine3, ray: &Ray) -> Vec<f64> {
    if let Leaf::HalfSpace { normal, offset } = leaf {
        let back = map.inverse();
        let (o, d) = (back.transform_point3(ray.origin), back.transform_vector3(ray.dir));
        let t = (offset - normal.dot(o)) / normal.dot(d);
        return if t.is_finite() { vec![t] } else { Vec::new() };
    }
    super::ends(&leaf.solid().mapped(map), ray).into_iter().flatten().collect()
}
