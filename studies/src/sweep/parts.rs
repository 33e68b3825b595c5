//! A sweep that several processes compute, on this machine or others that see the same folder: a plan, parts of it, and
//! what is left to be done. Whoever calls [`sweep`](super::sweep) in the end computes what is missing and writes the table.

use super::grid::Grid;
use super::{SweepOptions, axis::unquoted};
use crate::error::Error;
use crate::run::Status;
use crate::study::{Runner, StudyFolder, complete, lock};
use ropewalk_report::{Csv, RunFolder, Sheet, write_atomic};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::{Mutex, PoisonError};

/// So many runs for each run that goes on at the same time make it worth to start a process.
const RUNS_EACH: usize = 8;
/// Batch systems don't like more.
const MOST_PARTS: usize = 1000;

/// One of several equal parts of a sweep: `3/40`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    number: usize,
    of: usize,
}

impl FromStr for Part {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let whole = |text: &str| text.trim().parse::<usize>().ok();
        match text.split_once('/').map(|(number, of)| (whole(number), whole(of))) {
            Some((Some(number), Some(of))) if number > 0 && number <= of => Ok(Part { number, of }),
            Some((Some(number), Some(of))) if of > 0 => {
                Err(format!("there is no part {number} of {of}: they are numbered from 1"))
            }
            _ => Err("expected a part and their number, like `3/40`".into()),
        }
    }
}

impl std::fmt::Display for Part {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl Part {
    /// The runs of it: neighbours, which cost about the same, go to different parts.
    pub fn runs(self, all: usize) -> impl Iterator<Item = usize> {
        (self.number - 1..all).step_by(self.of)
    }
}

/// A sweep that has been planned.
pub struct Planned {
    /// The folder.
    pub folder: PathBuf,
    /// Number of runs.
    pub runs: usize,
    /// Those that aren't complete.
    pub missing: Vec<usize>,
    /// How many parts would do, and how many runs at a time are thought of for each.
    pub parts: (usize, usize),
}

/// How a share of the runs ended.
pub struct Shared {
    /// Whether something stopped it.
    pub interrupted: bool,
    /// Runs that failed or could not begin.
    pub failed: usize,
    /// Runs of this share, and those that are complete.
    pub runs: (usize, usize),
    /// Complete runs that were there already.
    pub earlier: usize,
    /// The folder.
    pub folder: PathBuf,
}

/// Checks a sweep and writes `sweep.json` and `plan.csv`, a row for each run: number, name, parameters.
///
/// # Errors
/// As [`sweep`](super::sweep).
pub fn plan(grid: &Grid, options: &SweepOptions) -> Result<Planned, Error> {
    let axes = grid.check()?;
    let (out, manifest) = (options.out.clone(), grid.manifest());
    let folder = match options.fresh {
        true => StudyFolder::open(out, true, &manifest)?,
        false => StudyFolder::join(out, &manifest)?,
    };
    let several = grid.scenes().len() > 1;
    let mut csv = Csv::new(
        ["number".to_string(), "run".into()]
            .into_iter()
            .chain(several.then(|| "scene".to_string()))
            .chain(axes.iter().map(|a| a.heading.clone())),
    );
    for k in 0..grid.len() {
        let (scene, values) = grid.choice(k);
        csv.cell((k + 1).to_string()).cell(grid.name(k));
        if several {
            csv.cell(grid.scenes()[scene]);
        }
        axes.iter().zip(values).for_each(|(a, i)| _ = csv.cell(unquoted(&a.cells[i])));
        csv.end();
    }
    write_atomic(&folder.path().join("plan.csv"), &csv.text())?;
    let missing: Vec<usize> = (0..grid.len()).filter(|k| !is_complete(grid, &folder, *k)).collect();
    let jobs = options.jobs.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
    let parts = missing.len().div_ceil(RUNS_EACH * jobs).clamp(1, MOST_PARTS);
    Ok(Planned { folder: folder.path().to_path_buf(), runs: grid.len(), missing, parts: (parts, jobs) })
}

impl Planned {
    /// The plan for people, with a batch job as an example. `command` is the sweep as it is called, with its folder.
    pub fn report(&self, command: &str) -> String {
        let (parts, jobs) = self.parts;
        let each = self.missing.len().div_ceil(parts);
        let mut sheet = Sheet::default();
        sheet.entry("folder", format!("{}: sweep.json, plan.csv", self.folder.display()));
        sheet.entry("runs", format!("{}, {} of them to be computed", self.runs, self.missing.len()));
        sheet.entry(
            "parts",
            format!("{parts} would do, of up to {each} runs each; any other number does as well"),
        );
        sheet.entry("one part", format!("{command} --part 1/{parts} --jobs {jobs}"));
        sheet.entry(
            "Slurm",
            format!("sbatch --array=1-{parts} --cpus-per-task={jobs} job.sh, where job.sh ends with"),
        );
        sheet.entry("", format!("{command} --part $SLURM_ARRAY_TASK_ID/{parts} --jobs {jobs}"));
        sheet.entry("in the end", command);
        sheet.entry("", "computes what is missing and writes the table");
        sheet.to_string()
    }
}

fn is_complete(grid: &Grid, folder: &StudyFolder, k: usize) -> bool {
    let run = RunFolder::earlier(folder.run(grid.name(k)));
    // most often there is nothing at all, which is seen without a scene
    run.summary_file().exists() && grid.file(k).is_ok_and(|file| complete(&run, &file).is_some())
}

/// Computes some of the runs, while other processes may be at the same folder: what is complete stays, and every run
/// comes into the folder whole. No table is written.
///
/// # Errors
/// As [`sweep`](super::sweep); what goes wrong with one run is none.
pub fn share(grid: &Grid, runs: &[usize], options: &SweepOptions) -> Result<Shared, Error> {
    let folder = StudyFolder::join(options.out.clone(), &grid.manifest())?;
    let runner = Runner::shared(runs.len(), options.progress, options.watch);
    let done = Mutex::new(Vec::new());
    runner.for_each(runs.len(), options.jobs, |i| {
        let k = runs[i];
        let name = grid.name(k);
        let ran = runner.run(grid.file(k).as_ref(), name, &RunFolder::earlier(folder.run(name)));
        lock(&done).push((ran.summary.status, ran.earlier));
        Ok(())
    })?;
    runner.progress.finish();
    let done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    let count = |of: &dyn Fn(&(Status, bool)) -> bool| done.iter().filter(|d| of(d)).count();
    Ok(Shared {
        interrupted: done.len() < runs.len() || count(&|d| d.0 == Status::Interrupted) > 0,
        failed: count(&|d| d.0.is_failure()),
        runs: (runs.len(), count(&|d| d.0.is_complete())),
        earlier: count(&|d| d.1),
        folder: Path::to_path_buf(folder.path()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_have_every_run_once() {
        for of in [1, 2, 3, 7, 12, 20] {
            let parts = (1..=of).map(|k| format!("{k}/{of}").parse::<Part>().unwrap());
            let mut all: Vec<usize> = parts.flat_map(|p| p.runs(12)).collect();
            all.sort_unstable();
            assert_eq!(all, (0..12).collect::<Vec<_>>());
        }
        for wrong in ["", "3", "0/4", "5/4", "1/0", "-1/4", "a/b", "1/2/3"] {
            assert!(wrong.parse::<Part>().is_err(), "{wrong}");
        }
    }
}
