//! The generalized-α family with fixed or error-controlled steps.

use super::adding::{left, left_like_dice, left_once};
use super::controller::{StepController, StepLaw};
use super::convergence::{Failure, Rate};
use super::forces::{Ringing, Strained, larger};
use super::newton::Newton;
use super::options::{ConstraintForm, Limits, NewtonPolicy, Options, Stepping};
use super::predictor::{Past, best_order};
use super::scales::{Scaled, Units};
use super::scheme::{Coefficients, Scheme};
use super::start::{anew, settle};
use super::step::{Integrator, StepError, StepReport, linear, too_strict};
use super::workspace::{Which, Workspace};
use crate::error::BuildError;
use crate::model::Model;
use crate::model::limit::Limit;
use crate::model::state::{Control, State};
use crate::solve::linear::SolveError;
use std::f64::consts::TAU;

/// Integrator of the Newmark, HHT-α and generalized-α family on index-3 equations.
pub struct Alpha {
    options: Options,
    limits: Limits,
    scheme: Coefficients,
    /// What takes its place for a few steps where tension swings ever wilder: it leaves nothing of what steps don't resolve.
    calm: Coefficients,
    /// Time over which errors may add up [s].
    horizon: f64,
    units: Units,
    warning: Option<String>,
}

/// Elements along a cable up to which Newton's tolerance doesn't depend on their number.
const COARSE: f64 = 64.0;
/// What Newton's method may leave with fixed steps, and once where rounding keeps that from falling.
const FIXED: f64 = 1e-7;
const FIXED_ONCE: f64 = 1e-5;
/// Largest change of velocities across the constraints with the size of a step, in parts of what the tolerance allows for the
/// horizon, and of velocities themselves where steps are fixed.
const MOST_ACROSS: [f64; 2] = [10.0, 1e-3];
/// Largest rotation of a body in a fixed step [rad]: from a quarter turn on a driven joint may end on another branch.
const MOST_TURN: f64 = 1.5;
/// A step so much smaller than another one has a much smaller error, or it isn't that of the step.
const SHRUNK: f64 = 0.1;
/// How many times more than that is far.
const FAR: f64 = 100.0;
/// Steps with the scheme that takes away what swings: two do it, one more finds what follows.
const CALM: u32 = 3;
/// Safety factor of the step-size controller.
const SAFETY: f64 = 0.85;
/// How many times as much as inertia is off a tension may be, where it answers to what swings: next to a resonance.
const ANSWER: f64 = 5.0;

impl Alpha {
    /// Checks the options against the model. `duration` is the length of the run, over which errors add up unless
    /// the options say otherwise.
    pub fn new(options: &Options, model: &Model, duration: f64) -> Result<Self, StepError> {
        options.check()?;
        let scheme = options.scheme.coefficients()?;
        let calm = Scheme::GeneralizedAlpha { rho_inf: 0.0 }.coefficients()?;
        let mut warning = None;
        if model.multipliers() > 0
            && let Some(why) = options.scheme.unstable_with_constraints()?
        {
            if !options.allow_unstable || scheme.beta == 0.0 {
                let message = format!(
                    "this scheme is unstable with constraints: {why}. Take generalized-alpha with rho_inf below 1, \
                     HHT with a negative alpha{}",
                    if scheme.beta == 0.0 { "" } else { ", or set `allow_unstable = true`" }
                );
                return Err(BuildError::at("scheme", message).into());
            }
            warning = Some(format!("unstable scheme allowed: {why}"));
        }
        let units = options.scales.map_or(Ok(Units::SI), |scales| Units::of(scales, model))?;
        let horizon = options.horizon_in(duration);
        let limits = options.limits(duration);
        Ok(Alpha { options: options.clone(), limits, scheme, calm, horizon, units, warning })
    }

    /// Its numbers.
    pub fn scheme(&self) -> &Coefficients {
        &self.scheme
    }

    /// The numbers of the next step.
    fn now(&self, control: &Control) -> &Coefficients {
        if control.calm > 0 { &self.calm } else { &self.scheme }
    }

    /// What the scheme changes a number by between the last step and the next, as a ratio.
    fn change(&self, control: &Control, of: impl Fn(&Coefficients) -> f64) -> f64 {
        match (control.calm > 0, control.calmed) {
            (true, false) => of(&self.calm) / of(&self.scheme),
            (false, true) => of(&self.scheme) / of(&self.calm),
            _ => 1.0,
        }
    }

