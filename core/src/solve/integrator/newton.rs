//! Newton's method of one trial step.
//!
//! The unknowns are the new auxiliary acceleration and the multipliers: with `δq = β h² δa`, `δv = γ h δa`,
//! `δv̇ = (1-αm)/(1-αf) δa` the matrix is `[(1-αm)/(1-αf) M + γ h C + β h² K, Gᵀ; G, 0]`, whose condition doesn't
//! grow as the step shrinks (Bottasso, Bauchau & Cardona 2007), and β = 0 is no special case.

use super::consistent::{ROUNDINGS, roundings};
use super::convergence::{Convergence, FLOOR, Failure, Rate};
use super::factors::{Factors, Remedy};
use super::options::NewtonPolicy;
use super::scales::{Stopping, Units};
use super::scheme::Coefficients;
use super::workspace::{Trial, Which, Workspace};
use crate::algebra::rotation::{along, vector_rate};
use crate::model::Model;
use crate::model::node::NodeKind;
use crate::model::state::{At, State};
use crate::model::term::{Leap, Weights};
use crate::solve::linear::SolveError;
use crate::solve::redundancy::Softening;

/// Iterations of a careful start. Next to a singular position a prediction off by `e` asks for a correction of `e` over
/// the distance, which may lead beyond the other branch; once the well determined directions are right, little is left.
const CAREFUL: u32 = 3;

/// The square of half a turn.
const HALF_TURN: f64 = std::f64::consts::PI * std::f64::consts::PI;
/// A correction by so many lengths of a part leads nowhere: from there on numbers only grow.
const FAR: f64 = 1e6;

/// Largest expected rest of the error that is believed without a second iteration. What is expected grows from step to
/// step that has only one.
const TRUST: f64 = 0.1;

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
    /// Whether to go on to that below rounding of positions.
    pub deep: bool,
    /// The same of corrections that do no harm where rounding leaves nothing else.
    pub wandering: f64,
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

/// What an iteration knows of itself.
struct Iteration {
    convergence: Convergence,
    factors: Factors,
    /// Whether terms with kinks are told where an iteration comes from.
    kinks: bool,
    /// Whether forces were approximated at kinks: in the present matrix, and at all.
    approximate: bool,
    approximated: bool,
    /// Whether positions are right, so that forces are looked at.
    settled: bool,
}

impl Iteration {
    fn corrected(&mut self, size: f64, force: f64) {
        let c = &mut self.convergence;
        c.corrected(size, force);
        if c.since == 1 {
            // new factors in the midst of it converge at least as well as a step that begins with them
            (c.theta, c.eta) = (0.0, c.eta.clamp(1e-16, TRUST).powf(0.8));
        }
    }

    fn rate(&self, iterations: u32, unmet: bool) -> Rate {
        let (theta, eta) = (self.convergence.seen(self.factors.fresh()), self.convergence.eta);
        Rate { iterations, eta, theta, kept_failed: self.factors.kept_failed, unmet }
    }
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
        let (v, a) = (&t.v_old.as_ref().unwrap_or(&self.state.v)[..n], &self.state.a[..n]);
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
        self.model.drive(self.state.t + h, &self.state.internal, &mut t.q, &mut t.v, &mut t.a);
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

