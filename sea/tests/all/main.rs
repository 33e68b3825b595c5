//! Waves against reference values and their own differences.

mod kinematics;
mod lattice;
mod measured;
mod response;
mod states;
mod table;