    /// Whether a calm scheme can take the place of this one: its auxiliary accelerations are of another time than the true ones.
    fn calms(&self) -> bool {
        self.controlled() && self.scheme.lead() != 0.0
    }

    /// What Newton's method may leave of positions, relative to the length of each part, and what it may where rounding keeps
    /// that from falling.
    fn newton_tolerances(&self, model: &Model, h: f64) -> [f64; 2] {
        // on short elements, what is left of an iteration strains more, and would spoil the next prediction
        let fine = (COARSE / model.finest().max(1) as f64).min(1.0).powi(2);
        let asked = self.options.newton_tolerance * fine;
        match self.options.stepping {
            Stepping::Fixed { .. } => [asked * FIXED, asked * FIXED_ONCE],
            Stepping::Controlled { tolerance } => {
                let step = if model.is_mechanism() { h / self.horizon } else { 1.0 };
                let left = if model.turns_smoothly() { left(step) } else { left_like_dice(step) };
                [left, left_once(step)].map(|left| asked * left * tolerance.min(1e-3))
            }
        }
    }

    /// Rescales the auxiliary acceleration to a new step size or scheme: it stands `Δ h` away from the true one. Where the calm scheme
    /// takes over, it is the mean of the last two true ones: it would have nine times the swing, and they have none together.
    fn rescale(&self, state: &State, h: f64, aux: &mut Vec<f64>) {
        let c = &state.control;
        aux.clear();
        if c.calm > 0 && !c.calmed && c.backs > 0 {
            aux.extend(state.a.iter().zip(&c.a_back[0]).map(|(a, back)| 0.5 * (a + back)));
            return;
        }
        let ratio = if c.h_last > 0.0 { self.change(c, Coefficients::lead) * h / c.h_last } else { 1.0 };
        aux.extend(state.aux.iter().zip(&state.a).map(|(aux, a)| a + ratio * (aux - a)));
    }

    /// Fits what velocities have across curved constraints to a step `h` of another size than the last: the scheme keeps it
    /// steady at `Cq h²` times the jerk across them (Arnold, Brüls & Cardona 2015). As it was, accelerations and
    /// multipliers would ring for tens of steps.
    fn fit_velocities(&self, model: &Model, state: &State, work: &mut Workspace, h: f64) {
        let mut v = work.trial.v_old.take().unwrap_or_default();
        let scheme = self.change(&state.control, Coefficients::error_constant).sqrt();
        let (ratio, nv) = (scheme * h / state.control.h_last, model.velocities());
        let fits = ratio != 1.0 && ratio <= LAW.most[0];
        if !fits || !model.is_linkage() || self.stabilised(model) {
            return;
        }
        if work.trial.across.is_empty() {
            work.trial.across = self.across(model, state, work).unwrap_or_else(|| vec![0.0; nv]);
        }
        let (across, more) = (&work.trial.across, ratio * ratio - 1.0);
        // next to a singular position, or after a step that was cut, it is something else, and growth would multiply it
        let most = match self.options.stepping {
            Stepping::Controlled { tolerance } => MOST_ACROSS[0] * tolerance / self.horizon,
            Stepping::Fixed { .. } => MOST_ACROSS[1] * work.norms.relative(&state.v),
        };
        if more.abs() * work.norms.relative(across) <= most {
            v.clear();
            v.extend(state.v.iter().zip(across).map(|(v, d)| v + more * d));
            work.trial.v_old = Some(v);
        }
    }

    /// What the velocities at the start of a step have across the constraints, in the metric of the last iteration matrix;
    /// `None` if there is none.
    fn across(&self, model: &Model, state: &State, work: &mut Workspace) -> Option<Vec<f64>> {
        work.factored?;
        let nv = model.velocities();
        let mut rhs = vec![0.0; model.structure().n];
        model.constraint_rates(&state.at(), &mut work.system, &mut rhs[nv..]);
        work.solve(model, Which::Iteration, &mut rhs).ok()?;
        rhs.truncate(nv);
        Some(rhs)
    }

