//! The cable on the way to an equilibrium: what changes in the tangent, and why.
//!
//! A cable is stiff in stretching and soft in bending. A Newton step that turns an element stretches it, to second
//! order, and the spurious tension then dominates the next tangent. Three remedies, none of which changes the
//! equilibrium:
//! - The geometric stiffness takes its stress from the strain *linearised at the iterate before*,
//!   `ε(q - d) + ∂ε(q - d)·d`, which is already near the final one (Magisano, Leonetti & Garcea, Comput. Methods
//!   Appl. Mech. Eng. 313, 2017).
//! - Where the shape is slack, so that the tangent isn't positive, that stress is given a floor, and the bending
//!   tangent is that of T1, which is positive for every shape.
//! - `EA` is capped at the first iterations by what the load can use, against locking.

use super::longitudinal::{Longitudinal, Strain};
use super::model::Models;
use super::quadrature::{Point, Rule};
use super::reduced::Reduced;
use super::shape::{Natural, natural};
use super::transverse::Transverse;
use super::{CableParams, T1};
use ropewalk_core::{Dual, Real, Relaxation};

/// `EA` under the cap: `ramp · max(1e5 EI/L², 1e4 load)`.
#[inline(always)]
pub fn capped<R: Real>(p: &CableParams<R>, ramp: f64, load: f64) -> R {
    if ramp.is_infinite() {
        return p.ea;
    }
    let (bending, load) = (p.ei * R::of(1e5) / (p.l * p.l), R::of(1e4 * load));
    let cap = R::of(ramp) * bending.if_gt(load, bending, load);
    p.ea.if_gt(cap, cap, p.ea)
}

/// The natural variables at the iterate before, and how they changed from there to first order.
#[derive(Clone, Copy, Debug)]
pub struct Step<R> {
    before: Natural<R>,
    rate: Natural<R>,
}

impl<R: Real> Step<R> {
    /// Of an element whose length stays.
    #[inline(always)]
    pub fn new(q: &Natural<R>, last: &Natural<R>) -> Self {
        let before = std::array::from_fn(|i| std::array::from_fn(|k| q[i][k] - last[i][k]));
        Step { before, rate: *last }
    }

    /// Of dofs `e` and a length `l` that came here by `d` and `dl`: what the length does to the strain is as large as what the
    /// dofs do, and all but cancels it where material is fed.
    #[inline(always)]
    pub fn fed(e: &[R; 12], d: &[R; 12], l: R, dl: R) -> Self {
        let e: [Dual<R>; 12] = std::array::from_fn(|i| Dual::new(e[i] - d[i], d[i]));
        let q = natural(&e, Dual::of(1.0) / Dual::new(l - dl, dl));
        Step { before: q.map(|x| x.map(|x| x.re)), rate: q.map(|x| x.map(|x| x.eps)) }
    }

    /// The axial force `EA ε` at a point that geometric stiffness is to be taken with, where the strain here is `eps`.
    #[inline(always)]
    pub fn stress<L: Longitudinal>(
        &self,
        longitudinal: L,
        p: &CableParams<R>,
        how: &Relaxation,
        at: &Point,
        eps: R,
    ) -> R {
        let mut stress = capped(p, how.ramp, how.load) * eps;
        if how.smooth {
            let strain = longitudinal.strain(&self.before, at);
            stress = capped(p, how.ramp_before, how.load) * (strain.eps() + strain.rate(&self.rate));
        }
        if let Some(floor) = how.floor {
            let floor = R::of(floor);
            stress = stress.if_gt(floor, stress, floor);
        }
        stress
    }
}

/// Adds force and relaxed tangent of stretching and bending.
#[inline(always)]
pub fn add_relaxed<L: Longitudinal, T: Transverse, Q: Rule, R: Real, const TANGENT: bool>(
    models: Models<L, T, Q>,
    p: &CableParams<R>,
    how: &Relaxation,
    il: R,
    q: &Natural<R>,
    step: &Step<R>,
    out: &mut Reduced<R>,
) {
    let Models { longitudinal, transverse, rule } = models;
    let ea_l = capped(p, how.ramp, how.load) * p.l;
    for at in models.points() {
        let strain = longitudinal.strain(q, at);
        let c = ea_l * R::of(at.w);
        let stress = c * strain.eps();
        out.add_force(stress, &strain.gradient());
        if TANGENT {
            let mixed = R::of(at.w) * p.l * step.stress(longitudinal, p, how, at, strain.eps());
            strain.add_stiffness(c, mixed, out);
        }
    }
    if TANGENT && how.floor.is_some() {
        transverse.add::<Q::Bending, R, false>(rule.bending(), p.ei, p.l, il, q, out);
        let force = out.g;
        T1.add::<Q::Bending, R, true>(rule.bending(), p.ei, p.l, il, q, out);
        out.g = force;
    } else {
        transverse.add::<Q::Bending, R, TANGENT>(rule.bending(), p.ei, p.l, il, q, out);
    }
}
