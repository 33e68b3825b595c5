//! Parts in water: surface, drag, added mass, towing.

#[path = "../common/scenes.rs"]
mod common;

mod afloat;
mod all_round;
mod floating;
mod fluid;
mod one_world;
mod tank;
mod towing;
mod vortices;
mod wall;
mod waves;
mod whirling;
