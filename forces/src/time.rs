//! Factors that change with time.

use crate::signals::rate;
use ropewalk_core::error::{finite, need};
use ropewalk_core::reach::Knots;
use ropewalk_core::{BuildError, EndSlope, Interpolation, Join, Signal, V3, reach};
use ropewalk_scene::quantity::{self, Kind, Setting, kind};
use ropewalk_scene::{Builder, Inputs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::OnceLock;

/// A factor of a load as a function of time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum TimeFunction {
    /// 1 at all times.
    #[default]
    Constant,
    /// From one value to another with continuous first and second derivative (quintic step), constant outside.
    Ramp {
        /// Value up to `t0`.
        from: f64,
        /// Value from `t1` on.
        to: f64,
        /// Start of the ramp [s].
        #[serde(deserialize_with = "quantity::time")]
        t0: f64,
        /// End of the ramp [s].
        #[serde(deserialize_with = "quantity::time")]
        t1: f64,
    },
    /// Values at given times, joined by straight lines unless `join` says otherwise; constant before the first and after
    /// the last.
    Table(TimeTable),
    /// 0 up to `t0`, rises to 1 at `peak`, falls to 0 at `t1` and stays there.
    Triangle {
        /// Start [s].
        #[serde(deserialize_with = "quantity::time")]
        t0: f64,
        /// Time of the value 1 [s].
        #[serde(deserialize_with = "quantity::time")]
        peak: f64,
        /// End [s].
        #[serde(deserialize_with = "quantity::time")]
        t1: f64,
    },
    /// `mean + amplitude sin(2π frequency t + phase)`.
    Harmonic {
        /// Mean value.
        mean: f64,
        /// Amplitude.
        amplitude: f64,
        /// Frequency [Hz].
        #[serde(deserialize_with = "quantity::frequency")]
        frequency: f64,
        /// Phase at `t = 0` [rad].
        #[serde(deserialize_with = "quantity::angle")]
        phase: f64,
    },
    /// What an input without unit is set to while the run goes on: its name.
    Input(TimeInput),
}

/// An input that a load reads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct TimeInput {
    /// Its name.
    pub name: String,
    /// What it is set to, once the load has been built.
    #[serde(skip)]
    signal: Option<Signal>,
}

/// Values of a load at given times.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimeTable {
    /// Times [s], ascending.
    #[serde(deserialize_with = "quantity::list::time")]
    pub t: Vec<f64>,
    /// Value at each time.
    pub value: Vec<f64>,
    /// Interpolation of the values.
    #[serde(default)]
    pub join: Join,
    /// The curve through them, and what steps must not leap over of it; made when it is first asked for.
    #[serde(skip)]
    curve: OnceLock<Box<(Interpolation, Knots)>>,
}

impl TimeTable {
    /// Joins these values at these times.
    pub fn new(t: Vec<f64>, value: Vec<f64>, join: Join) -> Self {
        TimeTable { t, value, join, curve: OnceLock::new() }
    }
    fn check(&self) -> Result<(), BuildError> {
        let (n, m) = (self.t.len(), self.value.len());
        need(n == m, || format!("table of a load has {n} times but {m} values"))?;
        need(n > 0, || "table of a load has no entry; give one at least".into())?;
        finite("times of a load's table", &self.t)?;
        finite("values of a load's table", &self.value)?;
        need(self.t.windows(2).all(|t| t[0] < t[1]), || "times of a load's table must ascend".into())
    }
    fn curve(&self) -> &(Interpolation, Knots) {
        self.curve.get_or_init(|| {
            let curve = Interpolation::new(&self.t, &self.value, self.join, [EndSlope::Natural; 2]);
            let at = |t: f64| [curve.at(t)[1], 0.0, 0.0];
            let knots = match self.join {
                Join::Linear => Knots::at_rows(&self.t, at),
                Join::Monotone | Join::Cubic => Knots::halfway(&self.t, at),
            };
            Box::new((curve, knots))
        })
    }
    fn at(&self, t: f64) -> f64 {
        let (Some(first), Some(last)) = (self.t.first(), self.t.last()) else { return 0.0 };
        self.curve().0.at(t.clamp(*first, *last))[1]
    }
    fn rate(&self, t: f64) -> f64 {
        match (self.t.first(), self.t.last()) {
            (Some(first), Some(last)) if t >= *first && t < *last => self.curve().0.at(t)[2],
            _ => 0.0,
        }
    }
}

impl TimeFunction {
    /// A table of values at ascending times [s], joined by straight lines.
    pub fn table(t: Vec<f64>, value: Vec<f64>) -> Self {
        TimeFunction::Table(TimeTable::new(t, value, Join::Linear))
    }

    /// What an input of this name is set to; a load binds it to the scene's.
    pub fn input(name: &str) -> Self {
        TimeFunction::Input(TimeInput { name: name.into(), signal: None })
    }

    /// What a signal is set to, in place of a factor.
    pub fn of(signal: Signal) -> Self {
        TimeFunction::Input(TimeInput { name: String::new(), signal: Some(signal) })
    }

    /// The same, bound to the inputs of a scene.
    ///
    /// # Errors
    /// There is no such input, or it has a unit.
    pub fn bound(&self, inputs: &Inputs) -> Result<Self, BuildError> {
        let TimeFunction::Input(TimeInput { name, .. }) = self else { return Ok(self.clone()) };
        Ok(Self::of(inputs.signal("time", &Setting::Input(name.clone()), &kind::NUMBER)?))
    }

    /// Whether its numbers make sense; loads that are given a function ask for this.
    ///
    /// # Errors
    /// Times that don't ascend, lists of different length, no entry, numbers that aren't finite.
    pub fn check(&self) -> Result<(), BuildError> {
        // the field of every spec that has one
        self.numbers().map_err(|e| e.of("time"))
    }

