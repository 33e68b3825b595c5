//! `ropewalk linearise SCENE`

use super::{Exit, say, warn};
use crate::cli::SceneArgs;
use ropewalk_models::Bundled;
use ropewalk_report::Watch;
use ropewalk_scene::{SceneFile, quantity};
pub use ropewalk_studies::Error;
use ropewalk_studies::linearise::{About, LineariseOptions, write_linearised};
use std::path::PathBuf;

/// About which state, and where the matrices go.
#[derive(Debug, clap::Args)]
pub(crate) struct LineariseArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// State: `equilibrium`, `start`, or where the run is at a time such as `20 s`
    #[arg(long, value_name = "STATE", default_value = "equilibrium", value_parser = about)]
    at: About,
    /// Folder for the results, new or empty [default: runs/SCENE-linearised, numbered]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Say nothing but errors and warnings
    #[arg(long, short)]
    quiet: bool,
}

fn about(text: &str) -> Result<About, String> {
    match text.trim() {
        "equilibrium" => Ok(About::Equilibrium),
        "start" => Ok(About::Start),
        time => match time.parse().or_else(|_| quantity::kind::TIME.parse(time)) {
            Ok(t) => Ok(About::Time(t)),
            Err(_) => Err(format!("expected `equilibrium`, `start` or a time such as `20 s`, not `{text}`")),
        },
    }
}

pub(crate) fn linearise(args: &LineariseArgs, bundled: &[Bundled]) -> Result<Exit, Error> {
    let file = SceneFile::open(&args.scene.scene, &args.scene.overrides, bundled)?;
    let options = LineariseOptions { about: args.at, out: args.out.clone(), watch: Watch::signals(warn) };
    let outcome = write_linearised(&file, &options, &mut warn)?;
    if !args.quiet {
        say(outcome.report.trim_end());
    }
    Ok(Exit::Done)
}
