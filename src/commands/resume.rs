//! `ropewalk resume DIR`

use super::run::tell;
use super::{Exit, progress, warn};
use ropewalk_report::Watch;
pub use ropewalk_studies::Error;
use ropewalk_studies::run::{Every, RunOptions, resume as resume_run};
use std::path::PathBuf;

pub(crate) fn resume(folder: PathBuf, checkpoint: Option<Every>, quiet: bool) -> Result<Exit, Error> {
    let (progress, watch) = (progress(quiet), Watch::signals(warn));
    let options = RunOptions { out: Some(folder), progress, checkpoint, watch, ..RunOptions::default() };
    Ok(tell(&resume_run(&options, &mut warn)?, quiet))
}
