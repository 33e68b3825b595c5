//! What reports compute and write, against reference values and what reads it back.

mod statistics;
mod vtk;
