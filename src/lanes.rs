//! Numbers that stand for one ray, or for several side by side.
//!
//! What leaves compute is written once, for any [`Lanes`]. One ray uses `f64`, packets of
//! rays use [`Vector`], whose width is chosen at run time for the machine. Both do the same
//! operations in the same order, each rounded by itself: products and sums are never fused.
//! So an answer does not depend on which of the two has found it, nor on the machine.
//!
//! Whatever works on lanes is inlined into the one function that was compiled for the
//! machine's vectors: each function says so, and there are no closures, which could not.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use glam::{DMat3, DVec3};
use pulp::Simd;

/// One number, or one for each ray of a packet.
pub(crate) trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// One truth, or one for each ray.
    type Mask: Copy
        + BitAnd<Output = Self::Mask>
        + BitOr<Output = Self::Mask>
        + Not<Output = Self::Mask>;

    /// The same number for all rays that this one has numbers for.
    fn same(self, x: f64) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    fn less(self, other: Self) -> Self::Mask;
    fn equal(self, other: Self) -> Self::Mask;
    /// For each ray `yes` or `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Whether it is true of one ray.
    fn any(mask: Self::Mask) -> bool;
    /// The power of two that brings a positive number into 1..2, or as near as one factor
    /// goes for denormal numbers and those above 2¹⁰²³, infinity among them.
    fn inverse_power_of_two(self) -> Self;

    /// The smaller one; `other` where one is not a number.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.less(other), self, other)
    }

    /// The larger one; `other` where one is not a number.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.less(self), self, other)
    }

    /// The nearest whole number, the even one of two; numbers of 2⁵¹ and more stay as they
    /// are. Adding 1.5 · 2⁵² leaves no room for a fraction.
    #[inline(always)]
    fn round(self) -> Self {
        let large = self.same(6_755_399_441_055_744.0);
        let rounded = (self + large) - large;
        Self::select(self.abs().less(self.same(2_251_799_813_685_248.0)), rounded, self)
    }

    /// The largest whole number up to one from 0 to 2³¹, for [`small`] to read.
    #[inline(always)]
    fn small(self) -> Self {
        let large = self.same(SMALL);
        let rounded = self + large;
        let above = self.less(rounded - large);
        Self::select(above, rounded - self.same(1.0), rounded)
    }

    /// Whether it is a number, and not infinite.
    #[inline(always)]
    fn is_finite(self) -> Self::Mask {
        self.abs().less(self.same(f64::INFINITY))
    }
}

impl Lanes for f64 {
    type Mask = bool;

    #[inline(always)]
    fn same(self, x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    #[expect(clippy::float_cmp, reason = "that is what is asked")]
    fn equal(self, other: Self) -> bool {
        self == other
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }

    #[inline(always)]
    fn inverse_power_of_two(self) -> Self {
        // The field of 2⁻ᵉ is 2 BIAS minus that of 2ᵉ; both ends of its range are taken by
        // other kinds of numbers.
        let field = (2 * BIAS).saturating_sub(self.to_bits() >> 52);
        Self::from_bits(field.clamp(1, 2 * BIAS - 1) << 52)
    }
}

/// The exponent field of 1.0.
const BIAS: u64 = 1023;

/// The numbers of as many rays as the machine computes at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector<S: Simd>(pub(crate) S, pub(crate) S::f64s);

/// Truths for as many rays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Truths<S: Simd>(S, S::m64s);

macro_rules! operator {
    ($name:ident, $method:ident, $type:ident, $of_simd:ident) => {
        impl<S: Simd> $name for $type<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0, self.0.$of_simd(self.1, other.1))
            }
        }
    };
}

operator!(Add, add, Vector, add_f64s);
operator!(Sub, sub, Vector, sub_f64s);
operator!(Mul, mul, Vector, mul_f64s);
operator!(Div, div, Vector, div_f64s);
operator!(BitAnd, bitand, Truths, and_m64s);
operator!(BitOr, bitor, Truths, or_m64s);

