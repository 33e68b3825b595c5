//! A PID controller, sampled.

use super::channels::{Bound, Channels};
use super::sampled::{Act, sampled};
use crate::register_spec;
use crate::spec::ControllerSpec;
use ropewalk_core::error::{need, not_negative};
use ropewalk_core::{BuildError, Controller, Sample};
use ropewalk_quantity::{self as quantity, Dimension, Formula};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A PID controller: sets an input by what a record lacks of a setpoint, at regular instants.
///
/// With the error `e = setpoint - measures` it is `u = bias + kp e + I + D`. The integral `I` grows by `ki e every`, but not
/// further into a limit that `u` is at (anti-windup). `D` is `-kd` times the rate of what is measured, through a filter of
/// first order (Åström and Hägglund, Advanced PID Control, 2006, ch. 13: backward differences). The first instant has no rate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PidSpec {
    /// The input that it sets.
    pub input: String,
    /// What it measures: a column of a record such as `rope.start.tension`, or a formula of columns and of the time `t`; one
    /// with other signs than letters, digits, dots and underscores stands in braces.
    pub measures: Formula,
    /// What that is to be: a number, or a formula of columns and of the time `t`.
    pub setpoint: Formula,
    /// Proportional gain, in units of the input over those of what is measured: `"2 m/s / 1 kN"`.
    #[serde(default)]
    pub kp: Formula,
    /// Integral gain, the same over seconds.
    #[serde(default)]
    pub ki: Formula,
    /// Derivative gain, the same times seconds.
    #[serde(default)]
    pub kd: Formula,
    /// Time constant of the filter of the rate [s].
    #[serde(default, deserialize_with = "quantity::time")]
    pub filter: f64,
    /// What is added: a number, or a formula.
    #[serde(default)]
    pub bias: Formula,
    /// Time from one instant to the next [s].
    #[serde(deserialize_with = "quantity::time")]
    pub every: f64,
    /// Least value that it sets. Default: the limit of the input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<Formula>,
    /// Largest value that it sets. Default: the limit of the input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<Formula>,
    /// Name in messages. Default: that of the input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}
register_spec!(Controller, "pid", PidSpec);

struct Pid {
    every: f64,
    measures: Bound,
    setpoint: Bound,
    bias: Bound,
    gains: [f64; 3],
    filter: f64,
    limits: [f64; 2],
}

#[typetag::serde(name = "pid")]
impl ControllerSpec for PidSpec {
    fn input(&self) -> &str {
        &self.input
    }
    fn build(&self, c: &Channels<'_>) -> Result<Arc<dyn Controller>, BuildError> {
        let (_, input) = c.input(&self.input)?;
        let of_input = Dimension::of(input.unit()).unwrap_or_default();
        let measures = c.bind("measures", &self.measures, None)?;
        let constant = |field: &'static str, x: &Formula, of: Dimension| {
            x.in_unit(&of.unit()).map_err(|what| BuildError::at(field, format!("`{field}`: {what}")))
        };
        let gain = of_input.over(measures.dimension);
        let second = Dimension::new(0, 0, 1, 0);
        let gains = [
            constant("kp", &self.kp, gain)?,
            constant("ki", &self.ki, gain.over(second))?,
            constant("kd", &self.kd, gain.over(Dimension::default().over(second)))?,
        ];
        let [least, most] = input.limits();
        let limit = |field, x: &Option<Formula>, none: f64| {
            x.as_ref().map_or(Ok(none), |x| constant(field, x, of_input))
        };
        let limits = [limit("min", &self.min, least)?.max(least), limit("max", &self.max, most)?.min(most)];
        need(limits[0] <= limits[1], || format!("`min` must not be above `max`, but they are {limits:?}"))
            .map_err(|e| e.of("min"))?;
        let act = Pid {
            every: self.every,
            setpoint: c.bind("setpoint", &self.setpoint, Some(measures.dimension))?,
            bias: c.bind("bias", &self.bias, Some(of_input))?,
            measures,
            gains,
            filter: not_negative("filter", self.filter)?,
            limits,
        };
        sampled(c, &self.input, &self.name, self.every, act)
    }
}

impl Act for Pid {
    /// Whether it has begun, the integral, the last measured value, the filtered rate.
    const MEMORY: usize = 4;
    fn sees(&self) -> Vec<&Bound> {
        vec![&self.measures, &self.setpoint, &self.bias]
    }
    fn act(&self, sample: &Sample<'_>, memory: &mut [f64]) -> f64 {
        let [begun, integral, last, rate] = memory else { return f64::NAN };
        let ([kp, ki, kd], [least, most]) = (self.gains, self.limits);
        let measured = self.measures.value(sample);
        let error = self.setpoint.value(sample) - measured;
        if *begun == 0.0 {
            (*begun, *last) = (1.0, measured);
        }
        *rate = (self.filter * *rate + measured - *last) / (self.filter + self.every);
        *last = measured;
        let rest = self.bias.value(sample) + kp * error - kd * *rate;
        let grown = *integral + ki * error * self.every;
        // an integral that would only push further into a limit stays what it is
        let (wanted, push) = (rest + grown, grown - *integral);
        if !(wanted > most && push > 0.0 || wanted < least && push < 0.0) {
            *integral = grown;
        }
        let value = rest + *integral;
        if value.is_nan() { value } else { value.clamp(least, most) }
    }
}
