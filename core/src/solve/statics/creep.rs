//! From any configuration to a stable equilibrium: the model creeps downhill as if in honey.
//!
//! Steps of Euler's backward method for `c M ẋ + r(x) + Gᵀλ = 0`, `g(x) = 0`: each is the minimum of the potential plus
//! `c/2h |x - x₀|²` nearby, so the potential falls at every step, whatever the start, through contact and behind limit
//! points. The step grows as long as Newton's method follows and its matrix stays positive.
//!
//! A cable that is laid too short for its length would crumple first. From a guess it creeps with a soft `EA`, so that
//! the load shapes it, and stiffens from stage to stage.

use super::outcome::{Found, StaticsError};
use super::problem::Statics;
use crate::model::node::{difference, retract};
use crate::model::state::{At, Relaxation, Relaxed, State};

/// Most steps, and most iterations of one.
const STEPS: u32 = 400;
const ITERATIONS: u32 = 14;
/// Caps of the stiff modulus from stage to stage, as [`Relaxation::ramp`]: first such that the load strains by a tenth.
const STAGES: [f64; 5] = [1e-3, 1e-2, 1e-1, 1.0, f64::INFINITY];
/// A step that moves less than this, relative to the reference length, stands still; and how often what stands on a saddle is
/// pushed off it.
const STILL: f64 = 1e-3;
const PUSHES: u32 = 5;
/// The least drag to begin with, in parts of the largest stiffness.
const BALANCED: f64 = 1e-9;
/// Largest move in one step, relative to the reference length.
const FARTHEST: f64 = 0.3;

