//! A report for the terminal: lines behind labels, and tables in columns.

use std::fmt::{self, Display, Write};

/// Width of a terminal, in characters.
pub const TERMINAL: usize = 118;

/// A report that grows line by line. What stands behind a label is indented by as much everywhere.
///
/// ```
/// let mut sheet = ropewalk_report::Sheet::new("A cable");
/// sheet.entry("steps", 25);
/// sheet.entries("notes", ["one", "two"]);
/// assert_eq!(sheet.to_string(), "A cable\n  steps     25\n  notes     one\n            two\n");
/// ```
#[derive(Clone, Debug)]
pub struct Sheet {
    text: String,
    label_width: usize,
}

impl Default for Sheet {
    fn default() -> Self {
        Sheet { text: String::new(), label_width: 9 }
    }
}

impl Sheet {
    /// A report under a title.
    pub fn new(title: impl Display) -> Self {
        Sheet { text: format!("{title}\n"), ..Sheet::default() }
    }
    /// The same with room for longer labels, in characters.
    #[must_use]
    pub fn with_labels(self, label_width: usize) -> Self {
        Sheet { label_width, ..self }
    }
    /// A line as it is.
    pub fn line(&mut self, text: impl Display) {
        _ = writeln!(self.text, "{text}");
    }
    /// A line behind a label.
    pub fn entry(&mut self, label: &str, text: impl Display) {
        _ = writeln!(self.text, "  {label:<0$} {text}", self.label_width);
    }
    /// Lines of which the first stands behind the label.
    pub fn entries<T: Display>(&mut self, label: &str, texts: impl IntoIterator<Item = T>) {
        for (k, text) in texts.into_iter().enumerate() {
            self.entry(if k == 0 { label } else { "" }, text);
        }
    }
    /// Columns under their headings, numbers to the right.
    pub fn table(&mut self, headings: &[impl AsRef<str>], rows: &[Vec<String>]) {
        self.table_within(usize::MAX, headings, rows);
    }
    /// The same with as many columns as `width` has room for; gives their number.
    pub fn table_within(
        &mut self,
        width: usize,
        headings: &[impl AsRef<str>],
        rows: &[Vec<String>],
    ) -> usize {
        let headings: Vec<String> = headings.iter().map(|h| h.as_ref().to_string()).collect();
        let wide = |c: usize| {
            let cells = rows.iter().map(|row| &row[c]).chain([&headings[c]]);
            cells.map(|text| text.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..headings.len()).map(wide).collect();
        let mut room = width;
        let fitting = widths.iter().take_while(|w| {
            let fits = room >= **w + 2;
            room = room.saturating_sub(**w + 2);
            fits
        });
        let columns = fitting.count();
        let numeric: Vec<bool> =
            (0..columns).map(|c| rows.iter().all(|row| begins_as_number(&row[c]))).collect();
        for row in [headings.as_slice()].into_iter().chain(rows.iter().map(Vec::as_slice)) {
            let mut line = String::new();
            for (c, text) in row.iter().enumerate().take(columns) {
                let width = widths[c];
                _ = match numeric[c] {
                    true => write!(line, "  {text:>width$}"),
                    false => write!(line, "  {text:<width$}"),
                };
            }
            self.line(line.trim_end());
        }
        columns
    }
}

impl Display for Sheet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// Whether a cell belongs to a column of numbers: nothing, a number with or without its unit, or a word in its place.
fn begins_as_number(text: &str) -> bool {
    let digits = text.strip_prefix('-').unwrap_or(text);
    digits.starts_with(|c: char| c.is_ascii_digit())
        || matches!(digits, "" | "NaN" | "inf" | "failed" | "fails")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_the_columns_that_it_has_room_for() {
        let strings = |list: &[&str]| list.iter().map(|s| (*s).to_string()).collect::<Vec<_>>();
        let rows = [strings(&["5", "finished", "-1.5"]), strings(&["15", "failed", "NaN"])];
        let mut sheet = Sheet::default();
        let columns = sheet.table_within(TERMINAL, &["speed [kn]", "status", "z [m]"], &rows);
        let expected =
            "  speed [kn]  status    z [m]\n           5  finished   -1.5\n          15  failed      NaN\n";
        assert_eq!((sheet.to_string().as_str(), columns), (expected, 3));
        let wide = strings(&["a", &"b".repeat(100), &"c".repeat(20)]);
        assert_eq!(Sheet::default().table_within(TERMINAL, &wide, std::slice::from_ref(&wide)), 2);
    }
}
