//! `summary.json`: the few numbers that say how a run ended.

use crate::certificate::statement::Certificate;
use crate::error::Error;
use ropewalk_core::Audit;
use ropewalk_core::integrator::Limit;
use ropewalk_core::statics::CriticalKind;
use ropewalk_report::{Interrupt, Table};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fmt;

/// How a run ended, as `summary.json` holds it.
///
/// Numbers that aren't finite are written as `null`, since JSON has no word for them, and read
/// back as NaN.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Summary {
    /// One word for scripts, such as `finished`, `interrupted`, `failed`.
    pub status: Status,
    /// What a human should know about it.
    #[serde(default)]
    pub message: Option<String>,
    /// What one should know although the run went on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// What one should know about the model, such as numbers that follow from what the scene says.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Events of the run: what broke or let go, and when.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<Happened>,
    /// Loads at which equilibria lost their stability, in the order of the path.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub critical: Vec<CriticalLoad>,
    /// Rows of `history.csv`, from which one can tell whether the file is whole.
    #[serde(default)]
    pub rows: usize,
    /// The last value of every column of the history, by its name there; see [`set`](Self::set).
    #[serde(rename = "final", default)]
    pub final_values: Map<String, Value>,
    /// How much work it was.
    #[serde(default)]
    pub counts: Counts,
    /// How many steps were limited by what, such as `position error`; nothing of fixed steps.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub limits: BTreeMap<String, u64>,
    /// The energy balance at the end of the run.
    #[serde(default)]
    pub energy: EnergyTotals,
    /// CPU time of the run, in seconds.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub cpu_s: f64,
    /// Wall time, in seconds.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub wall_s: f64,
    /// How far the run can be trusted, if that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Certificate>,
    /// Where the time went, if the run was profiled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<Vec<ProfileEntry>>,
}

impl Summary {
    /// Sets the final values of all columns of a history.
    pub(crate) fn set_finals(&mut self, history: &Table) {
        for column in &history.columns {
            if let Some(last) = column.values.last() {
                self.set(&column.name, *last);
            }
        }
    }

    /// Sets how many steps were limited by what, in the order of [`Limit::ALL`].
    pub(crate) fn set_limits(&mut self, counts: &[u64]) {
        let told = Limit::ALL.iter().zip(counts).filter(|(_, n)| **n > 0);
        self.limits = told.map(|(limit, n)| (limit.word().to_string(), *n)).collect();
        if self.limits.keys().all(|word| word == Limit::Fixed.word()) {
            self.limits.clear();
        }
    }

    /// What limited steps, the most frequent first: `position error 81 %, growth 12 %`; nothing of fixed steps.
    pub(crate) fn limits_told(&self) -> Option<String> {
        let all: u64 = self.limits.values().sum();
        let mut sorted: Vec<(&String, &u64)> = self.limits.iter().collect();
        sorted.sort_by(|a, b| b.1.cmp(a.1));
        let share = |(word, n): (&String, &u64)| format!("{word} {:.2} %", 100.0 * *n as f64 / all as f64);
        let share = |entry| share(entry).replace(".00 %", " %");
        (!sorted.is_empty()).then(|| sorted.into_iter().map(share).collect::<Vec<_>>().join(", "))
    }

    /// Sets the final value of a column; columns keep the order in which they are set.
    ///
    /// ```
    /// # let mut summary = ropewalk_studies::run::Summary::default();
    /// summary.set("t", 20.0);
    /// summary.set("hose.end.tension", 250.5);
    /// ```
    pub fn set(&mut self, column: impl Into<String>, value: f64) {
        self.final_values.insert(column.into(), value.into());
    }
}

/// How a run ended, in a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It came to its end.
    Finished,
    /// An event ended it.
    Stopped,
    /// A signal such as Ctrl-C, or the end of the time given, stopped it.
    Interrupted,
    /// The solver gave up.
    #[default]
    Failed,
    /// It could not begin.
    Refused,
}

impl Status {
    /// All of them.
    pub const ALL: [Status; 5] =
        [Status::Finished, Status::Stopped, Status::Failed, Status::Refused, Status::Interrupted];

    /// Whether there is nothing left to compute.
    pub fn is_complete(self) -> bool {
        matches!(self, Status::Finished | Status::Stopped)
    }
    /// Whether there is no result, and not because it was interrupted.
    pub fn is_failure(self) -> bool {
        matches!(self, Status::Failed | Status::Refused)
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Status::Finished => "finished",
            Status::Stopped => "stopped",
            Status::Interrupted => "interrupted",
            Status::Failed => "failed",
            Status::Refused => "refused",
        })
    }
}

/// How an analysis ended.
pub(crate) enum Ending {
    Finished,
    /// By an event of this name.
    Stopped(String),
    /// By a signal or a deadline.
    Interrupted,
    Failed(Error),
}

impl From<Error> for Ending {
    fn from(error: Error) -> Self {
        if matches!(error, Error::Interrupted) { Ending::Interrupted } else { Ending::Failed(error) }
    }
}

