//! Numbers that carry derivatives along.

use num_dual::{DualNum, DualStruct};
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number that carries derivatives along: what relations, markers and terms without closed derivatives are evaluated with.
///
/// Plain numbers are jets without derivatives, those of the crate `num_dual` have one or several of any order, and a
/// [`Gradient`](super::gradient::Gradient) has as many first ones as a vector register holds numbers.
///
/// ```
/// use num_dual::Dual64;
/// use ropewalk_core::Jet;
///
/// fn hypotenuse<S: Jet>(a: S, b: S) -> S {
///     (a * a + b * b).sqrt()
/// }
/// assert_eq!(hypotenuse(3.0, 4.0), 5.0);
/// assert!((hypotenuse(Dual64::new(3.0, 1.0), Dual64::from(4.0)).eps - 0.6).abs() < 1e-15);
/// ```
pub trait Jet:
    Copy
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + AddAssign<f64>
    + SubAssign<f64>
    + MulAssign<f64>
    + DivAssign<f64>
    + Sum
{
    /// The number itself.
    fn re(&self) -> f64;
    /// Nought.
    #[inline(always)]
    fn zero() -> Self {
        Self::from(0.0)
    }
    /// One.
    #[inline(always)]
    fn one() -> Self {
        Self::from(1.0)
    }
    /// `1/x`
    fn recip(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Whole power.
    fn powi(self, n: i32) -> Self;
    /// Any power.
    fn powf(self, n: f64) -> Self;
    /// `eˣ`
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Sine and cosine [of rad].
    fn sin_cos(self) -> (Self, Self);
    /// Sine [of rad].
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    /// Cosine [of rad].
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// Tangent [of rad].
    fn tan(self) -> Self;
    /// Arcsine [rad].
    fn asin(self) -> Self;
    /// Arccosine [rad].
    fn acos(self) -> Self;
    /// Arctangent [rad].
    fn atan(self) -> Self;
    /// The angle of the point `(x, self)` of the plane [rad].
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
}

macro_rules! as_they_are {
    ($($f:ident $(($n:ident: $t:ty))?),*) => { $(
        #[inline(always)]
        fn $f(self $(, $n: $t)?) -> Self {
            DualNum::$f(&self $(, $n)?)
        }
    )* };
}

impl<T: DualNum<Primitive = f64> + Copy> Jet for T {
    #[inline(always)]
    fn re(&self) -> f64 {
        DualStruct::re(self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        DualNum::sin_cos(&self)
    }
    as_they_are!(recip, sqrt, powi(n: i32), powf(n: f64), exp, atan2(x: Self), ln, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh);
}
