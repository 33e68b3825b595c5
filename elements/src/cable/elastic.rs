//! Elasticity that changes along an element or isn't proportional to the strain: EA and EI that go linearly from one end to
//! the other, tables, ropes that don't push.
//!
//! Such an element has the [`Cable`](super::Cable) for its mass, without stiffness. It is rare beside the others: one kernel
//! serves all stiffness models, one element at a time.

use super::T1;
use super::element::CableParams;
use super::law::Curve;
use super::longitudinal::{Longitudinal, Strain};
use super::model::{ChosenModels, Models};
use super::quadrature::{Quadrature, Rule};
use super::reduced::Reduced;
use super::relaxed::capped;
use super::shape::{Natural, natural};
use super::transverse::{Curve as Bend, Transverse};
use ropewalk_core::{Batch, Element, Energy, Local, Real, Relaxation, Share, Weights};
use std::sync::Arc;

/// Axial force as a function of the strain: linear, or after a table.
#[derive(Clone, Debug)]
pub(crate) struct Stretching {
    /// Stiffness EA at both ends of the element [N]; 1 with a table, which has the force.
    pub ends: [f64; 2],
    /// Force over strain; linear without.
    pub table: Option<Arc<Curve>>,
    /// Whether it only pulls.
    pub tension_only: bool,
}

/// Bending moment as a function of the curvature: linear, or after a table.
#[derive(Clone, Debug)]
pub(crate) struct Bending {
    /// Stiffness EI at both ends of the element [N m²]; 1 with a table, which has the moment.
    pub ends: [f64; 2],
    /// Moment over curvature; linear without.
    pub table: Option<Arc<Curve>>,
}

fn between([a, b]: [f64; 2], xi: f64) -> f64 {
    a + xi * (b - a)
}

impl Stretching {
    /// Energy per length [J/m], force [N] and stiffness [N] at a place of the element and this strain.
    pub fn at(&self, xi: f64, eps: f64) -> [f64; 3] {
        let scale = between(self.ends, xi);
        let of = |eps: f64| self.table.as_ref().map_or([0.5 * eps * eps, eps, 1.0], |table| table.at(eps));
        if self.tension_only && eps < 0.0 {
            return [0.0; 3];
        }
        of(eps).map(|x| scale * x)
    }
    /// Stiffness where it pulls, at the least.
    fn taut(&self, xi: f64, eps: f64) -> f64 {
        self.at(xi, if self.tension_only { eps.max(0.0) } else { eps })[2]
    }
}

impl Bending {
    /// Energy per length [J/m], and its first and second derivative by the square of the curvature.
    fn by_square(&self, xi: f64, square: f64) -> [f64; 3] {
        let scale = between(self.ends, xi);
        let linear = [0.5 * square, 0.5, 0.0];
        self.table.as_ref().map_or(linear, |table| table.by_square(square)).map(|x| scale * x)
    }
    /// Whether there is any.
    fn is_some(&self) -> bool {
        self.table.is_some() || self.ends != [0.0; 2]
    }
    /// The moment at a place of the element and this curvature [N m].
    pub fn moment(&self, xi: f64, kappa: f64) -> f64 {
        2.0 * self.by_square(xi, kappa * kappa)[1] * kappa
    }
}

/// Elastic force of an element where that of [`Cable`](super::Cable) doesn't do.
#[derive(Clone, Debug)]
pub(crate) struct Elastic {
    /// Length, and the largest stiffnesses.
    pub params: CableParams,
    /// How it stretches.
    pub stretching: Stretching,
    /// How it bends.
    pub bending: Bending,
    /// Strain measures and quadrature.
    pub models: ChosenModels,
}