impl<S: Simd> Neg for Vector<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0, self.0.neg_f64s(self.1))
    }
}

impl<S: Simd> Not for Truths<S> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0, self.0.not_m64s(self.1))
    }
}

/// Whether vectors have an instruction each for [`Lanes::min`] and [`Lanes::max`]. Those of
/// x86 choose as these do where zeros have signs or one is not a number; others differ.
const fn chooses_by_instruction<S: Simd>() -> bool {
    cfg!(target_arch = "x86_64") && S::F64_LANES > 1
}

/// A number for each of the most rays that a machine computes at once: its bit.
const WEIGHTS: [f64; 8] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0];

impl<S: Simd> Truths<S> {
    /// A bit for each ray of which it is true, that of the first one lowest.
    #[inline(always)]
    pub(crate) fn bits(self) -> u64 {
        let Self(simd, truths) = self;
        let (weights, _) = S::as_simd_f64s(&WEIGHTS);
        let weights = simd.select_f64s(truths, weights[0], simd.splat_f64s(0.0));
        // Sums of different powers of two are exact.
        small(simd.reduce_sum_f64s(weights) + SMALL) as u64
    }
}

impl<S: Simd> Lanes for Vector<S> {
    type Mask = Truths<S>;

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if chooses_by_instruction::<S>() {
            return Self(self.0, self.0.min_f64s(self.1, other.1));
        }
        Self::select(self.less(other), self, other)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if chooses_by_instruction::<S>() {
            return Self(self.0, self.0.max_f64s(self.1, other.1));
        }
        Self::select(other.less(self), self, other)
    }

    #[inline(always)]
    fn same(self, x: f64) -> Self {
        Self(self.0, self.0.splat_f64s(x))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0, self.0.sqrt_f64s(self.1))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let sign = self.0.splat_f64s(-0.0);
        Self(self.0, self.0.and_f64s(self.0.not_f64s(sign), self.1))
    }

    #[inline(always)]
    fn less(self, other: Self) -> Truths<S> {
        Truths(self.0, self.0.less_than_f64s(self.1, other.1))
    }

    #[inline(always)]
    fn equal(self, other: Self) -> Truths<S> {
        Truths(self.0, self.0.equal_f64s(self.1, other.1))
    }

    #[inline(always)]
    fn select(mask: Truths<S>, yes: Self, no: Self) -> Self {
        Self(yes.0, yes.0.select_f64s(mask.1, yes.1, no.1))
    }

    #[inline(always)]
    fn any(mask: Truths<S>) -> bool {
        mask.0.first_true_m64s(mask.1) < S::F64_LANES
    }

    #[inline(always)]
    fn inverse_power_of_two(self) -> Self {
        let simd = self.0;
        let field = simd.splat_u64s((2 * BIAS + 1) << 52);
        let bits = simd.and_u64s(simd.transmute_u64s_f64s(self.1), field);
        let inverse = simd.sub_u64s(simd.splat_u64s((2 * BIAS) << 52), bits);
        let inverse = Self(simd, simd.transmute_f64s_u64s(inverse));
        // As numbers, fields are in the order of their size, and one below zero has a sign.
        let least = self.same(f64::from_bits(1 << 52));
        let most = self.same(f64::from_bits((2 * BIAS - 1) << 52));
        inverse.max(least).min(most)
    }
}

/// To whole numbers below 2⁵² this adds as many units of the last place: 2⁵².
const SMALL: f64 = 4_503_599_627_370_496.0;

/// What [`Lanes::small`] has found.
pub(crate) fn small(x: f64) -> usize {
    let bits = x.to_bits() & u64::from(u32::MAX);
    usize::try_from(bits).expect("32 bits")
}

