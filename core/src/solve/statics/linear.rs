//! The equations of motion linearised about an equilibrium, in the frame of the search.

use super::problem::Statics;
use crate::model::state::{At, Relaxed, State};
use crate::model::structure::Structure;
use crate::model::term::Weights;

/// `M ẍ + C ẋ + K x + Gᵀλ = -r`, `G x = -g`, with all matrices stored as [`Structure::rows`] says.
///
/// In a frame that turns, `C` holds the gyroscopic and `K` the centrifugal part.
pub(crate) struct Linear {
    pub structure: Structure,
    /// `K`, and `G` in the rows of the constraints.
    pub stiffness: Vec<f64>,
    /// The same with `ρ GᵀG` added, for factorisation, and its residual.
    pub braced: Vec<f64>,
    pub braced_residual: Vec<f64>,
    pub damping: Vec<f64>,
    pub mass: Vec<f64>,
}

/// How much stiffer than all else constraints are braced in equations whose falling directions are counted.
const STIFFER: f64 = 1.25;

impl Statics<'_> {
    /// Linearises at a state, with the velocities and accelerations of the frame.
    pub(crate) fn linearise(&mut self, state: &State) -> Linear {
        self.linearise_as(state, None)
    }

    /// The same to tell stable from unstable by it.
    pub(crate) fn linearise_to_judge(&mut self, state: &State) -> Linear {
        self.linearise_as(state, Some(Relaxed::to_judge()))
    }

    fn linearise_as(&mut self, state: &State, relaxed: Option<Relaxed<'_>>) -> Linear {
        self.assemble(state, &state.q, &state.lambda, relaxed, true);
        let stiffness = self.system.values.clone();
        self.brace_by(STIFFER);
        Linear {
            structure: self.structure.clone(),
            stiffness,
            braced: self.system.values.clone(),
            braced_residual: self.system.residual.clone(),
            damping: self.damping.values.clone(),
            mass: self.mass.values.clone(),
        }
    }

    /// Residual and stiffness of the loads alone, as seen from the frame.
    pub(crate) fn loads(&mut self, state: &State) -> (Vec<f64>, Vec<f64>) {
        self.follow_frame(&state.q);
        let State { t, q, internal, .. } = state;
        let at = At { t: *t, q, v: &self.v, a: &self.a, internal, relaxed: None };
        let (q, v, a) = (1.0, 1.0, 1.0);
        let none = Weights::default();
        let (model, structure) = (self.model, &self.structure);
        model.assemble_loads(structure, &at, Weights { q, ..none }, &mut self.system);
        let omega = self.frame.map_or([0.0; 3], |f| f.omega);
        if omega != [0.0; 3] {
            model.assemble_loads(structure, &at, Weights { v, ..none }, &mut self.damping);
            model.assemble_loads(structure, &at, Weights { a, ..none }, &mut self.mass);
            self.turn_columns(omega, &state.q);
        }
        (self.system.residual.clone(), self.system.values.clone())
    }

    /// A state with the velocities and accelerations of the frame.
    pub(super) fn riding(&mut self, state: &State) -> State {
        let mut out = state.clone();
        self.ride(&mut out);
        out.aux.clone_from(&out.a);
        out
    }

    /// Sets velocities and accelerations of a state to those of the frame.
    pub(crate) fn ride(&mut self, state: &mut State) {
        self.follow_frame(&state.q);
        state.v.clone_from(&self.v);
        state.a.clone_from(&self.a);
    }
}
