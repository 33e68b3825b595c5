//! The certificate of a run: it is run again with steps ten times tighter, and again on a mesh with a third of the
//! element length, which divides an error of second order by nine. What that changes is the error of the run.
//!
//! Error control bounds the error of each step, not what a motion makes of it: after a snap, or where a motion is chaotic,
//! small errors grow. Then the difference is far above the tolerance, and the run is called sensitive. What its error hangs
//! on is found by more runs ([`Cause`]).

mod accuracy;
mod cause;

pub use accuracy::choose;
pub use cause::Cause;

use crate::error::Error;
use crate::study::{Axes, Measured, Settings, Target, Watch, difference, measure, on_all_cores, words};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use ropewalk_core::V3;
use ropewalk_report::{SweepProgress, rough};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fmt::Write;
use std::sync::{Arc, Mutex, PoisonError};

/// How many times as many elements the finer mesh has.
const FINER: f64 = 3.0;
/// A change of more than this many tolerances makes a run sensitive.
const FAR: f64 = 10.0;
/// What a fixed step is held to, which promises nothing.
const OF_FIXED: f64 = 1e-3;

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
    fn sum(&self) -> f64 {
        self.step.unwrap_or(0.0) + self.mesh.unwrap_or(0.0)
    }
}

/// Runs of a scene with several settings, in memory, each computed once.
pub struct Trials<'a> {
    /// What is varied in the scene.
    pub axes: &'a Axes<'a>,
    /// Where all runs end, if before the end of the scene [s].
    pub until: Option<f64>,
    /// What may stop the runs.
    pub watch: Watch,
    /// What shows how far they are.
    pub progress: SweepProgress,
    known: Mutex<HashMap<String, Arc<Measured>>>,
    spent: Mutex<f64>,
}

impl<'a> Trials<'a> {
    /// No run yet.
    pub fn new(axes: &'a Axes<'a>, until: Option<f64>, watch: Watch, progress: SweepProgress) -> Self {
        Trials { axes, until, watch, progress, known: Mutex::default(), spent: Mutex::default() }
    }

    /// Runs these settings on all cores; of a run that was stopped there is none.
    fn get(&self, all: &[Settings]) -> Vec<Option<Arc<Measured>>> {
        all.par_iter().map(|settings| self.one(settings)).collect()
    }

    fn one(&self, settings: &Settings) -> Option<Arc<Measured>> {
        let (name, lock) =
            (format!("{settings:?}"), || self.known.lock().unwrap_or_else(PoisonError::into_inner));
        if let Some(run) = lock().get(&name) {
            return Some(run.clone());
        }
        if self.watch.is_over() {
            return None;
        }
        self.progress.plan(1);
        let run = match self.axes.with(settings, self.until) {
            Err(fault) => Measured::failed(fault.message),
            Ok(file) => {
                let progress = self.progress.begin(&self.axes.words(settings), file.scene().run.duration);
                measure(&file, true, self.watch, progress)
            }
        };
        self.progress.done(false);
        if run.cpu_s.is_finite() {
            *self.spent.lock().unwrap_or_else(PoisonError::into_inner) += run.cpu_s;
        }
        if run.stopped {
            return None;
        }
        let run = Arc::new(run);
        lock().insert(name, run.clone());
        Some(run)
    }

    /// CPU time so far [s].
    pub fn spent(&self) -> f64 {
        *self.spent.lock().unwrap_or_else(PoisonError::into_inner)
    }
    /// Number of runs so far.
    pub fn runs(&self) -> usize {
        self.known.lock().unwrap_or_else(PoisonError::into_inner).len()
    }
}

