//! Forces of samples.
//!
//! Positions between steps are interpolated. Forces can't always be had from them: a stiff cable makes `EA/l` of force of
//! every metre that an interpolation is off. An interpolated state that doesn't balance is moved until it does. What is
//! done aside has a workspace of its own: looking at a run doesn't change it.

use super::Simulation;
use super::difference::Difference;
use crate::model::node::retract;
use crate::model::state::State;
use crate::model::term::Weights;
use crate::solve::integrator::{
    MOST_MOVES, Stepping, Workspace, accelerate, agree, agree_in_velocity, consistent_by_iteration,
    consistent_by_mass, move_velocities,
};
use crate::solve::linear::SolveError;
use crate::solve::times::Phase;

/// By how much at most what an interpolation is off by has grown where it serves at another time of the step: what is found
/// in soft directions is where the search began.
const MOST_GROWN: f64 = 0.05;
/// What an interpolated state may leave of the equations of motion, in parts of the tolerance of forces …
const BALANCED: f64 = 0.1;
/// … and what is left of them once it has been moved.
const FINE: f64 = 1e-2;
/// What an iteration leaves of what there was, for its matrix to serve once more.
const FAST: f64 = 0.03;
/// What may be left, in parts of the forces at work, for the matrix of another state to lead on from there.
const NEAR: f64 = 0.03;
/// How far a single iteration may move a state, in parts of the tolerance of positions, or of a part's length where steps are fixed:
/// an interpolation isn't off by more, and farther away there are other balances.
const LEASH: [f64; 2] = [10.0, 1e-2];
/// Iterations that do for that, also between the ends of a step of seconds.
const MOST_ITERATIONS: usize = 30;

impl Simulation {
    /// Gives the scratch state, which lies inside the last step or at its end, the forces of the motion.
    pub(super) fn find_forces(&mut self) -> Result<(), SolveError> {
        if self.moves_into_balance(true)? {
            return Ok(());
        }
        let weights = self.weights();
        if self.work.softening.is_some() {
            agree(&self.model, &mut self.scratch, &mut self.work)?;
        }
        if consistent_by_mass(&self.model, &mut self.scratch, &mut self.work)? {
            return Ok(());
        }
        let mut aside = self.take_aside()?;
        let weights = weights.unwrap_or_default();
        let done = consistent_by_iteration(&self.model, &mut self.scratch, &mut aside, weights);
        self.aside = Some(aside);
        done
    }

    /// Gives the scratch state the strains of the motion, which it has at the end of the last step.
    pub(super) fn find_strains(&mut self) -> Result<(), SolveError> {
        if self.scratch.t < self.state.t { self.find_strains_with_rates() } else { Ok(()) }
    }

    /// The same with velocities on the constraints: at the end of a step too they may be off.
    pub(super) fn find_strains_with_rates(&mut self) -> Result<(), SolveError> {
        // between the stages of Radau IIA they are as good as there
        if self.state.control.stages[0].is_empty() {
            self.moves_into_balance(false)?;
        }
        Ok(())
    }

    /// What the factors of the last step were made with, if they can be used without a trace.
    pub(super) fn weights(&self) -> Option<Weights> {
        self.work.factored.filter(|weights| weights.q > 0.0 && self.work.solver.is_settled())
    }

    /// Moves the scratch state into balance with velocities on the constraints, and finds the `forces` there, if they are
    /// asked for. Whether it did; otherwise the state is as it was.
    fn moves_into_balance(&mut self, forces: bool) -> Result<bool, SolveError> {
        let Some(weights) = self.weights() else { return Ok(false) };
        let begin = self.work.clocks.start();
        let mut aside = self.take_aside()?;
        let start = self.scratch.clone();
        self.mend();
        let there = self.balance(weights, forces, &mut aside)
            && (!forces || self.find_accelerations(&mut aside).is_ok());
        if !there {
            self.scratch = start;
        } else if self.scratch.t < self.state.t {
            let mended = Difference::between(self.model.nodes(), &start, &self.scratch);
            self.mended = Some((self.work.counts.steps, self.scratch.t, mended));
        }
        self.aside = Some(aside);
        self.work.clocks.stop(Phase::Output, begin);
        Ok(there)
    }

    /// Begins with what the interpolation was off by nearby in the same step, if that was looked at before, as where the time
    /// of an event is searched for: it grows from the ends of the step inwards.
    fn mend(&mut self) {
        let (begin, h) = (self.previous.t, self.state.t - self.previous.t);
        let Some((step, t, mended)) = &self.mended else { return };
        if *step != self.work.counts.steps || !(self.scratch.t < self.state.t) {
            return;
        }
        let shape = |t: f64| (t - begin) * (begin + h - t);
        let grown = shape(self.scratch.t) / shape(*t);
        if !((grown - 1.0).abs() <= MOST_GROWN) {
            return;
        }
        let start = self.scratch.clone();
        mended.put(self.model.nodes(), grown * grown, &start, &mut self.scratch);
    }

