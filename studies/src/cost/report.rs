//! What the runs cost: table, front, advice and picture.

use super::front::{Point, cheapest, front};
use super::reference::Reference;
use crate::error::Error;
use crate::study::{Axes, StudyFolder, Target, words};
use ropewalk_report::{
    Csv, LinePlot, Mark, OutputError, Series, Sheet, TERMINAL, cannot_create, rough, write_atomic,
};
use serde::Serialize;
use std::fs;
use std::sync::Arc;

/// The accuracies that advice is given for, relative to the size of the record.
pub(super) const GOALS: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// Rows that are shown.
const MOST_ROWS: usize = 60;

/// What to take for an error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CostAdvice {
    /// The error that is allowed, relative to the size of the record.
    pub accuracy: f64,
    /// The settings in words, none if none were found.
    pub settings: Option<String>,
    /// How to get them.
    pub recipe: Option<String>,
    /// The error that they have.
    pub error: Option<f64>,
    /// What they cost [s].
    pub cpu_s: Option<f64>,
}

/// All about the runs, in order of their cost.
pub struct Report<'a> {
    pub axes: &'a Axes<'a>,
    pub target: &'a Target,
    pub reference: &'a Reference,
    pub points: Vec<Point>,
}

impl Report<'_> {
    /// The cheapest settings for each accuracy that the reference can tell.
    pub(super) fn advice(&self) -> Vec<CostAdvice> {
        let of = |accuracy: f64| {
            let found = cheapest(&self.points, accuracy - self.reference.uncertainty());
            CostAdvice {
                accuracy,
                settings: found.map(|p| self.axes.words(&p.run.settings)),
                recipe: found.map(|p| self.axes.recipe(&p.run.settings)),
                error: found.map(|p| p.error),
                cpu_s: found.map(|p| p.run.cpu_s),
            }
        };
        GOALS.map(of).into()
    }

    /// Writes the scene with the settings for each accuracy, ready to run: `advice/1e-3.toml`.
    ///
    /// # Errors
    /// A file that can't be written.
    pub(super) fn write_scenes(&self, folder: &StudyFolder) -> Result<(), Error> {
        let path = folder.path().join("advice");
        // what an earlier call found is no longer true
        match fs::remove_dir_all(&path) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
                return Err(OutputError::io("delete", &path)(e).into());
            }
            _ => fs::create_dir_all(&path).map_err(|e| cannot_create(&path, e))?,
        }
        for accuracy in GOALS {
            if let Some(p) = cheapest(&self.points, accuracy - self.reference.uncertainty()) {
                let file = self.axes.with(&p.run.settings, None)?;
                write_atomic(&path.join(format!("{accuracy:e}.toml")), &file.document().to_toml())?;
            }
        }
        Ok(())
    }

    fn cells(&self, p: &Point) -> Vec<String> {
        let s = &p.run.settings;
        let elements: Vec<String> = self.axes.elements(s).iter().map(u64::to_string).collect();
        let step = s.stepping.map(|_| format!("{:e}", s.tightness()));
        vec![
            elements.join("+"),
            s.models.map(words::models).unwrap_or_default(),
            step.unwrap_or_default(),
            s.scheme.map(words::scheme).unwrap_or_default(),
        ]
    }

    fn headings(&self) -> Vec<String> {
        let step = if self.axes.base.stepping.is_none() || self.axes.base.tolerance().is_some() {
            "tolerance"
        } else {
            "step [s]"
        };
        ["elements", "models", step, "scheme", "cpu [s]", "steps", "error"].map(String::from).into()
    }

    /// What is said on the terminal.
    pub(super) fn text(&self) -> String {
        let mut sheet = Sheet::default();
        let best = front(&self.points);
        let (headings, rows, left_out) = self.rows(&best);
        sheet.table_within(TERMINAL, &headings, &rows);
        if left_out > 0 {
            sheet.line(format!("  … and {left_out} more runs in table.csv"));
        }
        let reference = self.reference;
        let when = match self.target.t {
            Some(t) => format!("taken at {t}"),
            None => "the largest over the run".into(),
        };
        sheet.line(format!(
            "\n  * no other run is both faster and more accurate (Pareto front); errors are relative to {} {}, the largest\n    \
             magnitude of {} over the run, and {when}",
            rough(reference.size),
            self.target.unit,
            self.target.name
        ));
        sheet.line(format!(
            "\n  reference, uncertainty {} (steps {}, mesh {})",
            rough(reference.uncertainty()),
            rough(reference.step),
            rough(reference.mesh)
        ));
        reference.notes.iter().for_each(|note| sheet.line(format!("    {note}")));
        sheet.line("\n  advice");
        self.advice().iter().for_each(|a| sheet.line(self.advice_line(a)));
        sheet.to_string()
    }

    /// The runs that are shown, and how many are left out: those that are farthest from being worth their time.
    fn shown(&self, best: &[Point]) -> (Vec<&Point>, usize) {
        let mut shown: Vec<&Point> = self.points.iter().filter(|p| p.run.cpu_s.is_finite()).collect();
        let left_out = shown.len().saturating_sub(MOST_ROWS);
        if left_out > 0 {
            let behind = |p: &Point| {
                let better = best.iter().filter(|b| b.run.cpu_s <= p.run.cpu_s).map(|b| p.error / b.sure);
                let behind = better.fold(1.0, f64::max);
                if p.error.is_nan() { f64::INFINITY } else { behind }
            };
            shown.sort_by(|a, b| behind(a).total_cmp(&behind(b)));
            shown.truncate(MOST_ROWS);
            shown.sort_by(|a, b| a.run.cpu_s.total_cmp(&b.run.cpu_s));
        }
        (shown, left_out)
    }

    /// Headings and rows of the runs that are shown, and how many are left out.
    pub(super) fn rows(&self, best: &[Point]) -> (Vec<String>, Vec<Vec<String>>, usize) {
        let (shown, left_out) = self.shown(best);
        let (headings, rows) = self.table(&shown, best);
        (headings, rows, left_out)
    }

    /// Headings and rows, without columns of which the scene has nothing.
    fn table(&self, shown: &[&Point], best: &[Point]) -> (Vec<String>, Vec<Vec<String>>) {
        let row = |p: &&Point| {
            let is_best = best.iter().any(|b| Arc::ptr_eq(&b.run, &p.run));
            let mut row = self.cells(p);
            row.extend([rough(p.run.cpu_s), p.run.counts.steps.to_string()]);
            row.push(if p.error.is_finite() { format!("{:.1e}", p.error) } else { "failed".into() });
            let mark = match (is_best, p.sure > p.error) {
                (true, _) => "*",
                (false, true) => "coincidence",
                _ => "",
            };
            row.push(mark.into());
            row
        };
        let rows: Vec<Vec<String>> = shown.iter().map(row).collect();
        let mut headings = self.headings();
        headings.push(String::new());
        let used: Vec<bool> =
            (0..headings.len()).map(|c| c >= 4 || rows.iter().any(|r| !r[c].is_empty())).collect();
        let only = |row: &Vec<String>| {
            row.iter().zip(&used).filter(|(_, u)| **u).map(|(c, _)| c.clone()).collect::<Vec<_>>()
        };
        (only(&headings), rows.iter().map(only).collect())
    }

    fn advice_line(&self, a: &CostAdvice) -> String {
        let goal = match a.accuracy >= 1e-3 {
            true => format!("{} %", 100.0 * a.accuracy),
            false => format!("{:e}", a.accuracy),
        };
        match (&a.settings, &a.recipe, a.cpu_s, a.error) {
            (Some(settings), Some(recipe), Some(cpu), Some(error)) => {
                format!("    for {goal}: {settings}: {} s, error {error:.1e}\n      {recipe}", rough(cpu))
            }
            _ if self.reference.uncertainty() >= a.accuracy => {
                format!("    for {goal}: unknown, the uncertainty of the reference is larger")
            }
            _ => format!("    for {goal}: nothing found that reaches it in the time given"),
        }
    }

    /// All runs, in order of their cost.
    ///
    /// # Errors
    /// A file that can't be written.
    pub(super) fn write_table(&self, folder: &StudyFolder) -> Result<(), OutputError> {
        let more = ["sure error", "front", "message"].map(String::from);
        let mut csv = Csv::new(self.headings().into_iter().chain(more));
        let best = front(&self.points);
        for p in &self.points {
            self.cells(p).iter().for_each(|cell| _ = csv.cell(cell));
            csv.number(p.run.cpu_s).cell(p.run.counts.steps.to_string()).number(p.error).number(p.sure);
            csv.cell(if best.iter().any(|b| Arc::ptr_eq(&b.run, &p.run)) { "1" } else { "0" });
            csv.cell(p.run.failure.as_deref().unwrap_or_default()).end();
        }
        write_atomic(&folder.table_file(), &csv.text())
    }

    /// Error over CPU time: the runs by scheme, other models, and the front.
    pub(super) fn plot(&self, scene: &str) -> LinePlot {
        let point = |p: &Point| (p.run.cpu_s, p.error);
        let own = self.axes.base.models;
        let mut series: Vec<Series> = Vec::new();
        let drawn = self.points.iter().filter(|p| p.error.is_finite() && p.run.cpu_s.is_finite());
        // the models of the scene before all others
        let (of_scene, others): (Vec<_>, Vec<_>) = drawn.partition(|p| p.run.settings.models == own);
        for (is_own, p) in
            of_scene.into_iter().map(|p| (true, p)).chain(others.into_iter().map(|p| (false, p)))
        {
            let s = &p.run.settings;
            let models = if is_own { s.models.map(words::models) } else { Some("other models".into()) };
            let words = [models.filter(|_| own.is_some()), s.scheme.map(words::scheme)];
            let label = words.into_iter().flatten().collect::<Vec<_>>().join(", ");
            match series.iter_mut().find(|s| s.label == label) {
                Some(s) => s.points.push(point(p)),
                None => series.push(Series::new(label, vec![point(p)]).with_mark(Mark::Dots)),
            }
        }
        let best = front(&self.points).iter().map(|p| (p.run.cpu_s, p.sure)).collect();
        series.push(Series::new("front", best));
        let (first, last) = (self.points.first(), self.points.last());
        if let (Some(a), Some(b)) = (first, last)
            && self.reference.uncertainty() > 0.0
        {
            let level = self.reference.uncertainty();
            let ends = vec![(a.run.cpu_s, level), (b.run.cpu_s.min(1e9), level)];
            series.push(Series::new("uncertainty of the reference", ends));
        }
        LinePlot {
            title: format!("What accuracy costs: {} of {scene}", self.target.text),
            x_label: "CPU time [s]".into(),
            y_label: "error, relative to the size".into(),
            series,
            log_x: true,
            log_y: true,
            ..LinePlot::default()
        }
    }
}
