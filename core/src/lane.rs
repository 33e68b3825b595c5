//! One arithmetic trait and its carriers: the same kernel source runs one element or eight at once.
//!
//! [`Real`] is implemented by `f64` and by [`Pack`], an array of lanes that the compiler turns into vector
//! instructions when the kernel is entered through [`run`]. Everything that a kernel calls must be
//! `#[inline(always)]`: the processor features of the door reach only what is inlined behind it.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Three components of a vector in space.
pub type V3<R> = [R; 3];

/// A real number, or several side by side.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Send
    + Sync
    + 'static
{
    /// How many numbers one value carries.
    const LANES: usize;
    /// The same number in every lane.
    fn of(x: f64) -> Self;
    /// One number per lane, `f(lane)`.
    fn each(f: impl FnMut(usize) -> f64) -> Self;
    /// The number in one lane.
    fn lane(self, lane: usize) -> f64;
    /// `self * a + b`, fused where the processor does it for free.
    fn fma(self, a: Self, b: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// A function of one number, lane by lane. Not vectorised: for the odd logarithm.
    fn map(self, f: impl Fn(f64) -> f64) -> Self;
    /// `yes` where `self > limit`, else `no`, lane by lane.
    fn if_gt(self, limit: Self, yes: Self, no: Self) -> Self;
    /// Absolute value.
    #[inline(always)]
    fn abs(self) -> Self {
        self.if_gt(Self::zero(), self, -self)
    }
    /// Nought.
    #[inline(always)]
    fn zero() -> Self {
        Self::of(0.0)
    }
}

impl Real for f64 {
    const LANES: usize = 1;
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn each(mut f: impl FnMut(usize) -> f64) -> Self {
        f(0)
    }
    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        // without the instruction, mul_add is a slow library call
        if cfg!(target_feature = "fma") { self.mul_add(a, b) } else { self * a + b }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        f(self)
    }
    #[inline(always)]
    fn if_gt(self, limit: Self, yes: Self, no: Self) -> Self {
        if self > limit { yes } else { no }
    }
}

/// `N` numbers side by side. `FUSED` may be true only behind a door that enables fused multiply-add.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Pack<const N: usize, const FUSED: bool>(pub [f64; N]);

macro_rules! lanewise {
    ($tr:ident, $f:ident, $op:tt) => {
        impl<const N: usize, const F: bool> $tr for Pack<N, F> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, r: Self) -> Self {
                let mut o = [0.0; N];
                for i in 0..N {
                    o[i] = self.0[i] $op r.0[i];
                }
                Pack(o)
            }
        }
    };
}
lanewise!(Add, add, +);
lanewise!(Sub, sub, -);
lanewise!(Mul, mul, *);
lanewise!(Div, div, /);

impl<const N: usize, const F: bool> Neg for Pack<N, F> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Pack(self.0.map(|x| -x))
    }
}
impl<const N: usize, const F: bool> AddAssign for Pack<N, F> {
    #[inline(always)]
    fn add_assign(&mut self, r: Self) {
        *self = *self + r;
    }
}
impl<const N: usize, const F: bool> SubAssign for Pack<N, F> {
    #[inline(always)]
    fn sub_assign(&mut self, r: Self) {
        *self = *self - r;
    }
}

impl<const N: usize, const F: bool> Real for Pack<N, F> {
    const LANES: usize = N;
    #[inline(always)]
    fn of(x: f64) -> Self {
        Pack([x; N])
    }
    #[inline(always)]
    fn each(f: impl FnMut(usize) -> f64) -> Self {
        Pack(std::array::from_fn(f))
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.0[lane]
    }
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        let mut o = [0.0; N];
        for i in 0..N {
            o[i] = if F { self.0[i].mul_add(a.0[i], b.0[i]) } else { self.0[i] * a.0[i] + b.0[i] };
        }
        Pack(o)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let mut o = [0.0; N];
        for i in 0..N {
            o[i] = self.0[i].sqrt();
        }
        Pack(o)
    }
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Pack(self.0.map(f))
    }
    #[inline(always)]
    fn if_gt(self, limit: Self, yes: Self, no: Self) -> Self {
        let mut o = [0.0; N];
        for i in 0..N {
            o[i] = if self.0[i] > limit.0[i] { yes.0[i] } else { no.0[i] };
        }
        Pack(o)
    }
}

