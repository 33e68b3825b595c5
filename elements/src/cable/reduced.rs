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
    /// Their derivatives, symmetric: the blocks of the upper triangle, see [`block`]; of those on the diagonal only
    /// their own upper triangle counts.
    pub k: [M3<R>; 6],
}

/// Where block `(i, j)`, `i <= j`, stands in [`Reduced::k`].
#[inline(always)]
pub const fn block(i: usize, j: usize) -> usize {
    i * (5 - i) / 2 + j
}

impl<R: Real> Reduced<R> {
    /// Nothing yet.
    #[inline(always)]
    pub fn zero() -> Self {
        Reduced { g: [[R::zero(); 3]; 3], k: [[[R::zero(); 3]; 3]; 6] }
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
            self.k[block(i, j)][c][c] += s;
        }
    }

    /// Adds `s a aᵀ`.
    #[inline(always)]
    pub fn add_square(&mut self, s: R, a: &Natural<R>) {
        for i in 0..3 {
            for r in 0..3 {
                let sa = s * a[i][r];
                for c in r..3 {
                    self.k[block(i, i)][r][c] = sa.fma(a[i][c], self.k[block(i, i)][r][c]);
                }
                for j in i + 1..3 {
                    for c in 0..3 {
                        self.k[block(i, j)][r][c] = sa.fma(a[j][c], self.k[block(i, j)][r][c]);
                    }
                }
            }
        }
    }

    /// Adds the force to the dofs.
    #[inline(always)]
    pub fn spread_force<const SET: bool>(&self, il: R, out: &mut Share<R, 12>) {
        let f = on_dofs(&self.g, il);
        for i in 0..12 {
            put::<SET, R>(&mut out.r[i], f[i]);
        }
    }

    /// Tangent on the dofs, times `w`: set with `SET`, else added.
    #[inline(always)]
    pub fn spread_tangent<const SET: bool>(&self, il: R, w: R, out: &mut Share<R, 12>) {
        let [dd, da, db, aa, ab, bb] = &self.k;
        let (wl, wll) = (w * il, w * il * il);
        for r in 0..3 {
            for c in r..3 {
                // derivatives of t = Δ - α - β by α and β, above the diagonal and below it
                let (a, b) = (aa[r][c], bb[r][c]);
                let (ta, at) = (da[r][c] - a - ab[c][r], da[c][r] - a - ab[r][c]);
                let (tb, bt) = (db[r][c] - ab[r][c] - b, db[c][r] - ab[c][r] - b);
                let tt = wll * (dd[r][c] - da[c][r] - db[c][r] - ta - tb);
                put_block::<SET, R>(out, r, c, [tt, wl * ta, wl * tb, w * a, w * ab[r][c], w * b]);
                if r != c {
                    put_block::<SET, R>(out, c, r, [tt, wl * at, wl * bt, w * a, w * ab[c][r], w * b]);
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

/// Puts entry `(r, c)` of the blocks `[tt, tα, tβ, αα, αβ, ββ]` where it belongs among the dofs, and its mirror image.
#[inline(always)]
fn put_block<const SET: bool, R: Real>(out: &mut Share<R, 12>, r: usize, c: usize, b: [R; 6]) {
    let [tt, ta, tb, aa, ab, bb] = b;
    let minus = [-tt, -ta, -tb];
    for (i, j, k) in [(r, c, tt), (r, 6 + c, minus[0]), (6 + r, c, minus[0]), (6 + r, 6 + c, tt)] {
        put::<SET, R>(&mut out.k[i][j], k);
    }
    put::<SET, R>(&mut out.k[3 + r][3 + c], aa);
    put::<SET, R>(&mut out.k[9 + r][9 + c], bb);
    let pairs = [
        (r, 3 + c, minus[1]),
        (6 + r, 3 + c, ta),
        (r, 9 + c, minus[2]),
        (6 + r, 9 + c, tb),
        (3 + r, 9 + c, ab),
    ];
    for (i, j, k) in pairs {
        put::<SET, R>(&mut out.k[i][j], k);
        put::<SET, R>(&mut out.k[j][i], k);
    }
}

#[inline(always)]
fn put<const SET: bool, R: Real>(entry: &mut R, x: R) {
    if SET {
        *entry = x;
    } else {
        *entry += x;
    }
}

/// Adds `s a bᵀ` of natural forces to the tangent on the dofs: for tangents without symmetry.
#[inline(always)]
pub fn add_product<R: Real>(s: R, a: &Natural<R>, b: &Natural<R>, il: R, out: &mut Share<R, 12>) {
    add_products(&[Product::new(s, a, b, il)], out);
}

/// `s a` and `b` on the dofs, of a product `s a bᵀ` of natural forces.
#[derive(Clone, Copy)]
pub struct Product<R>([R; 12], [R; 12]);

impl<R: Real> Product<R> {
    /// Some: lists that are filled as far as needed begin as none, which nothing has to be written for.
    #[inline(always)]
    pub fn new(s: R, a: &Natural<R>, b: &Natural<R>, il: R) -> Option<Self> {
        let mut on = Product(on_dofs(a, il), on_dofs(b, il));
        for a in &mut on.0 {
            *a = s * *a;
        }
        Some(on)
    }
}

/// Adds products to the tangent, which passes once for all of them.
#[inline(always)]
pub fn add_products<R: Real>(products: &[Option<Product<R>>], out: &mut Share<R, 12>) {
    for i in 0..12 {
        let mut row = out.k[i];
        for Product(a, b) in products.iter().flatten() {
            for j in 0..12 {
                row[j] = a[i].fma(b[j], row[j]);
            }
        }
        out.k[i] = row;
    }
}
