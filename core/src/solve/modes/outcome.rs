//! Modes as they are found and told.

use super::pencil::Pencil;
use crate::model::Model;
use crate::model::node::{Node, NodeKind};
use crate::solve::linear::SolveError;
use crate::solve::statics::StaticsError;
use std::ops::ControlFlow;

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

pub(super) struct Watch<'a>(pub(super) &'a mut OnLook<'a>);

impl Watch<'_> {
    pub(super) fn look(&mut self, good: usize, count: usize, vectors: usize) -> Result<(), ModesError> {
        match (self.0)(good, count, vectors) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(ModesError::Interrupted),
        }
    }
}

/// A mode in elimination order.
pub(super) struct Raw {
    pub(super) rate: [f64; 2],
    pub(super) rigid: bool,
    pub(super) shape: [Vec<f64>; 2],
    pub(super) residual: f64,
    /// What is left of its stiffness, in parts of the entries that make it.
    pub(super) left: f64,
}

pub(super) struct Found {
    pub(super) modes: Vec<Raw>,
    pub(super) missing: Option<usize>,
    pub(super) of: Option<usize>,
}

/// How far the loads may grow.
#[derive(Clone, Debug, PartialEq)]
pub struct Critical {
    /// The loads that grow together, by label.
    pub loads: Vec<String>,
    /// The smallest positive factor at which an equilibrium is lost that is there before; of an unstable equilibrium the
    /// one, below 1, from which on it is unstable. `None` if there is none below [`Critical::MOST`].
    pub factor: Option<f64>,
    /// The direction in which it tips over, as a mode without a rate.
    pub shape: Option<Mode>,
    /// The factor up to which the path of equilibria is known; `None` where it wasn't followed, as falling directions can't
    /// be counted in matrices that aren't symmetric: the factor is that of linear buckling then.
    pub safe: Option<f64>,
}

impl Critical {
    /// The largest factor that is looked for; its inverse is the smallest.
    pub const MOST: f64 = 1e4;
}

/// Along which of [`Mode::directions`] a component of a node moves.
pub(super) fn direction(node: &Node, component: usize) -> Option<usize> {
    match node.kind {
        NodeKind::Frame if component >= 3 => Some(3),
        NodeKind::Twist if component == 6 => Some(3),
        NodeKind::Scalars(_) => None,
        _ => Some(component % 3),
    }
}

/// Brings a mode into the order of velocities, to unit size, and says what moves.
pub(super) fn finish(model: &Model, pencil: &Pencil, raw: Raw) -> Mode {
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
