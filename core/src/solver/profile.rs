//! LU without pivoting inside the profile of the matrix, in elimination order.
//!
//! Along a chain the profile is a narrow band, and rows of `L` and columns of `U` are contiguous: short scalar
//! products, no index lists. The order of [`Structure`] keeps it stable (multipliers follow their nodes); the
//! [`Guard`](super::Guard) checks.

use super::{LinearSolver, SolveError};
use crate::pattern::Structure;

/// LU without pivoting for structurally symmetric matrices with a small profile.
#[derive(Default)]
pub struct Profile {
    /// First column of each row of `L` (and first row of each column of `U`).
    first: Vec<usize>,
    /// Where row `i` of `L` starts in `lower`, minus `first[i]`; likewise in `upper`.
    start: Vec<usize>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// Reciprocal pivots.
    inverse: Vec<f64>,
    /// For each stored entry of the matrix, where it goes: below `lower.len()` into `lower`, then `upper`, then the
    /// diagonal.
    slots: Vec<usize>,
    negative: usize,
}

fn first_columns(s: &Structure) -> Vec<usize> {
    let mut first: Vec<usize> = (0..s.n).collect();
    for c in 0..s.n {
        for &r in &s.rows[s.columns[c]..s.columns[c + 1]] {
            let (low, high) = (r.min(c), r.max(c));
            first[high] = first[high].min(low);
        }
    }
    first
}

impl Profile {
    /// Entries that the factors would have.
    pub fn size(s: &Structure) -> usize {
        first_columns(s).iter().enumerate().map(|(i, f)| 2 * (i - f) + 1).sum()
    }
}

impl LinearSolver for Profile {
    fn name(&self) -> &'static str {
        "LU along the chain"
    }

    fn analyse(&mut self, s: &Structure) -> Result<(), SolveError> {
        self.first = first_columns(s);
        let mut total = 0;
        self.start = Vec::with_capacity(s.n);
        for (i, f) in self.first.iter().enumerate() {
            self.start.push(total);
            total += i - f;
        }
        self.lower = vec![0.0; total];
        self.upper = vec![0.0; total];
        self.inverse = vec![0.0; s.n];
        self.slots = Vec::with_capacity(s.entries());
        for c in 0..s.n {
            for &r in &s.rows[s.columns[c]..s.columns[c + 1]] {
                self.slots.push(match r.cmp(&c) {
                    std::cmp::Ordering::Greater => self.start[r] + c - self.first[r],
                    std::cmp::Ordering::Less => total + self.start[c] + r - self.first[c],
                    std::cmp::Ordering::Equal => 2 * total + r,
                });
            }
        }
        Ok(())
    }

    fn factor(&mut self, s: &Structure, values: &[f64]) -> Result<(), SolveError> {
        let total = self.lower.len();
        self.lower.fill(0.0);
        self.upper.fill(0.0);
        self.inverse.fill(0.0);
        for (&slot, &v) in self.slots.iter().zip(values) {
            if slot < total {
                self.lower[slot] = v;
            } else if slot < 2 * total {
                self.upper[slot - total] = v;
            } else {
                self.inverse[slot - 2 * total] = v;
            }
        }
        if s.symmetric {
            self.lower.copy_from_slice(&self.upper);
        }
        self.negative = 0;
        for i in 0..s.n {
            let f = self.first[i];
            let (done_l, row) = self.lower.split_at_mut(self.start[i]);
            let (done_u, column) = self.upper.split_at_mut(self.start[i]);
            let (row, column) = (&mut row[..i - f], &mut column[..i - f]);
            for j in f..i {
                let fj = self.first[j];
                let from = f.max(fj);
                let (a, b) = (self.start[j] + from - fj, self.start[j] + j - fj);
                let (mut l, mut u) = (row[j - f], column[j - f]);
                for (((ri, uj), lj), ci) in row[from - f..j - f]
                    .iter()
                    .zip(&done_u[a..b])
                    .zip(&done_l[a..b])
                    .zip(&column[from - f..j - f])
                {
                    l -= ri * uj;
                    u -= lj * ci;
                }
                row[j - f] = l * self.inverse[j];
                column[j - f] = u;
            }
            let pivot = self.inverse[i] - row.iter().zip(column.iter()).map(|(l, u)| l * u).sum::<f64>();
            if pivot == 0.0 || !pivot.is_finite() {
                return Err(SolveError::Singular(i));
            }
            self.negative += usize::from(pivot < 0.0);
            self.inverse[i] = 1.0 / pivot;
        }
        Ok(())
    }

    fn solve(&mut self, x: &mut [f64]) {
        for i in 0..x.len() {
            let (f, start) = (self.first[i], self.start[i]);
            let row = &self.lower[start..start + i - f];
            let sum: f64 = row.iter().zip(&x[f..i]).map(|(l, x)| l * x).sum();
            x[i] -= sum;
        }
        for i in (0..x.len()).rev() {
            let (f, start) = (self.first[i], self.start[i]);
            x[i] *= self.inverse[i];
            let xi = x[i];
            for (x, u) in x[f..i].iter_mut().zip(&self.upper[start..start + i - f]) {
                *x -= u * xi;
            }
        }
    }

    fn negative_pivots(&self) -> Option<usize> {
        Some(self.negative)
    }
}
