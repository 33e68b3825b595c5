//! Figures of one's own: columns of a history, or of the table of a sweep, over another column.

use crate::error::Error;
use crate::run::Status;
use ropewalk_report::plot::Raster;
use ropewalk_report::{LinePlot, Mark, OutputError, Panels, RunFolder, Series, cells};
use ropewalk_scene::Fault;
use std::path::{Path, PathBuf};

/// How a figure looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// With a title, curves by colour.
    #[default]
    Screen,
    /// Without a title, which the caption of a paper says, and with dashes besides, for print in grey.
    Paper,
}

/// A figure of the run or sweep at `source`, a folder or a CSV file: `records`, each a column or the stem of some, over
/// `against`; without it over time, or over the first parameter of a sweep. There is a plot for each unit. In a sweep
/// runs that differ in other parameters are curves of their own.
///
/// # Errors
/// There is no such table or column, or nothing to draw.
pub fn figure(
    source: &Path,
    records: &[String],
    against: Option<&str>,
    style: Style,
) -> Result<Panels, Error> {
    let sheet = Sheet::open(source)?;
    let x = match against {
        Some(name) => *sheet.find(name)?.first().unwrap_or(&0),
        None => sheet.first(),
    };
    let mut shown: Vec<usize> = Vec::new();
    for record in records {
        let found = sheet.find(record)?;
        shown.extend(found.into_iter().filter(|k| *k != x));
    }
    shown.dedup();
    let mut units: Vec<&str> = shown.iter().map(|k| sheet.unit(*k)).collect();
    units.sort_by_key(|unit| shown.iter().position(|k| sheet.unit(*k) == *unit));
    units.dedup();
    let plots = units.iter().map(|unit| {
        let of_unit: Vec<usize> = shown.iter().copied().filter(|k| sheet.unit(*k) == *unit).collect();
        sheet.plot(x, &of_unit, style, against.is_some())
    });
    let panels: Vec<LinePlot> = plots.collect();
    let title = if style == Style::Paper { String::new() } else { sheet.name.clone() };
    Ok(Panels { title, columns: 1, panels })
}

/// Writes a figure as SVG; as PNG or PDF too, where the program was built with the feature `raster`.
///
/// # Errors
/// Another kind of picture is asked for; a file that can't be written.
pub fn write_figure(figure: &Panels, path: &Path) -> Result<(), Error> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    if ending == "svg" {
        return Ok(figure.write(path)?);
    }
    let shown = path.display();
    let Some(kind) = Raster::of(&ending) else {
        let message = format!("figures are drawn as .svg, .png or .pdf, not as `{shown}`");
        return Err(Fault::new(message).into());
    };
    let bytes = kind.picture(&figure.svg()?).map_err(|why| {
        let help = match Raster::THERE {
            true => "write an .svg file instead",
            false => {
                "build it with `cargo build --release --features raster`, or write an .svg file: browsers, word processors \
                 and LaTeX (\\includesvg) read it, and rsvg-convert or Inkscape make PDF and PNG of it"
            }
        };
        Fault::new(format!("`{shown}` can't be drawn: {why}")).with_help(help)
    })?;
    std::fs::write(path, bytes).map_err(OutputError::io("write", path))?;
    Ok(())
}

/// A table whose cells may be text.
struct Sheet {
    /// What it is of.
    name: String,
    headings: Vec<String>,
    rows: Vec<Vec<String>>,
    /// Columns of a sweep that are parameters.
    parameters: std::ops::Range<usize>,
}

