//! Volumes of primitives in their own frames.

use super::super::rounded::Rounded;
use crate::shape::{Primitive, Profile};

/// π is off by less than half a unit in its last place.
const PI: Rounded = Rounded { value: std::f64::consts::PI, error: f64::EPSILON };

/// A sixth.
const SIXTH: Rounded = Rounded { value: 1.0 / 6.0, error: f64::EPSILON };

/// The volume of a primitive whose sizes make a solid; none of a half-space.
pub(super) fn volume(primitive: &Primitive) -> Option<Rounded> {
    match *primitive {
        Primitive::Cuboid { min, max } => {
            let [x, y, z] =
                [0, 1, 2].map(|i| Rounded::exact(max[i]) - Rounded::exact(min[i]));
            Some(x * y * z)
        }
        Primitive::Quadric { profile, bottom, top } => {
            Some(PI * squares(profile, bottom, top))
        }
        Primitive::HalfSpace { .. } => None,
    }
}

/// The integral of the squared radius ρ over the height.
///
/// Each ρ is a product of two functions linear in z, of one sign each where the solid is, so
/// that nothing cancels; that of one sheet is a square and such a product.
fn squares(profile: Profile, bottom: f64, top: f64) -> Rounded {
    let at = Rounded::exact;
    let between = |bottom: f64, top: f64, factors: &dyn Fn(Rounded) -> [Rounded; 2]| {
        if bottom < top { product(at(bottom), at(top), factors) } else { Rounded::ZERO }
    };
    match profile {
        Profile::Ball { radius } => {
            let r = at(radius);
            between(bottom.max(-radius), top.min(radius), &|z| [r - z, r + z])
        }
        Profile::Cylinder { radius } => between(bottom, top, &|_| [at(radius); 2]),
        Profile::Cone { radius, slope } => {
            // The makers of frusta round heights and slopes.
            let (r, slope) = (at(radius), Rounded::nearly(slope));
            let [bottom, top] = [bottom, top].map(Rounded::nearly);
            product(bottom, top, &|z| [r + slope * z; 2])
        }
        Profile::Paraboloid { scale } => {
            between(bottom.max(0.0), top, &|z| [Rounded::nearly(scale), z])
        }
        Profile::OneSheet { waist, slope } => {
            let slope = Rounded::nearly(slope);
            between(bottom, top, &|_| [at(waist); 2])
                + between(bottom, top, &|z| [slope * z; 2])
        }
        Profile::TwoSheets { vertex, slope } => {
            let (slope, v) = (at(slope), at(vertex));
            let factors = |z| [slope * (z - v), slope * (z + v)];
            between(bottom, top.min(-vertex), &factors)
                + between(bottom.max(vertex), top, &factors)
        }
    }
}

/// The integral of the product of two linear functions between two heights.
fn product(
    bottom: Rounded,
    top: Rounded,
    factors: &dyn Fn(Rounded) -> [Rounded; 2],
) -> Rounded {
    let ([a, b], [c, d]) = (factors(bottom), factors(top));
    let (ends, across) = (a * b + c * d, a * d + b * c);
    (top - bottom) * SIXTH * (ends + ends + across)
}
