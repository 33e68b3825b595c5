//! Runs of a scene with several settings: each is computed once, in memory, and kept in a file of its own if the study
//! has a folder, so that the same study goes on where it was stopped.

use super::axes::{Axes, Settings, words};
use super::folder::StudyFolder;
use super::runner::lock;
use super::target::{Target, When, difference};
use crate::error::{Error, caught};
use crate::run::{Counts, Ending};
use crate::simulate::{How, compute};
use ropewalk_core::V3;
use ropewalk_report::{OutputError, Stopwatch, SweepProgress, Table, Watch, plain, write_json};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Runs shorter than this are timed several times [s] …
const SHORT: f64 = 0.1;
/// … and this often.
const REPEATS: usize = 3;

/// A run and what came of it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Run {
    pub settings: Settings,
    /// Whether it had the machine to itself.
    pub timed: bool,
    /// CPU time of building and running [s]; infinite if it was not measured.
    #[serde(with = "never")]
    pub cpu_s: f64,
    pub counts: Counts,
    /// Why there is no result, if so.
    pub failure: Option<String>,
    /// Time and what is looked at, as far as it was computed.
    #[serde(with = "csv")]
    pub values: Table,
    /// Positions of all nodes at some rows, of runs that are kept in memory only …
    #[serde(skip)]
    pub positions: Vec<Vec<V3<f64>>>,
    /// … and the length that they are measured by [m].
    #[serde(skip)]
    pub length: f64,
}

/// All runs of a study, and how new ones are made.
pub struct Runs<'a> {
    /// What is varied in the scene.
    pub axes: &'a Axes<'a>,
    /// Where all runs end, if before the end of the scene [s].
    pub until: Option<f64>,
    /// What shows how far they are.
    pub progress: SweepProgress,
    /// Where runs are kept, and what of them.
    kept: Option<(&'a StudyFolder, &'a Target)>,
    known: Mutex<HashMap<String, Arc<Run>>>,
    /// CPU time of this call [s].
    spent: Mutex<f64>,
}

impl<'a> Runs<'a> {
    /// Runs that are kept in memory, with all their records and with positions.
    pub fn in_memory(axes: &'a Axes<'a>, until: Option<f64>, progress: SweepProgress) -> Self {
        Runs { axes, until, progress, kept: None, known: Mutex::default(), spent: Mutex::default() }
    }

    /// Runs of which a target is kept in a folder, and those that an earlier call left there.
    pub(crate) fn in_folder(
        axes: &'a Axes<'a>,
        target: &'a Target,
        folder: &'a StudyFolder,
        progress: SweepProgress,
    ) -> Self {
        let runs = Runs { kept: Some((folder, target)), ..Runs::in_memory(axes, target.t, progress) };
        let files = fs::read_dir(folder.run("")).into_iter().flatten().flatten();
        // a file that can't be read is one that has to be computed again
        let run = |path: &Path| serde_json::from_str::<Run>(&fs::read_to_string(path).ok()?).ok();
        let known = files.filter_map(|f| run(&f.path()));
        *lock(&runs.known) = known.map(|r| (runs.name(&r.settings, r.timed), Arc::new(r))).collect();
        runs
    }

    /// Number of runs that are there.
    pub fn len(&self) -> usize {
        lock(&self.known).len()
    }
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// CPU time that this call has spent [s].
    pub fn spent(&self) -> f64 {
        *lock(&self.spent)
    }
    /// All runs that were timed.
    pub(crate) fn timed(&self) -> Vec<Arc<Run>> {
        lock(&self.known).values().filter(|r| r.timed).cloned().collect()
    }

    /// The run with these settings, with the machine to itself, and given up as soon as it has taken longer than `worth`;
    /// none if there was no time left for it.
    pub(crate) fn timed_for(
        &self,
        settings: &Settings,
        worth: Duration,
        watch: Watch,
    ) -> Result<Option<Arc<Run>>, Error> {
        self.known_or_new(settings, Some(worth), watch)
    }

    /// The run with these settings, beside others; none if it was stopped before its end.
    pub(crate) fn get(&self, settings: &Settings, watch: Watch) -> Result<Option<Arc<Run>>, Error> {
        self.known_or_new(settings, None, watch)
    }

