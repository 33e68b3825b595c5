//! LU without pivoting inside the profile of the matrix, in elimination order.
//!
//! Along a chain the profile is a narrow band. Each row of `L` and `U` is contiguous, and elimination subtracts
//! multiples of rows: short loops over neighbours, no index lists. The order of [`Structure`] keeps it stable
//! (multipliers follow their nodes); the [`Guard`](super::Guard) checks.

use super::{LinearSolver, Scalar, SolveError};
use crate::structure::Structure;

/// LU without pivoting for structurally symmetric matrices with a small profile.
#[derive(Default)]
pub struct Profile<T = f64> {
    /// First column of each row of `L`.
    first: Vec<usize>,
    /// One past the last column of each row of `U`; ascends, so that rows below hold what rows above leave in them.
    end: Vec<usize>,
    /// Where each row starts in `rows`.
    start: Vec<usize>,
    /// `L` without its unit diagonal, and `U`, row by row.
    rows: Vec<T>,
    /// Reciprocal pivots.
    inverse: Vec<T>,
    /// For each entry of the matrix, where it is stored and where it goes in `rows`; of a symmetric one, where its
    /// mirror image goes too.
    slots: Vec<[u32; 3]>,
    negative: usize,
}

fn first_columns(s: &Structure) -> Vec<usize> {
    let mut first: Vec<usize> = (0..s.n).collect();
    for (r, columns, at) in s.rows() {
        for c in (0..at.len()).map(|k| columns.get(k)) {
            let (low, high) = (r.min(c), r.max(c));
            first[high] = first[high].min(low);
        }
    }
    first
}

fn ends(first: &[usize]) -> Vec<usize> {
    let mut end: Vec<usize> = (1..=first.len()).collect();
    for (c, &f) in first.iter().enumerate() {
        end[f] = end[f].max(c + 1);
    }
    for i in 1..end.len() {
        end[i] = end[i].max(end[i - 1]);
    }
    end
}

impl Profile {
    /// Entries that the factors would have.
    pub fn size(s: &Structure) -> usize {
        let first = first_columns(s);
        ends(&first).iter().zip(&first).map(|(e, f)| e - f).sum()
    }
}

impl<T: Scalar> LinearSolver<T> for Profile<T> {
    fn name(&self) -> &'static str {
        "LU inside the profile"
    }

    fn analyse(&mut self, s: &Structure) -> Result<(), SolveError> {
        self.first = first_columns(s);
        self.end = ends(&self.first);
        let mut total = 0;
        self.start = Vec::with_capacity(s.n);
        for (f, e) in self.first.iter().zip(&self.end) {
            self.start.push(total);
            total += e - f;
        }
        if u32::try_from(total).is_err() {
            return Err(SolveError::Memory);
        }
        self.rows = vec![T::default(); total];
        self.inverse = vec![T::default(); s.n];
        let slot = |r: usize, c: usize| (self.start[r] + c - self.first[r]) as u32;
        self.slots = Vec::with_capacity(s.entries());
        for (r, columns, at) in s.rows() {
            for (k, p) in at.enumerate() {
                let c = columns.get(k);
                self.slots.push([p as u32, slot(r, c), if s.symmetric { slot(c, r) } else { slot(r, c) }]);
            }
        }
        Ok(())
    }

    fn factor(&mut self, s: &Structure, values: &[T]) -> Result<(), SolveError> {
        self.rows.fill(T::default());
        for &[p, a, b] in &self.slots {
            let v = values[p as usize];
            self.rows[a as usize] = v;
            self.rows[b as usize] = v;
        }
        self.negative = 0;
        for i in 0..s.n {
            let f = self.first[i];
            let (above, below) = self.rows.split_at_mut(self.start[i]);
            let row = &mut below[..self.end[i] - f];
            for j in f..i {
                let l = row[j - f];
                if l == T::default() {
                    continue;
                }
                let l = l * self.inverse[j];
                row[j - f] = l;
                let upper = &above
                    [self.start[j] + j + 1 - self.first[j]..self.start[j] + self.end[j] - self.first[j]];
                for (x, u) in row[j + 1 - f..].iter_mut().zip(upper) {
                    *x -= l * *u;
                }
            }
            let pivot = row[i - f];
            if pivot == T::default() || !Scalar::is_finite(pivot) {
                return Err(SolveError::Singular(i));
            }
            self.negative += usize::from(pivot.real() < 0.0);
            self.inverse[i] = pivot.inverse();
        }
        Ok(())
    }

    fn solve(&mut self, x: &mut [T]) {
        for i in 0..x.len() {
            let (f, start) = (self.first[i], self.start[i]);
            let sum: T = self.rows[start..start + i - f].iter().zip(&x[f..i]).map(|(l, x)| *l * *x).sum();
            x[i] -= sum;
        }
        for i in (0..x.len()).rev() {
            let (diagonal, end) =
                (self.start[i] + i - self.first[i], self.start[i] + self.end[i] - self.first[i]);
            let upper = &self.rows[diagonal + 1..end];
            let sum: T = upper.iter().zip(&x[i + 1..]).map(|(u, x)| *u * *x).sum();
            x[i] = (x[i] - sum) * self.inverse[i];
        }
    }

    fn negative_pivots(&self) -> Option<usize> {
        Some(self.negative)
    }
}
