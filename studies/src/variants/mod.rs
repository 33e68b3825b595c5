//! What stiffness models cost and give, and what a scaling of the equations does: `ropewalk variants`.
//!
//! Two studies. [`stiffness`] compares every pair of a longitudinal and a transverse model: its cost, its error on a
//! cantilever and on a pendulum, locking, balance of energy, symmetry, and the strain that pure bending causes. [`scaling`]
//! runs the same problems with equations in SI units and without dimensions, with relative and with absolute stopping
//! tests, and counts Newton's iterations.

mod condition;
pub mod pictures;
mod problem;
mod report;
pub mod scaling;
pub mod stiffness;

pub use condition::{Form, condition};
pub use problem::Problem;

use scaling::Row;
use serde::Serialize;
use stiffness::{Forbidden, Stiffness};

/// Everything that `ropewalk variants` found.
#[derive(Clone, Debug, Serialize)]
pub struct Variants {
    /// Version of Ropewalk.
    pub ropewalk: &'static str,
    /// The pairs of models that go together, with each quadrature.
    pub stiffness: Vec<Stiffness>,
    /// Those that don't, and why.
    pub forbidden: Vec<Forbidden>,
    /// Equations in SI units and without dimensions.
    pub scaling: Vec<Row>,
}
