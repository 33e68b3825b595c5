//! The simplified Newton iteration of a Radau step: all stages share one Jacobian, and the transformation of the
//! tableau turns their system into one real and one complex of the size of the model.
//!
//! With `z` an eigenvalue of the inverse Runge-Kutta matrix over `h`:
//! `[M + C/z + K/z², Gᵀ; G, 0] [δw; δl/z²] = -[r/z²; g]`, all transformed. Stage velocities and accelerations are no
//! unknowns: they follow from the increments.

use super::stages::Stages;
use super::tableau::{ALPHA, GAMMA, T, T_INVERSE};
use crate::model::Model;
use crate::model::state::State;
use crate::solve::integrator::consistent::roundings;
use crate::solve::integrator::convergence::{Convergence, Failure, Rate};
use crate::solve::integrator::factors::{Factors, Remedy};
use crate::solve::integrator::forces::larger;
use crate::solve::integrator::options::NewtonPolicy;
use crate::solve::integrator::workspace::{Which, Workspace};
use faer::c64;

pub(super) struct Newton<'a> {
    pub model: &'a Model,
    pub state: &'a State,
    pub h: f64,
    pub policy: NewtonPolicy,
    pub max_iterations: u32,
    /// Tolerance of displacements, relative to the length of each part.
    pub tolerance: f64,
    /// The same where rounding keeps corrections from falling.
    pub wandering: f64,
    /// Tolerance of what is left of the equations of motion, relative to the forces at work in each part.
    pub force_tolerance: f64,
    /// Whether every constraint is linear, so that one iteration meets it.
    pub linear_constraints: bool,
}