/// A whole number that was kept, or computed, among others.
#[expect(
    clippy::cast_possible_truncation,
    reason = "counts and places, whole or to be cut, from 0 to 2^53"
)]
pub(crate) fn whole(x: f64) -> u64 {
    // Machines have an instruction for signed numbers.
    (x as i64).cast_unsigned()
}

/// A vector of space, or one for each ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vec3<L> {
    pub(crate) x: L,
    pub(crate) y: L,
    pub(crate) z: L,
}

impl From<DVec3> for Vec3<f64> {
    #[inline(always)]
    fn from(v: DVec3) -> Self {
        Self { x: v.x, y: v.y, z: v.z }
    }
}

impl From<Vec3<f64>> for DVec3 {
    #[inline(always)]
    fn from(v: Vec3<f64>) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

impl<L: Lanes> Vec3<L> {
    /// The same vector for all rays that `like` has numbers for.
    #[inline(always)]
    pub(crate) fn same(like: L, v: DVec3) -> Self {
        Self { x: like.same(v.x), y: like.same(v.y), z: like.same(v.z) }
    }

    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> L {
        (self.x * other.x + self.y * other.y) + self.z * other.z
    }

    #[inline(always)]
    pub(crate) fn length(self) -> L {
        self.dot(self).sqrt()
    }

    /// The length of its first two components.
    #[inline(always)]
    pub(crate) fn across(self) -> L {
        (self.x * self.x + self.y * self.y).sqrt()
    }

    #[inline(always)]
    pub(crate) fn largest(self) -> L {
        self.x.abs().max(self.y.abs()).max(self.z.abs())
    }

    #[inline(always)]
    pub(crate) fn is_finite(self) -> L::Mask {
        self.x.is_finite() & self.y.is_finite() & self.z.is_finite()
    }

    #[inline(always)]
    pub(crate) fn scaled(self, by: L) -> Self {
        Self { x: self.x * by, y: self.y * by, z: self.z * by }
    }

    #[inline(always)]
    pub(crate) fn mapped(self, m: &DMat3) -> Self {
        Self {
            x: Self::same(self.x, DVec3::new(m.x_axis.x, m.y_axis.x, m.z_axis.x))
                .dot(self),
            y: Self::same(self.x, DVec3::new(m.x_axis.y, m.y_axis.y, m.z_axis.y))
                .dot(self),
            z: Self::same(self.x, DVec3::new(m.x_axis.z, m.y_axis.z, m.z_axis.z))
                .dot(self),
        }
    }
}

impl<L: Lanes> Add for Vec3<L> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<L: Lanes> Sub for Vec3<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::{Arch, WithSimd};

    struct Choose([f64; 2]);

    impl WithSimd for Choose {
        type Output = [f64; 2];

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> [f64; 2] {
            let [a, b] = self.0.map(|x| Vector(simd, simd.splat_f64s(x)));
            let first = |x: Vector<S>| {
                let mut numbers = [0.0; 8];
                S::as_mut_simd_f64s(&mut numbers).0[0] = x.1;
                numbers[0]
            };
            [first(a.min(b)), first(a.max(b))]
        }
    }

    #[test]
    fn small_numbers_are_read() {
        for x in [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.5, 2.999_999_9, 7.0, 2_147_483_647.5]
        {
            assert_eq!(small(x.small()) as u64, whole(x), "{x}");
        }
    }

    /// Bit by bit, for zeros with signs and for what is not a number too.
    #[test]
    fn vectors_choose_as_numbers_do() {
        let numbers = [0.0, -0.0, 1.5, -2.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
        for arch in [Arch::new(), Arch::Scalar] {
            for a in numbers {
                for b in numbers {
                    let found = arch.dispatch(Choose([a, b])).map(f64::to_bits);
                    let (least, most) = (Lanes::min(a, b), Lanes::max(a, b));
                    assert_eq!(found, [least.to_bits(), most.to_bits()], "{a} {b}");
                }
            }
        }
    }
}
