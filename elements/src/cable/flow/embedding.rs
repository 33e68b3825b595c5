//! How the nodes of an element follow the boundaries of their line.

use crate::cable::twisting::{COORDINATES, VELOCITIES};
use ropewalk_core::{Dual, Local, Real, Weights};

/// Where the two nodes of an element stand on the material: `p_i = fixed_i + Σ_k by_ki π_k`, linear in the `F` boundaries
/// of the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Embedding<const F: usize, R = f64> {
    /// What doesn't move with any boundary [m].
    pub fixed: [R; 2],
    /// Share of each boundary, first the one at the start if that flows.
    pub by: [[R; 2]; F],
}

impl<const F: usize> Embedding<F> {
    /// One number per lane.
    #[inline(always)]
    pub(crate) fn lanes<R: Real>(each: impl Fn(fn(&Self, usize) -> f64, usize) -> R) -> Embedding<F, R> {
        let mut out = Embedding { fixed: [R::zero(); 2], by: [[R::zero(); 2]; F] };
        for i in 0..2 {
            out.fixed[i] = each(|e, i| e.fixed[i], i);
            for k in 0..F {
                out.by[k][i] = each(|e, j| e.by[j / 2][j % 2], 2 * k + i);
            }
        }
        out
    }
    /// The same in every lane.
    pub fn spread<R: Real>(&self) -> Embedding<F, R> {
        Self::lanes(|f, j| R::of(f(self, j)))
    }
}

/// The material coordinates of an element at an instant: their distance and their rates.
#[derive(Clone, Copy, Debug)]
pub struct Grid<R> {
    /// Material between the nodes, `p_b - p_a` [m].
    pub l: R,
    /// Its inverse.
    pub il: R,
    /// Material coordinate of the first node [m].
    pub p: R,
    /// Rate of `l` [m/s].
    pub ld: R,
    /// Rates of the nodes' material coordinates [m/s].
    pub pd: [R; 2],
    /// Their accelerations [m/s²].
    pub pdd: [R; 2],
}

impl<R: Real> Grid<R> {
    /// At the boundaries of a local state, which stand behind the twelve dofs.
    #[inline(always)]
    pub fn new<const F: usize, const N: usize>(e: &Embedding<F, R>, x: &Local<R, N, N>) -> Self {
        let of = |x: &[R; N]| -> [R; F] { std::array::from_fn(|k| x[12 + k]) };
        Self::of(e, of(&x.q), of(&x.v), of(&x.a))
    }

    /// At these boundaries, with these rates and accelerations.
    #[inline(always)]
    pub fn of<const F: usize>(e: &Embedding<F, R>, q: [R; F], v: [R; F], a: [R; F]) -> Self {
        let (mut p, mut pd, mut pdd) = (e.fixed, [R::zero(); 2], [R::zero(); 2]);
        for k in 0..F {
            for i in 0..2 {
                p[i] = e.by[k][i].fma(q[k], p[i]);
                pd[i] = e.by[k][i].fma(v[k], pd[i]);
                pdd[i] = e.by[k][i].fma(a[k], pdd[i]);
            }
        }
        let l = p[1] - p[0];
        Grid { l, il: R::of(1.0) / l, p: p[0], ld: pd[1] - pd[0], pd, pdd }
    }

    /// In a local state whose boundaries stand behind two nodes with torsion.
    #[inline(always)]
    pub(super) fn behind<const F: usize, const Q: usize, const N: usize>(
        e: &Embedding<F, R>,
        x: &Local<R, Q, N>,
    ) -> Self {
        let of = |x: &[R], from: usize| -> [R; F] { std::array::from_fn(|f| x[from + f]) };
        Grid::of(e, of(&x.q, COORDINATES), of(&x.v, VELOCITIES), of(&x.a, VELOCITIES))
    }

    /// The same as what stays while something else changes.
    #[inline(always)]
    pub(super) fn lifted(&self) -> Grid<Dual<R>> {
        let c = Dual::constant;
        Grid {
            l: c(self.l),
            il: c(self.il),
            p: c(self.p),
            ld: c(self.ld),
            pd: self.pd.map(c),
            pdd: self.pdd.map(c),
        }
    }

    /// The same as it changes with boundary `k` in the direction that the tangent is weighted by: the boundary itself by
    /// `w.q`, its rate by `w.v`, its acceleration by `w.a`.
    #[inline(always)]
    pub fn towards<const F: usize>(&self, e: &Embedding<F, R>, k: usize, w: &Weights) -> Grid<Dual<R>> {
        let by = &e.by[k];
        let (wq, wv, wa) = (R::of(w.q), R::of(w.v), R::of(w.a));
        let l = Dual::new(self.l, wq * (by[1] - by[0]));
        Grid {
            l,
            il: Dual::of(1.0) / l,
            p: Dual::new(self.p, wq * by[0]),
            ld: Dual::new(self.ld, wv * (by[1] - by[0])),
            pd: [Dual::new(self.pd[0], wv * by[0]), Dual::new(self.pd[1], wv * by[1])],
            pdd: [Dual::new(self.pdd[0], wa * by[0]), Dual::new(self.pdd[1], wa * by[1])],
        }
    }
}
