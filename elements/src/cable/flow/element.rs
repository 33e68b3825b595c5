//! The cable element through which material flows: elastic force and inertia.

use super::embedding::{Embedding, Grid};
use super::for_fronts;
use super::rule::close;
use super::transport::{Row, Transport, nodal};
use crate::cable::element::{CableParams, mass};
use crate::cable::longitudinal::{Longitudinal, Strain, add_axial, axial_energy};
use crate::cable::model::Models;
use crate::cable::quadrature::Rule;
use crate::cable::reduced::Reduced;
use crate::cable::relaxed::{Step, add_relaxed, capped};
use crate::cable::shape::natural;
use crate::cable::transverse::{Transverse, bending_energy};
use ropewalk_core::{Batch, Dual, Element, Energy, Local, Power, Real, Share, V3, Weights, dot};

/// A cable element like [`Cable`](crate::cable::Cable) whose ends may stand anywhere on the material and move along it.
///
/// Its unknowns are the twelve dofs of its nodes and the `F` boundaries of its line. Inertia is `M(l) A` with the material
/// acceleration `A` at the nodes; elastic force the derivative of `U(e, l)` by the dofs and, with the open ends left to
/// [`FlowEnd`](super::FlowEnd), by the boundaries.
#[derive(Clone, Copy, Debug)]
pub struct FlowCable<L, T, Q, const F: usize> {
    /// What it is made of; its length is that of its embedding.
    pub params: CableParams,
    /// Where its nodes stand on the material.
    pub by: Embedding<F>,
    /// How it strains.
    pub models: Models<L, T, Q>,
}

impl<L: Longitudinal, T: Transverse, Q: Rule, const F: usize> FlowCable<L, T, Q, F> {
    /// An element of these properties.
    pub fn new(params: CableParams, models: Models<L, T, Q>, by: Embedding<F>) -> Self {
        FlowCable { params, by, models }
    }
}

/// Properties and embedding over lanes, and the models of all of them.
#[derive(Clone, Copy, Debug)]
pub struct FlowLanes<M, const F: usize, R> {
    params: CableParams<R>,
    by: Embedding<F, R>,
    models: M,
}

/// `M A` with the scalars of the mass matrix.
#[inline(always)]
fn times<R: Real>(m: &[Row<R>; 4], a: &[V3<R>; 4]) -> [V3<R>; 4] {
    let mut f = *a;
    for i in 0..4 {
        f[i] = super::transport::row_times(&m[i], a);
    }
    f
}

/// Strain energy of an element of length `l`.
#[inline(always)]
fn strain_energy<L: Longitudinal, T: Transverse, Q: Rule, R: Real>(
    models: Models<L, T, Q>,
    p: &CableParams<R>,
    e: &[R; 12],
    l: R,
) -> R {
    let il = R::of(1.0) / l;
    let q = natural(e, il);
    let Models { longitudinal, transverse, rule } = models;
    axial_energy(longitudinal, rule.axial(), p.ea * l, &q)
        + bending_energy(transverse, rule.bending(), p.ei, l, il, &q)
}

#[inline(always)]
fn lift<R: Real>(p: &CableParams<R>) -> CableParams<Dual<R>> {
    let c = Dual::constant;
    CableParams { l: c(p.l), ea: c(p.ea), ei: c(p.ei), rho_a: c(p.rho_a) }
}

/// Inertia: residual, tangent, and the rows and columns of the boundaries.
#[inline(always)]
fn add_inertia<M, R: Real, const F: usize, const N: usize, const TANGENT: bool>(
    p: &FlowLanes<M, F, R>,
    g: &Grid<R>,
    x: &Local<R, N, N>,
    w: &Weights,
    out: &mut Share<R, N>,
) {
    let (e, ed, edd) = (nodal(&x.q), nodal(&x.v), nodal(&x.a));
    let m = mass(&CableParams { l: g.l, ..p.params });
    let f = times(&m, &Transport::new(g, &e, &ed, &edd).a);
    for i in 0..12 {
        out.r[i] += f[i / 3][i % 3];
    }
    let mut d_f = [f; F];
    if TANGENT {
        let (wq, wv, wa) = (R::of(w.q), R::of(w.v), R::of(w.a));
        let (p4, h4) = Transport::matrices(g);
        let mut by = h4;
        for i in 0..4 {
            for j in 0..4 {
                by[i][j] = wq * h4[i][j] - (wv + wv) * p4[i][j];
            }
            by[i][i] += wa;
        }
        for i in 0..4 {
            for j in 0..4 {
                let mut k = R::zero();
                for n in 0..4 {
                    k = m[i][n].fma(by[n][j], k);
                }
                for c in 0..3 {
                    out.k[3 * i + c][3 * j + c] += k;
                }
            }
        }
        let (params, e, ed, edd) = (lift(&p.params), nodal_dual(&e), nodal_dual(&ed), nodal_dual(&edd));
        for k in 0..F {
            let g = g.towards(&p.by, k, w);
            let m = mass(&CableParams { l: g.l, ..params });
            let f = times(&m, &Transport::new(&g, &e, &ed, &edd).a);
            for i in 0..4 {
                for c in 0..3 {
                    d_f[k][i][c] = f[i][c].eps;
                }
            }
        }
    }
    close::<R, F, N, TANGENT>(&p.by, g, &x.q, &f, &d_f, w, out);
}

