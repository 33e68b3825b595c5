//! Statistics of a run that is done: moments, waves, spectra and fatigue of its records, from its history.

use crate::error::Error;
use ropewalk_report::statistics::{
    Crossings, Life, Moments, Spectrum, damage, equivalent_range, rainflow, total,
};
use ropewalk_report::{
    Column, Csv, LinePlot, OutputError, RunFolder, Series, Sheet, TERMINAL, Table, number, write_atomic,
};
use ropewalk_scene::{Fault, did_you_mean};
use std::path::Path;

/// Seconds of a year, over which damage is told.
const YEAR: f64 = 365.25 * 86_400.0;

/// What is to be told of which part of a run.
#[derive(Clone, Debug, Default)]
pub struct StatisticsOptions {
    /// From what time on [s]: behind the ramp of the sea.
    pub from: f64,
    /// Up to what time [s]; without it to the end.
    pub to: Option<f64>,
    /// Columns of the history, or what their names begin with; all if there are none.
    pub records: Vec<String>,
    /// How many cycles what they show endures, if that is to be told.
    pub life: Option<Life>,
}

/// A record at equal intervals.
struct Course<'a> {
    column: &'a Column,
    dt: f64,
    values: Vec<f64>,
}

/// The part of a column within a time, at equal intervals: rows of events in between are left out by interpolation.
fn course<'a>(t: &[f64], column: &'a Column, [from, to]: [f64; 2]) -> Option<Course<'a>> {
    let points: Vec<(f64, f64)> = t
        .iter()
        .zip(&column.values)
        .filter(|(t, x)| **t >= from && **t <= to && x.is_finite())
        .map(|(t, x)| (*t, *x))
        .collect();
    let (first, last) = (points.first()?.0, points.last()?.0);
    if points.len() < 4 {
        return None;
    }
    let mut steps: Vec<f64> = points.windows(2).map(|w| w[1].0 - w[0].0).filter(|h| *h > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    let dt = *steps.get(steps.len() / 2)?;
    let count = ((last - first) / dt * (1.0 + 1e-9)).floor() as usize;
    let mut k = 0;
    let at = |i: usize| {
        let t = (first + dt * i as f64).min(last);
        while k + 2 < points.len() && points[k + 1].0 < t {
            k += 1;
        }
        let ((a, x), (b, y)) = (points[k], points[k + 1]);
        if b > a { x + (y - x) * ((t - a) / (b - a)).clamp(0.0, 1.0) } else { y }
    };
    Some(Course { column, dt, values: (0..=count).map(at).collect() })
}

/// Writes `tables/statistics.csv`, a spectrum of each record as table and picture, and with a life the cycles of each, into the
/// folder of a run, and tells of them in a table for people.
///
/// # Errors
/// There is no history, no such record, or nothing in that time; files that can't be written.
pub fn statistics(source: &Path, options: &StatisticsOptions) -> Result<String, Error> {
    let folder = RunFolder::earlier(source.to_path_buf());
    let file = folder.history_file();
    if !file.is_file() {
        let fault = Fault::new(format!("{} is no folder of a run: it has no history.csv", source.display()));
        let help = "`ropewalk run` makes one; of many runs `ropewalk sweep … --extremes` tells statistics";
        return Err(fault.with_help(help).into());
    }
    let history = Table::read(&file)?;
    let columns = chosen(&history, &options.records)?;
    let t = &history.columns[0].values;
    let end = t.last().copied().unwrap_or(0.0);
    let window = [options.from, options.to.unwrap_or(end)];
    let courses: Vec<Course<'_>> = columns.iter().filter_map(|c| course(t, c, window)).collect();
    if courses.is_empty() {
        let [from, to] = window;
        return Err(Fault::new(format!("there are fewer than four rows from {from} s to {to} s")).into());
    }
    let table = table(&courses, options.life.as_ref());
    write_atomic(&folder.table_file("statistics")?, &table.csv)?;
    let mut told: Vec<String> = Vec::new();
    for course in &courses {
        spectrum(&folder, course, &mut |text| told.push(text.to_string()))?;
        if options.life.is_some() {
            cycles(&folder, course)?;
        }
    }
    let mut sheet =
        Sheet::new(format!("Statistics of {} from {} s to {} s", source.display(), window[0], window[1]));
    sheet.table_within(TERMINAL, &table.headings, &table.rows);
    sheet.entries("warning", told);
    sheet.entry("tables", format!("{}/tables/statistics.csv, spectrum-*.csv", source.display()));
    sheet.entry("pictures", format!("{}/plots/spectrum-*.svg", source.display()));
    Ok(sheet.to_string())
}

