//! A term is one share of the equations of motion; a model is a flat list of them.

use crate::algebra::lane::{Real, Width};
use crate::model::capability::{Couples, Foresees, Remembers, Shows, Timed};
use crate::model::pattern::Pattern;
use crate::model::state::At;
use crate::model::structure::Structure;
use std::ops::AddAssign;

/// Kinetic and potential energy [J]; over lanes with `R` other than `f64`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Energy<R = f64> {
    /// Kinetic energy [J].
    pub kinetic: R,
    /// Potential energy: strain, weight, springs [J].
    pub potential: R,
}

impl<R: Real> Energy<R> {
    /// None.
    #[inline(always)]
    pub fn zero() -> Self {
        Energy { kinetic: R::zero(), potential: R::zero() }
    }
    /// The energy in one lane.
    #[inline(always)]
    pub(crate) fn lane(&self, l: usize) -> Energy {
        Energy { kinetic: self.kinetic.lane(l), potential: self.potential.lane(l) }
    }
}

impl AddAssign for Energy {
    fn add_assign(&mut self, e: Self) {
        self.kinetic += e.kinetic;
        self.potential += e.potential;
    }
}

/// Rates of the energy balance `d/dt (kinetic + potential) = supplied + carried - dissipated` [W]; over lanes with `R`
/// other than `f64`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Power<R = f64> {
    /// Turned into heat or left in the water.
    pub dissipated: R,
    /// Done by loads from outside.
    pub supplied: R,
    /// Carried over the ends by material that flows in or out.
    pub carried: R,
}

impl<R: Real> Power<R> {
    /// None.
    #[inline(always)]
    pub fn zero() -> Self {
        Power { dissipated: R::zero(), supplied: R::zero(), carried: R::zero() }
    }
    /// A share of the way from one to another.
    pub(crate) fn between(from: Self, to: Self, share: R) -> Self {
        let at = |from: R, to: R| share.fma(to - from, from);
        Power {
            dissipated: at(from.dissipated, to.dissipated),
            supplied: at(from.supplied, to.supplied),
            carried: at(from.carried, to.carried),
        }
    }
    /// The power in one lane.
    #[inline(always)]
    pub(crate) fn lane(&self, l: usize) -> Power {
        Power {
            dissipated: self.dissipated.lane(l),
            supplied: self.supplied.lane(l),
            carried: self.carried.lane(l),
        }
    }
}

impl AddAssign for Power {
    fn add_assign(&mut self, p: Self) {
        self.dissipated += p.dissipated;
        self.supplied += p.supplied;
        self.carried += p.carried;
    }
}

/// Which combination of derivatives the iteration matrix needs:
/// `q ∂r/∂q + v ∂r/∂v + a ∂r/∂v̇`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weights {
    /// Weight of the stiffness `∂r/∂q`.
    pub q: f64,
    /// Weight of the damping `∂r/∂v`.
    pub v: f64,
    /// Weight of the mass `∂r/∂v̇`.
    pub a: f64,
}

/// One share of the residual `r(q, v, v̇, t) = M v̇ + f_int - f_ext`, its derivatives, its energy and its power.
///
/// Most terms are a [`Pool`](crate::Pool) of elements, a field on stations, or a few lines like the spring in
/// `ropewalk-forces`. What a scene doesn't name is not in the list of terms and costs nothing.
pub trait Term: Send + Sync {
    /// A name for manifests, profiles and messages, such as `hose: drag`.
    fn label(&self) -> String;
    /// Declares which unknowns it couples: one [`Pattern::clique`] for each block of its tangent, in a fixed order.
    fn pattern(&self, p: &mut Pattern);
    /// Whether its tangent is symmetric for every choice of [`Weights`]. One term that isn't makes the solver
    /// take the unsymmetric path.
    fn symmetric(&self) -> bool {
        true
    }
    /// Whether its tangent has more than noughts with these weights: where a matrix alone is wanted it isn't asked otherwise.
    fn has_tangent(&self, _: &Weights) -> bool {
        true
    }
    /// Whether it is a load from outside, which [critical factors](crate::solve::modes::Critical) scale.
    fn is_load(&self) -> bool {
        false
    }
    /// What it is called where its forces are drawn as arrows, if it acts on parts from outside or between them: in a word,
    /// such as `contact`. Forces within a part, and its inertia, aren't drawn.
    fn acts(&self) -> Option<&'static str> {
        self.is_load().then_some("load")
    }
    /// Adds its share of the residual and, if wanted, of the tangent.
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>);
    /// Its kinetic and potential energy.
    fn energy(&self, _at: &At<'_>) -> Energy {
        Energy::default()
    }
    /// The power that it takes out or brings in. Part of the contract: the audit adds these up.
    fn power(&self, _at: &At<'_>) -> Power {
        Power::default()
    }
    /// Both at once, as every step of a run asks for them: a term that looks for what touches overrides it, so that it looks
    /// once.
    fn balance(&self, at: &At<'_>) -> (Energy, Power) {
        (self.energy(at), self.power(at))
    }
    /// Whether its force has a kink in velocities that a step may leap over, such as dry friction between slip and stick:
    /// only then does [`Assembly::leap`] say anything.
    fn kinked(&self) -> bool {
        false
    }
    /// What time does to it, if it depends on time otherwise than through the state.
    fn timed(&self) -> Option<&dyn Timed> {
        None
    }
    /// What it has ahead, if a long step could miss something.
    fn foresees(&self) -> Option<&dyn Foresees> {
        None
    }
    /// What it remembers, if it does.
    fn remembers(&self) -> Option<&dyn Remembers> {
        None
    }
    /// How what it couples changes with the state, if it does.
    fn couples(&self) -> Option<&dyn Couples> {
        None
    }
    /// What it shows of itself, if it does.
    fn shows(&self) -> Option<&dyn Shows> {
        None
    }
    /// The effects that it applies together, each as a term of its own; none if it is a single one. For ledgers: these
    /// are evaluated for forces, energy and power, but never assembled into a matrix.
    fn effects(&self) -> Vec<Box<dyn Term>> {
        Vec::new()
    }
}

