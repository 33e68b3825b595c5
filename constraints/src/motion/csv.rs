//! Columns of CSV files.

use ropewalk_scene::{did_you_mean, file, quantity};
use std::path::Path;

/// A table longer than this [bytes] is surely none that drives a motion.
const LARGEST: u64 = 256 << 20;

/// A cell: what stands there, and its first column in the line, counted in characters from 1.
struct Cell {
    text: String,
    column: usize,
}

/// The cells of a line, without spaces around them; what stands in quotes may hold commas.
fn cells(line: &str) -> Vec<Cell> {
    let mut all = vec![Cell { text: String::new(), column: 1 }];
    let mut quoted = false;
    for (k, c) in line.chars().enumerate() {
        match (c, all.last_mut()) {
            ('"', _) => quoted = !quoted,
            (',', _) if !quoted => all.push(Cell { text: String::new(), column: k + 2 }),
            (c, Some(cell)) => cell.text.push(c),
            (_, None) => {}
        }
    }
    for cell in &mut all {
        cell.text = cell.text.trim().to_string();
    }
    all
}

/// A column that is looked for.
pub(crate) struct Wanted<'a> {
    pub name: &'a str,
    pub kind: &'a quantity::Kind,
    /// Whether it must be there; one that isn't holds zeros.
    pub needed: bool,
}

/// What was read.
pub(crate) struct Columns<const N: usize> {
    pub rows: Vec<[f64; N]>,
    /// The line of each row, counted from 1.
    pub lines: Vec<usize>,
    /// Which columns are there.
    pub found: [bool; N],
    /// The line that names the columns.
    pub header: usize,
}

/// Reads columns of these names and kinds; others are left alone. The first line of the file names them, with their units
/// in brackets or without in SI units, as in this `example`.
///
/// # Errors
/// The file can't be read; a column is missing or there twice; a line has more or fewer cells than the first, or one that
/// is no number. With file, line and column.
pub(crate) fn columns<const N: usize>(
    path: &str,
    wanted: [Wanted<'_>; N],
    example: &str,
) -> Result<Columns<N>, String> {
    let text = file::text(Path::new(path), LARGEST).map_err(|e| format!("can't read {path}: {e}"))?;
    let at = |line: usize, message: String| format!("{path}, line {line}: {message}");
    let inside = |line: usize, cell: &Cell, message: &str| {
        format!("{path}, line {line}, column {}: {message}", cell.column)
    };
    let mut lines =
        text.trim_start_matches('\u{feff}').lines().enumerate().filter(|(_, l)| !l.trim().is_empty());
    let Some((first, header)) = lines.next() else { return Err(at(1, "the file is empty".into())) };
    let first = first + 1;
    let header = cells(header);
    let headings: Vec<(&str, &str)> = header
        .iter()
        .map(|h| match h.text.strip_suffix(']').and_then(|h| h.split_once('[')) {
            Some((name, unit)) => (name.trim(), unit.trim()),
            None => (h.text.as_str(), ""),
        })
        .collect();
    let mut places = [None; N];
    for (place, Wanted { name, kind, needed }) in places.iter_mut().zip(&wanted) {
        let mut all = (0..headings.len()).filter(|k| headings[*k].0 == *name);
        let Some(k) = all.next() else {
            if !needed {
                // one that isn't read may be meant, unless its name is that of another
                let others = headings.iter().filter(|h| wanted.iter().all(|w| w.name != h.0));
                if let Some(near) = others.map(|h| h.0).find(|h| did_you_mean(h, &[name]).is_some()) {
                    let message = format!("there is no column `{near}` to be read; did you mean `{name}`?");
                    return Err(at(first, message));
                }
                continue;
            }
            let message = format!("there is no column `{name}`; the first line must be like `{example}`");
            return Err(at(first, message));
        };
        if let Some(twice) = all.next() {
            return Err(inside(first, &header[twice], &format!("there is a column `{name}` already")));
        }
        let unit = headings[k].1;
        if !unit.is_empty() {
            let wrong = |e| inside(first, &header[k], &format!("column `{name}`: {e}"));
            kind.parse(&format!("1 {unit}")).map_err(wrong)?;
        }
        *place = Some((k, unit));
    }
    let (mut rows, mut numbers) = (Vec::new(), Vec::new());
    for (n, line) in lines {
        let (n, cells) = (n + 1, cells(line));
        if cells.len() != headings.len() {
            return Err(at(n, format!("there are {} columns, not {}", cells.len(), headings.len())));
        }
        let mut row = [0.0; N];
        for ((x, place), Wanted { kind, .. }) in row.iter_mut().zip(&places).zip(&wanted) {
            let Some((k, unit)) = *place else { continue };
            let cell = &cells[k];
            let number = cell.text.parse::<f64>().map_err(|_| {
                let hint = if cell.text.contains(',') { ": write a decimal point" } else { "" };
                inside(n, cell, &format!("`{}` is not a number{hint}", cell.text))
            })?;
            if !number.is_finite() {
                return Err(inside(n, cell, &format!("`{}` is not a finite number", cell.text)));
            }
            *x = match unit.is_empty() {
                true => number,
                false => kind.parse(&format!("{} {unit}", cell.text)).map_err(|e| inside(n, cell, &e))?,
            };
        }
        rows.push(row);
        numbers.push(n);
    }
    Ok(Columns { rows, lines: numbers, found: places.map(|p| p.is_some()), header: first })
}
