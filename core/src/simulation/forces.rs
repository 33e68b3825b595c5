//! Forces of samples.
//!
//! Positions between steps are interpolated. Forces can't always be had from them: a stiff cable makes `EA/l` of force of
//! every metre that an interpolation is off. An interpolated state that doesn't balance is moved until it does. What is
//! done aside has a workspace of its own: looking at a run doesn't change it.

use super::Simulation;
use crate::model::node::retract;
use crate::model::term::Weights;
use crate::solve::integrator::{
    Workspace, assemble_mass_at, consistent_as_it_is, consistent_by_factors, consistent_by_iteration,
    consistent_by_mass,
};
use crate::solve::linear::SolveError;

/// What an interpolated state may leave of the equations of motion, in parts of the tolerance of forces.
const BALANCED: f64 = 0.1;
/// What is left of them once it has been moved into balance, in parts of the forces at work.
const FINE: f64 = 1e-5;
/// What an iteration leaves of what there was, for its matrix to serve once more.
const FAST: f64 = 0.03;
/// Iterations that should do for that.
const MOST_ITERATIONS: usize = 10;

impl Simulation {
    /// Gives the scratch state, which lies inside the last step or at its end, the forces of the motion.
    pub(super) fn find_forces(&mut self) -> Result<(), SolveError> {
        if self.moves_into_balance()? {
            return Ok(());
        }
        let weights = self.weights();
        assemble_mass_at(&self.model, &self.scratch, &mut self.work)?;
        if consistent_by_mass(&self.model, &mut self.scratch, &mut self.work)? {
            return Ok(());
        }
        let mut aside = self.take_aside()?;
        let weights = weights.unwrap_or_default();
        let done = consistent_by_iteration(&self.model, &mut self.scratch, &mut aside, weights);
        self.aside = Some(aside);
        done
    }

    /// Gives the scratch state, which lies inside the last step or at its end, the strains of the motion.
    pub(super) fn find_strains(&mut self) -> Result<(), SolveError> {
        // between the stages of Radau IIA they are as good as there
        if self.state.control.stages[0].is_empty() {
            self.moves_into_balance()?;
        }
        Ok(())
    }

    /// What the factors of the last step were made with.
    fn weights(&self) -> Option<Weights> {
        self.work.factored.filter(|weights| weights.q > 0.0)
    }

    /// Moves the scratch state into balance if it lies inside the last step and isn't; whether it did.
    fn moves_into_balance(&mut self) -> Result<bool, SolveError> {
        match self.weights() {
            Some(weights) if self.scratch.t < self.state.t && !self.balances() => self.balance(weights),
            _ => Ok(false),
        }
    }

    /// Whether the scratch state meets the equations of motion well enough for its forces to be those of the motion.
    fn balances(&mut self) -> bool {
        let (state, work) = (&self.scratch, &mut self.work);
        self.model.assemble(&state.at(), &state.lambda, None, &mut work.system);
        let tolerance = BALANCED * self.integrator.options().force_tolerance;
        let left = &work.system.residual;
        work.forces.ratio(&work.norms, left, &state.a, &state.lambda, tolerance) <= 1.0
    }

    /// Moves the scratch state into balance as Newton's method would at the end of a step like the last one: stiff
    /// directions find their equilibrium, soft ones stay where they are.
    ///
    /// A step of its own, from the start of the last one to here, would do for most. But it may be much shorter, and would
    /// see what the longer steps leave of velocities as the waves that those don't resolve.
    ///
    /// Gives whether it got there, with the forces of the motion: the factors at hand then serve as the metric that
    /// velocities are moved onto the constraints in. Otherwise the state is as it was.
    fn balance(&mut self, weights: Weights) -> Result<bool, SolveError> {
        let mut aside = self.take_aside()?;
        let start = self.scratch.clone();
        let there = self.iterate(weights, &mut aside) && self.makes_consistent(&mut aside).is_ok();
        if !there {
            self.scratch = start;
        }
        self.aside = Some(aside);
        Ok(there)
    }

    /// Makes a balanced scratch state consistent, where it isn't already.
    fn makes_consistent(&mut self, aside: &mut Workspace) -> Result<(), SolveError> {
        let (model, forces) = (&self.model, &self.work.forces);
        if !consistent_as_it_is(model, &mut self.scratch, aside, |l| forces.pulled(l, FINE) <= 1.0)? {
            consistent_by_factors(model, &mut self.scratch, aside)?;
        }
        Ok(())
    }

    /// Whether the iteration came to its end.
    fn iterate(&mut self, weights: Weights, aside: &mut Workspace) -> bool {
        let (model, s) = (&self.model, &mut self.scratch);
        let (nv, start) = (model.velocities(), s.q.clone());
        let mut d = vec![0.0; nv];
        let (mut before, mut fast, mut twice) = (f64::INFINITY, false, true);
        // from where a matrix serves once more, and how far that is
        let mut from = None;
        for k in 0..MOST_ITERATIONS {
            // where the interpolation is far off, no matrix serves twice
            let renew = !fast;
            model.assemble(&s.at(), &s.lambda, renew.then_some(weights), &mut aside.system);
            let (work, residual) = (&mut self.work, &aside.system.residual);
            let left = work.forces.ratio(&work.norms, residual, &s.a, &s.lambda, FINE);
            if k > 0 && left <= 1.0 {
                return true;
            }
            if !(left <= before)
                && let Some((state, way)) = from.take()
            {
                // it didn't
                (*s, d) = (state, way);
                (before, fast, twice) = (f64::INFINITY, false, false);
                continue;
            }
            from = (!renew).then(|| (s.clone(), d.clone()));
            fast = twice && left < FAST * before;
            before = left;
            let mut x: Vec<f64> = residual.iter().map(|r| -r).collect();
            x[nv..].iter_mut().for_each(|x| *x /= weights.q);
            if renew && aside.factor(model, weights).is_err() || aside.solve_iteration(model, &mut x).is_err()
            {
                break;
            }
            for i in 0..nv {
                d[i] += weights.q * x[i];
                s.v[i] += weights.v * x[i];
                s.a[i] += weights.a * x[i];
            }
            s.lambda.iter_mut().zip(&x[nv..]).for_each(|(l, x)| *l += x);
            retract(model.nodes(), &start, &d, &mut s.q);
            model.drive(s.t, &s.internal, &mut s.q, &mut s.v, &mut s.a);
        }
        false
    }

    fn take_aside(&mut self) -> Result<Box<Workspace>, SolveError> {
        let mut aside = match self.aside.take() {
            Some(aside) => aside,
            None => Box::new(Workspace::new(&self.model)?),
        };
        aside.softening = self.work.softening.clone();
        Ok(aside)
    }
}