/// What an evaluation of Newton's method comes from.
///
/// Where a kink may lie in between, the tangent on this side of it says nothing about the other: a term may then add the
/// force and the tangent that lead to the kink instead of its own, and say so with [`Assembly::approximates`].
#[derive(Clone, Copy, Debug)]
pub enum Leap<'a> {
    /// A prediction from the start of the step.
    Predicted,
    /// The iterate with these velocities.
    From(&'a [f64]),
}

/// Where the terms add: the residual and, if wanted, the entries of the iteration matrix.
pub struct Assembly<'a> {
    pub(crate) residual: &'a mut [f64],
    pub(crate) values: Option<&'a mut [f64]>,
    pub(crate) weights: Weights,
    pub(crate) width: Width,
    pub(crate) structure: &'a Structure,
    /// First clique of the current term.
    pub(crate) clique: usize,
    /// For blocks on their way out of lanes.
    pub(crate) scratch: &'a mut Vec<f64>,
    /// What a term with kinks is told, and whether it took its force for another.
    pub(crate) leap: Option<Leap<'a>>,
    pub(crate) approximate: &'a mut bool,
}

impl Assembly<'_> {
    /// Whether the tangent is wanted too.
    #[inline(always)]
    pub fn wants_tangent(&self) -> bool {
        self.values.is_some()
    }
    /// The weights of the tangent; all zero where none is wanted.
    #[inline(always)]
    pub fn weights(&self) -> Weights {
        self.weights
    }
    /// What this evaluation comes from, where that is worth knowing.
    #[inline(always)]
    pub fn leap(&self) -> Option<Leap<'_>> {
        self.leap
    }
    /// Says that a force was only approximated: what follows from it is no solution yet.
    pub fn approximates(&mut self) {
        *self.approximate = true;
    }
    /// The number of lanes to work with.
    pub fn width(&self) -> Width {
        self.width
    }
    /// Adds to one equation of the residual.
    #[inline(always)]
    pub fn add(&mut self, dof: usize, r: f64) {
        self.residual[dof] += r;
    }
    /// Adds to equations of the residual that follow each other.
    #[inline(always)]
    pub(crate) fn add_slice(&mut self, first: usize, r: &[f64]) {
        for (sum, r) in self.residual[first..first + r.len()].iter_mut().zip(r) {
            *sum += r;
        }
    }
    /// The same of a number of them that is known while compiling.
    #[inline(always)]
    pub(crate) fn add_run<const N: usize>(&mut self, first: usize, r: &[f64; N]) {
        for (sum, r) in self.residual[first..first + N].iter_mut().zip(r) {
            *sum += r;
        }
    }
    /// Adds the block of the term's clique number `clique`, which has `n` unknowns: `k(i, j)` for row `i` and
    /// column `j`. Does nothing where no tangent is wanted.
    #[inline(always)]
    pub fn add_block(&mut self, clique: usize, n: usize, k: impl Fn(usize, usize) -> f64) {
        let Some(values) = self.values.as_deref_mut() else { return };
        for t in self.structure.tiles(self.clique + clique) {
            debug_assert!((t.row + t.rows) as usize <= n && (t.column + t.columns) as usize <= n);
            for i in 0..t.rows as usize {
                let row = &mut values[t.at as usize + i * t.stride as usize..][..t.columns as usize];
                for (j, value) in row.iter_mut().enumerate() {
                    *value += k(t.row as usize + i, t.column as usize + j);
                }
            }
        }
    }
    /// The same for a block in memory, of which the first rows and columns count.
    #[inline(always)]
    pub fn add_square<const N: usize>(&mut self, clique: usize, k: &[[f64; N]; N]) {
        let Some(values) = self.values.as_deref_mut() else { return };
        for t in self.structure.tiles(self.clique + clique) {
            let rows = &k[t.row as usize..][..t.rows as usize];
            for (i, k) in rows.iter().enumerate() {
                let k = &k[t.column as usize..];
                let to = &mut values[t.at as usize + i * t.stride as usize..];
                match t.columns {
                    // the usual lengths unrolled: both nodes of a cable element, or one of them
                    12 => add_few::<12>(to, k),
                    6 => add_few::<6>(to, k),
                    n => to[..n as usize].iter_mut().zip(k).for_each(|(to, k)| *to += k),
                }
            }
        }
    }
}

#[inline(always)]
fn add_few<const M: usize>(to: &mut [f64], k: &[f64]) {
    if let (Some(to), Some(k)) = (to.first_chunk_mut::<M>(), k.first_chunk::<M>()) {
        for (to, k) in to.iter_mut().zip(k) {
            *to += k;
        }
    }
}
