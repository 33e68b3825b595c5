//! A banded linear system with a border of one row and column, solved with row exchanges.

/// A banded matrix of `n` rows with `edge` (0 or 1) full rows and columns at its end, and a right-hand side.
///
/// The band is eliminated from the top; its last columns and the border are solved together as a small full system, so
/// that the band by itself may be singular: a straight inextensible cable between fixed ends is.
pub(super) struct Bordered {
    n: usize,
    edge: usize,
    /// Entries below and above the diagonal.
    below: usize,
    above: usize,
    /// Columns one after the other, each with room for what row exchanges fill in.
    band: Vec<f64>,
    right: Vec<f64>,
    bottom: Vec<f64>,
    corner: f64,
    pub rhs: Vec<f64>,
}

/// No pivot in this row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Singular(pub usize);

impl Bordered {
    pub fn new(n: usize, reach: usize, edge: usize) -> Self {
        let height = 3 * reach + 1;
        Bordered {
            n,
            edge,
            below: reach,
            above: reach,
            band: vec![0.0; n * height],
            right: vec![0.0; n * edge],
            bottom: vec![0.0; n * edge],
            corner: 0.0,
            rhs: vec![0.0; n + edge],
        }
    }

    pub fn clear(&mut self) {
        for part in [&mut self.band, &mut self.right, &mut self.bottom, &mut self.rhs] {
            part.fill(0.0);
        }
        self.corner = 0.0;
    }

    fn height(&self) -> usize {
        2 * self.below + self.above + 1
    }
    fn slot(&self, row: usize, column: usize) -> usize {
        column * self.height() + self.below + self.above + row - column
    }

    /// Adds to an entry; row and column `n` are the border.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        match (row == self.n, column == self.n) {
            (false, false) => {
                debug_assert!(row <= column + self.below && column <= row + self.above, "{row} {column}");
                let at = self.slot(row, column);
                self.band[at] += value;
            }
            (false, true) => self.right[row] += value,
            (true, false) => self.bottom[column] += value,
            (true, true) => self.corner += value,
        }
    }

    /// An entry; zero outside of the band.
    #[cfg(test)]
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        match (row == self.n, column == self.n) {
            (false, false) if row > column + self.below || column > row + self.above => 0.0,
            (false, false) => self.band[self.slot(row, column)],
            (false, true) => self.right[row],
            (true, false) => self.bottom[column],
            (true, true) => self.corner,
        }
    }

    /// Solves in place: the solution stands in `rhs`.
    pub fn solve(&mut self) -> Result<(), Singular> {
        let n = self.n;
        // the full system at the end is as large as the rows that the band's last pivots can reach
        let kept = (self.below + self.above + 1).min(n);
        let front = n - kept;
        for k in 0..front {
            self.eliminate(k)?;
        }
        let size = kept + self.edge;
        let mut full = vec![0.0; size * size];
        for i in 0..kept {
            let (row, from) = (front + i, (front + i).saturating_sub(self.below).max(front));
            for column in from..n.min(row + self.below + self.above + 1) {
                full[i * size + column - front] = self.band[self.slot(row, column)];
            }
        }
        if self.edge == 1 {
            for i in 0..kept {
                full[i * size + kept] = self.right[front + i];
                full[kept * size + i] = self.bottom[front + i];
            }
            full[kept * size + kept] = self.corner;
        }
        solve_full(&mut full, &mut self.rhs[front..]).map_err(|Singular(k)| Singular(front + k))?;
        let border = if self.edge == 1 { self.rhs[n] } else { 0.0 };
        for k in (0..front).rev() {
            let mut sum = self.rhs[k];
            for column in k + 1..n.min(k + self.below + self.above + 1) {
                sum -= self.band[self.slot(k, column)] * self.rhs[column];
            }
            if self.edge == 1 {
                sum -= self.right[k] * border;
            }
            self.rhs[k] = sum / self.band[self.slot(k, k)];
        }
        Ok(())
    }

    /// Clears column `k` below its pivot, in the band and in the border's row.
    fn eliminate(&mut self, k: usize) -> Result<(), Singular> {
        let (last, end) = (self.n.min(k + self.below + 1), self.n.min(k + self.below + self.above + 1));
        let size = |row: usize| self.band[self.slot(row, k)].abs();
        let pivot = (k + 1..last).fold(k, |best, row| if size(row) > size(best) { row } else { best });
        if !(size(pivot) > 0.0) {
            return Err(Singular(k));
        }
        if pivot != k {
            for column in k..end {
                let (a, b) = (self.slot(k, column), self.slot(pivot, column));
                self.band.swap(a, b);
            }
            self.rhs.swap(k, pivot);
            if self.edge == 1 {
                self.right.swap(k, pivot);
            }
        }
        let inverse = 1.0 / self.band[self.slot(k, k)];
        for row in k + 1..last {
            let factor = self.band[self.slot(row, k)] * inverse;
            if factor == 0.0 {
                continue;
            }
            for column in k + 1..end {
                let taken = factor * self.band[self.slot(k, column)];
                let at = self.slot(row, column);
                self.band[at] -= taken;
            }
            self.rhs[row] -= factor * self.rhs[k];
            if self.edge == 1 {
                self.right[row] -= factor * self.right[k];
            }
        }
        if self.edge == 1 && self.bottom[k] != 0.0 {
            let factor = self.bottom[k] * inverse;
            for column in k + 1..end {
                self.bottom[column] -= factor * self.band[self.slot(k, column)];
            }
            self.corner -= factor * self.right[k];
            self.rhs[self.n] -= factor * self.rhs[k];
        }
        Ok(())
    }
}