/// Scalar product.
#[inline(always)]
pub fn dot<R: Real>(a: &V3<R>, b: &V3<R>) -> R {
    a[0].fma(b[0], a[1].fma(b[1], a[2] * b[2]))
}

/// How many lanes a kernel runs over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Width {
    /// One element at a time; works everywhere, and the oracle of the others.
    One,
    /// Four elements at a time, with AVX2 and FMA.
    Four,
    /// Eight elements at a time, with AVX-512.
    Eight,
}

impl Width {
    /// The fastest width of the processor that the program runs on.
    pub fn best() -> Self {
        if has_avx512() {
            Width::Eight
        } else if has_avx2() {
            Width::Four
        } else {
            Width::One
        }
    }
}

/// Work that is generic over the carrier, so that [`run`] can choose it at run time.
pub trait LaneTask {
    /// Whether it is worth compiling for more than one lane. Each width is another copy of the code.
    const WIDE: bool = true;
    /// Does the work. Mark the implementation `#[inline(always)]`.
    fn go<R: Real>(self);
}

/// Runs a task over at most the given number of lanes: as many as the processor has instructions for.
pub fn run<T: LaneTask>(width: Width, task: T) {
    // decided while compiling: a narrow task has no wide copies
    if T::WIDE { wide(width, task) } else { task.go::<f64>() }
}

fn wide(width: Width, task: impl LaneTask) {
    match width {
        Width::Eight if has_avx512() => door::avx512(task),
        Width::Eight | Width::Four if has_avx2() => door::avx2(task),
        _ => task.go::<f64>(),
    }
}

#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}
#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("fma")
}
#[cfg(not(target_arch = "x86_64"))]
fn has_avx2() -> bool {
    false
}
#[cfg(not(target_arch = "x86_64"))]
fn has_avx512() -> bool {
    false
}

/// The whole of the project's unsafe code: two doors into code compiled for a newer processor.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod door {
    use super::{LaneTask, Pack, has_avx2, has_avx512};

    #[target_feature(enable = "avx2,fma")]
    fn inside_avx2(task: impl LaneTask) {
        task.go::<Pack<4, true>>();
    }
    #[target_feature(enable = "avx512f,avx512dq,avx512vl,fma")]
    fn inside_avx512(task: impl LaneTask) {
        task.go::<Pack<8, true>>();
    }
    pub fn avx2(task: impl LaneTask) {
        debug_assert!(has_avx2());
        // SAFETY: `run` comes here only where the running processor has these features
        unsafe { inside_avx2(task) }
    }
    pub fn avx512(task: impl LaneTask) {
        debug_assert!(has_avx512());
        // SAFETY: as above
        unsafe { inside_avx512(task) }
    }
}
#[cfg(not(target_arch = "x86_64"))]
mod door {
    use super::LaneTask;
    pub fn avx2(task: impl LaneTask) {
        task.go::<f64>();
    }
    pub fn avx512(task: impl LaneTask) {
        task.go::<f64>();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Sum<'a>(&'a [f64], &'a mut f64);
    impl LaneTask for Sum<'_> {
        #[inline(always)]
        fn go<R: Real>(self) {
            for chunk in self.0.chunks(R::LANES) {
                let x = R::each(|l| chunk.get(l).copied().unwrap_or(0.0));
                let y = x.fma(x, x.sqrt());
                *self.1 += (0..R::LANES).map(|l| y.lane(l)).sum::<f64>();
            }
        }
    }

    #[test]
    fn all_widths_agree() {
        let data: Vec<f64> = (0..21).map(f64::from).collect();
        let exact: f64 = data.iter().map(|x| x * x + x.sqrt()).sum();
        for width in [Width::One, Width::Four, Width::Eight, Width::best()] {
            let mut sum = 0.0;
            run(width, Sum(&data, &mut sum));
            approx::assert_relative_eq!(sum, exact, max_relative = 1e-14);
        }
    }
}
