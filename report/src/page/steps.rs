//! The steps of a solver over time.

use crate::{Csv, OutputError, cells, write_atomic};
use std::path::Path;

/// Sizes of steps over time, some of them together, and what kept them from being longer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Steps {
    /// Time at the end of each group of steps [s].
    pub t: Vec<f64>,
    /// The smallest of the group [s].
    pub least: Vec<f64>,
    /// The largest of the group [s].
    pub greatest: Vec<f64>,
    /// Number of the cause that limited most of the group.
    pub cause: Vec<usize>,
    /// What can limit steps, such as `position error`.
    pub causes: Vec<String>,
    /// How many steps were limited by each cause, of all steps.
    pub counts: Vec<u64>,
}

const HEAD: [&str; 4] = ["t [s]", "least [s]", "greatest [s]", "limited by"];

impl Steps {
    /// Writes them as CSV: `t [s],least [s],greatest [s],limited by`.
    ///
    /// ```
    /// # use ropewalk_report::{OutputError, Steps};
    /// let steps = Steps {
    ///     t: vec![0.1, 0.3],
    ///     least: vec![0.02, 0.05],
    ///     greatest: vec![0.05, 0.1],
    ///     cause: vec![0, 1],
    ///     causes: vec!["start".into(), "position error".into()],
    ///     counts: vec![3, 2],
    /// };
    /// # let folder = tempfile::tempdir().unwrap();
    /// # let path = folder.path().join("steps.csv");
    /// steps.write(&path)?;
    /// let back = Steps::read(&path)?;
    /// assert_eq!((&back.t, &back.causes, &back.cause), (&steps.t, &steps.causes, &steps.cause));
    /// # Ok::<(), OutputError>(())
    /// ```
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        let mut csv = Csv::new(HEAD);
        for (k, t) in self.t.iter().enumerate() {
            csv.number(*t).number(self.least[k]).number(self.greatest[k]);
            csv.cell(self.causes.get(self.cause[k]).map_or("", String::as_str));
            csv.end();
        }
        write_atomic(path, &csv.text())
    }

    /// Reads them back; how many steps each cause limited isn't in the file, each group counts as one.
    ///
    /// # Errors
    /// A file that can't be read, or that isn't such a one.
    pub fn read(path: &Path) -> Result<Self, OutputError> {
        let text = std::fs::read_to_string(path).map_err(OutputError::io("read", path))?;
        let mut steps = Steps::default();
        for (row, line) in text.lines().enumerate().skip(1) {
            let fail = || OutputError::Csv {
                path: path.into(),
                line: row + 1,
                message: "not a row of steps".into(),
            };
            let fields = cells(line);
            let [t, least, greatest, cause] = fields.as_slice() else { return Err(fail()) };
            let number = |text: &String| text.parse::<f64>().map_err(|_| fail());
            steps.t.push(number(t)?);
            steps.least.push(number(least)?);
            steps.greatest.push(number(greatest)?);
            let k = steps.causes.iter().position(|known| known == cause).unwrap_or_else(|| {
                steps.causes.push(cause.clone());
                steps.counts.push(0);
                steps.causes.len() - 1
            });
            steps.cause.push(k);
            steps.counts[k] += 1;
        }
        Ok(steps)
    }
}
