//! `ropewalk modes SCENE`

use super::{Exit, progress, say, warn};
use crate::cli::SceneArgs;
use ropewalk_core::modes::ModesError;
use ropewalk_models::Bundled;
use ropewalk_report::Watch;
use ropewalk_scene::{SceneFile, quantity};
pub use ropewalk_studies::Error;
use ropewalk_studies::modes::{ModesOptions, write_modes};
use std::path::PathBuf;

/// Which modes, of what, and where they go.
#[derive(Debug, clap::Args)]
pub(crate) struct ModesArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// How many modes, from the lowest on
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    count: u32,
    /// Time at which loads and motions are taken [default: 0, in statics the end of the load path]
    #[arg(long, value_name = "TIME", value_parser = time)]
    at: Option<f64>,
    /// Folder for the results, new or empty [default: runs/SCENE-modes, numbered]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Say nothing but errors and warnings
    #[arg(long, short)]
    quiet: bool,
}

fn time(text: &str) -> Result<f64, String> {
    text.trim().parse().or_else(|_| quantity::kind::TIME.parse(text))
}

pub(crate) fn modes(args: &ModesArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    let file = SceneFile::open(&args.scene.scene, &args.scene.overrides, bundled)?;
    let options = ModesOptions {
        count: args.count as usize,
        time: args.at,
        out: args.out.clone(),
        progress: progress(args.quiet),
        watch: Watch::signals(warn),
    };
    let done = write_modes(&file, &options, &mut warn);
    if let Err(Error::Modes(ModesError::Interrupted)) = done {
        return Ok(Exit::Interrupted);
    }
    let outcome = done?;
    if !args.quiet {
        say(outcome.report.trim_end());
    }
    Ok(Exit::Done)
}
