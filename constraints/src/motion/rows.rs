//! Rows of tables of motions.

use ropewalk_core::BuildError;
use ropewalk_core::error::finite;

/// What is wrong with a table, and in which of its rows, counted from 0.
#[derive(Debug)]
pub(super) struct Wrong {
    pub row: Option<usize>,
    pub message: String,
}

impl Wrong {
    pub fn new(row: usize, message: String) -> Self {
        Wrong { row: Some(row), message }
    }
    /// In a scene, where rows are counted from 1.
    pub fn in_scene(self) -> BuildError {
        match self.row {
            Some(row) => BuildError::new(format!("row {}: {}", row + 1, self.message)),
            None => BuildError::new(self.message),
        }
    }
    /// In a file whose rows are in these lines.
    pub fn in_file(self, path: &str, lines: &[usize]) -> BuildError {
        BuildError::new(match self.row {
            Some(row) => format!("{path}, line {}: {}", lines[row], self.message),
            None => format!("{path}: {}", self.message),
        })
    }
}

/// Whether rows, which begin with a time, make a table.
pub(super) fn check<const N: usize>(rows: &[[f64; N]]) -> Result<(), Wrong> {
    if rows.len() < 2 {
        let message = format!("the table of a motion needs two rows or more, not {}", rows.len());
        return Err(Wrong { row: None, message });
    }
    for (k, row) in rows.iter().enumerate() {
        finite("the row", row).map_err(|e| Wrong::new(k, e.message))?;
        if k > 0 && !(row[0] > rows[k - 1][0]) {
            let message = format!("times must ascend, but {} s comes after {} s", row[0], rows[k - 1][0]);
            return Err(Wrong::new(k, message));
        }
    }
    Ok(())
}
