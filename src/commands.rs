//! What the command line can do, one file for each verb.

pub(crate) mod bench;
pub(crate) mod check;
pub(crate) mod cost;
pub(crate) mod describe;
pub(crate) mod effects;
pub(crate) mod list;
pub(crate) mod modes;
pub(crate) mod resume;
pub(crate) mod run;
mod schema;
pub(crate) mod sweep;
pub(crate) mod variants;
pub(crate) mod verify;

use std::fmt::Display;
use std::io::Write;

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
    /// Ctrl-C, as shells expect it (128 + SIGINT).
    Interrupted = 130,
}

/// Writes results. Whoever closes the pipe early has seen enough.
pub(crate) fn say(text: impl Display) {
    let _ = writeln!(std::io::stdout(), "{text}");
}

/// Writes an error or a warning.
pub(crate) fn complain(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Breaks a text into lines of at most 96 characters, each behind `indent`; paragraphs stay apart.
pub(crate) fn wrapped(text: &str, indent: usize) -> String {
    const WIDTH: usize = 96;
    let mut out = String::new();
    let mut paragraphs = text.split("\n\n").peekable();
    while let Some(paragraph) = paragraphs.next() {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
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
