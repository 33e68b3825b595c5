//! Cables that are bent or stretched when free of stress.
//!
//! The strain energy `½ EA (ε - ε₀)² + ½ EI (κ - κ₀)²` differs from that of a straight cable by terms linear in ε and
//! κ. They are elements of their own, so that a straight cable doesn't carry them. Subtracting from the strain, and
//! not from the force, keeps it independent of how the cable is turned.

use super::element::CableParams;
use super::longitudinal::{Longitudinal, Strain};
use super::model::{CableModel, Models, Sink, WithModels, with_models};
use super::quadrature::{MOST, Quadrature, Rule};
use super::reduced::Reduced;
use super::shape::natural;
use super::transverse::{Curve, Transverse};
use ropewalk_core::{Batch, Element, Energy, Local, NodeId, Real, Share, Weights};

/// One number for each point of a quadrature rule; those behind the last point count for nothing.
pub type AtPoints<R> = [R; MOST];

/// Curvature times length below which a point counts as straight.
pub(super) const STRAIGHT: f64 = 1e-6;

/// Stress-free strain: adds the energy `EA ∫ (½ ε₀² - ε₀ ε) dx`.
#[derive(Clone, Copy, Debug)]
pub struct AxialRest<L, Q> {
    /// Unstretched length [m].
    pub l: f64,
    /// Axial stiffness [N].
    pub ea: f64,
    /// Stress-free strain at the points of the model, in the model's own measure.
    pub eps0: AtPoints<f64>,
    /// Axial strain.
    pub model: L,
    /// Where it is taken.
    pub rule: Q,
}

impl<L: Longitudinal, Q: Quadrature> AxialRest<L, Q> {
    /// For an element of length `l` and axial stiffness `ea`.
    pub fn new(l: f64, ea: f64, eps0: AtPoints<f64>, model: L, rule: Q) -> Self {
        AxialRest { l, ea, eps0, model, rule }
    }
    /// Stress-free at the shape `e`.
    pub fn at_shape(l: f64, ea: f64, e: &[f64; 12], model: L, rule: Q) -> Self {
        let (q, mut eps0) = (natural(e, 1.0 / l), [0.0; MOST]);
        for (eps0, at) in eps0.iter_mut().zip(model.points(rule)) {
            *eps0 = model.strain(&q, at).eps();
        }
        Self::new(l, ea, eps0, model, rule)
    }
}

/// An element's length, stiffness and numbers at the points, and the model and quadrature of all lanes.
#[derive(Clone, Copy, Debug)]
pub struct RestLanes<M, Q, R> {
    /// Unstretched length.
    pub l: R,
    /// `EA` or `EI`.
    pub stiffness: R,
    /// `ε₀` or `κ₀`.
    pub rest: AtPoints<R>,
    pub(super) model: M,
    pub(super) rule: Q,
}

impl<L: Longitudinal, Q: Quadrature> Element<12, 12> for AxialRest<L, Q> {
    type Lanes<R: Real> = RestLanes<L, Q, R>;

