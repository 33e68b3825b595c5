//! Kelvin–Voigt damping: material that resists the rate of its strain and of its curvature.
//!
//! Dissipated power `∫ [η EA ε̇² + η EI |κ̇|²] dx` (Garcia-Vallejo, Mayo, Escalona & Dominguez, Nonlinear Dyn. 35, 2004),
//! with the rate of the curvature vector as [`BendingDamping`] has it.

use super::bending_damping::BendingDamping;
use super::longitudinal::{Longitudinal, Strain};
use super::model::{CableModel, LongitudinalModel, Models, Sink, WithModels, with_models};
use super::quadrature::{MOST, Quadrature, Rule};
use super::reduced::{Product, Reduced, add_products};
use super::shape::{Natural, natural};
use super::transverse::Transverse;
use ropewalk_core::{Batch, Element, Local, NodeId, Power, Real, Share, Weights};

/// Damping of stretching: the axial force `η EA ε̇` besides the elastic one.
///
/// Not for L1n, whose force direction isn't the gradient of its strain; `push_axial_damping` takes L1 there.
#[derive(Clone, Copy, Debug)]
pub struct AxialDamping<L, Q> {
    /// Unstretched length [m].
    pub l: f64,
    /// `η EA` [N s].
    pub eta_ea: f64,
    /// Axial strain.
    pub model: L,
    /// Where it is taken.
    pub rule: Q,
}

/// Properties over lanes, and the model of all of them.
#[derive(Clone, Copy, Debug)]
pub struct AxialDampingLanes<L, Q, R> {
    /// Unstretched length.
    pub l: R,
    /// `η EA`.
    pub eta_ea: R,
    /// Axial strain.
    pub model: L,
    /// Where it is taken.
    pub rule: Q,
}

impl<L: Longitudinal, Q: Quadrature> AxialDamping<L, Q> {
    /// For an element of length `l`.
    pub fn new(l: f64, eta_ea: f64, model: L, rule: Q) -> Self {
        AxialDamping { l, eta_ea, model, rule }
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
    type Lanes<R: Real> = AxialDampingLanes<L, Q, R>;
    const SETS: bool = true;

    fn label(&self) -> String {
        format!("axial damping {} {}", self.model.label(), self.rule.label())
    }
    fn symmetric(&self) -> bool {
        false
    }
    fn has_tangent(w: &Weights) -> bool {
        w.q != 0.0 || w.v != 0.0
    }
    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R> {
        let &AxialDamping { model, rule, .. } = batch.first();
        AxialDampingLanes { l: batch.get(|e| e.l), eta_ea: batch.get(|e| e.eta_ea), model, rule }
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        &AxialDampingLanes { l, eta_ea, model, rule }: &Self::Lanes<R>,
        x: &Local<R, 12, 12>,
        w: &Weights,
        out: &mut Share<R, 12>,
    ) {
        let il = R::of(1.0) / l;
        let (q, v) = (natural(&x.q, il), natural(&x.v, il));
        let mut local = Reduced::zero();
        let mut products = [None; MOST];
        for (at, product) in model.points(rule).iter().zip(&mut products) {
            let strain = model.strain(&q, at);
            let c = eta_ea * l * R::of(at.w);
            let force = c * strain.rate(&v);
            let gradient = strain.gradient();
            local.add_force(force, &gradient);
            if TANGENT {
                let rate_by = blend(R::of(w.q), &strain.turn(&v), R::of(w.v), &gradient);
                *product = Product::new(c, &gradient, &rate_by, il);
                strain.add_hessian(R::of(w.q) * force, &mut local);
            }
        }
        local.spread_force::<true>(il, out);
        if TANGENT {
            local.spread_tangent::<true>(il, R::of(1.0), out);
            add_products(&products, out);
        }
    }
    #[inline(always)]
    fn power<R: Real>(
        &AxialDampingLanes { l, eta_ea, model, rule }: &Self::Lanes<R>,
        x: &Local<R, 12, 12>,
    ) -> Power<R> {
        let il = R::of(1.0) / l;
        let (q, v) = (natural(&x.q, il), natural(&x.v, il));
        let mut dissipated = R::zero();
        for at in model.points(rule) {
            let rate = model.strain(&q, at).rate(&v);
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
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self, models: Models<L, T, Q>) {
        let Models { longitudinal, rule, .. } = models;
        if self.bending {
            self.sink.push(BendingDamping::new(self.l, self.eta, rule.bending()), self.nodes);
        } else {
            self.sink.push(AxialDamping::new(self.l, self.eta, longitudinal, rule.axial()), self.nodes);
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
