//! Consistent velocities, accelerations and multipliers of a state in the midst of a motion: those for output.

use super::start::{solve_accelerations, velocity_rhs};
use super::workspace::{Which, Workspace};
use crate::model::Model;
use crate::model::node::retract;
use crate::model::state::{At, State};
use crate::model::term::Weights;
use crate::solve::linear::SolveError;

/// What moving velocities onto the constraints may change of forces, in parts of those at work.
const STRAINED: f64 = 1e-3;
/// What moving velocities onto the constraints leaves of how far they were off.
const MET: f64 = 1e-4;
/// Most solutions for that: a Jacobian from nearby needs more than one where bodies turn.
pub(crate) const MOST_MOVES: usize = 4;
/// Roundings of positions that constraints may be off by.
pub(super) const ROUNDINGS: f64 = 8.0;
/// How many times as many they may be off by where corrections are nothing but `noise`: a driven end far from the origin is
/// moved to and fro by tens of roundings.
const WANDERS: f64 = 16.0;

/// Roundings of positions that constraints may be off by once an iteration ends.
pub(super) fn roundings(noise: bool) -> f64 {
    if noise { WANDERS * ROUNDINGS } else { ROUNDINGS }
}

/// How velocities were moved onto the constraints.
#[derive(Clone, Copy, Default)]
pub(crate) struct Moved {
    /// How often.
    pub times: usize,
    /// What they were to be off by in the end.
    pub goal: f64,
}

/// Replaces velocities, accelerations and multipliers by those for output: velocities moved onto the constraints, and what
/// the index-1 system gives there. The integrator's own are noisier.
///
/// Velocities are moved in the metric of the mass unless that strains: what is next to a driven end would be strained at a
/// rate of its own, and damping along a stiff cable makes a large force of that. Then it is the metric of the iteration
/// matrix at this state, `M + γh C + βh² K`, in which it moves along.
///
/// # Errors
/// A matrix is singular; the state is as it was.
pub fn consistent(model: &Model, state: &mut State, work: &mut Workspace) -> Result<(), SolveError> {
    let weights = work.factored;
    if consistent_by_mass(model, state, work)? {
        return Ok(());
    }
    consistent_by_iteration(model, state, work, weights.unwrap_or_default())
}

/// The same in the metric of the mass alone; `false` if that would change forces, and nothing is changed.
pub(crate) fn consistent_by_mass(
    model: &Model,
    state: &mut State,
    work: &mut Workspace,
) -> Result<bool, SolveError> {
    work.assemble_mass(model, &state.at(), &state.lambda, 0.0, true)?;
    let v = on_constraints(model, state, work, Which::Mass)?;
    model.assemble(&state.at(), &state.lambda, None, &mut work.system);
    if v != state.v {
        let before = work.system.residual.clone();
        model.assemble(&At { v: &v, ..state.at() }, &state.lambda, None, &mut work.system);
        // without factors of a step this is a start, which meets the constraints already
        if work.factored.is_some() && strains(state, &before, work) {
            return Ok(false);
        }
    }
    state.v = v;
    accelerate(model, state, work).map(|()| true)
}

/// Moves positions onto the constraints, in the metric of the mass: redundant ones share forces out by what is left of how they
/// agree, which a trillionth of the model's size spoils.
///
/// # Errors
/// A matrix is singular.
pub(crate) fn agree(model: &Model, state: &mut State, work: &mut Workspace) -> Result<(), SolveError> {
    let (start, mut d) = (state.q.clone(), vec![0.0; model.velocities()]);
    for _ in 0..MOST_MOVES {
        let Some(mut way) = way_back(model, &state.at(), work) else { break };
        work.assemble_mass(model, &state.at(), &state.lambda, 0.0, true)?;
        work.solve(model, Which::Mass, &mut way)?;
        d.iter_mut().zip(&way).for_each(|(d, x)| *d += x);
        retract(model.nodes(), &start, &d, &mut state.q);
    }
    Ok(())
}

/// The same of velocities; the workspace then has the mass matrix of this state.
///
/// # Errors
/// A matrix is singular.
pub(crate) fn agree_in_velocity(
    model: &Model,
    state: &mut State,
    work: &mut Workspace,
) -> Result<(), SolveError> {
    work.assemble_mass(model, &state.at(), &state.lambda, 0.0, true)?;
    state.v = on_constraints(model, state, work, Which::Mass)?;
    Ok(())
}

/// Right-hand side that removes what the constraints are violated by, if that is more than rounding.
pub(crate) fn way_back(model: &Model, at: &At<'_>, work: &mut Workspace) -> Option<Vec<f64>> {
    let nv = model.velocities();
    let mut rhs = vec![0.0; model.structure().n];
    model.violations(at, &mut work.system, &mut rhs[nv..]);
    let least = ROUNDINGS * model.rounding();
    let met = rhs[nv..].iter().zip(model.row_scale()).all(|(g, scale)| g.abs() <= least * scale);
    rhs.iter_mut().for_each(|g| *g = -*g);
    (!met).then_some(rhs)
}

