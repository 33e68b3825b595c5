//! `ropewalk resume DIR`

use super::run::tell;
use super::{Exit, progress, warn};
pub use ropewalk_studies::Error;
use ropewalk_studies::run::{Every, RunOptions, resume as resume_run};
use std::path::PathBuf;

pub(crate) fn resume(folder: PathBuf, checkpoint: Option<Every>, quiet: bool) -> Result<Exit, Error> {
    let options = RunOptions { out: Some(folder), profile: false, progress: progress(quiet), checkpoint };
    Ok(tell(&resume_run(&options, &mut warn)?, quiet))
}