    fn known_or_new(
        &self,
        settings: &Settings,
        worth: Option<Duration>,
        watch: Watch,
    ) -> Result<Option<Arc<Run>>, Error> {
        let name = self.name(settings, worth.is_some());
        if let Some(run) = lock(&self.known).get(&name) {
            return Ok(Some(run.clone()));
        }
        if watch.is_over() {
            return Ok(None);
        }
        self.progress.plan(1);
        let run = self.compute(settings, worth, watch);
        self.progress.done(false);
        let Some(run) = run else { return Ok(None) };
        if let Some((folder, _)) = self.kept {
            let path = folder.run(&format!("{}.json", plain(&name)));
            fs::create_dir_all(folder.run("")).map_err(OutputError::io("create folder", &path))?;
            write_json(&path, &run)?;
        }
        let run = Arc::new(run);
        lock(&self.known).insert(name, run.clone());
        Ok(Some(run))
    }

    /// Computes a run, a short one that is timed several times; none if it was stopped.
    fn compute(&self, settings: &Settings, worth: Option<Duration>, watch: Watch) -> Option<Run> {
        let timed = worth.is_some();
        let limited = watch.until(worth.and_then(|w| Instant::now().checked_add(w)));
        let mut run = Run {
            settings: *settings,
            timed,
            cpu_s: f64::INFINITY,
            counts: Counts::default(),
            failure: None,
            values: Table::default(),
            positions: Vec::new(),
            length: f64::NAN,
        };
        let file = match self.axes.with(settings, self.until) {
            Ok(file) => file,
            Err(fault) => return Some(Run { failure: Some(fault.message), ..run }),
        };
        let words = self.axes.words(settings);
        for _ in 0..if timed { REPEATS } else { 1 } {
            let how = How {
                watch: limited,
                progress: Some(self.progress.begin(&words, file.scene().run.duration)),
                positions: self.kept.is_none(),
                ..How::default()
            };
            let stopwatch = Stopwatch::start();
            let done = caught(|| compute(file.scene(), how));
            let cpu_s = stopwatch.elapsed().cpu_s;
            *lock(&self.spent) += if cpu_s.is_finite() { cpu_s } else { 0.0 };
            run.cpu_s = run.cpu_s.min(cpu_s);
            let done = match done {
                Ok(done) => done,
                Err(e) => return Some(Run { failure: Some(e.brief()), ..run }),
            };
            (run.counts, run.positions, run.length) = (done.counts, done.positions, done.length);
            match done.ending {
                Ending::Interrupted if watch.is_over() => return None,
                Ending::Interrupted => {
                    run.failure = Some("given up: others are as accurate in far less time".into());
                    (run.cpu_s, run.values) = (cpu_s, Table::default());
                    break;
                }
                Ending::Failed(e) => run.failure = Some(e.to_string()),
                Ending::Finished | Ending::Stopped(_) => {}
            }
            run.values = match self.kept {
                Some((_, target)) => target.of(&done.table),
                None => done.table,
            };
            if run.failure.is_some() || run.cpu_s > SHORT {
                break;
            }
        }
        Some(run)
    }

    /// What tells a run from the others.
    fn name(&self, settings: &Settings, timed: bool) -> String {
        let mesh = settings.mesh.map(|m| format!("mesh={m}"));
        let models = settings.models.map(words::models);
        let step = settings.stepping.map(words::step);
        let scheme = settings.scheme.map(words::scheme);
        let newton = settings.newton.filter(|_| settings.newton != self.axes.base.newton);
        let newton = newton.map(|n| format!("newton={n:e}"));
        let reference = (!timed).then(|| "reference".to_string());
        let all = [reference, mesh, models, step, scheme, newton];
        all.into_iter().flatten().collect::<Vec<_>>().join(",")
    }
}

impl Run {
    /// How far this and another run differ in what is looked at; NaN if one of them failed.
    pub(crate) fn difference(&self, other: &Run, target: &Target) -> f64 {
        if self.failure.is_some() || other.failure.is_some() {
            return f64::NAN;
        }
        let when = if target.t.is_some() { When::End } else { When::Whole };
        difference(&target.of(&self.values), &target.of(&other.values), when)
    }
}

/// Histories as CSV, which has a word for what isn't a number.
mod csv {
    use ropewalk_report::Table;
    use serde::{Deserialize, Deserializer, Serializer, de::Error as _, ser::Error as _};
    use std::path::Path;

    pub(super) fn serialize<S: Serializer>(table: &Table, to: S) -> Result<S::Ok, S::Error> {
        let text = match table.columns.is_empty() {
            true => String::new(),
            false => table.to_csv().map_err(S::Error::custom)?,
        };
        to.serialize_str(&text)
    }
    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Table, D::Error> {
        match String::deserialize(from)?.as_str() {
            "" => Ok(Table::default()),
            text => Table::from_csv(text, Path::new("values")).map_err(D::Error::custom),
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
