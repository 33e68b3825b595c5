//! How good a solution is: the componentwise backward error.

use crate::algebra::lane::{LaneTask, Real, Width, run};
use crate::algebra::scalar::Scalar;
use crate::model::structure::{Columns, Structure};

/// Scratch of the check.
pub(super) struct Check<T = f64> {
    /// `A x - b`.
    pub residual: Vec<T>,
    /// `|A| |x| + |b|`.
    size: Vec<f64>,
    /// Sums of the rows of `|A|`.
    sums: Vec<f64>,
}

/// So many rows are summed up one by one before all are.
const FEW: usize = 16;

/// `A x - b` and `|A| |x| + |b|` in one pass.
struct Pass<'a, T> {
    s: &'a Structure,
    values: &'a [T],
    x: &'a [T],
    b: &'a [T],
    r: &'a mut [T],
    d: &'a mut [f64],
}

impl<T: Scalar> LaneTask for Pass<'_, T> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let Pass { s, values, x, b, r, d } = self;
        for ((r, d), b) in r.iter_mut().zip(d.iter_mut()).zip(b) {
            *r = -*b;
            *d = b.size();
        }
        for block in &s.blocks {
            for i in 0..block.size {
                let (row, columns, at) = s.row(block, i);
                let values = &values[at];
                let (mut ri, mut di) = (T::default(), 0.0);
                let xi = if s.symmetric { x[row] } else { T::default() };
                match columns {
                    Columns::From(first) => {
                        let run = first..first + values.len();
                        let (x, r, d) = (&x[run.clone()], &mut r[run.clone()], &mut d[run]);
                        let (fours, rest) = values.as_chunks::<4>();
                        let (mut rs, mut ds) = ([T::default(); 4], [0.0; 4]);
                        for (k, a) in fours.iter().enumerate() {
                            let (x, r, d) = (&x[4 * k..][..4], &mut r[4 * k..][..4], &mut d[4 * k..][..4]);
                            for l in 0..4 {
                                let (right, left) = (a[l] * x[l], a[l] * xi);
                                rs[l] += right;
                                ds[l] += right.size();
                                r[l] += left;
                                d[l] += left.size();
                            }
                        }
                        (ri, di) = (rs.into_iter().sum(), ds.iter().sum());
                        let begin = 4 * fours.len();
                        for (((&a, &x), r), d) in
                            rest.iter().zip(&x[begin..]).zip(&mut r[begin..]).zip(&mut d[begin..])
                        {
                            let (right, left) = (a * x, a * xi);
                            ri += right;
                            di += right.size();
                            *r += left;
                            *d += left.size();
                        }
                    }
                    Columns::List(list) => {
                        for (&a, &c) in values.iter().zip(list) {
                            let (right, left) = (a * x[c as usize], a * xi);
                            ri += right;
                            di += right.size();
                            r[c as usize] += left;
                            d[c as usize] += left.size();
                        }
                    }
                }
                // the diagonal has been counted on both sides
                let twice = values[0] * xi;
                r[row] += ri - twice;
                d[row] += di - twice.size();
            }
        }
    }
}

impl<T: Scalar> Check<T> {
    pub fn new(n: usize) -> Self {
        Check { residual: vec![T::default(); n], size: vec![0.0; n], sums: vec![0.0; n] }
    }

    /// Componentwise backward error `max |A x - b|ᵢ / (|A||x| + |b|)ᵢ`; leaves `A x - b` in `residual`. Rows whose
    /// terms are all rounding errors are measured against `(|A| 1)ᵢ |x|∞` instead (Arioli, Demmel & Duff 1989).
    /// Infinite where something isn't finite. `enough` is an error with which the caller is content.
    pub fn error(&mut self, s: &Structure, values: &[T], x: &[T], b: &[T], enough: f64) -> f64 {
        let (r, d) = (&mut self.residual, &mut self.size);
        run(Width::best(), Pass { s, values, x, b, r, d });
        let worst = self.worst(|_| 0.0);
        if !(worst > enough) || worst == f64::INFINITY {
            return worst;
        }
        let largest = x.iter().fold(0.0, |m: f64, x| m.max(x.size()));
        // the diagonal is part of the row's sum: what passes with it passes with the sum
        let diagonal = |row: usize| values[s.diagonal_at[row] as usize].size();
        let small = 1e3 * s.n as f64 * f64::EPSILON;
        let more = |row: usize, sum: f64| {
            let all = sum * largest;
            if self.size[row] <= small * all { all } else { 0.0 }
        };
        let mut failing = 0;
        let worst = self.worst(|row| {
            let mut more_here = more(row, diagonal(row));
            // the rows of constraints have no diagonal
            if self.residual[row].size() > enough * (self.size[row] + more_here) && failing < FEW {
                failing += 1;
                more_here = more(row, s.row_sum(values, row));
            }
            more_here
        });
        if !(worst > enough) || failing < FEW {
            return worst;
        }
        self.sums.fill(0.0);
        for (i, columns, at) in s.rows() {
            for (k, v) in values[at].iter().enumerate() {
                let c = columns.get(k);
                self.sums[i] += v.size();
                if s.symmetric && i != c {
                    self.sums[c] += v.size();
                }
            }
        }
        self.worst(|row| {
            let all = self.sums[row] * largest;
            if self.size[row] <= small * all { all } else { 0.0 }
        })
    }

    fn worst(&self, mut more: impl FnMut(usize) -> f64) -> f64 {
        let mut worst = 0.0;
        for (i, (r, d)) in self.residual.iter().zip(&self.size).enumerate() {
            // max() would swallow a NaN
            if !(Scalar::is_finite(*r) && d.is_finite()) {
                return f64::INFINITY;
            }
            if r.size() > worst * d {
                let d = d + more(i);
                if r.size() > worst * d {
                    worst = r.size() / d;
                }
            }
        }
        worst
    }
}
