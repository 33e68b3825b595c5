//! The program as a user runs it, and what it says.

#[path = "../common/scenes.rs"]
mod common;
#[path = "../common/program.rs"]
mod program;

mod atlas;
mod bad_input;
mod checkpoint;
mod cli;
mod cost;
mod effects;
mod examples;
mod plugin;
mod sweep;
mod verification;