/// Gauss's elimination with row exchanges of a small full system.
fn solve_full(a: &mut [f64], b: &mut [f64]) -> Result<(), Singular> {
    let n = b.len();
    for k in 0..n {
        let size = |row: usize| a[row * n + k].abs();
        let pivot = (k + 1..n).fold(k, |best, row| if size(row) > size(best) { row } else { best });
        if !(size(pivot) > 0.0) {
            return Err(Singular(k));
        }
        if pivot != k {
            for column in k..n {
                a.swap(k * n + column, pivot * n + column);
            }
            b.swap(k, pivot);
        }
        for row in k + 1..n {
            let factor = a[row * n + k] / a[k * n + k];
            for column in k + 1..n {
                a[row * n + column] -= factor * a[k * n + column];
            }
            b[row] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let rest: f64 = (k + 1..n).map(|c| a[k * n + c] * b[c]).sum();
        b[k] = (b[k] - rest) / a[k * n + k];
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers without pattern in (-1, 1).
    fn number(k: usize) -> f64 {
        2.0 * ((k as f64 * 0.754_877_666_2).fract() - 0.5)
    }

    #[test]
    fn solves_what_it_was_made_of() {
        for (n, reach, edge) in [(40, 6, 1), (57, 10, 1), (57, 10, 0), (5, 10, 1), (12, 3, 0)] {
            let mut a = Bordered::new(n, reach, edge);
            let mut sums = vec![0.0; n + edge];
            let x: Vec<f64> = (0..n + edge).map(|k| number(7 * k + 3)).collect();
            for row in 0..n + edge {
                for column in 0..n + edge {
                    let inside = row == n || column == n || row.abs_diff(column) <= reach;
                    // no diagonal in the band: rows must be exchanged
                    if inside && (row != column || row == n) {
                        let value = number(131 * row + 17 * column + 1);
                        a.add(row, column, value);
                        sums[row] += value * x[column];
                    }
                }
            }
            a.rhs.copy_from_slice(&sums);
            a.solve().unwrap();
            for k in 0..n + edge {
                assert!((a.rhs[k] - x[k]).abs() < 1e-8, "{n} {reach} {edge}: {} {}", a.rhs[k], x[k]);
            }
        }
    }

    #[test]
    fn a_border_makes_a_singular_band_regular() {
        // differences of neighbours see no constant; the border fixes the mean
        let n = 50;
        let mut a = Bordered::new(n, 2, 1);
        for k in 0..n {
            let neighbours = [k.checked_sub(1), Some(k + 1).filter(|k| *k < n)];
            for other in neighbours.into_iter().flatten() {
                a.add(k, k, 1.0);
                a.add(k, other, -1.0);
            }
            a.add(n, k, 1.0);
            a.add(k, n, 1.0);
        }
        a.rhs[n] = 3.0 * n as f64;
        a.solve().unwrap();
        assert!((0..n).all(|k| (a.rhs[k] - 3.0).abs() < 1e-10));
    }
}
