//! Control: what sets inputs while a run goes on, by what it sees of it.

use crate::simulation::record::Sample;

/// Sets inputs at regular instants, the first of them at t = 0. Steps end there.
///
/// It belongs to the model and never changes; what it remembers, such as an integral, is kept by the simulation, and
/// so goes through checkpoints and changes of the mesh.
pub trait Controller: Send + Sync {
    /// Its name in the scene.
    fn name(&self) -> &str;
    /// The number of the input that it sets, in the order of [`Model::inputs`](crate::Model::inputs).
    fn input(&self) -> usize;
    /// Time from one of its instants to the next [s].
    fn every(&self) -> f64;
    /// How many numbers it remembers; all 0 at first.
    fn memory(&self) -> usize {
        0
    }
    /// Whether it needs consistent accelerations and multipliers, which cost a factorisation per instant.
    fn needs_forces(&self) -> bool {
        false
    }
    /// What it sets its input to, brought within its limits; NaN ends the run.
    fn act(&self, sample: &Sample<'_>, memory: &mut [f64]) -> f64;
}
