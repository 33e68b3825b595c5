//! Newton's method of one trial step.
//!
//! The unknowns are the new auxiliary acceleration and the multipliers: with `δq = β h² δa`, `δv = γ h δa`,
//! `δv̇ = (1-αm)/(1-αf) δa` the matrix is `[(1-αm)/(1-αf) M + γ h C + β h² K, Gᵀ; G, 0]`, whose condition doesn't
//! grow as the step shrinks (Bottasso, Bauchau & Cardona 2007), and β = 0 is no special case.

use super::forces::left_of;
use super::options::NewtonPolicy;
use super::scales::{Stopping, Units};
use super::scheme::Coefficients;
use super::workspace::{Trial, Which, Workspace};
use crate::model::Model;
use crate::model::state::{At, State};
use crate::model::term::{Leap, Weights};
use crate::solve::linear::SolveError;
use crate::solve::redundancy::Softening;

/// Iterations with kept factors that are cheaper than new factors.
const PATIENCE: i32 = 3;

/// Convergence rate from which on the next steps don't try to keep factors either.
const HOPELESS: f64 = 0.5;

/// A step whose iteration still diverges after so many new matrices is repeated smaller.
const MOST_RENEWALS: u32 = 3;

/// The same where forces were approximated at kinks, which renews the matrix every time.
const MOST_AT_KINKS: u32 = 10;

/// Iterations of a careful start. Next to a singular position a prediction off by `e` asks for a correction of `e` over
/// the distance, which may lead beyond the other branch; once the well determined directions are right, little is left.
const CAREFUL: u32 = 3;

/// Largest expected rest of the error that is believed without a second iteration. What is expected grows from step to
/// step that has only one.
const TRUST: f64 = 0.1;

/// How Newton's method converged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rate {
    pub iterations: u32,
    /// Expected remaining error in parts of the last correction.
    pub eta: f64,
    /// Ratio of the last two corrections made with the same factors; zero for new factors that weren't used twice,
    /// `None` for kept ones.
    pub theta: Option<f64>,
    /// Whether kept factors had to be replaced on the way.
    pub kept_failed: bool,
    /// Whether the stopping test was given up, since only rounding is left.
    pub unmet: bool,
}

/// What Newton's method of a trial came to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Outcome {
    Converged(Rate),
    /// It diverged with factors of an earlier step: to be repeated with new ones.
    Stale,
    Failed {
        why: String,
    },
    Linear(SolveError),
}

/// What an absolute stopping test says of an iteration.
#[derive(Clone, Copy, PartialEq)]
enum Test {
    Met,
    Failed,
    /// It is met if the correction of this iteration is smaller.
    Increment(f64),
}

pub(crate) struct Newton<'a> {
    pub model: &'a Model,
    pub state: &'a State,
    pub scheme: Coefficients,
    pub h: f64,
    pub policy: NewtonPolicy,
    pub max_iterations: u32,
    /// Tolerance of displacements, relative to the length of each part.
    pub tolerance: f64,
    /// Tolerance of what is left of the equations of motion, relative to the forces at work in each part.
    pub force_tolerance: f64,
    /// When to stop, and the units of absolute tests.
    pub stopping: Stopping,
    pub units: Units,
    /// Whether every constraint is linear, so that one iteration meets it.
    pub linear_constraints: bool,
    /// Whether velocities are to meet the constraints as well.
    pub stabilised: bool,
    /// Whether terms with kinks are told what an iteration comes from.
    pub leaps: bool,
    /// Whether to begin as if nothing slipped.
    pub gripping: bool,
    /// Whether to start carefully because the step may end next to a singular position.
    pub careful: bool,
}

