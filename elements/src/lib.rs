//! Ropewalk: elements.

mod point_mass;
pub use point_mass::PointMass;