    /// Moves the scratch state into balance as Newton's method would at the end of a step like the last one: stiff
    /// directions find their equilibrium, soft ones stay where they are. Velocities are moved onto the constraints in the
    /// metric of that matrix: stiff directions move along.
    ///
    /// A step of its own, from the start of the last one to here, would do for most. But it may be much shorter, and would
    /// see what the longer steps leave of velocities as the waves that those don't resolve.
    ///
    /// Whether the iteration came to its end; what is left then stands in the workspace, if `forces` are asked for.
    fn balance(&mut self, weights: Weights, forces: bool, aside: &mut Workspace) -> bool {
        let tolerance = self.integrator.options().force_tolerance;
        let leash = match self.integrator.options().stepping {
            Stepping::Controlled { tolerance } => LEASH[0] * tolerance,
            Stepping::Fixed { .. } => LEASH[1],
        };
        // the end of a step is as balanced as it is
        let inside = self.scratch.t < self.state.t;
        let (model, work, s) = (&*self.model, &mut self.work, &mut self.scratch);
        let nv = model.velocities();
        let mut d = vec![0.0; nv];
        // the matrix of the last step serves until it doesn't, then those of the states here, also at other times of the step
        if self.aside_of != work.counts.steps || aside.factored != Some(weights) {
            (self.aside_of, aside.factored) = (work.counts.steps, None);
        }
        let (mut own, mut renew, mut before) = (aside.factored.is_some(), false, f64::INFINITY);
        // from where a matrix serves once more, and how far that is; whether one may
        let (mut from, mut again): (Option<State>, _) = (None, true);
        let mut goal = None;
        for k in 0..MOST_ITERATIONS {
            let factors = if own && aside.factored.is_some() { &mut *aside } else { &mut *work };
            // on the way one move of velocities does
            let most = if inside { 1 } else { MOST_MOVES };
            let Ok(moved) = move_velocities(model, s, factors, most, goal) else { break };
            if !inside && !forces {
                return true;
            }
            goal = goal.or(Some(moved.goal));
            model.assemble(&s.at(), &s.lambda, None, &mut aside.system);
            let residual = &aside.system.residual;
            let mut left = |tolerance| work.forces.ratio(&work.norms, residual, &s.a, &s.lambda, tolerance);
            let good = k == 0 && (!inside || left(BALANCED * tolerance) <= 1.0);
            let left = if good { 0.0 } else { left(FINE * tolerance) };
            if left <= 1.0 {
                let factors = if own && aside.factored.is_some() { &mut *aside } else { &mut *work };
                let Ok(moved) = move_velocities(model, s, factors, MOST_MOVES, goal) else { break };
                if forces && moved.times > 0 {
                    model.assemble(&s.at(), &s.lambda, None, &mut aside.system);
                }
                return true;
            }
            if !(left <= before)
                && let Some(state) = from.take()
            {
                // it didn't
                *s = state;
                (own, renew, before, again) = (true, true, f64::INFINITY, false);
                continue;
            }
            let far = |left: f64| FINE * tolerance * left > NEAR;
            let fast = if k == 0 {
                !far(left)
            } else {
                // or two more of its iterations will do
                !far(before) && (left < FAST * before || left.powi(3) < before.powi(2))
            };
            before = left;
            let mut x: Vec<f64> = residual.iter().map(|r| -r).collect();
            x[nv..].iter_mut().for_each(|x| *x /= weights.q);
            if renew || !fast {
                (own, from) = (true, None);
                model.assemble(&s.at(), &s.lambda, Some(weights), &mut aside.system);
                if aside.factor(model, weights).is_err() {
                    break;
                }
            } else {
                from = Some(s.clone());
            }
            let factors = if own { &mut *aside } else { &mut *work };
            if factors.solve_iteration(model, &mut x).is_err() {
                break;
            }
            let far = weights.q * work.norms.relative(&x[..nv]);
            if far > leash {
                x.iter_mut().for_each(|x| *x *= leash / far);
            }
            for i in 0..nv {
                d[i] = weights.q * x[i];
                s.v[i] += weights.v * x[i];
                s.a[i] += weights.a * x[i];
            }
            s.lambda.iter_mut().zip(&x[nv..]).for_each(|(l, x)| *l += x);
            retract(model.nodes(), &s.q.clone(), &d, &mut s.q);
            model.drive(s.t, &s.internal, &mut s.q, &mut s.v, &mut s.a);
            renew = own && !(again && fast);
        }
        false
    }

    /// Finds accelerations and multipliers of the scratch state, where the workspace has what is left of the equations of
    /// motion with those that it has.
    fn find_accelerations(&mut self, aside: &mut Workspace) -> Result<(), SolveError> {
        let (model, s) = (&*self.model, &mut self.scratch);
        if aside.softening.is_some() {
            agree(model, s, aside)?;
            agree_in_velocity(model, s, aside)?;
            model.assemble(&s.at(), &s.lambda, None, &mut aside.system);
        } else if !aside.take_inertia(model, &self.work)? {
            // what is missing of the balance is little, and a mass that is a little off makes little of it
            aside.assemble_mass(model, &s.at(), &s.lambda, 0.0, true)?;
        }
        accelerate(model, s, aside)
    }

    pub(super) fn take_aside(&mut self) -> Result<Box<Workspace>, SolveError> {
        let mut aside = match self.aside.take() {
            Some(aside) => aside,
            None => Box::new(Workspace::new(&self.model)?),
        };
        aside.softening = self.work.softening.clone();
        Ok(aside)
    }
}