impl Ending {
    pub(crate) fn status(&self) -> Status {
        match self {
            Ending::Finished => Status::Finished,
            Ending::Stopped(_) => Status::Stopped,
            Ending::Interrupted => Status::Interrupted,
            Ending::Failed(_) => Status::Failed,
        }
    }
    /// What stopped it before its end, if anything did.
    pub(crate) fn stopped_by(&self) -> Option<String> {
        match self {
            Ending::Stopped(by) => Some(by.clone()),
            Ending::Interrupted => Some(Interrupt::cause().into()),
            Ending::Finished | Ending::Failed(_) => None,
        }
    }
    /// What a human should know about it.
    pub(crate) fn message(&self) -> Option<String> {
        match self {
            Ending::Failed(error) => Some(error.to_string()),
            other => other.stopped_by().map(|by| format!("stopped by {by}")),
        }
    }
}

/// An event of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Happened {
    /// What it was.
    pub name: String,
    /// When it was, located between two steps [s].
    pub t: f64,
}

/// A load at which equilibria lost their stability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CriticalLoad {
    /// The load factor.
    pub load_factor: f64,
    /// What happens there: beyond a `limit` the model snaps through, at a `bifurcation` it buckles.
    pub kind: CriticalKind,
    /// In how many directions at once: two where a round column buckles.
    pub directions: usize,
    /// What moves and how.
    pub what: String,
}

/// How much work a run was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Accepted time steps.
    pub steps: u64,
    /// Tries of a step that were thrown away and repeated with a smaller one.
    pub rejected: u64,
    /// Newton iterations, those of rejected steps included.
    pub newton_iterations: u64,
    /// Factorisations of the tangent matrix.
    pub factorizations: u64,
}

/// The energy balance at the end of a run, in joules.
///
/// kinetic + potential − initial = supplied + carried − dissipated + imbalance.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct EnergyTotals {
    /// Kinetic energy at the end.
    #[serde(deserialize_with = "null_as_nan")]
    pub kinetic: f64,
    /// Potential energy at the end, elastic and of conservative fields.
    #[serde(deserialize_with = "null_as_nan")]
    pub potential: f64,
    /// Work done on the model from outside, since the start.
    #[serde(deserialize_with = "null_as_nan")]
    pub supplied: f64,
    /// Energy that material carried in over the ends, since the start.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub carried: f64,
    /// Energy lost to damping, drag and friction, since the start.
    #[serde(deserialize_with = "null_as_nan")]
    pub dissipated: f64,
    /// Kinetic and potential energy at the start.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub initial: f64,
    /// What the balance doesn't account for: the error of the integration.
    #[serde(deserialize_with = "null_as_nan")]
    pub imbalance: f64,
}

impl From<&Audit> for EnergyTotals {
    fn from(a: &Audit) -> Self {
        EnergyTotals {
            kinetic: a.kinetic,
            potential: a.potential,
            supplied: a.supplied,
            carried: a.carried,
            dissipated: a.dissipated,
            initial: a.initial,
            imbalance: a.imbalance(),
        }
    }
}

/// One line of a run's profile.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ProfileEntry {
    /// What was measured, such as a term's label.
    pub label: String,
    /// How often it was called.
    pub calls: u64,
    /// Time spent in it, in seconds.
    #[serde(deserialize_with = "null_as_nan")]
    pub seconds: f64,
    /// Its share of the whole, 0 … 1.
    #[serde(deserialize_with = "null_as_nan")]
    pub share: f64,
}

impl ProfileEntry {
    pub(crate) fn new(label: impl Into<String>, calls: u64, seconds: f64) -> Self {
        ProfileEntry { label: label.into(), calls, seconds, share: 0.0 }
    }
}

fn null_as_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_not_finite_become_null() {
        let mut summary = Summary { status: Status::Failed, cpu_s: f64::INFINITY, ..Summary::default() };
        summary.set("hose.tension", f64::NAN);
        summary.set("hose.end.x", f64::INFINITY);
        summary.energy.imbalance = f64::NAN;
        let value = serde_json::to_value(&summary).unwrap();
        assert_eq!(value["status"], "failed");
        assert_eq!(value["final"]["hose.tension"], Value::Null);
        assert_eq!(value["final"]["hose.end.x"], Value::Null);
        assert_eq!(value["cpu_s"], Value::Null);
        let back: Summary = serde_json::from_value(value).unwrap();
        assert!(back.energy.imbalance.is_nan() && back.cpu_s.is_nan());
    }

    #[test]
    fn a_summary_reads_back_and_keeps_the_order_of_columns() {
        let mut summary = Summary {
            status: Status::Finished,
            message: Some("reached t = 10 s".into()),
            counts: Counts { steps: 100, rejected: 2, newton_iterations: 310, factorizations: 120 },
            cpu_s: 0.25,
            profile: Some(vec![ProfileEntry { label: "cable".into(), calls: 310, seconds: 0.2, share: 0.8 }]),
            ..Summary::default()
        };
        summary.set("z", 1.0);
        summary.set("a", 0.1);
        let text = serde_json::to_string(&summary).unwrap();
        assert!(text.contains(r#""final":{"z":1.0,"a":0.1}"#));
        assert_eq!(serde_json::from_str::<Summary>(&text).unwrap(), summary);
    }
}
