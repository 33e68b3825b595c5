//! `ropewalk completions SHELL` and `ropewalk man DIR`

use super::{Exit, say};
use clap::Command;
use clap_complete::Shell;
use ropewalk_report::OutputError;
pub use ropewalk_studies::Error;
use std::path::Path;

/// Writes what a shell has to read to complete commands.
pub(crate) fn completions(mut command: Command, shell: Shell) -> Result<Exit, Error> {
    let name = command.get_name().to_string();
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut command, name, &mut text);
    say(String::from_utf8_lossy(&text).trim_end());
    Ok(Exit::Done)
}

/// Writes a page of the manual for the program and for each of its commands.
pub(crate) fn man(command: Command, folder: &Path) -> Result<Exit, Error> {
    std::fs::create_dir_all(folder).map_err(OutputError::io("create", folder))?;
    clap_mangen::generate_to(command, folder).map_err(OutputError::io("write to", folder))?;
    say(format!("{}: pages of the manual, such as ropewalk-run.1", folder.display()));
    Ok(Exit::Done)
}
