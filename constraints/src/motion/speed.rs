//! A measured speed.

use super::csv;
use crate::check::unit;
use ropewalk_core::build::{BuildError, finite};
use ropewalk_core::quantity::kind;
use ropewalk_core::{Motion, MotionSpec, Moving, V3, quantity, reach, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A run along a straight line with speeds at given times, joined by cubics: the speed has a continuous derivative, so
/// the position has two. Between two equal speeds it is constant and it never overshoots (Fritsch and Butland 1984).
///
/// It is defined for the time of its rows only.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedTable {
    direction: V3<f64>,
    t: Vec<f64>,
    v: Vec<f64>,
    /// Acceleration and way at each time.
    a: Vec<f64>,
    x: Vec<f64>,
}

impl SpeedTable {
    /// A run along `direction` (of any length) with these speeds [m/s] at these times [s].
    ///
    /// # Errors
    /// Fewer than two rows, times that don't ascend, numbers that aren't finite (the message gives the row, counted
    /// from 1), a direction without length.
    pub fn new(direction: V3<f64>, rows: &[[f64; 2]]) -> Result<Self, BuildError> {
        let direction = unit("direction", direction)?;
        check(rows).map_err(|(row, message)| match row {
            Some(row) => BuildError::new(format!("row {}: {message}", row + 1)),
            None => BuildError::new(message),
        })?;
        let (t, v): (Vec<f64>, Vec<f64>) = rows.iter().map(|r| (r[0], r[1])).unzip();
        let a = slopes(&t, &v);
        let mut x = vec![0.0];
        for k in 1..t.len() {
            let h = t[k] - t[k - 1];
            // the integral of a cubic from its ends
            let way = 0.5 * h * (v[k - 1] + v[k]) + h * h / 12.0 * (a[k - 1] - a[k]);
            x.push(x[k - 1] + way);
        }
        Ok(SpeedTable { direction, t, v, a, x })
    }
}

/// What is wrong with a table of times and speeds, and in which row.
fn check(rows: &[[f64; 2]]) -> Result<(), (Option<usize>, String)> {
    if rows.len() < 2 {
        return Err((None, format!("a table of speeds needs two rows or more, not {}", rows.len())));
    }
    for (k, row) in rows.iter().enumerate() {
        finite("the row", row).map_err(|e| (Some(k), e.message))?;
        if k > 0 && !(row[0] > rows[k - 1][0]) {
            let message = format!("times must ascend, but {} s comes after {} s", row[0], rows[k - 1][0]);
            return Err((Some(k), message));
        }
    }
    Ok(())
}

/// Slopes with which cubics between the rows don't overshoot: the weighted harmonic mean of the slopes on both sides,
/// zero where these differ in sign.
fn slopes(t: &[f64], v: &[f64]) -> Vec<f64> {
    let n = t.len();
    let h = |k: usize| t[k + 1] - t[k];
    let d = |k: usize| (v[k + 1] - v[k]) / h(k);
    if n == 2 {
        return vec![d(0); 2];
    }
    // at an end: that of the parabola through three rows, limited
    let end = |h0: f64, h1: f64, d0: f64, d1: f64| {
        let slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
        if slope * d0 <= 0.0 {
            0.0
        } else if d0 * d1 <= 0.0 && slope.abs() > 3.0 * d0.abs() {
            3.0 * d0
        } else {
            slope
        }
    };
    let inner = |k: usize| {
        let (before, after) = (d(k - 1), d(k));
        if before * after <= 0.0 {
            return 0.0;
        }
        let (w1, w2) = (2.0 * h(k) + h(k - 1), h(k) + 2.0 * h(k - 1));
        (w1 + w2) / (w1 / before + w2 / after)
    };
    (0..n)
        .map(|k| match k {
            0 => end(h(0), h(1), d(0), d(1)),
            k if k == n - 1 => end(h(n - 2), h(n - 3), d(n - 2), d(n - 3)),
            k => inner(k),
        })
        .collect()
}

impl Motion for SpeedTable {
    fn at(&self, t: f64) -> Moving {
        // beyond its ends the first and last pieces go on, so that rounding of the last time does no harm
        let k = self.t.partition_point(|&x| x <= t).clamp(1, self.t.len() - 1) - 1;
        let (h, u) = (self.t[k + 1] - self.t[k], (t - self.t[k]) / (self.t[k + 1] - self.t[k]));
        let (v0, v1, a0, a1) = (self.v[k], self.v[k + 1], h * self.a[k], h * self.a[k + 1]);
        // v = v0 + a0 u + b u² + c u³
        let (b, c) = (3.0 * (v1 - v0) - 2.0 * a0 - a1, 2.0 * (v0 - v1) + a0 + a1);
        let x = self.x[k] + h * u * (v0 + u * (a0 / 2.0 + u * (b / 3.0 + u * c / 4.0)));
        let v = v0 + u * (a0 + u * (b + u * c));
        let a = (a0 + u * (2.0 * b + 3.0 * u * c)) / h;
        let along = |s: f64| self.direction.map(|d| s * d);
        Moving { x: along(x), v: along(v), a: along(a) }
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        let size = self.v.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        Some(reach::knots(&self.t, |k| [self.v[k], 0.0, 0.0], size, t, h))
    }
    fn range(&self) -> (f64, f64) {
        (self.t[0], self.t[self.t.len() - 1])
    }
}

fn ahead() -> V3<f64> {
    [1.0, 0.0, 0.0]
}

/// Runs straight ahead with the speeds of a table, in the scene or in a CSV file: a measured launch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeedTableSpec {
    /// Name, by which constraints refer to it.
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
}
register_spec!(Motion, "speed_table", SpeedTableSpec);

/// Reads the columns `t` and `v` of a CSV file; the error gives file and line.
fn read(path: &str) -> Result<Vec<[f64; 2]>, String> {
    let (rows, lines) = csv::columns(path, [("t", &kind::TIME), ("v", &kind::SPEED)])?;
    check(&rows).map_err(|(row, message)| match row {
        Some(k) => format!("{path}, line {}: {message}", lines[k]),
        None => format!("{path}: {message}"),
    })?;
    Ok(rows)
}

#[typetag::serde(name = "speed_table")]
impl MotionSpec for SpeedTableSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self) -> Result<Arc<dyn Motion>, BuildError> {
        let rows: Vec<[f64; 2]> = match &self.file {
            Some(file) if self.t.is_empty() && self.v.is_empty() => {
                read(file).map_err(|e| BuildError::at("file", e))?
            }
            Some(_) => return Err(BuildError::at("file", "give either a `file` or `t` and `v`")),
            None if self.t.len() != self.v.len() => {
                let message = format!("`v` has {} entries, but `t` has {}", self.v.len(), self.t.len());
                return Err(BuildError::at("v", message));
            }
            None => self.t.iter().zip(&self.v).map(|(t, v)| [*t, *v]).collect(),
        };
        let field = |e: BuildError| BuildError { field: e.field.or(Some("t".into())), ..e };
        Ok(Arc::new(SpeedTable::new(self.direction, &rows).map_err(field)?))
    }
}
