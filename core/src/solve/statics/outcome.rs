//! What a search for equilibrium finds, and why it may find nothing.

use crate::model::state::State;
use std::fmt;

/// How an equilibrium was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Found {
    /// Newton iterations, each one factorisation and one solution.
    pub iterations: u32,
    /// Iterations in which the tangent was not positive and tension was given a floor.
    pub floored: u32,
    /// How often an unstable equilibrium was left by a push along its softest direction.
    pub pushes: u32,
    /// Whether the search was begun again from straight cables, or from arcs of slack ones, because the first guess led nowhere.
    pub straightened: bool,
    /// Rate at which small disturbances grow [1/s], swinging to and fro or fed by forces of velocities; 0 if they don't. Only
    /// asked where the first tangent of a path is not symmetric, as in flowing water.
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
    /// Whether it was stopped from outside, as [`Statics::stop_if`](super::Statics::stop_if) has it.
    pub interrupted: bool,
}

impl StaticsError {
    /// Nothing was searched, since there is nothing to be found.
    pub(super) fn refused(t: f64, why: String) -> Self {
        let (residual, equation) = (0.0, String::new());
        StaticsError { t, on_path: false, why, iterations: 0, residual, equation, interrupted: false }
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
        if self.interrupted {
            return format!("the search for an equilibrium {place} was stopped");
        }
        if *iterations == 0 {
            return format!("there is no equilibrium {place}: {why}");
        }
        format!(
            "no equilibrium was found {place}: {why} (after {iterations} iterations, largest residual {residual:.2e} N in \
             {equation}). Try more load `steps`, a start closer to the solution, or a little bending stiffness"
        )
    }
}

/// What happens at a critical load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum CriticalKind {
    /// The load has its largest value on the path: beyond, the model snaps through.
    Limit,
    /// Other paths branch off: the model buckles.
    Bifurcation,
    /// Under loads without potential, disturbances begin to swing ever wider.
    Flutter,
}

/// A load at which equilibria lose their stability.
#[derive(Clone, Debug, PartialEq)]
pub struct Critical {
    /// Load factor, or time [s].
    pub t: f64,
    /// What happens there.
    pub kind: CriticalKind,
    /// In how many directions at once: two where a round column buckles.
    pub directions: usize,
    /// What moves and how.
    pub what: String,
    /// The direction in which the model goes, as an increment.
    pub shape: Vec<f64>,
    /// The last stable equilibrium before it.
    pub state: State,
}

impl fmt::Display for CriticalKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            CriticalKind::Limit => "a limit point",
            CriticalKind::Bifurcation => "a bifurcation",
            CriticalKind::Flutter => "flutter",
        })
    }
}

impl fmt::Display for Critical {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let directions = match self.directions {
            1 => String::new(),
            n => format!(" in {n} directions"),
        };
        write!(f, "{}{directions}: {}", self.kind, self.what)
    }
}

/// A direction in which an equilibrium can be moved freely.
#[derive(Clone, Debug, PartialEq)]
pub struct Neutral {
    /// What moves and how, such as "`bar` turns about the axis (0, 0, 1) through (0, 0, 0) m".
    pub what: String,
    /// The line without bending stiffness whose shape changes, if nothing else moves.
    pub line: Option<String>,
    /// The direction, as an increment.
    pub shape: Vec<f64>,
}

/// What an equilibrium is like.
#[derive(Clone, Debug, Default)]
pub(super) struct Judgement {
    /// The time and the coordinates of what was judged, if it was found to be an equilibrium.
    pub of: Option<(f64, Vec<f64>)>,
    /// Newton's correction there.
    pub correction: Vec<f64>,
    /// Largest residual force [N].
    pub residual: f64,
    /// How many directions it can be left in by itself.
    pub unstable: usize,
    /// One of them, as an increment.
    pub way_out: Option<Vec<f64>>,
    /// Directions in which nothing holds it and nothing drives it.
    pub neutral: Vec<Neutral>,
    /// Rate at which disturbances swing ever wider [1/s], 0 if none does; and their shape.
    pub flutter: f64,
    pub swing: Vec<f64>,
    /// Rate at which what goes one way grows [1/s], where eigenvalues told.
    pub divergence: f64,
    /// Whether loads have a potential there.
    pub potential: bool,
    /// What the load moves, since nothing holds it: this is no equilibrium.
    pub driven: Option<String>,
    /// What can't be told.
    pub doubt: Option<String>,
}

impl Judgement {
    /// Rate at which a disturbance grows [1/s]; 0 if none does, or if it isn't known.
    pub fn growth(&self) -> f64 {
        self.flutter.max(self.divergence)
    }

    /// Whether its potential is least there, as far as can be told.
    pub fn is_least(&self) -> bool {
        self.potential && self.unstable == 0 && self.neutral.is_empty() && self.doubt.is_none()
    }
}

/// A point of a path of equilibria.
#[derive(Clone)]
pub(super) struct Point {
    pub state: State,
    /// Change of positions and multipliers, and of time, along the path.
    pub slope: Vec<f64>,
    pub rate: f64,
    /// Directions that it is unstable in.
    pub unstable: usize,
}
