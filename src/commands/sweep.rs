//! `ropewalk sweep SCENE --vary NAME=VALUES`

use super::shell::in_shell;
use super::{Exit, error, interrupted, progress, say, warn};
use crate::cli::SweepArgs;
use ropewalk_models::Bundled;
use ropewalk_report::Watch;
use ropewalk_scene::{Fault, Sampling};
pub use ropewalk_studies::Error;
pub use ropewalk_studies::sweep::{Grid, SweepOptions, sweep as sweep_grid};
use ropewalk_studies::sweep::{Part, plan, share};
use std::path::{Path, absolute};

impl SweepArgs {
    /// The runs.
    pub(crate) fn grid(&self, bundled: &[Bundled]) -> Result<Grid, Fault> {
        let sampling = self.samples.map(|count| Sampling { count, seed: self.seed, latin: self.latin });
        Grid::new(&self.scenes, &self.overrides, &self.vary, sampling, bundled)
    }

    /// How they are to be computed.
    pub(crate) fn options(&self, watch: Watch) -> SweepOptions {
        SweepOptions {
            out: self.out.clone(),
            fresh: self.fresh,
            jobs: self.jobs,
            progress: progress(self.quiet),
            watch,
            report: self.report,
            over: self.over,
            extremes: self.extremes,
        }
    }

    /// The arguments that make the same sweep in this folder, wherever they are used.
    pub(crate) fn words(&self, folder: &Path) -> Vec<String> {
        let place = |path: &Path| absolute(path).unwrap_or_else(|_| path.into()).display().to_string();
        // a bundled scene is no file
        let is_file =
            |s: &&String| Path::new(s).components().count() > 1 || Path::new(s).extension().is_some();
        let scene = |s: &String| Some(s).filter(is_file).map_or_else(|| s.clone(), |s| place(Path::new(s)));
        let mut words: Vec<String> =
            std::iter::once("sweep".into()).chain(self.scenes.iter().map(scene)).collect();
        let mut option = |name: &str, value: String| words.extend([name.to_string(), value]);
        self.vary.iter().for_each(|v| option("--vary", v.clone()));
        self.overrides.iter().for_each(|v| option("--set", v.clone()));
        if let Some(samples) = self.samples {
            option("--samples", samples.to_string());
            option("--seed", self.seed.to_string());
        }
        option("--out", place(folder));
        words.extend(self.latin.then(|| "--latin".to_string()));
        words.extend(self.extremes.then(|| "--extremes".to_string()));
        words
    }
}

pub(crate) fn sweep(args: &SweepArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    if let Some(address) = &args.dask {
        let fault = Fault::new(format!("the cluster at {address} can only be asked by Python"));
        let help = "install the Python package of Ropewalk and `distributed`; the command `ropewalk` that comes with it, or \
                    `python -m ropewalk`, does what this one does, and `--dask`";
        return Err(fault.with_help(help).into());
    }
    let grid = args.grid(bundled)?;
    let options = args.options(Watch::signals(warn));
    match args.part {
        _ if args.plan => {
            let planned = plan(&grid, &options)?;
            if !args.quiet {
                let words = args.words(&planned.folder);
                let command = words.iter().map(|w| in_shell(w)).collect::<Vec<_>>().join(" ");
                say(planned.report(&format!("ropewalk {command}")).trim_end());
            }
            Ok(Exit::Done)
        }
        Some(part) => shared(&grid, part, &options, args.quiet),
        None => whole(args, &grid, &options),
    }
}

/// One part of the runs, for batch systems.
fn shared(grid: &Grid, part: Part, options: &SweepOptions, quiet: bool) -> Result<Exit, Error> {
    let done = share(grid, &part.runs(grid.len()).collect::<Vec<_>>(), options)?;
    let ((runs, complete), folder) = (done.runs, done.folder.display());
    if !quiet {
        let earlier =
            if done.earlier > 0 { format!(", {} from before", done.earlier) } else { String::new() };
        say(format!("part {part}: {complete} of {runs} runs are complete{earlier}, in {folder}"));
    }
    Ok(if done.interrupted {
        interrupted(format!(
            "{complete} of {runs} runs of this part are complete, the same command computes the others"
        ))
    } else if done.failed > 0 {
        error(format!(
            "{} of {runs} runs of part {part} failed\n  = note: the others are in {folder}",
            done.failed
        ));
        Exit::Solver
    } else {
        Exit::Done
    })
}

/// All that is missing, and the table.
fn whole(args: &SweepArgs, grid: &Grid, options: &SweepOptions) -> Result<Exit, Error> {
    let outcome = sweep_grid(grid, options)?;
    if !args.quiet {
        say(outcome.report.trim_end());
    }
    let (runs, complete) = outcome.runs;
    let again = if args.fresh { "without --fresh, the same command" } else { "the same command" };
    Ok(if outcome.interrupted {
        interrupted(format!("{complete} of {runs} runs are complete, {again} computes the others"))
    } else if outcome.failed > 0 {
        let folder = outcome.folder.display();
        error(format!(
            "{} of {runs} runs failed\n  = note: the table in {folder} says why; {again} tries them again",
            outcome.failed
        ));
        Exit::Solver
    } else {
        Exit::Done
    })
}