    fn numbers(&self) -> Result<(), BuildError> {
        match self {
            TimeFunction::Constant => Ok(()),
            TimeFunction::Ramp { from, to, t0, t1 } => {
                finite("ramp of a load", &[*from, *to, *t0, *t1])?;
                need(t0 < t1, || format!("ramp of a load must end after its start {t0} s, not at {t1} s"))
            }
            TimeFunction::Table(table) => table.check(),
            TimeFunction::Triangle { t0, peak, t1 } => {
                finite("triangle of a load", &[*t0, *peak, *t1])?;
                need(t0 < peak && peak < t1, || "triangle of a load needs t0 < peak < t1".into())
            }
            TimeFunction::Harmonic { mean, amplitude, frequency, phase } => {
                finite("harmonic of a load", &[*mean, *amplitude, *frequency, *phase])
            }
            TimeFunction::Input(TimeInput { signal: Some(_), .. }) => Ok(()),
            TimeFunction::Input(TimeInput { name, .. }) => Err(BuildError::new(format!(
                "this load can't be set by the input `{name}`: give it a table instead"
            ))),
        }
    }

    /// Whether it changes at all.
    pub fn changes(&self) -> bool {
        !matches!(self, TimeFunction::Constant)
    }

    /// How much of a step `h` from `t` may be taken that leaps over nothing [s].
    pub fn reach(&self, t: f64, h: f64) -> f64 {
        match self {
            TimeFunction::Constant => h,
            TimeFunction::Ramp { t0, t1, .. } => reach::rise(*t0, *t1, t, h),
            TimeFunction::Table(table) => table.curve().1.reach(t, h),
            TimeFunction::Triangle { t0, peak, t1 } => {
                reach::knots(&[*t0, *peak, *t1], |k| [[0.0, 1.0, 0.0][k], 0.0, 0.0], 1.0, t, h)
            }
            TimeFunction::Harmonic { .. } => reach::period(self.period(), h),
            TimeFunction::Input(input) => input.signal.as_ref().map_or(h, |s| s.reach(t, h)),
        }
    }

    /// The period with which it goes to and fro [s], infinite if it doesn't.
    pub fn period(&self) -> f64 {
        match self {
            TimeFunction::Harmonic { amplitude, frequency, .. } if *amplitude != 0.0 => 1.0 / frequency.abs(),
            _ => f64::INFINITY,
        }
    }

    /// The factor at time `t` [s].
    #[inline]
    pub fn at(&self, t: f64) -> f64 {
        match self {
            TimeFunction::Constant => 1.0,
            TimeFunction::Ramp { from, to, t0, t1 } => {
                let u = ((t - t0) / (t1 - t0)).clamp(0.0, 1.0);
                from + (to - from) * u * u * u * (10.0 + u * (6.0 * u - 15.0))
            }
            TimeFunction::Table(table) => table.at(t),
            TimeFunction::Triangle { t0, peak, t1 } => {
                ((t - t0) / (peak - t0)).min((t1 - t) / (t1 - peak)).max(0.0)
            }
            TimeFunction::Harmonic { mean, amplitude, frequency, phase } => {
                mean + amplitude * (TAU * frequency * t + phase).sin()
            }
            TimeFunction::Input(input) => input.signal.as_ref().map_or(f64::NAN, |s| s.at(t)),
        }
    }

    /// How fast the factor changes at time `t` [1/s].
    pub fn rate(&self, t: f64) -> f64 {
        match self {
            TimeFunction::Constant => 0.0,
            TimeFunction::Ramp { from, to, t0, t1 } => {
                let u = ((t - t0) / (t1 - t0)).clamp(0.0, 1.0);
                30.0 * (to - from) / (t1 - t0) * (u * (1.0 - u)).powi(2)
            }
            TimeFunction::Table(table) => table.rate(t),
            TimeFunction::Triangle { t0, peak, t1 } => match t {
                t if t < *t0 || t >= *t1 => 0.0,
                t if t < *peak => 1.0 / (peak - t0),
                _ => -1.0 / (t1 - peak),
            },
            TimeFunction::Harmonic { amplitude, frequency, phase, .. } => {
                TAU * frequency * amplitude * (TAU * frequency * t + phase).cos()
            }
            TimeFunction::Input(input) => input.signal.as_ref().map_or(f64::NAN, |s| rate(s, t)),
        }
    }
}

/// Takes a vector apart that may read inputs: loads that together make it, each a vector times a function of time.
///
/// # Errors
/// There is no such input, or it is of another kind; inputs beside a function of time.
pub(crate) fn apart(
    b: &Builder,
    field: &str,
    vector: &[Setting; 3],
    kind: &Kind,
    time: &TimeFunction,
) -> Result<Vec<(V3<f64>, TimeFunction)>, BuildError> {
    let given: V3<f64> = std::array::from_fn(|i| vector[i].number().unwrap_or(0.0));
    let read: Vec<usize> = (0..3).filter(|&i| vector[i].number().is_none()).collect();
    let mut all = Vec::new();
    if read.is_empty() || given != [0.0; 3] {
        all.push((given, time.bound(b.inputs())?));
    }
    if !read.is_empty() && time.changes() {
        let message =
            format!("`{field}` reads inputs, and so has no factor: leave out `time`, or give numbers");
        return Err(BuildError::at("time", message));
    }
    for i in read {
        let axis = std::array::from_fn(|j| if j == i { 1.0 } else { 0.0 });
        all.push((axis, TimeFunction::of(b.signal(field, &vector[i], kind)?)));
    }
    Ok(all)
}
