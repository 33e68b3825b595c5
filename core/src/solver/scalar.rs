//! The numbers that an elimination works with: real, and complex for the stages of Radau IIA.

use faer::c64;
use faer::traits::ComplexField;
use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real or complex number. Complex matrices are symmetric where real ones are, never Hermitian: nothing is
/// conjugated.
pub trait Scalar:
    ComplexField
    + Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + Sum
{
    /// Its reciprocal.
    fn inverse(self) -> Self;
    /// `self - a b`; with `FUSED`, which may be set only where the processor has fused multiply-add, rounded once.
    fn minus<const FUSED: bool>(self, a: Self, b: Self) -> Self;
    /// Whether it is neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// Its real part.
    fn real(self) -> f64;
    /// Its size: the absolute value, of a complex number the sum of those of its parts.
    fn size(self) -> f64;
}

impl Scalar for f64 {
    #[inline(always)]
    fn inverse(self) -> Self {
        1.0 / self
    }
    #[inline(always)]
    fn minus<const FUSED: bool>(self, a: Self, b: Self) -> Self {
        if FUSED { (-a).mul_add(b, self) } else { self - a * b }
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
    #[inline(always)]
    fn real(self) -> f64 {
        self
    }
    #[inline(always)]
    fn size(self) -> f64 {
        self.abs()
    }
}

impl Scalar for c64 {
    #[inline(always)]
    fn inverse(self) -> Self {
        self.inv()
    }
    #[inline(always)]
    fn minus<const FUSED: bool>(self, a: Self, b: Self) -> Self {
        c64 {
            re: self.re.minus::<FUSED>(a.re, b.re) + a.im * b.im,
            im: self.im.minus::<FUSED>(a.re, b.im) - a.im * b.re,
        }
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }
    #[inline(always)]
    fn real(self) -> f64 {
        self.re
    }
    #[inline(always)]
    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }
}