    /// Iterates from the prediction in `work.trial.aux` and `work.trial.lambda`. `eta` is what the last step expects the
    /// remaining error to be.
    pub fn solve(&self, work: &mut Workspace, eta: f64) -> Result<Rate, Failure> {
        let rounding = work.norms.rounding();
        // next to a singular position rounding is amplified: to go on below it would only wander
        let deep = self.deep && work.softening.is_none();
        let tolerance = if deep { self.tolerance } else { self.tolerance.max(FLOOR * rounding) };
        let mut it = Iteration {
            convergence: Convergence::new(tolerance, rounding, TRUST, eta, 0.0),
            factors: Factors::new(self.policy),
            kinks: self.leaps && self.model.kinked(),
            approximate: false,
            approximated: false,
            settled: false,
        };
        self.kinematics(work);
        work.forces.look(self.model, &work.norms, self.state);
        for k in 0..self.max_iterations {
            if it.settled
                && let Some(rate) = self.forces_met(work, &it, k)
            {
                return Ok(rate);
            }
            let slow = !it.approximated && it.factors.slow(&it.convergence);
            let refresh = slow || it.approximated || self.wants_matrix(work, &it, k);
            if !it.settled || refresh {
                self.evaluate_from(work, &it, k, refresh);
            }
            let force = if self.stopping == Stopping::Relative { self.force(work) } else { 0.0 };
            let test = self.absolute(work);
            if test == Some(Test::Met) && !work.system.approximate {
                return Ok(Rate { theta: it.factors.fresh().then_some(0.0), ..it.rate(k, false) });
            }
            if refresh {
                self.factor(work, self.careful && k < CAREFUL)?;
                it.factors.renewed(&it.convergence, slow);
            }
            let kinked = self.note_kinks(work, &mut it, k);
            if slow || kinked {
                it.convergence.restart();
            }
            let size = self.correct(work)?;
            it.corrected(size, force);
            it.settled =
                self.stopping == Stopping::Relative && it.convergence.positions_right() && !it.approximate;
            if let Some(rate) = self.ends(work, &it, test, k + 1)? {
                return Ok(rate);
            }
        }
        if self.stopping != Stopping::Relative && it.convergence.is_noise() {
            let rate = it.rate(self.max_iterations, true);
            return Ok(Rate { theta: it.factors.fresh().then_some(0.0), ..rate });
        }
        Err(Failure::Newton(format!("{} Newton iterations were not enough", self.max_iterations)))
    }

    /// Where positions are right, whether forces are too before a further correction is made.
    fn forces_met(&self, work: &mut Workspace, it: &Iteration, iterations: u32) -> Option<Rate> {
        self.evaluate(work, false, None);
        let force = self.force(work);
        let met = (force <= 1.0 || it.convergence.stuck(force))
            && self.constraints_hold(work, it.convergence.is_noise());
        met.then(|| it.rate(iterations, !(force <= 1.0)))
    }

    /// Whether the iteration ends with the correction that was just made, well or not.
    fn ends(
        &self,
        work: &mut Workspace,
        it: &Iteration,
        test: Option<Test>,
        iterations: u32,
    ) -> Result<Option<Rate>, Failure> {
        let done = match test {
            None => {
                let c = &it.convergence;
                it.settled && c.force_left <= 1.0 && self.constraints_hold(work, c.is_noise())
            }
            Some(Test::Increment(limit)) => !it.approximate && self.increment(work) < limit,
            Some(_) => false,
        };
        if done {
            return Ok(Some(it.rate(iterations, false)));
        }
        let noise = it.convergence.is_noise();
        if !it.convergence.grows() || noise && test.is_some() {
            return Ok(None);
        }
        // at the floor of rounding the iteration wanders; far from it, it diverges
        if it.factors.fresh() && (noise || self.amplified(work, it)) {
            let rate = it.rate(iterations, !(it.convergence.force_left <= 1.0));
            return Ok(Some(Rate { eta: 1.0, theta: Some(1.0), ..rate }));
        }
        match it.factors.diverged(it.approximated) {
            Remedy::GoOn => Ok(None),
            _ => Err(Failure::newton("Newton's method diverges")),
        }
    }

    /// Whether all equations are met to rounding although corrections are larger than that: next to a singular position
    /// constraints hardly determine a direction.
    fn amplified(&self, work: &mut Workspace, it: &Iteration) -> bool {
        work.softening.is_some()
            && !it.approximate
            && it.convergence.size <= self.wandering
            && it.convergence.force_left <= 1.0
            && self.met_to(ROUNDINGS * self.model.rounding(), work)
    }

    /// Whether iteration `k` needs a new matrix even if it isn't slow.
    fn wants_matrix(&self, work: &Workspace, it: &Iteration, k: u32) -> bool {
        work.factored != Some(self.weights())
            || it.factors.always
            || k == 0 && work.trial.kinked
            || self.careful && k <= CAREFUL
    }

