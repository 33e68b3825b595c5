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
use super::quadrature::Rule;
use super::reduced::Reduced;
use super::shape::Natural;
use super::transverse::Transverse;
use super::{CableParams, T1};
use ropewalk_core::{Real, Relaxation};

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

/// Adds force and relaxed tangent of stretching and bending.
#[inline(always)]
pub fn add_relaxed<L: Longitudinal, T: Transverse, Q: Rule, R: Real, const TANGENT: bool>(
    models: Models<L, T, Q>,
    p: &CableParams<R>,
    how: &Relaxation,
    il: R,
    q: &Natural<R>,
    last: &Natural<R>,
    out: &mut Reduced<R>,
) {
    let Models { longitudinal, transverse, rule } = models;
    let ea_l = capped(p, how.ramp, how.load) * p.l;
    let before_l = capped(p, how.ramp_before, how.load) * p.l;
    for at in models.points() {
        let strain = longitudinal.strain(q, at);
        let c = ea_l * R::of(at.w);
        let stress = c * strain.eps();
        out.add_force(stress, &strain.gradient());
        if TANGENT {
            let mut mixed = stress;
            if how.smooth {
                let before: Natural<R> =
                    std::array::from_fn(|i| std::array::from_fn(|k| q[i][k] - last[i][k]));
                let strain = longitudinal.strain(&before, at);
                mixed = before_l * R::of(at.w) * (strain.eps() + strain.rate(last));
            }
            if let Some(floor) = how.floor {
                let floor = R::of(floor * at.w) * p.l;
                mixed = mixed.if_gt(floor, mixed, floor);
            }
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
