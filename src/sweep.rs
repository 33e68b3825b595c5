//! A sweep: scenes run with all combinations of some parameters, on all cores, each run into a folder of its own.
//!
//! The folders of the runs are what counts: the table and the pictures are made from them, and a sweep that is called
//! again computes only what is missing there.

mod axis;
mod finals;
mod grid;
mod manifest;
mod pictures;
mod report;
mod results;
mod tail;

pub(crate) use grid::Grid;
pub(crate) use tail::{Over, Report};

use crate::error::Error;
use crate::output::{Interrupt, ProgressMode, RunFolder, Stopwatch, Summary, SweepProgress, Table};
use crate::read::SceneFile;
use crate::run::{RunOptions, run_showing};
use crate::scene::Fault;
use crate::study::StudyFolder;
use rayon::iter::{ParallelBridge, ParallelIterator};
use results::{Results, Row};
use std::collections::HashSet;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// Stack of a thread that runs scenes: as large as that of the main thread usually is.
const STACK: usize = 8 << 20;

/// What may be chosen about a sweep beside its grid.
pub(crate) struct SweepOptions {
    /// The folder: new, empty, or that of the same sweep. Without it `runs/<scene>-sweep`, numbered.
    pub out: Option<PathBuf>,
    /// Whether to delete what an earlier sweep left in the folder.
    pub fresh: bool,
    /// Runs at the same time; without it as many as there are cores.
    pub jobs: Option<usize>,
    /// How to show the progress.
    pub progress: ProgressMode,
    /// Which value of a column stands for a run …
    pub report: Report,
    /// … and over which last part of it.
    pub over: Over,
}

/// How a sweep ended.
pub(crate) struct SweepOutcome {
    /// Whether Ctrl-C ended it.
    pub interrupted: bool,
    /// Runs that failed or could not begin.
    pub failed: usize,
    /// All runs there should be, and those that are complete.
    pub runs: (usize, usize),
    /// The folder.
    pub folder: PathBuf,
    /// The table and a summary for people, several lines.
    pub report: String,
}

/// Runs a grid. What one should know while it goes on is said on standard error, and so is every run that fails.
///
/// # Errors
/// The sweep could not even begin: a value is wrong, or the folder can't be used. What goes wrong with one run only
/// is no error.
pub(crate) fn sweep(grid: &Grid, options: &SweepOptions) -> Result<SweepOutcome, Error> {
    let axes = grid.check()?;
    let folder = StudyFolder::open(options.out.clone(), options.fresh, &grid.manifest())?;
    let stopwatch = Stopwatch::start();
    let mut sweep = Sweep {
        grid,
        over: options.over,
        folder: &folder,
        progress: SweepProgress::new(grid.len(), options.progress),
        interrupt: None,
        said: Mutex::default(),
        results: Mutex::new(Results::new(&axes, grid, folder.table_file())),
    };
    match Interrupt::install() {
        Ok(interrupt) => sweep.interrupt = Some(interrupt),
        Err(e) => sweep.progress.say(&format!("warning: {e}")),
    }
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.jobs.unwrap_or_else(cores).min(grid.len()))
        .stack_size(STACK)
        .build()
        .map_err(|e| Fault::new(format!("no threads to compute on: {e}")).with_help("try fewer `--jobs`"))?;
    pool.install(|| (0..grid.len()).par_bridge().try_for_each(|k| sweep.case(k)))?;
    let (mut results, progress) = sweep.end();
    results.save()?;
    let mut warn = |text: &str| progress.say(&format!("warning: {text}"));
    let pictures = pictures::draw(&folder, grid, &axes, &results, options.report, &mut warn);
    let tables = finals::write(&folder, grid, &axes, &results, options.report, &mut warn);
    progress.finish();

    let interrupted = results.count("interrupted") > 0 || results.len() < grid.len();
    let failed = results.count("failed") + results.count("refused");
    let complete = results.rows().filter(|(_, row)| row.is_complete()).count();
    let (wall_s, reported) = (stopwatch.elapsed().wall_s, (options.report, options.over));
    let report = report::report(&results, &folder, wall_s, grid.len(), reported, [tables, pictures]);
    let runs = (grid.len(), complete);
    Ok(SweepOutcome { interrupted, failed, runs, folder: folder.path().to_path_buf(), report })
}

