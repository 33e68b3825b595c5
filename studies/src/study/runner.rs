//! The runs of a study, on all cores, each into a folder of its own: what an earlier call has computed is not computed
//! again.

use super::share::{beside, publish};
use crate::error::{Error, caught};
use crate::run::{Leaves, RunOptions, Status, Summary, run_showing};
use rayon::iter::{ParallelBridge, ParallelIterator};
use ropewalk_report::{ProgressMode, RunFolder, SweepProgress, Table, Watch};
use ropewalk_scene::{Fault, SceneFile};
use std::collections::HashSet;
use std::fs;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Stack of a thread that runs scenes: as large as that of the main thread usually is.
const STACK: usize = 8 << 20;

/// What several threads write to; one that panicked has left it whole.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does this on a pool of so many threads, or of as many as there are cores.
fn on_threads<T: Send>(threads: Option<usize>, work: impl FnOnce() -> T + Send) -> Result<T, Fault> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).stack_size(STACK).build();
    Ok(pool.map_err(|e| Fault::new(format!("no threads to compute on: {e}")))?.install(work))
}

/// Does this on a pool of as many threads as there are cores.
///
/// # Errors
/// The system gives no threads.
pub(crate) fn on_all_cores<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, Fault> {
    on_threads(None, work)
}

/// What all threads of a study share.
pub(crate) struct Runner {
    /// Where the progress is shown and what goes wrong is said.
    pub progress: SweepProgress,
    watch: Watch,
    /// Whether other processes may compute the same runs.
    shared: bool,
    /// Warnings that have been said: most of them hold for all runs.
    said: Mutex<HashSet<String>>,
}

/// What a run came to, now or in an earlier call.
pub(crate) struct Ran {
    /// How it ended.
    pub summary: Summary,
    /// Its records, as far as they were computed.
    pub history: Table,
    /// Whether an earlier call computed it.
    pub earlier: bool,
}

impl Ran {
    /// A run that could not begin.
    pub(crate) fn refused(message: String) -> Self {
        let summary = Summary { status: Status::Refused, message: Some(message), ..Summary::default() };
        Ran { summary, history: Table::default(), earlier: false }
    }
}

impl Runner {
    /// Begins to show the progress of so many runs.
    pub(crate) fn new(runs: usize, mode: ProgressMode, watch: Watch) -> Self {
        let progress = SweepProgress::new(runs, mode);
        Runner { progress, watch, shared: false, said: Mutex::default() }
    }

    /// The same for one of several processes that compute runs into the same folders.
    pub(crate) fn shared(runs: usize, mode: ProgressMode, watch: Watch) -> Self {
        Runner { shared: true, ..Runner::new(runs, mode, watch) }
    }

    /// Does this for every run, `jobs` at a time or as many as there are cores.
    ///
    /// # Errors
    /// The first error of one of them, or no threads.
    pub(crate) fn for_each(
        &self,
        runs: usize,
        jobs: Option<usize>,
        work: impl Fn(usize) -> Result<(), Error> + Sync,
    ) -> Result<(), Error> {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        let threads = jobs.unwrap_or_else(cores).min(runs).max(1);
        let one = |k| if self.watch.is_interrupted() { Ok(()) } else { work(k) };
        on_threads(Some(threads), || (0..runs).par_bridge().try_for_each(one))
            .map_err(|fault| fault.with_help("try fewer `--jobs`"))?
    }

    /// What is in the folder, if it is a complete run of this very scene; else runs it. A run that fails is told.
    pub(crate) fn run(&self, scene: Result<&SceneFile, &Fault>, name: &str, folder: &RunFolder) -> Ran {
        let ran = match scene {
            Err(fault) => Ran::refused(fault.message.clone()),
            Ok(file) => complete(folder, file).unwrap_or_else(|| self.compute(file, name, folder)),
        };
        if ran.summary.status.is_failure() {
            let message = ran.summary.message.as_deref().unwrap_or("failed");
            let place = match folder.history_file().exists() {
                true => format!("\n  = note: the results until then are in {}", folder.path().display()),
                false => String::new(),
            };
            self.progress.say(&format!("error: {name}: {message}{place}"));
        }
        self.progress.done(ran.earlier);
        ran
    }

    /// Runs a scene into its folder; what a failed or interrupted run left there is deleted before, or if other processes
    /// may be at the same run, replaced when this one is done.
    fn compute(&self, file: &SceneFile, name: &str, folder: &RunFolder) -> Ran {
        if !self.shared {
            return match fs::remove_dir_all(folder.path()) {
                Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
                    Ran::refused(format!("can't delete {}: {e}", folder.path().display()))
                }
                _ => self.compute_in(file, name, folder.path()),
            };
        }
        let own = beside(folder.path());
        let ran = self.compute_in(file, name, &own);
        if !own.exists() {
            return ran;
        }
        match publish(&own, folder.path(), |path| complete(&RunFolder::earlier(path.into()), file)) {
            Ok(earlier) => earlier.unwrap_or(ran),
            Err(e) => Ran::refused(format!("can't write {}: {e}", folder.path().display())),
        }
    }

    /// Runs a scene into a new folder.
    fn compute_in(&self, file: &SceneFile, name: &str, path: &Path) -> Ran {
        let options = RunOptions {
            out: Some(path.to_path_buf()),
            progress: ProgressMode::Quiet,
            watch: self.watch,
            // many runs are looked at together, by what the study makes of them
            leaves: Leaves { report: false, ..Leaves::default() },
            inputs_stay: true,
            ..RunOptions::default()
        };
        let progress = |t_end: f64| self.progress.begin(name, t_end);
        let mut warn = |text: &str| {
            if lock(&self.said).insert(text.to_string()) {
                self.progress.say(&format!("warning: {name}: {text}"));
            }
        };
        // a defect that shows in one run must not take the others with it
        match caught(|| run_showing(file, &options, &progress, &mut warn)) {
            Ok(outcome) => Ran { summary: outcome.summary, history: outcome.history, earlier: false },
            Err(e) => Ran::refused(e.brief()),
        }
    }
}

/// What is in the folder of a run that is complete, and that is of this very scene and version.
pub(crate) fn complete(folder: &RunFolder, file: &SceneFile) -> Option<Ran> {
    let manifest: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.manifest_file()).ok()?).ok()?;
    let same = manifest["ropewalk"] == env!("CARGO_PKG_VERSION")
        && fs::read_to_string(folder.scene_file()).ok()? == file.document().to_toml();
    if !same {
        return None;
    }
    let summary: Summary = folder.read_summary().ok()?;
    let history = Table::read(&folder.history_file()).ok()?;
    // a history that was cut off or touched doesn't end as the summary says
    let ended = history.columns.iter().all(|c| {
        match (c.values.last(), summary.final_values.get(&c.name).map(serde_json::Value::as_f64)) {
            // the last digit may be lost in reading JSON
            (Some(x), Some(Some(y))) => (x - y).abs() <= 1e-12 * x.abs(),
            (Some(x), Some(None)) => !x.is_finite(),
            _ => false,
        }
    });
    let whole = history.rows() == summary.rows && ended;
    (summary.status.is_complete() && whole).then_some(Ran { summary, history, earlier: true })
}