/// Certifies settings of a scene for these records; none if it was stopped.
///
/// # Errors
/// A record that has no size.
pub fn certify(
    trials: &Trials<'_>,
    settings: &Settings,
    records: &[Target],
    accuracy: Option<f64>,
) -> Result<Option<Certificate>, Error> {
    let tight = settings.stepping.map(|s| settings.stepped(Some(Axes::tighter(s))));
    let fine = settings.mesh.map(|m| settings.meshed(Some(FINER * m)));
    let wanted: Vec<Settings> = [Some(*settings), tight, fine].into_iter().flatten().collect();
    let spent = trials.spent();
    let done = on_all_cores(|| trials.get(&wanted))?;
    let Some(mut done) = done.into_iter().collect::<Option<Vec<_>>>() else { return Ok(None) };
    let base = done.remove(0);
    let tightened = tight.map(|_| done.remove(0));
    let refined = fine.map(|_| done.remove(0));
    let axes = trials.axes;
    let elements = |s: Settings| axes.elements(&s).iter().map(u64::to_string).collect::<Vec<_>>().join("+");
    let mut certificate = Certificate {
        tolerance: accuracy.or(settings.tolerance()).unwrap_or(OF_FIXED),
        settings: axes.words(settings),
        tighter: tight.and_then(|s| s.stepping).map(words::step),
        finer: fine.map(|s| format!("{} elements", elements(s))),
        positions: tightened.as_ref().and_then(|tight| moved(&base, tight)),
        ..Certificate::default()
    };
    let failed = |words: &str, run: &Measured| run.failure.as_ref().map(|why| format!("{words}: {why}"));
    let named =
        [("as it is", Some(&base)), ("tighter steps", tightened.as_ref()), ("finer mesh", refined.as_ref())];
    certificate.failures = named.iter().filter_map(|(words, run)| failed(words, (*run)?)).collect();
    for target in records {
        let size = target.size_in(&base.history)?;
        let change = |other: &Arc<Measured>| differences(target, &base, other);
        certificate.records.push(Change {
            record: target.text.clone(),
            size,
            unit: target.unit.clone(),
            step: tightened.as_ref().map(change).transpose()?,
            mesh: refined.as_ref().map(change).transpose()?,
        });
    }
    let far = FAR * certificate.tolerance;
    let asked = accuracy.is_some() || records.len() == 1;
    let by_record =
        |c: &Change| c.step.is_some_and(|x| x > far) || accuracy.is_some() && c.mesh.is_some_and(|x| x > far);
    certificate.sensitive = certificate.positions.is_some_and(|x| !(x <= far))
        || asked && certificate.records.iter().any(by_record)
        || certificate.failures.iter().any(|f| f.starts_with("tighter"));
    if accuracy.is_none() && certificate.failures.is_empty() {
        certificate.cause = cause::find(trials, settings, records, &certificate)?;
    }
    certificate.cpu_s = trials.spent() - spent;
    Ok(Some(certificate))
}

/// The largest difference of two runs in a record, relative to its size in the first; infinite if they don't agree in
/// anything, since one failed or ended at quite another time.
///
/// # Errors
/// A record that has no size.
fn differences(target: &Target, a: &Measured, b: &Measured) -> Result<f64, Error> {
    let size = target.size_in(&a.history)?;
    let change = difference(&target.of(&a.history), &target.of(&b.history), target.t.is_some()) / size;
    Ok(if b.failure.is_some() || change.is_nan() { f64::INFINITY } else { change })
}

/// The largest distance of two runs on the same mesh over time, as root mean square over all nodes, relative to the length
/// of the model; infinite if one of them ended early. Moments at which the meshes differ after all are left out.
fn moved(a: &Measured, b: &Measured) -> Option<f64> {
    let apart = |p: &[V3<f64>], q: &[V3<f64>]| {
        let squares = p.iter().zip(q).map(|(p, q)| (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>());
        (squares.sum::<f64>() / p.len() as f64).sqrt()
    };
    let (p, q) = (&a.positions, &b.positions);
    // an event may end one of them a little earlier
    if p.len().abs_diff(q.len()) > 1 + p.len() / 50 {
        return Some(f64::INFINITY);
    }
    let same = p.iter().zip(q).filter(|(p, q)| p.len() == q.len() && !p.is_empty());
    let all = same.map(|(p, q)| apart(p, q) / a.length);
    all.reduce(|m, x| if x.is_nan() || m.is_nan() { f64::INFINITY } else { m.max(x) })
}

impl Certificate {
    /// Whether all records are known to the tolerance.
    pub fn holds(&self) -> bool {
        self.failures.is_empty() && self.records.iter().all(|r| r.sum() <= self.tolerance)
    }

    /// Several lines for people.
    pub fn text(&self) -> String {
        let mut out = String::new();
        let mut line = |what: &str, text: String| _ = writeln!(out, "  {what:<9} {text}");
        let again = [
            self.tighter.as_ref().map(|t| format!("{t}, ten times tighter")),
            self.finer.as_ref().map(|f| format!("{f}, three times as many")),
        ];
        let again: Vec<String> = again.into_iter().flatten().collect();
        line(
            "certified",
            format!(
                "by running again with {}; {} s of CPU in all",
                again.join("; and with "),
                rough(self.cpu_s)
            ),
        );
        if let Some(x) = self.positions {
            line("", format!("positions: tighter steps change them by {} of the length", short(x)));
        }
        for r in &self.records {
            let parts = [("tighter steps", r.step), ("the finer mesh", r.mesh)];
            let parts: Vec<String> =
                parts.iter().filter_map(|(what, x)| Some(format!("{what} {}", short((*x)?)))).collect();
            line("", format!("{}: {}, of {} {}", r.record, parts.join(", "), rough(r.size), r.unit));
        }
        for failure in &self.failures {
            line("", format!("failed, {failure}"));
        }
        if self.sensitive {
            let worst = self.records.iter().filter_map(|r| r.step).chain(self.positions).fold(0.0, f64::max);
            line(
                "sensitive",
                format!(
                    "a change of {} is far above the tolerance of {:e}: no more than this is known",
                    short(worst),
                    self.tolerance
                ),
            );
        }
        if let Some(cause) = self.cause {
            line("cause", cause.text().into());
        }
        out
    }
}

fn short(x: f64) -> String {
    if x.is_finite() { format!("{x:.1e}") } else { "beyond all measure".into() }
}
