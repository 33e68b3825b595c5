//! The dense kernels of a front.

use crate::algebra::scalar::Scalar;

/// Rows and columns of the piece of `C` that is kept in registers; widths of what is passed on are multiples of both.
const ROWS: usize = 4;
pub(super) const COLUMNS: usize = 8;

/// Factors a front's own rows and columns in place: `upper` holds `[F₁₁ F₁₂]` row by row and becomes `U`, `lower` holds
/// `F₂₁` column by column and becomes `L`. Fails with the number of a pivot that vanishes.
#[inline(always)]
pub(super) fn triangles<T: Scalar, const FUSED: bool, const SYMMETRIC: bool>(
    own: usize,
    stride: usize,
    upper: &mut [T],
    lower: &mut [T],
    inverse: &mut [T],
) -> Result<(), usize> {
    for p in 0..own {
        let (above, below) = upper.split_at_mut((p + 1) * stride);
        let row = &above[p * stride..][..stride];
        let pivot = row[p];
        if pivot.size() == 0.0 || !Scalar::is_finite(pivot) {
            return Err(p);
        }
        inverse[p] = pivot.inverse();
        for r in p + 1..own {
            let to = &mut below[(r - p - 1) * stride..][..stride];
            let l = if SYMMETRIC { row[r] } else { to[p] } * inverse[p];
            lower[p * stride + r] = l;
            for (to, u) in to[p + 1..].iter_mut().zip(&row[p + 1..]) {
                *to = to.minus::<FUSED>(l, *u);
            }
        }
    }
    for p in 0..own {
        let (before, column) = lower.split_at_mut(p * stride);
        let column = &mut column[own..stride];
        if SYMMETRIC {
            let row = &upper[p * stride + own..][..column.len()];
            column.iter_mut().zip(row).for_each(|(l, u)| *l = *u * inverse[p]);
            continue;
        }
        for q in 0..p {
            let u = upper[q * stride + p];
            for (l, k) in column.iter_mut().zip(&before[q * stride + own..][..stride - own]) {
                *l = l.minus::<FUSED>(u, *k);
            }
        }
        column.iter_mut().for_each(|l| *l *= inverse[p]);
    }
    Ok(())
}

/// `C -= L₂₁ U₁₂`, piece by piece; of a symmetric one those that hold a part of the upper half.
#[inline(always)]
pub(super) fn subtract_product<T: Scalar, const FUSED: bool, const SYMMETRIC: bool>(
    own: usize,
    wide: usize,
    lower: &[T],
    upper: &[T],
    c: &mut [T],
) {
    let stride = own + wide;
    for i in (0..wide).step_by(ROWS) {
        let first = if SYMMETRIC { i / COLUMNS * COLUMNS } else { 0 };
        for j in (first..wide).step_by(COLUMNS) {
            let mut piece = [T::eight(&c[i * wide + j..]); ROWS];
            for (k, row) in piece.iter_mut().enumerate().skip(1) {
                *row = T::eight(&c[(i + k) * wide + j..]);
            }
            for p in 0..own {
                let l = &lower[p * stride + own + i..][..ROWS];
                let u = T::eight(&upper[p * stride + own + j..]);
                for k in 0..ROWS {
                    T::eight_minus::<FUSED>(&mut piece[k], l[k], &u);
                }
            }
            for (k, row) in piece.iter().enumerate() {
                T::write(row, &mut c[(i + k) * wide + j..]);
            }
        }
    }
}

/// Scalar product over four sums, which don't wait for each other.
#[inline(always)]
pub(super) fn dot<T: Scalar>(a: &[T], b: &[T]) -> T {
    let n = a.len().min(b.len());
    let (a, a_rest) = a[..n].as_chunks::<4>();
    let (b, b_rest) = b[..n].as_chunks::<4>();
    let mut sums = [T::default(); 4];
    for (a, b) in a.iter().zip(b) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: T = a_rest.iter().zip(b_rest).map(|(a, b)| *a * *b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}
