//! Whether an equilibrium is stable.
//!
//! Where loads have a potential the tangent is symmetric, and Sylvester's law of inertia tells: on the motions that the
//! constraints leave, as many eigenvalues are negative as there are negative pivots beside those of the multipliers.
//! That holds for pairs too, such as the two planes that a round cable buckles in, where the sign of a determinant says
//! nothing. Counted are the pivots of `K - m W` and `K + m W`, with what rounding makes of `K` for `m W`: what lies
//! between the two counts is neutral as far as the matrix can tell, and is pushed by a finite amount instead
//! ([`super::neutral`]).
//!
//! Where loads have no potential (drag, forces that follow), eigenvalues of the linearised motion tell
//! ([`crate::solve::modes`]), and a disturbance that is followed for a while ([`super::disturbance`]).

use super::naming::describe;
use super::neutral::Leaning;
use super::outcome::{Judgement, Neutral};
use super::problem::Statics;
use crate::model::state::{Relaxation, Relaxed, State};
use crate::solve::linear::SolveError;
use crate::solve::modes::{Mode, slowest};
use std::collections::BTreeMap;

/// Part of the diagonal of the tangent that is taken for rounding of it, and stands in for stiffness that is missing.
pub(super) const MARGIN: f64 = 1e-12;
/// The load of what lies in balance by itself, in parts of the largest stiffness times the length.
const BALANCED: f64 = 1e-6;
/// Of so many directions of a line without bending stiffness is asked whether it comes back, if that can be told.
const ENOUGH: usize = 6;
/// A motion that swings less often than this in the time in which it grows e-fold goes one way [rad].
const ONE_WAY: f64 = 0.05;
/// How many eigenvalues are asked for where loads have no potential.
const SLOWEST: usize = 16;
/// What is so much slower than the fastest of these moves freely: what is left of an equilibrium and rounding make such rates.
const NEUTRAL: f64 = 1e-5;

