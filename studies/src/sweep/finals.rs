//! Where the runs ended: the last value of every record, or a mean or an extreme there, by the first parameter, as tables.

use super::axis::Axis;
use super::grid::Grid;
use super::results::{Recorded, Results};
use super::tail::Report;
use crate::study::StudyFolder;
use ropewalk_report::{Csv, OutputError, write_atomic};
use std::collections::HashMap;

/// Last values of runs that differ in nothing but the first parameter.
pub(super) struct Line {
    /// What they have in common.
    pub name: String,
    /// Number of the value of the first parameter, and reported value of the record.
    pub values: Vec<(usize, f64)>,
}

/// The reported values of a column, line by line.
pub(super) fn finals(column: &Recorded, grid: &Grid, results: &Results, what: Report) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    let mut place: HashMap<String, usize> = HashMap::new();
    for (k, row) in results.rows().filter(|(_, row)| row.status.is_complete()) {
        let Some(values) = Results::values(row, column) else { continue };
        let name = grid.line(k);
        let at = *place.entry(name.clone()).or_insert_with(|| {
            lines.push(Line { name, values: Vec::new() });
            lines.len() - 1
        });
        let value = grid.choice(k).1.get(grid.main()).copied().unwrap_or(0);
        lines[at].values.push((value, values.reported(what)));
    }
    lines
}

/// Writes a table for every record: a row for each value of the first parameter, a column for all others. Gives the
/// number of tables; one that can't be written is no reason to fail.
pub(super) fn write(
    folder: &StudyFolder,
    grid: &Grid,
    axes: &[Axis],
    results: &Results,
    what: Report,
    warn: &mut dyn FnMut(&str),
) -> usize {
    let Some(axis) = axes.get(grid.main()) else { return 0 };
    let files = folder.files();
    let mut written = 0;
    for column in results.recorded().iter().skip(1) {
        let lines = finals(column, grid, results, what);
        if lines.is_empty() {
            continue;
        }
        let text = table(&column.heading, axis, &lines);
        let result: Result<(), OutputError> = files
            .table_file(&format!("{}-{}", column.name, what.ending()))
            .and_then(|path| write_atomic(&path, &text));
        match result {
            Ok(()) => written += 1,
            Err(e) => warn(&e.to_string()),
        }
    }
    written
}

fn table(heading: &str, axis: &Axis, lines: &[Line]) -> String {
    let name = |line: &Line| match line.name.as_str() {
        "" => heading.to_string(),
        name => format!("{heading}: {name}"),
    };
    let mut csv = Csv::new(std::iter::once(axis.heading.clone()).chain(lines.iter().map(name)));
    let lines: Vec<HashMap<usize, f64>> = lines.iter().map(|l| l.values.iter().copied().collect()).collect();
    for (i, cell) in axis.cells.iter().enumerate() {
        csv.cell(cell);
        lines.iter().for_each(|line| _ = csv.number_or_none(line.get(&i).copied()));
        csv.end();
    }
    csv.text()
}
