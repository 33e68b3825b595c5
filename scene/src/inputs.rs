//! The inputs of a scene: named channels that are set while a run goes on.

use crate::document::did_you_mean;
use ropewalk_core::{BuildError, Hold, Input, Signal};
use ropewalk_quantity::{Dimension, Formula, Kind, Setting};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A channel that is set while a run goes on: by a controller of the scene, or from Rust, Python or another program
/// between steps. A field reads it by `{ input = "name" }` instead of a number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InputSpec {
    /// Name, by which fields, controllers and programs refer to it.
    pub name: String,
    /// SI unit of its values, such as `m/s`. Default: plain numbers.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// Value until it is set: a number in its unit, or a text with a unit.
    #[serde(default)]
    pub default: Formula,
    /// Least value. Default: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<Formula>,
    /// Largest value. Default: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<Formula>,
    /// How values are joined: `hold` jumps when it is set, `linear` reaches the value at the end of the next advance, or of
    /// a controller's interval, and `smooth` does that without a kink. Speeds that are prescribed can't jump and need
    /// `linear`; amplitudes of motions need `smooth`.
    #[serde(default)]
    pub join: Hold,
}

impl InputSpec {
    /// An input without limits that is 0 until it is set.
    pub fn new(name: &str, unit: &str, join: Hold) -> Self {
        InputSpec { name: name.into(), unit: unit.into(), default: 0.0.into(), min: None, max: None, join }
    }

    fn build(&self) -> Result<Input, BuildError> {
        if self.name.trim().is_empty() {
            return Err(BuildError::at("name", "an input needs a name"));
        }
        Dimension::of(&self.unit)
            .map_err(|what| BuildError::at("unit", format!("\"{}\" {what}", self.unit)))?;
        if !Dimension::is_coherent(&self.unit) {
            let si = Dimension::of(&self.unit).unwrap_or_default().unit();
            let message = format!(
                "values of inputs are in SI units: write `unit = \"{si}\"` instead of \"{}\"; `default`, `min` and `max` \
                 may be texts in any unit",
                self.unit
            );
            return Err(BuildError::at("unit", message));
        }
        let number = |field: &'static str, x: &Formula| {
            x.in_unit(&self.unit).map_err(|what| BuildError::at(field, format!("`{field}`: {what}")))
        };
        let limit = |field, x: &Option<Formula>, none: f64| x.as_ref().map_or(Ok(none), |x| number(field, x));
        let limits = [limit("min", &self.min, f64::NEG_INFINITY)?, limit("max", &self.max, f64::INFINITY)?];
        Input::new(self.name.trim(), self.unit.trim(), number("default", &self.default)?, limits, self.join)
    }
}

/// The inputs of a model that is being built, by their names.
#[derive(Clone, Debug, Default)]
pub struct Inputs(Vec<Arc<Input>>);

impl Inputs {
    /// Makes the inputs of a scene; an error tells the number of its spec.
    pub(crate) fn build(specs: &[InputSpec]) -> Result<Self, (usize, BuildError)> {
        let mut all: Vec<Arc<Input>> = Vec::with_capacity(specs.len());
        for (k, spec) in specs.iter().enumerate() {
            let input = spec.build().map_err(|e| (k, e))?;
            if all.iter().any(|i| i.name() == input.name()) {
                let message = format!("there are two inputs named `{}`", input.name());
                return Err((k, BuildError::at("name", message)));
            }
            all.push(Arc::new(input));
        }
        Ok(Inputs(all))
    }

    /// All of them.
    pub fn all(&self) -> &[Arc<Input>] {
        &self.0
    }

    /// The number of the input of this name, which a `field` asks for.
    ///
    /// # Errors
    /// There is none.
    pub fn number(&self, field: &str, name: &str) -> Result<usize, BuildError> {
        self.0.iter().position(|i| i.name() == name).ok_or_else(|| {
            let names: Vec<&str> = self.0.iter().map(|i| i.name()).collect();
            let there: Vec<String> = names.iter().map(|n| format!("`{n}`")).collect();
            let there = match (there.is_empty(), did_you_mean(name, &names)) {
                (true, _) => "the scene has none: declare it in `[[inputs]]`".into(),
                (_, Some(guess)) => guess,
                _ => format!("the inputs are {}", there.join(", ")),
            };
            BuildError::at(field, format!("there is no input `{name}`; {there}"))
        })
    }

    /// What a `field` reads that has to be of this kind.
    ///
    /// # Errors
    /// There is no such input, or it has another unit.
    pub fn signal(&self, field: &str, setting: &Setting, kind: &Kind) -> Result<Signal, BuildError> {
        let name = match setting {
            Setting::Number(x) => return Ok(Signal::Constant(*x)),
            Setting::Input(name) => name,
        };
        let input = &self.0[self.number(field, name)?];
        let dimension = Dimension::of(input.unit()).unwrap_or_default();
        if !kind.fits(dimension) {
            let said =
                |unit: &str| if unit.is_empty() { "without unit".into() } else { format!("in {unit}") };
            let message = format!(
                "`{field}` is {}, {}, but the input `{name}` is {}",
                kind.name,
                said(kind.unit),
                said(input.unit())
            );
            return Err(BuildError::at(field, message));
        }
        Ok(Signal::Input(input.clone()))
    }
}
