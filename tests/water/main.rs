//! Parts in water: surface, drag, added mass, towing.

#[path = "../common/scenes.rs"]
mod common;

mod afloat;
mod fluid;
mod one_world;
mod towing;
mod waves;
mod whirling;
