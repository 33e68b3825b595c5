//! One arithmetic trait and its carriers: the same kernel source runs one element or eight at once.
//!
//! [`Real`] is implemented by `f64`, by [`Pack`] (plain arrays, for any processor), and by the vector registers of
//! newer processors, which no code can name: a kernel meets them only where [`run`] has found them. Everything that a
//! kernel calls must be `#[inline(always)]`, closures in hot places avoided: the processor features of the door
//! reach only what is inlined behind it.

mod dual;

pub use dual::Dual;

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
    /// Four values from the four numbers that each lane has side by side in memory: `f(lane)`.
    #[inline(always)]
    fn from_rows(f: impl Fn(usize) -> [f64; 4]) -> [Self; 4] {
        [Self::each(|l| f(l)[0]), Self::each(|l| f(l)[1]), Self::each(|l| f(l)[2]), Self::each(|l| f(l)[3])]
    }
    /// The way back: hands `f` each lane with its four numbers.
    #[inline(always)]
    fn to_rows(values: [Self; 4], mut f: impl FnMut(usize, [f64; 4])) {
        for l in 0..Self::LANES {
            f(l, [values[0].lane(l), values[1].lane(l), values[2].lane(l), values[3].lane(l)]);
        }
    }
    /// One number per lane, from the front of a slice.
    fn read(from: &[f64]) -> Self;
    /// Writes one number per lane to the front of a slice.
    fn write(self, to: &mut [f64]);
    /// `self * a + b`, fused where the processor does it for free.
    fn fma(self, a: Self, b: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// A function of one number, lane by lane. Not vectorised: for the odd logarithm.
    fn map(self, f: impl Fn(f64) -> f64) -> Self;
    /// `yes` where `self > limit`, else `no`, lane by lane.
    fn if_gt(self, limit: Self, yes: Self, no: Self) -> Self;
    /// Whether `self > limit` in all lanes; not where one holds no number.
    fn all_gt(self, limit: Self) -> bool;
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
    fn read(from: &[f64]) -> Self {
        from[0]
    }
    #[inline(always)]
    fn write(self, to: &mut [f64]) {
        to[0] = self;
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
    #[inline(always)]
    fn all_gt(self, limit: Self) -> bool {
        self > limit
    }
}

/// `N` numbers side by side, for any processor.
#[derive(Clone, Copy, Debug)]
pub struct Pack<const N: usize>(pub [f64; N]);

macro_rules! lanewise {
    ($tr:ident, $f:ident, $op:tt) => {
        impl<const N: usize> $tr for Pack<N> {
            type Output = Self;
            #[inline(always)]
            fn $f(mut self, r: Self) -> Self {
                for i in 0..N {
                    self.0[i] $op r.0[i];
                }
                self
            }
        }
    };
}
lanewise!(Add, add, +=);
lanewise!(Sub, sub, -=);
lanewise!(Mul, mul, *=);
lanewise!(Div, div, /=);

impl<const N: usize> Neg for Pack<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Pack(self.0.map(|x| -x))
    }
}
impl<const N: usize> AddAssign for Pack<N> {
    #[inline(always)]
    fn add_assign(&mut self, r: Self) {
        *self = *self + r;
    }
}
impl<const N: usize> SubAssign for Pack<N> {
    #[inline(always)]
    fn sub_assign(&mut self, r: Self) {
        *self = *self - r;
    }
}

impl<const N: usize> Real for Pack<N> {
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
    fn read(from: &[f64]) -> Self {
        Self::each(|i| from[i])
    }
    #[inline(always)]
    fn write(self, to: &mut [f64]) {
        to[..N].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Pack(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Pack(self.0.map(f))
    }
    #[inline(always)]
    fn if_gt(self, limit: Self, yes: Self, no: Self) -> Self {
        Self::each(|i| if self.0[i] > limit.0[i] { yes.0[i] } else { no.0[i] })
    }
    #[inline(always)]
    fn all_gt(self, limit: Self) -> bool {
        self.0.iter().zip(&limit.0).all(|(x, limit)| x > limit)
    }
}

/// Scalar product.
///
/// ```
/// assert_eq!(ropewalk_core::dot(&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0]), 32.0);
/// ```
#[inline(always)]
pub fn dot<R: Real>(a: &V3<R>, b: &V3<R>) -> R {
    a[0].fma(b[0], a[1].fma(b[1], a[2] * b[2]))
}

/// `s a`
///
/// ```
/// assert_eq!(ropewalk_core::scaled(2.0, &[1.0, -1.0, 0.5]), [2.0, -2.0, 1.0]);
/// ```
#[inline(always)]
pub fn scaled<R: Real>(s: R, a: &V3<R>) -> V3<R> {
    [s * a[0], s * a[1], s * a[2]]
}

/// How many lanes a kernel runs over.
///
/// ```
/// use ropewalk_core::Width;
/// assert_eq!(Width::Four.lanes(), 4);
/// assert!(Width::best().lanes() >= 1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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

    /// The width to work on so many elements with: no wider than takes them all at once.
    ///
    /// ```
    /// use ropewalk_core::Width;
    /// assert_eq!(Width::Eight.enough_for(3), Width::Four);
    /// assert_eq!(Width::Eight.enough_for(20), Width::Eight);
    /// ```
    pub fn enough_for(self, count: usize) -> Self {
        if self == Width::Eight && count <= Width::Four.lanes() { Width::Four } else { self }
    }

    /// How many elements it evaluates at a time.
    pub fn lanes(self) -> usize {
        match self {
            Width::One => 1,
            Width::Four => 4,
            Width::Eight => 8,
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

#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod door;
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

    struct Turn<'a>(&'a [[f64; 4]; 8], &'a mut [[f64; 4]; 8]);
    impl LaneTask for Turn<'_> {
        #[inline(always)]
        fn go<R: Real>(self) {
            for first in (0..8).step_by(R::LANES) {
                let values = R::from_rows(|l| self.0[first + l]);
                for (i, v) in values.iter().enumerate() {
                    assert_eq!(v.lane(R::LANES - 1), self.0[first + R::LANES - 1][i]);
                }
                R::to_rows(values, |l, row| self.1[first + l] = row);
            }
        }
    }

    #[test]
    fn rows_go_into_lanes_and_come_back() {
        let rows: [[f64; 4]; 8] = std::array::from_fn(|l| std::array::from_fn(|i| (10 * l + i) as f64));
        for width in [Width::One, Width::Four, Width::Eight] {
            let mut back = [[0.0; 4]; 8];
            run(width, Turn(&rows, &mut back));
            assert_eq!(back, rows);
        }
    }

    struct Above<'a>(&'a [f64; 8], f64, &'a mut Vec<bool>);

    impl LaneTask for Above<'_> {
        #[inline(always)]
        fn go<R: Real>(self) {
            let all = (0..8).step_by(R::LANES).map(|l| R::read(&self.0[l..]).all_gt(R::of(self.1)));
            self.2.push(all.fold(true, |a, b| a & b));
        }
    }

    #[test]
    fn all_lanes_are_asked() {
        for width in [Width::One, Width::Four, Width::Eight] {
            for lane in 0..8 {
                let mut x = [2.0; 8];
                for (value, above) in [(1.5, true), (1.0, false), (0.5, false), (f64::NAN, false)] {
                    x[lane] = value;
                    let mut all = Vec::new();
                    run(width, Above(&x, 1.0, &mut all));
                    assert_eq!(all, [above], "{value} in lane {lane}");
                }
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
