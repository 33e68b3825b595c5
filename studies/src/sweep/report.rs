//! What is said on the terminal when a sweep has ended.

use super::results::{Recorded, Results, Row};
use super::tail::{Over, Report, STEADY};
use crate::run::Status;
use crate::study::StudyFolder;
use ropewalk_report::{Sheet, TERMINAL, number, rough};

/// Rows that are shown.
const MOST_ROWS: usize = 80;
/// Columns that are named as unsteady; the others are counted.
const MOST_NAMED: usize = 6;

/// The value of a column that stands for a run; nothing where the run doesn't have it.
pub(super) fn shown_value(row: &Row, column: &Recorded, what: Report) -> String {
    Results::values(row, column).map_or(String::new(), |v| number(v.reported(what)))
}

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
                row.status.to_string(),
                rough(row.cpu_s),
                row.counts.steps.to_string(),
                row.counts.newton_iterations.to_string(),
            ];
            let finals = recorded.iter().skip(1).map(|c| shown_value(row, c, what));
            results.cells(k).iter().cloned().chain(work).chain(finals).collect()
        })
        .collect();
    let mut sheet = Sheet::default();
    let columns = sheet.table_within(TERMINAL, &headings, &shown);
    let left_out = results.len().saturating_sub(MOST_ROWS);
    if left_out > 0 {
        sheet.line(format!("  … and {left_out} more runs in table.csv"));
    }
    let not_shown = headings.len() - columns;
    if not_shown > 0 {
        sheet.line(format!("  … and {not_shown} more records in table.csv"));
    }
    sheet.line("");
    if what == Report::Last {
        unsteady(&mut sheet, results, over);
    } else {
        sheet.entry("values", format!("{} of {over}", what.ending()));
    }
    let words = Status::ALL.map(|status| (results.count(status), status));
    let words = words.into_iter().filter(|(n, _)| *n > 0).map(|(n, status)| format!("{n} {status}"));
    let not_begun = (results.len() < runs).then(|| format!("{} not begun", runs - results.len()));
    let words = words.chain(not_begun).collect::<Vec<_>>().join(", ");
    let earlier = results.rows().filter(|(_, row)| row.earlier).count();
    let note = if earlier > 0 { format!("; {earlier} of them were there already") } else { String::new() };
    sheet.entry("runs", format!("{words}{note}"));
    let cpu: f64 = results.rows().filter(|(_, r)| !r.earlier).map(|(_, r)| r.cpu_s).sum();
    sheet.entry("time", format!("wall time {} s, CPU time {} s", rough(wall_s), rough(cpu)));
    sheet.entry("folder", folder.path().display());
    let values = if what == Report::Last { "last" } else { what.ending() };
    sheet.entry(
        "results",
        format!(
            "table.csv, runs/, {tables} tables of {values} values in tables/, {pictures} pictures in plots/"
        ),
    );
    sheet.to_string()
}

/// Says which last values aren't steady, a line for each column; nothing if all are.
fn unsteady(sheet: &mut Sheet, results: &Results, over: Over) {
    let mut all: Vec<(String, usize, usize, f64)> = Vec::new();
    for column in results.recorded().iter().skip(1) {
        let tails = results.rows().filter(|(_, row)| row.status.is_complete());
        let tails: Vec<f64> =
            tails.filter_map(|(_, row)| Some(Results::values(row, column)?.tail.unsteady)).collect();
        let count = tails.iter().filter(|x| **x > STEADY).count();
        if count > 0 {
            let most = tails.iter().copied().fold(0.0, f64::max);
            all.push((column.name.clone(), count, tails.len(), most));
        }
    }
    for (name, count, of, most) in all.iter().take(MOST_NAMED) {
        let percent = (100.0 * most).ceil();
        sheet.entry(
            "unsteady",
            format!(
                "{name} in {count} of {of} runs: it ranges by up to {percent} % of its largest over {over}"
            ),
        );
    }
    if let Some(more) = all.len().checked_sub(MOST_NAMED).filter(|n| *n > 0) {
        sheet.entry("unsteady", format!("and {more} more records, see the tail columns of table.csv"));
    }
    if !all.is_empty() {
        let help =
            "their last values are one of many: take `--report mean`, `least` or `largest`, or run longer";
        sheet.entry("", help);
    }
}
