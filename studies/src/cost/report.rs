//! What the runs cost: table, front, advice and picture.

use super::GOALS;
use super::front::{Point, cheapest, front};
use super::reference::Reference;
use crate::error::Error;
use crate::study::{Axes, StudyFolder, Target, words};
use ropewalk_report::{
    LinePlot, Mark, OutputError, Series, cannot_create, in_columns, push_cell, push_number, rough,
    write_atomic,
};
use serde::Serialize;
use std::fmt::Write;
use std::fs;
use std::sync::Arc;

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
            let found = cheapest(&self.points, accuracy - self.reference.doubt());
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
            if let Some(p) = cheapest(&self.points, accuracy - self.reference.doubt()) {
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
        let mut out = String::new();
        let best = front(&self.points);
        let is_best = |p: &Point| best.iter().any(|b| Arc::ptr_eq(&b.run, &p.run));
        let mut shown: Vec<&Point> = self.points.iter().filter(|p| p.run.cpu_s.is_finite()).collect();
        let left_out = shown.len().saturating_sub(MOST_ROWS);
        if left_out > 0 {
            // those that are farthest from being worth their time
            let behind = |p: &Point| {
                let better = best.iter().filter(|b| b.run.cpu_s <= p.run.cpu_s).map(|b| p.error / b.sure);
                let behind = better.fold(1.0, f64::max);
                if p.error.is_nan() { f64::INFINITY } else { behind }
            };
            shown.sort_by(|a, b| behind(a).total_cmp(&behind(b)));
            shown.truncate(MOST_ROWS);
            shown.sort_by(|a, b| a.run.cpu_s.total_cmp(&b.run.cpu_s));
        }
        let rows: Vec<Vec<String>> = shown
            .iter()
            .map(|p| {
                let mut row = self.cells(p);
                row.extend([rough(p.run.cpu_s), p.run.counts.steps.to_string()]);
                row.push(if p.error.is_finite() { format!("{:.1e}", p.error) } else { "failed".into() });
                row.push(match (is_best(p), p.sure > p.error) {
                    (true, _) => "*".into(),
                    (false, true) => "by luck".into(),
                    _ => String::new(),
                });
                row
            })
            .collect();
        let mut headings = self.headings();
        headings.push(String::new());
        // columns of which the scene has nothing
        let used: Vec<bool> =
            (0..headings.len()).map(|c| c >= 4 || rows.iter().any(|r| !r[c].is_empty())).collect();
        let only = |row: &[String]| {
            row.iter().zip(&used).filter(|(_, u)| **u).map(|(c, _)| c.clone()).collect::<Vec<_>>()
        };
        let rows: Vec<Vec<String>> = rows.iter().map(|r| only(r)).collect();
        out += &in_columns(&only(&headings), &rows).0;
        if left_out > 0 {
            _ = writeln!(out, "  … and {left_out} more runs in table.csv");
        }
        let reference = self.reference;
        _ = writeln!(
            out,
            "\n  * no other run is both faster and more accurate (Pareto front); errors are relative to {} {}, the largest",
            rough(reference.size),
            self.target.unit
        );
        let when = match self.target.t {
            Some(t) => format!("taken at {t}"),
            None => "the largest over the run".into(),
        };
        _ = writeln!(out, "    magnitude of {} over the run, and {when}", self.target.name);
        _ = writeln!(
            out,
            "\n  reference, sure to {} (steps {}, mesh {})",
            rough(reference.doubt()),
            rough(reference.step),
            rough(reference.mesh)
        );
        for note in &reference.notes {
            _ = writeln!(out, "    {note}");
        }
        _ = writeln!(out, "\n  advice");
        for a in self.advice() {
            let goal = if a.accuracy >= 1e-3 {
                format!("{} %", 100.0 * a.accuracy)
            } else {
                format!("{:e}", a.accuracy)
            };
            match (&a.settings, &a.recipe, a.cpu_s, a.error) {
                (Some(settings), Some(recipe), Some(cpu), Some(error)) => {
                    _ = writeln!(
                        out,
                        "    for {goal}: {settings}: {} s, error {error:.1e}\n      {recipe}",
                        rough(cpu)
                    );
                }
                _ if reference.doubt() >= a.accuracy => {
                    _ = writeln!(out, "    for {goal}: can't be told, the reference isn't that sure");
                }
                _ => _ = writeln!(out, "    for {goal}: nothing found that reaches it in the time given"),
            }
        }
        out
    }

    /// All runs, in order of their cost.
    ///
    /// # Errors
    /// A file that can't be written.
    pub(super) fn write_table(&self, folder: &StudyFolder) -> Result<(), OutputError> {
        let mut text = self.headings().join(",");
        text += ",sure error,front,message\n";
        let best = front(&self.points);
        for p in &self.points {
            for cell in self.cells(p) {
                push_cell(&mut text, &cell);
                text.push(',');
            }
            push_number(&mut text, p.run.cpu_s);
            _ = write!(text, ",{},", p.run.counts.steps);
            push_number(&mut text, p.error);
            text.push(',');
            push_number(&mut text, p.sure);
            _ = write!(text, ",{},", u8::from(best.iter().any(|b| Arc::ptr_eq(&b.run, &p.run))));
            push_cell(&mut text, p.run.failure.as_deref().unwrap_or_default());
            text.push('\n');
        }
        write_atomic(&folder.table_file(), &text)
    }

    /// Error over CPU time: the runs by scheme, other models, and the front.
    pub(super) fn plot(&self, scene: &str) -> LinePlot {
        let point = |p: &Point| (p.run.cpu_s, p.error);
        let own = self.axes.base.models;
        let mut series: Vec<Series> = Vec::new();
        let mut add = |label: String, p: &Point| match series.iter_mut().find(|s| s.label == label) {
            Some(s) => s.points.push(point(p)),
            None => series.push(Series::new(label, vec![point(p)]).with_mark(Mark::Dots)),
        };
        for p in self.points.iter().filter(|p| p.error.is_finite() && p.run.cpu_s.is_finite()) {
            let s = &p.run.settings;
            let models =
                if s.models == own { s.models.map(words::models) } else { Some("other models".into()) };
            let words: Vec<String> = [models.filter(|_| own.is_some()), s.scheme.map(words::scheme)]
                .into_iter()
                .flatten()
                .collect();
            add(words.join(", "), p);
        }
        series.sort_by_key(|s| s.label.starts_with("other"));
        let best = front(&self.points).iter().map(|p| (p.run.cpu_s, p.sure)).collect();
        series.push(Series::new("front", best));
        let (first, last) = (self.points.first(), self.points.last());
        if let (Some(a), Some(b)) = (first, last)
            && self.reference.doubt() > 0.0
        {
            let doubt = self.reference.doubt();
            series.push(Series::new(
                "doubt of the reference",
                vec![(a.run.cpu_s, doubt), (b.run.cpu_s.min(1e9), doubt)],
            ));
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
