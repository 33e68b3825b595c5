//! Sweeps, costs, effects and atlases.

#[path = "../common/scenes.rs"]
mod common;
#[path = "../common/program.rs"]
mod program;

mod atlas;
mod cost;
mod effects;
mod parts;
mod sweep;
