//! Elasticity that changes along an element or isn't proportional to the strain: EA and EI that go linearly from one end to
//! the other, tables, ropes that don't push.
//!
//! Such an element has the [`Cable`](super::Cable) for its mass, without stiffness. One kernel serves all stiffness models; tables
//! are rare beside what else there is, and looked up for one element at a time.

use super::T1;
use super::element::CableParams;
use super::law::Curve;
use super::longitudinal::{Longitudinal, Strain};
use super::model::{ChosenModels, Models, Sink};
use super::quadrature::{Quadrature, Rule};
use super::reduced::Reduced;
use super::relaxed::capped;
use super::shape::{Natural, natural};
use super::transverse::{Curve as Bend, Transverse};
use ropewalk_core::{Batch, Element, Energy, Local, NodeId, Real, Share, Weights};
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

/// Energy per length [J/m], force [N] and stiffness [N] at a place of an element with this stiffness at its ends, or what its table
/// is multiplied by; none below the strain at which it grows slack.
#[inline(always)]
fn stretched<R: Real>(ends: &[R; 2], table: Option<&Curve>, slack: R, xi: f64, eps: R) -> [R; 3] {
    let mut of = [R::of(0.5) * eps * eps, eps, R::of(1.0)];
    if let Some(table) = table {
        of = tabulated(eps, |eps| table.at(eps));
    }
    for x in &mut of {
        *x = slack.if_gt(eps, R::zero(), between(ends, xi) * *x);
    }
    of
}

/// Energy per length [J/m], and its first and second derivative by the square of the curvature.
#[inline(always)]
fn bent<R: Real>(ends: &[R; 2], table: Option<&Curve>, xi: f64, square: R) -> [R; 3] {
    let mut of = [R::of(0.5) * square, R::of(0.5), R::zero()];
    if let Some(table) = table {
        of = tabulated(square, |square| table.by_square(square));
    }
    for x in &mut of {
        *x = between(ends, xi) * *x;
    }
    of
}

#[inline(always)]
fn between<R: Real>([a, b]: &[R; 2], xi: f64) -> R {
    R::of(xi).fma(*b - *a, *a)
}

/// Numbers that a table gives, lane by lane.
#[inline(always)]
fn tabulated<R: Real>(x: R, at: impl Fn(f64) -> [f64; 3]) -> [R; 3] {
    [x.map(|x| at(x)[0]), x.map(|x| at(x)[1]), x.map(|x| at(x)[2])]
}

impl Stretching {
    /// Energy per length [J/m], force [N] and stiffness [N] at a place of the element and this strain.
    pub fn at(&self, xi: f64, eps: f64) -> [f64; 3] {
        stretched(&self.ends, self.table.as_deref(), self.slack(), xi, eps)
    }
    /// The strain below which there is no force.
    fn slack(&self) -> f64 {
        if self.tension_only { 0.0 } else { f64::NEG_INFINITY }
    }
}

