//! Extremes of runs that differ in a seed: what the largest value of a record is likely to be, and how sure that is.

use super::grid::Grid;
use super::results::Results;
use crate::study::StudyFolder;
use ropewalk_report::statistics::{Gumbel, Interval, Moments};
use ropewalk_report::{Csv, LinePlot, Mark, OutputError, Series, number, write_atomic};

/// Fewer runs than this tell nothing of extremes.
const FEWEST: usize = 3;
/// The quantile that designers ask for beside the most probable value, and how sure the intervals are.
const QUANTILE: f64 = 0.9;
const CONFIDENCE: f64 = 0.95;

/// One end of a record over the runs of a line.
struct Extreme {
    record: String,
    heading: String,
    line: String,
    /// 1 of largest values, -1 of least ones.
    side: f64,
    values: Vec<f64>,
    gumbel: Gumbel,
    /// The most probable extreme, and that which is passed once in ten such runs.
    probable: Interval,
    quantile: Interval,
}

impl Extreme {
    fn new(record: &str, heading: &str, line: &str, side: f64, values: Vec<f64>) -> Option<Self> {
        let mirrored: Vec<f64> = values.iter().map(|x| side * x).collect();
        let gumbel = Gumbel::by_l_moments(&mirrored).filter(|g| g.scale > 0.0)?;
        let at = |p: f64| {
            let i = Gumbel::bootstrap(&mirrored, p, CONFIDENCE)?;
            let [a, b] = [side * i.low, side * i.high];
            Some(Interval { value: side * i.value, low: a.min(b), high: a.max(b) })
        };
        // the location of Gumbel's distribution is its most probable value
        let (probable, quantile) = (at((-1f64).exp())?, at(QUANTILE)?);
        let (record, heading, line) = (record.into(), heading.into(), line.into());
        Some(Extreme { record, heading, line, side, values, gumbel, probable, quantile })
    }

    fn what(&self) -> &'static str {
        if self.side > 0.0 { "largest" } else { "least" }
    }

    /// Values over Gumbel's reduced variate: on a straight line if they are distributed so.
    fn paper(&self) -> LinePlot {
        let mut sorted: Vec<f64> = self.values.iter().map(|x| self.side * x).collect();
        sorted.sort_by(f64::total_cmp);
        let n = sorted.len() as f64;
        let variate = |p: f64| -(-p.ln()).ln();
        let dots =
            sorted.iter().enumerate().map(|(k, x)| (variate((k as f64 + 0.56) / (n + 0.12)), self.side * x));
        let line = [0.02, 0.99].map(|p| (variate(p), self.side * self.gumbel.quantile(p)));
        let of = if self.line.is_empty() { String::new() } else { format!(", {}", self.line) };
        LinePlot {
            title: format!("Extremes of {}{of}: {} of each run", self.record, self.what()),
            x_label: "-ln(-ln P) [-]".into(),
            y_label: self.heading.clone(),
            series: vec![
                Series::new("runs", dots.collect()).with_mark(Mark::Dots),
                Series::new("Gumbel", line.into()),
            ],
            ..LinePlot::default()
        }
    }
}

/// Writes `tables/extremes.csv` and a picture of each end of each record on Gumbel's paper, and tells of them in lines for
/// people. Runs belong together that differ in nothing but the first parameter.
pub(super) fn write(
    folder: &StudyFolder,
    grid: &Grid,
    results: &Results,
    warn: &mut dyn FnMut(&str),
) -> Vec<String> {
    let mut all: Vec<Extreme> = Vec::new();
    for column in results.recorded().iter().skip(1) {
        let mut lines: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
        for (k, row) in results.rows().filter(|(_, row)| row.status.is_complete()) {
            let Some(v) = Results::values(row, column) else { continue };
            let name = grid.line(k);
            let ends = [v.least, v.largest];
            match lines.iter_mut().find(|(have, _)| *have == name) {
                Some((_, values)) => values.push(ends),
                None => lines.push((name, vec![ends])),
            }
        }
        for (line, values) in lines.iter().filter(|(_, values)| values.len() >= FEWEST) {
            for (k, side) in [(1, 1.0), (0, -1.0)] {
                let values = values.iter().map(|v| v[k]).collect();
                all.extend(Extreme::new(&column.name, &column.heading, line, side, values));
            }
        }
    }
    if all.is_empty() {
        warn(&format!(
            "extremes need {FEWEST} runs or more that differ in the first parameter alone, such as `seed=1:10:1`"
        ));
        return Vec::new();
    }
    let files = folder.files();
    let written: Result<(), OutputError> =
        files.table_file("extremes").and_then(|path| write_atomic(&path, &table(&all)));
    written.unwrap_or_else(|e| warn(&e.to_string()));
    for x in &all {
        let line: String = x.line.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
        let name =
            format!("extremes-{}-{}{}{line}", x.record, x.what(), if line.is_empty() { "" } else { "-" });
        files.draw(&name, |path| x.paper().write(path), warn);
    }
    let told = |x: &Extreme| {
        let of = if x.line.is_empty() { String::new() } else { format!(" ({})", x.line) };
        let [p, q] = [&x.probable, &x.quantile]
            .map(|i| format!("{} ({} … {})", number(i.value), number(i.low), number(i.high)));
        format!(
            "{} {}{of}: most probable {p}, once in ten runs {q}; {} runs",
            x.what(),
            x.heading,
            x.values.len()
        )
    };
    all.iter().map(told).collect()
}

fn table(all: &[Extreme]) -> String {
    let mut csv = Csv::new([
        "record",
        "runs with",
        "extreme",
        "runs",
        "mean",
        "deviation",
        "location",
        "scale",
        "most probable",
        "95 % from",
        "95 % to",
        "once in ten runs",
        "95 % from ",
        "95 % to ",
    ]);
    for x in all {
        csv.cell(&x.heading).cell(&x.line).cell(x.what());
        let m = Moments::of(&x.values);
        csv.number(x.values.len() as f64);
        csv.number_or_none(m.map(|m| m.mean)).number_or_none(m.map(|m| m.deviation));
        csv.number(x.side * x.gumbel.location).number(x.gumbel.scale);
        for i in [&x.probable, &x.quantile] {
            csv.number(i.value).number(i.low).number(i.high);
        }
        csv.end();
    }
    csv.text()
}
