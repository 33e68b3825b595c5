//! `ropewalk cost SCENE --of RECORD`

use super::{Exit, error, interrupted, progress, say, warn};
use crate::cli::SceneArgs;
use ropewalk_models::Bundled;
use ropewalk_report::Watch;
use ropewalk_scene::quantity;
pub use ropewalk_studies::Error;
use ropewalk_studies::cost::{CostOptions, cost as find};
use std::path::PathBuf;
use std::time::Duration;

/// Of what, and how much may be spent on it.
#[derive(Debug, clap::Args)]
pub(crate) struct CostArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The record, or one of its columns; with @TIME at that time only
    #[arg(long, value_name = "RECORD[@TIME]")]
    of: String,
    /// Wall time after which no more is tried, half of it for the reference
    #[arg(long, value_name = "TIME", default_value = "10 min", value_parser = time)]
    budget: Duration,
    /// Folder for the results: new, empty, or that of the same study [default: runs/SCENE-cost, numbered]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Delete what an earlier study left in the folder, and compute everything
    #[arg(long)]
    fresh: bool,
    /// Say nothing but errors and warnings
    #[arg(long, short)]
    quiet: bool,
}

/// A length of time, such as `60s` or `10 min`.
pub(super) fn time(text: &str) -> Result<Duration, String> {
    let wrong = || format!("expected a time such as `60s` or `10 min`, not `{text}`");
    let seconds = text.trim().parse().or_else(|_| quantity::kind::TIME.parse(text)).map_err(|_| wrong())?;
    match Duration::try_from_secs_f64(seconds) {
        Ok(time) if !time.is_zero() && seconds < 1e9 => Ok(time),
        _ => Err(wrong()),
    }
}

pub(crate) fn cost(args: CostArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    let options = CostOptions {
        of: args.of,
        set: args.scene.overrides,
        out: args.out,
        fresh: args.fresh,
        budget: args.budget,
        progress: progress(args.quiet),
        watch: Watch::signals(warn),
    };
    let outcome = find(&args.scene.scene, bundled, &options)?;
    if !args.quiet && !outcome.report.is_empty() {
        say(outcome.report.trim_end());
    }
    Ok(if outcome.interrupted {
        let folder = outcome.folder.display();
        interrupted(format!("what was computed is in {folder}, the same command goes on with it"))
    } else if outcome.uncertainty.is_nan() {
        error("no reference was found in the time given\n  = help: raise --budget, the same command goes on");
        Exit::Solver
    } else {
        Exit::Done
    })
}
