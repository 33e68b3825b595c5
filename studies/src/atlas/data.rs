//! What the runs of an entry left behind.

use super::plan::{Plan, Use};
use crate::error::Error;
use crate::run::{Shape, Summary, read_shapes};
use crate::study::StudyFolder;
use ropewalk_report::{RunFolder, Table};

/// One run of an entry with its results.
pub(super) struct Run<'a> {
    pub used: &'a Use,
    pub summary: Summary,
    pub history: Table,
    /// Empty unless they are asked for.
    pub shapes: Vec<Shape>,
    /// Length of an element and bending time of the first cable.
    pub bending: Option<(f64, f64)>,
}

/// Reads the results of an entry's runs; `missing` are numbers of the runs that have none.
///
/// # Errors
/// A file that can't be read.
pub fn read<'a>(
    plan: &'a Plan,
    entry: usize,
    folder: &StudyFolder,
    with_shapes: bool,
) -> Result<Vec<Run<'a>>, Error> {
    let one = |used: &'a Use| {
        let case = &plan.cases[used.case];
        let run = RunFolder::earlier(folder.run(&case.name));
        let shapes = if with_shapes { read_shapes(&run)? } else { Vec::new() };
        let (summary, history) = (run.read_summary()?, Table::read(&run.history_file())?);
        Ok(Run { used, summary, history, shapes, bending: case.bending })
    };
    plan.uses[entry].iter().map(one).collect()
}
