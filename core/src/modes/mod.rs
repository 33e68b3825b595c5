//! Vibration modes: small free motions `x e^{λt}` about an equilibrium, at rest or in a frame that moves steadily.
//!
//! The equations are those of the model, linearised where the equilibrium is: with the stiffness that comes of tension
//! and of the forces of constraints, in a turning frame with Coriolis and centrifugal forces. Multipliers stay in the
//! equations, so motions meet the constraints and no spurious modes come of them.

mod buckling;
mod krylov;
mod pencil;
mod quadratic;
mod undamped;

use crate::model::{Model, System};
use crate::motion::SteadyFrame;
use crate::node::{Node, NodeKind};
use crate::solver::SolveError;
use crate::state::{At, State};
use crate::statics::{Linear, Statics, StaticsError, StaticsOptions};
pub use buckling::Critical;
use pencil::Pencil;
use std::ops::ControlFlow;

/// A stiffness of less than so many times its own rounding is none.
const ZERO: f64 = 64.0;

/// A mode of vibration: `q(t) = q₀ ⊕ Re((shape + i quadrature) e^{λt})`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Real part of `λ` [1/s]: negative if the motion dies out, positive if it grows.
    pub growth: f64,
    /// Imaginary part of `λ`, not negative: the angular frequency of the damped motion [rad/s].
    pub omega: f64,
    /// Whether it costs no energy to move this way: nothing brings it back.
    pub rigid: bool,
    /// Its shape as an increment, of unit size in the norm of the mass: `sqrt(x̄ᵀ M x) = 1`.
    pub shape: Vec<f64>,
    /// What follows a quarter of a period later; zeros where all points move in phase.
    pub quadrature: Vec<f64>,
    /// Share of each node in the kinetic energy; they add up to 1.
    pub shares: Vec<f64>,
    /// Shares of motion along x, y and z and of the rotation of bodies.
    pub directions: [f64; 4],
    /// What is left of the equations, as a displacement against the shape.
    pub residual: f64,
}

impl Mode {
    /// Frequency [Hz]; 0 if the motion doesn't swing.
    pub fn frequency(&self) -> f64 {
        self.omega / std::f64::consts::TAU
    }
    /// Damping ratio `-Re λ / |λ|`: 0 undamped, 1 and no frequency if it creeps back without swinging.
    pub fn damping_ratio(&self) -> f64 {
        let size = self.growth.hypot(self.omega);
        // `0 -`, not `-`: no minus before a zero
        if size > 0.0 { (0.0 - self.growth) / size } else { 0.0 }
    }
    /// Whether a small disturbance grows this way, by more than what may be rounding.
    pub fn is_unstable(&self) -> bool {
        self.growth > 1e-7 * self.omega && !self.rigid
    }
}

/// The modes of an equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// Rigid ones first, then by `|λ|`; without damping unstable ones before all others.
    pub modes: Vec<Mode>,
    /// Whether forces depend on velocity, so that modes are damped or gyroscopic.
    pub damped: bool,
    /// Number of all modes, if fewer than asked for exist.
    pub of: Option<usize>,
    /// How many modes below the last one are missing or too many by Sylvester's law of inertia; `None` where it can't be
    /// asked.
    pub missing: Option<usize>,
    /// How far the loads may grow until the equilibrium tips over; `None` without loads.
    pub critical: Option<Critical>,
    /// The rate at which a disturbance grows that none of these modes explains [1/s]: there are others, unstable ones.
    pub hidden: Option<f64>,
}

/// Why modes can't be found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModesError {
    /// Something moves without mass.
    #[error("{unknown} has no mass, so it has no frequency: give it some, or hold it by a constraint")]
    Massless {
        /// The unknown.
        unknown: String,
    },
    /// A constraint moves otherwise than the frame.
    #[error(
        "`{constraint}` moves at t = {t} s, so there is no equilibrium to vibrate about: give modes of a steady motion \
         with `analysis = \"statics\"` and `frame` in [run], and hold what moves with the frame"
    )]
    Moving {
        /// Its name.
        constraint: String,
        /// When [s].
        t: f64,
    },
    /// Nothing can move.
    #[error("nothing can move: the constraints hold everything")]
    Held,
    /// No modes were asked for.
    #[error("the number of modes must be at least 1")]
    None,
    /// Material runs through a cable whose shape can't be steady.
    #[error(transparent)]
    Unsteady(#[from] StaticsError),
    /// A linear system can't be solved.
    #[error("the modes can't be computed: {0}")]
    Solver(SolveError),
    /// The eigenvalues of the projection can't be found.
    #[error("the modes can't be computed: the eigenvalues of the projected equations did not converge")]
    Eigen,
    /// The iteration takes too long.
    #[error("only {found} of {wanted} modes converged: ask for fewer with `--count`")]
    NotFound {
        /// How many are exact enough.
        found: usize,
        /// How many were asked for.
        wanted: usize,
    },
    /// Who watches has seen enough.
    #[error("interrupted")]
    Interrupted,
}

/// Progress: how many modes are exact, of how many, and how many vectors it took.
pub type OnLook<'a> = dyn FnMut(usize, usize, usize) -> ControlFlow<()> + 'a;

struct Watch<'a>(&'a mut OnLook<'a>);

impl Watch<'_> {
    fn look(&mut self, good: usize, count: usize, vectors: usize) -> Result<(), ModesError> {
        match (self.0)(good, count, vectors) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(ModesError::Interrupted),
        }
    }
}

/// A mode in elimination order.
struct Raw {
    rate: [f64; 2],
    rigid: bool,
    shape: [Vec<f64>; 2],
    residual: f64,
}

