//! How far writing numbers with six digits has moved the surfaces of a solid.
//!
//! OpenSCAD prints the numbers of a `.csg` with six significant digits, so every number in it
//! is off by up to half a unit of the sixth. An error in the translation of a map moves a
//! leaf by as much; one in its linear part by as much times the lever arm, the coordinates of
//! what is mapped. Maps within maps add up: their errors are carried to the leaf by interval
//! arithmetic, to first order.
//!
//! A number that takes fewer than six digits is taken as exact: people write 12.5, and it is
//! rare that anything else is printed so. So is one that takes more, which was not printed
//! with six. But where one entry of a matrix has been rounded, all have.

use glam::{DAffine3, DMat3, DVec3};

use crate::primitive::Primitive;
use crate::solid::{Kind, Solid};

/// What a number may be off by: its digits are six, or fewer or more.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Digits {
    Six,
    Other,
}

/// Half a unit of the sixth digit of a number, and whether it takes just six.
fn sixth(x: f64) -> (f64, Digits) {
    if x == 0.0 || !x.is_finite() {
        return (0.0, Digits::Other);
    }
    let exponent = 5.0 - x.abs().log10().floor();
    let scaled = x.abs() * 10.0_f64.powf(exponent);
    let rounded = scaled.round();
    // The product is off by a few units in its last place.
    let is_whole = (scaled - rounded).abs() <= 1e-9 * scaled;
    let is_six = is_whole && rounded % 10.0 != 0.0;
    (0.5 * 10.0_f64.powf(-exponent), if is_six { Digits::Six } else { Digits::Other })
}

/// What a size may be off by.
fn error(x: f64) -> f64 {
    let (half_unit, digits) = sixth(x);
    if digits == Digits::Six { half_unit } else { 0.0 }
}

/// What the entries of a map may be off by.
fn errors(map: &DAffine3) -> DAffine3 {
    let has_six = |numbers: &[f64]| numbers.iter().any(|&x| sixth(x).1 == Digits::Six);
    let half_units = |v: DVec3| DVec3::from_array(v.to_array().map(|x| sixth(x).0));
    let m = map.matrix3;
    let turns = has_six(&m.to_cols_array());
    let moves = turns || has_six(&map.translation.to_array());
    DAffine3 {
        matrix3: if turns {
            DMat3::from_cols(
                half_units(m.x_axis),
                half_units(m.y_axis),
                half_units(m.z_axis),
            )
        } else {
            DMat3::ZERO
        },
        translation: if moves { half_units(map.translation) } else { DVec3::ZERO },
    }
}

fn absolute(m: &DMat3) -> DMat3 {
    DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}

/// The product of the maps above a subtree, and what its entries may be off by.
#[derive(Clone, Copy)]
struct Above {
    map: DAffine3,
    errors: DAffine3,
}

impl Above {
    fn then(&self, map: &DAffine3) -> Self {
        let (outer, own) = (absolute(&self.map.matrix3), errors(map));
        let inner = absolute(&map.matrix3);
        let Self { errors, .. } = self;
        Self {
            map: self.map * *map,
            errors: DAffine3 {
                matrix3: errors.matrix3 * inner + outer * own.matrix3,
                translation: errors.matrix3 * map.translation.abs()
                    + errors.translation
                    + outer * own.translation,
            },
        }
    }

    /// How far a surface of a primitive may be from where it was meant.
    ///
    /// A turn counts twice, for where surfaces are compared it counts over the whole width of
    /// a leaf, not from the middle.
    fn moved(&self, primitive: &Primitive) -> f64 {
        let (arm, sizes) = sizes(primitive);
        let turned = 2.0 * (self.errors.matrix3 * arm);
        let moved = self.errors.translation + absolute(&self.map.matrix3) * sizes;
        (turned + moved).length()
    }
}

/// The largest coordinates of a primitive, and what its sizes may be off by on each axis.
fn sizes(primitive: &Primitive) -> (DVec3, DVec3) {
    let primitive = primitive.describe();
    let off = |lengths: Vec<f64>| lengths.into_iter().map(error).fold(0.0, f64::max);
    let around = primitive.extent().mapped(&DAffine3::IDENTITY);
    // What has no bounds is in no file.
    let arm = if around.is_bounded() {
        around.min.abs().max(around.max.abs())
    } else {
        DVec3::ZERO
    };
    (arm, DVec3::from_array(primitive.lengths().map(off)))
}

/// How far the surfaces of each leaf may be from where they were meant, in the order in which
/// leaves are numbered. Faces of meshes are not asked about: theirs is zero.
pub(super) fn moved(solid: &Solid) -> Vec<f64> {
    let top = Above {
        map: DAffine3::IDENTITY,
        errors: DAffine3 { matrix3: DMat3::ZERO, translation: DVec3::ZERO },
    };
    let mut found = Vec::new();
    let mut tasks = vec![(solid, top)];
    while let Some((solid, above)) = tasks.pop() {
        let node = solid.node();
        match &node.kind {
            Kind::Primitive(primitive) => {
                let moved = above.moved(primitive);
                found.push(if moved.is_finite() { moved } else { 0.0 });
            }
            Kind::Mesh(_) => found.push(0.0),
            Kind::Mapped(map) => {
                let inner = above.then(map);
                tasks.extend(node.children.iter().map(|child| (child, inner)));
            }
            Kind::Tagged(_) | Kind::Boolean(_) => {
                tasks.extend(node.children.iter().rev().map(|child| (child, above)));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn only_numbers_of_six_digits_are_off() {
        for (x, expected) in [
            (0.866_025, 5e-7),
            (-12.3457, 5e-5),
            (200.001, 5e-4),
            (123_457.0, 0.5),
            (1.234_56e-7, 5e-13),
            (0.866_03, 0.0),
            (12.5, 0.0),
            (0.0, 0.0),
            (1.0 / 3.0, 0.0),
            (2_000_000.0, 0.0),
        ] {
            assert!((error(x) - expected).abs() <= 1e-12 * expected, "{x}: {}", error(x));
        }
    }

    #[test]
    fn errors_of_a_turn_grow_with_the_lever_arm() {
        let turn = DMat3::from_cols(
            dvec3(0.866_025, 0.5, 0.0),
            dvec3(-0.5, 0.866_025, 0.0),
            DVec3::Z,
        );
        let near = Solid::cuboid(DVec3::splat(2.0)).mapped(DAffine3::from_mat3(turn));
        let far = Solid::cuboid(DVec3::splat(2.0))
            .translated(dvec3(100.0, 0.0, 0.0))
            .mapped(DAffine3::from_mat3(turn));
        let plain = Solid::cuboid(DVec3::splat(2.0)).translated(dvec3(100.0, 0.0, 0.0));
        let [near, far, plain] = [near, far, plain].map(|solid| moved(&solid)[0]);
        assert!(near > 1e-6 && near < 2e-5, "{near}");
        assert!(far > 5e-5 && far < 2e-4, "{far}");
        assert!(plain <= 0.0, "{plain}");
    }
}