#[inline(always)]
pub(super) fn nodal_dual<R: Real>(e: &[V3<R>; 4]) -> [V3<Dual<R>>; 4] {
    let mut out = [[Dual::zero(); 3]; 4];
    for i in 0..4 {
        out[i] = Dual::constants(&e[i]);
    }
    out
}

/// How an element came to where a search for equilibrium stands.
#[inline(always)]
pub(super) fn last_step<R: Real, const F: usize, const N: usize>(
    by: &Embedding<F, R>,
    g: &Grid<R>,
    x: &Local<R, N, N>,
) -> Step<R> {
    let (mut e, mut last, mut grown) = ([R::zero(); 12], [R::zero(); 12], R::zero());
    e.copy_from_slice(&x.q[..12]);
    last.copy_from_slice(&x.last[..12]);
    for k in 0..F {
        grown += (by.by[k][1] - by.by[k][0]) * x.last[12 + k];
    }
    Step::fed(&e, &last, g.l, grown)
}

/// Elastic force: residual, tangent, and the rows and columns of the boundaries.
#[inline(always)]
fn add_elastic<
    L: Longitudinal,
    T: Transverse,
    Q: Rule,
    R: Real,
    const F: usize,
    const N: usize,
    const TANGENT: bool,
>(
    p: &FlowLanes<Models<L, T, Q>, F, R>,
    g: &Grid<R>,
    x: &Local<R, N, N>,
    w: &Weights,
    out: &mut Share<R, N>,
) {
    let mut e = [R::zero(); 12];
    e.copy_from_slice(&x.q[..12]);
    let q = natural(&e, g.il);
    let Models { longitudinal, transverse, rule } = p.models;
    let mut local = Reduced::zero();
    let mut params = CableParams { l: g.l, ..p.params };
    let mut relaxed = None;
    // the pool relaxes in scalar only, as that of cables that don't feed
    if R::LANES == 1
        && let Some(how) = &x.relaxed
    {
        let step = last_step(&p.by, g, x);
        add_relaxed::<L, T, Q, R, TANGENT>(p.models, &params, how, g.il, &q, &step, &mut local);
        relaxed = Some((how, step, params));
        params.ea = capped(&params, how.ramp, how.load);
    } else {
        add_axial::<L, Q::Axial, R, TANGENT>(longitudinal, rule.axial(), params.ea * g.l, &q, &mut local);
        transverse.add::<Q::Bending, R, TANGENT>(rule.bending(), params.ei, g.l, g.il, &q, &mut local);
    }
    let mut own = Share::<R, 12>::zero();
    local.spread_force::<true>(g.il, &mut own);
    let (params, fixed) = (lift(&params), Dual::constants(&e));
    if TANGENT {
        let wq = R::of(w.q);
        local.spread_tangent::<true>(g.il, wq, &mut own);
        for i in 0..12 {
            for j in 0..12 {
                out.k[i][j] += own.k[i][j];
            }
        }
        // what a longer element would feel: its force differentiated, its energy differentiated twice
        let l = Dual::new(g.l, R::of(1.0));
        let il = Dual::of(1.0) / l;
        let natural_l = natural(&fixed, il);
        let twice = Dual::new(l, Dual::constant(R::of(1.0)));
        let mut energy = strain_energy(p.models, &lift(&params), &Dual::constants(&fixed), twice);
        let mut local = Reduced::zero();
        if let Some((how, step, of)) = &relaxed {
            // the energy `s ε + EA (ε - ε₀)²/2` has the derivatives that the geometric stiffness by the stress s takes
            let natural_twice = natural(&Dual::constants(&fixed), Dual::of(1.0) / twice);
            let (mut apart, ea) = (Dual::zero(), params.ea);
            for at in p.models.points() {
                let strain = longitudinal.strain(&natural_l, at);
                let here = Dual::constant(strain.eps().re);
                let s = step.stress(longitudinal, of, how, at, here.re);
                let w = l * Dual::of(at.w);
                local.add_force(w * (ea * (strain.eps() - here) + Dual::constant(s)), &strain.gradient());
                let (eps, wide) = (longitudinal.strain(&natural_twice, at).eps(), twice * Dual::of(at.w));
                apart += wide * Dual::constant(Dual::constant(s) - ea * here) * eps;
            }
            energy.eps.eps += apart.eps.eps;
        } else {
            add_axial::<L, Q::Axial, Dual<R>, false>(
                longitudinal,
                rule.axial(),
                params.ea * l,
                &natural_l,
                &mut local,
            );
        }
        transverse.add::<Q::Bending, Dual<R>, false>(
            rule.bending(),
            params.ei,
            l,
            il,
            &natural_l,
            &mut local,
        );
        let mut force = Share::<Dual<R>, 12>::zero();
        local.spread_force::<true>(il, &mut force);
        for k in 0..F {
            let grows = p.by.by[k][1] - p.by.by[k][0];
            out.r[12 + k] += grows * energy.re.eps;
            for i in 0..12 {
                let d = wq * grows * force.r[i].eps;
                out.k[i][12 + k] += d;
                out.k[12 + k][i] += d;
            }
            for m in 0..F {
                let other = p.by.by[m][1] - p.by.by[m][0];
                out.k[12 + k][12 + m] += wq * grows * other * energy.eps.eps;
            }
        }
    } else {
        let l = Dual::new(g.l, R::of(1.0));
        let energy = strain_energy(p.models, &params, &fixed, l);
        for k in 0..F {
            out.r[12 + k] += (p.by.by[k][1] - p.by.by[k][0]) * energy.eps;
        }
    }
    for i in 0..12 {
        out.r[i] += own.r[i];
    }
}

