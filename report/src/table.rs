//! Time histories: named columns with units, written to and read from CSV.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::{OutputError, write_durable};

/// One column of a [`Table`]: a recorded quantity over time.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Column {
    /// Name of the record, such as `hose.end.x`.
    pub name: String,
    /// SI unit, such as `m`; empty for a number without dimension (written `[-]`).
    pub unit: String,
    /// One value per row. A quantity that has no value at some time is NaN there.
    pub values: Vec<f64>,
}

impl Column {
    /// An empty column.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into(), values: Vec::new() }
    }

    /// Name and unit as they stand in a CSV header or on a plot's axis: `hose.end.x [m]`.
    pub fn heading(&self) -> String {
        let unit = if self.unit.is_empty() { "-" } else { &self.unit };
        format!("{} [{unit}]", self.name)
    }

    fn from_heading(heading: &str) -> Self {
        let split = heading.strip_suffix(']').and_then(|start| start.rsplit_once(" ["));
        match split {
            Some((name, "-")) => Self::new(name, ""),
            Some((name, unit)) => Self::new(name, unit),
            None => Self::new(heading, ""),
        }
    }
}

/// Time histories of a run, held in memory: columns of equal length, the first one time.
///
/// Use it to collect what a plot needs or to read a `history.csv` back; a run itself writes with
/// [`TableWriter`].
///
/// ```text
/// t [s],hose.end.x [m],hose.tension [N]
/// 0,1,250.5
/// 0.1,1.0000000000000002,250.25
/// ```
///
/// ```
/// # use ropewalk_report::{Column, OutputError, Table};
/// let mut table = Table::new([Column::new("hose.end.x", "m")]);
/// table.push_row(&[0.0, 1.25])?;
/// assert_eq!(table.to_csv()?, "t [s],hose.end.x [m]\n0,1.25\n");
/// # Ok::<(), OutputError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Table {
    /// The columns, time first.
    pub columns: Vec<Column>,
}

impl Table {
    /// A table without rows: column `t [s]`, then `records`.
    pub fn new(records: impl IntoIterator<Item = Column>) -> Self {
        let mut columns = vec![Column::new("t", "s")];
        columns.extend(records);
        Self { columns }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |c| c.values.len())
    }

    /// The column of this name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|c| c.name == name)
    }

    /// Column `name` over the first column (time), as a plot's points; `None` for an unknown name.
    pub fn points(&self, name: &str) -> Option<Vec<(f64, f64)>> {
        let time = &self.columns.first()?.values;
        let values = &self.column(name)?.values;
        Some(time.iter().copied().zip(values.iter().copied()).collect())
    }

    /// Appends a row: time, then one number per record.
    ///
    /// # Errors
    /// [`OutputError::RowWidth`] if the row doesn't have one number per column.
    pub fn push_row(&mut self, row: &[f64]) -> Result<(), OutputError> {
        check_width(self.columns.len(), row.len())?;
        for (column, value) in self.columns.iter_mut().zip(row) {
            column.values.push(*value);
        }
        Ok(())
    }

    /// The table as CSV text. Numbers are the shortest that read back to the same bits.
    ///
    /// # Errors
    /// [`OutputError::RowWidth`] if the columns differ in length.
    pub fn to_csv(&self) -> Result<String, OutputError> {
        let mut text = Csv::new(self.columns.iter().map(Column::heading)).text();
        for column in &self.columns {
            check_width(self.rows(), column.values.len())?;
        }
        for row in 0..self.rows() {
            push_line(&mut text, self.columns.iter().map(|c| c.values[row]));
        }
        Ok(text)
    }

    /// Writes the table to a CSV file, all or nothing.
    ///
    /// # Errors
    /// Columns of different lengths, or a file that can't be written.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        super::write_atomic(path, &self.to_csv()?)
    }

    /// Reads a CSV file such as [`TableWriter`] writes.
    ///
    /// # Errors
    /// A file that can't be read, or that isn't a header over rows of numbers.
    pub fn read(path: &Path) -> Result<Self, OutputError> {
        let text = fs::read_to_string(path).map_err(OutputError::io("read", path))?;
        Self::from_csv(&text, path)
    }

    /// Reads CSV text; `path` only serves error messages.
    ///
    /// A last line without its line feed was cut off when a run was killed: it is left out.
    ///
    /// # Errors
    /// [`OutputError::Csv`], with the line, if it isn't a header over rows of numbers.
    pub fn from_csv(text: &str, path: &Path) -> Result<Self, OutputError> {
        let fail = |line, message: String| OutputError::Csv { path: path.to_path_buf(), line, message };
        let whole = text.rfind('\n').map_or("", |end| &text[..end]);
        let mut lines = whole.lines().enumerate();
        let header = match lines.next() {
            Some((_, header)) if !header.trim().is_empty() => header,
            _ => return Err(fail(1, "no header line".into())),
        };
        let mut table = Self {
            columns: cells(header.trim_start_matches('\u{feff}'))
                .iter()
                .map(|heading| Column::from_heading(heading))
                .collect(),
        };
        let mut names = HashSet::new();
        if let Some(twice) = table.columns.iter().find(|c| !names.insert(&c.name)) {
            return Err(fail(1, format!("there are two columns `{}`", twice.name)));
        }
        let mut row = Vec::with_capacity(table.columns.len());
        for (index, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
            row.clear();
            let mut column = 1;
            for field in line.split(',') {
                let value = field.trim().parse::<f64>().map_err(|_| {
                    fail(index + 1, format!("column {column}: '{}' is not a number", field.trim()))
                })?;
                row.push(value);
                column += field.chars().count() + 1;
            }
            table.push_row(&row).map_err(|error| fail(index + 1, error.to_string()))?;
        }
        Ok(table)
    }
}

