//! `[[run.statistics]]`: what is told of records in few numbers, and how much fatigue their cycles do.

use ropewalk_core::BuildError;
use ropewalk_core::error::positive;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Statistics of records: mean, deviation, extremes, waves and spectra, and with `fatigue` their cycles by rainflow counting and the
/// damage that these do. They stand on the page of the run and in `tables/statistics.csv`, spectra in
/// `tables/spectrum-RECORD.csv` and `plots/`, cycles in `tables/cycles-RECORD.csv`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StatisticsSpec {
    /// Columns of the history, or what their names begin with. Default: all.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub of: Vec<String>,
    /// From what time on [s]: behind the ramp of the sea.
    #[serde(deserialize_with = "ropewalk_quantity::time")]
    pub from: f64,
    /// Up to what time [s]. Default: the end of the run.
    #[serde(deserialize_with = "ropewalk_quantity::optional::time", skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// How many cycles what they show endures. Default: cycles aren't counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fatigue: Option<FatigueSpec>,
    /// Name of the table. Default: `statistics`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// How many cycles of tension (T-N) or stress (S-N) something endures: `N = k (range/strength)^-m`.
///
/// Give `breaking_load` or `stress`. Columns in other units are told without cycles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FatigueSpec {
    /// Number of cycles of a range as large as the strength: 316 of studless chain by API RP 2SK.
    #[serde(deserialize_with = "ropewalk_quantity::number")]
    pub k: f64,
    /// Slope.
    #[serde(deserialize_with = "ropewalk_quantity::number")]
    pub m: f64,
    /// The strength that ranges of tension are divided by [N].
    #[serde(
        default,
        deserialize_with = "ropewalk_quantity::optional::force",
        skip_serializing_if = "Option::is_none"
    )]
    pub breaking_load: Option<f64>,
    /// The stress that ranges of stress are divided by [Pa]: `1 MPa` where the curve is for MPa.
    #[serde(
        default,
        deserialize_with = "ropewalk_quantity::optional::pressure",
        skip_serializing_if = "Option::is_none"
    )]
    pub stress: Option<f64>,
    /// A second slope. Default: one slope for all ranges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub second_slope: Option<SecondSlope>,
    /// Let the mean of each cycle count, by Goodman: a range about the mean `M` does what `range/(1 - M/strength)` does about zero.
    #[serde(default)]
    pub mean_load: bool,
}

/// Where a fatigue curve bends, and how steep it is beyond.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SecondSlope {
    /// Beyond so many cycles.
    #[serde(deserialize_with = "ropewalk_quantity::number")]
    pub beyond: f64,
    /// Slope there.
    #[serde(deserialize_with = "ropewalk_quantity::number")]
    pub m: f64,
}

impl StatisticsSpec {
    /// Name of the table.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or("statistics")
    }

    /// What is wrong with the numbers of a run of this duration [s], if anything.
    ///
    /// # Errors
    /// A time that isn't in the run; numbers that make no fatigue curve.
    pub fn check(&self, duration: f64) -> Result<(), BuildError> {
        let to = self.to.unwrap_or(duration);
        if !(self.from >= 0.0 && self.from < to && to <= duration * (1.0 + 1e-12)) {
            let message = format!("statistics from {} s to {to} s of a run of {duration} s", self.from);
            return Err(BuildError::at("from", message));
        }
        let of = |e: BuildError| {
            let field = e.field.as_deref().map_or("fatigue".into(), |field| format!("fatigue.{field}"));
            e.of(field)
        };
        self.fatigue.map_or(Ok(()), |fatigue| fatigue.strength().map(drop).map_err(of))
    }
}

impl FatigueSpec {
    /// What ranges are divided by, and the unit of the records that have them.
    ///
    /// # Errors
    /// Numbers that make no fatigue curve.
    pub fn strength(&self) -> Result<(f64, &'static str), BuildError> {
        positive("k", self.k)?;
        positive("m", self.m)?;
        if let Some(second) = self.second_slope {
            positive("beyond", second.beyond).map_err(|e| e.of("second_slope.beyond"))?;
            positive("m", second.m).map_err(|e| e.of("second_slope.m"))?;
        }
        match (self.breaking_load, self.stress) {
            (Some(load), None) => Ok((positive("breaking_load", load)?, "N")),
            (None, Some(stress)) => Ok((positive("stress", stress)?, "Pa")),
            _ => {
                let message = "fatigue needs the `breaking_load` that ranges of tension are divided by, or the `stress` that \
                               ranges of stress are, one of both";
                Err(BuildError::new(message))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_for_tension_or_for_stress() {
        let load = FatigueSpec {
            k: 316.0,
            m: 3.0,
            breaking_load: Some(5e6),
            stress: None,
            second_slope: None,
            mean_load: false,
        };
        assert_eq!(load.strength().unwrap(), (5e6, "N"));
        let both = FatigueSpec { stress: Some(1e6), ..load };
        assert!(both.strength().unwrap_err().message.contains("one of both"));
        let neither = FatigueSpec { breaking_load: None, ..load };
        assert!(neither.strength().is_err());
        for wrong in [f64::NAN, 0.0, -3.0] {
            assert!(FatigueSpec { m: wrong, ..load }.strength().is_err());
            assert!(FatigueSpec { breaking_load: Some(wrong), ..load }.strength().is_err());
        }
        let spec = StatisticsSpec { from: 5.0, fatigue: Some(load), ..StatisticsSpec::default() };
        assert!(spec.check(20.0).is_ok());
        assert!(spec.check(5.0).is_err(), "no time is left");
        assert!(StatisticsSpec { to: Some(30.0), ..spec }.check(20.0).is_err(), "beyond the end");
    }
}