impl Sheet {
    fn open(source: &Path) -> Result<Self, Error> {
        let path = table_of(source)?;
        let text = std::fs::read_to_string(&path).map_err(OutputError::io("read", &path))?;
        // a line without its end was cut off when a run was killed
        let whole = text.rfind('\n').map_or("", |end| &text[..end]);
        let mut lines = whole.lines().filter(|line| !line.trim().is_empty());
        let headings = lines.next().map(cells).unwrap_or_default();
        let mut rows = Vec::new();
        for (k, line) in lines.enumerate() {
            let row = cells(line);
            if row.len() != headings.len() {
                let message = format!("{} cells under {} headings", row.len(), headings.len());
                return Err(OutputError::Csv { path, line: k + 2, message }.into());
            }
            rows.push(row);
        }
        let status = headings.iter().position(|h| h == "status");
        let parameters = match (headings.first().map(String::as_str), status) {
            (Some("run"), Some(status)) => 1..status,
            _ => 0..0,
        };
        let folder = source.canonicalize().unwrap_or_else(|_| source.to_path_buf());
        let name = folder.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Sheet { name, headings, rows, parameters })
    }

    /// Name of a column, without its unit.
    fn column(&self, k: usize) -> &str {
        let heading = &self.headings[k];
        heading.rsplit_once(" [").map_or(heading.as_str(), |(name, _)| name)
    }

    fn unit(&self, k: usize) -> &str {
        let heading = &self.headings[k];
        heading.rsplit_once(" [").map_or("-", |(_, unit)| unit.trim_end_matches(']'))
    }

    /// What figures are drawn over unless something else is asked for.
    fn first(&self) -> usize {
        if self.parameters.is_empty() { 0 } else { self.parameters.start }
    }

    /// The column of this name; of a sweep that of last values; or all whose names begin so.
    fn find(&self, name: &str) -> Result<Vec<usize>, Error> {
        let all = || (0..self.headings.len()).map(|k| (k, self.column(k)));
        let exact = |wanted: &str| all().find(|(_, own)| *own == wanted).map(|(k, _)| vec![k]);
        let begins = |stem: String| {
            let found: Vec<usize> = all().filter(|(_, own)| own.starts_with(&stem)).map(|(k, _)| k).collect();
            (!found.is_empty()).then_some(found)
        };
        let found = exact(name)
            .or_else(|| exact(&format!("final {name}")))
            .or_else(|| begins(format!("{name}.")))
            .or_else(|| begins(format!("final {name}.")));
        found.ok_or_else(|| {
            let names: Vec<&str> = all().map(|(_, own)| own).filter(|own| *own != "message").collect();
            let fault = Fault::new(format!("there is no column `{name}` in {}", self.name));
            let shown = names.iter().take(30).copied().collect::<Vec<_>>().join(", ");
            let more = if names.len() > 30 { ", …" } else { "" };
            let fault = fault.with_note(format!("there are {shown}{more}"));
            match ropewalk_scene::did_you_mean(name, &names) {
                Some(guess) => fault.with_help(guess).into(),
                None => fault.into(),
            }
        })
    }

    /// A value; of a run of a sweep that didn't come to its end none, wherever it ended.
    fn number(&self, row: &[String], k: usize) -> f64 {
        let status = self.parameters.end;
        let ended = [Status::Finished, Status::Stopped].map(|s| s.to_string());
        if !self.parameters.is_empty() && k > status && !ended.contains(&row[status]) {
            return f64::NAN;
        }
        row[k].trim().parse().unwrap_or(f64::NAN)
    }

    /// Columns of one unit over another column; a curve for each set of the other parameters.
    fn plot(&self, x: usize, columns: &[usize], style: Style, chosen: bool) -> LinePlot {
        let others: Vec<usize> = self.parameters.clone().filter(|k| *k != x).collect();
        let set = |row: &[String]| {
            let word = |k: &usize| format!("{} = {}", self.column(*k), row[*k]);
            others.iter().map(word).collect::<Vec<_>>().join(", ")
        };
        let mut sets: Vec<String> = Vec::new();
        for row in &self.rows {
            let own = set(row);
            if !sets.contains(&own) {
                sets.push(own);
            }
        }
        let mut series = Vec::new();
        for &k in columns {
            for own in &sets {
                let rows = self.rows.iter().filter(|row| set(row) == *own);
                let mut points: Vec<(f64, f64)> =
                    rows.map(|row| (self.number(row, x), self.number(row, k))).collect();
                let mut label = self.column(k).strip_prefix("final ").unwrap_or(self.column(k)).to_string();
                if !own.is_empty() {
                    label = if columns.len() > 1 { format!("{label}, {own}") } else { own.clone() };
                }
                let mark = if self.parameters.is_empty() { Mark::Line } else { Mark::LineAndDots };
                if self.parameters.contains(&x) {
                    points.sort_by(|a, b| a.0.total_cmp(&b.0));
                }
                series.push(Series::new(label, points).with_mark(mark));
            }
        }
        let names = columns.iter().map(|k| self.column(*k)).collect::<Vec<_>>();
        let unit = self.unit(columns.first().copied().unwrap_or(0));
        let y = if names.len() <= 3 { names.join(", ") } else { stem(&names) };
        let lengths = chosen && self.unit(x) == "m" && unit == "m" && self.parameters.is_empty();
        LinePlot {
            x_label: format!("{} [{}]", self.column(x), self.unit(x)),
            y_label: format!("{y} [{unit}]"),
            series,
            equal_axes: lengths,
            dashed: style == Style::Paper,
            ..LinePlot::default()
        }
    }
}

