//! Products with a vector, four entries at a time where the processor has registers for that: the same to the last bit.

use super::{Block, Structure};
use crate::algebra::lane::{LaneTask, Real, Width, run};

impl Structure {
    /// `y = A x` in elimination order.
    pub fn multiply(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        self.add_product(values, x, y);
    }

    /// `y += A x`.
    pub(crate) fn add_product(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        run(Width::Four, Product { structure: self, values, x, y });
    }
}

struct Product<'a> {
    structure: &'a Structure,
    values: &'a [f64],
    x: &'a [f64],
    y: &'a mut [f64],
}

impl LaneTask for Product<'_> {
    #[inline(always)]
    fn go<R: Real>(self) {
        let Self { structure, values, x, y } = self;
        for block in &structure.blocks {
            match block.run {
                Some(first) => {
                    let rows = &values[block.base..][..block.size * block.width()];
                    structure.multiply_run::<R>(block, first, rows, &x[first..][..block.width()], y);
                }
                None => structure.multiply_list(block, values, x, y),
            }
        }
    }
}

impl Structure {
    /// The share of a block whose columns follow each other; `x` holds those alone.
    #[inline(always)]
    fn multiply_run<R: Real>(&self, block: &Block, first: usize, rows: &[f64], x: &[f64], y: &mut [f64]) {
        for (i, row) in rows.chunks_exact(block.width()).enumerate() {
            if self.symmetric {
                let (row, own) = (&row[i..], x[block.first - first + i]);
                y[block.first + i] += sum::<R>(row, &x[i..]);
                add::<R>(&row[1..], own, &mut y[first + i + 1..][..row.len() - 1]);
            } else {
                y[block.first + i] += sum::<R>(row, x);
            }
        }
    }

    #[inline(always)]
    fn multiply_list(&self, block: &Block, values: &[f64], x: &[f64], y: &mut [f64]) {
        for (r, columns, at) in (0..block.size).map(|i| self.row(block, i)) {
            let values = &values[at];
            let columns = || (0..values.len()).map(|k| columns.get(k));
            y[r] += values.iter().zip(columns()).map(|(a, c)| a * x[c]).sum::<f64>();
            if self.symmetric {
                for (a, c) in values.iter().zip(columns()).skip(1) {
                    y[c] += a * x[r];
                }
            }
        }
    }
}

/// `aᵀ x`, in four sums, none of which waits for another.
#[inline(always)]
pub(crate) fn sum_of_products(a: &[f64], x: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, of_x) = (a.chunks_exact(4), x[..a.len()].chunks_exact(4));
    let rest: f64 = fours.remainder().iter().zip(of_x.remainder()).map(|(a, x)| a * x).sum();
    for (a, x) in fours.zip(of_x) {
        for i in 0..4 {
            sums[i] += a[i] * x[i];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// The same, with the four sums in the lanes of a register where there is one. Not fused: what cancels exactly would leave
/// rounding, by which a straight column leans.
#[inline(always)]
pub(crate) fn sum<R: Real>(a: &[f64], x: &[f64]) -> f64 {
    if R::LANES != 4 {
        return sum_of_products(a, x);
    }
    let mut sums = R::zero();
    let (fours, of_x) = (a.chunks_exact(4), x[..a.len()].chunks_exact(4));
    let rest: f64 = fours.remainder().iter().zip(of_x.remainder()).map(|(a, x)| a * x).sum();
    for (a, x) in fours.zip(of_x) {
        sums += R::read(a) * R::read(x);
    }
    (sums.lane(0) + sums.lane(1)) + (sums.lane(2) + sums.lane(3)) + rest
}

/// `y += a x`, entry by entry.
#[inline(always)]
pub(crate) fn add<R: Real>(a: &[f64], x: f64, y: &mut [f64]) {
    let whole = a.len() / R::LANES * R::LANES;
    let ((a, more), (y, more_y)) = (a.split_at(whole), y.split_at_mut(whole));
    let all = R::of(x);
    for (a, y) in a.chunks_exact(R::LANES).zip(y.chunks_exact_mut(R::LANES)) {
        (R::read(y) + R::read(a) * all).write(y);
    }
    for (a, y) in more.iter().zip(more_y) {
        *y += a * x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::noise::Noise;

    struct Both<'a> {
        a: &'a [f64],
        x: &'a [f64],
        y: &'a mut [f64],
        sum: &'a mut f64,
    }

    impl LaneTask for Both<'_> {
        #[inline(always)]
        fn go<R: Real>(self) {
            *self.sum = sum::<R>(self.a, self.x);
            add::<R>(self.a, self.x[0], self.y);
        }
    }

    #[test]
    fn lanes_change_nothing_to_the_last_bit() {
        let mut noise = Noise::default();
        for n in 1..40 {
            let [a, x, y] = [(); 3].map(|()| (0..n).map(|_| noise.draw()).collect::<Vec<f64>>());
            let [one, four] = [Width::One, Width::Four].map(|width| {
                let (mut y, mut sum) = (y.clone(), f64::NAN);
                run(width, Both { a: &a, x: &x, y: &mut y, sum: &mut sum });
                (sum.to_bits(), y)
            });
            assert_eq!(one, four, "{n}");
        }
    }
}
