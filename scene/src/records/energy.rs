//! The balance of energy over time.

use super::named;
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::{BuildError, Column, Model, Record, Sample};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Balance of energy: columns `energy.kinetic`, `.potential`, `.supplied`, `.dissipated` and `.imbalance` in J.
///
/// Work is counted from the start of the run. The imbalance is the energy gained by the integration (positive) or
/// lost by its numerical damping (negative).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EnergySpec {
    /// Name in results. Default: `energy`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}

register_spec!(Record, "energy", EnergySpec);

struct Balance {
    name: String,
    title: String,
}

impl Record for Balance {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        ["kinetic", "potential", "supplied", "dissipated", "imbalance"]
            .map(|i| Column::new(format!("{}.{i}", self.name), "J"))
            .to_vec()
    }
    fn needs_energy(&self) -> bool {
        true
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let a = s.audit;
        // what material carries in over an end is supplied from outside as well
        out.extend([a.kinetic, a.potential, a.supplied + a.carried, a.dissipated, a.imbalance()]);
    }
}

#[typetag::serde(name = "energy")]
impl RecordSpec for EnergySpec {
    fn build(&self, _: &Model) -> Result<Box<dyn Record>, BuildError> {
        let name = named(&self.name, || "energy".into());
        Ok(Box::new(Balance { name, title: named(&self.title, || "Balance of energy".into()) }))
    }
}
