//! The program as a user runs it, and what it says.

#[path = "../common/program.rs"]
mod program;

mod bad_input;
mod checkpoint;
mod cli;
mod examples;
mod import;
mod migrate;
mod pages;
mod statistics;
mod stopping;
mod storm;
mod verification;
