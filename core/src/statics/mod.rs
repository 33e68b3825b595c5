//! Equilibria: at rest, along a load path, or relative to a frame that moves steadily.
//!
//! Newton's method with the remedies of [`Relaxed`](crate::Relaxed): geometric stiffness from the stress linearised at
//! the iterate before; a floor of tension where the tangent isn't positive; a cap of the stiff modulus at the first
//! iterations. An equilibrium is accepted if it is stable and not folded. Where Newton's method finds none, the model
//! creeps downhill to one; along a path of loads it follows the arc through bends and leaves critical points for the
//! stable path behind them.

mod creep;
mod critical;
mod disturbance;
mod flow;
mod linear;
mod naming;
mod neutral;
mod path;
mod search;
mod stability;
mod tangent;

pub use critical::{Critical, CriticalKind};
pub use disturbance::Disturbance;
pub(crate) use linear::Linear;
pub use neutral::Neutral;

use crate::build::{BuildError, positive};
use crate::model::{Model, System};
use crate::motion::SteadyFrame;
use crate::redundancy::Softening;
use crate::solver::{Guard, SolveError};
use crate::state::State;
use crate::structure::Structure;
use crate::times::{Clocks, Times};
use search::FOLD;
use serde::{Deserialize, Serialize};
use stability::Judgement;
use std::time::Duration;

/// How equilibria are found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StaticsOptions {
    /// Number of load steps from t = 0 to the end of the run.
    pub steps: usize,
    /// Most Newton iterations per equilibrium.
    pub max_iterations: u32,
    /// Refuse equilibria that are unstable or folded, and look for the true one.
    pub stable: bool,
    /// Tolerance of positions, relative to the reference length.
    pub tolerance: f64,
}

impl Default for StaticsOptions {
    fn default() -> Self {
        StaticsOptions { steps: 10, max_iterations: 60, stable: true, tolerance: 1e-9 }
    }
}

impl StaticsOptions {
    /// What is wrong with the numbers, if anything.
    pub fn check(&self) -> Result<(), BuildError> {
        let refused = |name: &str, message: String| Err(BuildError::at(format!("statics.{name}"), message));
        if self.steps == 0 || self.steps > 1_000_000 {
            return refused("steps", format!("`steps` must be between 1 and 1000000, not {}", self.steps));
        }
        if self.max_iterations == 0 {
            return refused("max_iterations", "`max_iterations` must be at least 1".into());
        }
        positive("tolerance", self.tolerance).map(drop).map_err(|e| e.of("statics.tolerance"))
    }
}

/// How an equilibrium was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Found {
    /// Newton iterations, each one factorisation and one solution.
    pub iterations: u32,
    /// Iterations in which the tangent was not positive and tension was given a floor.
    pub floored: u32,
    /// How often an unstable equilibrium was left by a push along its softest direction.
    pub pushes: u32,
    /// Whether the search was begun again from straight cables, because the first guess led to a fold.
    pub straightened: bool,
    /// Rate at which small disturbances grow, swinging to and fro [1/s]; 0 if they don't. Only asked where the first
    /// tangent of a path is not symmetric, as in flowing water.
    pub flutter: f64,
    /// Largest residual force [N].
    pub residual: f64,
}

impl Found {
    /// Adds the work of another search; the residual is that of the later one.
    pub fn add(&mut self, later: &Found) {
        self.iterations += later.iterations;
        self.floored += later.floored;
        self.pushes += later.pushes;
        self.straightened |= later.straightened;
        self.flutter = self.flutter.max(later.flutter);
        self.residual = later.residual;
    }
}

/// Why no equilibrium was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", self.told())]
pub struct StaticsError {
    /// Time [s], or the load factor.
    pub t: f64,
    /// Whether that is the load factor of a path.
    pub on_path: bool,
    /// What went wrong.
    pub why: String,
    /// Iterations spent.
    pub iterations: u32,
    /// Largest residual [N].
    pub residual: f64,
    /// Where.
    pub equation: String,
}

impl StaticsError {
    /// Nothing was searched, since there is nothing to be found.
    fn refused(t: f64, why: String) -> Self {
        StaticsError { t, on_path: false, why, iterations: 0, residual: 0.0, equation: String::new() }
    }

