//! The whole of the project's unsafe code: the vector registers of newer processors, and a door to each.
//!
//! The carriers are private, and nothing makes one but code behind its door. That is why their operations are safe:
//! whoever holds one runs on a processor that has the instructions.

use super::{Add, AddAssign, Div, LaneTask, Mul, Neg, Real, Sub, SubAssign, has_avx2, has_avx512};
use std::arch::x86_64::*;

macro_rules! carrier {
    ($name:ident, $register:ty, $lanes:literal, $set:ident, $load:ident, $store:ident, $add:ident, $sub:ident,
     $mul:ident, $div:ident, $fma:ident, $sqrt:ident, $andnot:ident, |$x:ident, $limit:ident, $yes:ident, $no:ident| $if_gt:expr,
     |$a:ident, $b:ident| $all_gt:expr, |$get:ident| $from_rows:expr, |$values:ident, $put:ident| $to_rows:expr) => {
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
            fn abs(self) -> Self {
                // SAFETY: see the module
                $name(unsafe { $andnot($set(-0.0), self.0) })
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
            #[inline(always)]
            fn all_gt(self, limit: Self) -> bool {
                let ($a, $b) = (self.0, limit.0);
                // SAFETY: see the module
                unsafe { $all_gt }
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
    _mm256_andnot_pd,
    |x, limit, yes, no| _mm256_blendv_pd(no, yes, _mm256_cmp_pd::<_CMP_GT_OQ>(x, limit)),
    |x, limit| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(x, limit)) == 0xF,
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
    _mm512_andnot_pd,
    |x, limit, yes, no| _mm512_mask_blend_pd(_mm512_cmp_pd_mask::<_CMP_GT_OQ>(x, limit), no, yes),
    |x, limit| _mm512_cmp_pd_mask::<_CMP_GT_OQ>(x, limit) == 0xFF,
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
