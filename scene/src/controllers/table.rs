//! An input as a table over a record.

use super::channels::{Bound, Channels};
use super::sampled::{Act, sampled};
use crate::register_spec;
use crate::spec::ControllerSpec;
use ropewalk_core::error::{finite, need};
use ropewalk_core::{BuildError, Controller, Sample};
use ropewalk_quantity::{self as quantity, Dimension, Formula};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Sets an input by a table over a record, over time or over a formula of them, at regular instants: straight lines
/// between its rows, constant before the first and after the last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ControlTableSpec {
    /// The input that it sets.
    pub input: String,
    /// What the table is over: a column of a record, `t`, or a formula of them.
    pub over: Formula,
    /// Values of `over`, ascending: numbers in SI units, or texts with units.
    pub at: Vec<Formula>,
    /// Values of the input there.
    pub value: Vec<Formula>,
    /// Time from one instant to the next [s].
    #[serde(deserialize_with = "quantity::time")]
    pub every: f64,
    /// Name in messages. Default: that of the input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}
register_spec!(Controller, "table", ControlTableSpec);

struct Tabled {
    over: Bound,
    rows: Vec<[f64; 2]>,
}

fn numbers(field: &'static str, list: &[Formula], of: Dimension) -> Result<Vec<f64>, BuildError> {
    let unit = of.unit();
    let all = list.iter().map(|x| x.in_unit(&unit)).collect::<Result<Vec<_>, _>>();
    let all = all.map_err(|what| BuildError::at(field, format!("`{field}`: {what}")))?;
    finite(field, &all).map(|()| all)
}

#[typetag::serde(name = "table")]
impl ControllerSpec for ControlTableSpec {
    fn input(&self) -> &str {
        &self.input
    }
    fn build(&self, c: &Channels<'_>) -> Result<Arc<dyn Controller>, BuildError> {
        let (_, input) = c.input(&self.input)?;
        let over = c.bind("over", &self.over, None)?;
        let at = numbers("at", &self.at, over.dimension)?;
        let value = numbers("value", &self.value, Dimension::of(input.unit()).unwrap_or_default())?;
        need(!at.is_empty(), || "a table needs rows".into()).map_err(|e| e.of("at"))?;
        need(at.len() == value.len(), || {
            format!("`at` has {} entries, but `value` has {}", at.len(), value.len())
        })
        .map_err(|e| e.of("value"))?;
        need(at.windows(2).all(|x| x[0] < x[1]), || "the entries of `at` must ascend".into())
            .map_err(|e| e.of("at"))?;
        let act = Tabled { over, rows: at.into_iter().zip(value).map(|(x, y)| [x, y]).collect() };
        sampled(c, &self.input, &self.name, self.every, act)
    }
}

impl Act for Tabled {
    fn sees(&self) -> Vec<&Bound> {
        vec![&self.over]
    }
    fn act(&self, sample: &Sample<'_>, _: &mut [f64]) -> f64 {
        let x = self.over.value(sample);
        if x.is_nan() {
            return x;
        }
        let next = self.rows.partition_point(|row| row[0] <= x);
        match (next.checked_sub(1).map(|k| self.rows[k]), self.rows.get(next)) {
            (Some([a, ya]), Some([b, yb])) => ya + (x - a) / (b - a) * (yb - ya),
            (Some([_, y]), None) | (None, Some(&[_, y])) => y,
            (None, None) => f64::NAN,
        }
    }
}