    /// Predicts the auxiliary acceleration: the true one is continued by the polynomial that was best last time.
    fn predict(&self, state: &State, h: f64, work: &mut Workspace) {
        let c = self.now(&state.control);
        let n = state.a.len();
        let (a, t) = (&state.a[..n], &mut work.trial);
        let (new, old) = (&mut t.aux[..n], &t.aux_old[..n]);
        let scale = 1.0 / (1.0 - c.alpha_m);
        let (f_new, f_old, m_old) = ((1.0 - c.alpha_f) * scale, c.alpha_f * scale, c.alpha_m * scale);
        let order = state.control.order.min(state.control.backs);
        match Past::new(state, h).continued(order) {
            [_, 0.0, 0.0] => {
                for i in 0..n {
                    new[i] = (f_new + f_old) * a[i] - m_old * old[i];
                }
            }
            [x, y, z] => {
                let [one, two] = &state.control.a_back;
                let (one, two) = (&one[..n], if z == 0.0 { &one[..n] } else { &two[..n] });
                for i in 0..n {
                    let ahead = x * a[i] + y * one[i] + z * two[i];
                    new[i] = f_new * ahead + f_old * a[i] - m_old * old[i];
                }
            }
        }
        t.lambda.copy_from_slice(&state.lambda);
    }

    fn stabilised(&self, model: &Model) -> bool {
        self.options.constraints == ConstraintForm::Ggl && model.multipliers() > 0
    }

    /// Estimated error of the trial, relative to the part where it is largest: `|Cq h² (a₊ - a)|`, without what the
    /// constraints and the numerical damping take away. With it what tensions are off for it, over their tolerance.
    fn error(
        &self,
        model: &Model,
        state: &State,
        work: &mut Workspace,
        h: f64,
    ) -> Result<(f64, Strained), SolveError> {
        let scheme = self.now(&state.control);
        let factor = scheme.error_constant() * h * h;
        let (nv, mut e, mut rhs) =
            (model.velocities(), std::mem::take(&mut work.trial.d), std::mem::take(&mut work.trial.rhs));
        let t = &work.trial;
        for (e, (new, old)) in e.iter_mut().zip(t.aux.iter().zip(&t.aux_old)) {
            *e = factor * scheme.mass() * (new - old);
        }
        // what is prescribed has no error
        model.without_driven(&state.internal, &mut e);
        rhs.clear();
        rhs.resize(model.structure().n, 0.0);
        let known = work.times_inertia(model, &state.at(), &state.lambda, &e, &mut rhs[..nv]);
        let solved = known.and_then(|()| work.solve(model, Which::Iteration, &mut rhs));
        // once constraints have taken out what rounding and iterations leave across them
        for body in &work.bodies {
            let t = &work.trial;
            body.weigh(body.counts(&t.v, &t.a, work.norms.weights(), self.horizon), &mut rhs);
        }
        let size = work.norms.relative(&rhs[..nv]);
        let strained = work.forces.strained(&work.trial.q, &rhs[..nv], self.options.force_tolerance);
        (work.trial.d, work.trial.rhs) = (e, rhs);
        solved?;
        Ok((size, strained))
    }

    /// Predicts and iterates a step `h`, and judges what comes of it.
    fn attempt(
        &self,
        model: &Model,
        state: &State,
        work: &mut Workspace,
        h: f64,
        remedies: &Remedies,
    ) -> Result<Attempt, StepError> {
        let mut aux = std::mem::take(&mut work.trial.aux_old);
        self.rescale(state, h, &mut aux);
        work.trial.aux_old = aux;
        self.fit_velocities(model, state, work, h);
        self.predict(state, h, work);
        if self.stabilised(model) {
            work.trial.shift.fill(0.0);
        }
        let [tolerance, wandering] = self.newton_tolerances(model, h);
        let newton = Newton {
            model,
            state,
            scheme: *self.now(&state.control),
            h,
            policy: if self.full(state, remedies) { NewtonPolicy::Full } else { NewtonPolicy::Modified },
            max_iterations: self.options.max_iterations,
            tolerance,
            wandering,
            deep: model.turns_smoothly(),
            force_tolerance: self.options.newton_tolerance * self.options.newton_force_tolerance(),
            stopping: self.options.stopping,
            units: self.units,
            linear_constraints: !model.is_mechanism(),
            stabilised: self.stabilised(model),
            // a step that leaps over the instant at which something sticks ends so stiff that the estimate of its error
            // is blind: error control has to find that instant
            leaps: !self.controlled(),
            gripping: remedies.gripping,
            careful: remedies.careful,
        };
        // factors that served badly last time are not tried again
        if state.control.worn() {
            work.factored = None;
        }
        match newton.solve(work, state.control.eta.max(0.05)) {
            Ok(mut rate) => {
                rate.kept_failed |= remedies.stale;
                self.judge(model, state, work, h, rate)
            }
            Err(failure) => Ok(Attempt::Failed(failure)),
        }
    }

