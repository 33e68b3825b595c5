//! `ropewalk run SCENE`

use super::{Exit, complain, say};
use crate::cli::SceneArgs;
use crate::error::Error;
use crate::output::ProgressMode;
use crate::read::SceneFile;
use crate::run::{Every, Outcome, RunOptions, run as run_scene};
use ropewalk_models::Bundled;
use std::path::PathBuf;

pub(crate) fn run(
    args: &SceneArgs,
    out: Option<PathBuf>,
    profile: bool,
    checkpoint: Option<Every>,
    quiet: bool,
    bundled: &[Bundled],
) -> Result<Exit, Error> {
    let file = SceneFile::open(&args.scene, &args.overrides, bundled)?;
    let progress = if quiet { ProgressMode::Quiet } else { ProgressMode::Auto };
    let options = RunOptions { out, profile, progress, checkpoint };
    let outcome = run_scene(&file, &options, &mut |warning| complain(format!("warning: {warning}")))?;
    Ok(tell(&outcome, quiet))
}

/// Says how a run ended.
pub(super) fn tell(outcome: &Outcome, quiet: bool) -> Exit {
    if !quiet {
        say(outcome.report.trim_end());
    }
    let message = outcome.summary.message.as_deref().unwrap_or_default();
    match outcome.summary.status.as_str() {
        "failed" => {
            let folder = outcome.folder.path().display();
            complain(format!("error: {message}\n  = note: the results until then are in {folder}"));
            Exit::Solver
        }
        "interrupted" => Exit::Interrupted,
        _ => Exit::Done,
    }
}
