//! `ropewalk resume DIR`

use super::run::tell;
use super::{Exit, complain};
use ropewalk_report::ProgressMode;
pub use ropewalk_studies::Error;
use ropewalk_studies::run::{Every, RunOptions, resume as resume_run};
use std::path::PathBuf;

pub(crate) fn resume(folder: PathBuf, checkpoint: Option<Every>, quiet: bool) -> Result<Exit, Error> {
    let progress = if quiet { ProgressMode::Quiet } else { ProgressMode::Auto };
    let options = RunOptions { out: Some(folder), profile: false, progress, checkpoint };
    let outcome = resume_run(&options, &mut |warning| complain(format!("warning: {warning}")))?;
    Ok(tell(&outcome, quiet))
}
