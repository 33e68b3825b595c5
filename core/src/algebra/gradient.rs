//! Derivatives in several directions at once, and the tangents that they make.

use super::jet::Jet;
use super::lane::{LaneTask, Real, Width, run};
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number with its derivatives in as many directions as its carrier has lanes.
///
/// What a function of it decides and looks up is done once for all of them.
#[derive(Clone, Copy, Debug)]
pub struct Gradient<R> {
    /// The number.
    pub re: f64,
    /// Its derivatives, lane by lane.
    pub eps: R,
}

impl<R: Real> Gradient<R> {
    /// A function of it, from its value and its slope there.
    #[inline(always)]
    fn chain(self, re: f64, slope: f64) -> Self {
        Gradient { re, eps: self.eps * R::of(slope) }
    }
}

impl<R: Real> From<f64> for Gradient<R> {
    #[inline(always)]
    fn from(re: f64) -> Self {
        Gradient { re, eps: R::zero() }
    }
}
impl<R: Real> Neg for Gradient<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Gradient { re: -self.re, eps: -self.eps }
    }
}
impl<R: Real> Add for Gradient<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, r: Self) -> Self {
        Gradient { re: self.re + r.re, eps: self.eps + r.eps }
    }
}
impl<R: Real> Sub for Gradient<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, r: Self) -> Self {
        Gradient { re: self.re - r.re, eps: self.eps - r.eps }
    }
}
impl<R: Real> Mul for Gradient<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, r: Self) -> Self {
        Gradient { re: self.re * r.re, eps: self.eps.fma(R::of(r.re), r.eps * R::of(self.re)) }
    }
}
impl<R: Real> Div for Gradient<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, r: Self) -> Self {
        let (inverse, re) = (1.0 / r.re, self.re / r.re);
        Gradient { re, eps: r.eps.fma(R::of(-re), self.eps) * R::of(inverse) }
    }
}
impl<R: Real> Add<f64> for Gradient<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, r: f64) -> Self {
        Gradient { re: self.re + r, ..self }
    }
}
impl<R: Real> Sub<f64> for Gradient<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, r: f64) -> Self {
        Gradient { re: self.re - r, ..self }
    }
}
impl<R: Real> Mul<f64> for Gradient<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, r: f64) -> Self {
        self.chain(self.re * r, r)
    }
}
impl<R: Real> Div<f64> for Gradient<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, r: f64) -> Self {
        self.chain(self.re / r, 1.0 / r)
    }
}
macro_rules! assigns {
    ($($tr:ident $f:ident $op:tt),*) => { $(
        impl<R: Real> $tr for Gradient<R> {
            #[inline(always)]
            fn $f(&mut self, r: Self) {
                *self = *self $op r;
            }
        }
        impl<R: Real> $tr<f64> for Gradient<R> {
            #[inline(always)]
            fn $f(&mut self, r: f64) {
                *self = *self $op r;
            }
        }
    )* };
}
assigns!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *, DivAssign div_assign /);
impl<R: Real> Sum for Gradient<R> {
    #[inline(always)]
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::from(0.0), |sum, x| sum + x)
    }
}

impl<R: Real> Jet for Gradient<R> {
    #[inline(always)]
    fn re(&self) -> f64 {
        self.re
    }
    #[inline(always)]
    fn recip(self) -> Self {
        let y = 1.0 / self.re;
        self.chain(y, -y * y)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let y = self.re.sqrt();
        self.chain(y, 0.5 / y)
    }
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        // x⁰ has slope 0 everywhere
        let slope = if n == 0 { 0.0 } else { f64::from(n) * self.re.powi(n - 1) };
        self.chain(self.re.powi(n), slope)
    }
    #[inline(always)]
    fn powf(self, n: f64) -> Self {
        let slope = if n == 0.0 { 0.0 } else { n * self.re.powf(n - 1.0) };
        self.chain(self.re.powf(n), slope)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let y = self.re.exp();
        self.chain(y, y)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.re.ln(), 1.0 / self.re)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.re.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }
    #[inline(always)]
    fn tan(self) -> Self {
        let y = self.re.tan();
        self.chain(y, 1.0 + y * y)
    }
    #[inline(always)]
    fn asin(self) -> Self {
        self.chain(self.re.asin(), 1.0 / (1.0 - self.re * self.re).sqrt())
    }
    #[inline(always)]
    fn acos(self) -> Self {
        self.chain(self.re.acos(), -1.0 / (1.0 - self.re * self.re).sqrt())
    }
    #[inline(always)]
    fn atan(self) -> Self {
        self.chain(self.re.atan(), 1.0 / (1.0 + self.re * self.re))
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let square = self.re * self.re + x.re * x.re;
        self.chain(self.re.atan2(x.re), x.re / square) + x.chain(0.0, -self.re / square)
    }
    #[inline(always)]
    fn sinh(self) -> Self {
        self.chain(self.re.sinh(), self.re.cosh())
    }
    #[inline(always)]
    fn cosh(self) -> Self {
        self.chain(self.re.cosh(), self.re.sinh())
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        let y = self.re.tanh();
        self.chain(y, 1.0 - y * y)
    }
}

/// `N` residuals of `N` unknowns or fewer, over any carrier: what [`tangent`] differentiates.
///
/// What it calls is to be `#[inline(always)]`, without closures, for the registers of the processor to serve.
pub trait Residuals<const N: usize> {
    /// Evaluates them.
    fn eval<S: Jet>(&self, seeds: &impl Seeds<S>) -> [S; N];
}