struct Found {
    modes: Vec<Raw>,
    missing: Option<usize>,
    of: Option<usize>,
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
    let mut statics = Statics::relative(model, options, frame).map_err(ModesError::Solver)?;
    statics.run_material(state)?;
    let mut trial = state.clone();
    // the first correction finds the multipliers, the second is taken with the stiffness that comes of them
    for round in 0..2 {
        let mut pencil = Pencil::new(model, &state.modes, statics.linearise(&trial))?;
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
    let mut statics = Statics::relative(model, options, frame).map_err(ModesError::Solver)?;
    statics.run_material(state)?;
    let mut rest = state.clone();
    rest.v.fill(0.0);
    rest.a.fill(0.0);
    statics.ride(&mut rest);
    refuse_moving(model, &rest, frame)?;
    let mut pencil = Pencil::new(model, &state.modes, statics.linearise(&rest))?;
    let mut watch = Watch(look);
    let found = if pencil.damped || !pencil.symmetric {
        quadratic::find(&mut pencil, count, &mut watch)?
    } else {
        let mut kinds = vec![0; pencil.len()];
        for node in model.nodes() {
            for (i, dof) in node.dofs().enumerate() {
                kinds[pencil.structure().position[dof]] = direction(node, i).unwrap_or(0);
            }
        }
        undamped::find(&mut pencil, count, &kinds, &mut watch)?
    };
    if found.modes.is_empty() {
        return Err(ModesError::Held);
    }
    let mut found = found;
    let all = std::mem::take(&mut found.modes);
    let mut modes: Vec<Mode> = all.into_iter().map(|raw| finish(model, &pencil, raw)).collect();
    // in the order found, but rigid ones first
    modes.sort_by_key(|m| !m.rigid);
    // no law of inertia counts what is damped or gyroscopic, but a disturbance finds what grows
    let hidden = match pencil.damped || !pencil.symmetric {
        true if !modes.iter().any(Mode::is_unstable) => {
            let after = statics.disturb(&rest).map_err(ModesError::Solver)?;
            after.unstable.then_some(after.rate)
        }
        _ => None,
    };
    // the modes are right though a matrix of the buckling problem be singular
    let critical = match buckling::critical(&mut statics, model, &rest, &mut pencil, &modes) {
        Err(ModesError::Solver(_) | ModesError::Eigen) => None,
        found => found?,
    };
    let Found { missing, of, .. } = found;
    Ok(Modes { modes, damped: pencil.damped, of, missing, critical, hidden })
}

/// The `count` modes of smallest `|λ|` of equations that are linearised already, whether a state may vibrate or not.
pub(crate) fn slowest(
    model: &Model,
    modes: &[f64],
    linear: Linear,
    count: usize,
) -> Result<Vec<Mode>, ModesError> {
    let mut pencil = Pencil::new(model, modes, linear)?;
    let found = quadratic::find(&mut pencil, count, &mut Watch(&mut |_, _, _| ControlFlow::Continue(())))?;
    Ok(found.modes.into_iter().map(|raw| finish(model, &pencil, raw)).collect())
}

/// What is held still moves with the frame; what is driven must move like it, or not at all.
fn refuse_moving(model: &Model, state: &State, frame: Option<SteadyFrame>) -> Result<(), ModesError> {
    let m = model.multipliers();
    let (mut rate, mut bias, mut sum) = (vec![0.0; m], vec![0.0; m], vec![0.0; m]);
    let at: At<'_> = state.at();
    model.rates(&at, &mut rate, &mut bias);
    model.constraint_rates(&at, &mut System::default(), &mut sum);
    for (c, constraint) in model.constraints().iter().enumerate() {
        let rows = model.rows_of(c);
        let driven = rate[rows.clone()].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let off = sum[rows.clone()].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let pushed = bias[rows].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        if (driven > 0.0 && off > 1e-9 * driven) || (frame.is_none() && pushed > 0.0) {
            return Err(ModesError::Moving { constraint: constraint.name().into(), t: state.t });
        }
    }
    Ok(())
}

/// Along which of [`Mode::directions`] a component of a node moves.
fn direction(node: &Node, component: usize) -> Option<usize> {
    match node.kind {
        NodeKind::Frame if component >= 3 => Some(3),
        NodeKind::Scalars(_) => None,
        _ => Some(component % 3),
    }
}

/// Brings a mode into the order of velocities, to unit size, and says what moves.
fn finish(model: &Model, pencil: &Pencil, raw: Raw) -> Mode {
    let (s, nv, n) = (pencil.structure(), model.velocities(), pencil.len());
    let mut shares = vec![0.0; model.nodes().len()];
    let mut directions = [0.0; 4];
    let mut parts = raw.shape.map(|x| if x.is_empty() { vec![0.0; n] } else { x });
    let (mut y, mut weighed) = (vec![0.0; n], vec![0.0; nv]);
    let mut energies = Vec::new();
    for x in &parts {
        pencil.mass(x, &mut y);
        y.iter_mut().zip(x).for_each(|(y, x)| *y *= x);
        s.restore(&y, &mut weighed);
        energies.push(weighed.clone());
    }
    let mass: f64 = energies.iter().flatten().sum();
    for (k, node) in model.nodes().iter().enumerate() {
        for (i, dof) in node.dofs().enumerate() {
            let e = (energies[0][dof] + energies[1][dof]) / mass;
            shares[k] += e;
            if let Some(d) = direction(node, i) {
                directions[d] += e;
            }
        }
    }
    let scale = 1.0 / mass.sqrt();
    parts.iter_mut().flatten().for_each(|x| *x *= scale);
    let [shape, quadrature] = parts.map(|x| {
        let mut out = vec![0.0; nv];
        s.restore(&x, &mut out);
        out
    });
    let [growth, omega] = raw.rate;
    Mode { growth, omega, rigid: raw.rigid, shape, quadrature, shares, directions, residual: raw.residual }
}
