//! A measured or computed motion.

use super::csv::{self, Wanted};
use super::rows::{Wrong, check};
use ropewalk_core::reach::Knots;
use ropewalk_core::{BuildError, EndSlope, Interpolation, Join, Motion, Moving};
use ropewalk_scene::quantity::kind;
use ropewalk_scene::{MotionSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What a table of displacements does at its ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Ends {
    /// It comes and goes as the rows there do: a record cut out of a longer one. A cubic spline has no acceleration there.
    #[default]
    Natural,
    /// No velocity at either end.
    AtRest,
    /// Starts without velocity and ends as it comes: a manoeuvre from rest.
    FromRest,
}

/// Displacements at given times, joined by cubics with a continuous velocity.
///
/// Rows are displacements from where the driven marker starts, so the first one is usually zero. It is defined for the
/// time of its rows only.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Along each axis.
    along: [Interpolation; 3],
    knots: Knots,
}

/// Slopes that differ by less than this part of the largest are the same.
const SAME_SLOPE: f64 = 1e-9;

impl Table {
    /// A curve through rows of time [s] and displacement `x, y, z` [m].
    ///
    /// # Errors
    /// Fewer than two rows, times that don't ascend, numbers that aren't finite (the message gives the row, counted from
    /// 1); straight lines whose velocity jumps.
    pub fn new(rows: &[[f64; 4]], join: Join, ends: Ends) -> Result<Self, BuildError> {
        Self::through(rows, join, ends).map_err(Wrong::in_scene)
    }

    fn through(rows: &[[f64; 4]], join: Join, ends: Ends) -> Result<Self, Wrong> {
        check(rows)?;
        let rest = |is: bool| if is { EndSlope::Given(0.0) } else { EndSlope::Natural };
        let ends = [rest(ends != Ends::Natural), rest(ends == Ends::AtRest)];
        let t: Vec<f64> = rows.iter().map(|r| r[0]).collect();
        let along: [Interpolation; 3] = std::array::from_fn(|c| {
            let x: Vec<f64> = rows.iter().map(|r| r[c + 1]).collect();
            Interpolation::new(&t, &x, join, ends)
        });
        if let (Join::Linear, Some(k)) = (join, kink(&along)) {
            let message = format!(
                "joined by straight lines, the velocity would jump at {} s, which no finite force can follow: take \
                 `join = \"monotone\"` or `\"cubic\"`, or give speeds in a `speed_table`",
                t[k]
            );
            return Err(Wrong::new(k, message));
        }
        let derivative = |order: usize| {
            let along = &along;
            move |t: f64| [0, 1, 2].map(|c| along[c].at(t)[1 + order])
        };
        let knots = match join {
            // its acceleration is made of straight lines
            Join::Cubic => Knots::at_rows(&t, derivative(2)),
            Join::Linear | Join::Monotone => Knots::halfway(&t, derivative(1)),
        };
        Ok(Table { along, knots })
    }
}

/// The first row at which the slope jumps.
fn kink(along: &[Interpolation; 3]) -> Option<usize> {
    let size = along.iter().flat_map(Interpolation::slopes).flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let jumps =
        |k: usize| along.iter().any(|x| (x.slopes()[k][0] - x.slopes()[k - 1][1]).abs() > SAME_SLOPE * size);
    (1..along[0].slopes().len()).find(|k| jumps(*k))
}

impl Motion for Table {
    fn at(&self, t: f64) -> Moving {
        let [x, y, z] = [0, 1, 2].map(|c| self.along[c].at(t));
        Moving { x: [x[1], y[1], z[1]], v: [x[2], y[2], z[2]], a: [x[3], y[3], z[3]] }
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(self.knots.reach(t, h))
    }
    fn period(&self, t: f64) -> f64 {
        self.knots.period(t)
    }
    fn range(&self) -> (f64, f64) {
        let t = self.along[0].times();
        (t[0], t[t.len() - 1])
    }
}

fn monotone() -> Join {
    Join::Monotone
}

