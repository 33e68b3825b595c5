//! Factors that change with time.

use ropewalk_core::build::{BuildError, finite, need};
use ropewalk_core::{quantity, reach};
use std::f64::consts::TAU;

/// A factor of a load as a function of time.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
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
    /// Linear between given times, constant before the first and after the last.
    Table {
        /// Times [s], ascending.
        #[serde(deserialize_with = "quantity::list::time")]
        t: Vec<f64>,
        /// Value at each time.
        value: Vec<f64>,
    },
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
}

impl TimeFunction {
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
            TimeFunction::Table { t, value } => {
                let (n, m) = (t.len(), value.len());
                need(n == m, || format!("table of a load has {n} times but {m} values"))?;
                need(n > 0, || "table of a load has no entry; give one at least".into())?;
                finite("times of a load's table", t)?;
                finite("values of a load's table", value)?;
                need(t.windows(2).all(|t| t[0] < t[1]), || "times of a load's table must ascend".into())
            }
            TimeFunction::Triangle { t0, peak, t1 } => {
                finite("triangle of a load", &[*t0, *peak, *t1])?;
                need(t0 < peak && peak < t1, || "triangle of a load needs t0 < peak < t1".into())
            }
            TimeFunction::Harmonic { mean, amplitude, frequency, phase } => {
                finite("harmonic of a load", &[*mean, *amplitude, *frequency, *phase])
            }
        }
    }

    /// Whether it changes at all.
    pub fn changes(&self) -> bool {
        !matches!(self, TimeFunction::Constant)
    }

    /// How much of a step `h` from `t` may be taken that leaps over nothing [s].
    pub fn reach(&self, t: f64, h: f64) -> f64 {
        let knots = |times: &[f64], value: &[f64]| {
            let range =
                value.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &x| (x.min(a), x.max(b)));
            reach::knots(times, |k| [value[k], 0.0, 0.0], range.1 - range.0, t, h)
        };
        match self {
            TimeFunction::Constant => h,
            TimeFunction::Ramp { t0, t1, .. } => reach::rise(*t0, *t1, t, h),
            TimeFunction::Table { t: times, value } => knots(times, value),
            TimeFunction::Triangle { t0, peak, t1 } => knots(&[*t0, *peak, *t1], &[0.0, 1.0, 0.0]),
            TimeFunction::Harmonic { frequency, .. } => reach::period(1.0 / frequency, h),
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
            TimeFunction::Table { t: times, value } => table(times, value, t),
            TimeFunction::Triangle { t0, peak, t1 } => table(&[*t0, *peak, *t1], &[0.0, 1.0, 0.0], t),
            TimeFunction::Harmonic { mean, amplitude, frequency, phase } => {
                mean + amplitude * (TAU * frequency * t + phase).sin()
            }
        }
    }
}

fn table(times: &[f64], value: &[f64], t: f64) -> f64 {
    let n = times.len().min(value.len());
    let k = times[..n].partition_point(|&x| x <= t);
    match (k, n) {
        (_, 0) => 0.0,
        (0, _) => value[0],
        (k, n) if k == n => value[n - 1],
        _ => value[k - 1] + (value[k] - value[k - 1]) * (t - times[k - 1]) / (times[k] - times[k - 1]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_between_and_beyond() {
        let ramp = TimeFunction::Ramp { from: 2.0, to: 4.0, t0: 1.0, t1: 3.0 };
        assert_eq!([0.0, 1.0, 2.0, 3.0, 9.0].map(|t| ramp.at(t)), [2.0, 2.0, 3.0, 4.0, 4.0]);
        let triangle = TimeFunction::Triangle { t0: 1.0, peak: 2.0, t1: 4.0 };
        assert_eq!([0.0, 1.5, 2.0, 3.0, 4.0, 5.0].map(|t| triangle.at(t)), [0.0, 0.5, 1.0, 0.5, 0.0, 0.0]);
        let harmonic = TimeFunction::Harmonic { mean: 1.0, amplitude: 2.0, frequency: 0.25, phase: 0.0 };
        assert_eq!(harmonic.at(1.0), 3.0);
        assert_eq!(TimeFunction::default().at(7.0), 1.0);
    }

    #[test]
    fn bad_functions_are_refused() {
        let bad = [
            TimeFunction::Ramp { from: 0.0, to: 1.0, t0: 1.0, t1: 1.0 },
            TimeFunction::Table { t: vec![], value: vec![] },
            TimeFunction::Table { t: vec![0.0, 0.0], value: vec![1.0, 2.0] },
            TimeFunction::Table { t: vec![0.0], value: vec![f64::NAN] },
            TimeFunction::Triangle { t0: 0.0, peak: 3.0, t1: 2.0 },
        ];
        assert!(bad.iter().all(|f| f.check().is_err()));
    }
}
