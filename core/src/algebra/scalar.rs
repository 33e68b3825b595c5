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
    /// Eight numbers side by side, as vector registers hold them.
    type Eight: Copy;
    /// The first eight of a slice.
    fn eight(from: &[Self]) -> Self::Eight;
    /// Writes eight numbers to the beginning of a slice.
    fn write(eight: &Self::Eight, to: &mut [Self]);
    /// `eight -= a b`, as [`Scalar::minus`].
    fn eight_minus<const FUSED: bool>(eight: &mut Self::Eight, a: Self, b: &Self::Eight);
    /// Its size: the absolute value, of a complex number the sum of those of its parts.
    fn size(self) -> f64;
}

impl Scalar for f64 {
    type Eight = [f64; 8];
    #[inline(always)]
    fn eight(from: &[Self]) -> [f64; 8] {
        let mut eight = [0.0; 8];
        eight.copy_from_slice(&from[..8]);
        eight
    }
    #[inline(always)]
    fn write(eight: &[f64; 8], to: &mut [Self]) {
        to[..8].copy_from_slice(eight);
    }
    #[inline(always)]
    fn eight_minus<const FUSED: bool>(eight: &mut [f64; 8], a: Self, b: &[f64; 8]) {
        for i in 0..8 {
            eight[i] = eight[i].minus::<FUSED>(a, b[i]);
        }
    }
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
    /// Real parts and imaginary parts.
    type Eight = [[f64; 8]; 2];
    #[inline(always)]
    fn eight(from: &[Self]) -> [[f64; 8]; 2] {
        // a closure would not be compiled for the processor's vectors
        let (from, mut eight) = (&from[..8], [[0.0; 8]; 2]);
        for i in 0..8 {
            (eight[0][i], eight[1][i]) = (from[i].re, from[i].im);
        }
        eight
    }
    #[inline(always)]
    fn write([re, im]: &[[f64; 8]; 2], to: &mut [Self]) {
        let to = &mut to[..8];
        for i in 0..8 {
            to[i] = c64 { re: re[i], im: im[i] };
        }
    }
    #[inline(always)]
    fn eight_minus<const FUSED: bool>([re, im]: &mut [[f64; 8]; 2], a: Self, b: &[[f64; 8]; 2]) {
        for i in 0..8 {
            re[i] = re[i].minus::<FUSED>(a.re, b[0][i]).minus::<FUSED>(-a.im, b[1][i]);
        }
        for i in 0..8 {
            im[i] = im[i].minus::<FUSED>(a.re, b[1][i]).minus::<FUSED>(a.im, b[0][i]);
        }
    }
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
