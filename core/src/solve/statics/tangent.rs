//! One linear system of the search: assembly, in a frame that may move, factorisation and solution.

use super::problem::Statics;
use super::stability::MARGIN;
use crate::algebra::lane::{V3, dot};
use crate::algebra::rotation::{M3, cross, product, skew, transposed_times};
use crate::model::marker::frame;
use crate::model::node::NodeKind;
use crate::model::state::{At, Relaxation, Relaxed, State};
use crate::model::term::Weights;
use crate::model::twist::tangent;
use crate::solve::linear::SolveError;
use crate::solve::times::Phase;

/// What holds all that is free where tangents are singular, in parts of its diagonal or of this share of the largest:
/// corrections fall by as much.
const TRACE: f64 = 1e-9;
const LEAST: f64 = 1e-3;

impl Statics<'_> {
    /// Assembles, factors and solves once: Newton's correction, velocities (as increments) and then multipliers.
    pub(super) fn newton(
        &mut self,
        state: &State,
        q: &[f64],
        lambda: &[f64],
        relaxed: Relaxed<'_>,
    ) -> Result<Vec<f64>, SolveError> {
        self.assemble_to_solve(state, q, lambda, relaxed);
        self.factor()?;
        self.correction()
    }

    /// The same where the tangent is positive: without what else one would cost.
    pub(super) fn newton_if_positive(
        &mut self,
        state: &State,
        q: &[f64],
        lambda: &[f64],
        relaxed: Relaxed<'_>,
    ) -> Option<Vec<f64>> {
        self.assemble_to_solve(state, q, lambda, relaxed);
        let begin = self.clocks.start();
        let factored = self.solver.factor_as_it_is(&self.structure, &self.system.values);
        self.clocks.stop(Phase::Factorisation, begin);
        factored.ok()?;
        if self.solver.negative_pivots()? != self.held(state) {
            return None;
        }
        self.correction().ok()
    }

    fn assemble_to_solve(&mut self, state: &State, q: &[f64], lambda: &[f64], relaxed: Relaxed<'_>) {
        self.assemble(state, q, lambda, Some(relaxed), false);
        self.prepare();
        if self.loose {
            self.hold_loosely();
        } else if !self.free.is_empty() {
            let w = self.weights();
            self.shift(&w, MARGIN);
        }
    }

    /// Holds what is free by a trace of stiffness, where something is.
    pub(super) fn hold_loosely(&mut self) {
        if self.loose {
            let w = self.weights_from(LEAST);
            self.shift(&w, TRACE);
        }
    }

    /// Makes the assembled tangent fit for elimination without pivoting.
    pub(super) fn prepare(&mut self) {
        self.brace();
        if let Some(softening) = &self.softening {
            softening.apply(&mut self.system.values);
        }
    }

    /// Factors the tangent.
    pub(super) fn factor(&mut self) -> Result<(), SolveError> {
        let begin = self.clocks.start();
        self.solver.factor(&self.structure, &self.system.values)?;
        self.clocks.stop(Phase::Factorisation, begin);
        Ok(())
    }

    /// Newton's correction with the factored tangent, velocities and then multipliers; free directions stay where they
    /// are.
    pub(super) fn correction(&mut self) -> Result<Vec<f64>, SolveError> {
        let residual: Vec<f64> = self.system.residual.iter().map(|r| -r).collect();
        self.solve(&residual)
    }

    /// The solution for a right-hand side (velocities, then multipliers) with the factored tangent; free directions stay
    /// where they are.
    pub(super) fn solve(&mut self, rhs: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut x = vec![0.0; self.structure.n];
        self.structure.order(rhs, &mut x);
        let begin = self.clocks.start();
        self.solver.solve(&self.structure, &self.system.values, &mut x)?;
        self.hold(&mut x, &vec![0.0; self.free.len()])?;
        self.clocks.stop(Phase::Solution, begin);
        Ok(self.structure.position.iter().map(|&p| x[p]).collect())
    }

    /// Residual and stiffness as seen from the frame; with `motion` damping and mass as well.
    pub(super) fn assemble(
        &mut self,
        state: &State,
        q: &[f64],
        lambda: &[f64],
        relaxed: Option<Relaxed<'_>>,
        motion: bool,
    ) {
        self.follow_frame(q);
        let at = At { t: state.t, q, v: &self.v, a: &self.a, internal: &state.internal, relaxed };
        let one = |q, v, a| Some(Weights { q, v, a });
        self.model.assemble_in(&self.structure, &at, lambda, one(1.0, 0.0, 0.0), &mut self.system);
        let omega = self.frame.map_or([0.0; 3], |f| f.omega);
        if motion || omega != [0.0; 3] {
            self.model.assemble_in(&self.structure, &at, lambda, one(0.0, 1.0, 0.0), &mut self.damping);
            self.model.assemble_in(&self.structure, &at, lambda, one(0.0, 0.0, 1.0), &mut self.mass);
        }
        if omega != [0.0; 3] {
            self.turn_columns(omega, q);
        }
    }

    /// Adds `ρ GᵀG` to the stiffness and `ρ Gᵀ g` to the residual. The solution is the same, and no node is left
    /// without stiffness before its constraint is reached in the elimination.
    pub(super) fn brace(&mut self) {
        self.brace_by(1.0);
    }

    /// The same, so many times as stiff as what is stiffest: one that is as stiff cancels what falls over.
    pub(super) fn brace_by(&mut self, times: f64) {
        if self.model.multipliers() > 0 {
            let stiffness = self.stiffest().map(|x| times * x);
            self.model.add_brace(&self.structure, stiffness, &mut self.system);
        }
    }

    /// Largest diagonal entries of the assembled stiffness, of positions and of what has no length; where there are none before
    /// constraints have their forces, that of the load over its reference length.
    pub(super) fn stiffest(&self) -> [f64; 2] {
        let s = &self.structure;
        let mut largest = [0.0_f64; 2];
        for n in self.model.nodes() {
            for i in n.dofs() {
                let kind = usize::from(i - n.v >= 3 || !n.kind.has_position());
                largest[kind] = largest[kind].max(self.system.values[s.diagonal[i] as usize].abs());
            }
        }
        let length = self.model.length();
        if !(largest[0] > 0.0) {
            let turns = largest[1] / length.powi(2);
            largest[0] = if turns > 0.0 { turns } else { (self.worst().1 / length).max(f64::MIN_POSITIVE) };
        }
        if !(largest[1] > 0.0) {
            largest[1] = largest[0] * length.powi(2);
        }
        largest
    }

    /// Velocities and accelerations of the frame at a configuration.
    pub(super) fn follow_frame(&mut self, q: &[f64]) {
        for &(v, _, rate) in &self.flow {
            self.v[v] = rate;
        }
        let Some(f) = self.frame else { return };
        for n in self.model.nodes() {
            let x = &q[n.coords()];
            let blocks = match n.kind {
                NodeKind::Point | NodeKind::Frame => 1,
                NodeKind::Slope | NodeKind::Twist => 2,
                NodeKind::Scalars(_) => 0,
            };
            for b in 0..blocks {
                let origin = if b == 0 { f.centre } else { [0.0; 3] };
                let arm: V3<f64> = std::array::from_fn(|i| x[3 * b + i] - origin[i]);
                let turn = cross(&f.omega, &arm);
                let pull = cross(&f.omega, &turn);
                for i in 0..3 {
                    self.v[n.v + 3 * b + i] = turn[i] + if b == 0 { f.velocity[i] } else { 0.0 };
                    self.a[n.v + 3 * b + i] = pull[i];
                }
            }
            if n.kind == NodeKind::Frame {
                // a body turns with the frame; in its own axes its spin is constant
                let spin = transposed_times(&frame(x), &f.omega);
                self.v[n.v + 3..n.v + 6].copy_from_slice(&spin);
            }
            if n.kind == NodeKind::Twist {
                self.v[n.v + 6] = dot(&tangent(x), &f.omega);
            }
        }
    }

    /// Adds what the frame's turning makes of a displacement `x` that rides with it: `C W₁ + M W₃` to the stiffness
    /// and `M W₂` to the damping.
    ///
    /// Vectors in space: `W₁ = ω̃`, `W₂ = 2 ω̃`, `W₃ = ω̃²`. Rotations in a body's own axes: `W₁ = W₂ = ω̃`, with `ω` in
    /// those axes too, and `W₃ = 0`.
    pub(super) fn turn_columns(&mut self, omega: V3<f64>, q: &[f64]) {
        let s = &self.structure;
        let w = skew(&omega);
        let space = [w, w.map(|row| row.map(|x| 2.0 * x)), product(&w, &w)];
        // at each position that three components of a node start at
        let mut turning: Vec<Option<[M3; 3]>> = vec![None; s.n];
        for n in self.model.nodes() {
            for block in 0..n.kind.velocities() / 3 {
                let own = match (n.kind, block) {
                    (NodeKind::Scalars(_), _) => continue,
                    (NodeKind::Frame, 1) => {
                        let w = skew(&transposed_times(&frame(&q[n.coords()]), &omega));
                        [w, w, [[0.0; 3]; 3]]
                    }
                    _ => space,
                };
                turning[s.position[n.v + 3 * block]] = Some(own);
            }
        }
        for (_, columns, at) in s.rows().filter(|(r, ..)| !s.is_multiplier[*r]) {
            for (k, p) in at.enumerate() {
                let Some([w1, w2, w3]) = &turning[columns.get(k)] else { continue };
                let (c, m): (V3<f64>, V3<f64>) = (
                    std::array::from_fn(|i| self.damping.values[p + i]),
                    std::array::from_fn(|i| self.mass.values[p + i]),
                );
                let (k1, k2, k3) =
                    (transposed_times(w1, &c), transposed_times(w2, &m), transposed_times(w3, &m));
                for j in 0..3 {
                    self.system.values[p + j] += k1[j] + k3[j];
                    self.damping.values[p + j] += k2[j];
                }
            }
        }
    }

    /// Size of the load: the residual with every stiff modulus switched off.
    pub(super) fn load(&mut self, state: &State) -> f64 {
        self.follow_frame(&state.q);
        let how = Relaxation { ramp: 0.0, ramp_before: 0.0, ..Relaxation::default() };
        let at = At {
            t: state.t,
            q: &state.q,
            v: &self.v,
            a: &self.a,
            internal: &state.internal,
            relaxed: Some(Relaxed { last: None, how }),
        };
        let none = vec![0.0; self.model.multipliers()];
        self.model.assemble_in(&self.structure, &at, &none, None, &mut self.system);
        let mut sum = 0.0;
        for n in self.model.nodes().iter().filter(|n| n.kind.has_position()) {
            let r = &self.system.residual[n.v..n.v + 3];
            sum += r.iter().map(|x| x * x).sum::<f64>().sqrt();
        }
        sum
    }

    /// Whether the cap on stiffness still changes the forces.
    pub(super) fn ramp_binds(&mut self, state: &State, q: &[f64], lambda: &[f64], how: Relaxation) -> bool {
        self.follow_frame(q);
        // both by the same path through the elements, so that equal means equal to the last bit
        let how = Relaxation { smooth: true, ..how };
        let mut at = At { t: state.t, q, v: &self.v, a: &self.a, internal: &state.internal, relaxed: None };
        at.relaxed = Some(Relaxed { last: None, how: Relaxation { ramp: f64::INFINITY, ..how } });
        self.model.assemble_in(&self.structure, &at, lambda, None, &mut self.system);
        let free = self.system.residual.clone();
        at.relaxed = Some(Relaxed { last: None, how });
        self.model.assemble_in(&self.structure, &at, lambda, None, &mut self.system);
        free != self.system.residual
    }
}
