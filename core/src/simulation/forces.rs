//! Forces of samples.
//!
//! Positions between steps are interpolated. Forces can't always be had from them: a stiff cable makes `EA/l` of force of
//! every metre that an interpolation is off. An interpolated state that doesn't balance is moved until it does. What is
//! done aside has a workspace of its own: looking at a run doesn't change it.

use super::Simulation;
use crate::model::node::retract;
use crate::model::term::Weights;
use crate::solve::integrator::{Workspace, assemble_mass_at, consistent_by_iteration, consistent_by_mass};
use crate::solve::linear::SolveError;

/// What an interpolated state may leave of the equations of motion, in parts of the tolerance of forces.
const BALANCED: f64 = 0.1;
/// What is left of them once it has been moved into balance, in parts of the forces at work.
const FINE: f64 = 1e-5;
/// Iterations that should do for that.
const MOST_ITERATIONS: usize = 10;
/// What an iteration with the factors of the last step may leave of the one before, for them to serve once more.
const SERVES: f64 = 0.3;

impl Simulation {
    /// Gives the scratch state, which lies inside the last step or at its end, the forces of the motion.
    pub(super) fn find_forces(&mut self) -> Result<(), SolveError> {
        let weights = self.work.factored.filter(|weights| weights.q > 0.0);
        if let Some(weights) = weights
            && self.scratch.t < self.state.t
        {
            self.balance(weights)?;
        }
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

    /// Moves the scratch state into balance as Newton's method would at the end of a step like the last one: stiff
    /// directions find their equilibrium, soft ones stay where they are.
    ///
    /// A step of its own, from the start of the last one to here, would do for most. But it may be much shorter, and would
    /// see what the longer steps leave of velocities as the waves that those don't resolve.
    fn balance(&mut self, weights: Weights) -> Result<(), SolveError> {
        let mut aside = self.take_aside()?;
        let done = self.iterate(weights, &mut aside);
        self.aside = Some(aside);
        done
    }

    fn iterate(&mut self, weights: Weights, aside: &mut Workspace) -> Result<(), SolveError> {
        let (model, s) = (&self.model, &mut self.scratch);
        let (nv, start) = (model.velocities(), s.clone());
        let mut d = vec![0.0; nv];
        // the factors of the last step, as long as they serve
        let (mut kept, mut before, mut fresh) = (true, f64::INFINITY, 0);
        let enough = BALANCED * self.integrator.options().force_tolerance / FINE;
        for k in 0..MOST_ITERATIONS {
            // where the interpolation is far off, no matrix serves twice
            let mut renew = !kept && (fresh < 2 || fresh % 2 == 0);
            model.assemble(&s.at(), &s.lambda, renew.then_some(weights), &mut aside.system);
            let work = &mut self.work;
            let left = work.forces.ratio(&work.norms, &aside.system.residual, &s.a, &s.lambda, FINE);
            if left <= if k > 0 { 1.0 } else { enough } {
                return Ok(());
            }
            if kept && !(left < SERVES * before) {
                (kept, renew) = (false, true);
                model.assemble(&s.at(), &s.lambda, Some(weights), &mut aside.system);
            }
            fresh += usize::from(!kept);
            before = left;
            let mut x: Vec<f64> = aside.system.residual.iter().map(|r| -r).collect();
            x[nv..].iter_mut().for_each(|x| *x /= weights.q);
            let solved = match kept {
                true => work.solve_iteration(model, &mut x),
                false if renew && aside.factor(model, weights).is_err() => break,
                false => aside.solve_iteration(model, &mut x),
            };
            if solved.is_err() {
                break;
            }
            for i in 0..nv {
                d[i] += weights.q * x[i];
                s.v[i] += weights.v * x[i];
                s.a[i] += weights.a * x[i];
            }
            s.lambda.iter_mut().zip(&x[nv..]).for_each(|(l, x)| *l += x);
            retract(model.nodes(), &start.q, &d, &mut s.q);
            model.drive(s.t, &s.internal, &mut s.q, &mut s.v, &mut s.a);
        }
        // an iteration that doesn't come to its end leaves the interpolation
        *s = start;
        Ok(())
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
