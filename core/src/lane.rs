//! One arithmetic trait and its carriers: the same kernel source runs one element or eight at once.
//!
//! [`Real`] is implemented by `f64`, by [`Pack`] (plain arrays, for any processor), and by the vector registers of
//! newer processors, which no code can name: a kernel meets them only where [`run`] has found them. Everything that a
//! kernel calls must be `#[inline(always)]`, closures in hot places avoided: the processor features of the door
//! reach only what is inlined behind it.

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
}

/// Scalar product.
#[inline(always)]
pub fn dot<R: Real>(a: &V3<R>, b: &V3<R>) -> R {
    a[0].fma(b[0], a[1].fma(b[1], a[2] * b[2]))
}

/// `s a`
#[inline(always)]
pub fn scaled<R: Real>(s: R, a: &V3<R>) -> V3<R> {
    [s * a[0], s * a[1], s * a[2]]
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

/// The whole of the project's unsafe code: the vector registers of newer processors, and a door to each.
///
/// The carriers are private, and nothing makes one but code behind its door. That is why their operations are safe:
/// whoever holds one runs on a processor that has the instructions.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod door {
    use super::{Add, AddAssign, Div, LaneTask, Mul, Neg, Real, Sub, SubAssign, has_avx2, has_avx512};
    use std::arch::x86_64::*;

    macro_rules! carrier {
        ($name:ident, $register:ty, $lanes:literal, $set:ident, $load:ident, $store:ident, $add:ident, $sub:ident,
         $mul:ident, $div:ident, $fma:ident, $sqrt:ident, |$x:ident, $limit:ident, $yes:ident, $no:ident| $if_gt:expr,
         |$get:ident| $from_rows:expr, |$values:ident, $put:ident| $to_rows:expr) => {
            #[derive(Clone, Copy)]
            struct $name($register);

            impl $name {
                #[inline(always)]
                fn numbers(self) -> [f64; $lanes] {
                    let mut x = [0.0; $lanes];
                    self.write(&mut x);
                    x
                }
            }
            carrier!($name, Add, add, $add);
            carrier!($name, Sub, sub, $sub);
            carrier!($name, Mul, mul, $mul);
            carrier!($name, Div, div, $div);
            impl Neg for $name {
                type Output = Self;
                #[inline(always)]
                fn neg(self) -> Self {
                    Self::of(-0.0) - self
                }
            }
            impl AddAssign for $name {
                #[inline(always)]
                fn add_assign(&mut self, r: Self) {
                    *self = *self + r;
                }
            }
            impl SubAssign for $name {
                #[inline(always)]
                fn sub_assign(&mut self, r: Self) {
                    *self = *self - r;
                }
            }
            impl Real for $name {
                const LANES: usize = $lanes;
                #[inline(always)]
                fn of(x: f64) -> Self {
                    // SAFETY: see the module
                    $name(unsafe { $set(x) })
                }
                #[inline(always)]
                fn each(mut f: impl FnMut(usize) -> f64) -> Self {
                    let mut x = [0.0; $lanes];
                    for i in 0..$lanes {
                        x[i] = f(i);
                    }
                    Self::read(&x)
                }
                #[inline(always)]
                fn lane(self, lane: usize) -> f64 {
                    self.numbers()[lane]
                }
                #[inline(always)]
                fn from_rows($get: impl Fn(usize) -> [f64; 4]) -> [Self; 4] {
                    // SAFETY: see the module
                    unsafe { $from_rows }
                }
                #[inline(always)]
                fn to_rows($values: [Self; 4], mut $put: impl FnMut(usize, [f64; 4])) {
                    // SAFETY: see the module
                    unsafe { $to_rows }
                }
                #[inline(always)]
                fn read(from: &[f64]) -> Self {
                    let from = &from[..$lanes];
                    // SAFETY: see the module; `from` fills the register
                    $name(unsafe { $load(from.as_ptr()) })
                }
                #[inline(always)]
                fn write(self, to: &mut [f64]) {
                    let to = &mut to[..$lanes];
                    // SAFETY: see the module; `to` has room for the register
                    unsafe { $store(to.as_mut_ptr(), self.0) };
                }
                #[inline(always)]
                fn fma(self, a: Self, b: Self) -> Self {
                    // SAFETY: see the module
                    $name(unsafe { $fma(self.0, a.0, b.0) })
                }
                #[inline(always)]
                fn sqrt(self) -> Self {
                    // SAFETY: see the module
                    $name(unsafe { $sqrt(self.0) })
                }
                #[inline(always)]
                fn map(self, f: impl Fn(f64) -> f64) -> Self {
                    let x = self.numbers();
                    Self::each(|i| f(x[i]))
                }
                #[inline(always)]
                fn if_gt(self, limit: Self, yes: Self, no: Self) -> Self {
                    let ($x, $limit, $yes, $no) = (self.0, limit.0, yes.0, no.0);
                    // SAFETY: see the module
                    $name(unsafe { $if_gt })
                }
            }
        };
        ($name:ident, $tr:ident, $f:ident, $intrinsic:ident) => {
            impl $tr for $name {
                type Output = Self;
                #[inline(always)]
                fn $f(self, r: Self) -> Self {
                    // SAFETY: see the module
                    $name(unsafe { $intrinsic(self.0, r.0) })
                }
            }
        };
    }
    carrier!(
        Avx2,
        __m256d,
        4,
        _mm256_set1_pd,
        _mm256_loadu_pd,
        _mm256_storeu_pd,
        _mm256_add_pd,
        _mm256_sub_pd,
        _mm256_mul_pd,
        _mm256_div_pd,
        _mm256_fmadd_pd,
        _mm256_sqrt_pd,
        |x, limit, yes, no| _mm256_blendv_pd(no, yes, _mm256_cmp_pd::<_CMP_GT_OQ>(x, limit)),
        |get| {
            let [a, b, c, d] = transpose([row(get(0)), row(get(1)), row(get(2)), row(get(3))]);
            [Avx2(a), Avx2(b), Avx2(c), Avx2(d)]
        },
        |values, put| {
            let [a, b, c, d] = transpose([values[0].0, values[1].0, values[2].0, values[3].0]);
            put(0, Avx2(a).numbers());
            put(1, Avx2(b).numbers());
            put(2, Avx2(c).numbers());
            put(3, Avx2(d).numbers());
        }
    );
    carrier!(
        Avx512,
        __m512d,
        8,
        _mm512_set1_pd,
        _mm512_loadu_pd,
        _mm512_storeu_pd,
        _mm512_add_pd,
        _mm512_sub_pd,
        _mm512_mul_pd,
        _mm512_div_pd,
        _mm512_fmadd_pd,
        _mm512_sqrt_pd,
        |x, limit, yes, no| _mm512_mask_blend_pd(_mm512_cmp_pd_mask::<_CMP_GT_OQ>(x, limit), no, yes),
        |get| {
            let low = transpose([row(get(0)), row(get(1)), row(get(2)), row(get(3))]);
            let high = transpose([row(get(4)), row(get(5)), row(get(6)), row(get(7))]);
            let mut out = [Avx512::of(0.0); 4];
            for i in 0..4 {
                out[i] = Avx512(_mm512_insertf64x4::<1>(_mm512_castpd256_pd512(low[i]), high[i]));
            }
            out
        },
        |values, put| {
            let (mut low, mut high) = ([row([0.0; 4]); 4], [row([0.0; 4]); 4]);
            for i in 0..4 {
                low[i] = _mm512_castpd512_pd256(values[i].0);
                high[i] = _mm512_extractf64x4_pd::<1>(values[i].0);
            }
            (low, high) = (transpose(low), transpose(high));
            for l in 0..4 {
                put(l, Avx2(low[l]).numbers());
                put(4 + l, Avx2(high[l]).numbers());
            }
        }
    );

    /// A register of four numbers. Only behind a door.
    #[inline(always)]
    unsafe fn row(x: [f64; 4]) -> __m256d {
        // SAFETY: the caller is behind a door; `x` fills the register
        unsafe { _mm256_loadu_pd(x.as_ptr()) }
    }

    /// Four registers of four numbers, rows for columns. Only behind a door.
    #[inline(always)]
    unsafe fn transpose([a, b, c, d]: [__m256d; 4]) -> [__m256d; 4] {
        // SAFETY: the caller is behind a door
        unsafe {
            let (ab, ab_odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
            let (cd, cd_odd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
            [
                _mm256_permute2f128_pd::<0x20>(ab, cd),
                _mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd),
                _mm256_permute2f128_pd::<0x31>(ab, cd),
                _mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd),
            ]
        }
    }

    #[target_feature(enable = "avx2,fma")]
    fn inside_avx2(task: impl LaneTask) {
        task.go::<Avx2>();
    }
    #[target_feature(enable = "avx512f,avx512dq,avx512vl,fma")]
    fn inside_avx512(task: impl LaneTask) {
        task.go::<Avx512>();
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
