//! Vibration modes: small free motions `x e^{λt}` about an equilibrium, at rest or in a frame that moves steadily.
//!
//! The equations are those of the model, linearised where the equilibrium is: with the stiffness that comes of tension
//! and of the forces of constraints, in a turning frame with Coriolis and centrifugal forces. Multipliers stay in the
//! equations, so motions meet the constraints and no spurious modes come of them. What a term does wrong to a small order,
//! and says so, is left out: a cable that comes to a wheel by a fleet angle makes no mode grow.

mod align;
mod buckling;
mod dense;
mod krylov;
mod loading;
mod outcome;
mod pencil;
mod quadratic;
mod undamped;

use crate::model::Model;
use crate::model::assembly::System;
use crate::model::motion::SteadyFrame;
use crate::model::state::{At, State};
use crate::solve::statics::{Linear, Statics, StaticsOptions};
pub use outcome::{Critical, Mode, Modes, ModesError, OnLook};
use outcome::{Found, Watch, finish};
use pencil::Pencil;
use std::ops::ControlFlow;

/// A stiffness of less than so many times its own rounding is none.
const ZERO: f64 = 64.0;
/// A growth in parts of the fastest rate that is none.
const CREEPS: f64 = 1e-6;
/// What is left of a stiffness that may be none, and how far such rates are from others.
const CANCELS: f64 = 1e-11;
const APART: f64 = 1e-5;
/// By how many modes a state is judged at least.
const JUDGED: usize = 12;

/// Refuses a time at which a constraint moves otherwise than the frame, before an equilibrium is looked for in vain.
///
/// # Errors
/// [`ModesError::Moving`] with the constraint's name; the equations can't be set up.
pub fn check_at_rest(
    model: &Model,
    state: &State,
    options: &StaticsOptions,
    frame: Option<SteadyFrame>,
) -> Result<(), ModesError> {
    let mut statics = Statics::relative(model, options, frame).map_err(ModesError::Solver)?;
    statics.run_material(state)?;
    let mut rest = at_rest(state);
    statics.ride(&mut rest);
    refuse_moving(model, &rest)
}

/// Without velocities and accelerations.
fn at_rest(state: &State) -> State {
    let mut rest = state.clone();
    rest.v.fill(0.0);
    rest.a.fill(0.0);
    rest
}

/// Whether a state is in balance as it is, up to the tolerance of positions; if so, its multipliers are set. What no
/// search for equilibrium can find, since nothing tells one place from another, may be in balance all the same.
///
/// # Errors
/// The equations can't be solved, or something has no mass.
pub fn in_balance(
    model: &Model,
    state: &mut State,
    options: &StaticsOptions,
    frame: Option<SteadyFrame>,
) -> Result<bool, ModesError> {
    let renewed = model.renewed(&state.at(), true);
    let model = renewed.as_ref().unwrap_or(model);
    let mut statics = Statics::relative(model, options, frame).map_err(ModesError::Solver)?;
    statics.run_material(state)?;
    let mut trial = state.clone();
    // the first correction finds the multipliers, the second is taken with the stiffness that comes of them
    for round in 0..2 {
        let mut pencil = Pencil::new(model, &state.internal, statics.linearise(&trial))?;
        pencil.factor(0.0, 1e-9 * pencil.fastest).map_err(ModesError::Solver)?;
        let d = pencil.correction().map_err(ModesError::Solver)?;
        let (moves, multipliers) = d.split_at(model.velocities());
        let mut worst = 0.0_f64;
        for n in model.nodes() {
            for (k, x) in moves[n.dofs()].iter().enumerate() {
                let x = if k < 3 && n.kind.has_position() { x.abs() / model.length() } else { x.abs() };
                // max() would swallow a NaN
                worst = if x.is_nan() { f64::INFINITY } else { worst.max(x) };
            }
        }
        if !(worst <= options.tolerance) {
            return Ok(false);
        }
        trial.lambda.iter_mut().zip(multipliers).for_each(|(l, d)| *l += d);
        // a tiny strain of what is stiff is not a tiny force
        let before = trial.q.clone();
        model.retract(&before, moves, &mut trial.q);
        if round == 1 {
            statics.ride(&mut trial);
            *state = trial;
            return Ok(true);
        }
    }
    Ok(false)
}

