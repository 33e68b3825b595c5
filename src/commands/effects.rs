//! `ropewalk effects SCENE --of RECORD`

use super::{Exit, progress, say, warn};
use crate::cli::SceneArgs;
use ropewalk_models::Bundled;
use ropewalk_report::Watch;
use ropewalk_scene::SceneFile;
pub use ropewalk_studies::Error;
use ropewalk_studies::effects::{EffectsOptions, write_effects};
use std::path::PathBuf;

/// Effects of what, judged by what, and where the results go.
#[derive(Debug, clap::Args)]
pub(crate) struct EffectsArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The record by which effects are judged, or one of its columns; with @TIME at that time
    #[arg(long, value_name = "RECORD[@TIME]")]
    of: String,
    /// Change of the record that doesn't matter, relative to its largest size in the run
    #[arg(long, value_name = "SHARE", default_value_t = 1e-2)]
    accuracy: f64,
    /// Folder for the results, new or empty [default: runs/SCENE-effects, numbered]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Say nothing but errors and warnings
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn effects(args: &EffectsArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    let file = SceneFile::open(&args.scene.scene, &args.scene.overrides, bundled)?;
    let progress = progress(args.quiet);
    let (accuracy, out, watch) = (args.accuracy, args.out.clone(), Watch::signals(warn));
    let options = EffectsOptions { accuracy, out, progress, watch };
    let written = write_effects(&file, &args.of, &options, &mut warn);
    if let Err(Error::Interrupted) = written {
        return Ok(Exit::Interrupted);
    }
    let outcome = written?;
    if !args.quiet {
        say(outcome.report.trim_end());
    }
    Ok(if outcome.ledger.interrupted { Exit::Interrupted } else { Exit::Done })
}
