//! `shapes.csv`: the lines of all parts at the times of the snapshots, for pictures made later.

use crate::output::{Column, OutputError, RunFolder, Table};
use ropewalk_core::V3;

/// Writes them; a row without place parts one line from the next.
pub(crate) fn write(folder: &RunFolder, shapes: &[(f64, Vec<V3<f64>>)]) -> Result<(), OutputError> {
    if shapes.is_empty() {
        return Ok(());
    }
    let columns =
        [("t", "s"), ("x", "m"), ("y", "m"), ("z", "m")].map(|(name, unit)| Column::new(name, unit));
    let mut table = Table { columns: columns.to_vec() };
    for (t, line) in shapes {
        for x in line {
            table.push_row(&[*t, x[0], x[1], x[2]])?;
        }
    }
    table.write(&folder.shapes_file())
}

/// The last of them.
pub(crate) fn last(folder: &RunFolder) -> Result<Vec<V3<f64>>, OutputError> {
    let table = Table::read(&folder.shapes_file())?;
    let [t, x, y, z] = table.columns.as_slice() else { return Ok(Vec::new()) };
    let rows = (0..table.rows()).filter(|k| t.values.last() == Some(&t.values[*k]));
    Ok(rows.map(|k| [x.values[k], y.values[k], z.values[k]]).collect())
}
