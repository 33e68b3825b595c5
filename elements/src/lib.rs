//! Elements of Ropewalk.

pub mod cable;
mod point_mass;

pub use cable::{CableSpec, Section};
pub use point_mass::{PointMass, PointMassSpec};
