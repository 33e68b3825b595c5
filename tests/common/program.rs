//! Runs the compiled program, for the tests of it.
#![allow(dead_code)]

use std::path::Path;
use std::process::{Command, Output};

/// The program with these arguments, in this folder.
pub fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ropewalk"));
    command.args(arguments).current_dir(folder);
    command
}

/// What it said and how it ended; the code is missing if it crashed.
#[derive(Debug)]
pub struct Said {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Said {
    pub fn of(out: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Said { code: out.status.code(), stdout: text(out.stdout), stderr: text(out.stderr) }
    }

    /// It ended with exit code 2, one message that holds all of this, and nothing else.
    #[track_caller]
    pub fn refused(&self, holds: &[&str]) {
        assert_eq!((self.code, self.stdout.as_str()), (Some(2), ""), "{}", self.stderr);
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        assert!(
            self.stderr.starts_with("error: ") && self.stderr.matches("error: ").count() == 1,
            "{}",
            self.stderr
        );
        for text in holds {
            assert!(self.stderr.contains(text), "no {text:?} in\n{}", self.stderr);
        }
    }
}

/// Runs the program to its end.
pub fn run(folder: &Path, arguments: &[&str]) -> Said {
    Said::of(program(folder, arguments).output().unwrap())
}

/// The signals that end a run, with what messages call them and the exit code: interrupt, end, hang-up. Under `nohup` runs
/// are to go on after the last.
#[cfg(unix)]
pub fn signals() -> Vec<(&'static str, &'static str, i32)> {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored =
        status.lines().find_map(|l| u64::from_str_radix(l.strip_prefix("SigIgn:")?.trim(), 16).ok());
    let mut all = vec![("INT", "Ctrl-C", 130), ("TERM", "SIGTERM", 143)];
    if ignored.is_none_or(|signals| signals & 1 == 0) {
        all.push(("HUP", "SIGHUP", 129));
    }
    all
}
