//! Consistent starts: positions and velocities on the constraints, accelerations and multipliers that fit.

use super::options::Stepping;
use super::scheme::Coefficients;
use super::step::{Integrator, StepError};
use super::workspace::{Which, Workspace};
use crate::model::Model;
use crate::model::node::retract;
use crate::model::state::{At, State};
use crate::solve::linear::SolveError;

/// How far a start had to be moved: the part that was moved most, as a root mean square along it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Correction {
    /// Of positions [m].
    pub position: f64,
    /// Of velocities [m/s].
    pub velocity: f64,
}

/// Relative displacement of a start onto the constraints that is taken as meant.
const SMALL: f64 = 1e-3;
/// First step under error control, in parts of the time in which the part that moves most goes its own length.
const FIRST: f64 = 1e-2;
/// Relative change of velocities that is taken as meant.
const SMALL_VELOCITY: f64 = 0.05;

/// Makes a state consistent and ready for the integrator: positions and velocities are moved to the nearest point
/// on the constraints (in the norm of the mass), accelerations and multipliers are those of the equations of
/// motion, and the memory of the integrator is set so that neither order nor multipliers suffer from the start.
///
/// # Errors
/// The start is too far from the constraints and the options don't say `project`; or a linear system can't be
/// solved (a part without mass, redundant constraints).
pub fn prepare(
    model: &Model,
    state: &mut State,
    work: &mut Workspace,
    integrator: &dyn Integrator,
) -> Result<Correction, StepError> {
    let lenient = integrator.options().project;
    anew(model, state, work, integrator, first_step(integrator), lenient)
}

/// The same in the midst of a run, where velocities meet the constraints only to the order of the scheme.
///
/// # Errors
/// A linear system can't be solved.
pub(crate) fn restart(
    model: &Model,
    state: &mut State,
    work: &mut Workspace,
    integrator: &dyn Integrator,
) -> Result<Correction, StepError> {
    anew(model, state, work, integrator, first_step(integrator), true)
}

/// The first step, or a guess that the motion at the start may make smaller.
fn first_step(integrator: &dyn Integrator) -> f64 {
    let limits = integrator.limits();
    match integrator.options().stepping {
        Stepping::Fixed { h } => h,
        Stepping::Controlled { .. } => limits.start.unwrap_or(limits.guess),
    }
}

/// The same for a first step `h`; `lenient` accepts every correction.
pub(super) fn anew(
    model: &Model,
    state: &mut State,
    work: &mut Workspace,
    integrator: &dyn Integrator,
    h: f64,
    lenient: bool,
) -> Result<Correction, StepError> {
    let options = integrator.options();
    let linear =
        |t: f64, source: SolveError, what: &str| StepError::Linear { t, source, unknown: what.into() };
    work.forget();
    state.control = Default::default();
    state.lambda.fill(0.0);
    state.a.fill(0.0);
    let t = state.t;
    work.ensure_mass(model, &state.at(), &state.lambda)
        .map_err(|e| linear(t, e, "the mass matrix: every part needs a positive mass"))?;

    let position = project_positions(model, state, work)
        .map_err(|e| linear(t, e, "the constraints: are some redundant or impossible to meet?"))?;
    if position.relative > SMALL && !lenient {
        return Err(StepError::Inconsistent(inconsistent(
            model,
            "positions",
            position.size,
            "m",
            state,
            work,
        )));
    }
    // what touches takes hold before it begins to pull
    model.remember(state);
    let velocity = project_velocities(model, state, work)
        .map_err(|e| linear(t, e, "the constraints: are some redundant?"))?;

    let (mut a, mut lambda) = (vec![0.0; model.velocities()], vec![0.0; model.multipliers()]);
    let mut accelerate = |h: f64, state: &State, work: &mut Workspace| {
        let stiff = if options.filter_start { integrator.filter(h) } else { 0.0 };
        let done = accelerations(model, &state.at(), work, stiff, &mut a, &mut lambda);
        done.map(|()| (stiff, work.norms.relative(&a)))
    };
    let failed = |e| linear(t, e, "the initial accelerations");
    let (mut stiff, mut rate) = accelerate(h, state, work).map_err(failed)?;
    let mut h = h;
    if integrator.limits().start.is_none() && matches!(options.stepping, Stepping::Controlled { .. }) {
        let natural = FIRST / work.norms.relative(&state.v).max(rate.sqrt()).max(f64::MIN_POSITIVE);
        if natural < h {
            h = natural.max(integrator.limits().least);
            (stiff, rate) = accelerate(h, state, work).map_err(failed)?;
        }
    }
    state.control.h_start = h;

    let scale = work.norms.relative(&state.v) + rate.sqrt();
    if velocity.relative > SMALL_VELOCITY * scale && !lenient {
        return Err(StepError::Inconsistent(inconsistent(
            model,
            "velocities",
            velocity.size,
            "m/s",
            state,
            work,
        )));
    }
    state.a.copy_from_slice(&a);
    state.lambda.copy_from_slice(&lambda);
    integrator.settle(model, state, work, h, stiff).map_err(|e| linear(t, e, "the initial accelerations"))?;
    // norms need the plain mass matrix again
    work.has_mass = false;
    work.ensure_mass(model, &state.at(), &state.lambda).map_err(|e| linear(t, e, "the mass matrix"))?;
    if state.is_finite() {
        Ok(Correction { position: position.size, velocity: velocity.size })
    } else {
        Err(linear(t, SolveError::NotFinite, "the initial accelerations"))
    }
}

