//! Kinematics of material that flows through an element.

use super::embedding::Grid;
use ropewalk_core::{Real, V3};

/// Scalars that a row of nodal vectors is combined with; each stands for a multiple of the 3×3 unit matrix.
pub(super) type Row<R> = [R; 4];

/// Second derivatives of the curve at both nodes by the twelve dofs, `r''_i = k_i e`; its third derivative, `t e`; and
/// how the `k_i` change with the length of the element.
pub(super) struct Bends<R> {
    pub k: [Row<R>; 2],
    pub t: Row<R>,
    pub by_l: [Row<R>; 2],
}

impl<R: Real> Bends<R> {
    #[inline(always)]
    pub(super) fn new(il: R) -> Self {
        let (two, four, six, twelve) = (R::of(2.0) * il, R::of(4.0) * il, R::of(6.0), R::of(12.0));
        let (s, c) = (six * il * il, twelve * il * il * il);
        Bends {
            k: [[-s, -four, s, -two], [s, two, -s, four]],
            t: [c, s, -c, s],
            by_l: [[c, il * four, -c, il * two], [-c, -il * two, c, -il * four]],
        }
    }
}

/// `Σ row_i e_i`
#[inline(always)]
pub(super) fn row_times<R: Real>(row: &Row<R>, e: &[V3<R>; 4]) -> V3<R> {
    let mut x = [R::zero(); 3];
    for c in 0..3 {
        x[c] = row[0].fma(e[0][c], row[1].fma(e[1][c], row[2].fma(e[2][c], row[3] * e[3][c])));
    }
    x
}

/// The first twelve of the numbers of an element, as nodal vectors.
#[inline(always)]
pub(super) fn nodal<R: Real, const N: usize>(x: &[R; N]) -> [V3<R>; 4] {
    let mut e = [[R::zero(); 3]; 4];
    for i in 0..4 {
        for c in 0..3 {
            e[i][c] = x[3 * i + c];
        }
    }
    e
}

/// Velocity and acceleration of the material, which are cubics over the element: value and slope at both nodes.
///
/// With the fields at fixed material points `v = ṙ - ṗ r'` and `a = r̈ - 2 ṗ ṙ' + ṗ² r'' - p̈ r'`, where dots are taken at
/// fixed place in the mesh. Since `ṗ` is linear over an element and `r'` quadratic, both are cubics: no quadrature is
/// needed for them. `r''` jumps from element to element, so the slopes are the element's own.
#[derive(Clone, Copy, Debug)]
pub struct Transport<R> {
    /// Second derivative of the curve at both nodes [1/m].
    pub bend: [V3<R>; 2],
    /// Velocity of the material: value and slope at the first node, then at the second.
    pub v: [V3<R>; 4],
    /// Its acceleration.
    pub a: [V3<R>; 4],
}

impl<R: Real> Transport<R> {
    /// Of nodal dofs, their rates and accelerations.
    #[inline(always)]
    pub fn new(g: &Grid<R>, e: &[V3<R>; 4], ed: &[V3<R>; 4], edd: &[V3<R>; 4]) -> Self {
        let b = Bends::new(g.il);
        let third = row_times(&b.t, e);
        let (mut v, mut a, mut bend) = (*ed, *edd, [[R::zero(); 3]; 2]);
        for i in 0..2 {
            let (pd, pdd) = (g.pd[i], g.pdd[i]);
            let two = pd + pd;
            bend[i] = row_times(&b.k[i], e);
            let (rate, by_l) = (row_times(&b.k[i], ed), row_times(&b.by_l[i], e));
            for c in 0..3 {
                let slope = e[2 * i + 1][c];
                v[2 * i][c] -= pd * slope;
                v[2 * i + 1][c] -= pd * bend[i][c];
                let rate = g.ld.fma(by_l[c], rate[c]);
                a[2 * i][c] += pd * pd * bend[i][c] - two * ed[2 * i + 1][c] - pdd * slope;
                a[2 * i + 1][c] += pd * pd * third[c] - two * rate - pdd * bend[i][c];
            }
        }
        Transport { bend, v, a }
    }

    /// `P` and `H` of `v = ė - P e` and `a = ë - 2 P ė + H e`, for prescribed boundaries.
    #[inline(always)]
    pub(super) fn matrices(g: &Grid<R>) -> ([Row<R>; 4], [Row<R>; 4]) {
        let b = Bends::new(g.il);
        let (mut p, mut h) = ([[R::zero(); 4]; 4], [[R::zero(); 4]; 4]);
        for i in 0..2 {
            let (pd, pdd) = (g.pd[i], g.pdd[i]);
            let (square, twice) = (pd * pd, (pd + pd) * g.ld);
            p[2 * i][2 * i + 1] = pd;
            for j in 0..4 {
                p[2 * i + 1][j] = pd * b.k[i][j];
                h[2 * i][j] = square * b.k[i][j];
                h[2 * i + 1][j] = square * b.t[j] - pdd * b.k[i][j] - twice * b.by_l[i][j];
            }
            h[2 * i][2 * i + 1] -= pdd;
        }
        (p, h)
    }
}
