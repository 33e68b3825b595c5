//! Forces and tangents in the nine natural variables, and their way back to the twelve dofs.

use super::shape::Natural;
use ropewalk_core::{Real, Share, V3};

/// Three by three numbers.
pub type M3<R> = [V3<R>; 3];

/// Generalised forces conjugate to `[Δ, α, β]` and their derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Reduced<R> {
    /// Forces.
    pub g: Natural<R>,
    /// Symmetric part of the tangent. Only blocks `k[i][j]` with `i <= j` are kept, and of those with `i == j`
    /// only the upper triangle.
    pub k: [[M3<R>; 3]; 3],
    /// What has no symmetry; untouched by symmetric elements, and free for them.
    pub u: [[M3<R>; 3]; 3],
}

impl<R: Real> Reduced<R> {
    /// Nothing yet.
    #[inline(always)]
    pub fn zero() -> Self {
        let k = [[[[R::zero(); 3]; 3]; 3]; 3];
        Reduced { g: [[R::zero(); 3]; 3], k, u: k }
    }

    /// Adds `s` times a force.
    #[inline(always)]
    pub fn add_force(&mut self, s: R, g: &Natural<R>) {
        for i in 0..3 {
            for c in 0..3 {
                self.g[i][c] = s.fma(g[i][c], self.g[i][c]);
            }
        }
    }

    /// Adds `s` times the unit matrix to block `(i, j)`, `i <= j`.
    #[inline(always)]
    pub fn add_unit(&mut self, i: usize, j: usize, s: R) {
        for c in 0..3 {
            self.k[i][j][c][c] += s;
        }
    }

    /// Adds `s a aᵀ`.
    #[inline(always)]
    pub fn add_square(&mut self, s: R, a: &Natural<R>) {
        for i in 0..3 {
            for r in 0..3 {
                let sa = s * a[i][r];
                for c in r..3 {
                    self.k[i][i][r][c] = sa.fma(a[i][c], self.k[i][i][r][c]);
                }
                for j in i + 1..3 {
                    for c in 0..3 {
                        self.k[i][j][r][c] = sa.fma(a[j][c], self.k[i][j][r][c]);
                    }
                }
            }
        }
    }

    /// Adds `s a bᵀ`, which is not symmetric.
    #[inline(always)]
    pub fn add_product(&mut self, s: R, a: &Natural<R>, b: &Natural<R>) {
        for i in 0..3 {
            for r in 0..3 {
                let sa = s * a[i][r];
                for j in 0..3 {
                    for c in 0..3 {
                        self.u[i][j][r][c] = sa.fma(b[j][c], self.u[i][j][r][c]);
                    }
                }
            }
        }
    }

    /// Force on the dofs: with `t = (g_Δ - g_α - g_β)/L` it is `[-t, g_α, t, g_β]`.
    #[inline(always)]
    pub fn spread_force(&self, il: R, out: &mut Share<R, 12>) {
        for c in 0..3 {
            let t = (self.g[0][c] - self.g[1][c] - self.g[2][c]) * il;
            out.r[c] -= t;
            out.r[3 + c] += self.g[1][c];
            out.r[6 + c] += t;
            out.r[9 + c] += self.g[2][c];
        }
    }

    /// `w` times the symmetric tangent on the dofs. Leaves [`Reduced::u`] aside.
    #[inline(always)]
    pub fn spread_symmetric(&self, il: R, w: R, out: &mut Share<R, 12>) {
        let [[dd, da, db], [_, aa, ab], [_, _, bb]] = &self.k;
        let (wl, wll) = (w * il, w * il * il);
        let upper = |m: &M3<R>, r: usize, c: usize| if r <= c { m[r][c] } else { m[c][r] };
        for r in 0..3 {
            for c in 0..3 {
                // derivatives of t by α and β
                let ta = wl * (da[r][c] - upper(aa, r, c) - ab[c][r]);
                let tb = wl * (db[r][c] - ab[r][c] - upper(bb, r, c));
                out.k[r][3 + c] -= ta;
                out.k[3 + c][r] -= ta;
                out.k[6 + r][3 + c] += ta;
                out.k[3 + c][6 + r] += ta;
                out.k[r][9 + c] -= tb;
                out.k[9 + c][r] -= tb;
                out.k[6 + r][9 + c] += tb;
                out.k[9 + c][6 + r] += tb;
                let m = w * ab[r][c];
                out.k[3 + r][9 + c] += m;
                out.k[9 + c][3 + r] += m;
            }
            for c in r..3 {
                let across = (da[r][c] + da[c][r]) + (db[r][c] + db[c][r]) - (ab[r][c] + ab[c][r]);
                let tt = wll * (dd[r][c] + aa[r][c] + bb[r][c] - across);
                let (a, b) = (w * aa[r][c], w * bb[r][c]);
                let mut put = |i: usize, j: usize| {
                    out.k[i][j] += tt;
                    out.k[i][6 + j] -= tt;
                    out.k[6 + i][j] -= tt;
                    out.k[6 + i][6 + j] += tt;
                    out.k[3 + i][3 + j] += a;
                    out.k[9 + i][9 + j] += b;
                };
                put(r, c);
                if r != c {
                    put(c, r);
                }
            }
        }
    }

    /// `w` times the whole tangent on the dofs, symmetric part and the rest.
    #[inline(always)]
    pub fn spread_all(&self, il: R, w: R, out: &mut Share<R, 12>) {
        let entry = |i: usize, j: usize, r: usize, c: usize| {
            let swap = j < i || (i == j && c < r);
            self.u[i][j][r][c] + if swap { self.k[j][i][c][r] } else { self.k[i][j][r][c] }
        };
        let (wl, wll) = (w * il, w * il * il);
        for r in 0..3 {
            for c in 0..3 {
                let mut m: M3<R> = [[R::zero(); 3]; 3];
                for i in 0..3 {
                    for j in 0..3 {
                        m[i][j] = entry(i, j, r, c);
                    }
                }
                // row and column of t = Δ - α - β
                let row: V3<R> = std::array::from_fn(|j| m[0][j] - m[1][j] - m[2][j]);
                let column: V3<R> = std::array::from_fn(|i| m[i][0] - m[i][1] - m[i][2]);
                let tt = wll * (row[0] - row[1] - row[2]);
                for (i, si) in [(r, false), (6 + r, true)] {
                    for (j, sj) in [(c, false), (6 + c, true)] {
                        out.k[i][j] += if si == sj { tt } else { -tt };
                    }
                    for (j, t) in [(3 + c, wl * row[1]), (9 + c, wl * row[2])] {
                        out.k[i][j] += if si { t } else { -t };
                    }
                }
                for (i, t, k) in [(3 + r, wl * column[1], m[1]), (9 + r, wl * column[2], m[2])] {
                    out.k[i][c] -= t;
                    out.k[i][6 + c] += t;
                    out.k[i][3 + c] += w * k[1];
                    out.k[i][9 + c] += w * k[2];
                }
            }
        }
    }
}