fn inconsistent(
    model: &Model,
    what: &str,
    size: f64,
    unit: &str,
    state: &State,
    work: &mut Workspace,
) -> String {
    let before = model.state();
    let mut g = vec![0.0; model.multipliers()];
    model.violations(&At { t: state.t, ..before.at() }, &mut work.system, &mut g);
    let worst = (0..model.constraints().len())
        .map(|c| (c, model.rows_of(c).map(|r| g[r].abs()).fold(0.0, f64::max)))
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let name =
        worst.map_or(String::new(), |(c, _)| format!(" (most in `{}`)", model.constraints()[c].name()));
    format!(
        "the initial {what} don't meet the constraints: meeting them moves the model by {size:.3e} {unit} \
         (root mean square along the part that is moved most){name}. Correct the start, let motions and waves begin at rest (`ramp`), or set `project = true` to accept it"
    )
}

/// By how much the part that is moved most has been moved.
#[derive(Clone, Copy, Default)]
struct Moved {
    /// Relative to its length.
    relative: f64,
    /// As it is [m], or [m/s].
    size: f64,
}

impl Moved {
    fn by(d: &[f64], work: &Workspace) -> Self {
        let (part, relative) = work.norms.worst(d);
        Moved { relative, size: relative * work.norms.groups[part].length }
    }
}

/// Moves positions to the point on the constraints that is nearest in the norm of the mass.
fn project_positions(model: &Model, state: &mut State, work: &mut Workspace) -> Result<Moved, SolveError> {
    let (nv, m) = (model.velocities(), model.multipliers());
    if m == 0 {
        return Ok(Moved::default());
    }
    let start = state.q.clone();
    let (mut d, mut md) = (vec![0.0; nv], vec![0.0; nv]);
    let limit = 100.0 * model.rounding();
    let mut last = f64::INFINITY;
    for _ in 0..50 {
        work.assemble_mass(model, &state.at(), &state.lambda, 0.0, true)?;
        let g = &work.mass.residual[nv..];
        let fine = g.iter().zip(model.row_scale()).all(|(g, s)| g.abs() <= limit * s);
        // on the constraints what is left of the way is rounding, which no system can be solved for
        if fine && last <= 1e-10 {
            return Ok(Moved::by(&d, work));
        }
        let mut rhs: Vec<f64> = vec![0.0; nv];
        rhs.extend(g.iter().map(|g| -g));
        work.times_mass(model, &d, &mut md);
        for (r, md) in rhs.iter_mut().zip(&md) {
            *r = -md;
        }
        work.solve(model, Which::Mass, &mut rhs)?;
        let step = work.norms.relative(&rhs[..nv]);
        for (d, r) in d.iter_mut().zip(&rhs) {
            *d += r;
        }
        retract(model.nodes(), &start, &d, &mut state.q);
        if !step.is_finite() {
            return Err(SolveError::NotFinite);
        }
        if step <= 100.0 * work.norms.rounding() {
            return Ok(Moved::by(&d, work));
        }
        last = step;
    }
    Err(SolveError::NotFinite)
}

/// Right-hand side that removes `G v + ∂g/∂t`.
pub(super) fn velocity_rhs(model: &Model, at: &At<'_>, work: &mut Workspace) -> Vec<f64> {
    let (nv, m) = (model.velocities(), model.multipliers());
    let (mut rate, mut bias) = (vec![0.0; m], vec![0.0; m]);
    model.rates(at, &mut rate, &mut bias);
    let mut rhs = vec![0.0; nv];
    rhs.extend(times_jacobian(model, work, at.v).iter().zip(&rate).map(|(gv, gt)| -gv - gt));
    rhs
}

