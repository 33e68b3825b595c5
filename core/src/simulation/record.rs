//! Records: named, unit-carrying outputs of a run.

use crate::model::Model;
use crate::model::column::Column;
use crate::model::state::At;
use crate::simulation::audit::Audit;

/// What a record may look at: the model at a consistent instant.
pub struct Sample<'a> {
    /// The model.
    pub model: &'a Model,
    /// Configuration, velocities and accelerations, consistent with the constraints.
    pub at: At<'a>,
    /// Multipliers from the index-1 system.
    pub lambda: &'a [f64],
    /// Energies and accumulated work.
    pub audit: &'a Audit,
}

/// An output: what it is called, and its value at an instant.
pub trait Record: Send + Sync {
    /// What it is, in a few words for people.
    fn title(&self) -> String;
    /// Its name in the summary, such as `hose.end`.
    fn name(&self) -> String;
    /// Its columns.
    fn columns(&self) -> Vec<Column>;
    /// Whether it needs consistent accelerations and multipliers, which cost a factorisation per sample.
    fn needs_forces(&self) -> bool {
        false
    }
    /// Whether it tells of strains, or of forces that follow from them: between steps these are looked for.
    fn needs_strains(&self) -> bool {
        false
    }
    /// Whether it tells of the balance of energy: between steps that is drawn up anew.
    fn needs_energy(&self) -> bool {
        false
    }
    /// Appends one value per column.
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>);
}
