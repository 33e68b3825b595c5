//! How equations are solved: linear systems, integrators, equilibria, modes.

pub mod integrator;
pub mod linear;
pub mod linearise;
pub mod modes;
pub mod redundancy;
pub mod statics;
pub mod times;
