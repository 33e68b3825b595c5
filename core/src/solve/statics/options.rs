//! Options of the search for equilibria.

use crate::error::{BuildError, positive};

/// Options of the search for equilibria.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct StaticsOptions {
    /// Number of load steps from t = 0 to the end of the run.
    pub steps: usize,
    /// Most Newton iterations per equilibrium.
    pub max_iterations: u32,
    /// Reject unstable or folded equilibria and search for a stable one.
    pub stable: bool,
    /// Tolerance of positions, relative to the length of the longest cable (without cables: the size of the scene).
    pub tolerance: f64,
}

impl Default for StaticsOptions {
    fn default() -> Self {
        StaticsOptions { steps: 10, max_iterations: 60, stable: true, tolerance: 1e-9 }
    }
}

impl StaticsOptions {
    /// Checks the numbers.
    ///
    /// # Errors
    /// The first that is wrong, with its field.
    pub fn check(&self) -> Result<(), BuildError> {
        let refused = |name: &str, message: String| Err(BuildError::at(format!("statics.{name}"), message));
        if self.steps == 0 || self.steps > 1_000_000 {
            return refused("steps", format!("`steps` must be between 1 and 1000000, not {}", self.steps));
        }
        if self.max_iterations == 0 {
            return refused("max_iterations", "`max_iterations` must be at least 1".into());
        }
        positive("tolerance", self.tolerance).map(drop).map_err(|e| e.of("statics.tolerance"))
    }
}