/// Follows a table of displacements, in the scene or in a CSV file, or a table of angles for the constraint `rotation`.
///
/// Between rows it never overshoots. The acceleration jumps at the rows, unless `join = "cubic"`: choose that for
/// smooth records with many rows, such as the heave of a ship. For a table of speeds use `speed_table`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TableSpec {
    /// Name; constraints refer to it.
    pub name: String,
    /// A CSV file, its path as seen from the scene file. Its first line names the columns, `t` and any of `x`, `y`, `z`, or
    /// `angle`, with their units in brackets (`t [s],z [cm]`, `t [s],angle [deg]`) or without in s, m and rad; other
    /// columns are left alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Times [s], ascending, instead of a file; the run must not go beyond the last.
    #[serde(default, deserialize_with = "quantity::list::time")]
    pub t: Vec<f64>,
    /// Displacements along x at these times [m]. Default: none.
    #[serde(default, deserialize_with = "quantity::list::length")]
    pub x: Vec<f64>,
    /// Displacements along y [m].
    #[serde(default, deserialize_with = "quantity::list::length")]
    pub y: Vec<f64>,
    /// Displacements along z [m].
    #[serde(default, deserialize_with = "quantity::list::length")]
    pub z: Vec<f64>,
    /// Angles at these times, instead of displacements, for the constraint `rotation` [rad]. Degrees are written with their
    /// unit: `"90 deg"`.
    #[serde(default, deserialize_with = "quantity::list::angle", skip_serializing_if = "Vec::is_empty")]
    pub angle: Vec<f64>,
    /// Interpolation between the rows. `linear` is accepted only if all rows lie on one line, since the velocity
    /// would jump.
    #[serde(default = "monotone")]
    pub join: Join,
    /// Condition at its ends.
    #[serde(default)]
    pub ends: Ends,
}
register_spec!(Motion, "table", TableSpec);

const TURNED_AND_MOVED: &str =
    "give an `angle` or displacements `x`, `y`, `z`, not both: a motion has one unit";

impl TableSpec {
    /// Rows of time and displacement out of the lists.
    fn rows(&self) -> Result<Vec<[f64; 4]>, BuildError> {
        let columns = [("x", &self.x), ("y", &self.y), ("z", &self.z), ("angle", &self.angle)];
        for (name, column) in columns {
            if !column.is_empty() && column.len() != self.t.len() {
                let message = format!("`{name}` has {} entries, but `t` has {}", column.len(), self.t.len());
                return Err(BuildError::at(name, message));
            }
        }
        let turns = !self.angle.is_empty();
        if turns && columns[..3].iter().any(|(_, column)| !column.is_empty()) {
            return Err(BuildError::at("angle", TURNED_AND_MOVED));
        }
        let of = |column: &[f64], k: usize| column.get(k).copied().unwrap_or(0.0);
        let first = if turns { &self.angle } else { &self.x };
        let row = |k: usize| [self.t[k], of(first, k), of(&self.y, k), of(&self.z, k)];
        Ok((0..self.t.len()).map(row).collect())
    }
}

/// Rows of time and displacement out of a CSV file, and their lines.
fn read(path: &str) -> Result<(Vec<[f64; 4]>, Vec<usize>), String> {
    let length = |name| Wanted { name, kind: &kind::LENGTH, needed: false };
    let wanted = [
        Wanted { name: "t", kind: &kind::TIME, needed: true },
        length("x"),
        length("y"),
        length("z"),
        Wanted { name: "angle", kind: &kind::ANGLE, needed: false },
    ];
    let csv::Columns { rows, lines, found, header } = csv::columns(path, wanted, "t [s],z [m]")?;
    match (found[1..4].contains(&true), found[4]) {
        (true, true) => Err(format!("{path}, line {header}: {TURNED_AND_MOVED}")),
        (false, false) => Err(format!(
            "{path}, line {header}: there is no column `x`, `y`, `z` or `angle`; the first line must be like `t [s],z [m]` \
             or `t [s],angle [deg]`"
        )),
        _ => Ok((rows.into_iter().map(|[t, x, y, z, angle]| [t, x + angle, y, z]).collect(), lines)),
    }
}

#[typetag::serde(name = "table")]
impl MotionSpec for TableSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        if self.join == Join::Linear && self.ends != Ends::Natural {
            let message = "straight lines have no other ends: leave `ends` out, or take another `join`";
            return Err(BuildError::at("ends", message));
        }
        let lists = [&self.t, &self.x, &self.y, &self.z, &self.angle];
        let table = match &self.file {
            Some(_) if lists.iter().any(|list| !list.is_empty()) => {
                return Err(BuildError::at("file", "give either a `file` or `t` and displacements"));
            }
            Some(file) => {
                let (rows, lines) = read(file).map_err(|e| BuildError::at("file", e))?;
                let table = Table::through(&rows, self.join, self.ends);
                table.map_err(|e| e.in_file(file, &lines).of("file"))?
            }
            None => Table::new(&self.rows()?, self.join, self.ends).map_err(|e| e.of("t"))?,
        };
        Ok(Arc::new(table))
    }
}
