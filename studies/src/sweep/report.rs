//! What is said on the terminal when a sweep has ended.

use super::results::Results;
use super::tail::{Over, Report, unsteady};
use crate::study::StudyFolder;
use ropewalk_report::{in_columns, number, rough};
use std::fmt::Write;

/// Rows that are shown.
const MOST_ROWS: usize = 80;

/// The whole report: the table, as far as there is room, and where everything is.
pub(super) fn report(
    results: &Results,
    folder: &StudyFolder,
    wall_s: f64,
    runs: usize,
    (what, over): (Report, Over),
    [tables, pictures]: [usize; 2],
) -> String {
    let recorded = results.recorded();
    let mut headings = results.headings.clone();
    headings.extend(["status", "cpu [s]", "steps", "iterations"].map(String::from));
    headings.extend(recorded.iter().skip(1).map(|c| c.heading.clone()));
    let shown: Vec<Vec<String>> = results
        .rows()
        .take(MOST_ROWS)
        .map(|(k, row)| {
            let work = [
                row.status.clone(),
                rough(row.cpu_s),
                row.counts.steps.to_string(),
                row.counts.newton_iterations.to_string(),
            ];
            let finals = recorded
                .iter()
                .skip(1)
                .map(|c| Results::values(row, c).map_or(String::new(), |v| number(v.reported(what))));
            results.cells(k).iter().cloned().chain(work).chain(finals).collect()
        })
        .collect();
    let (mut out, columns) = in_columns(&headings, &shown);

    let left_out = results.len().saturating_sub(MOST_ROWS);
    if left_out > 0 {
        _ = writeln!(out, "  … and {left_out} more runs in table.csv");
    }
    let not_shown = headings.len() - columns;
    if not_shown > 0 {
        _ = writeln!(out, "  … and {not_shown} more records in table.csv");
    }
    out.push('\n');
    if what == Report::Last {
        out += &unsteady(results, over);
    } else {
        _ = writeln!(out, "  values    {} of {over}", what.ending());
    }
    let mut line = |what: &str, text: String| _ = writeln!(out, "  {what:<9} {text}");
    let mut words = Vec::new();
    for status in ["finished", "stopped", "failed", "refused", "interrupted"] {
        match results.count(status) {
            0 => {}
            n => words.push(format!("{n} {status}")),
        }
    }
    if results.len() < runs {
        words.push(format!("{} not begun", runs - results.len()));
    }
    let earlier = results.rows().filter(|(_, row)| row.earlier).count();
    let note = if earlier > 0 { format!("; {earlier} of them were there already") } else { String::new() };
    line("runs", format!("{}{note}", words.join(", ")));
    let cpu: f64 = results.rows().filter(|(_, r)| !r.earlier).map(|(_, r)| r.cpu_s).sum();
    line("time", format!("{} s on the clock, {} s of CPU", rough(wall_s), rough(cpu)));
    line("folder", folder.path().display().to_string());
    line(
        "results",
        format!(
            "table.csv, runs/, {tables} tables of {} values in tables/, {pictures} pictures in plots/",
            if what == Report::Last { "last" } else { what.ending() }
        ),
    );
    out
}