impl Bending {
    /// Whether there is any.
    fn is_some(&self) -> bool {
        self.table.is_some() || self.ends != [0.0; 2]
    }
    /// The moment at a place of the element and this curvature [N m].
    pub fn moment(&self, xi: f64, kappa: f64) -> f64 {
        2.0 * bent(&self.ends, self.table.as_deref(), xi, kappa * kappa)[1] * kappa
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
    /// What it adds to the force that the element with these dofs transmits [N].
    pub fn transmits(&self, q: &[f64; 12]) -> [f64; 3] {
        let x = Local { q: *q, v: [0.0; 12], a: [0.0; 12], last: [0.0; 12], relaxed: None };
        let mut out = Share::<f64, 12>::zero();
        let lanes = Lanes::of(&Batch::of(std::slice::from_ref(self)), self.tables());
        lanes.add::<false>(&x, &Weights { q: 0.0, v: 0.0, a: 0.0 }, &mut out);
        [out.r[6], out.r[7], out.r[8]]
    }

    fn tables(&self) -> [Option<Arc<Curve>>; 2] {
        [self.stretching.table.clone(), self.bending.table.clone()]
    }

    /// Puts it into the pool of its kind.
    pub fn push(self, pools: &mut impl Sink, on: &[NodeId]) {
        if self.tables().iter().any(Option::is_some) {
            pools.push(Tabulated(self), on);
        } else {
            pools.push(Linear(self), on);
        }
    }
}

impl AsRef<Elastic> for Elastic {
    fn as_ref(&self) -> &Elastic {
        self
    }
}

/// Elasticity after a table: one element at a time.
#[derive(Clone, Debug)]
struct Tabulated(Elastic);

/// Elasticity without one, over lanes.
#[derive(Clone, Debug)]
struct Linear(Elastic);

/// The numbers of elements over lanes.
pub(crate) struct Lanes<R> {
    params: CableParams<R>,
    /// Stiffness at both ends, or what a table is multiplied by.
    ea: [R; 2],
    ei: [R; 2],
    /// The strain below which there is no force.
    slack: R,
    bends: bool,
    tables: [Option<Arc<Curve>>; 2],
    models: ChosenModels,
}

impl<R: Real> Lanes<R> {
    #[inline(always)]
    fn of<E: AsRef<Elastic>>(batch: &Batch<'_, E>, tables: [Option<Arc<Curve>>; 2]) -> Self {
        let bends: R = batch.get(|e| f64::from(u8::from(e.as_ref().bending.is_some())));
        Lanes {
            params: CableParams {
                l: batch.get(|e| e.as_ref().params.l),
                ea: batch.get(|e| e.as_ref().params.ea),
                ei: batch.get(|e| e.as_ref().params.ei),
                rho_a: R::zero(),
            },
            ea: [batch.get(|e| e.as_ref().stretching.ends[0]), batch.get(|e| e.as_ref().stretching.ends[1])],
            ei: [batch.get(|e| e.as_ref().bending.ends[0]), batch.get(|e| e.as_ref().bending.ends[1])],
            slack: batch.get(|e| e.as_ref().stretching.slack()),
            bends: !R::of(0.5).all_gt(bends),
            tables,
            models: batch.first().as_ref().models,
        }
    }

    #[inline(always)]
    fn stretched(&self, xi: f64, eps: R) -> [R; 3] {
        stretched(&self.ea, self.tables[0].as_deref(), self.slack, xi, eps)
    }
    #[inline(always)]
    fn bent(&self, xi: f64, square: R) -> [R; 3] {
        bent(&self.ei, self.tables[1].as_deref(), xi, square)
    }

    /// Adds the axial force, and with `TANGENT` its derivative, relaxed if a search for equilibrium asks for it, see
    /// [`relaxed`](super::relaxed).
    #[inline(always)]
    fn stretch<const TANGENT: bool>(&self, q: &Natural<R>, x: &Local<R, 12, 12>, out: &mut Reduced<R>) {
        let (p, model) = (&self.params, self.models.longitudinal);
        // the pool relaxes in scalar only, so wide copies needn't know how
        let relaxed = if R::LANES == 1 { x.relaxed.as_ref() } else { None };
        let mut part = [R::of(1.0); 2];
        if let Some(how) = relaxed {
            part = [how.ramp, how.ramp_before].map(|ramp| capped(p, ramp, how.load) / p.ea);
        }
        for at in self.models.points() {
            let strain = model.strain(q, at);
            let eps = strain.eps();
            let w = part[0] * p.l * R::of(at.w);
            let [_, force, slope] = self.stretched(at.xi, eps);
            let stress = w * force;
            out.add_force(stress, &strain.gradient());
            if !TANGENT {
                continue;
            }
            let (mut material, mut mixed) = (w * slope, stress);
            if let Some(how) = relaxed {
                if how.smooth {
                    let last = natural(&x.last, R::of(1.0) / p.l);
                    let then = model.strain(&minus(q, &last), at);
                    let linear = then.eps() + then.rate(&last);
                    mixed = part[1] * p.l * R::of(at.w) * self.stretched(at.xi, linear)[1];
                }
                if let Some(floor) = how.floor {
                    let floor = R::of(floor * at.w) * p.l;
                    mixed = mixed.if_gt(floor, mixed, floor);
                    // where it pulls, at the least
                    material = w * self.stretched(at.xi, eps.if_gt(self.slack, eps, self.slack))[2];
                }
            }
            strain.add_stiffness(material, mixed, out);
        }
    }