/// What makes numbers that change with unknowns.
pub trait Seeds<S> {
    /// The number `x`, which changes by `w` with unknown `i`.
    fn of(&self, i: usize, x: f64, w: f64) -> S;
}

/// Unknowns from here on, one in each lane.
struct Lanes(usize);

impl<R: Real> Seeds<Gradient<R>> for Lanes {
    #[inline(always)]
    fn of(&self, i: usize, re: f64, w: f64) -> Gradient<R> {
        let mut eps = [0.0; MOST_LANES];
        if (self.0..self.0 + R::LANES).contains(&i) {
            eps[i - self.0] = w;
        }
        Gradient { re, eps: R::read(&eps) }
    }
}

/// Sets the first `n` rows and columns of `block` to the derivatives of residuals, row by row, by the first `n` unknowns.
///
/// ```
/// use ropewalk_core::{Jet, Residuals, Seeds, tangent};
///
/// /// `x y` and `x + 3 y`
/// struct Both([f64; 2]);
/// impl Residuals<2> for Both {
///     #[inline(always)]
///     fn eval<S: Jet>(&self, seeds: &impl Seeds<S>) -> [S; 2] {
///         let (x, y) = (seeds.of(0, self.0[0], 1.0), seeds.of(1, self.0[1], 1.0));
///         [x * y, x + y * 3.0]
///     }
/// }
/// let mut block = [[0.0; 2]; 2];
/// tangent(&Both([5.0, 7.0]), 2, &mut block);
/// assert_eq!(block, [[7.0, 5.0], [1.0, 3.0]]);
/// ```
pub fn tangent<const N: usize>(residuals: &impl Residuals<N>, n: usize, block: &mut [[f64; N]; N]) {
    run(Width::best(), Tangent { residuals, n, block });
}

struct Tangent<'a, F, const N: usize> {
    residuals: &'a F,
    n: usize,
    block: &'a mut [[f64; N]; N],
}

impl<F: Residuals<N>, const N: usize> LaneTask for Tangent<'_, F, N> {
    #[inline(always)]
    fn go<R: Real>(self) {
        for first in (0..self.n).step_by(R::LANES) {
            let columns: [Gradient<R>; N] = self.residuals.eval(&Lanes(first));
            let (mut lanes, count) = ([0.0; MOST_LANES], R::LANES.min(self.n - first));
            for (row, column) in self.block.iter_mut().zip(&columns).take(self.n) {
                column.eps.write(&mut lanes);
                row[first..first + count].copy_from_slice(&lanes[..count]);
            }
        }
    }
}

/// Lanes of the widest carrier.
const MOST_LANES: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::difference;

    /// Every function of a jet, one by one.
    fn all<S: Jet>(x: S, y: S) -> [S; 16] {
        let (sin, cos) = x.sin_cos();
        let mut z = x;
        z += y;
        z *= 1.5;
        z -= 0.25;
        z /= y;
        z /= 0.8;
        [
            x * y,
            x / y,
            (x - y) * 2.0 + z,
            (-x + 1.0) / 3.0 + x.sinh() * y.cosh(),
            x.recip() - y,
            x.sqrt(),
            x.powi(3) + y.powi(-2) + x.powi(0),
            x.powf(1.7) + y.powf(0.0),
            y.exp(),
            x.ln(),
            sin * y + cos,
            x.tan() + y.sin() * x.cos(),
            x.asin() * y,
            y.acos(),
            (x * y).atan() + x.atan2(-y),
            [x, y, x * x].into_iter().sum::<S>().tanh(),
        ]
    }

    struct All([f64; 2]);
    impl Residuals<16> for All {
        fn eval<S: Jet>(&self, seeds: &impl Seeds<S>) -> [S; 16] {
            all(seeds.of(0, self.0[0], 1.0), seeds.of(9, self.0[1], -2.0))
        }
    }

    #[test]
    fn every_function_has_its_derivative_in_every_direction() {
        let [x, y] = [0.61, 0.37];
        let by_x = difference(|h| all(x + h, y).to_vec());
        let by_y = difference(|h| all(x, y + h).to_vec());
        for width in [Width::One, Width::Four, Width::Eight] {
            let mut block = [[f64::NAN; 16]; 16];
            run(width, Tangent { residuals: &All([x, y]), n: 10, block: &mut block });
            for (i, row) in block.iter().enumerate().take(10) {
                approx::assert_relative_eq!(row[0], by_x[i], max_relative = 1e-9, epsilon = 1e-9);
                approx::assert_relative_eq!(row[9], -2.0 * by_y[i], max_relative = 1e-9, epsilon = 1e-9);
                assert!(row[1..9].iter().all(|x| *x == 0.0) && row[10..].iter().all(|x| x.is_nan()));
            }
            assert!(block[10..].iter().flatten().all(|x| x.is_nan()));
        }
        // the rows behind aren't asked for: what is left of the functions, one direction at a time
        let dual = all(num_dual::Dual64::new(x, 1.0), num_dual::Dual64::from(y));
        let own = all(Gradient { re: x, eps: 1.0 }, Gradient { re: y, eps: 0.0 });
        for (dual, own) in dual.iter().zip(own) {
            approx::assert_relative_eq!(dual.re, own.re, max_relative = 1e-15);
            approx::assert_relative_eq!(dual.eps, own.eps, max_relative = 1e-13);
        }
    }
}
