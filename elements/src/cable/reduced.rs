//! Forces and tangents in the nine natural variables, and their way back to the twelve dofs.

use super::shape::Natural;
use ropewalk_core::{Real, Share, V3};

/// Three by three numbers.
pub type M3<R> = [V3<R>; 3];

/// Generalised forces conjugate to `[Δ, α, β]` and their symmetric tangent.
#[derive(Clone, Copy, Debug)]
pub struct Reduced<R> {
    /// Forces.
    pub g: Natural<R>,
    /// Their derivatives, symmetric. Only blocks `k[i][j]` with `i <= j` are kept, and of those with `i == j`
    /// only the upper triangle.
    pub k: [[M3<R>; 3]; 3],
}

impl<R: Real> Reduced<R> {
    /// Nothing yet.
    #[inline(always)]
    pub fn zero() -> Self {
        Reduced { g: [[R::zero(); 3]; 3], k: [[[[R::zero(); 3]; 3]; 3]; 3] }
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

    /// Force on the dofs.
    #[inline(always)]
    pub fn spread_force(&self, il: R, out: &mut Share<R, 12>) {
        let f = on_dofs(&self.g, il);
        for i in 0..12 {
            out.r[i] += f[i];
        }
    }

    /// Tangent on the dofs, times `w`.
    #[inline(always)]
    pub fn spread_tangent(&self, il: R, w: R, out: &mut Share<R, 12>) {
        let [[dd, da, db], [_, aa, ab], [_, _, bb]] = &self.k;
        let (wl, wll) = (w * il, w * il * il);
        for r in 0..3 {
            for c in 0..3 {
                let (aa, bb) = if r <= c { (aa[r][c], bb[r][c]) } else { (aa[c][r], bb[c][r]) };
                // derivatives of t by α and β
                let ta = wl * (da[r][c] - aa - ab[c][r]);
                let tb = wl * (db[r][c] - ab[r][c] - bb);
                let m = w * ab[r][c];
                for (i, j, k) in [(6 + r, 3 + c, ta), (6 + r, 9 + c, tb), (3 + r, 9 + c, m)] {
                    out.k[i][j] += k;
                    out.k[j][i] += k;
                }
                for (j, t) in [(3 + c, ta), (9 + c, tb)] {
                    out.k[r][j] -= t;
                    out.k[j][r] -= t;
                }
                out.k[3 + r][3 + c] += w * aa;
                out.k[9 + r][9 + c] += w * bb;
            }
            for c in r..3 {
                let across = (da[r][c] + da[c][r]) + (db[r][c] + db[c][r]) - (ab[r][c] + ab[c][r]);
                let tt = wll * (dd[r][c] + aa[r][c] + bb[r][c] - across);
                let twice = [(r, c), (c, r)];
                for &(r, c) in if r == c { &twice[..1] } else { &twice[..] } {
                    out.k[r][c] += tt;
                    out.k[r][6 + c] -= tt;
                    out.k[6 + r][c] -= tt;
                    out.k[6 + r][6 + c] += tt;
                }
            }
        }
    }
}

/// A natural force on the dofs: with `t = (g_Δ - g_α - g_β)/L` it is `[-t, g_α, t, g_β]`.
#[inline(always)]
fn on_dofs<R: Real>(g: &Natural<R>, il: R) -> [R; 12] {
    let mut f = [R::zero(); 12];
    for c in 0..3 {
        let t = (g[0][c] - g[1][c] - g[2][c]) * il;
        (f[c], f[3 + c], f[6 + c], f[9 + c]) = (-t, g[1][c], t, g[2][c]);
    }
    f
}

/// Adds `s a bᵀ` of natural forces to the tangent on the dofs: for tangents without symmetry.
#[inline(always)]
pub fn add_product<R: Real>(s: R, a: &Natural<R>, b: &Natural<R>, il: R, out: &mut Share<R, 12>) {
    let (a, b) = (on_dofs(a, il), on_dofs(b, il));
    for i in 0..12 {
        let sa = s * a[i];
        for j in 0..12 {
            out.k[i][j] = sa.fma(b[j], out.k[i][j]);
        }
    }
}
