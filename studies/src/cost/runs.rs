//! The runs of a study of cost: each is computed once, and kept in a file of its own, so that the same study goes on
//! where it was stopped.

use crate::error::Error;
use crate::run::Counts;
use crate::study::{Axes, Settings, StudyFolder, Target, Watch, difference, measure, words};
use ropewalk_report::{OutputError, Progress, SweepProgress, Table, plain, write_json};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Runs shorter than this are timed several times [s] …
const SHORT: f64 = 0.1;
/// … and this often.
const REPEATS: usize = 3;

/// A run and what came of it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Run {
    pub settings: Settings,
    /// Whether it had the machine to itself.
    pub timed: bool,
    /// CPU time [s]; infinite if it was not measured.
    #[serde(with = "never")]
    pub cpu_s: f64,
    pub counts: Counts,
    /// Why there is no result, if so.
    pub failure: Option<String>,
    /// Time and what is looked at.
    #[serde(with = "csv")]
    pub values: Table,
}

/// All runs of the study, and how new ones are made.
pub(super) struct Runs<'a> {
    pub axes: &'a Axes<'a>,
    pub target: &'a Target,
    pub progress: SweepProgress,
    pub quiet: bool,
    folder: &'a StudyFolder,
    known: Mutex<HashMap<String, Arc<Run>>>,
    /// CPU time of this call [s].
    spent: Mutex<f64>,
}

impl<'a> Runs<'a> {
    /// Takes up what an earlier call left in the folder.
    pub(super) fn new(
        axes: &'a Axes<'a>,
        target: &'a Target,
        folder: &'a StudyFolder,
        progress: SweepProgress,
        quiet: bool,
    ) -> Self {
        let files = fs::read_dir(folder.run("")).into_iter().flatten().flatten();
        // a file that can't be read is one that has to be computed again
        let run = |path: &Path| serde_json::from_str::<Run>(&fs::read_to_string(path).ok()?).ok();
        let known = files.filter_map(|f| run(&f.path())).map(|r| (name(&r.settings, r.timed), Arc::new(r)));
        let known = Mutex::new(known.collect());
        Runs { axes, target, progress, quiet, folder, known, spent: Mutex::new(0.0) }
    }

    /// Number of runs that are there.
    pub(super) fn len(&self) -> usize {
        self.known.lock().unwrap_or_else(PoisonError::into_inner).len()
    }

