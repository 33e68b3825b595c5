//! What came out of the runs: `table.csv`, a row for each run, in the order of the combinations.

use super::axis::Axis;
use super::grid::Grid;
use super::tail::{Over, Report, Tail, extremes};
use crate::run::{Counts, Status, Summary};
use ropewalk_report::{Csv, OutputError, Table, write_atomic};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The table is written at most this often while runs are computed …
const PERIOD: Duration = Duration::from_secs(1);
/// … and takes at most this share of the time.
const SHARE: u32 = 20;

/// One of the values that a run leaves of a column.
type Pick = fn(&Values) -> f64;

/// The columns of the table for every record: last value, extremes of the run, and what its last part holds.
const VALUES: [(&str, Pick); 6] = [
    ("final", |v| v.last),
    ("min", |v| v.least),
    ("max", |v| v.largest),
    ("tail mean", |v| v.tail.mean),
    ("tail min", |v| v.tail.least),
    ("tail max", |v| v.tail.largest),
];

/// What came out of one run.
pub(super) struct Row {
    pub status: Status,
    pub message: Option<String>,
    pub counts: Counts,
    pub cpu_s: f64,
    /// Whether an earlier call computed it.
    pub earlier: bool,
    /// The columns of its history, the first one time.
    columns: Arc<[Recorded]>,
    values: Vec<Values>,
}

/// What a run leaves of a column; NaN if there is no value, or if a NaN is among them.
#[derive(Clone, Copy)]
pub(super) struct Values {
    pub last: f64,
    pub least: f64,
    pub largest: f64,
    /// The last part of the run.
    pub tail: Tail,
}

impl Values {
    /// The one that stands for the run.
    pub(super) fn reported(&self, what: Report) -> f64 {
        what.of(self.last, &self.tail)
    }
}

impl Row {
    pub(super) fn new(summary: &Summary, history: &Table, over: Over, earlier: bool) -> Self {
        let of = |values: &[f64], tail: Tail| {
            let (last, (least, largest)) = (values.last().copied().unwrap_or(f64::NAN), extremes(values));
            Values { last, least, largest, tail }
        };
        let mut message: Vec<String> = summary.message.iter().cloned().collect();
        message.extend(summary.notes.iter().cloned());
        message.extend(summary.warnings.iter().map(|w| format!("warning: {w}")));
        Self {
            status: summary.status,
            message: (!message.is_empty()).then(|| message.join("; ")),
            counts: summary.counts,
            cpu_s: summary.cpu_s,
            earlier,
            columns: history
                .columns
                .iter()
                .map(|c| Recorded { name: c.name.clone(), heading: c.heading() })
                .collect(),
            values: history
                .columns
                .iter()
                .zip(over.tails(history))
                .map(|(c, tail)| of(&c.values, tail))
                .collect(),
        }
    }
}

/// A column of the histories.
#[derive(Clone, PartialEq)]
pub(super) struct Recorded {
    /// Its name, such as `hose.end.z`.
    pub name: String,
    /// The same with its unit.
    pub heading: String,
}

/// The results of all runs so far.
pub(super) struct Results {
    path: PathBuf,
    /// What the runs are called: name, scene if there are several, varied parameters.
    pub headings: Vec<String>,
    cells: Vec<Vec<String>>,
    rows: Vec<Option<Row>>,
    /// The columns of the last run.
    columns: Arc<[Recorded]>,
    saved: Instant,
    cost: Duration,
}

impl Results {
    pub(super) fn new(axes: &[Axis], grid: &Grid, path: PathBuf) -> Self {
        let scenes = grid.scenes();
        let several = scenes.len() > 1;
        let scene = several.then(|| "scene".to_string());
        let headings = scene.into_iter().chain(axes.iter().map(|a| a.heading.clone())).collect();
        let cells = |k: usize| {
            let (scene, values) = grid.choice(k);
            let scene = several.then(|| scenes[scene].to_string());
            let values = axes.iter().zip(values).map(|(a, i)| a.cells[i].clone());
            [grid.name(k).to_string()].into_iter().chain(scene).chain(values).collect()
        };
        Self {
            path,
            headings,
            cells: (0..grid.len()).map(cells).collect(),
            rows: (0..grid.len()).map(|_| None).collect(),
            columns: Arc::new([]),
            saved: Instant::now(),
            cost: Duration::ZERO,
        }
    }

