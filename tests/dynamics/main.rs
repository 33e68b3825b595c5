//! Motion in time: bodies, joints, cables, steps and their accuracy.

#[path = "../common/scenes.rs"]
mod common;
#[path = "../common/mechanisms.rs"]
mod mechanisms;
#[path = "../common/program.rs"]
mod program;

mod accuracy;
mod ahead;
mod bodies;
mod chain;
mod consistency;
mod contradictions;
mod controllers;
mod corners;
mod curved;
mod dead_points;
mod energy;
mod inputs;
mod invariance;
mod joints;
mod linearise;
mod memory;
mod motions;
mod pendulums;
mod radau;
mod running;
mod scales;
mod singular;
mod swings;
mod tolerance;
mod torsion_springs;