/// Writes a CSV table row by row while a run computes.
///
/// Every row goes to the operating system at once and in one piece, so that a run that is killed
/// keeps all that it had computed. Nothing is allocated per row.
///
/// ```no_run
/// # use ropewalk_report::{Column, OutputError, RunFolder, Table, TableWriter};
/// let folder = RunFolder::create(None, "pendulum")?;
/// let columns = Table::new([Column::new("hose.end.x", "m")]);
/// let mut history = TableWriter::create(&folder.history_file(), &columns)?;
/// history.push(&[0.0, 1.25])?;
/// history.finish()?;
/// # Ok::<(), OutputError>(())
/// ```
#[derive(Debug)]
pub struct TableWriter {
    file: File,
    path: PathBuf,
    columns: usize,
    line: String,
}

impl TableWriter {
    /// Creates the file and writes the header of `table`, and the rows it already holds.
    ///
    /// # Errors
    /// A file that can't be created, or columns of different lengths.
    pub fn create(path: &Path, table: &Table) -> Result<Self, OutputError> {
        let text = table.to_csv()?;
        let mut file = File::create(path).map_err(OutputError::io("create", path))?;
        file.write_all(text.as_bytes()).map_err(OutputError::io("write", path))?;
        Ok(Self { file, path: path.to_path_buf(), columns: table.columns.len(), line: String::new() })
    }

    /// Replaces a file by these rows, all or nothing, to go on behind them.
    ///
    /// # Errors
    /// As [`create`](Self::create).
    pub fn resume(path: &Path, table: &Table) -> Result<Self, OutputError> {
        write_durable(path, table.to_csv()?.as_bytes())?;
        let file = File::options().append(true).open(path).map_err(OutputError::io("write", path))?;
        Ok(Self { file, path: path.to_path_buf(), columns: table.columns.len(), line: String::new() })
    }

    /// Appends a row: time, then one number per record.
    ///
    /// # Errors
    /// A row of the wrong length, or a file that can't be written (a full disk).
    pub fn push(&mut self, row: &[f64]) -> Result<(), OutputError> {
        check_width(self.columns, row.len())?;
        self.line.clear();
        push_line(&mut self.line, row.iter().copied());
        self.file.write_all(self.line.as_bytes()).map_err(OutputError::io("write", &self.path))
    }

    /// Makes sure that the rows are on the disk, then closes the file.
    ///
    /// # Errors
    /// What the system reports only now, such as a full network disk.
    pub fn finish(self) -> Result<(), OutputError> {
        self.file.sync_data().map_err(OutputError::io("write", &self.path))
    }
}

fn check_width(expected: usize, found: usize) -> Result<(), OutputError> {
    if expected == found { Ok(()) } else { Err(OutputError::RowWidth { expected, found }) }
}

/// CSV text of words and numbers, cell by cell.
///
/// ```
/// let mut csv = ropewalk_report::Csv::new(["what", "x [m]"]);
/// csv.cell("a, b").number(0.5).end();
/// assert_eq!(csv.text(), "what,x [m]\n\"a, b\",0.5\n");
/// ```
#[derive(Clone, Debug, Default)]
pub struct Csv {
    text: String,
    is_behind_cell: bool,
}

impl Csv {
    /// A table with these headings and no rows yet.
    pub fn new(headings: impl IntoIterator<Item = impl AsRef<str>>) -> Self {
        let mut csv = Self::default();
        headings.into_iter().for_each(|heading| _ = csv.cell(heading));
        csv.end();
        csv
    }
    /// A cell with a text.
    pub fn cell(&mut self, text: impl AsRef<str>) -> &mut Self {
        self.separate();
        push_cell(&mut self.text, text.as_ref());
        self
    }
    /// A cell with a number, such that it reads back to the same bits.
    pub fn number(&mut self, x: f64) -> &mut Self {
        self.separate();
        push_number(&mut self.text, x);
        self
    }
    /// A cell with a number, or an empty one.
    pub fn number_or_none(&mut self, x: Option<f64>) -> &mut Self {
        match x {
            Some(x) => self.number(x),
            None => self.cell(""),
        }
    }
    /// Ends the row.
    pub fn end(&mut self) {
        self.text.push('\n');
        self.is_behind_cell = false;
    }
    /// The whole table.
    pub fn text(self) -> String {
        self.text
    }

