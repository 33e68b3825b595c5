//! What a certificate says, for summaries and for people.

use ropewalk_report::{Sheet, rough};
use serde::{Deserialize, Serialize};

/// How far a run can be trusted. Changes are relative: of positions to the length of the model, of records to their
/// largest magnitude.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// What the changes are held against: the accuracy asked for, or the tolerance of error control; 1e-3 for fixed steps.
    pub tolerance: f64,
    /// The settings that were certified, in words.
    pub settings: String,
    /// The tighter step or tolerance, if the run has steps.
    pub tighter: Option<String>,
    /// The finer mesh, if the scene has one.
    pub finer: Option<String>,
    /// Largest change of the positions of all nodes (root mean square) by tighter steps.
    pub positions: Option<f64>,
    /// What changed in the records.
    pub records: Vec<Change>,
    /// Whether the changes are more than ten times the tolerance.
    pub sensitive: bool,
    /// What that hangs on, as far as it was found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cause: Option<Cause>,
    /// Runs that failed, and why.
    pub failures: Vec<String>,
    /// CPU time that this took beside the run itself [s].
    pub cpu_s: f64,
}

/// What tighter steps and a finer mesh change in a record.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// The record.
    pub record: String,
    /// Its largest magnitude.
    pub size: f64,
    /// The unit of that.
    pub unit: String,
    /// Change by tighter steps.
    pub step: Option<f64>,
    /// Change by the finer mesh.
    pub mesh: Option<f64>,
}

impl Change {
    /// Both changes together; infinite if one of them couldn't be told.
    pub(super) fn sum(&self) -> f64 {
        self.step.unwrap_or(0.0) + self.mesh.unwrap_or(0.0)
    }
}

/// What an error hangs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cause {
    /// What Newton's method leaves in every step.
    Newton,
    /// Steps that are too long.
    Steps,
    /// A mesh that is too coarse.
    Mesh,
    /// The motion, in which small errors grow.
    Motion,
}

impl Cause {
    /// What it is and what helps, for people.
    pub(super) fn text(self) -> &'static str {
        match self {
            Cause::Newton => {
                "this is what Newton's method leaves in every step: solved to the end, the same steps agree with tighter \
                 ones. Take a smaller `newton_tolerance`, and `relative` for an `absolute` stopping test"
            }
            Cause::Steps => {
                "the steps are too long: tighter ones come together. Take a smaller `tolerance`, or a smaller `h`"
            }
            Cause::Mesh => "the mesh is too coarse: take more `elements`",
            Cause::Motion => {
                "small errors grow in this motion, however tight the steps: look at an earlier time, or at means"
            }
        }
    }
}

impl Certificate {
    /// Whether all records are known to the tolerance.
    pub fn holds(&self) -> bool {
        self.failures.is_empty() && self.records.iter().all(|r| r.sum() <= self.tolerance)
    }

    /// Several lines for people.
    pub fn text(&self) -> String {
        let mut sheet = Sheet::default();
        let again = [
            self.tighter.as_ref().map(|t| format!("{t}, ten times tighter")),
            self.finer.as_ref().map(|f| format!("{f}, three times as many")),
        ];
        let again = again.into_iter().flatten().collect::<Vec<_>>().join("; and with ");
        let mut lines = vec![format!("by running again with {again}; {} s of CPU in all", rough(self.cpu_s))];
        lines.extend(
            self.positions
                .map(|x| format!("positions: tighter steps change them by {} of the length", short(x))),
        );
        for r in &self.records {
            let parts = [("tighter steps", r.step), ("the finer mesh", r.mesh)];
            let parts: Vec<String> =
                parts.iter().filter_map(|(what, x)| Some(format!("{what} {}", short((*x)?)))).collect();
            lines.push(format!("{}: {}, of {} {}", r.record, parts.join(", "), rough(r.size), r.unit));
        }
        lines.extend(self.failures.iter().map(|failure| format!("failed, {failure}")));
        sheet.entries("certified", lines);
        if self.sensitive {
            let worst = self.records.iter().filter_map(|r| r.step).chain(self.positions).fold(0.0, f64::max);
            sheet.entry(
                "sensitive",
                format!(
                    "a change of {} is far above the tolerance of {:e}: no more than this is known",
                    short(worst),
                    self.tolerance
                ),
            );
        }
        if let Some(cause) = self.cause {
            sheet.entry("cause", cause.text());
        }
        sheet.to_string()
    }
}

fn short(x: f64) -> String {
    if x.is_finite() { format!("{x:.1e}") } else { "beyond all measure".into() }
}