    /// Where on the path, or when.
    pub(super) fn place(&self) -> String {
        match (self.on_path, self.t) {
            (_, 0.0) => "at the start".into(),
            (true, t) => format!("at load factor {t}"),
            (false, t) => format!("at t = {t} s"),
        }
    }

    fn told(&self) -> String {
        let StaticsError { why, iterations, residual, equation, .. } = self;
        let place = self.place();
        if *iterations == 0 {
            return format!("there is no equilibrium {place}: {why}");
        }
        format!(
            "no equilibrium was found {place}: {why} (after {iterations} iterations, largest residual {residual:.2e} N in \
             {equation}). Try more load `steps`, a start closer to the solution, or a little bending stiffness"
        )
    }
}

/// How often the arc of a path is tried before shorter steps are.
const ARCS: u32 = 3;

/// Searches equilibria of one model. Keeps its scratch between searches.
pub struct Statics<'a> {
    model: &'a Model,
    options: StaticsOptions,
    frame: Option<SteadyFrame>,
    structure: Structure,
    solver: Guard,
    /// Where constraints are redundant.
    softening: Option<Softening>,
    system: System,
    damping: System,
    mass: System,
    /// The residual a little later, for its rate.
    ahead: System,
    clocks: Clocks,
    v: Vec<f64>,
    a: Vec<f64>,
    /// Whether material may run through cables, and at which rate it does so at the time of the search: place of each
    /// front's velocity and coordinate, and its rate.
    flows: bool,
    flow: Vec<(usize, usize, f64)>,
    /// Directions that nothing holds, as forces that would, in elimination order: no correction moves along them.
    free: Vec<Vec<f64>>,
    /// What the last equilibrium that was found is like.
    unstable: usize,
    neutral: Vec<Neutral>,
    doubt: Option<String>,
    judged: Judgement,
    /// Critical loads met so far.
    critical: Vec<Critical>,
    /// Longest stretch of time that was to be followed.
    span: f64,
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
            unstable: 0,
            neutral: Vec::new(),
            doubt: None,
            judged: Judgement { potential: true, ..Judgement::default() },
            critical: Vec::new(),
            span: 0.0,
        })
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

    /// Critical loads that [`Statics::follow`] has met, in the order of the path.
    pub fn critical(&self) -> &[Critical] {
        &self.critical
    }

    /// Moves `state` to the equilibrium at its time. `cold` says that no equilibrium nearby is known: the first of a
    /// path, or a guess.
    ///
    /// # Errors
    /// None was found, or there is none since the length of a cable changes; the state is as it was.
    pub fn find(&mut self, state: &mut State, cold: bool) -> Result<Found, StaticsError> {
        self.run_material(state)?;
        let before = state.clone();
        let found = self.seek(state, cold)?;
        self.refuse_unsteady(state).inspect_err(|_| state.clone_from(&before))?;
        Ok(found)
    }

    fn seek(&mut self, state: &mut State, cold: bool) -> Result<Found, StaticsError> {
        let before = state.clone();
        self.free.clear();
        let mut first = self.search(state, cold, cold, true);
        if first.is_err() && !cold {
            // from a neighbouring equilibrium the bare iteration nearly always gets there, and faster
            state.clone_from(&before);
            first = self.search(state, false, true, true);
        }
        let suspicious = match &first {
            Ok(_) => cold && self.options.stable && self.folded(state) < FOLD,
            Err(_) => cold,
        };
        if suspicious {
            first = self.find_straight(state, &before, first);
        }
        first.or_else(|e| self.find_otherwise(state, before, cold, e))
    }

    /// A guess can lead into a fold or nowhere; straight cables between their ends rarely do.
    fn find_straight(
        &mut self,
        state: &mut State,
        before: &State,
        first: Result<Found, StaticsError>,
    ) -> Result<Found, StaticsError> {
        let (neutral, doubt) = (self.neutral.clone(), self.doubt.clone());
        let mut other = before.clone();
        other.lambda.fill(0.0);
        for part in self.model.parts() {
            part.straighten(&mut other.q);
        }
        let second = self.search(&mut other, true, true, true);
        match (first, second) {
            (Ok(found), Ok(again)) if self.folded(&other) <= self.folded(state) => {
                _ = again;
                (self.neutral, self.doubt) = (neutral, doubt);
                Ok(found)
            }
            (_, Ok(again)) => {
                *state = other;
                Ok(Found { straightened: true, ..again })
            }
            (Ok(found), Err(_)) => {
                (self.neutral, self.doubt) = (neutral, doubt);
                Ok(found)
            }
            (Err(e), Err(_)) => Err(e),
        }
    }

    /// Where Newton's method finds nothing from a guess: something may be free to move, or the guess is far away.
    fn find_otherwise(
        &mut self,
        state: &mut State,
        before: State,
        cold: bool,
        first: StaticsError,
    ) -> Result<Found, StaticsError> {
        let mut found = Found { iterations: first.iterations, ..Found::default() };
        state.clone_from(&before);
        if self.set_free(state)
            && let Ok(more) = self.search(state, cold, cold, true)
        {
            found.add(&more);
            return Ok(found);
        }
        self.free.clear();
        if cold && self.options.stable {
            state.clone_from(&before);
            if self.creep(state, &mut found, true).is_ok() {
                return Ok(found);
            }
        }
        *state = before;
        Err(self.explain(state, first))
    }

    /// Moves the state from one equilibrium to that at time `t`: in one step if that converges, else in as many smaller
    /// ones as it needs, along the arc of the path where the load can't be raised. Critical loads are passed to where the
    /// path is stable again, and kept in [`Statics::critical`]. Returns the work of all of them.
    ///
    /// # Errors
    /// The path could not be followed; the state is the last equilibrium that was found.
    pub fn follow(&mut self, state: &mut State, t: f64) -> Result<Found, StaticsError> {
        let (mut h, mut sum) = (t - state.t, Found::default());
        self.span = self.span.max(h.abs());
        let least = h.abs() / 256.0;
        // shorter steps of the load come before the arc, which costs more
        let short = h.abs() / 4.5;
        let mut arcs = 0;
        while state.t != t {
            let before = state.clone();
            let swings = self.judged.flutter > 0.0;
            state.t = if (t - before.t).abs() <= 1.001 * h.abs() { t } else { before.t + h };
            let to = state.t;
            self.run_on(state, to - before.t);
            let e = match self.step_on(state) {
                Ok(found) => {
                    sum.add(&found);
                    if self.judged.flutter > 0.0 && !swings {
                        self.locate_by_load(&before, state, &mut sum);
                    } else if self.leapt(&before, state) {
                        self.go_round(&before, state, &mut sum)?;
                    }
                    h *= 2.0;
                    continue;
                }
                // what was refused isn't found by smaller steps either
                Err(e) if e.iterations == 0 => {
                    *state = before;
                    return Err(StaticsError { on_path: true, ..e });
                }
                Err(e) => e,
            };
            let unstable = self.unstable > 0;
            let beyond = state.clone();
            state.clone_from(&before);
            if self.options.stable && unstable && !self.judged.potential {
                self.locate_by_load(&before, &beyond, &mut sum);
                self.leave_last(state, to, &mut sum)?;
                continue;
            }
            if self.options.stable && (h.abs() <= short || unstable) && arcs < ARCS {
                arcs += 1;
                let known = self.critical.len();
                match self.trace(state, to, &mut sum) {
                    Ok(()) => {
                        arcs = 0;
                        continue;
                    }
                    // a critical load is an answer, if not the one that was hoped for
                    Err(e) if self.critical.len() > known => return Err(e),
                    Err(_) => state.clone_from(&before),
                }
            }
            h *= 0.5;
            if h.abs() < least {
                return Err(e);
            }
        }
        Ok(sum)
    }

    /// One step of [`Statics::follow`]: a stable equilibrium at the time of the state.
    fn step_on(&mut self, state: &mut State) -> Result<Found, StaticsError> {
        let before = state.clone();
        let mut first = self.search(state, false, false, false);
        if first.is_err() {
            state.clone_from(&before);
            first = self.search(state, false, true, false);
        }
        let found = first?;
        if self.unstable > 0 {
            let why = format!("it is unstable in {} directions", self.unstable);
            return Err(StaticsError { why, ..self.fail(state, "", found.iterations) });
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests;