    /// Whether the matrix is made anew at every iteration: where kept factors failed, it changes too much even within a
    /// step.
    fn full(&self, state: &State, remedies: &Remedies) -> bool {
        remedies.stale || state.control.without_kept() || self.options.newton == NewtonPolicy::Full
    }

    fn controlled(&self) -> bool {
        matches!(self.options.stepping, Stepping::Controlled { .. })
    }

    /// Where the constraints are dependent for a moment, they are solved like redundant ones from here on; `false` if they
    /// are already, or aren't to blame.
    fn soften(&self, model: &Model, work: &mut Workspace) -> bool {
        let to_blame = work.softening.is_none() && model.multipliers() > 0;
        if to_blame {
            work.soften(model);
        }
        to_blame
    }

    /// Chooses what a step that didn't converge is repeated with before it is made smaller; `false` if nothing is left.
    fn remedy(
        &self,
        model: &Model,
        state: &State,
        work: &mut Workspace,
        failures: u32,
        remedies: &mut Remedies,
    ) -> bool {
        if !self.full(state, remedies) {
            // kept factors may be what fails, where forces turn much within a step
            remedies.stale = true;
        } else if model.kinked() && !self.controlled() && !remedies.gripping {
            // the prediction may go on slipping where something is about to stop
            remedies.gripping = true;
        } else if failures == 0 && !remedies.careful && model.is_mechanism() {
            // a mechanism may be about to end next to a singular position, which a smaller step needn't avoid
            remedies.careful = true;
        } else {
            return false;
        }
        work.factored = None;
        true
    }

    /// Whether velocities break the constraints by far more than what the error that positions may gather in the run asks.
    fn drifts(&self, model: &Model, state: &State, work: &mut Workspace) -> bool {
        let Stepping::Controlled { tolerance } = self.options.stepping else { return false };
        let mut rates = vec![0.0; model.multipliers()];
        model.constraint_rates(&state.at(), &mut work.system, &mut rates);
        let limit = FAR * tolerance * model.length() / self.horizon;
        rates.iter().zip(model.row_scale()).any(|(rate, scale)| rate.abs() > limit * scale)
    }

    /// Whether a trial that converged is to be accepted.
    fn judge(
        &self,
        model: &Model,
        state: &State,
        work: &mut Workspace,
        h: f64,
        rate: Rate,
    ) -> Result<Attempt, StepError> {
        let bad = |why: &str| Ok(Attempt::Bad { why: why.into() });
        if let Some(why) = model.flips(&state.q, &work.trial.d) {
            return bad(why);
        }
        match self.options.stepping {
            Stepping::Fixed { .. } if !model.is_mechanism() => {
                Ok(Attempt::Done { rate, error: 0.0, by: Limit::Fixed, strained: None })
            }
            Stepping::Fixed { .. } if model.turn(&work.trial.d) > MOST_TURN => {
                bad("a body turns too far in one step: it may end on another branch of its joint")
            }
            Stepping::Fixed { .. } if jumps(state, work) => {
                bad("velocities jump: a mechanism leaves its branch, or an impact is shorter than `h`")
            }
            Stepping::Fixed { .. } => {
                Ok(Attempt::Done { rate, error: 0.0, by: Limit::Fixed, strained: None })
            }
            Stepping::Controlled { tolerance } => {
                let turn = model.turn(&work.trial.d);
                let (local, strained) =
                    self.error(model, state, work, h).map_err(|source| linear(model, state.t, source))?;
                // errors of positions add up, per unit step, none by itself above all of them; stiff directions follow what
                // moves them, and forget
                let position = local * (self.horizon / h).max(1.0) / tolerance;
                let error = larger(position, strained.ratio);
                let by = if strained.ratio > position { Limit::Force } else { Limit::Position };
                // a body that is driven has no error, but a larger turn may end on another branch of its joint
                let error = if turn > 1.0 { error + turn * turn } else { error };
                if error.is_nan() {
                    return bad("the error estimate is not a number");
                }
                Ok(Attempt::Done { rate, error, by, strained: Some(strained) })
            }
        }
    }