    /// CPU time that this call has spent [s].
    pub(super) fn spent(&self) -> f64 {
        *self.spent.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// All runs that were timed.
    pub(super) fn timed(&self) -> Vec<Arc<Run>> {
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        known.values().filter(|r| r.timed).cloned().collect()
    }

    /// The run with these settings, with the machine to itself, and given up as soon as it has taken longer than `worth`;
    /// none if there was no time left for it.
    ///
    /// # Errors
    /// Its result can't be kept.
    pub(super) fn timed_for(
        &self,
        settings: &Settings,
        worth: Duration,
        watch: Watch,
    ) -> Result<Option<Arc<Run>>, Error> {
        self.kept(settings, Some(worth), watch)
    }

    /// The run with these settings, beside others; none if it was stopped before its end.
    ///
    /// # Errors
    /// Its result can't be kept.
    pub(super) fn get(&self, settings: &Settings, watch: Watch) -> Result<Option<Arc<Run>>, Error> {
        self.kept(settings, None, watch)
    }

    fn kept(
        &self,
        settings: &Settings,
        worth: Option<Duration>,
        watch: Watch,
    ) -> Result<Option<Arc<Run>>, Error> {
        let name = name(settings, worth.is_some());
        if let Some(run) = self.known.lock().unwrap_or_else(PoisonError::into_inner).get(&name) {
            return Ok(Some(run.clone()));
        }
        if watch.is_over() {
            return Ok(None);
        }
        self.progress.plan(1);
        let run = self.compute(settings, worth, watch);
        self.progress.done(false);
        let Some(run) = run else { return Ok(None) };
        let path = self.folder.run(&format!("{}.json", plain(&name)));
        fs::create_dir_all(self.folder.run("")).map_err(OutputError::io("create folder", &path))?;
        write_json(&path, &run)?;
        let run = Arc::new(run);
        self.known.lock().unwrap_or_else(PoisonError::into_inner).insert(name, run.clone());
        Ok(Some(run))
    }

    fn compute(&self, settings: &Settings, worth: Option<Duration>, watch: Watch) -> Option<Run> {
        let (timed, limit) = (worth.is_some(), worth.and_then(|w| Instant::now().checked_add(w)));
        let limited = Watch { deadline: [watch.deadline, limit].into_iter().flatten().min(), ..watch };
        let words = self.axes.words(settings);
        let mut run = Run {
            settings: *settings,
            timed,
            cpu_s: f64::INFINITY,
            counts: Counts::default(),
            failure: None,
            values: Table::default(),
        };
        let file = match self.axes.with(settings, self.target.t) {
            Ok(file) => file,
            Err(fault) => return Some(Run { failure: Some(fault.message), ..run }),
        };
        for _ in 0..if timed { REPEATS } else { 1 } {
            let progress: Progress = self.progress.begin(&words, file.scene().run.duration);
            let done = measure(&file, false, limited, progress);
            *self.spent.lock().unwrap_or_else(PoisonError::into_inner) += done.cpu_s;
            if done.stopped && watch.is_over() {
                return None;
            }
            run.cpu_s = run.cpu_s.min(done.cpu_s);
            (run.counts, run.failure) = (done.counts, done.failure);
            if done.stopped {
                run.failure = Some("given up: others are as accurate in far less time".into());
                (run.cpu_s, run.values) = (done.cpu_s, Table::default());
                break;
            }
            run.values = self.target.of(&done.history);
            if run.failure.is_some() || run.cpu_s > SHORT {
                break;
            }
        }
        Some(run)
    }

    /// Difference of two runs in what is looked at; NaN if one of them failed.
    pub(super) fn between(&self, a: &Run, b: &Run) -> f64 {
        if a.failure.is_some() || b.failure.is_some() {
            return f64::NAN;
        }
        difference(&a.values, &b.values, self.target.t.is_some())
    }

    /// Tells what has just been found out.
    pub(super) fn say(&self, text: &str) {
        if !self.quiet {
            self.progress.say(text);
        }
    }
}

/// What tells a run from the others.
fn name(settings: &Settings, timed: bool) -> String {
    let mesh = settings.mesh.map(|m| format!("mesh={m}"));
    let models = settings.models.map(words::models);
    let step = settings.stepping.map(words::step);
    let scheme = settings.scheme.map(words::scheme);
    let reference = (!timed).then(|| "reference".to_string());
    [reference, mesh, models, step, scheme].into_iter().flatten().collect::<Vec<_>>().join(",")
}

/// Histories as CSV, which has a word for what isn't a number.
mod csv {
    use super::{Path, Table};
    use serde::{Deserialize, Deserializer, Serializer, de::Error as _, ser::Error as _};

    pub(super) fn serialize<S: Serializer>(table: &Table, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&if table.columns.is_empty() {
            String::new()
        } else {
            table.to_csv().map_err(S::Error::custom)?
        })
    }
    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Table, D::Error> {
        let text = String::deserialize(from)?;
        if text.is_empty() {
            Ok(Table::default())
        } else {
            Table::from_csv(&text, Path::new("values")).map_err(D::Error::custom)
        }
    }
}

/// A number that may be infinite, which JSON can't write.
mod never {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(x: &f64, to: S) -> Result<S::Ok, S::Error> {
        x.is_finite().then_some(*x).serialize(to)
    }
    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        Ok(Option::deserialize(from)?.unwrap_or(f64::INFINITY))
    }
}
