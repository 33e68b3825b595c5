//! Elements of Ropewalk.

pub mod cable;
mod path;
mod point_mass;
pub mod rigid_body;
pub mod rigid_chain;

pub use cable::{CableSpec, Section};
pub use path::Path;
pub use point_mass::{Across, PointMass, PointMassSpec};
pub use rigid_body::RigidBodySpec;
pub use rigid_chain::{LinkSection, RigidChainSpec};
