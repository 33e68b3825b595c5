//! A sweep of the command line whose runs other processes compute, such as the workers of a cluster.

use super::Exit;
use crate::cli::{Cli, Command, SweepArgs};
use clap::Parser;
use ropewalk_models::Bundled;
use ropewalk_report::Watch;
use ropewalk_studies::Error;
use ropewalk_studies::sweep::{Grid, Planned, Shared, SweepOptions, plan, share};

/// A sweep, as the command line has it, of which other processes compute the runs.
pub struct SharedSweep {
    args: SweepArgs,
    grid: Grid,
}

impl SharedSweep {
    /// Reads `sweep SCENE --vary …`.
    ///
    /// # Errors
    /// The arguments are wrong, which has been said on standard error.
    pub fn parse(arguments: &[String], bundled: &[Bundled]) -> Result<Self, u8> {
        let all = std::iter::once("ropewalk").chain(arguments.iter().map(String::as_str));
        let cli = Cli::try_parse_from(all).map_err(|e| {
            let _ = e.print();
            if e.use_stderr() { Exit::Input as u8 } else { 0 }
        })?;
        let Command::Sweep(mut args) = cli.command else { return Err(Exit::Input as u8) };
        let grid = args.grid(bundled).map_err(|e| {
            super::error(e);
            Exit::Input as u8
        })?;
        args.quiet = true;
        Ok(SharedSweep { args, grid })
    }

    /// The scheduler that `--dask` names.
    pub fn address(&self) -> Option<&str> {
        self.args.dask.as_deref()
    }

    /// Checks it and prepares its folder. Which runs are missing, and the arguments that make the same sweep on another
    /// machine.
    ///
    /// # Errors
    /// As [`plan`].
    pub fn plan(&self) -> Result<(Planned, Vec<String>), Error> {
        let planned = plan(&self.grid, &self.args.options(Watch::default()))?;
        let words = self.args.words(&planned.folder);
        Ok((planned, words))
    }

    /// Computes some of the runs, one after the other.
    ///
    /// # Errors
    /// As [`share`].
    pub fn compute(&self, runs: &[usize], watch: Watch) -> Result<Shared, Error> {
        share(&self.grid, runs, &SweepOptions { jobs: Some(1), ..self.args.options(watch) })
    }
}