    /// Moves the state to the end of a step `h`; what the controller remembers is still that of the step before.
    fn accept(&self, model: &Model, state: &mut State, work: &mut Workspace, h: f64, rate: &Rate) {
        let order = best_order(state, h, work);
        if model.is_linkage() {
            let (t, norms) = (&work.trial, &work.norms);
            let change = norms.relative_of(|i| t.aux[i] - t.aux_old[i]);
            state.control.note_pace(h, change, norms.relative(&t.a));
        }
        let c = &mut state.control;
        c.order = order;
        c.h_before = c.h_last;
        let [one, two] = &mut c.a_back;
        std::mem::swap(one, two);
        one.clear();
        one.extend_from_slice(&state.a);
        c.backs = (c.backs + 1).min(2);
        work.forces.keep(&mut c.forces);
        c.eta = rate.eta;
        c.theta = rate.theta.unwrap_or(c.theta);
        c.note_factors(rate.kept_failed);
        let t = &mut work.trial;
        std::mem::swap(&mut state.q, &mut t.q);
        std::mem::swap(&mut state.v, &mut t.v);
        std::mem::swap(&mut state.a, &mut t.a);
        std::mem::swap(&mut state.aux, &mut t.aux);
        std::mem::swap(&mut state.lambda, &mut t.lambda);
        state.t += h;
        work.counts.steps += 1;
        work.counts.unmet += u64::from(rate.unmet);
    }
}

/// What a trial step came to.
enum Attempt {
    /// It converged, with this estimated error over the tolerance, what that is the error of, and what it makes of tensions.
    Done { rate: Rate, error: f64, by: Limit, strained: Option<Strained> },
    /// It converged to something that can't be, and is to be repeated with a smaller step.
    Bad { why: String },
    /// It didn't converge.
    Failed(Failure),
}

/// With what a step is repeated before it is made smaller.
#[derive(Default)]
struct Remedies {
    /// Without kept factors.
    stale: bool,
    /// From a prediction that sticks where something slips.
    gripping: bool,
    /// With small corrections at first.
    careful: bool,
}

/// Its steps grow by the root of their error.
const LAW: StepLaw = StepLaw {
    growth: |error, _| SAFETY / error.max(1e-12).sqrt(),
    trend: None,
    most: [2.5; 2],
    worthless: 1.25,
    recovery: 1.1,
    shares_rest: false,
};

/// Whether velocities change within the step by half of what they are, although they hardly did in the step before: no
/// smooth motion does that. Steps with error control see it by themselves.
fn jumps(state: &State, work: &Workspace) -> bool {
    let norms = &work.norms;
    let change = norms.relative_of(|i| work.trial.v[i] - state.v[i]);
    let (before, after) = (norms.relative(&state.v), norms.relative(&work.trial.v));
    let last = state.control.h_last;
    last > 0.0 && last * norms.relative(&state.a) < 0.05 * before && change > 0.5 * before.max(after)
}

impl Integrator for Alpha {
    fn options(&self) -> &Options {
        &self.options
    }

    fn limits(&self) -> Limits {
        self.limits
    }

    fn horizon(&self) -> f64 {
        self.horizon
    }

    fn per_period(&self) -> f64 {
        // where all goes to and fro with `ω`, the inertia of a step `h` is off by `2 |Cq| (ω h)²` of it
        let off = 2.0 * self.scheme.error_constant().abs() * ANSWER;
        TAU * (off / self.options.force_tolerance).sqrt()
    }

    fn set_horizon(&mut self, horizon: f64) {
        self.horizon = horizon;
    }

    fn warning(&self) -> Option<&str> {
        self.warning.as_deref()
    }

    fn filter(&self, h: f64) -> f64 {
        self.scheme.beta * h * h
    }

