//! A user's CSV over a figure, such as an experiment.

use super::spec::{Overlay, Panel};
use ropewalk_report::{Mark, OutputError, Series, Table};
use std::path::{Path, PathBuf};

/// Measured or published curves: the first column is along the horizontal axis.
pub struct Measured {
    table: Table,
    label: Option<String>,
    /// Whether the figure has but one panel, into which all of it belongs.
    whole: bool,
}

/// `FIGURE=FILE` of the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Laid {
    /// Number of the figure.
    pub figure: String,
    /// The CSV that is laid over it.
    pub file: PathBuf,
}

impl std::str::FromStr for Laid {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=').map(|(figure, file)| (figure.trim(), file.trim())) {
            Some((figure, file)) if !figure.is_empty() && !file.is_empty() => {
                let figure = figure.strip_prefix("figure-").unwrap_or(figure);
                Ok(Laid { figure: figure.into(), file: file.into() })
            }
            _ => Err("expected the number of a figure and a CSV file, like `3.10=measured.csv`".into()),
        }
    }
}

impl Measured {
    /// Reads a file; several panels need columns of the names that they show.
    ///
    /// # Errors
    /// It can't be read, is no table of numbers, or has a column that belongs to no panel or to several.
    pub fn read(overlay: &Overlay, panels: &[&Panel]) -> Result<Self, String> {
        let path = Path::new(&overlay.file);
        let table = Table::read(path).map_err(|e: OutputError| e.to_string())?;
        if table.columns.len() < 2 {
            return Err(format!("{} has no second column to be drawn over the first", path.display()));
        }
        let measured = Self { table, label: overlay.label.clone(), whole: panels.len() == 1 };
        if !measured.whole {
            for column in measured.table.columns.iter().skip(1) {
                if !panels.iter().any(|panel| belongs(&column.name, panel)) {
                    let names: Vec<&str> =
                        panels.iter().flat_map(|p| p.y.iter().map(String::as_str)).collect();
                    return Err(format!(
                        "the column `{}` of {} is shown by none of the figure's panels: name it after one of {}",
                        column.name,
                        path.display(),
                        names.join(", ")
                    ));
                }
            }
        }
        Ok(measured)
    }

    /// What of it belongs into a panel.
    pub(super) fn curves(&self, panel: &Panel) -> Vec<Series> {
        let columns = self.table.columns.iter().skip(1);
        let shown: Vec<_> = columns.filter(|c| self.whole || belongs(&c.name, panel)).collect();
        let curve = |c: &&ropewalk_report::Column| {
            let label = match (&self.label, shown.len()) {
                (Some(label), 1) => label.clone(),
                (Some(label), _) => format!("{label}, {}", c.name),
                (None, _) => c.name.clone(),
            };
            Series::new(label, self.table.points(&c.name).unwrap_or_default()).with_mark(Mark::Dots)
        };
        shown.iter().map(curve).collect()
    }
}

/// Whether a panel shows a record of this name.
fn belongs(column: &str, panel: &Panel) -> bool {
    panel.y.iter().any(|y| y == column)
}