/// What all threads share.
struct Sweep<'a> {
    grid: &'a Grid,
    over: Over,
    folder: &'a StudyFolder,
    progress: SweepProgress,
    interrupt: Option<Interrupt>,
    /// Warnings that have been said: most of them hold for all runs.
    said: Mutex<HashSet<String>>,
    results: Mutex<Results>,
}

impl Sweep<'_> {
    /// One combination, unless Ctrl-C was pressed.
    fn case(&self, k: usize) -> Result<(), Error> {
        if self.interrupt.is_some_and(Interrupt::requested) {
            return Ok(());
        }
        let name = self.grid.name(k);
        let folder = RunFolder::earlier(self.folder.run(name));
        let row = match self.grid.file(k) {
            Err(fault) => Row::refused(fault.message),
            Ok(file) => match complete(&folder, &file) {
                Some((summary, history)) => Row::new(&summary, &history, self.over, true),
                None => self.compute(&file, name, &folder),
            },
        };
        if let Some(message) = row.complaint() {
            let place = match folder.history_file().exists() {
                true => format!("\n  = note: the results until then are in {}", folder.path().display()),
                false => String::new(),
            };
            self.progress.say(&format!("error: {name}: {message}{place}"));
        }
        self.progress.done(row.earlier);
        let mut results = self.results.lock().unwrap_or_else(PoisonError::into_inner);
        results.set(k, row);
        Ok(results.save_now_and_then()?)
    }

    /// Runs a scene into its folder; what a failed or interrupted run left there is deleted before.
    fn compute(&self, file: &SceneFile, name: &str, folder: &RunFolder) -> Row {
        if let Err(e) = fs::remove_dir_all(folder.path())
            && e.kind() != std::io::ErrorKind::NotFound
        {
            return Row::refused(format!("can't delete {}: {e}", folder.path().display()));
        }
        let options = RunOptions {
            out: Some(folder.path().to_path_buf()),
            profile: false,
            progress: ProgressMode::Quiet,
            checkpoint: None,
        };
        let progress = |t_end: f64| self.progress.begin(name, t_end);
        let mut warn = |text: &str| {
            if self.said.lock().unwrap_or_else(PoisonError::into_inner).insert(text.to_string()) {
                self.progress.say(&format!("warning: {name}: {text}"));
            }
        };
        // a defect that shows in one run must not take the others with it
        match catch_unwind(AssertUnwindSafe(|| run_showing(file, &options, &progress, &mut warn))) {
            Ok(Ok(outcome)) => Row::new(&outcome.summary, &outcome.history, self.over, false),
            Ok(Err(Error::File(fault))) => Row::refused(fault.message),
            Ok(Err(e)) => Row::refused(e.to_string()),
            Err(_) => Row::refused("an internal error, see above: please report it".into()),
        }
    }

    fn end(self) -> (Results, SweepProgress) {
        (self.results.into_inner().unwrap_or_else(PoisonError::into_inner), self.progress)
    }
}

/// What is in the folder of a run that is complete, and that is of this very scene and version.
fn complete(folder: &RunFolder, file: &SceneFile) -> Option<(Summary, Table)> {
    let manifest: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.manifest_file()).ok()?).ok()?;
    let same = manifest["ropewalk"] == env!("CARGO_PKG_VERSION")
        && fs::read_to_string(folder.scene_file()).ok()? == file.document().to_toml();
    if !same {
        return None;
    }
    let summary = folder.read_summary().ok()?;
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
    (matches!(summary.status.as_str(), "finished" | "stopped") && whole).then_some((summary, history))
}
