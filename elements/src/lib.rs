//! Elements of Ropewalk.

pub mod cable;
mod point_mass;
pub mod rigid_body;

pub use cable::{CableSpec, Section};
pub use point_mass::{PointMass, PointMassSpec};
pub use rigid_body::RigidBodySpec;
