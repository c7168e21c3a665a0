//! A scene as equations: the polynomials of its surfaces, and on which sides of them it is.

use glam::{DMat3, DVec3};

use super::Scene;
use crate::shape::Identity;

/// The surfaces of a scene without meshes, in coordinates of the caller's choice.
///
/// Faces that lie on one surface share its equation, as they share its crossings.
#[derive(Debug)]
pub(crate) struct Equations<'a> {
    scene: &'a Scene,
    /// The ten coefficients of each surface: of x², y², z², xy, yz, zx, x, y, z and 1.
    pub(crate) surfaces: Vec<[f64; 10]>,
    leaves: Vec<Sides>,
}

/// A leaf: on the positive side of some surfaces, on the negative side of others.
#[derive(Clone, Copy, Debug, Default)]
struct Sides {
    /// Bits of the surfaces that bound the leaf.
    of: u64,
    /// Which of them are positive inside.
    positive: u64,
}

/// Why a scene has no such equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NotFew {
    /// A leaf is a mesh.
    Mesh(u32),
    /// There are more surfaces than bits.
    Surfaces,
}

/// How many surfaces there can be: one for each bit.
pub(crate) const MOST_SURFACES: usize = 64;

impl Scene {
    /// The equations of all surfaces at `origin + map · s`, as polynomials in s.
    pub(crate) fn equations(
        &self,
        origin: DVec3,
        map: DMat3,
    ) -> Result<Equations<'_>, NotFew> {
        let mut known: Vec<Identity> = Vec::new();
        let mut leaves = Vec::new();
        let mut surfaces = Vec::new();
        for (leaf, shape) in (0..).zip(&self.shapes) {
            let mut sides = Sides::default();
            for face in 0..shape.surface().faces() {
                let (identity, positive) = shape.identity(face);
                let number = known.iter().position(|other| *other == identity);
                let number = number.unwrap_or(known.len());
                if number == known.len() {
                    let form = shape.form(face, origin, map);
                    surfaces.push(form.ok_or(NotFew::Mesh(leaf))?);
                    known.push(identity);
                }
                if number >= MOST_SURFACES {
                    return Err(NotFew::Surfaces);
                }
                sides.of |= 1 << number;
                sides.positive |= u64::from(positive) << number;
            }
            leaves.push(sides);
        }
        Ok(Equations { scene: self, surfaces, leaves })
    }
}

impl Equations<'_> {
    /// Whether a point is inside on whose equations the bits say which are positive.
    pub(crate) fn is_inside(&self, positive: u64, counts: &mut Vec<u32>) -> bool {
        let Scene { program, literals, .. } = self.scene;
        program.evaluate(literals, counts, |leaf| {
            let Sides { of, positive: wanted } = self.leaves[leaf];
            positive & of == wanted
        })
    }
}