impl Newton<'_> {
    pub fn weights(&self) -> Weights {
        let c = &self.scheme;
        Weights { q: c.beta * self.h * self.h, v: c.gamma * self.h, a: c.mass() }
    }

    /// Sets positions, velocities and true accelerations of the trial from its auxiliary acceleration.
    pub fn kinematics(&self, work: &mut Workspace) {
        let (c, h, t) = (&self.scheme, self.h, &mut work.trial);
        let n = t.aux.len();
        let (old, new) = (&t.aux_old[..n], &t.aux[..n]);
        let (v, a) = (&self.state.v[..n], &self.state.a[..n]);
        let (d, v_new, a_new) = (&mut t.d[..n], &mut t.v[..n], &mut t.a[..n]);
        let (d_old, d_new) = (h * h * (0.5 - c.beta), h * h * c.beta);
        let (g_old, g_new) = (h * (1.0 - c.gamma), h * c.gamma);
        let scale = 1.0 / (1.0 - c.alpha_f);
        let (m_old, m_new, f_old) = (c.alpha_m * scale, (1.0 - c.alpha_m) * scale, c.alpha_f * scale);
        for i in 0..n {
            d[i] = h * v[i] + (d_old * old[i] + d_new * new[i]);
            v_new[i] = v[i] + (g_old * old[i] + g_new * new[i]);
            a_new[i] = m_new * new[i] + (m_old * old[i] - f_old * a[i]);
        }
        if self.stabilised {
            t.d.iter_mut().zip(&t.shift).for_each(|(d, shift)| *d += shift);
        }
        self.model.retract(&self.state.q, &t.d, &mut t.q);
        self.model.drive(self.state.t + h, &self.state.modes, &mut t.q, &mut t.v, &mut t.a);
    }

    /// Assembles at the trial; with `matrix` the iteration matrix too, which is then factored.
    fn evaluate(&self, work: &mut Workspace, matrix: bool, leap: Option<Leap<'_>>) {
        let at = self.place(&work.trial);
        let weights = matrix.then(|| self.weights());
        self.model.assemble_from(leap, &at, &work.trial.lambda, weights, &mut work.system);
    }

    /// Factors the iteration matrix that was assembled at the trial.
    fn factor(&self, work: &mut Workspace, careful: bool) -> Result<(), SolveError> {
        work.round_forces(self.model, self.weights());
        if careful {
            Softening::new(self.model, self.model.structure()).blunt(&mut work.system.values);
            work.system.approximate = true;
        }
        work.factor(self.model, self.weights())
    }

    /// Iterates from the prediction in `work.trial.aux` and `work.trial.lambda`.
    pub fn solve(&self, work: &mut Workspace, mut eta: f64) -> Outcome {
        let nv = self.model.velocities();
        let beta_h2 = self.scheme.beta.max(1.0 / 12.0) * self.h * self.h;
        let floor = 4.0 * work.norms.rounding();
        let stop = self.tolerance.max(floor);
        // below this, corrections wander instead of falling
        let noise = 30.0 * floor;
        let (mut last, mut theta) = (0.0_f64, 0.0_f64);
        // iterations with the present factors, and how many were made here
        let (mut since, mut renewals, mut kept_failed) = (0, 0, false);
        let multiplier_scale = 1.0 / (self.scheme.beta * self.h * self.h);
        let kinks = self.leaps && self.model.kinked();
        let (mut approximate, mut approximated) = (false, false);
        // positions are right; and by how much forces were off before the last iteration
        let (mut settled, mut force_before) = (false, None);
        // what the iteration says of its matrix
        let seen = |since: i32, before: f64, theta: f64, renewals: u32| {
            if since > 1 && before > noise { Some(theta) } else { (renewals > 0).then_some(0.0) }
        };
        let mut last_before = 0.0;
        let test_forces = self.stopping == Stopping::Relative;
        self.kinematics(work);
        work.forces.look(self.model, &work.norms, self.state);
        for k in 0..self.max_iterations {
            let stale = work.factored != Some(self.weights());
            // an iteration that would go on for long with its matrix gets a new one
            let slow = !approximated && since > 1 && last > noise && last * theta.powi(PATIENCE) > stop;
            let refresh = stale || self.policy == NewtonPolicy::Full || slow || approximated;
            let careful = self.careful && k < CAREFUL;
            let refresh = refresh || k == 0 && work.trial.kinked || self.careful && k <= CAREFUL;
            if settled {
                self.evaluate(work, false, None);
                let force = self.force(work);
                let stuck = last <= noise && force_before.is_some_and(|before: f64| force > 0.5 * before);
                if (force <= 1.0 || stuck) && self.constraints_hold(work) {
                    let theta = seen(since, last_before, theta, renewals);
                    let unmet = !(force <= 1.0);
                    return Outcome::Converged(Rate { iterations: k, eta, theta, kept_failed, unmet });
                }
            }
            let before = std::mem::take(&mut work.trial.v_before);
            let leap = match k {
                _ if !kinks => None,
                _ if !refresh => None,
                0 if self.gripping => Some(Leap::Predicted),
                0 => None,
                _ => Some(Leap::From(&before)),
            };
            if !settled || refresh {
                self.evaluate(work, refresh, leap);
            }
            work.trial.v_before = before;
            let force = if test_forces { self.force(work) } else { 0.0 };
            let test = self.absolute(work);
            if test == Some(Test::Met) && !work.system.approximate {
                let theta = (renewals > 0).then_some(0.0);
                return Outcome::Converged(Rate { iterations: k, eta, theta, kept_failed, unmet: false });
            }
            if refresh && let Err(e) = self.factor(work, careful) {
                return Outcome::Linear(e);
            }
            // behind a kink, corrections say nothing about convergence
            let behind = std::mem::replace(&mut approximate, work.system.approximate);
            if kinks {
                work.trial.v_before.copy_from_slice(&work.trial.v);
                work.trial.kinked = if k == 0 { approximate } else { work.trial.kinked };
                approximated |= approximate;
            }
            kept_failed |= slow && renewals == 0 && theta > HOPELESS;
            renewals += u32::from(refresh);
            since = if slow || approximate || behind { 1 } else { since + 1 };
            work.counts.newton_iterations += 1;
            let residual = &work.system.residual;
            if residual.iter().fold(false, |bad, r| bad | !r.is_finite()) {
                return Outcome::Failed { why: "the residual is not finite".into() };
            }
            let s = self.model.structure();
            s.order(residual, &mut work.x);
            work.x.iter_mut().for_each(|x| *x = -*x);
            if self.stabilised {
                self.constraint_rates(work);
                for (&p, rate) in s.position[nv..].iter().zip(&work.trial.g_rate) {
                    work.x[p] = -rate / (self.scheme.gamma * self.h);
                }
            } else {
                for &p in &s.position[nv..] {
                    work.x[p] *= multiplier_scale;
                }
            }
            if let Err(e) = work.solve_ordered(self.model, Which::Iteration) {
                return Outcome::Linear(e);
            }
            s.add_restored(&work.x, &mut work.trial.aux, &mut work.trial.lambda);
            let mut size = beta_h2 * work.norms.relative_ordered(&work.x);
            if self.stabilised {
                match self.shift(work, multiplier_scale) {
                    Ok(shift) => size += shift,
                    Err(e) => return Outcome::Linear(e),
                }
            }
            self.kinematics(work);
            if !size.is_finite() {
                return Outcome::Failed { why: "the iteration left the finite numbers".into() };
            }
            if since > 1 {
                theta = size / last;
                eta = theta / (1.0 - theta).max(1e-3);
            } else {
                // new factors in the midst of it converge at least as well as a step that begins with them
                theta = 0.0;
                eta = eta.clamp(1e-16, TRUST).powf(0.8);
            }
            last_before = std::mem::replace(&mut last, size);
            // a rate that wasn't seen for some steps has to be seen again before it is trusted
            let trusted = since > 1 || eta <= TRUST;
            let force_left = left_of(force, force_before.replace(force).filter(|_| since > 1));
            settled =
                test_forces && (trusted && size * eta.min(1e3) <= stop || size <= floor) && !approximate;
            let done = match test {
                None => settled && force_left <= 1.0 && self.constraints_hold(work),
                Some(Test::Increment(limit)) => !approximate && self.increment(work) < limit,
                Some(_) => false,
            };
            if done {
                let theta = seen(since, last_before, theta, renewals);
                return Outcome::Converged(Rate { iterations: k + 1, eta, theta, kept_failed, unmet: false });
            }
            if theta >= 1.0 && (test.is_none() || size > noise) {
                // at the floor of rounding the iteration wanders; far from it, it diverges
                if size <= noise && renewals > 0 {
                    let theta = Some(1.0);
                    return Outcome::Converged(Rate {
                        iterations: k + 1,
                        eta: 1.0,
                        theta,
                        kept_failed,
                        unmet: !(force_left <= 1.0),
                    });
                }
                match renewals {
                    0 => return Outcome::Stale,
                    1..=MOST_RENEWALS => {}
                    ..MOST_AT_KINKS if approximated => {}
                    _ => return Outcome::Failed { why: "Newton's method diverges".into() },
                }
            }
        }
        if self.stopping != Stopping::Relative && last <= noise {
            let (iterations, theta) = (self.max_iterations, (renewals > 0).then_some(0.0));
            return Outcome::Converged(Rate { iterations, eta, theta, kept_failed, unmet: true });
        }
        Outcome::Failed { why: format!("{} Newton iterations were not enough", self.max_iterations) }
    }

    /// What is left of the equations of motion, as they were just assembled, over its tolerance.
    fn force(&self, work: &mut Workspace) -> f64 {
        let t = &work.trial;
        work.forces.ratio(&work.norms, &work.system.residual, &t.a, &t.lambda, self.force_tolerance)
    }

    /// What an absolute stopping test says of the equations, as they were just assembled.
    fn absolute(&self, work: &Workspace) -> Option<Test> {
        let Stopping::Absolute { residual, increment } = self.stopping else { return None };
        let met = residual.is_none_or(|r| self.units.residual(self.model, &work.system.residual) < r);
        Some(match (met, increment) {
            (false, _) => Test::Failed,
            (true, None) => Test::Met,
            (true, Some(limit)) => Test::Increment(limit),
        })
    }

    /// Norm of the correction of the coordinates that was just solved for.
    fn increment(&self, work: &Workspace) -> f64 {
        let positions = &self.model.structure().position[..self.model.velocities()];
        let scale = self.scheme.beta * self.h * self.h;
        self.units.increment(self.model, positions.iter().map(|&p| scale * work.x[p]))
    }

    fn place<'a>(&'a self, trial: &'a Trial) -> At<'a> {
        At {
            t: self.state.t + self.h,
            q: &trial.q,
            v: &trial.v,
            a: &trial.a,
            modes: &self.state.modes,
            relaxed: None,
        }
    }

    /// Sets the rates of the constraints at the trial.
    fn constraint_rates(&self, work: &mut Workspace) {
        let mut rate = std::mem::take(&mut work.trial.g_rate);
        self.model.constraint_rates(&self.place(&work.trial), &mut work.system, &mut rate);
        work.trial.g_rate = rate;
    }

    /// Moves positions onto the constraints beside their motion, by the shortest way in the metric of the iteration
    /// matrix. Gives the size of the move, relative to the part that it moves most.
    fn shift(&self, work: &mut Workspace, multiplier_scale: f64) -> Result<f64, SolveError> {
        let (nv, s) = (self.model.velocities(), self.model.structure());
        work.x.fill(0.0);
        for (&p, g) in s.position[nv..].iter().zip(&work.system.residual[nv..]) {
            work.x[p] = -g * multiplier_scale;
        }
        work.solve_ordered(self.model, Which::Iteration)?;
        let scale = 1.0 / multiplier_scale;
        for (shift, &p) in work.trial.shift.iter_mut().zip(&s.position[..nv]) {
            *shift += scale * work.x[p];
        }
        Ok(scale * work.norms.relative_ordered(&work.x))
    }

    fn constraints_hold(&self, work: &mut Workspace) -> bool {
        if self.stabilised {
            self.constraint_rates(work);
            let limit = 1e-9 * self.model.length();
            let rates = work.trial.g_rate.iter().zip(self.model.row_scale());
            if !rates.into_iter().all(|(g, s)| g.abs() <= limit * s) {
                return false;
            }
        }
        if self.linear_constraints {
            return true;
        }
        // what is left of them shakes the multipliers by its square of the step
        let (most, least) = (1e-10 * self.model.length(), 8.0 * self.model.rounding());
        let limit = (10.0 * self.tolerance * self.model.length()).min(most).max(least);
        let mut g = std::mem::take(&mut work.trial.g);
        self.model.violations(&self.place(&work.trial), &mut work.system, &mut g);
        let fine = g.iter().zip(self.model.row_scale()).all(|(g, s)| g.abs() <= limit * s);
        work.trial.g = g;
        fine
    }
}