impl Newton<'_> {
    pub fn solve(&self, work: &mut Workspace, s: &mut Stages) -> Result<Rate, Failure> {
        let control = &self.state.control;
        let eta = if control.h_last > 0.0 { control.eta.max(1e-3).powf(0.8) } else { 1.0 };
        let mut convergence =
            Convergence::new(self.tolerance, work.norms.rounding(), f64::INFINITY, eta, control.theta);
        convergence.enough = convergence.enough.max(self.wandering);
        let mut factors = Factors::new(self.policy);
        self.predict(s);
        if factors.always || !s.factored_for(self.h) || control.worn() {
            s.differentiate(self.model, work, self.state, self.h)?;
            factors.renewed(&convergence, false);
        }
        work.forces.look(self.model, &work.norms, self.state);
        for iterations in 1..=self.max_iterations {
            if factors.always && iterations > 1 {
                s.differentiate(self.model, work, self.state, self.h)?;
            }
            let (size, force) = self.iterate(work, s)?;
            if !size.is_finite() {
                return Err(Failure::newton("the iteration left the finite numbers"));
            }
            let c = &mut convergence;
            c.corrected(size, force);
            let rate = |eta, theta| Rate {
                iterations,
                eta,
                theta: Some(theta),
                kept_failed: factors.kept_failed,
                unmet: false,
            };
            let forces_right = c.force_left <= 1.0 || size <= c.floor && c.since > 1;
            if c.positions_right() && forces_right && self.constraints_hold(work, s, c.is_noise()) {
                return Ok(rate(c.eta, c.theta));
            }
            if c.since == 1 {
                continue;
            }
            if c.grows() && c.is_noise() && factors.fresh() {
                // at the floor of rounding the iteration wanders
                return Ok(rate(1.0, 0.0));
            }
            let left = self.max_iterations - iterations;
            // next to a singular position constraints hardly determine a direction
            let wanders = |work: &mut Workspace, s: &mut Stages| {
                size <= self.wandering && forces_right && self.constraints_hold(work, s, c.is_noise())
            };
            match factors.judge(c, left) {
                Remedy::GiveUp if wanders(work, s) => return Ok(rate(1.0, 0.0)),
                Remedy::GoOn if left == 0 && wanders(work, s) => return Ok(rate(1.0, 0.0)),
                Remedy::GoOn => {}
                Remedy::GiveUp if c.grows() => return Err(Failure::newton("Newton's method diverges")),
                Remedy::GiveUp => return Err(Failure::newton("Newton's method converges too slowly")),
                Remedy::Renew => {
                    if c.grows() {
                        self.predict(s);
                    }
                    s.differentiate(self.model, work, self.state, self.h)?;
                    factors.renewed(c, false);
                    c.restart();
                    c.eta = 1.0;
                }
            }
        }
        Err(Failure::Newton(format!("{} Newton iterations were not enough", self.max_iterations)))
    }

    fn predict(&self, s: &mut Stages) {
        s.predict(self.state, self.h, self.model.redundancy().is_some());
        s.kinematics(self.model, self.state, self.h);
    }

    /// One iteration; gives the size of the change of positions, relative to the part that it moves most, and what was left
    /// of the equations of motion before it, over its tolerance: each the largest of the three stages.
    fn iterate(&self, work: &mut Workspace, s: &mut Stages) -> Result<(f64, f64), Failure> {
        let (model, nv) = (self.model, self.model.velocities());
        work.counts.newton_iterations += 1;
        for i in 0..3 {
            if i == 1 && s.known {
                continue;
            }
            model.assemble(&s.at(self.state, self.h, i), &s.lambda[i], None, &mut work.system);
            s.residual[i].copy_from_slice(&work.system.residual);
        }
        if s.residual.iter().flatten().any(|r| !r.is_finite()) {
            return Err(Failure::newton("the residual is not finite"));
        }
        let mut force = 0.0;
        for i in 0..3 {
            let left =
                work.forces.ratio(&work.norms, &s.residual[i], &s.a[i], &s.lambda[i], self.force_tolerance);
            force = larger(force, left);
        }
        let g = (self.h / GAMMA).powi(2);
        let inverse = ALPHA.inv() * self.h;
        let square = inverse * inverse;
        for k in 0..s.real.len() {
            let r = [s.residual[0][k], s.residual[1][k], s.residual[2][k]];
            let [x, re, im] = T_INVERSE.map(|t| -(t[0] * r[0] + t[1] * r[1] + t[2] * r[2]));
            let y = c64 { re, im };
            (s.real[k], s.imaginary[k]) = if k < nv { (g * x, square * y) } else { (x, y) };
        }
        work.solve(model, Which::Iteration, &mut s.real)?;
        s.solve_complex(model, work)?;
        for (k, (x, y)) in s.real[nv..].iter_mut().zip(&mut s.imaginary[nv..]).enumerate() {
            (*x, *y) = (*x / g, *y / square);
            for i in 0..3 {
                s.lambda[i][k] += T[i][0] * *x + T[i][1] * y.re + T[i][2] * y.im;
            }
        }
        let mut size = 0.0;
        for i in 0..3 {
            for k in 0..nv {
                let (x, y) = (s.real[k], s.imaginary[k]);
                s.d[k] = T[i][0] * x + T[i][1] * y.re + T[i][2] * y.im;
                s.z[i][k] += s.d[k];
            }
            size = larger(size, work.norms.relative(&s.d));
        }
        s.kinematics(model, self.state, self.h);
        Ok((size, force))
    }

    fn constraints_hold(&self, work: &mut Workspace, s: &mut Stages, noise: bool) -> bool {
        if self.linear_constraints {
            return true;
        }
        let length = self.model.length();
        let limit =
            (1e-10 * length).min(self.tolerance * length).max(roundings(noise) * self.model.rounding());
        let mut g = std::mem::take(&mut s.rate);
        let fine = (0..3).all(|i| {
            self.model.violations(&s.at(self.state, self.h, i), &mut work.system, &mut g);
            g.iter().zip(self.model.row_scale()).all(|(g, scale)| g.abs() <= limit * scale)
        });
        s.rate = g;
        fine
    }
}
