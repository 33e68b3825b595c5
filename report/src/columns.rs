//! Rows of text in columns, for the terminal.

use std::fmt::Write;

/// Width of a table, in characters.
const WIDTH: usize = 118;

/// Columns under their headings, numbers to the right, as many as there is room for; and how many these are.
pub fn in_columns(headings: &[String], rows: &[Vec<String>]) -> (String, usize) {
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
        let (text, columns) = in_columns(&strings(&["speed [kn]", "status", "z [m]"]), &rows);
        let expected =
            "  speed [kn]  status    z [m]\n           5  finished   -1.5\n          15  failed      NaN\n";
        assert_eq!((text.as_str(), columns), (expected, 3));
        let wide = strings(&["a", &"b".repeat(100), &"c".repeat(20)]);
        assert_eq!(in_columns(&wide, std::slice::from_ref(&wide)).1, 2);
    }
}