/// Replaces accelerations and multipliers by those that the equations of motion have at a state, by the factors of the mass
/// matrix there and what is left with those of the state, which the workspace has.
///
/// # Errors
/// A matrix is singular; the state is as it was.
pub(crate) fn accelerate(model: &Model, state: &mut State, work: &mut Workspace) -> Result<(), SolveError> {
    // forces and inertia are linear in accelerations and multipliers
    let (nv, m) = (model.velocities(), model.multipliers());
    let mut rhs = vec![0.0; nv + m];
    let mut known = state.a.clone();
    known.extend_from_slice(&state.lambda);
    work.times_mass(model, &known, &mut rhs);
    let (mut rate, mut bias) = (vec![0.0; m], vec![0.0; m]);
    model.rates(&state.at(), &mut rate, &mut bias);
    for (r, left) in rhs[..nv].iter_mut().zip(&work.system.residual) {
        *r -= left;
    }
    for (r, b) in rhs[nv..].iter_mut().zip(&bias) {
        *r = -b;
    }
    work.solve(model, Which::Mass, &mut rhs)?;
    state.a.copy_from_slice(&rhs[..nv]);
    state.lambda.copy_from_slice(&rhs[nv..]);
    Ok(())
}

/// The same in the metric of the iteration matrix with these weights.
pub(crate) fn consistent_by_iteration(
    model: &Model,
    state: &mut State,
    work: &mut Workspace,
    weights: Weights,
) -> Result<(), SolveError> {
    model.assemble(&state.at(), &state.lambda, Some(weights), &mut work.system);
    work.factor(model, weights)?;
    work.assemble_mass(model, &state.at(), &state.lambda, 0.0, true)?;
    let v = on_constraints(model, state, work, Which::Iteration)?;
    let (mut a, mut lambda) = (vec![0.0; model.velocities()], vec![0.0; model.multipliers()]);
    let zero = vec![0.0; model.velocities()];
    let at = At { v: &v, a: &zero, ..state.at() };
    solve_accelerations(model, &at, work, &mut a, &mut lambda)?;
    (state.v, state.a, state.lambda) = (v, a, lambda);
    Ok(())
}

/// Moves velocities onto the constraints in the metric of an iteration matrix from nearby, whose factors the workspace holds:
/// at most so often, until the sum of what they are off by is down to a `goal`, or to a share of what it was.
///
/// # Errors
/// A matrix is singular.
pub(crate) fn move_velocities(
    model: &Model,
    state: &mut State,
    work: &mut Workspace,
    most: usize,
    goal: Option<f64>,
) -> Result<Moved, SolveError> {
    let (nv, m) = (model.velocities(), model.multipliers());
    let mut kept = std::mem::take(&mut work.rates);
    model.keep_rates(&state.at(), &mut kept);
    let (mut rate, mut x) = (vec![0.0; m], Vec::with_capacity(nv + m));
    let (mut moved, mut before) = (Moved::default(), 0.0);
    let mut done = Ok(());
    while done.is_ok() && moved.times < most {
        model.kept_rates(&kept, &state.v, &mut rate);
        let scaled = rate.iter().zip(model.row_scale()).map(|(rate, scale)| (rate / scale).powi(2));
        let off = scaled.sum::<f64>().sqrt();
        if moved.times == 0 {
            moved.goal = goal.unwrap_or(MET * off);
        }
        // as it stands at zero, and where there are no constraints
        if off <= moved.goal && (goal.is_some() || moved.times > 0 || off == 0.0) {
            break;
        }
        x.clear();
        x.resize(nv, 0.0);
        x.extend(rate.iter().map(|rate| -rate));
        done = work.solve(model, Which::Iteration, &mut x);
        if done.is_ok() {
            state.v.iter_mut().zip(&x).for_each(|(v, x)| *v += x);
            moved.times += 1;
        }
        // a move leaves as large a part as the one before did
        if off * off <= moved.goal * before {
            break;
        }
        before = off;
    }
    work.rates = kept;
    done.map(|()| moved)
}

/// The velocities nearest to those of a state that the constraints allow, by the Jacobian in the mass matrix of this state.
fn on_constraints(
    model: &Model,
    state: &State,
    work: &mut Workspace,
    metric: Which,
) -> Result<Vec<f64>, SolveError> {
    let mut v = state.v.clone();
    if model.multipliers() == 0 {
        return Ok(v);
    }
    let mut rhs = velocity_rhs(model, &At { v: &v, ..state.at() }, work);
    work.solve(model, metric, &mut rhs)?;
    for (v, d) in v.iter_mut().zip(&rhs) {
        *v += d;
    }
    Ok(v)
}

/// Whether other velocities, with which the system was just assembled, change forces by more than a share of those at work.
fn strains(state: &State, before: &[f64], work: &mut Workspace) -> bool {
    let change: Vec<f64> = work.system.residual.iter().zip(before).map(|(new, old)| new - old).collect();
    !(work.forces.ratio(&work.norms, &change, &state.a, &state.lambda, STRAINED) <= 1.0)
}
