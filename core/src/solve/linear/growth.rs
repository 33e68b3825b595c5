//! How much the entries grow in an elimination without pivoting, and so how far it can be trusted.
//!
//! Computed factors are those of a matrix `A + E` with `|E| ≤ c ε |L||U|` (Higham, *Accuracy and Stability of Numerical
//! Algorithms*, 2nd ed., theorem 9.3), where `c` counts the terms of a sum. With `D` the pivots and
//! `wᵢ = Σₖ (lᵢₖ² |dₖ| + uₖᵢ² / |dₖ|) / 2` Cauchy and Schwarz give `(|L||U|)ᵢⱼ ≤ 2 √(wᵢ wⱼ)`. So if `wᵢ` is at most `g` times
//! a natural size `sᵢ` of the equation, the error is at most `2 c ε g` of the matrix that is scaled to ones on its
//! diagonal. The size is `|aᵢᵢ|`, and for a multiplier, which has no diagonal, `Σₖ gᵢₖ² / |aₖₖ|`. A positive definite
//! matrix has `wᵢ = aᵢᵢ`, whatever its condition; what makes `g` large are pivots that nearly vanish, constraints that
//! repeat others, and bodies much lighter than what hangs on them.

use crate::algebra::scalar::Scalar;
use crate::model::structure::Structure;

/// Watches the growth in a factorisation.
#[derive(Default)]
pub(super) struct Growth {
    /// `w` of each position, so far.
    sums: Vec<f64>,
    /// Scratch of one front.
    here: Vec<f64>,
    /// For each multiplier its position and where its entries end; each with the diagonal entry of its velocity.
    multipliers: Vec<(usize, usize)>,
    entries: Vec<(u32, u32)>,
    /// Largest ratio of `w` to the natural size.
    pub largest: f64,
}

impl Growth {
    pub fn new(s: &Structure) -> Self {
        let mut of: Vec<(usize, u32, u32)> = Vec::new();
        for (r, columns, at) in s.rows() {
            for (k, p) in at.enumerate() {
                let c = columns.get(k);
                match (s.is_multiplier[r], s.is_multiplier[c]) {
                    (true, false) => of.push((r, p as u32, s.diagonal_at[c])),
                    (false, true) if s.symmetric => of.push((c, p as u32, s.diagonal_at[r])),
                    _ => {}
                }
            }
        }
        of.sort_unstable();
        let mut growth = Growth { sums: vec![0.0; s.n], ..Growth::default() };
        for p in (0..s.n).filter(|&p| s.is_multiplier[p]) {
            growth.multipliers.push((p, of.partition_point(|e| e.0 <= p)));
        }
        growth.entries = of.into_iter().map(|(_, g, a)| (g, a)).collect();
        growth
    }

    /// A new factorisation begins.
    pub fn start(&mut self) {
        self.sums.fill(0.0);
    }

    /// Adds to `w` of neighbouring positions.
    #[inline(always)]
    pub fn add_run(&mut self, first: usize, shares: &[f64]) {
        for (w, share) in self.sums[first..].iter_mut().zip(shares) {
            *w += share;
        }
    }

    /// Adds the share of some pivots: their rows of `U` and columns of `L`, over these positions.
    #[inline(always)]
    pub fn add<T: Scalar>(&mut self, at: &[u32], stride: usize, upper: &[T], lower: &[T], inverse: &[T]) {
        let all = at.len();
        self.here.clear();
        self.here.resize(all, 0.0);
        for (p, inverse) in inverse.iter().enumerate() {
            let share = Share::of(upper[p * stride + p], *inverse);
            let begin = p * stride;
            let (row, column) = (&upper[begin..][..all], &lower[begin..][..all]);
            self.here[p] += share.pivot;
            for ((w, u), l) in self.here[p + 1..].iter_mut().zip(&row[p + 1..]).zip(&column[p + 1..]) {
                *w += share.of_pair(*l, *u);
            }
        }
        for (w, &p) in self.here.iter().zip(at) {
            self.sums[p as usize] += w;
        }
    }

    /// Compares with the natural sizes, when all is factored.
    pub fn finish<T: Scalar>(&mut self, s: &Structure, values: &[T]) {
        let mut largest: f64 = 0.0;
        let mut judge = |w: f64, size: f64| {
            // a NaN is too large as well
            if !(w <= largest * size) {
                largest = if w <= f64::MAX * size.min(1.0) { w / size } else { f64::INFINITY };
            }
        };
        let diagonal = |p: usize| values[s.diagonal_at[p] as usize].size();
        let mut begin = 0;
        for (p, &w) in self.sums.iter().enumerate().filter(|(p, _)| !s.is_multiplier[*p]) {
            judge(w, diagonal(p));
        }
        for &(p, end) in &self.multipliers {
            let own = diagonal(p);
            let held = |&(g, a): &(u32, u32)| {
                let (g, a) = (values[g as usize].size(), values[a as usize].size());
                if a > 0.0 { g * g / a } else { 0.0 }
            };
            let size = if own > 0.0 { own } else { self.entries[begin..end].iter().map(held).sum() };
            judge(self.sums[p], size);
            begin = end;
        }
        self.largest = largest;
    }
}

/// What a pivot adds to `w`.
#[derive(Clone, Copy)]
pub(super) struct Share {
    pub pivot: f64,
    inverse: f64,
}

impl Share {
    #[inline(always)]
    pub fn of<T: Scalar>(pivot: T, inverse: T) -> Self {
        Share { pivot: pivot.size(), inverse: inverse.size() }
    }
    /// To the unknown with these entries of the pivot's column of `L` and row of `U`.
    #[inline(always)]
    pub fn of_pair<T: Scalar>(&self, l: T, u: T) -> f64 {
        let (l, u) = (l.size(), u.size());
        0.5 * (l * l * self.pivot + u * u * self.inverse)
    }
    /// The same of a symmetric matrix.
    #[inline(always)]
    pub fn of_one<T: Scalar>(&self, u: T) -> f64 {
        let u = u.size();
        u * u * self.inverse
    }
}