impl Statics<'_> {
    /// Creeps from `state` to a stable equilibrium at its time, and closes in on it by Newton's method. `far` says that
    /// the state is a guess.
    ///
    /// # Errors
    /// None was found within the steps; the state is where they ended.
    pub(super) fn creep(
        &mut self,
        state: &mut State,
        found: &mut Found,
        far: bool,
    ) -> Result<(), StaticsError> {
        // its drag holds everything
        self.free.clear();
        let load = self.load(state).max(f64::MIN_POSITIVE);
        let masses = self.masses(state);
        let (length, nv) = (self.model.length(), self.model.velocities());
        // a float that lies in balance has no load, and falls over all the same
        let first = (10.0 * load / length).max(BALANCED * self.stiffest()[0]);
        let (mut drag, mut near) = (first, 0_u32);
        let mut stages = STAGES[if far { 0 } else { STAGES.len() - 1 }..].iter();
        let mut stage = *stages.next().unwrap_or(&f64::INFINITY);
        let (mut still, mut pushes) = (false, 0);
        for _ in 0..STEPS {
            if self.is_over() {
                break;
            }
            let mut next = state.clone();
            let Some((iterations, positive)) = self.creep_once(&mut next, &masses, [drag, load, stage])
            else {
                found.iterations += ITERATIONS;
                drag *= 8.0;
                if !(drag < 1e14 * first) {
                    return Err(self.fail(state, "the model doesn't creep anywhere", found.iterations));
                }
                continue;
            };
            found.iterations += iterations;
            if !positive {
                if still && pushes < PUSHES && self.push_off(state, found) {
                    (still, pushes, drag) = (false, pushes + 1, first);
                    continue;
                }
                drag *= 4.0;
                if !(drag < 1e14 * first) {
                    return Err(self.fail(state, "the model doesn't creep anywhere", found.iterations));
                }
                continue;
            }
            let mut moved = vec![0.0; nv];
            difference(self.model.nodes(), &state.q, &next.q, &mut moved);
            let size = self.size(&moved);
            still = size <= STILL;
            *state = next;
            // where it hardly moves although little holds it back, Newton's method takes over
            if size <= 0.02 && drag <= 1e-2 * first {
                near += 1;
                if stage.is_finite() {
                    if near > 1 {
                        (stage, near) = (*stages.next().unwrap_or(&f64::INFINITY), 0);
                        drag = drag.max(0.1 * first);
                    }
                    continue;
                }
                // a search that fails costs as much as many steps
                if near.is_power_of_two() {
                    let mut there = state.clone();
                    match self.search(&mut there, false, false, false) {
                        Ok(more) if self.unstable == 0 && self.gap(&state.q, &there.q) <= 0.3 => {
                            found.add(&more);
                            *state = there;
                            return Ok(());
                        }
                        _ => self.free.clear(),
                    }
                }
            }
            drag *= match iterations {
                0..=4 => 0.25,
                5..=7 => 0.6,
                _ => 1.2,
            };
            drag = drag.max(1e-12 * first);
        }
        Err(self.fail(state, "the model creeps on and on", found.iterations))
    }

    /// Pushes what stands at an unstable equilibrium, as what begins in a symmetric place does, in the direction in which it
    /// would fall. Whether it stood at one.
    fn push_off(&mut self, state: &mut State, found: &mut Found) -> bool {
        let mut there = state.clone();
        let Ok(more) = self.search(&mut there, false, false, false) else { return false };
        found.add(&more);
        self.free.clear();
        if self.unstable == 0 || self.gap(&state.q, &there.q) > 0.3 {
            return false;
        }
        let Some(shapes) = self.soft(&there, self.unstable) else { return false };
        let push = self.choose(&shapes);
        retract(self.model.nodes(), &there.q, &push, &mut state.q);
        state.lambda = there.lambda;
        true
    }

    /// One step; the iterations that it took, and whether it ended where the matrix is positive.
    fn creep_once(
        &mut self,
        state: &mut State,
        masses: &[f64],
        [drag, load, ramp]: [f64; 3],
    ) -> Option<(u32, bool)> {
        self.cover(&state.at()).ok()?;
        let (model, nv) = (self.model, self.model.velocities());
        let start = state.q.clone();
        let (mut moved, mut next) = (vec![0.0; nv], state.q.clone());
        let mut last: Option<Vec<f64>> = None;
        let mut before = f64::INFINITY;
        for k in 1..=ITERATIONS {
            let how =
                Relaxation { smooth: last.is_some(), ramp, ramp_before: ramp, load, ..Relaxation::default() };
            self.assemble(
                state,
                &state.q,
                &state.lambda,
                Some(Relaxed { last: last.as_deref(), how }),
                false,
            );
            self.prepare();
            difference(model.nodes(), &start, &state.q, &mut moved);
            for i in 0..nv {
                self.system.residual[i] += drag * masses[i] * moved[i];
                self.system.values[self.structure.diagonal[i] as usize] += drag * masses[i];
            }
            self.factor().ok()?;
            // without a potential pivots tell nothing
            let positive =
                !self.judged.potential || self.solver.negative_pivots().is_none_or(|n| n == self.held(state));
            let d = self.correction().ok()?;
            let size = self.size(&d[..nv]);
            if !size.is_finite() || size > 2.0 || (k > 4 && size > 2.0 * before) {
                return None;
            }
            retract(model.nodes(), &state.q, &d[..nv], &mut next);
            std::mem::swap(&mut state.q, &mut next);
            state.lambda.iter_mut().zip(&d[nv..]).for_each(|(l, d)| *l += d);
            if self.gap(&start, &state.q) > FARTHEST || self.has_passed(state, &start) {
                return None;
            }
            last = Some(d[..nv].to_vec());
            if size <= 1e-6 || (k > 1 && size * (size / before).min(1.0) <= 1e-7) {
                return Some((k, positive));
            }
            before = size;
        }
        None
    }

    /// Whether something has gone through what it is only coupled with where they are near.
    fn has_passed(&self, state: &State, start: &[f64]) -> bool {
        let now = state.at();
        self.model.recouples() && self.model.coupled_passes(&At { q: start, ..now }, &now).is_some()
    }

    /// Largest difference of two configurations, relative to the reference length.
    fn gap(&self, a: &[f64], b: &[f64]) -> f64 {
        let mut d = vec![0.0; self.model.velocities()];
        difference(self.model.nodes(), a, b, &mut d);
        self.position_size(&d) / self.model.length()
    }

    /// Share of each unknown in the mass; of what has none, a little.
    fn masses(&mut self, state: &State) -> Vec<f64> {
        self.assemble(state, &state.q, &state.lambda, None, true);
        let s = &self.structure;
        let mass = |i: usize| self.mass.values[s.diagonal[i] as usize].max(0.0);
        let places = || self.model.nodes().iter().filter(|n| n.kind.has_position());
        let total: f64 = places().map(|n| mass(n.v)).sum();
        let (count, square) = (places().count().max(1) as f64, self.model.length().powi(2));
        let mut out = vec![0.0; self.model.velocities()];
        for n in self.model.nodes() {
            for (k, i) in n.dofs().enumerate() {
                let own = if total > 0.0 { mass(i) / total } else { 0.0 };
                let least = if k < 3 { 1e-3 / count } else { 1e-3 * square / count.powi(3) };
                out[i] = own.max(least);
            }
        }
        out
    }
}