impl Elastic {
    /// Adds the axial force, and with `TANGENT` its derivative, relaxed if a search for equilibrium asks for it, see
    /// [`relaxed`](super::relaxed).
    #[inline(always)]
    fn stretch<R: Real, const TANGENT: bool>(
        &self,
        q: &Natural<R>,
        x: &Local<R, 12, 12>,
        out: &mut Reduced<R>,
    ) {
        let law = &self.stretching;
        let (model, l) = (self.models.longitudinal, self.params.l);
        let part = |ramp: f64, how: &Relaxation| capped(&self.params, ramp, how.load) / self.params.ea;
        let [now, before] =
            x.relaxed.as_ref().map_or([1.0; 2], |how| [part(how.ramp, how), part(how.ramp_before, how)]);
        for at in self.models.points() {
            let strain = model.strain(q, at);
            let w = now * l * at.w;
            let stress = strain.eps().map(|eps| w * law.at(at.xi, eps)[1]);
            out.add_force(stress, &strain.gradient());
            if !TANGENT {
                continue;
            }
            let mut material = strain.eps().map(|eps| w * law.at(at.xi, eps)[2]);
            let mut mixed = stress;
            if let Some(how) = &x.relaxed {
                if how.smooth {
                    let last = natural(&x.last, R::of(1.0 / l));
                    let then = model.strain(&minus(q, &last), at);
                    let linear = then.eps() + then.rate(&last);
                    mixed = linear.map(|eps| before * l * at.w * law.at(at.xi, eps)[1]);
                }
                if let Some(floor) = how.floor {
                    let floor = R::of(floor * at.w * l);
                    mixed = mixed.if_gt(floor, mixed, floor);
                    material = strain.eps().map(|eps| w * law.taut(at.xi, eps));
                }
            }
            strain.add_stiffness(material, mixed, out);
        }
    }

    /// Adds the bending force, and with `TANGENT` its derivative.
    #[inline(always)]
    fn bend<R: Real, const TANGENT: bool>(&self, q: &Natural<R>, x: &Local<R, 12, 12>, out: &mut Reduced<R>) {
        let (il, l) = (R::of(1.0 / self.params.l), self.params.l);
        let law = &self.bending;
        let positive = x.relaxed.as_ref().is_some_and(|how| how.floor.is_some());
        for at in self.models.rule.bending().points() {
            let bend = Bend::new(self.models.transverse, q, at, il);
            let by = |k: usize| bend.square.value.map(|z| l * at.w * law.by_square(at.xi, z)[k]);
            bend.add_force(by(1), out);
            if TANGENT && positive {
                Bend::new(T1, q, at, il).add_hessian(by(1), out);
            } else if TANGENT {
                bend.add_hessian(by(1), out);
                out.add_square(by(2), &bend.gradient());
            }
        }
    }

    /// What it adds to the force that the element with these dofs transmits [N].
    pub fn transmits(&self, q: &[f64; 12]) -> [f64; 3] {
        let x = Local { q: *q, v: [0.0; 12], a: [0.0; 12], last: [0.0; 12], relaxed: None };
        let mut out = Share::<f64, 12>::zero();
        Self::add::<f64, false>(self, &x, &Weights { q: 0.0, v: 0.0, a: 0.0 }, &mut out);
        [out.r[6], out.r[7], out.r[8]]
    }
}

fn minus<R: Real>(a: &Natural<R>, b: &Natural<R>) -> Natural<R> {
    std::array::from_fn(|i| std::array::from_fn(|c| a[i][c] - b[i][c]))
}

impl Element<12, 12> for Elastic {
    type Lanes<R: Real> = Elastic;
    const WIDE: bool = false;

    fn label(&self) -> String {
        let Models { longitudinal, transverse, rule } = self.models;
        format!("elasticity {}+{} {}", longitudinal.label(), transverse.label(), rule.label())
    }
    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Elastic {
        batch.first().clone()
    }
    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        p: &Elastic,
        x: &Local<R, 12, 12>,
        w: &Weights,
        out: &mut Share<R, 12>,
    ) {
        let il = R::of(1.0 / p.params.l);
        let q = natural(&x.q, il);
        let mut local = Reduced::zero();
        p.stretch::<R, TANGENT>(&q, x, &mut local);
        if p.bending.is_some() {
            p.bend::<R, TANGENT>(&q, x, &mut local);
        }
        local.spread_force::<false>(il, out);
        if TANGENT {
            local.spread_tangent::<false>(il, R::of(w.q), out);
        }
    }
    #[inline(always)]
    fn energy<R: Real>(p: &Elastic, x: &Local<R, 12, 12>) -> Energy<R> {
        let (il, l) = (R::of(1.0 / p.params.l), p.params.l);
        let q = natural(&x.q, il);
        let mut potential = R::zero();
        for at in p.models.points() {
            let eps = p.models.longitudinal.strain(&q, at).eps();
            potential += eps.map(|eps| l * at.w * p.stretching.at(at.xi, eps)[0]);
        }
        if !p.bending.is_some() {
            return Energy { kinetic: R::zero(), potential };
        }
        for at in p.models.rule.bending().points() {
            let square = Bend::new(p.models.transverse, &q, at, il).square.value;
            potential += square.map(|z| l * at.w * p.bending.by_square(at.xi, z)[0]);
        }
        Energy { kinetic: R::zero(), potential }
    }
}
