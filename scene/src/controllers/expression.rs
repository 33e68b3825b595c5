//! An input as a formula of records and time.

use super::channels::{Bound, Channels};
use super::sampled::{Act, sampled};
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
    value: Bound,
}

#[typetag::serde(name = "expression")]
impl ControllerSpec for ExpressionSpec {
    fn input(&self) -> &str {
        &self.input
    }
    fn build(&self, c: &Channels<'_>) -> Result<Arc<dyn Controller>, BuildError> {
        let wanted = Dimension::of(c.input(&self.input)?.1.unit()).unwrap_or_default();
        let act = Expressed { value: c.bind("value", &self.value, Some(wanted))? };
        sampled(c, &self.input, &self.name, self.every, act)
    }
}

impl Act for Expressed {
    fn sees(&self) -> Vec<&Bound> {
        vec![&self.value]
    }
    fn act(&self, sample: &Sample<'_>, _: &mut [f64]) -> f64 {
        self.value.value(sample)
    }
}