macro_rules! element {
    ($boundaries:literal, $size:literal) => {
        impl<L: Longitudinal, T: Transverse, Q: Rule> Element<$size, $size>
            for FlowCable<L, T, Q, $boundaries>
        {
            type Lanes<R: Real> = FlowLanes<Models<L, T, Q>, $boundaries, R>;
            const WIDE: bool = $boundaries == 1 && Models::<L, T, Q>::KNOWN;

            fn label(&self) -> String {
                let Models { longitudinal, transverse, rule } = self.models;
                format!("flowing cable {}+{} {}", longitudinal.label(), transverse.label(), rule.label())
            }
            fn symmetric(&self) -> bool {
                false
            }
            #[inline(always)]
            fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R> {
                FlowLanes {
                    params: CableParams {
                        l: batch.get(|e| e.params.l),
                        ea: batch.get(|e| e.params.ea),
                        ei: batch.get(|e| e.params.ei),
                        rho_a: batch.get(|e| e.params.rho_a),
                    },
                    by: Embedding::lanes(|f, j| batch.get(|e| f(&e.by, j))),
                    models: batch.first().models,
                }
            }
            #[inline(always)]
            fn add<R: Real, const TANGENT: bool>(
                p: &Self::Lanes<R>,
                x: &Local<R, $size, $size>,
                w: &Weights,
                out: &mut Share<R, $size>,
            ) {
                let g = Grid::new(&p.by, x);
                add_inertia::<_, R, $boundaries, $size, TANGENT>(p, &g, x, w, out);
                add_elastic::<L, T, Q, R, $boundaries, $size, TANGENT>(p, &g, x, w, out);
            }
            #[inline(always)]
            fn energy<R: Real>(p: &Self::Lanes<R>, x: &Local<R, $size, $size>) -> Energy<R> {
                let g = Grid::new(&p.by, x);
                let v = Transport::new(&g, &nodal(&x.q), &nodal(&x.v), &nodal(&x.a)).v;
                let f = times(&mass(&CableParams { l: g.l, ..p.params }), &v);
                let mut twice = R::zero();
                for i in 0..4 {
                    twice += dot(&f[i], &v[i]);
                }
                let mut e = [R::zero(); 12];
                e.copy_from_slice(&x.q[..12]);
                let potential = strain_energy(p.models, &p.params, &e, g.l);
                Energy { kinetic: R::of(0.5) * twice, potential }
            }
            /// Kinetic energy that material carries over the ends; it cancels between neighbours.
            #[inline(always)]
            fn power<R: Real>(p: &Self::Lanes<R>, x: &Local<R, $size, $size>) -> Power<R> {
                let g = Grid::new(&p.by, x);
                let v = Transport::new(&g, &nodal(&x.q), &nodal(&x.v), &nodal(&x.a)).v;
                let carried =
                    R::of(0.5) * p.params.rho_a * (g.pd[1] * dot(&v[2], &v[2]) - g.pd[0] * dot(&v[0], &v[0]));
                Power { carried, ..Power::zero() }
            }
        }
    };
}
for_fronts!((1, 13), (2, 14); element);