    /// Keeps what came out of a run.
    pub(super) fn set(&mut self, k: usize, mut row: Row) {
        // most runs have the same columns, which are kept once
        match row.columns == self.columns {
            true => row.columns = self.columns.clone(),
            false => self.columns = row.columns.clone(),
        }
        self.rows[k] = Some(row);
    }
    /// Number of runs that have ended.
    pub(super) fn len(&self) -> usize {
        self.rows().count()
    }
    /// Number of runs that ended so.
    pub(super) fn count(&self, status: Status) -> usize {
        self.rows().filter(|(_, row)| row.status == status).count()
    }
    /// The runs that have ended, each with its number.
    pub(super) fn rows(&self) -> impl Iterator<Item = (usize, &Row)> {
        self.rows.iter().enumerate().filter_map(|(k, row)| Some((k, row.as_ref()?)))
    }
    /// What a run is called: its values, without name.
    pub(super) fn cells(&self, k: usize) -> &[String] {
        &self.cells[k][1..]
    }

    /// All columns of the histories, in the order in which the runs have them.
    pub(super) fn recorded(&self) -> Vec<Recorded> {
        let mut all: Vec<Recorded> = Vec::new();
        let mut last: &[Recorded] = &[];
        for (_, row) in self.rows() {
            if *row.columns != *last {
                last = &row.columns;
                let new: Vec<Recorded> = last.iter().filter(|c| !all.contains(c)).cloned().collect();
                all.extend(new);
            }
        }
        all
    }

    /// What a run leaves of a column, if the run has it.
    pub(super) fn values(row: &Row, column: &Recorded) -> Option<Values> {
        row.columns.iter().position(|c| c == column).map(|k| row.values[k])
    }

    /// The table as CSV: name, parameters, status, work, values, message.
    fn to_csv(&self) -> String {
        let recorded = self.recorded();
        // least and largest time are no news
        let shown = |what: &str| recorded.iter().skip(usize::from(what != "final"));
        let fixed = ["status", "cpu [s]", "steps", "rejected", "newton iterations"].map(String::from);
        let mut headings = vec!["run".to_string()];
        headings.extend(self.headings.iter().cloned().chain(fixed));
        for (what, _) in VALUES {
            headings.extend(shown(what).map(|c| format!("{what} {}", c.heading)));
        }
        headings.push("message".into());
        let mut csv = Csv::new(headings);
        for (k, row) in self.rows() {
            self.cells[k].iter().for_each(|cell| _ = csv.cell(cell));
            csv.cell(row.status.to_string()).number(row.cpu_s);
            let c = row.counts;
            [c.steps, c.rejected, c.newton_iterations].iter().for_each(|n| _ = csv.cell(n.to_string()));
            for (what, of) in VALUES {
                for column in shown(what) {
                    csv.number_or_none(Self::values(row, column).map(|values| of(&values)));
                }
            }
            csv.cell(row.message.as_deref().unwrap_or_default()).end();
        }
        csv.text()
    }

    /// Writes the table, all or nothing.
    pub(super) fn save(&mut self) -> Result<(), OutputError> {
        let start = Instant::now();
        write_atomic(&self.path, &self.to_csv())?;
        self.saved = Instant::now();
        self.cost = start.elapsed();
        Ok(())
    }

    /// Writes the table if that wasn't done just now; what isn't in it yet is in the folders of the runs.
    pub(super) fn save_now_and_then(&mut self) -> Result<(), OutputError> {
        if self.saved.elapsed() < PERIOD.max(SHARE * self.cost) { Ok(()) } else { self.save() }
    }
}