/// The columns that are asked for.
fn chosen<'a>(history: &'a Table, records: &[String]) -> Result<Vec<&'a Column>, Error> {
    let all = &history.columns[1.min(history.columns.len())..];
    if records.is_empty() {
        return Ok(all.iter().collect());
    }
    let mut found: Vec<&Column> = Vec::new();
    for record in records {
        let of: Vec<&Column> =
            all.iter().filter(|c| c.name == *record || c.name.starts_with(&format!("{record}."))).collect();
        if of.is_empty() {
            let names: Vec<&str> = all.iter().map(|c| c.name.as_str()).collect();
            let fault = Fault::new(format!("there is no record `{record}` in the history"));
            let fault = fault.with_note(format!("there are {}", names.join(", ")));
            return Err(match did_you_mean(record, &names) {
                Some(guess) => fault.with_help(guess),
                None => fault,
            }
            .into());
        }
        found.extend(of);
    }
    Ok(found)
}

/// The table, for programs and for people.
struct Told {
    csv: String,
    headings: Vec<String>,
    rows: Vec<Vec<String>>,
}

fn table(courses: &[Course<'_>], life: Option<&Life>) -> Told {
    let mut headings: Vec<String> = [
        "record",
        "mean",
        "deviation",
        "least",
        "largest",
        "skewness",
        "kurtosis",
        "crossings",
        "period [s]",
        "significant range",
    ]
    .map(String::from)
    .to_vec();
    if let Some(life) = life {
        headings.extend(["cycles", "damage", "damage a year"].map(String::from));
        headings.push(format!("range at 1 Hz, m = {}", life.m));
    }
    let mut csv = Csv::new(&headings);
    let mut rows = Vec::new();
    for course in courses {
        let Some(m) = Moments::of(&course.values) else { continue };
        let waves = Crossings::of(&course.values, course.dt);
        let mut values = vec![
            Some(m.mean),
            Some(m.deviation),
            Some(m.least),
            Some(m.greatest),
            Some(m.skewness),
            Some(m.kurtosis),
            Some(waves.times.len() as f64),
            waves.period(),
            waves.significant_range(),
        ];
        if let Some(life) = life {
            let duration = course.dt * course.values.len() as f64;
            let cycles = rainflow(&course.values);
            let done = damage(&cycles, |c| life.cycles(c));
            values.extend([
                Some(total(&cycles)),
                Some(done),
                Some(done * YEAR / duration),
                Some(equivalent_range(&cycles, life.m, duration)),
            ]);
        }
        let name = course.column.heading();
        csv.cell(&name);
        values.iter().for_each(|x| _ = csv.number_or_none(*x));
        csv.end();
        rows.push(
            std::iter::once(name).chain(values.iter().map(|x| x.map_or(String::new(), number))).collect(),
        );
    }
    Told { csv: csv.text(), headings, rows }
}

/// The spectrum of a record, from about eight pieces of it.
fn spectrum(folder: &RunFolder, course: &Course<'_>, warn: &mut dyn FnMut(&str)) -> Result<(), Error> {
    let length = Spectrum::length_for(course.values.len());
    let Some(s) = Spectrum::welch(&course.values, course.dt, length) else { return Ok(()) };
    let column = course.column;
    let unit = if column.unit.is_empty() { "1/Hz".to_string() } else { format!("({})^2/Hz", column.unit) };
    let name = format!("spectrum-{}", column.name);
    let table = Table {
        columns: vec![
            Column { values: s.frequencies.clone(), ..Column::new("f", "Hz") },
            Column { values: s.densities.clone(), ..Column::new("density", &unit) },
        ],
    };
    table.write(&folder.table_file(&name)?)?;
    let points = s.frequencies.iter().copied().zip(s.densities.iter().copied()).collect();
    let plot = LinePlot {
        title: format!("Spectrum of {}", column.name),
        x_label: "f [Hz]".into(),
        y_label: format!("density [{unit}]"),
        series: vec![Series::new(&column.name, points)],
        ..LinePlot::default()
    };
    folder.draw(&name, |path| plot.write(path), warn);
    Ok(())
}

/// The cycles of a record by rainflow counting.
fn cycles(folder: &RunFolder, course: &Course<'_>) -> Result<(), OutputError> {
    let all = rainflow(&course.values);
    let unit = &course.column.unit;
    let column = |name: &str, unit: &str, of: fn(&ropewalk_report::statistics::Cycle) -> f64| Column {
        values: all.iter().map(of).collect(),
        ..Column::new(name, unit)
    };
    let table = Table {
        columns: vec![
            column("range", unit, |c| c.range),
            column("mean", unit, |c| c.mean),
            column("count", "", |c| c.count),
        ],
    };
    table.write(&folder.table_file(&format!("cycles-{}", course.column.name))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_events_do_not_disturb_a_course() {
        let t: Vec<f64> = (0..100)
            .map(|k| 0.1 * f64::from(k))
            .flat_map(|t| if (t - 3.0).abs() < 1e-9 { vec![t, t + 0.03] } else { vec![t] })
            .collect();
        let column = Column { values: t.iter().map(|t| 2.0 * t + 1.0).collect(), ..Column::new("x", "m") };
        let c = course(&t, &column, [1.0, 8.0]).expect("course");
        assert!((c.dt - 0.1).abs() < 1e-9 && c.values.len() == 71);
        assert!(c.values.iter().enumerate().all(|(k, x)| (x - (3.0 + 0.2 * k as f64)).abs() < 1e-9));
    }
}