    fn label(&self) -> String {
        format!("stress-free strain {} {}", self.model.label(), self.rule.label())
    }
    fn has_tangent(w: &Weights) -> bool {
        w.q != 0.0
    }
    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R> {
        let &Self { model, rule, .. } = batch.first();
        let mut rest = [R::zero(); MOST];
        for k in 0..MOST {
            rest[k] = batch.get(|e| e.eps0[k]);
        }
        RestLanes { l: batch.get(|e| e.l), stiffness: batch.get(|e| e.ea), rest, model, rule }
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        p: &Self::Lanes<R>,
        x: &Local<R, 12, 12>,
        w: &Weights,
        out: &mut Share<R, 12>,
    ) {
        let il = R::of(1.0) / p.l;
        let q = natural(&x.q, il);
        let mut local = Reduced::zero();
        for (at, eps0) in p.model.points(p.rule).iter().zip(p.rest) {
            let strain = p.model.strain(&q, at);
            let stress = -(p.stiffness * p.l * R::of(at.w) * eps0);
            local.add_force(stress, &strain.gradient());
            if TANGENT {
                strain.add_hessian(stress, &mut local);
            }
        }
        local.spread_force::<false>(il, out);
        if TANGENT {
            local.spread_tangent::<false>(il, R::of(w.q), out);
        }
    }
    #[inline(always)]
    fn energy<R: Real>(p: &Self::Lanes<R>, x: &Local<R, 12, 12>) -> Energy<R> {
        let q = natural(&x.q, R::of(1.0) / p.l);
        let mut potential = R::zero();
        for (at, eps0) in p.model.points(p.rule).iter().zip(p.rest) {
            let eps = p.model.strain(&q, at).eps();
            potential += p.stiffness * p.l * R::of(at.w) * eps0 * (R::of(0.5) * eps0 - eps);
        }
        Energy { kinetic: R::zero(), potential }
    }
}

/// Stress-free curvature: adds the energy `EI ∫ (½ κ₀² - κ₀ κ) dx`.
///
/// κ₀ is a number without a direction, for a cable that may turn about its axis as it likes: in its straightened state
/// it may fall to any side, and nothing holds it in the plane in which it is bent. [`Directed`](super::Directed) knows
/// directions. There κ has a kink, so `√(κ² + κₛ²)` with `κₛ = 1e-6/L` takes its place; a
/// straight element with κ₀ > 0 is in unstable equilibrium.
#[derive(Clone, Copy, Debug)]
pub struct BendingRest<T, Q> {
    /// Unstretched length [m].
    pub l: f64,
    /// Bending stiffness [N m²].
    pub ei: f64,
    /// Stress-free curvature at the quadrature points, of `√(κ² + κₛ²)` [1/m].
    pub kappa0: AtPoints<f64>,
    /// Curvature.
    pub model: T,
    /// Where it is taken.
    pub rule: Q,
}

impl<T: Transverse, Q: Quadrature> BendingRest<T, Q> {
    /// For an element of length `l` and bending stiffness `ei`.
    pub fn new(l: f64, ei: f64, kappa0: AtPoints<f64>, model: T, rule: Q) -> Self {
        BendingRest { l, ei, kappa0, model, rule }
    }
    /// Stress-free at the shape `e`; points that are straight there stay so.
    pub fn at_shape(l: f64, ei: f64, e: &[f64; 12], model: T, rule: Q) -> Self {
        let (q, mut kappa0, s2) = (natural(e, 1.0 / l), [0.0; MOST], (STRAIGHT / l).powi(2));
        for (kappa0, at) in kappa0.iter_mut().zip(rule.points()) {
            let square = Curve::new(model, &q, at, 1.0 / l).square.value;
            *kappa0 = if square > s2 { (square + s2).sqrt() } else { 0.0 };
        }
        Self::new(l, ei, kappa0, model, rule)
    }
    /// Its numbers for one lane.
    pub fn to_lanes(&self) -> RestLanes<T, Q, f64> {
        Self::lanes(&Batch::of(std::slice::from_ref(self)))
    }
}

impl<T: Transverse, Q: Quadrature> Element<12, 12> for BendingRest<T, Q> {
    type Lanes<R: Real> = RestLanes<T, Q, R>;

