//! An input as a formula of records and time.

use super::channels::{Bound, Channels};
use crate::register_spec;
use crate::spec::ControllerSpec;
use ropewalk_core::{BuildError, Controller, Sample};
use ropewalk_quantity::{self as quantity, Dimension, Formula};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Sets an input to a formula of records and of the time `t`, such as `-2 kN s/m * vessel.velocity.x`, at regular instants.
///
/// A name is a column of a record; one with other signs than letters, digits, dots and underscores stands in braces, as in
/// `{rope@50%.tension}`. Units are checked. The value is brought within the limits of the input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpressionSpec {
    /// The input that it sets.
    pub input: String,
    /// The formula: `+ - * / ^`, `sqrt`, `abs`, `sign`, `min`, `max`, `clamp`, `exp`, `ln`, `tanh`, `sin`, `cos`, `tan`, `asin`, `acos`,
    /// `atan`, `atan2`, `floor`, `round`, `pi`, and numbers with units.
    pub value: Formula,
    /// Time from one instant to the next [s].
    #[serde(deserialize_with = "quantity::time")]
    pub every: f64,
    /// Name in messages. Default: that of the input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}
register_spec!(Controller, "expression", ExpressionSpec);

struct Expressed {
    name: String,
    input: usize,
    every: f64,
    value: Bound,
}

#[typetag::serde(name = "expression")]
impl ControllerSpec for ExpressionSpec {
    fn input(&self) -> &str {
        &self.input
    }
    fn build(&self, c: &Channels<'_>) -> Result<Arc<dyn Controller>, BuildError> {
        let (number, input) = c.input(&self.input)?;
        let wanted = Dimension::of(input.unit()).unwrap_or_default();
        Ok(Arc::new(Expressed {
            name: self.name.clone().unwrap_or_else(|| self.input.clone()),
            input: number,
            every: c.interval(self.every)?,
            value: c.bind("value", &self.value, Some(wanted))?,
        }))
    }
}

impl Controller for Expressed {
    fn name(&self) -> &str {
        &self.name
    }
    fn input(&self) -> usize {
        self.input
    }
    fn every(&self) -> f64 {
        self.every
    }
    fn needs_forces(&self) -> bool {
        self.value.needs_forces()
    }
    fn act(&self, sample: &Sample<'_>, _: &mut [f64]) -> f64 {
        self.value.value(sample)
    }
}
