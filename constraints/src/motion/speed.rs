//! A measured speed.

use super::csv::{self, Wanted};
use super::rows::{Wrong, check};
use crate::check::unit;
use ropewalk_core::reach::Knots;
use ropewalk_core::{BuildError, EndSlope, Interpolation, Join, Motion, Moving, V3};
use ropewalk_scene::quantity::kind;
use ropewalk_scene::{MotionSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A run along a straight line with speeds at given times. The way is the integral of the speed, the acceleration its
/// slope.
///
/// It is defined for the time of its rows only.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedTable {
    direction: V3<f64>,
    speed: Interpolation,
    knots: Knots,
}

impl SpeedTable {
    /// A run along `direction` (of any length) with these speeds [m/s] at these times [s].
    ///
    /// # Errors
    /// Fewer than two rows, times that don't ascend, numbers that aren't finite (the message gives the row, counted
    /// from 1), a direction without length.
    pub fn new(direction: V3<f64>, rows: &[[f64; 2]], join: Join) -> Result<Self, BuildError> {
        let direction = unit("direction", direction)?;
        check(rows).map_err(Wrong::in_scene)?;
        let (t, v): (Vec<f64>, Vec<f64>) = rows.iter().map(|r| (r[0], r[1])).unzip();
        let speed = Interpolation::new(&t, &v, join, [EndSlope::Natural; 2]);
        let at = |t: f64| [speed.at(t)[1], 0.0, 0.0];
        let knots = match join {
            Join::Linear => Knots::at_rows(&t, at),
            Join::Monotone | Join::Cubic => Knots::halfway(&t, at),
        };
        Ok(SpeedTable { direction, speed, knots })
    }
}

impl Motion for SpeedTable {
    fn at(&self, t: f64) -> Moving {
        let [x, v, a, _] = self.speed.at(t).map(|s| self.direction.map(|d| s * d));
        Moving { x, v, a }
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(self.knots.reach(t, h))
    }
    fn period(&self, t: f64) -> f64 {
        self.knots.period(t)
    }
    fn range(&self) -> (f64, f64) {
        let t = self.speed.times();
        (t[0], t[t.len() - 1])
    }
}

fn ahead() -> V3<f64> {
    [1.0, 0.0, 0.0]
}

/// Straight ahead with the speeds of a table, in the scene or in a CSV file: a measured launch, the speed of a winch.
///
/// The speed is piecewise linear, so the distance is the area under the table: 1 m from 0 to 1 m/s in 2 s. The
/// acceleration jumps at the rows, and steps end there; `join = "monotone"` smooths the speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeedTableSpec {
    /// Name; constraints refer to it.
    pub name: String,
    /// Direction of travel.
    #[serde(default = "ahead")]
    pub direction: V3<f64>,
    /// A CSV file, its path as seen from the scene file. Its first line names the columns, `t` and `v`, with their units
    /// in brackets (`t [s],v [kn]`) or without in s and m/s; other columns are left alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Times [s], ascending, instead of a file; the run must not go beyond the last.
    #[serde(default, deserialize_with = "quantity::list::time")]
    pub t: Vec<f64>,
    /// Speeds at these times [m/s].
    #[serde(default, deserialize_with = "quantity::list::speed")]
    pub v: Vec<f64>,
    /// Interpolation of the speeds.
    #[serde(default)]
    pub join: Join,
}
register_spec!(Motion, "speed_table", SpeedTableSpec);

/// Reads the columns `t` and `v` of a CSV file; the error gives file and line.
fn read(path: &str) -> Result<Vec<[f64; 2]>, BuildError> {
    let needed = true;
    let wanted =
        [Wanted { name: "t", kind: &kind::TIME, needed }, Wanted { name: "v", kind: &kind::SPEED, needed }];
    let table = csv::columns(path, wanted, "t [s],v [m/s]").map_err(BuildError::new)?;
    check(&table.rows).map_err(|e| e.in_file(path, &table.lines))?;
    Ok(table.rows)
}

#[typetag::serde(name = "speed_table")]
impl MotionSpec for SpeedTableSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        let rows: Vec<[f64; 2]> = match &self.file {
            Some(file) if self.t.is_empty() && self.v.is_empty() => read(file).map_err(|e| e.of("file"))?,
            Some(_) => return Err(BuildError::at("file", "give either a `file` or `t` and `v`")),
            None if self.t.len() != self.v.len() => {
                let message = format!("`v` has {} entries, but `t` has {}", self.v.len(), self.t.len());
                return Err(BuildError::at("v", message));
            }
            None => self.t.iter().zip(&self.v).map(|(t, v)| [*t, *v]).collect(),
        };
        let field = |e: BuildError| BuildError { field: e.field.or(Some("t".into())), ..e };
        Ok(Arc::new(SpeedTable::new(self.direction, &rows, self.join).map_err(field)?))
    }
}