    /// Adds the bending force, and with `TANGENT` its derivative.
    #[inline(always)]
    fn bend<const TANGENT: bool>(&self, q: &Natural<R>, x: &Local<R, 12, 12>, out: &mut Reduced<R>) {
        let (il, l) = (R::of(1.0) / self.params.l, self.params.l);
        let positive = R::LANES == 1 && x.relaxed.as_ref().is_some_and(|how| how.floor.is_some());
        for at in self.models.rule.bending().points() {
            let bend = Bend::new(self.models.transverse, q, at, il);
            let w = l * R::of(at.w);
            let [_, by, again] = self.bent(at.xi, bend.square.value);
            let (by, again) = (w * by, w * again);
            bend.add_force(by, out);
            if TANGENT && positive {
                Bend::new(T1, q, at, il).add_hessian(by, out);
            } else if TANGENT {
                bend.add_hessian(by, out);
                out.add_square(again, &bend.gradient());
            }
        }
    }

    #[inline(always)]
    fn add<const TANGENT: bool>(&self, x: &Local<R, 12, 12>, w: &Weights, out: &mut Share<R, 12>) {
        let il = R::of(1.0) / self.params.l;
        let q = natural(&x.q, il);
        let mut local = Reduced::zero();
        self.stretch::<TANGENT>(&q, x, &mut local);
        if self.bends {
            self.bend::<TANGENT>(&q, x, &mut local);
        }
        local.spread_force::<true>(il, out);
        if TANGENT {
            local.spread_tangent::<true>(il, R::of(w.q), out);
        }
    }

    #[inline(always)]
    fn energy(&self, x: &Local<R, 12, 12>) -> Energy<R> {
        let (il, l) = (R::of(1.0) / self.params.l, self.params.l);
        let q = natural(&x.q, il);
        let mut potential = R::zero();
        for at in self.models.points() {
            let eps = self.models.longitudinal.strain(&q, at).eps();
            potential += l * R::of(at.w) * self.stretched(at.xi, eps)[0];
        }
        if !self.bends {
            return Energy { kinetic: R::zero(), potential };
        }
        for at in self.models.rule.bending().points() {
            let square = Bend::new(self.models.transverse, &q, at, il).square.value;
            potential += l * R::of(at.w) * self.bent(at.xi, square)[0];
        }
        Energy { kinetic: R::zero(), potential }
    }
}

fn minus<R: Real>(a: &Natural<R>, b: &Natural<R>) -> Natural<R> {
    std::array::from_fn(|i| std::array::from_fn(|c| a[i][c] - b[i][c]))
}

macro_rules! elements {
    ($name:ident, $wide:literal) => {
        impl AsRef<Elastic> for $name {
            #[inline(always)]
            fn as_ref(&self) -> &Elastic {
                &self.0
            }
        }

        impl Element<12, 12> for $name {
            type Lanes<R: Real> = Lanes<R>;
            const WIDE: bool = $wide;
            const SETS: bool = true;

            fn label(&self) -> String {
                let Models { longitudinal, transverse, rule } = self.0.models;
                format!("elasticity {}+{} {}", longitudinal.label(), transverse.label(), rule.label())
            }
            fn has_tangent(w: &Weights) -> bool {
                w.q != 0.0
            }
            #[inline(always)]
            fn lanes<R: Real>(batch: &Batch<'_, Self>) -> Lanes<R> {
                Lanes::of(batch, if $wide { [None, None] } else { batch.first().0.tables() })
            }
            #[inline(always)]
            fn add<R: Real, const TANGENT: bool>(
                p: &Lanes<R>,
                x: &Local<R, 12, 12>,
                w: &Weights,
                out: &mut Share<R, 12>,
            ) {
                p.add::<TANGENT>(x, w, out);
            }
            #[inline(always)]
            fn energy<R: Real>(p: &Lanes<R>, x: &Local<R, 12, 12>) -> Energy<R> {
                p.energy(x)
            }
        }
    };
}
elements!(Tabulated, false);
elements!(Linear, true);
