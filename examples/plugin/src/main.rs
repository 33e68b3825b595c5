//! A program of one's own: Ropewalk's command line with a type of element, a type of force and a scene more.
//!
//! ```sh
//! cargo run -- run heave
//! cargo run -- describe float
//! ```
//!
//! Modules are linked with the program, and what they register is known by that alone. Types from a library need
//! `use my_library as _;` here.

mod float;
mod waterplane;

use ropewalk::Bundled;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut scenes = ropewalk::bundled().to_vec();
    scenes.push(Bundled { name: "heave", text: include_str!("../scenes/heave.toml") });
    ropewalk::cli::main_with(&scenes)
}
