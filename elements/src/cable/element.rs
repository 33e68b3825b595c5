//! The cable element: elastic force of one longitudinal and one transverse model, and the consistent mass.

use super::longitudinal::{Longitudinal, add_axial, axial_energy};
use super::model::Models;
use super::quadrature::Rule;
use super::reduced::Reduced;
use super::relaxed::{Step, add_relaxed, capped};
use super::shape::natural;
use super::transverse::{Transverse, bending_energy};
use ropewalk_core::{Batch, Element, Energy, Local, Real, Share, Weights};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What one cable element is made of; over lanes with `R` other than `f64`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CableParams<R = f64> {
    /// Unstretched length `L` [m].
    pub l: R,
    /// Axial stiffness `EA` [N].
    pub ea: R,
    /// Bending stiffness `EI` [N m²].
    pub ei: R,
    /// Mass per unstretched length `ρA`, structure and the water inside [kg/m].
    pub rho_a: R,
}

impl CableParams {
    /// Refuses what no cable can be made of.
    pub fn check(&self) -> Result<(), String> {
        if !(self.l.is_finite() && self.l > 0.0) {
            return Err(format!("the length of a cable element must be positive, not {} m", self.l));
        }
        for (name, x) in [("EA", self.ea), ("EI", self.ei), ("rhoA", self.rho_a)] {
            if !(x.is_finite() && x >= 0.0) {
                return Err(format!("{name} of a cable element must not be negative: {x}"));
            }
        }
        Ok(())
    }
}

/// A two-node cable element without torsion, in the absolute nodal coordinate formulation: the position of its curve
/// is a cubic, and its dofs are position and slope at both ends.
///
/// Use it for ropes, hoses, chains and thin beams that stretch and bend however far they like. It carries its
/// elastic force and its consistent mass; everything else (weight, drag, damping, a bent rest shape) is a pool of its
/// own. Which models go together is told by [`legal`](super::legal).
#[derive(Clone, Copy, Debug)]
pub struct Cable<L, T, Q> {
    /// Cross-section.
    pub params: CableParams,
    /// How it strains.
    pub models: Models<L, T, Q>,
}

impl<L: Longitudinal, T: Transverse, Q: Rule> Cable<L, T, Q> {
    /// An element of these properties.
    pub fn new(params: CableParams, models: Models<L, T, Q>) -> Self {
        Cable { params, models }
    }
}

/// Properties over lanes, and the models of all of them.
#[derive(Clone, Copy, Debug)]
pub struct CableLanes<L, T, Q, R> {
    params: CableParams<R>,
    models: Models<L, T, Q>,
}

impl<L: Longitudinal, T: Transverse, Q: Rule> Element<12, 12> for Cable<L, T, Q> {
    type Lanes<R: Real> = CableLanes<L, T, Q, R>;
    const SETS: bool = true;

    fn label(&self) -> String {
        let Models { longitudinal, transverse, rule } = self.models;
        format!("cable {}+{} {}", longitudinal.label(), transverse.label(), rule.label())
    }
    fn symmetric(&self) -> bool {
        self.models.longitudinal.symmetric()
    }

    #[inline(always)]
    fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Self::Lanes<R> {
        let params = CableParams {
            l: batch.get(|e| e.params.l),
            ea: batch.get(|e| e.params.ea),
            ei: batch.get(|e| e.params.ei),
            rho_a: batch.get(|e| e.params.rho_a),
        };
        CableLanes { params, models: batch.first().models }
    }

    #[inline(always)]
    fn add<R: Real, const TANGENT: bool>(
        &CableLanes { params: ref p, models }: &Self::Lanes<R>,
        x: &Local<R, 12, 12>,
        w: &Weights,
        out: &mut Share<R, 12>,
    ) {
        let Models { longitudinal, transverse, rule } = models;
        // what is elastic after a law of its own is here for its mass alone
        if x.relaxed.is_none() && R::of(f64::MIN_POSITIVE).all_gt(p.ea + p.ei) {
            out.r = [R::zero(); 12];
            if TANGENT {
                out.k = [[R::zero(); 12]; 12];
            }
            add_mass::<R, TANGENT>(p, &x.a, w.a, out);
            return;
        }
        let il = R::of(1.0) / p.l;
        let q = natural(&x.q, il);
        let mut local = Reduced::zero();
        let mut ea = p.ea;
        // the pool relaxes in scalar only, so wide copies needn't know how
        if R::LANES == 1
            && let Some(how) = &x.relaxed
        {
            let step = Step::new(&q, &natural(&x.last, il));
            ea = capped(p, how.ramp, how.load);
            add_relaxed::<L, T, Q, R, TANGENT>(models, p, how, il, &q, &step, &mut local);
        } else {
            add_axial::<L, Q::Axial, R, TANGENT>(longitudinal, rule.axial(), ea * p.l, &q, &mut local);
            transverse.add::<Q::Bending, R, TANGENT>(rule.bending(), p.ei, p.l, il, &q, &mut local);
        }
        local.spread_force::<true>(il, out);
        if TANGENT {
            local.spread_tangent::<true>(il, R::of(w.q), out);
            longitudinal.add_unsymmetric(R::of(w.q) * ea * p.l, &q, il, out);
        }
        add_mass::<R, TANGENT>(p, &x.a, w.a, out);
    }

    #[inline(always)]
    fn energy<R: Real>(CableLanes { params: p, models }: &Self::Lanes<R>, x: &Local<R, 12, 12>) -> Energy<R> {
        let il = R::of(1.0) / p.l;
        let q = natural(&x.q, il);
        let (m, mut twice) = (mass(p), R::zero());
        for i in 0..4 {
            for j in 0..4 {
                for c in 0..3 {
                    twice = (m[i][j] * x.v[3 * i + c]).fma(x.v[3 * j + c], twice);
                }
            }
        }
        let (axial, bending) = (
            axial_energy(models.longitudinal, models.rule.axial(), p.ea * p.l, &q),
            bending_energy(models.transverse, models.rule.bending(), p.ei, p.l, il, &q),
        );
        Energy { kinetic: R::of(0.5) * twice, potential: axial + bending }
    }
}

/// Consistent mass `ρA ∫ SᵀS dx`; each entry stands for a multiple of the 3×3 unit matrix.
#[inline(always)]
pub fn mass<R: Real>(p: &CableParams<R>) -> [[R; 4]; 4] {
    let m = p.rho_a * p.l * R::of(1.0 / 420.0);
    let (ml, mll) = (m * p.l, m * p.l * p.l);
    let (near, far) = (R::of(156.0) * m, R::of(54.0) * m);
    let (a, b) = (R::of(22.0) * ml, R::of(13.0) * ml);
    let (c, d) = (R::of(4.0) * mll, R::of(-3.0) * mll);
    [[near, a, far, -b], [a, c, b, d], [far, b, near, -a], [-b, d, -a, c]]
}

/// Adds `M v̇`, and with `TANGENT` `w M`.
#[inline(always)]
fn add_mass<R: Real, const TANGENT: bool>(p: &CableParams<R>, a: &[R; 12], w: f64, out: &mut Share<R, 12>) {
    let m = mass(p);
    for i in 0..4 {
        for j in 0..4 {
            let wm = R::of(w) * m[i][j];
            for c in 0..3 {
                out.r[3 * i + c] = m[i][j].fma(a[3 * j + c], out.r[3 * i + c]);
                if TANGENT {
                    out.k[3 * i + c][3 * j + c] += wm;
                }
            }
        }
    }
}
