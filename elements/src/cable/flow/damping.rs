//! Damping of a flowing cable: at the rates of its material.

use super::element::nodal_dual;
use super::embedding::{Embedding, Grid};
use super::for_fronts;
use super::rule::close;
use super::transport::{Transport, nodal};
use crate::cable::bending_damping::{BendingDamping, BendingDampingLanes};
use crate::cable::damping::{AxialDamping, AxialDampingLanes};
use crate::cable::longitudinal::Longitudinal;
use crate::cable::quadrature::Quadrature;
use ropewalk_core::{Batch, Dual, Element, Local, Power, Real, Share, V3, Weights};

/// A force of an element on its own material, which needs coordinates, velocities of the material, and the length.
pub trait Material: Element<12, 12> {
    /// Its numbers over lanes, `get` being the way to those of each lane's element; the models are those of the first.
    fn numbers<R: Real>(first: &Self, get: impl Fn(fn(&Self) -> f64) -> R) -> Self::Lanes<R>;
    /// The same numbers for another length of the element.
    fn at_length<R: Real>(p: &Self::Lanes<R>, l: R) -> Self::Lanes<R>;
    /// The same numbers with derivatives of nothing.
    fn lift<R: Real>(p: &Self::Lanes<R>, l: Dual<R>) -> Self::Lanes<Dual<R>>;
}

impl<L: Longitudinal, Q: Quadrature> Material for AxialDamping<L, Q> {
    #[inline(always)]
    fn numbers<R: Real>(first: &Self, get: impl Fn(fn(&Self) -> f64) -> R) -> Self::Lanes<R> {
        let &AxialDamping { model, rule, .. } = first;
        AxialDampingLanes { l: get(|e| e.l), eta_ea: get(|e| e.eta_ea), model, rule }
    }
    #[inline(always)]
    fn at_length<R: Real>(p: &Self::Lanes<R>, l: R) -> Self::Lanes<R> {
        AxialDampingLanes { l, ..*p }
    }
    #[inline(always)]
    fn lift<R: Real>(p: &Self::Lanes<R>, l: Dual<R>) -> Self::Lanes<Dual<R>> {
        AxialDampingLanes { l, eta_ea: Dual::constant(p.eta_ea), model: p.model, rule: p.rule }
    }
}
impl Material for BendingDamping {
    #[inline(always)]
    fn numbers<R: Real>(first: &Self, get: impl Fn(fn(&Self) -> f64) -> R) -> Self::Lanes<R> {
        BendingDampingLanes { l: get(|e| e.l), eta_ei: get(|e| e.eta_ei), rule: first.rule }
    }
    #[inline(always)]
    fn at_length<R: Real>(p: &Self::Lanes<R>, l: R) -> Self::Lanes<R> {
        BendingDampingLanes { l, ..*p }
    }
    #[inline(always)]
    fn lift<R: Real>(p: &Self::Lanes<R>, l: Dual<R>) -> Self::Lanes<Dual<R>> {
        BendingDampingLanes { l, eta_ei: Dual::constant(p.eta_ei), rule: p.rule }
    }
}

/// A damping `D` of a cable element through which material flows.
#[derive(Clone, Copy, Debug)]
pub struct FlowDamping<D, const F: usize> {
    /// The damping, for an element at rest.
    pub damping: D,
    /// Embedding of the element.
    pub by: Embedding<F>,
}

/// The state of the material as an element at rest would see it.
#[inline(always)]
fn still<R: Real, const N: usize>(g: &Grid<R>, x: &Local<R, N, N>) -> Local<R, 12, 12> {
    let v = Transport::new(g, &nodal(&x.q), &nodal(&x.v), &nodal(&x.a)).v;
    state(&nodal(&x.q), &v)
}

#[inline(always)]
fn state<R: Real>(e: &[V3<R>; 4], ed: &[V3<R>; 4]) -> Local<R, 12, 12> {
    let zero = [R::zero(); 12];
    let mut x = Local { q: zero, v: zero, a: zero, last: zero, relaxed: None };
    for i in 0..12 {
        x.q[i] = e[i / 3][i % 3];
        x.v[i] = ed[i / 3][i % 3];
    }
    x
}

macro_rules! element {
    ($boundaries:literal, $size:literal) => {
        impl<D: Material> Element<$size, $size> for FlowDamping<D, $boundaries> {
            type Lanes<R: Real> = (D::Lanes<R>, Embedding<$boundaries, R>);
            const WIDE: bool = false;

            fn label(&self) -> String {
                format!("{} of a flowing cable", self.damping.label())
            }
            fn symmetric(&self) -> bool {
                false
            }
            #[inline(always)]
            fn lanes<R: Real>(b: &Batch<'_, Self>) -> Self::Lanes<R> {
                let damping = D::numbers(&b.first().damping, |f| b.get(|e| f(&e.damping)));
                (damping, Embedding::lanes(|f, j| b.get(|e| f(&e.by, j))))
            }
            #[inline(always)]
            fn add<R: Real, const TANGENT: bool>(
                (p, by): &Self::Lanes<R>,
                x: &Local<R, $size, $size>,
                w: &Weights,
                out: &mut Share<R, $size>,
            ) {
                let g = Grid::new(by, x);
                let (p_now, still) = (D::at_length(p, g.l), still(&g, x));
                let mut own = Share::<R, 12>::zero();
                D::add::<R, TANGENT>(&p_now, &still, w, &mut own);
                let f = nodal(&own.r);
                for i in 0..12 {
                    out.r[i] += own.r[i];
                }
                let mut d_f = [f; $boundaries];
                if TANGENT {
                    // the velocity of the material depends on the dofs as well: v = ė - P e
                    let mut by_v = Share::<R, 12>::zero();
                    D::add::<R, true>(&p_now, &still, &Weights { q: 0.0, v: w.q, a: 0.0 }, &mut by_v);
                    let (p4, _) = Transport::matrices(&g);
                    for i in 0..12 {
                        for j in 0..4 {
                            for c in 0..3 {
                                let mut k = own.k[i][3 * j + c];
                                for n in 0..4 {
                                    k -= by_v.k[i][3 * n + c] * p4[n][j];
                                }
                                out.k[i][3 * j + c] += k;
                            }
                        }
                    }
                    let (e, ed) = (nodal_dual(&nodal(&x.q)), nodal_dual(&nodal(&x.v)));
                    for k in 0..$boundaries {
                        let g = g.towards(by, k, w);
                        let v = Transport::new(&g, &e, &ed, &ed).v;
                        let mut own = Share::<Dual<R>, 12>::zero();
                        D::add::<Dual<R>, false>(&D::lift(p, g.l), &state(&e, &v), w, &mut own);
                        for i in 0..12 {
                            d_f[k][i / 3][i % 3] = own.r[i].eps;
                        }
                    }
                }
                close::<R, $boundaries, $size, TANGENT>(by, &g, &x.q, &f, &d_f, w, out);
            }
            #[inline(always)]
            fn power<R: Real>((p, by): &Self::Lanes<R>, x: &Local<R, $size, $size>) -> Power<R> {
                let g = Grid::new(by, x);
                D::power(&D::at_length(p, g.l), &still(&g, x))
            }
        }
    };
}
for_fronts!((1, 13), (2, 14); element);
