//! What the command line can do, one file for each verb.

pub(crate) mod atlas;
pub(crate) mod bench;
pub(crate) mod book;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod cost;
pub(crate) mod describe;
pub(crate) mod effects;
mod examples;
pub(crate) mod export;
pub(crate) mod export_fmu;
pub(crate) mod import;
pub(crate) mod linearise;
pub(crate) mod list;
pub(crate) mod migrate;
pub(crate) mod modes;
pub(crate) mod new;
pub(crate) mod plot;
pub(crate) mod reference;
pub(crate) mod remedy;
pub(crate) mod resume;
pub(crate) mod run;
pub(crate) mod scene_schema;
mod schema;
mod serve;
pub(crate) mod shared;
mod shell;
pub(crate) mod statistics;
pub(crate) mod sweep;
pub(crate) mod variants;
pub(crate) mod verify;
pub(crate) mod view;
mod words;

use clap::ValueEnum;
use ropewalk_report::{Interrupt, ProgressMode};
use std::fmt::Display;
use std::io::{ErrorKind, Write};
use std::sync::{Mutex, PoisonError};

/// How the program ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Exit {
    /// All went well.
    Done = 0,
    /// A case of the verification suite is outside its tolerances.
    Outside = 1,
    /// The scene or the command is wrong.
    Input = 2,
    /// The solver gave up.
    Solver = 3,
    /// Ctrl-C or another signal.
    Interrupted = 130,
}

impl Exit {
    /// The exit code of the program.
    pub(crate) fn code(self) -> u8 {
        if self == Exit::Interrupted { Interrupt::exit_code() } else { self as u8 }
    }
}

/// Why results could not be written, the first time.
static UNSAID: Mutex<Option<std::io::Error>> = Mutex::new(None);

/// Writes results. Whoever closes the pipe early has seen enough; what else goes wrong is told at the end.
pub(crate) fn say(text: impl Display) {
    if let Err(e) = writeln!(std::io::stdout(), "{text}")
        && e.kind() != ErrorKind::BrokenPipe
    {
        UNSAID.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(e);
    }
}

/// How the program ends if it would have ended like this: it says so where results could not be written.
pub(crate) fn ended(exit: Exit) -> Exit {
    match UNSAID.lock().unwrap_or_else(PoisonError::into_inner).take() {
        Some(e) => {
            complain(format!("error: can't write to standard output: {e}"));
            Exit::Input
        }
        None => exit,
    }
}

/// Writes to standard error.
pub(crate) fn complain(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Writes an error. Messages themselves have no such prefix.
pub(crate) fn error(text: impl Display) {
    complain(format!("error: {text}"));
}

/// Writes a warning.
pub(crate) fn warn(text: &str) {
    complain(format!("warning: {text}"));
}

/// Says what is left of a command that a signal stopped.
pub(crate) fn interrupted(what: impl Display) -> Exit {
    complain(format!("stopped by {}: {what}", Interrupt::cause()));
    Exit::Interrupted
}

/// What `--progress` can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Shown {
    Auto,
    Bar,
    Lines,
    None,
}

/// What the command line says of progress.
static SHOWN: Mutex<ProgressMode> = Mutex::new(ProgressMode::Auto);

pub(crate) fn show(how: Shown) {
    *SHOWN.lock().unwrap_or_else(PoisonError::into_inner) = match how {
        Shown::Auto => ProgressMode::Auto,
        Shown::Bar => ProgressMode::Bar,
        Shown::Lines => ProgressMode::Lines,
        Shown::None => ProgressMode::Quiet,
    };
}

/// How progress is shown.
pub(crate) fn progress(quiet: bool) -> ProgressMode {
    let shown = || *SHOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if quiet { ProgressMode::Quiet } else { shown() }
}

/// Breaks a text into lines of at most 96 characters, each behind `indent`; paragraphs stay apart, and those set in by
/// four spaces, such as examples, keep their lines.
pub(crate) fn wrapped(text: &str, indent: usize) -> String {
    const WIDTH: usize = 96;
    let mut out = String::new();
    let mut paragraphs = text.split("\n\n").peekable();
    while let Some(paragraph) = paragraphs.next() {
        let as_written = !paragraph.trim().is_empty()
            && paragraph.lines().all(|line| line.trim().is_empty() || line.starts_with("    "));
        let kept = paragraph.lines().filter(|_| as_written);
        out.extend(kept.map(|line| format!("{:indent$}{line}\n", "")));
        let mut line = String::new();
        for word in paragraph.split_whitespace().filter(|_| !as_written) {
            if !line.is_empty() && indent + line.chars().count() + 1 + word.chars().count() > WIDTH {
                out += &format!("{:indent$}{line}\n", "");
                line.clear();
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line += word;
        }
        if !line.is_empty() {
            out += &format!("{:indent$}{line}\n", "");
        }
        if paragraphs.peek().is_some() {
            out.push('\n');
        }
    }
    out
}

/// The first sentence or line of a doc comment.
pub(crate) fn first_line(text: &str) -> String {
    let paragraph = text.split("\n\n").next().unwrap_or_default();
    let line: String = paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.find(". ") {
        Some(end) => line[..=end].to_string(),
        None => line,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_keep_their_lines() {
        let text = "Words that\nrun on.\n\n    one   --set a=1\n    two   --set b=2\n\nThe end.\n";
        let shown = "  Words that run on.\n\n      one   --set a=1\n      two   --set b=2\n\n  The end.\n";
        assert_eq!(wrapped(text, 2), shown);
    }
}