    /// Assembles for iteration `k`; terms with kinks are told where a new matrix comes from.
    fn evaluate_from(&self, work: &mut Workspace, it: &Iteration, k: u32, refresh: bool) {
        let before = std::mem::take(&mut work.trial.v_before);
        let leap = match k {
            _ if !(it.kinks && refresh) => None,
            0 if self.gripping => Some(Leap::Predicted),
            0 => None,
            _ => Some(Leap::From(&before)),
        };
        self.evaluate(work, refresh, leap);
        work.trial.v_before = before;
    }

    /// Notes whether forces were approximated at kinks; `true` if the next correction says nothing of convergence for it.
    fn note_kinks(&self, work: &mut Workspace, it: &mut Iteration, k: u32) -> bool {
        let behind = std::mem::replace(&mut it.approximate, work.system.approximate);
        if it.kinks {
            work.trial.v_before.copy_from_slice(&work.trial.v);
            work.trial.kinked = if k == 0 { it.approximate } else { work.trial.kinked };
            it.approximated |= it.approximate;
        }
        it.approximate || behind
    }

    /// Solves for a correction and makes it. Gives its size, relative to the part that it moves most.
    fn correct(&self, work: &mut Workspace) -> Result<f64, Failure> {
        work.counts.newton_iterations += 1;
        let residual = &work.system.residual;
        if residual.iter().fold(false, |bad, r| bad | !r.is_finite()) {
            return Err(Failure::newton("the residual is not finite"));
        }
        let (s, nv) = (self.model.structure(), self.model.velocities());
        let multiplier_scale = 1.0 / (self.scheme.beta * self.h * self.h);
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
        work.solve_ordered(self.model, Which::Iteration)?;
        let beta_h2 = self.scheme.beta.max(1.0 / 12.0) * self.h * self.h;
        let mut size = beta_h2 * work.norms.relative_ordered(&work.x);
        self.undo(work);
        s.add_restored(&work.x, &mut work.trial.aux, &mut work.trial.lambda);
        if self.stabilised {
            size += self.shift(work, multiplier_scale)?;
        }
        self.kinematics(work);
        // a NaN is far too
        if size <= FAR { Ok(size) } else { Err(Failure::newton("Newton's method runs away")) }
    }

    /// Turns corrections of orientations, which the matrix is made for, into those of the increment since the start of the
    /// step: undoes [`NodeKind::velocity`]. Without it an iteration would leave as much as half of what bodies turn by in
    /// the step, however fresh its matrix.
    fn undo(&self, work: &mut Workspace) {
        let s = self.model.structure();
        for node in self.model.nodes().iter().filter(|node| node.kind == NodeKind::Frame) {
            let turned = std::array::from_fn(|i| work.trial.d[node.v + 3 + i]);
            let p: [usize; 3] = std::array::from_fn(|i| s.position[node.v + 3 + i]);
            if along(&turned, &turned) < HALF_TURN {
                let rate = vector_rate(&turned, &p.map(|p| work.x[p]));
                p.iter().zip(rate).for_each(|(&p, x)| work.x[p] = x);
            }
        }
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
            internal: &self.state.internal,
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
        let size = scale * work.norms.relative_ordered(&work.x);
        self.undo(work);
        for (shift, &p) in work.trial.shift.iter_mut().zip(&s.position[..nv]) {
            *shift += scale * work.x[p];
        }
        Ok(size)
    }

    fn constraints_hold(&self, work: &mut Workspace, noise: bool) -> bool {
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
        let (most, least) = (1e-10 * self.model.length(), roundings(noise) * self.model.rounding());
        self.met_to((10.0 * self.tolerance * self.model.length()).min(most).max(least), work)
    }

    /// Whether the trial violates no constraint by more than this, in its own scale.
    fn met_to(&self, limit: f64, work: &mut Workspace) -> bool {
        let mut g = std::mem::take(&mut work.trial.g);
        self.model.violations(&self.place(&work.trial), &mut work.system, &mut g);
        let fine = g.iter().zip(self.model.row_scale()).all(|(g, s)| g.abs() <= limit * s);
        work.trial.g = g;
        fine
    }
}
