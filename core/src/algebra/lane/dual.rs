//! Forward differentiation of kernels in one direction.

use super::Real;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number and its derivative in one direction, over any carrier: a kernel evaluated with it gives its own derivative.
///
/// [`Real::map`] knows no derivative of the function that it is given and makes it NaN; a kernel that is
/// differentiated does without.
///
/// ```
/// use ropewalk_core::Dual;
/// // x³ at 2, with its derivative
/// let x = Dual::new(2.0, 1.0);
/// let y = x * x * x;
/// assert_eq!((y.re, y.eps), (8.0, 12.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<R> {
    /// The number.
    pub re: R,
    /// Its derivative.
    pub eps: R,
}

impl<R: Real> Dual<R> {
    /// A number that changes at this rate.
    #[inline(always)]
    pub fn new(re: R, eps: R) -> Self {
        Dual { re, eps }
    }
    /// A number that doesn't change.
    #[inline(always)]
    pub fn constant(re: R) -> Self {
        Dual { re, eps: R::zero() }
    }
    /// Numbers that don't change.
    #[inline(always)]
    pub fn constants<const N: usize>(x: &[R; N]) -> [Self; N] {
        let mut out = [Self::zero(); N];
        for i in 0..N {
            out[i].re = x[i];
        }
        out
    }
}

impl<R: Real> Add for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, r: Self) -> Self {
        Dual { re: self.re + r.re, eps: self.eps + r.eps }
    }
}
impl<R: Real> Sub for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, r: Self) -> Self {
        Dual { re: self.re - r.re, eps: self.eps - r.eps }
    }
}
impl<R: Real> Mul for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, r: Self) -> Self {
        Dual { re: self.re * r.re, eps: self.re.fma(r.eps, self.eps * r.re) }
    }
}
impl<R: Real> Div for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, r: Self) -> Self {
        let re = self.re / r.re;
        Dual { re, eps: (self.eps - re * r.eps) / r.re }
    }
}
impl<R: Real> Neg for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Dual { re: -self.re, eps: -self.eps }
    }
}
impl<R: Real> AddAssign for Dual<R> {
    #[inline(always)]
    fn add_assign(&mut self, r: Self) {
        *self = *self + r;
    }
}
impl<R: Real> SubAssign for Dual<R> {
    #[inline(always)]
    fn sub_assign(&mut self, r: Self) {
        *self = *self - r;
    }
}

impl<R: Real> Real for Dual<R> {
    const LANES: usize = R::LANES;
    #[inline(always)]
    fn of(x: f64) -> Self {
        Dual::constant(R::of(x))
    }
    #[inline(always)]
    fn each(f: impl FnMut(usize) -> f64) -> Self {
        Dual::constant(R::each(f))
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.re.lane(lane)
    }
    #[inline(always)]
    fn read(from: &[f64]) -> Self {
        Dual::constant(R::read(from))
    }
    #[inline(always)]
    fn write(self, to: &mut [f64]) {
        self.re.write(to);
    }
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        Dual { re: self.re.fma(a.re, b.re), eps: self.re.fma(a.eps, self.eps.fma(a.re, b.eps)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let re = self.re.sqrt();
        Dual { re, eps: self.eps / (re + re) }
    }
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Dual { re: self.re.map(f), eps: R::of(f64::NAN) }
    }
    #[inline(always)]
    fn if_gt(self, limit: Self, yes: Self, no: Self) -> Self {
        Dual { re: self.re.if_gt(limit.re, yes.re, no.re), eps: self.re.if_gt(limit.re, yes.eps, no.eps) }
    }
    #[inline(always)]
    fn all_gt(self, limit: Self) -> bool {
        self.re.all_gt(limit.re)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Any formula over the carrier.
    fn formula<R: Real>(x: R) -> R {
        let y = (x * x + R::of(2.0)).sqrt() / (R::of(3.0) - x);
        y.if_gt(R::of(0.1), y.fma(x, -x), x) - y
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for x in [-0.7, 0.3, 1.9] {
            let exact = formula(Dual::new(x, 1.0));
            let numeric = crate::testing::difference(|h| vec![formula(x + h)])[0];
            approx::assert_relative_eq!(exact.re, formula(x), max_relative = 1e-15);
            approx::assert_relative_eq!(exact.eps, numeric, max_relative = 1e-9);
            let second = formula(Dual::new(Dual::new(x, 1.0), Dual::constant(1.0))).eps.eps;
            let numeric = crate::testing::difference(|h| vec![formula(Dual::new(x + h, 1.0)).eps])[0];
            approx::assert_relative_eq!(second, numeric, max_relative = 1e-8);
        }
    }

    #[test]
    fn what_has_no_derivative_is_not_a_number() {
        assert!(Dual::new(1.0, 1.0).map(f64::ln).eps.is_nan());
    }
}
