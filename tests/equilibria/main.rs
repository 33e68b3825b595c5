//! Equilibria, their paths and stability, modes.

#[path = "../common/scenes.rs"]
mod common;
#[path = "../common/mechanisms.rs"]
mod mechanisms;
#[path = "../common/program.rs"]
mod program;

mod buckling;
mod flow;
mod flutter;
mod modes;
mod neutral;
mod paths;
mod stability;
mod statics;
