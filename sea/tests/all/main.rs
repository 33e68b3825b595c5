//! Waves against reference values and their own differences.

mod kinematics;
mod lattice;
mod states;
mod table;