/// What names begin with alike, up to a point.
fn stem(names: &[&str]) -> String {
    let first = names.first().copied().unwrap_or_default();
    let alike = |n: &usize| names.iter().all(|name| name.get(..*n) == first.get(..*n));
    let shared = (0..=first.len()).rev().filter(|n| first.is_char_boundary(*n)).find(alike).unwrap_or(0);
    let text = first[..shared].trim_end_matches('.');
    if text.is_empty() { "value".into() } else { text.to_string() }
}

/// The table of a folder, or the file itself.
fn table_of(source: &Path) -> Result<PathBuf, Fault> {
    let shown = source.display();
    if source.is_file() {
        return Ok(source.to_path_buf());
    }
    let run = RunFolder::earlier(source.to_path_buf());
    let tables = [run.history_file(), source.join("table.csv")];
    let what = if source.exists() { "holds neither history.csv nor table.csv" } else { "doesn't exist" };
    tables.into_iter().find(|path| path.is_file()).ok_or_else(|| {
        Fault::new(format!("there is nothing to draw in {shown}: it {what}"))
            .with_help("name the folder of a run or of a sweep, or a CSV file")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strings(names: &[&str]) -> Vec<String> {
        names.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn columns_are_found_by_their_names_and_stems_and_drawn_by_unit() {
        let folder = tempfile::tempdir().unwrap();
        let text = "t [s],end.x [m],end.z [m],end.tension [N]\n0,1,2,3\n1,2,3,4\n2,0,0,5";
        std::fs::write(folder.path().join("history.csv"), text).unwrap();
        let both = figure(folder.path(), &strings(&["end"]), None, Style::Screen).unwrap();
        assert_eq!(both.panels.len(), 2);
        assert_eq!(both.panels[0].y_label, "end.x, end.z [m]");
        // the last row was cut off
        assert_eq!(both.panels[1].series[0].points, [(0.0, 3.0), (1.0, 4.0)]);
        let path = figure(folder.path(), &strings(&["end.z"]), Some("end.x"), Style::Paper).unwrap();
        let plot = &path.panels[0];
        assert!(plot.equal_axes && plot.dashed && path.title.is_empty());
        assert_eq!((plot.x_label.as_str(), plot.series[0].points[1]), ("end.x [m]", (2.0, 3.0)));
        let fault =
            figure(folder.path(), &strings(&["end.y"]), None, Style::Screen).err().unwrap().to_string();
        assert!(fault.contains("no column `end.y`") && fault.contains("end.tension"), "{fault}");
        let out = folder.path().join("fig.pdf");
        match write_figure(&path, &out) {
            Ok(()) => assert!(Raster::THERE && std::fs::read(&out).unwrap().starts_with(b"%PDF-")),
            Err(fault) => {
                let fault = fault.to_string();
                assert!(!Raster::THERE && fault.contains("--features raster"), "{fault}");
            }
        }
        let fault = write_figure(&path, &out.with_extension("jpg")).err().unwrap().to_string();
        assert!(fault.contains(".svg, .png or .pdf"), "{fault}");
        write_figure(&path, &out.with_extension("svg")).unwrap();
    }

    #[test]
    fn runs_of_a_sweep_are_curves_over_a_parameter() {
        let folder = tempfile::tempdir().unwrap();
        let text = "run,speed [m/s],law,status,final end.z [m],message\n\
                    a,2,one,finished,-1,\nb,1,one,finished,-2,\nc,1,two,finished,-3,\"x, y\"\nd,2,two,failed,-9,\n";
        std::fs::write(folder.path().join("table.csv"), text).unwrap();
        let panels = figure(folder.path(), &strings(&["end.z"]), None, Style::Screen).unwrap();
        let plot = &panels.panels[0];
        let labels: Vec<&str> = plot.series.iter().map(|s| s.label.as_str()).collect();
        assert_eq!(labels, ["law = one", "law = two"]);
        assert_eq!(plot.series[0].points, [(1.0, -2.0), (2.0, -1.0)]);
        assert!(plot.series[1].points[1].1.is_nan(), "what failed is a gap");
        assert_eq!(plot.x_label, "speed [m/s]");
    }

    #[test]
    fn the_axis_of_many_columns_is_named_by_what_they_share() {
        assert_eq!(stem(&["hose.end.x", "hose.end.y"]), "hose.end");
        assert_eq!(stem(&["a", "b"]), "value");
    }
}
