//! Kelvin–Voigt damping: material that resists the rate of its strain and of its curvature.
//!
//! Dissipated power `∫ [η EA ε̇² + η EI |κ̇|²] dx` (Garcia-Vallejo, Mayo, Escalona & Dominguez, Nonlinear Dyn. 35, 2004),
//! with the rate of the curvature vector as [`BendingDamping`] has it.

use super::bending_damping::BendingDamping;
use super::longitudinal::{Longitudinal, Strain};
use super::model::{CableModel, LongitudinalModel, Sink, WithModels, with_models};
use super::quadrature::{Quadrature, Rule};
use super::reduced::{Reduced, add_product};
use super::shape::{Natural, natural};
use super::transverse::Transverse;
use ropewalk_core::{Batch, Element, Local, NodeId, Power, Real, Share, Weights};
use std::marker::PhantomData;

/// Damping of stretching: the axial force `η EA ε̇` besides the elastic one.
///
/// Not for L1n, whose force direction isn't the gradient of its strain; `push_axial_damping` takes L1 there.
#[derive(Clone, Copy, Debug)]
pub struct AxialDamping<L, Q> {
    /// Unstretched length [m].
    pub l: f64,
    /// `η EA` [N s].
    pub eta_ea: f64,
    models: PhantomData<(L, Q)>,
}

impl<L: Longitudinal, Q: Quadrature> AxialDamping<L, Q> {
    /// For an element of length `l`.
    pub fn new(l: f64, eta_ea: f64) -> Self {
        AxialDamping { l, eta_ea, models: PhantomData }
    }
}

/// `s a + t b`
#[inline(always)]
fn blend<R: Real>(s: R, a: &Natural<R>, t: R, b: &Natural<R>) -> Natural<R> {
    let mut sum = *a;
    for i in 0..3 {
        for c in 0..3 {
            sum[i][c] = s.fma(a[i][c], t * b[i][c]);
        }
    }
    sum
}

impl<L: Longitudinal, Q: Quadrature> Element<12, 12> for AxialDamping<L, Q> {
    /// `[L, η EA]`
    type Lanes<R: Real> = [R; 2];
    const SYMMETRIC: bool = false;

    fn label() -> String {
        format!("axial damping {} {}", L::LABEL, Q::LABEL)
    }
    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> [R; 2] {
        [batch.get(|e| e.l), batch.get(|e| e.eta_ea)]
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        &[l, eta_ea]: &[R; 2],
        x: &Local<R, 12, 12>,
        w: &Weights,
        out: &mut Share<R, 12>,
    ) {
        let il = R::of(1.0) / l;
        let (q, v) = (natural(&x.q, il), natural(&x.v, il));
        let mut local = Reduced::zero();
        for at in L::points::<Q>() {
            let strain = L::strain(&q, at);
            let c = eta_ea * l * R::of(at.w);
            let force = c * strain.rate(&v);
            let gradient = strain.gradient();
            local.add_force(force, &gradient);
            if TANGENT {
                let rate_by = blend(R::of(w.q), &strain.turn(&v), R::of(w.v), &gradient);
                add_product(c, &gradient, &rate_by, il, out);
                strain.add_hessian(R::of(w.q) * force, &mut local);
            }
        }
        local.spread_force::<false>(il, out);
        if TANGENT {
            local.spread_tangent::<false>(il, R::of(1.0), out);
        }
    }
    #[inline(always)]
    fn power<R: Real>(&[l, eta_ea]: &[R; 2], x: &Local<R, 12, 12>) -> Power<R> {
        let il = R::of(1.0) / l;
        let (q, v) = (natural(&x.q, il), natural(&x.v, il));
        let mut dissipated = R::zero();
        for at in L::points::<Q>() {
            let rate = L::strain(&q, at).rate(&v);
            dissipated += eta_ea * l * R::of(at.w) * rate * rate;
        }
        Power { dissipated, ..Power::zero() }
    }
}

struct Push<'a, S> {
    sink: &'a mut S,
    bending: bool,
    l: f64,
    eta: f64,
    nodes: &'a [NodeId],
}

impl<S: Sink> WithModels for Push<'_, S> {
    type Output = ();
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self) {
        if self.bending {
            self.sink.push(BendingDamping::<Q::Bending>::new(self.l, self.eta), self.nodes);
        } else {
            self.sink.push(AxialDamping::<L, Q::Axial>::new(self.l, self.eta), self.nodes);
        }
    }
}

/// Pushes the axial damping that belongs to a cable element of the chosen models.
pub fn push_axial_damping(
    sink: &mut impl Sink,
    mut model: CableModel,
    l: f64,
    eta_ea: f64,
    nodes: &[NodeId],
) -> Result<(), String> {
    if model.longitudinal == LongitudinalModel::L1n {
        model.longitudinal = LongitudinalModel::L1;
    }
    with_models(model, Push { sink, bending: false, l, eta: eta_ea, nodes })
}

/// Pushes the bending damping that belongs to a cable element of the chosen models.
pub fn push_bending_damping(
    sink: &mut impl Sink,
    model: CableModel,
    l: f64,
    eta_ei: f64,
    nodes: &[NodeId],
) -> Result<(), String> {
    with_models(model, Push { sink, bending: true, l, eta: eta_ei, nodes })
}
