//! What the ledger of effects holds.

use super::work::EffectWork;
use crate::run::{Counts, ProfileEntry};
use serde::Serialize;

/// What became of a run with an effect more or less.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It ran.
    Ran {
        /// Largest change of the record, relative to its largest size in the run.
        change: f64,
        /// CPU time [s].
        cpu_s: f64,
        /// How much work it was.
        counts: Counts,
        /// Remarks, such as the event that ended it.
        note: String,
    },
    /// It did not run, for this reason.
    Failed(String),
}

impl Verdict {
    pub(super) fn change(&self) -> Option<f64> {
        if let Verdict::Ran { change, .. } = self { Some(*change) } else { None }
    }
}

/// An effect that was tried.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EffectTrial {
    /// Its name, such as `drag` or `bending of hose`.
    pub name: String,
    /// What was assumed of an effect that the scene lacks.
    pub note: String,
    /// What became of the run.
    pub verdict: Verdict,
}

/// All effects that change the record by less than the accuracy, left out together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Advice {
    /// The effects.
    pub names: Vec<String>,
    /// What became of the run without them.
    pub verdict: Verdict,
}

/// The ledger of effects of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct Ledger {
    /// The record that was watched, as it was asked for.
    pub record: String,
    /// Its largest size in the run, in SI units.
    pub scale: f64,
    /// CPU time of the run without clocks inside [s].
    pub cpu_s: f64,
    /// How much work the run is.
    pub counts: Counts,
    /// Where the time of the run went: terms, constraints, solver, and the rest; these add up to that of a run with clocks.
    pub costs: Vec<ProfileEntry>,
    /// What the effects do, term by term.
    pub work: Vec<EffectWork>,
    /// How far the record changes with finer time steps: smaller changes can't be told from the error of the run. None in
    /// statics, and where that run did not end.
    pub own_error: Option<f64>,
    /// The scene without each of its effects.
    pub without: Vec<EffectTrial>,
    /// The scene with each effect that it lacks and that could be tried.
    pub with: Vec<EffectTrial>,
    /// Effects that can't be guessed from the scene, and what to write to try them.
    pub hints: Vec<(String, String)>,
    /// What can be left out at the accuracy; none if nothing can.
    pub advice: Option<Advice>,
    /// By how much the time of the same run has differed between beginning and end: smaller savings can't be told.
    pub noise: f64,
    /// Whether Ctrl-C ended it before all effects were tried.
    pub interrupted: bool,
}

impl Ledger {
    /// CPU time of the run with clocks, which its costs add up to [s].
    pub fn measured_s(&self) -> f64 {
        self.costs.iter().map(|c| c.seconds).sum()
    }
}
