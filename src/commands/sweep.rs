//! `ropewalk sweep SCENE --vary NAME=VALUES`

use super::{Exit, error, interrupted, progress, say, warn};
use crate::cli::SweepArgs;
use ropewalk_models::Bundled;
use ropewalk_report::Watch;
pub use ropewalk_studies::Error;
pub use ropewalk_studies::sweep::{Grid, SweepOptions, sweep as sweep_grid};

pub(crate) fn sweep(args: SweepArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    let grid = Grid::new(&args.scenes, &args.overrides, &args.vary, bundled)?;
    let options = SweepOptions {
        out: args.out,
        fresh: args.fresh,
        jobs: args.jobs,
        progress: progress(args.quiet),
        watch: Watch::signals(warn),
        report: args.report,
        over: args.over,
    };
    let outcome = sweep_grid(&grid, &options)?;
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
