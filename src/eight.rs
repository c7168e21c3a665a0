//! Eight single-precision numbers side by side, for what only sorts out.
//!
//! Boxes and triangles are first looked at in single precision: what is passed by there with
//! room for all rounding is passed by, and the rest is left to double precision. So it does
//! not matter for any answer how wide the machine's vectors are; eight numbers are one
//! vector of AVX, or two of SSE or Neon.
//!
//! As with [`lanes`](crate::lanes), whatever works on these is `inline(always)`, and there
//! are no closures.

use std::ops::{Add, Div, Mul, Sub};

use pulp::{NullaryFnOnce, Scalar256b, Simd};

/// How many there are.
pub(crate) const EIGHT: usize = 8;

/// A machine with vectors of eight such numbers.
pub(crate) trait Eight: Simd {
    /// A bit for each truth, the first one lowest.
    fn bits(self, truths: Self::m32s) -> u32;
}

impl Eight for Scalar256b {
    #[inline(always)]
    fn bits(self, truths: Self::m32s) -> u32 {
        let ones = self.select_u32s(truths, self.splat_u32s(1), self.splat_u32s(0));
        let ones: [u32; EIGHT] = pulp::cast(ones);
        let mut bits = 0;
        for (i, one) in ones.into_iter().enumerate() {
            bits |= one << i;
        }
        bits
    }
}

#[cfg(target_arch = "x86_64")]
impl Eight for pulp::x86::V3 {
    #[inline(always)]
    fn bits(self, truths: Self::m32s) -> u32 {
        self.avx._mm256_movemask_ps(pulp::cast(truths)).cast_unsigned()
    }
}

/// What is to be done with such numbers.
pub(crate) trait WithEight {
    type Output;

    fn with_eight<S: Eight>(self, simd: S) -> Self::Output;
}

/// Does it as fast as the machine can.
#[inline(always)]
pub(crate) fn with_eight<Op: WithEight>(op: Op) -> Op::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(On(op, simd));
    }
    op.with_eight(Scalar256b)
}

#[cfg(target_arch = "x86_64")]
struct On<Op, S>(Op, S);

#[cfg(target_arch = "x86_64")]
impl<Op: WithEight, S: Eight> NullaryFnOnce for On<Op, S> {
    type Output = Op::Output;

    #[inline(always)]
    fn call(self) -> Op::Output {
        self.0.with_eight(self.1)
    }
}

/// The numbers.
#[derive(Clone, Copy)]
pub(crate) struct Numbers<S: Eight>(S, S::f32s);

macro_rules! operator {
    ($name:ident, $method:ident, $of_simd:ident) => {
        impl<S: Eight> $name for Numbers<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0, self.0.$of_simd(self.1, other.1))
            }
        }
    };
}

operator!(Add, add, add_f32s);
operator!(Sub, sub, sub_f32s);
operator!(Mul, mul, mul_f32s);
operator!(Div, div, div_f32s);

impl<S: Eight> Numbers<S> {
    #[inline(always)]
    pub(crate) fn load(simd: S, numbers: &[f32; EIGHT]) -> Self {
        let (vectors, _) = S::as_simd_f32s(numbers);
        Self(simd, vectors[0])
    }

    #[inline(always)]
    pub(crate) fn same(simd: S, number: f32) -> Self {
        Self(simd, simd.splat_f32s(number))
    }

    #[inline(always)]
    pub(crate) fn store(self) -> [f32; EIGHT] {
        let mut numbers = [0.0; EIGHT];
        let (vectors, _) = S::as_mut_simd_f32s(&mut numbers);
        vectors[0] = self.1;
        numbers
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        let all_but_sign = self.0.splat_f32s(f32::from_bits(0x7fff_ffff));
        Self(self.0, self.0.and_f32s(self.1, all_but_sign))
    }

    #[inline(always)]
    pub(crate) fn min(self, other: Self) -> Self {
        Self(self.0, self.0.min_f32s(self.1, other.1))
    }

    #[inline(always)]
    pub(crate) fn max(self, other: Self) -> Self {
        Self(self.0, self.0.max_f32s(self.1, other.1))
    }

    /// A bit for each number that is smaller, the first one lowest.
    #[inline(always)]
    pub(crate) fn less(self, other: Self) -> u32 {
        self.0.bits(self.0.less_than_f32s(self.1, other.1))
    }
}
