//! `ropewalk view DIR`, `ropewalk view A B`

use super::{Exit, say};
pub use ropewalk_studies::Error;
use ropewalk_studies::run::{compare, page_of, report_of};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Which runs to look at, and where the page goes.
#[derive(Debug, clap::Args)]
pub(crate) struct ViewArgs {
    /// Folder of a run, or of two runs to compare
    #[arg(value_name = "DIR", required = true, num_args = 1..=2)]
    folders: Vec<PathBuf>,
    /// File for the page [default: report.html in the folder; of two runs compare-NAME.html in the first]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Make the page anew, of history.csv, field.npy and summary.json
    #[arg(long)]
    fresh: bool,
    /// Only say where the page is
    #[arg(long)]
    no_open: bool,
    /// Serve the page to a browser on this machine, made anew at every look, until Ctrl-C: of a run that still goes on
    #[arg(long, value_name = "PORT", num_args = 0..=1, default_missing_value = "0", conflicts_with_all = ["out", "fresh"])]
    serve: Option<u16>,
}

pub(crate) fn view(args: &ViewArgs) -> Result<Exit, Error> {
    if let Some(port) = args.serve {
        return super::serve::serve(&args.folders, port, !args.no_open);
    }
    let path = match args.folders.as_slice() {
        [a, b] => {
            let name = b.canonicalize().unwrap_or_else(|_| b.clone());
            let name = name.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let path = args.out.clone().unwrap_or_else(|| a.join(format!("compare-{name}.html")));
            compare([a, b])?.write(&path)?;
            path
        }
        [folder, ..] => args.single(folder)?,
        [] => unreachable!("one folder is required"),
    };
    say(path.display());
    if !args.no_open && std::io::stdout().is_terminal() {
        open(path.as_os_str());
    }
    Ok(Exit::Done)
}

impl ViewArgs {
    fn single(&self, folder: &Path) -> Result<PathBuf, Error> {
        match (&self.out, self.fresh) {
            (None, false) => report_of(folder),
            (out, _) => {
                let path = out.clone().unwrap_or_else(|| folder.join("report.html"));
                page_of(folder)?.write(&path)?;
                Ok(path)
            }
        }
    }
}

/// Shows something with the program that the system has for it; where there is none, its place has been said.
pub(super) fn open(what: &std::ffi::OsStr) {
    let mut command = if cfg!(target_os = "macos") {
        Command::new("open")
    } else if cfg!(windows) {
        let mut command = Command::new("cmd");
        // the first text in quotes would be the title of a window
        command.args(["/C", "start", ""]);
        command
    } else {
        Command::new("xdg-open")
    };
    let _ = command.arg(what).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
}