    fn label(&self) -> String {
        format!("stress-free curvature {} {}", self.model.label(), self.rule.label())
    }
    fn has_tangent(w: &Weights) -> bool {
        w.q != 0.0
    }
    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R> {
        let &Self { model, rule, .. } = batch.first();
        let mut rest = [R::zero(); MOST];
        for k in 0..MOST {
            rest[k] = batch.get(|e| e.kappa0[k]);
        }
        RestLanes { l: batch.get(|e| e.l), stiffness: batch.get(|e| e.ei), rest, model, rule }
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        p: &Self::Lanes<R>,
        x: &Local<R, 12, 12>,
        w: &Weights,
        out: &mut Share<R, 12>,
    ) {
        let il = R::of(1.0) / p.l;
        let q = natural(&x.q, il);
        let kappa_s = R::of(STRAIGHT) * il;
        let mut local = Reduced::zero();
        for (at, kappa0) in p.rule.points().iter().zip(p.rest) {
            let curve = Curve::new(p.model, &q, at, il);
            let i2 = R::of(1.0) / kappa_s.fma(kappa_s, curve.square.value);
            // derivative of the energy by κ²
            let by = -(p.stiffness * p.l * R::of(0.5 * at.w) * kappa0 * i2.sqrt());
            let gradient = curve.gradient();
            local.add_force(by, &gradient);
            if TANGENT {
                curve.add_hessian(by, &mut local);
                local.add_square(R::of(-0.5) * by * i2, &gradient);
            }
        }
        local.spread_force::<false>(il, out);
        if TANGENT {
            local.spread_tangent::<false>(il, R::of(w.q), out);
        }
    }
    #[inline(always)]
    fn energy<R: Real>(p: &Self::Lanes<R>, x: &Local<R, 12, 12>) -> Energy<R> {
        let il = R::of(1.0) / p.l;
        let q = natural(&x.q, il);
        let s2 = R::of(STRAIGHT * STRAIGHT) * il * il;
        let (half, mut potential) = (R::of(0.5), R::zero());
        for (at, kappa0) in p.rule.points().iter().zip(p.rest) {
            let kappa = (Curve::new(p.model, &q, at, il).square.value + s2).sqrt();
            // with ½ EI κ² of the elastic term this is ½ EI (√(κ² + κₛ²) - κ₀)²
            let bent = half * kappa0.fma(kappa0, s2);
            let constant = kappa0.abs().if_gt(R::zero(), bent, R::zero());
            potential += p.stiffness * p.l * R::of(at.w) * (constant - kappa0 * kappa);
        }
        Energy { kinetic: R::zero(), potential }
    }
}

/// What an element looks like when free of stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rest {
    /// As long at each point as in this shape, the twelve dofs of the element; how it is bent there is told by
    /// [`Directed`](super::Directed).
    Stretched([f64; 12]),
    /// The same strain and curvature everywhere.
    Uniform {
        /// Strain in the model's own measure.
        eps0: f64,
        /// Curvature [1/m].
        kappa0: f64,
    },
}

struct Push<'a, S> {
    sink: &'a mut S,
    params: CableParams,
    rest: Rest,
    nodes: &'a [NodeId],
}

impl<S: Sink> WithModels for Push<'_, S> {
    type Output = ();
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self, models: Models<L, T, Q>) {
        let CableParams { l, ea, ei, .. } = self.params;
        let Models { longitudinal, transverse, rule } = models;
        let (points, bends) = (rule.axial(), rule.bending());
        let (axial, kappa0) = match self.rest {
            Rest::Stretched(e) => (AxialRest::at_shape(l, ea, &e, longitudinal, points), [0.0; MOST]),
            Rest::Uniform { eps0, kappa0 } => {
                (AxialRest::new(l, ea, [eps0; MOST], longitudinal, points), [kappa0; MOST])
            }
        };
        if axial.eps0.iter().any(|&x| x != 0.0) {
            self.sink.push(axial, self.nodes);
        }
        if kappa0.iter().any(|&x| x != 0.0) {
            self.sink.push(BendingRest::new(l, ei, kappa0, transverse, bends), self.nodes);
        }
    }
}

/// Pushes what a cable element of the chosen models needs to be free of stress at `rest`: nothing, stress-free
/// strain, stress-free curvature, or both.
pub fn push_rest(
    sink: &mut impl Sink,
    model: CableModel,
    params: CableParams,
    rest: Rest,
    nodes: &[NodeId],
) -> Result<(), String> {
    params.check()?;
    with_models(model, Push { sink, params, rest, nodes })
}
