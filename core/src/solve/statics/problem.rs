//! The search for equilibria of one model: what it works on, and what it has found so far.

use super::options::StaticsOptions;
use super::outcome::{Critical, Judgement, Neutral};
use crate::model::Model;
use crate::model::assembly::System;
use crate::model::motion::SteadyFrame;
use crate::model::state::At;
use crate::model::structure::Structure;
use crate::solve::linear::{Guard, SolveError};
use crate::solve::redundancy::Softening;
use crate::solve::times::{Clocks, Times};
use std::time::Duration;

/// Searches equilibria of one model. Keeps its scratch between searches.
pub struct Statics<'a> {
    pub(super) model: &'a Model,
    pub(super) options: StaticsOptions,
    pub(super) frame: Option<SteadyFrame>,
    pub(super) structure: Structure,
    pub(super) solver: Guard,
    /// Where constraints are redundant.
    pub(super) softening: Option<Softening>,
    pub(super) system: System,
    pub(super) damping: System,
    pub(super) mass: System,
    /// The residual a little later, for its rate.
    pub(super) ahead: System,
    pub(super) clocks: Clocks,
    pub(super) v: Vec<f64>,
    pub(super) a: Vec<f64>,
    /// Whether material may run through cables, and at which rate it does so at the time of the search: place of each
    /// boundary's velocity and coordinate, and its rate.
    pub(super) flows: bool,
    pub(super) flow: Vec<(usize, usize, f64)>,
    /// Directions that nothing holds, as forces that would, in elimination order: no correction moves along them.
    pub(super) free: Vec<Vec<f64>>,
    /// Whether tangents are singular on the way, so that all that is free is held by a trace of stiffness: a body that is laid
    /// aslant may spin about its own axis, which isn't that of its equilibrium.
    pub(super) loose: bool,
    /// Whether the path has lost its stability by flutter, so that what grows on it may also go one way.
    pub(super) swung: bool,
    /// What the last equilibrium that was found is like.
    pub(super) unstable: usize,
    pub(super) neutral: Vec<Neutral>,
    pub(super) doubt: Option<String>,
    pub(super) judged: Judgement,
    /// Critical loads met so far.
    pub(super) critical: Vec<Critical>,
    /// Stretches of time that it leapt over and that the path couldn't be followed through.
    pub(super) unseen: Vec<[f64; 2]>,
    /// Longest stretch of time that was to be followed.
    pub(super) span: f64,
    /// Whether to give up, asked at every iteration.
    pub(super) is_over: Option<Box<dyn Fn() -> bool>>,
}

impl<'a> Statics<'a> {
    /// Prepares the search for equilibria at rest: what feeds a cable stands still.
    ///
    /// # Errors
    /// Not enough memory for the factors.
    pub fn new(model: &'a Model, options: &StaticsOptions) -> Result<Self, SolveError> {
        let at_rest = Self::relative(model, options, None)?;
        Ok(Statics { flows: false, ..at_rest })
    }

    /// Prepares the search for equilibria relative to a frame that moves steadily, such as a tow at constant speed or
    /// in a steady turn: one solution instead of a long run. The frame's centre is a point in space at the time of
    /// the search. Material runs through cables whose ends feed: where it runs in as fast as out, their shape may be
    /// steady, with the forces that this takes.
    ///
    /// # Errors
    /// Not enough memory for the factors.
    pub fn relative(
        model: &'a Model,
        options: &StaticsOptions,
        frame: Option<SteadyFrame>,
    ) -> Result<Self, SolveError> {
        let turning = frame.is_some_and(|f| f.omega != [0.0; 3]);
        let structure = if turning { model.unsymmetric_structure() } else { model.structure().clone() };
        let solver = Guard::new(&structure)?;
        let zero = vec![0.0; model.velocities()];
        Ok(Statics {
            model,
            options: options.clone(),
            frame,
            softening: model.redundancy().map(|_| Softening::new(model, &structure)),
            structure,
            solver,
            system: System::default(),
            damping: System::default(),
            mass: System::default(),
            ahead: System::default(),
            clocks: Clocks::default(),
            v: zero.clone(),
            a: zero,
            flows: true,
            flow: Vec::new(),
            free: Vec::new(),
            loose: false,
            swung: false,
            unstable: 0,
            neutral: Vec::new(),
            doubt: None,
            judged: Judgement { potential: true, ..Judgement::default() },
            critical: Vec::new(),
            unseen: Vec::new(),
            span: 0.0,
            is_over: None,
        })
    }

    /// Goes over to the model as it couples around a state, if it doesn't cover that yet; whether it did.
    pub(super) fn cover(&mut self, at: &At<'_>) -> Result<bool, SolveError> {
        let Some(renewed) = self.model.renewed(at, false) else { return Ok(false) };
        let turning = self.structure.symmetric != self.model.structure().symmetric;
        let same = self.model.couples_as(&renewed);
        self.model = self.model.keep(renewed);
        if same {
            return Ok(true);
        }
        self.structure =
            if turning { self.model.unsymmetric_structure() } else { self.model.structure().clone() };
        self.solver = Guard::new(&self.structure)?;
        self.softening = self.softening.take().map(|_| Softening::new(self.model, &self.structure));
        self.free.clear();
        Ok(true)
    }

    /// Gives up as soon as this says so; it is asked at every iteration. The error then
    /// says so.
    pub fn stop_if(&mut self, is_over: impl Fn() -> bool + 'static) {
        self.is_over = Some(Box::new(is_over));
    }

    pub(super) fn is_over(&self) -> bool {
        self.is_over.as_ref().is_some_and(|is_over| is_over())
    }

    /// Records the time of each term from now on.
    pub fn profile(&mut self) {
        for system in [&mut self.system, &mut self.damping, &mut self.mass] {
            system.profile = Some(Vec::new());
        }
        self.clocks = Clocks::running();
    }

    /// Calls and time of each term, of the constraints and of the solver, by label; nothing without
    /// [`Statics::profile`].
    pub fn times(&self) -> Vec<(String, u64, Duration)> {
        let systems = [&self.system, &self.damping, &self.mass];
        Times::default().adding(self.model, systems, &self.clocks).list()
    }

    /// Directions in which nothing holds the last equilibrium and nothing drives it.
    pub fn neutral(&self) -> &[Neutral] {
        &self.neutral
    }

    /// What can't be told about the stability of the last equilibrium.
    pub fn doubt(&self) -> Option<&str> {
        self.doubt.as_deref()
    }

    /// Stretches of time in which [`Statics::follow`] moved farther than the path explains, and couldn't go along it: a
    /// critical load there was passed.
    pub fn unseen(&self) -> &[[f64; 2]] {
        &self.unseen
    }

    /// Critical loads that [`Statics::follow`] has met, in the order of the path.
    pub fn critical(&self) -> &[Critical] {
        &self.critical
    }
}
