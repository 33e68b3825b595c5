//! `ropewalk atlas ATLAS`

use super::{Exit, error, interrupted, progress, say, warn};
use ropewalk_models::{Bundled, atlases};
use ropewalk_report::Watch;
pub use ropewalk_studies::Error;
pub use ropewalk_studies::atlas::{AtlasFile, AtlasOptions, Laid, atlas as make};
use std::path::PathBuf;

/// An atlas, what of it, and where it goes.
#[derive(Debug, clap::Args)]
pub(crate) struct AtlasArgs {
    /// A bundled atlas (thesis), or a .toml or .json file
    #[arg(value_name = "ATLAS")]
    atlas: String,
    /// Only these entries, such as 4.43,table-4.11
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    only: Vec<String>,
    /// Show what there is, and compute nothing
    #[arg(long)]
    list: bool,
    /// Folder for the results: new, empty, or that of the same atlas [default: runs/ATLAS-atlas, numbered]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Coarser and shorter runs for a first look
    #[arg(long)]
    quick: bool,
    /// Lay the curves of a CSV file over a figure; may be given several times
    #[arg(long, value_name = "FIGURE=FILE")]
    overlay: Vec<Laid>,
    /// Delete what an earlier call left in the folder, and compute everything
    #[arg(long)]
    fresh: bool,
    /// Runs at the same time [default: as many as there are cores]
    #[arg(long, short, value_name = "N", value_parser = crate::cli::at_least_one)]
    jobs: Option<usize>,
    /// Say nothing but errors and warnings
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn atlas(args: AtlasArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    let file = AtlasFile::open(&args.atlas, atlases())?;
    if args.list {
        say(file.list().trim_end());
        return Ok(Exit::Done);
    }
    let options = AtlasOptions {
        only: args.only,
        out: args.out,
        fresh: args.fresh,
        quick: args.quick,
        jobs: args.jobs,
        overlay: args.overlay,
        progress: progress(args.quiet),
        watch: Watch::signals(warn),
    };
    let outcome = make(&file, &options, bundled)?;
    if !args.quiet {
        say(outcome.report.trim_end());
    }
    let (runs, complete) = outcome.runs;
    let again = if options.fresh { "without --fresh, the same command" } else { "the same command" };
    Ok(if outcome.interrupted {
        interrupted(format!("{complete} of {runs} runs are complete, {again} computes the others"))
    } else if outcome.failed > 0 || outcome.broken > 0 {
        let (failed, broken) = (outcome.failed, outcome.broken);
        error(format!(
            "{failed} of {runs} runs failed, and {broken} entries could not be made of their results"
        ));
        Exit::Solver
    } else {
        Exit::Done
    })
}
