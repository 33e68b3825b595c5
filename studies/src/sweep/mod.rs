//! A sweep: scenes run with all combinations of some parameters, on all cores, each run into a folder of its own.
//!
//! The folders of the runs are what counts: the table and the pictures are made from them, and a sweep that is called
//! again computes only what is missing there. Several processes may share the runs ([`plan`], [`share`]).

mod axis;
mod extremes;
mod finals;
mod grid;
mod manifest;
mod page;
mod parts;
mod pictures;
mod report;
mod results;
mod tail;

pub(crate) use axis::Axis;
pub use grid::Grid;
pub use parts::{Part, Planned, Shared, plan, share};
pub use tail::{Over, Report};

use crate::error::Error;
use crate::run::Status;
use crate::study::{Runner, StudyFolder, lock};
use results::{Results, Row};
use ropewalk_report::{ProgressMode, RunFolder, Sheet, Stopwatch, Watch};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// Options of [`sweep`].
#[derive(Clone, Debug)]
pub struct SweepOptions {
    /// The folder: new, empty, or that of the same sweep. Without it `runs/<scene>-sweep`, numbered.
    pub out: Option<PathBuf>,
    /// Whether to delete what an earlier sweep left in the folder.
    pub fresh: bool,
    /// Runs at the same time; without it as many as there are cores.
    pub jobs: Option<usize>,
    /// How to show the progress.
    pub progress: ProgressMode,
    /// What may stop it; by default nothing, and the process keeps its signals.
    pub watch: Watch,
    /// Which value of a column stands for a run …
    pub report: Report,
    /// … and over which last part of it.
    pub over: Over,
    /// Whether to tell of extremes over the first parameter, a seed.
    pub extremes: bool,
}

/// How a sweep ended.
pub struct SweepOutcome {
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
pub fn sweep(grid: &Grid, options: &SweepOptions) -> Result<SweepOutcome, Error> {
    let axes = grid.check()?;
    let folder = StudyFolder::open(options.out.clone(), options.fresh, &grid.manifest())?;
    let stopwatch = Stopwatch::start();
    let runner = Runner::new(grid.len(), options.progress, options.watch);
    let results = Mutex::new(Results::new(&axes, grid, folder.table_file()));
    runner.for_each(grid.len(), options.jobs, |k| {
        let name = grid.name(k);
        let ran = runner.run(grid.file(k).as_ref(), name, &RunFolder::earlier(folder.run(name)));
        let mut results = lock(&results);
        results.set(k, Row::new(&ran.summary, &ran.history, options.over, ran.earlier));
        Ok(results.save_now_and_then()?)
    })?;
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    let progress = runner.progress;
    results.save()?;
    let mut warn = |text: &str| progress.say(&format!("warning: {text}"));
    let pictures = pictures::draw(&folder, grid, &axes, &results, options.report, &mut warn);
    let tables = finals::write(&folder, grid, &axes, &results, options.report, &mut warn);
    let extremes = match options.extremes {
        true => extremes::write(&folder, grid, &results, &mut warn),
        false => Vec::new(),
    };
    let names: Vec<String> = (0..grid.len()).map(|k| grid.name(k).to_string()).collect();
    page::write(&folder, &results, &names, (options.report, options.over))
        .unwrap_or_else(|e| progress.say(&format!("warning: {e}")));
    progress.finish();

    let interrupted = results.count(Status::Interrupted) > 0 || results.len() < grid.len();
    let count = |of: fn(Status) -> bool| results.rows().filter(|(_, row)| of(row.status)).count();
    let (failed, complete) = (count(Status::is_failure), count(Status::is_complete));
    let (wall_s, reported) = (stopwatch.elapsed().wall_s, (options.report, options.over));
    let mut report = report::report(&results, &folder, wall_s, grid.len(), reported, [tables, pictures]);
    let mut more = Sheet::default();
    more.entries("extremes", extremes);
    report += &more.to_string();
    let runs = (grid.len(), complete);
    Ok(SweepOutcome { interrupted, failed, runs, folder: folder.path().to_path_buf(), report })
}