impl Statics<'_> {
    /// Judges the equilibrium in `there`, which Newton's method came to by the increment `last`; `seed` varies the way out.
    pub(super) fn judge(
        &mut self,
        there: &State,
        last: Option<&[f64]>,
        load: f64,
        seed: u32,
    ) -> Result<Judgement, SolveError> {
        self.assemble_check(there, last, load, false);
        let potential = self.structure.symmetric || self.is_mirrored();
        let mut out = Judgement { residual: self.worst().1, potential, ..Judgement::default() };
        if !potential {
            self.prepare();
            self.free.clear();
            self.hold_loosely();
            self.factor()?;
            out.correction = self.correction()?;
            // to judge costs more than another iteration
            if !self.is_there(&out.correction) {
                return Ok(out);
            }
            self.assemble_check(there, last, load, true);
            if !self.mirror_if_unfelt() {
                self.prepare();
                self.judge_motion(there, &mut out)?;
                return Ok(out);
            }
        }
        self.prepare();
        let w = self.weights();
        let held = self.held(there);
        let count = |s: &Self| s.solver.negative_pivots().map(|n| n.saturating_sub(held));
        self.shift(&w, -MARGIN);
        self.factor()?;
        let below = count(self);
        if below == Some(0) {
            self.free.clear();
            self.note_correction(&mut out)?;
            return Ok(out);
        }
        self.shift(&w, 2.0 * MARGIN);
        self.factor()?;
        let (Some(below), Some(unstable)) = (below, count(self)) else {
            // pivoting hides the signs of the pivots
            self.free.clear();
            self.note_correction(&mut out)?;
            self.judge_motion(there, &mut out)?;
            return Ok(out);
        };
        let near = below.saturating_sub(unstable);
        let lowest = self.lowest(&w, near.max(usize::from(unstable > 0)))?;
        self.free = lowest.iter().take(near).map(|x| self.weighed(&w, x)).collect();
        self.note_correction(&mut out)?;
        out.unstable = unstable;
        if unstable > 0 {
            out.way_out = Some(self.softest(seed));
            return Ok(out);
        }
        // what a load drives where nothing holds is no equilibrium; what floats in balance has no load, but rounding of what lifts it
        let load_felt = load.max(BALANCED * self.stiffest()[0] * self.model.length());
        for x in lowest.iter().take(near) {
            let shape = self.increment(x);
            let work: f64 = shape.iter().zip(&self.system.residual).map(|(d, r)| d * r).sum();
            let position = &self.structure.position;
            let rounding: f64 = shape.iter().zip(position).map(|(d, &p)| MARGIN * w[p] * d * d).sum();
            if work.abs() > (1e-6 * load_felt * self.size(&shape) * self.model.length()).max(rounding) {
                out.driven = Some(describe(self.model, &there.q, &shape));
                return Ok(out);
            }
        }
        // by the matrix alone these can't be told: rounding is as large as they are
        let mut limp: BTreeMap<String, usize> = BTreeMap::new();
        for k in 0..near {
            let free = Neutral::new(self.model, there, self.increment(&lowest[k]));
            let asked = free.line.as_ref().and_then(|line| limp.get(line)).copied().unwrap_or(0);
            // a limp line may lie otherwise in as many ways as it has nodes
            if asked >= ENOUGH {
                continue;
            }
            let leaning = self.lean(there, &free.shape, k, load);
            if let Some(line) = &free.line {
                let told = !matches!(leaning, Leaning::Unknown);
                limp.insert(line.clone(), if told { asked + 1 } else { ENOUGH });
            }
            match leaning {
                Leaning::Stays => out.neutral.push(free),
                // of a limp line no more can be told
                Leaning::Unknown if free.line.is_some() => out.neutral.push(free),
                Leaning::Unknown => {
                    let what = format!("{}, as far as can be seen", free.what);
                    out.doubt = Some(format!("whether it is stable can't be told: {what}"));
                }
                Leaning::Returns => {}
                Leaning::Leaves => {
                    out.unstable += 1;
                    out.way_out.get_or_insert(free.shape);
                }
            }
        }
        Ok(out)
    }

    /// Newton's correction with the factored tangent, unless it is known from a better one.
    fn note_correction(&mut self, out: &mut Judgement) -> Result<(), SolveError> {
        if out.correction.is_empty() {
            out.correction = self.correction()?;
        }
        Ok(())
    }

    /// Checks an equilibrium without asking for its stability.
    pub(super) fn check(
        &mut self,
        there: &State,
        last: Option<&[f64]>,
        load: f64,
    ) -> Result<Judgement, SolveError> {
        let how = Relaxation::check(last.is_some(), load);
        let correction = self.newton(there, &there.q, &there.lambda, Relaxed { last, how })?;
        Ok(Judgement { correction, residual: self.worst().1, ..Judgement::default() })
    }

    /// How many directions the equilibrium in `there` can be left in, neutral ones not counted; leaves the factors of
    /// its tangent. `None` where the pivots don't tell.
    pub(super) fn count(&mut self, there: &State, last: Option<&[f64]>, load: f64) -> Option<usize> {
        self.assemble_check(there, last, load, false);
        if !self.structure.symmetric && !self.is_mirrored() {
            return None;
        }
        self.prepare();
        let w = self.weights();
        self.shift(&w, MARGIN);
        self.factor().ok()?;
        self.solver.negative_pivots().map(|n| n.saturating_sub(self.held(there)))
    }

    /// Assembles residual and tangent at an equilibrium that is to be checked, or to be judged by that tangent.
    fn assemble_check(&mut self, there: &State, last: Option<&[f64]>, load: f64, judges: bool) {
        let how = Relaxation { judges, ..Relaxation::check(last.is_some(), load) };
        self.assemble(there, &there.q, &there.lambda, Some(Relaxed { last, how }), false);
    }

    /// Judges by the eigenvalues of the linearised motion.
    fn judge_motion(&mut self, there: &State, out: &mut Judgement) -> Result<(), SolveError> {
        let upright = self.is_upright(there);
        let linear = self.linearise_to_judge(there);
        match slowest(self.model, &there.internal, linear, SLOWEST) {
            Ok(mut rates) => {
                // rounding leaves motions among them that the constraints forbid
                rates.retain(|m| self.is_allowed(&m.shape) && self.is_allowed(&m.quadrature));
                let rate = |m: &Mode| m.growth.hypot(m.omega);
                let least = NEUTRAL * rates.iter().map(rate).fold(0.0, f64::max);
                let neutral = |m: &&Mode| m.rigid || rate(m) <= least;
                for mode in rates.iter().filter(|m| m.is_unstable() && !neutral(m)) {
                    if mode.omega <= ONE_WAY * mode.growth {
                        // near a critical load rounding makes a pair of two directions that are left alike
                        let square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
                        let pair = square(&mode.quadrature) > 1e-6 * square(&mode.shape);
                        out.unstable += 1 + usize::from(pair);
                        out.divergence = out.divergence.max(mode.growth);
                        out.way_out.get_or_insert_with(|| mode.shape.clone());
                    } else if mode.growth > out.flutter {
                        out.flutter = mode.growth;
                        out.swing.clone_from(&mode.shape);
                    }
                }
                for mode in rates.iter().filter(neutral) {
                    out.neutral.push(Neutral::new(self.model, there, mode.shape.clone()));
                }
            }
            // what has no mass can't swing
            Err(_) if upright => {}
            Err(e) => {
                out.doubt = Some(format!("whether it is stable can't be told: {e}"));
            }
        }
        Ok(())
    }

    /// Whether the symmetric part of the assembled tangent is positive where the constraints leave motions: then no real
    /// eigenvalue is negative (Bendixson), and nothing goes one way only.
    fn is_upright(&mut self, there: &State) -> bool {
        let (s, mean) = (&self.structure, self.mirrored());
        let factored = self.solver.factor(s, &mean).is_ok();
        factored && self.solver.negative_pivots() == Some(self.held(there))
    }

    /// Whether the constraints allow an increment; their Jacobian stands in the assembled tangent. What is left of an equation is
    /// compared with what the largest part of the increment could bring there: parts that should be zero are but rounding.
    fn is_allowed(&self, d: &[f64]) -> bool {
        let s = &self.structure;
        let mut x = vec![0.0; s.n];
        s.order(d, &mut x);
        let largest = x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        s.rows().filter(|(r, ..)| s.is_multiplier[*r]).all(|(_, columns, at)| {
            let (mut against, mut reach) = (0.0, 0.0);
            for (k, p) in at.enumerate() {
                let j = self.system.values[p];
                against += j * x[columns.get(k)];
                reach += j.abs() * largest;
            }
            against.abs() <= 1e-6 * reach
        })
    }

    /// What each unknown weighs where eigenvalues are compared with rounding: the size of its diagonal entry.
    pub(super) fn weights(&self) -> Vec<f64> {
        self.weights_from(1e-6)
    }

    /// The same, of at least this share of the largest of its kind.
    pub(super) fn weights_from(&self, least: f64) -> Vec<f64> {
        let s = &self.structure;
        let diagonal = |i: usize| self.system.values[s.diagonal[i] as usize].abs();
        // positions, and what else there is: slopes, rotations, coordinates
        let kind =
            |i: usize, n: &crate::model::node::Node| usize::from(i - n.v >= 3 || n.kind.velocities() < 3);
        let mut largest = [0.0_f64; 2];
        for n in self.model.nodes() {
            for i in n.dofs() {
                largest[kind(i, n)] = largest[kind(i, n)].max(diagonal(i));
            }
        }
        if !(largest[0] > 0.0) {
            largest[0] = 1.0;
        }
        if !(largest[1] > 0.0) {
            largest[1] = largest[0] * (1e-3 * self.model.length()).powi(2);
        }
        let mut w = vec![0.0; s.n];
        for n in self.model.nodes() {
            for i in n.dofs() {
                w[s.position[i]] = diagonal(i).max(least * largest[kind(i, n)]);
            }
        }
        w
    }

    /// Adds `m W` to the tangent.
    pub(super) fn shift(&mut self, w: &[f64], m: f64) {
        for (p, w) in w.iter().enumerate() {
            self.system.values[self.structure.diagonal_at[p] as usize] += m * w;
        }
    }

    /// Equations of constraints that hold.
    pub(super) fn held(&self, there: &State) -> usize {
        let all = 0..self.model.constraints().len();
        all.filter(|&c| self.model.holds(c, &there.internal)).map(|c| self.model.rows_of(c).len()).sum()
    }
}