    fn settle(
        &self,
        model: &Model,
        state: &mut State,
        work: &mut Workspace,
        h: f64,
        stiff: f64,
    ) -> Result<(), SolveError> {
        if !self.options.filter_start {
            state.aux.copy_from_slice(&state.a);
            return Ok(());
        }
        settle(model, state, work, &self.scheme, h, stiff, !self.stabilised(model))
    }

    fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        work: &mut Workspace,
        h_max: f64,
    ) -> Result<StepReport, StepError> {
        work.ensure_mass(model, &state.at(), &state.lambda)
            .map_err(|source| linear(model, state.t, source))?;
        if self.options.scales.is_some() && work.scaled.is_none() {
            work.scaled = Some(Scaled::new(model, self.units));
            work.factored = None;
        }
        let mut steps = StepController::new(&LAW, self.options.stepping, self.limits, &state.control, h_max);
        let mut remedies = Remedies::default();
        work.trial.across.clear();
        let mut renewed = false;
        loop {
            let h = steps.h;
            let (why, repeat) = match self.attempt(model, state, work, h, &remedies)? {
                Attempt::Done { rate, error, by, strained } if error <= steps.allowed(by) => {
                    let Ringing { part: rings, grows } =
                        work.forces.ring(state.control.h_last, self.options.force_tolerance);
                    self.accept(model, state, work, h, &rate);
                    let linkage = model.is_linkage();
                    let kept = if linkage { state.control.remembered(h, error, LAW.most[0]) } else { error };
                    steps.accepted(&mut state.control, kept, rate.iterations, by);
                    let control = &mut state.control;
                    (control.calmed, control.calm) = (control.calm > 0, control.calm.saturating_sub(1));
                    if grows && self.calms() {
                        control.calm = CALM;
                        steps.cap(control);
                    }
                    let (iterations, rejected, limit) = (rate.iterations, steps.rejected, steps.limit);
                    return Ok(StepReport { h, iterations, rejected, error, limit, rings, strained });
                }
                Attempt::Done { rate, error, by, .. } => {
                    work.counts.rejected += 1;
                    if !steps.too_large(error, rate.iterations, by) {
                        return Err(too_strict(model, state.t, &steps, work));
                    }
                    let [first, largest] = steps.first.unwrap_or([h, error]);
                    let stays = h <= SHRUNK * first && error > largest * (h / first).sqrt();
                    let driven =
                        model.is_mechanism() || !model.inputs().is_empty() && model.multipliers() > 0;
                    // not the error of this step: behind the kink of an input or a motion velocities meet the constraints to
                    // the order of the longer step before it, and where steps change much they may leave them altogether
                    let behind = stays && driven && h <= SHRUNK * state.control.h_last;
                    if behind || !renewed && h <= SHRUNK * first && self.drifts(model, state, work) {
                        renewed = true;
                        let internal = state.internal.clone();
                        anew(model, state, work, self, steps.h, true)?;
                        state.internal = internal;
                    }
                    continue;
                }
                Attempt::Bad { why } => (why, false),
                Attempt::Failed(Failure::Linear(source)) => {
                    let repeat = self.soften(model, work);
                    if !repeat && h <= self.limits.least {
                        return Err(linear(model, state.t, source));
                    }
                    (source.to_string(), repeat)
                }
                Attempt::Failed(Failure::Newton(why)) => {
                    (why, self.remedy(model, state, work, steps.failures, &mut remedies))
                }
            };
            if repeat {
                continue;
            }
            // what fails with the calm scheme may do without
            if std::mem::take(&mut state.control.calm) > 0 {
                continue;
            }
            // what comes and goes must not be leapt over
            if model.is_linkage() && steps.leap() {
                work.counts.rejected += 1;
                work.factored = None;
                (remedies.careful, remedies.gripping) = (false, false);
                continue;
            }
            let equation = work.worst_equation(model);
            work.counts.rejected += 1;
            work.factored = None;
            (remedies.careful, remedies.gripping) = (false, false);
            if !steps.failed(&mut state.control) {
                return Err(StepError::NoConvergence { t: state.t, h, why, equation });
            }
            if steps.failures == 2 && model.is_mechanism() && !self.controlled() {
                // velocities that meet the constraints only to the order of the old step would swing ever wilder
                let cap = state.control.h_cap;
                anew(model, state, work, self, steps.h, true)?;
                state.control.h_cap = cap;
            }
        }
    }
}
