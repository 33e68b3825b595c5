//! How a force on the material of an element acts on the boundaries of its line.

use super::embedding::{Embedding, Grid};
use super::transport::{Bends, nodal};
use ropewalk_core::{Real, Share, V3, Weights};

/// Adds what a force on the material does to the boundaries, and with `TANGENT` the rows and columns of the boundaries.
///
/// `f` is the consistent nodal vector of the force as it stands in the residual; `share.k` must hold its derivative by
/// the twelve dofs and nothing else; `d_f` is its derivative in the direction of each boundary
/// ([`Grid::towards`]). When boundary and dofs move, the material at a node moves by `δr - r' δp`, and its slope by
/// `δr' - r'' δp`, hence `Q_p = -(r'·F + r''·F')` at each node, whatever the force.
#[inline(always)]
pub fn close<R: Real, const F: usize, const N: usize, const TANGENT: bool>(
    by: &Embedding<F, R>,
    g: &Grid<R>,
    q: &[R; N],
    f: &[V3<R>; 4],
    d_f: &[[V3<R>; 4]; F],
    w: &Weights,
    share: &mut Share<R, N>,
) {
    let (b, e) = (Bends::new(g.il), nodal(q));
    // slope and second derivative at each node: what the material is displaced by, per boundary
    let mut slide = [[R::zero(); 3]; 4];
    for i in 0..2 {
        for c in 0..3 {
            slide[2 * i][c] = e[2 * i + 1][c];
            slide[2 * i + 1][c] = super::transport::row_times(&b.k[i], &e)[c];
        }
    }
    let wq = R::of(w.q);
    for k in 0..F {
        let row = 12 + k;
        for i in 0..4 {
            let by = by.by[k][i / 2];
            for c in 0..3 {
                share.r[row] -= by * slide[i][c] * f[i][c];
            }
        }
        if !TANGENT {
            continue;
        }
        for i in 0..4 {
            let by = by.by[k][i / 2];
            for c in 0..3 {
                let s = by * slide[i][c];
                for j in 0..12 {
                    share.k[row][j] -= s * share.k[3 * i + c][j];
                }
                for m in 0..F {
                    share.k[row][12 + m] -= s * d_f[m][i][c];
                }
            }
        }
        for i in 0..2 {
            let by_k = by.by[k][i];
            for c in 0..3 {
                share.k[row][3 * (2 * i + 1) + c] -= wq * by_k * f[2 * i][c];
                let moment = wq * by_k * f[2 * i + 1][c];
                let mut by_l = R::zero();
                for j in 0..4 {
                    share.k[row][3 * j + c] -= moment * b.k[i][j];
                    by_l = b.by_l[i][j].fma(e[j][c], by_l);
                }
                for m in 0..F {
                    share.k[row][12 + m] -= moment * by_l * (by.by[m][1] - by.by[m][0]);
                }
            }
        }
    }
    if TANGENT {
        for m in 0..F {
            for i in 0..12 {
                share.k[i][12 + m] += d_f[m][i / 3][i % 3];
            }
        }
    }
}
