//! The command line of Ropewalk.

use std::process::ExitCode;

fn main() -> ExitCode {
    ropewalk::cli::main_with(ropewalk::scenes())
}
