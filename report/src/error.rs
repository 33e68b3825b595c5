//! What can go wrong when results are written, each with the way out.

use std::io;
use std::path::{Path, PathBuf};

/// An output that could not be made. Every message names the file or plot and, where there is
/// one, the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The operating system refused a file operation.
    #[error("can't {action} {}: {source}{}", path.display(), remedy(source))]
    Io {
        /// What was tried, such as "write".
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The system's own words.
        source: io::Error,
    },

    /// The folder asked for already holds files, which would be overwritten or mixed up.
    #[error(
        "{} is not empty, and results are never overwritten: give a new or empty folder with \
         --out, or leave --out away for a numbered folder under runs/",
        path.display()
    )]
    FolderInUse {
        /// The folder that was asked for.
        path: PathBuf,
    },

    /// The folder asked for belongs to another sweep or other study.
    #[error(
        "{} holds another {kind}, {difference}: give another folder with --out, or delete those results with --fresh",
        path.display()
    )]
    OtherStudy {
        /// What the folder is for, such as "sweep".
        kind: &'static str,
        /// The folder that was asked for.
        path: PathBuf,
        /// How the one that is there differs, such as "of other values".
        difference: String,
    },

    /// Another process computes in the folder.
    #[error("another {kind} is at work in {}: wait for its end, or take another folder", path.display())]
    Busy {
        /// What the folder is for, such as "sweep".
        kind: &'static str,
        /// The folder that was asked for.
        path: PathBuf,
    },

    /// A CSV file is not a table of numbers under a header.
    #[error("{}, line {line}: {message}", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// What is wrong with it.
        message: String,
    },

    /// A row has more or fewer numbers than the table has columns.
    #[error("a row of {found} numbers was given to a table of {expected} columns")]
    RowWidth {
        /// Columns of the table.
        expected: usize,
        /// Numbers in the row.
        found: usize,
    },

    /// A plot holds no finite point.
    #[error("plot '{title}' has nothing to show: no point with finite coordinates")]
    EmptyPlot {
        /// Title of the plot.
        title: String,
    },

    /// A logarithmic axis was asked for data without a positive value.
    #[error("plot '{title}' has no positive value on its logarithmic {axis} axis: use a linear axis")]
    LogAxis {
        /// Title of the plot.
        title: String,
        /// "x" or "y".
        axis: &'static str,
    },

    /// A field record whose parts don't go together.
    #[error("the field record of '{part}' has a hole: {message}")]
    Field {
        /// The part, or "times".
        part: String,
        /// What is wrong with it.
        message: String,
    },

    /// A file isn't the array that it should be.
    #[error("{}: {message}", path.display())]
    Npy {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        message: String,
    },

    /// A value could not be written as JSON, or JSON could not be read.
    #[error("{}: {message}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// The parser's own words.
        message: String,
    },

    /// A checkpoint can't be written or read.
    #[error("{}: {message}", path.display())]
    Checkpoint {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        message: String,
    },

    /// The system did not let signals such as Ctrl-C be caught.
    #[error("Ctrl-C can't be caught: {message}")]
    Interrupt {
        /// The system's own words.
        message: String,
    },
}

impl OutputError {
    /// Wraps a system error with what was tried and where; for use in `map_err`.
    pub fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        move |source| Self::Io { action, path, source }
    }
}

fn remedy(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            " (choose a folder you may write to, with --out DIR)"
        }
        io::ErrorKind::NotADirectory => {
            " (a part of this path is a file, not a folder; choose another with --out DIR)"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            " (free some space, or choose a folder on another disk with --out DIR)"
        }
        _ => "",
    }
}
