//! What is said on the terminal when a sweep has ended.

use super::folder::SweepFolder;
use super::results::Results;
use crate::output::{number, rough};
use std::fmt::Write;

/// Rows that are shown.
const MOST_ROWS: usize = 80;
/// Width of the table, in characters.
const WIDTH: usize = 118;

/// The whole report: the table, as far as there is room, and where everything is.
pub(super) fn report(
    results: &Results,
    folder: &SweepFolder,
    wall_s: f64,
    runs: usize,
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
                .map(|c| Results::values(row, c).map_or(String::new(), |v| number(v[0])));
            results.cells(k).iter().cloned().chain(work).chain(finals).collect()
        })
        .collect();
    let (mut out, columns) = table(&headings, &shown);

    let left_out = results.len().saturating_sub(MOST_ROWS);
    if left_out > 0 {
        _ = writeln!(out, "  … and {left_out} more runs in table.csv");
    }
    let not_shown = headings.len() - columns;
    if not_shown > 0 {
        _ = writeln!(out, "  … and {not_shown} more records in table.csv");
    }
    out.push('\n');
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
        format!("table.csv, runs/, {tables} tables of last values in tables/, {pictures} pictures in plots/"),
    );
    out
}

/// Columns under their headings, numbers to the right, as many as there is room for; and how many these are.
fn table(headings: &[String], rows: &[Vec<String>]) -> (String, usize) {
    let is_number = |text: &str| text.is_empty() || text.parse::<f64>().is_ok();
    let wide = |c: usize| {
        let cells = rows.iter().map(|row| &row[c]).chain([&headings[c]]);
        cells.map(|text| text.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..headings.len()).map(wide).collect();
    let mut room = WIDTH;
    let fitting = widths.iter().take_while(|w| {
        let fits = room >= **w + 2;
        room = room.saturating_sub(**w + 2);
        fits
    });
    let columns = fitting.count();
    let mut out = String::new();
    for row in [headings].into_iter().chain(rows.iter().map(Vec::as_slice)) {
        let mut line = String::new();
        for c in 0..columns {
            let numeric = rows.iter().all(|row| is_number(&row[c]));
            let (text, width) = (&row[c], widths[c]);
            _ = if numeric { write!(line, "  {text:>width$}") } else { write!(line, "  {text:<width$}") };
        }
        out += line.trim_end();
        out.push('\n');
    }
    (out, columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_the_columns_that_it_has_room_for() {
        let strings = |list: &[&str]| list.iter().map(|s| (*s).to_string()).collect::<Vec<_>>();
        let rows = [strings(&["5", "finished", "-1.5"]), strings(&["15", "failed", "NaN"])];
        let (text, columns) = table(&strings(&["speed [kn]", "status", "z [m]"]), &rows);
        let expected =
            "  speed [kn]  status    z [m]\n           5  finished   -1.5\n          15  failed      NaN\n";
        assert_eq!((text.as_str(), columns), (expected, 3));
        let wide = strings(&["a", &"b".repeat(100), &"c".repeat(20)]);
        assert_eq!(table(&wide, std::slice::from_ref(&wide)).1, 2);
    }
}
