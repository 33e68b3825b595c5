//! Lines that touch each other, and themselves.
//!
//! A line is a shape as well: the distance from it changes no faster than a point moves, and its level surfaces are hollow
//! by no more than it is bent, so that the search that finds where a curve touches a shape finds where it touches another
//! curve. Each of two pieces is searched along the other with half of the stiffness, which treats both alike.
//!
//! [`pieces`] knows what can touch what, [`near`] keeps the list of pieces that are near each other, [`facing`] finds where
//! one touches the other, [`push`] turns that into forces, [`bristle`] and [`friction`] hold what would slip, [`ahead`] keeps steps short enough, and [`LineContact`] puts it
//! all into the equations of motion.

mod ahead;
mod bristle;
mod clearance;
mod curve;
mod facing;
mod friction;
mod near;
mod pieces;
mod push;
mod spec;
mod term;

pub use clearance::ClearanceSpec;
pub use curve::nearest_points;
pub use spec::LineContactSpec;
pub use term::{Deepest, LineContact, Touching};
