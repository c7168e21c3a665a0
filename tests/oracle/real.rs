//! Numbers of 200 bits, and vectors and affine maps of them.

use std::borrow::Borrow;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use glam::{DAffine3, DVec3};

/// How many bits a number has.
const BITS: usize = 200;

/// A number of 200 bits: 44 decimal digits more than an `f64`.
#[derive(Clone, Debug)]
pub(crate) struct Real(Float);

type Float = FBig<HalfEven, 2>;

impl Real {
    /// The number itself.
    pub(crate) fn exact(x: f64) -> Self {
        // Zero is added to make a negative zero positive.
        let number = Float::try_from(x + 0.0).expect("the number is finite");
        Self(number.with_precision(BITS).value())
    }

    /// The number closest to it.
    pub(crate) fn rounded(&self) -> f64 {
        self.0.to_f64().value()
    }

    pub(crate) fn sqrt(&self) -> Self {
        if self.is_zero() { self.clone() } else { Self(self.0.sqrt()) }
    }

    pub(crate) fn squared(&self) -> Self {
        self * self
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.0.repr().significand().is_zero()
    }

    pub(crate) fn is_negative(&self) -> bool {
        !self.is_zero() && self.0 < Float::ZERO
    }

    pub(crate) fn is_positive(&self) -> bool {
        !self.is_zero() && !self.is_negative()
    }
}

impl From<f64> for Real {
    fn from(x: f64) -> Self {
        Self::exact(x)
    }
}

macro_rules! operator {
    ($operator:ident, $method:ident) => {
        impl<R: Borrow<Real>> $operator<R> for Real {
            type Output = Self;
            fn $method(self, other: R) -> Self {
                Self((&self.0).$method(&other.borrow().0))
            }
        }

        impl<R: Borrow<Real>> $operator<R> for &Real {
            type Output = Real;
            fn $method(self, other: R) -> Real {
                Real((&self.0).$method(&other.borrow().0))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Real {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl PartialEq for Real {
    fn eq(&self, other: &Self) -> bool {
        (self - other).is_zero()
    }
}

impl PartialOrd for Real {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        let difference = self - other;
        Some(difference.is_positive().cmp(&difference.is_negative()))
    }
}

/// A point, a direction or a normal.
#[derive(Clone, Debug)]
pub(crate) struct Vector(pub(crate) [Real; 3]);

impl Vector {
    pub(crate) fn exact(v: DVec3) -> Self {
        Self(v.to_array().map(Real::exact))
    }

    pub(crate) fn rounded(&self) -> DVec3 {
        DVec3::from_array(self.0.each_ref().map(Real::rounded))
    }

    pub(crate) fn dot(&self, other: &Self) -> Real {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        a * x + b * y + c * z
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| &self.0[i] + &other.0[i]))
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| &self.0[i] - &other.0[i]))
    }

    pub(crate) fn times(&self, factor: &Real) -> Self {
        Self(self.0.each_ref().map(|x| x * factor))
    }

    pub(crate) fn cross(&self, other: &Self) -> Self {
        let (a, b) = (&self.0, &other.0);
        let turn = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
        Self([turn(1, 2), turn(2, 0), turn(0, 1)])
    }

    pub(crate) fn length(&self) -> Real {
        self.dot(self).sqrt()
    }
}

/// An affine map, kept by the columns of its linear part.
#[derive(Clone, Debug)]
pub(crate) struct Map {
    pub(crate) columns: [Vector; 3],
    pub(crate) offset: Vector,
}

impl Map {
    pub(crate) fn exact(map: &DAffine3) -> Self {
        let m = map.matrix3;
        Self {
            columns: [m.x_axis, m.y_axis, m.z_axis].map(Vector::exact),
            offset: Vector::exact(map.translation),
        }
    }

    /// The image of a direction.
    pub(crate) fn direction(&self, v: &Vector) -> Vector {
        let [x, y, z] = &v.0;
        let [a, b, c] = &self.columns;
        a.times(x).plus(&b.times(y)).plus(&c.times(z))
    }

    /// The image of a point.
    pub(crate) fn point(&self, p: &Vector) -> Vector {
        self.direction(p).plus(&self.offset)
    }

    /// First `inner`, then this one.
    pub(crate) fn after(&self, inner: &Self) -> Self {
        Self {
            columns: inner.columns.each_ref().map(|column| self.direction(column)),
            offset: self.point(&inner.offset),
        }
    }

    /// The rows of the inverse of the linear part: cross products of its columns.
    pub(crate) fn inverse_rows(&self) -> [Vector; 3] {
        let [a, b, c] = &self.columns;
        let rows = [b.cross(c), c.cross(a), a.cross(b)];
        let determinant = rows[0].dot(a);
        rows.map(|row| row.times(&(Real::exact(1.0) / &determinant)))
    }
}
