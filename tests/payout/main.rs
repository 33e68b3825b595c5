//! Cables whose length changes: winches, eyelets, spools.

#[path = "../common/scenes.rs"]
mod common;
#[path = "../common/hoist.rs"]
mod hoist;
#[path = "../common/program.rs"]
mod program;

mod arc;
mod belt;
mod births;
mod drum;
mod eyelet;
mod falls;
mod fleet_twist;
mod gripping;
mod hoisting;
mod lifting;
mod momentum;
mod passing;
mod reeling;
mod reeving;
mod route;
mod running;
mod shear_pin;
mod standing;
mod torsion;
mod unwinding;
mod unwinding_scene;
mod winch;
