//! Loads at which a path of equilibria loses its stability.

use crate::state::State;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What happens at a critical load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
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