/// `G x`, with the Jacobian in the mass system.
fn times_jacobian(model: &Model, work: &mut Workspace, x: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; model.structure().n];
    work.times_mass(model, x, &mut all);
    all.split_off(model.velocities())
}

fn project_velocities(model: &Model, state: &mut State, work: &mut Workspace) -> Result<Moved, SolveError> {
    if model.multipliers() == 0 {
        return Ok(Moved::default());
    }
    work.assemble_mass(model, &state.at(), &state.lambda, 0.0, true)?;
    let mut rhs = velocity_rhs(model, &state.at(), work);
    work.solve(model, Which::Mass, &mut rhs)?;
    let moved = Moved::by(&rhs[..model.velocities()], work);
    for (v, d) in state.v.iter_mut().zip(&rhs) {
        *v += d;
    }
    if moved.size.is_finite() { Ok(moved) } else { Err(SolveError::NotFinite) }
}

/// Solves `[M + stiff K, Gᵀ; G, 0] [a; λ] = [F; -bias]` at a place of evaluation.
fn accelerations(
    model: &Model,
    at: &At<'_>,
    work: &mut Workspace,
    stiff: f64,
    a: &mut [f64],
    lambda: &mut [f64],
) -> Result<(), SolveError> {
    let zero = vec![0.0; model.velocities()];
    let at = At { a: &zero, ..*at };
    let known = lambda.to_vec();
    work.assemble_mass(model, &at, &known, stiff, true)?;
    solve_accelerations(model, &at, work, a, lambda)
}

pub(super) fn solve_accelerations(
    model: &Model,
    at: &At<'_>,
    work: &mut Workspace,
    a: &mut [f64],
    lambda: &mut [f64],
) -> Result<(), SolveError> {
    let (nv, m) = (model.velocities(), model.multipliers());
    let (mut rate, mut bias) = (vec![0.0; m], vec![0.0; m]);
    model.rates(at, &mut rate, &mut bias);
    let none = vec![0.0; m];
    model.assemble(at, &none, None, &mut work.system);
    let mut rhs: Vec<f64> = work.system.residual[..nv].iter().map(|r| -r).collect();
    rhs.extend(bias.iter().map(|b| -b));
    work.solve(model, Which::Mass, &mut rhs)?;
    a.copy_from_slice(&rhs[..nv]);
    lambda.copy_from_slice(&rhs[nv..]);
    Ok(())
}

/// Sets the auxiliary acceleration a step's lead ahead of the true one, and gives the velocity the steady offset
/// normal to the constraints that the scheme has: multipliers then start without ringing. Without `offset` velocities
/// stay on the constraints.
pub(super) fn settle(
    model: &Model,
    state: &mut State,
    work: &mut Workspace,
    c: &Coefficients,
    h: f64,
    stiff: f64,
    offset: bool,
) -> Result<(), SolveError> {
    let nv = model.velocities();
    let e = 1e-2 * h;
    let d: Vec<f64> = (0..nv).map(|i| e * state.v[i] + 0.5 * e * e * state.a[i]).collect();
    let v: Vec<f64> = (0..nv).map(|i| state.v[i] + e * state.a[i]).collect();
    let mut q = state.q.clone();
    retract(model.nodes(), &state.q, &d, &mut q);
    let at = At { t: state.t + e, q: &q, v: &v, ..state.at() };
    let (mut later, mut lambda) = (vec![0.0; nv], state.lambda.clone());
    accelerations(model, &at, work, stiff, &mut later, &mut lambda)?;
    let jerk: Vec<f64> = later.iter().zip(&state.a).map(|(l, a)| (l - a) / e).collect();
    for i in 0..nv {
        state.aux[i] = state.a[i] + c.lead() * h * jerk[i];
    }
    if offset && model.multipliers() > 0 {
        work.assemble_mass(model, &state.at(), &state.lambda, 0.0, true)?;
        let mut rhs = vec![0.0; nv];
        rhs.extend(times_jacobian(model, work, &jerk));
        work.solve(model, Which::Mass, &mut rhs)?;
        for i in 0..nv {
            state.v[i] += c.error_constant() * h * h * rhs[i];
        }
    }
    Ok(())
}
