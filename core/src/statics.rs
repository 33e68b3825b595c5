//! Equilibria.

use serde::{Deserialize, Serialize};

/// How equilibria are found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StaticsOptions {
    /// Number of load steps from t = 0 to the end of the run.
    pub steps: usize,
    /// Most Newton iterations per equilibrium.
    pub max_iterations: u32,
    /// Refuse equilibria that are unstable or folded, and look for the true one.
    pub stable: bool,
}

impl Default for StaticsOptions {
    fn default() -> Self {
        StaticsOptions { steps: 10, max_iterations: 400, stable: true }
    }
}