    fn separate(&mut self) {
        if self.is_behind_cell {
            self.text.push(',');
        }
        self.is_behind_cell = true;
    }
}

/// Writes a text between two commas. It stays on one line, so that a row is a line everywhere in the file.
fn push_cell(text: &mut String, cell: &str) {
    let cell = cell.replace(['\n', '\r'], " ");
    if cell.contains([',', '"']) {
        text.push('"');
        text.push_str(&cell.replace('"', "\"\""));
        text.push('"');
    } else {
        text.push_str(&cell);
    }
}

/// Writes a number in its shortest form that reads back to the same bits.
pub fn push_number(text: &mut String, value: f64) {
    // Debug is the shortest round-trip form and, unlike Display, knows exponents.
    let _ = write!(text, "{value:?}");
    if text.ends_with(".0") {
        text.truncate(text.len() - 2);
    }
}

/// The cells of a line; what stands in quotes may hold commas.
pub fn cells(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let mut quoted = false;
    let mut chars = line.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '"' if quoted && chars.peek() == Some(&'"') => {
                chars.next();
                push_to_last(&mut fields, '"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            other => push_to_last(&mut fields, other),
        }
    }
    fields
}

fn push_to_last(fields: &mut [String], c: char) {
    if let Some(last) = fields.last_mut() {
        last.push(c);
    }
}

fn push_line(text: &mut String, row: impl Iterator<Item = f64>) {
    for (i, value) in row.enumerate() {
        if i > 0 {
            text.push(',');
        }
        push_number(text, value);
    }
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Table {
        let mut table = Table::new([Column::new("hose.end.x", "m"), Column::new("drag, \"normal\"", "")]);
        table.push_row(&[0.0, 1.0 / 3.0, f64::NAN]).unwrap();
        table.push_row(&[0.1, -1e-300, f64::INFINITY]).unwrap();
        table.push_row(&[2.0, f64::MAX, 5e-324]).unwrap();
        table
    }

    #[test]
    fn header_names_time_and_units() {
        let csv = sample().to_csv().unwrap();
        assert!(csv.starts_with("t [s],hose.end.x [m],\"drag, \"\"normal\"\" [-]\"\n0,0.333"));
        assert!(csv.contains("\n0.1,-1e-300,inf\n2,1.7976931348623157e308,5e-324\n"));
    }

    #[test]
    fn numbers_read_back_bit_for_bit() {
        let table = sample();
        let back = Table::from_csv(&table.to_csv().unwrap(), Path::new("x.csv")).unwrap();
        for (a, b) in table.columns.iter().zip(&back.columns) {
            assert_eq!((&a.name, &a.unit), (&b.name, &b.unit));
            let bits = |c: &Column| c.values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(a), bits(b));
        }
        assert_eq!(back.points("hose.end.x").unwrap()[1], (0.1, -1e-300));
        assert!(back.points("nobody").is_none());
    }

    #[test]
    fn rows_are_in_the_file_before_the_writer_is_closed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let mut writer = TableWriter::create(&path, &Table::new([Column::new("x", "m")])).unwrap();
        writer.push(&[0.0, 1.0]).unwrap();
        writer.push(&[0.5, 2.0]).unwrap();
        std::mem::forget(writer);
        let table = Table::read(&path).unwrap();
        assert_eq!(table.rows(), 2);
        assert_eq!(table.columns[1].values, [1.0, 2.0]);
    }

    #[test]
    fn a_row_cut_off_by_a_kill_is_left_out() {
        let table = Table::from_csv("t [s],x [m]\n0,1\n0.1,2.3", Path::new("x.csv")).unwrap();
        assert_eq!(table.rows(), 1);
    }

    #[test]
    fn faults_name_the_line() {
        let fault = |text| Table::from_csv(text, Path::new("a.csv")).unwrap_err().to_string();
        assert_eq!(fault("t [s]\n0\nzero\n"), "a.csv, line 3: column 1: 'zero' is not a number");
        assert!(fault("t [s],x [m]\n0,\"0,1\"\n").starts_with("a.csv, line 2: column 3: '\"0' is not"));
        assert_eq!(fault("t [s],x [m],x [N]\n0,1,2\n"), "a.csv, line 1: there are two columns `x`");
        assert!(fault("t [s],x [m]\n0\n").starts_with("a.csv, line 2: a row of 1"));
        assert_eq!(fault(""), "a.csv, line 1: no header line");
        let mut table = Table::new([]);
        assert!(table.push_row(&[0.0, 1.0]).is_err());
    }

    #[test]
    fn windows_line_ends_and_foreign_headings_are_read() {
        let table = Table::from_csv("\u{feff}time,force [N m]\r\n1,2\r\n\r\n", Path::new("a")).unwrap();
        assert_eq!(table.columns[0], Column { name: "time".into(), unit: String::new(), values: vec![1.0] });
        assert_eq!(table.columns[1].unit, "N m");
    }
}