/// The `count` lowest modes about the equilibrium in `state`, which [`Statics`] or [`in_balance`] has found; in the
/// order of `|λ|`. All there are if they are fewer. Sparse: the matrix `K + s C + s² M` is factored with the
/// constraints, and its inverse builds a Krylov space (Lanczos's and Arnoldi's methods).
///
/// # Errors
/// Something moves without mass, a constraint moves otherwise than the frame, or the iteration fails.
pub fn modes(
    model: &Model,
    state: &State,
    options: &StaticsOptions,
    frame: Option<SteadyFrame>,
    count: usize,
    look: &mut OnLook<'_>,
) -> Result<Modes, ModesError> {
    if count == 0 {
        return Err(ModesError::None);
    }
    let renewed = model.renewed(&state.at(), true);
    let model = renewed.as_ref().unwrap_or(model);
    let mut statics = Statics::relative(model, options, frame).map_err(ModesError::Solver)?;
    statics.run_material(state)?;
    let mut rest = at_rest(state);
    statics.ride(&mut rest);
    refuse_moving(model, &rest)?;
    let mut pencil = Pencil::new(model, &state.internal, statics.linearise_to_judge(&rest))?;
    let mut watch = Watch(look);
    let mut found = find(model, &mut pencil, count, &mut watch)?;
    if found.modes.is_empty() {
        return Err(ModesError::Held);
    }
    let all = std::mem::take(&mut found.modes);
    let modes = named(model, &pencil, all);
    // no law of inertia counts what is damped or gyroscopic, but a disturbance finds what grows
    let hidden = match pencil.damped || !pencil.symmetric {
        true if !modes.iter().any(Mode::is_unstable) => {
            let after = statics.disturb(&rest).map_err(ModesError::Solver)?;
            after.unstable.then_some(after.rate)
        }
        _ => None,
    };
    // the modes are right though a matrix of the buckling problem be singular
    let critical = match critical(&mut statics, model, &rest, &mut pencil, &modes) {
        Err(ModesError::Solver(_) | ModesError::Eigen) => None,
        found => found?,
    };
    let Found { missing, of, .. } = found;
    Ok(Modes { modes, damped: pencil.damped, of, missing, critical, hidden })
}

/// How far the loads may grow, whatever number of modes was asked for.
fn critical(
    statics: &mut Statics<'_>,
    model: &Model,
    state: &State,
    pencil: &mut Pencil,
    modes: &[Mode],
) -> Result<Option<Critical>, ModesError> {
    if modes.len() >= JUDGED {
        return buckling::critical(statics, model, state, pencil, modes);
    }
    let found = find(model, pencil, JUDGED, &mut Watch(&mut |_, _, _| ControlFlow::Continue(())))?;
    let modes = named(model, pencil, found.modes);
    buckling::critical(statics, model, state, pencil, &modes)
}

fn find(
    model: &Model,
    pencil: &mut Pencil,
    count: usize,
    watch: &mut Watch<'_>,
) -> Result<Found, ModesError> {
    let kinds = align::kinds(model, pencil);
    if pencil.damped || !pencil.symmetric {
        quadratic::find(pencil, count, &kinds, watch)
    } else {
        undamped::find(pencil, count, &kinds, watch)
    }
}

/// Modes with their names, in the order found, but rigid ones first.
fn named(model: &Model, pencil: &Pencil, mut all: Vec<outcome::Raw>) -> Vec<Mode> {
    let rate = |raw: &outcome::Raw| raw.rate[0].hypot(raw.rate[1]);
    let rates: Vec<f64> = all.iter().map(rate).collect();
    let fastest = rates.iter().copied().fold(0.0, f64::max);
    for (raw, own) in all.iter_mut().zip(&rates).filter(|(raw, _)| !raw.rigid) {
        // what creeps away a million times slower than others move is rounding of what is free
        let creeps = raw.rate[1] == 0.0 && raw.rate[0] > 0.0 && *own <= CREEPS * fastest;
        // so is what is left of a stiffness that cancels, unless others are about as slow
        let next = rates.iter().copied().filter(|other| other > own).fold(f64::INFINITY, f64::min);
        let drifts = raw.left <= CANCELS && next.is_finite() && *own <= APART * next;
        if creeps || drifts {
            (raw.rate, raw.rigid) = ([0.0; 2], true);
        }
    }
    let mut modes: Vec<Mode> = all.into_iter().map(|raw| finish(model, pencil, raw)).collect();
    modes.sort_by_key(|m| !m.rigid);
    modes
}

/// The `count` modes of smallest `|λ|` of equations that are linearised already, whether a state may vibrate or not.
pub(crate) fn slowest(
    model: &Model,
    internal: &[f64],
    linear: Linear,
    count: usize,
) -> Result<Vec<Mode>, ModesError> {
    let mut pencil = Pencil::new(model, internal, linear)?;
    let kinds = align::kinds(model, &pencil);
    let mut watch = Watch(&mut |_, _, _| ControlFlow::Continue(()));
    let found = quadratic::find(&mut pencil, count, &kinds, &mut watch)?;
    Ok(found.modes.into_iter().map(|raw| finish(model, &pencil, raw)).collect())
}

/// What is held still moves with the frame; what is driven must move like it, or not at all. What only begins to move is
/// held where it is.
fn refuse_moving(model: &Model, state: &State) -> Result<(), ModesError> {
    let m = model.multipliers();
    let (mut rate, mut sum) = (vec![0.0; m], vec![0.0; m]);
    let at: At<'_> = state.at();
    model.rates(&at, &mut rate, &mut vec![0.0; m]);
    model.constraint_rates(&at, &mut System::default(), &mut sum);
    let largest = |rows: &[f64]| rows.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for (c, constraint) in model.constraints().iter().enumerate() {
        let rows = model.rows_of(c);
        let (driven, off) = (largest(&rate[rows.clone()]), largest(&sum[rows]));
        if driven > 0.0 && off > 1e-9 * driven {
            return Err(ModesError::Moving { constraint: constraint.name().into(), t: state.t });
        }
    }
    Ok(())
}
