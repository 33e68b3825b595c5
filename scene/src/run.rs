//! `[run]`: what is asked of a scene, from when to when, and what is written down.

use crate::statistics::StatisticsSpec;
use ropewalk_core::{BuildError, SteadyFrame};
use serde::{Deserialize, Serialize};

/// Type of analysis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Analysis {
    /// Motion as a function of time.
    #[default]
    Dynamics,
    /// A sequence of equilibria; time is the load factor.
    Statics,
}

/// Analysis, duration and output.
///
/// ```
/// use ropewalk_scene::Run;
/// let run = Run { duration: 20.0, output: 0.1, ..Run::default() };
/// assert!(run.check().is_ok());
/// assert_eq!(run.interval(), 0.1);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Run {
    /// Type of analysis.
    pub analysis: Analysis,
    /// Duration of the run [s]; in statics the final load factor.
    #[serde(deserialize_with = "ropewalk_quantity::time")]
    pub duration: f64,
    /// Output interval of the history [s]; 0 means a thousandth of the duration.
    #[serde(deserialize_with = "ropewalk_quantity::time")]
    pub output: f64,
    /// In statics: the moving frame in which the equilibrium is found, such as that of a ship towing steadily. Fixed
    /// points move with the frame.
    pub frame: Option<SteadyFrame>,
    /// Start a dynamic run from the equilibrium at t = 0 instead of the configuration as laid.
    pub from_equilibrium: bool,
    /// Whether energy and work are balanced at every step.
    pub audit: bool,
    /// Number of snapshots in the plots of shapes.
    pub snapshots: usize,
    /// Number of snapshots in the field record of a single run: `field.npy`, and the motion in `report.html`. Rows of the
    /// history that come next are taken, so that there are at most as many.
    pub field_snapshots: usize,
    /// Titles of the plots of shapes. Default: the title of the scene.
    pub shape_titles: ShapeTitles,
    /// Tables of a few columns of the history, each a CSV file of its own.
    pub tables: Vec<TableSpec>,
    /// Range graphs of lines: between what tension, curvature and the like were along them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ranges: Vec<RangeSpec>,
    /// Statistics of records over a time, and the fatigue of their cycles.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub statistics: Vec<StatisticsSpec>,
}

/// A range graph: least, mean and largest value of tension, curvature, bending moment, declination and position along a line
/// over a time, with deviations and the instants of extremes. Every accepted step counts, however rarely the history has a
/// row. Results are `tables/range-LINE.csv` and `plots/range-LINE-tension.svg` and so on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RangeSpec {
    /// The cable.
    pub of: String,
    /// From what time on [s].
    #[serde(default, deserialize_with = "ropewalk_quantity::time")]
    pub from: f64,
    /// Up to what time [s]. Default: the end of the run.
    #[serde(
        default,
        deserialize_with = "ropewalk_quantity::optional::time",
        skip_serializing_if = "Option::is_none"
    )]
    pub to: Option<f64>,
    /// Name in results. Default: that of the cable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// Titles of the pictures of shapes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ShapeTitles {
    /// From the side: x and z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<String>,
    /// From above: x and y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub top: Option<String>,
    /// From the end: y and z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end: Option<String>,
    /// In space, seen obliquely from above; drawn only if it has a title.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub space: Option<String>,
    /// z over the distance from the z axis; drawn only if it has a title.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radial: Option<String>,
}

/// Some columns of the history as a table of their own: `tables/NAME.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TableSpec {
    /// Name of its file, without ending.
    pub name: String,
    /// Names of its columns in the history. Time is always the first column.
    pub columns: Vec<String>,
    /// Interval of the rows, a multiple of `output` [s]. Default: every row of the history.
    #[serde(default, deserialize_with = "ropewalk_quantity::time")]
    pub every: f64,
}

impl Default for Run {
    fn default() -> Self {
        Run {
            analysis: Analysis::Dynamics,
            duration: 1.0,
            output: 0.0,
            frame: None,
            from_equilibrium: false,
            audit: true,
            snapshots: 9,
            field_snapshots: 361,
            shape_titles: ShapeTitles::default(),
            tables: Vec::new(),
            ranges: Vec::new(),
            statistics: Vec::new(),
        }
    }
}

/// More rows of a history than this are surely a mistake, and fill disk and memory.
const MOST_ROWS: f64 = 1e7;

impl Run {
    /// The interval of the history [s].
    pub fn interval(&self) -> f64 {
        if self.output > 0.0 { self.output } else { self.duration / 1000.0 }
    }
    /// What is wrong with the numbers, if anything.
    pub fn check(&self) -> Result<(), BuildError> {
        ropewalk_core::error::positive("duration", self.duration).map_err(|e| e.of("run.duration"))?;
        ropewalk_core::error::not_negative("output", self.output).map_err(|e| e.of("run.output"))?;
        let rows = self.duration / self.interval();
        if self.analysis == Analysis::Dynamics && rows > MOST_ROWS {
            let message = format!("a history of {rows:.0e} rows is too long: make `output` longer");
            return Err(BuildError::at("run.output", message));
        }
        if let Some(f) = self.frame {
            ropewalk_core::error::finite("frame", &[f.velocity, f.omega, f.centre].concat())
                .map_err(|e| e.of("run.frame"))?;
            if self.analysis != Analysis::Statics {
                let message =
                    "`frame` belongs to `analysis = \"statics\"`; a run in time has motions instead";
                return Err(BuildError::at("run.frame", message));
            }
        }
        if self.snapshots > 10_000 {
            let message = format!("`snapshots` must be at most 10000, not {}", self.snapshots);
            return Err(BuildError::at("run.snapshots", message));
        }
        if self.field_snapshots > 100_000 {
            let message = format!("`field_snapshots` must be at most 100000, not {}", self.field_snapshots);
            return Err(BuildError::at("run.field_snapshots", message));
        }
        for table in &self.tables {
            ropewalk_core::error::not_negative("every", table.every).map_err(|e| e.of("run.tables"))?;
            let named = !table.name.is_empty() && !table.name.contains(['/', '\\']);
            if !named || self.tables.iter().filter(|t| t.name == table.name).count() > 1 {
                let message = format!("`{}` can't be the name of a table, or two have it", table.name);
                return Err(BuildError::at("run.tables", message));
            }
        }
        Ok(())
    }
}
