//! Statistics of some records over a time: their table, spectra and cycles.

use super::course::{Course, course};
use ropewalk_report::statistics::{
    Crossings, Cycle, Life, Moments, Spectrum, damage, equivalent_range, rainflow, total,
};
use ropewalk_report::{
    Column, Csv, LinePlot, Listing, OutputError, RunFolder, Series, Table, number, write_atomic,
};
use ropewalk_scene::{FatigueSpec, Fault, StatisticsSpec, did_you_mean};

/// Seconds of a year, over which damage is told.
const YEAR: f64 = 365.25 * 86_400.0;

/// What is to be told of which records and of which time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Asked {
    /// Name of the table.
    pub name: String,
    /// Columns of the history, or what their names begin with; all if there are none.
    pub records: Vec<String>,
    pub window: [f64; 2],
    /// How many cycles what they show endures, and the unit of the records that it is for; an empty one is for all.
    pub life: Option<(Life, String)>,
}

impl Asked {
    /// What a scene asks for, of a run that ended at `end` [s].
    pub fn of(spec: &StatisticsSpec, end: f64) -> Self {
        let life = |fatigue: &FatigueSpec| {
            let (strength, unit) = fatigue.strength().ok()?;
            let beyond = fatigue.second_slope.map(|second| (second.beyond, second.m));
            let life = Life { strength, k: fatigue.k, m: fatigue.m, beyond, mean_load: fatigue.mean_load };
            Some((life, unit.to_string()))
        };
        Asked {
            name: spec.name().into(),
            records: spec.of.clone(),
            window: [spec.from, spec.to.unwrap_or(end).min(end)],
            life: spec.fatigue.as_ref().and_then(life),
        }
    }

    /// The set that the table is about, as part of the names of other files.
    fn stem(&self) -> String {
        if self.name == "statistics" { String::new() } else { format!("{}-", self.name) }
    }

    /// The life of a record, if it has one.
    fn life_of(&self, column: &Column) -> Option<&Life> {
        self.life.as_ref().filter(|(_, unit)| unit.is_empty() || *unit == column.unit).map(|(life, _)| life)
    }
}

/// The columns that are asked for.
pub(crate) fn chosen<'a>(history: &'a Table, records: &[String]) -> Result<Vec<&'a Column>, Fault> {
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
            });
        }
        found.extend(of);
    }
    Ok(found)
}

/// What was found.
pub(crate) struct Set<'a> {
    asked: Asked,
    courses: Vec<Course<'a>>,
    headings: Vec<String>,
    /// A name and numbers for each record.
    rows: Vec<(String, Vec<Option<f64>>)>,
}

impl<'a> Set<'a> {
    /// Of a history.
    ///
    /// # Errors
    /// No such record, or nothing in that time.
    pub fn new(asked: Asked, history: &'a Table) -> Result<Self, Fault> {
        let columns = chosen(history, &asked.records)?;
        let t: &[f64] = history.columns.first().map_or(&[], |c| &c.values);
        let courses: Vec<Course<'_>> = columns.iter().filter_map(|c| course(t, c, asked.window)).collect();
        if courses.is_empty() {
            let [from, to] = asked.window;
            return Err(Fault::new(format!("there are fewer than four rows from {from} s to {to} s")));
        }
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
        if let Some((life, _)) = &asked.life {
            headings.extend(["cycles", "damage", "damage a year"].map(String::from));
            headings.push(format!("range at 1 Hz (m = {})", life.m));
        }
        let rows = courses.iter().filter_map(|course| row(&asked, course)).collect();
        Ok(Set { asked, courses, headings, rows })
    }

    /// Headings, and cells for people.
    pub fn cells(&self) -> (&[String], Vec<Vec<String>>) {
        let cells = |(name, values): &(String, Vec<Option<f64>>)| {
            let numbers = values.iter().map(|x| x.map_or(String::new(), number));
            std::iter::once(name.clone()).chain(numbers).collect()
        };
        (&self.headings, self.rows.iter().map(cells).collect())
    }

    /// The same for a page.
    pub fn listing(&self) -> Listing {
        let (headings, rows) = self.cells();
        let [from, to] = self.asked.window.map(number);
        let title = match self.asked.name.as_str() {
            "statistics" => "Statistics".to_string(),
            name => format!("Statistics: {name}"),
        };
        let mut note = format!("From {from} s to {to} s.");
        if let Some((life, _)) = &self.asked.life {
            note += &format!(" Fatigue: {}.", curve(life));
        }
        Listing { title, headings: headings.to_vec(), rows, note }
    }

    /// Writes the table, spectra and cycles, and gives the names of tables and pictures.
    ///
    /// # Errors
    /// A table that can't be written.
    pub fn write(
        &self,
        folder: &RunFolder,
        plots: bool,
        warn: &mut dyn FnMut(&str),
    ) -> Result<(Vec<String>, Vec<String>), OutputError> {
        let mut csv = Csv::new(&self.headings);
        for (name, values) in &self.rows {
            csv.cell(name);
            values.iter().for_each(|x| _ = csv.number_or_none(*x));
            csv.end();
        }
        write_atomic(&folder.table_file(&self.asked.name)?, &csv.text())?;
        let (mut tables, mut pictures) = (vec![self.asked.name.clone()], Vec::new());
        for course in &self.courses {
            let name = format!("spectrum-{}{}", self.asked.stem(), course.column.name);
            if let Some(drawn) = spectrum(folder, &name, course, plots, warn)? {
                tables.push(name.clone());
                pictures.extend(drawn.then_some(name));
            }
            if self.asked.life_of(course.column).is_some() {
                let name = format!("cycles-{}{}", self.asked.stem(), course.column.name);
                cycles(folder, &name, course)?;
                tables.push(name);
            }
        }
        Ok((tables, pictures))
    }
}

/// A fatigue curve in words.
fn curve(life: &Life) -> String {
    let Life { strength, k, m, beyond, mean_load } = life;
    let [strength, k, m] = [strength, k, m].map(|x| number(*x));
    let second = beyond
        .map_or(String::new(), |(knee, m)| format!(", slope {} beyond {} cycles", number(m), number(knee)));
    let mean = if *mean_load { ", means by Goodman" } else { "" };
    format!("N = {k} (range/{strength})^-{m}{second}{mean}, cycles by rainflow counting, damage by Miner")
}

fn row(asked: &Asked, course: &Course<'_>) -> Option<(String, Vec<Option<f64>>)> {
    let m = Moments::of(&course.values)?;
    let waves = Crossings::of(&course.values, course.dt);
    let moments = [m.mean, m.deviation, m.least, m.greatest, m.skewness, m.kurtosis];
    let mut values: Vec<Option<f64>> = moments.map(Some).to_vec();
    values.extend([Some(waves.times.len() as f64), waves.period(), waves.significant_range()]);
    if asked.life.is_some() {
        values.extend(asked.life_of(course.column).map_or([None; 4], |life| {
            let duration = course.dt * course.values.len() as f64;
            let cycles = rainflow(&course.values);
            let done = damage(&cycles, |c| life.cycles(c));
            let equivalent = equivalent_range(&cycles, life.m, duration);
            [total(&cycles), done, done * YEAR / duration, equivalent].map(Some)
        }));
    }
    Some((course.column.heading(), values))
}

/// The spectrum of a record, from about eight pieces of it; whether it was drawn, if there is one.
fn spectrum(
    folder: &RunFolder,
    name: &str,
    course: &Course<'_>,
    plots: bool,
    warn: &mut dyn FnMut(&str),
) -> Result<Option<bool>, OutputError> {
    let length = Spectrum::length_for(course.values.len());
    let Some(s) = Spectrum::welch(&course.values, course.dt, length) else { return Ok(None) };
    let column = course.column;
    let unit = if column.unit.is_empty() { "1/Hz".to_string() } else { format!("({})^2/Hz", column.unit) };
    let table = Table {
        columns: vec![
            Column { values: s.frequencies.clone(), ..Column::new("f", "Hz") },
            Column { values: s.densities.clone(), ..Column::new("density", &unit) },
        ],
    };
    table.write(&folder.table_file(name)?)?;
    let points = s.frequencies.iter().copied().zip(s.densities.iter().copied()).collect();
    let plot = LinePlot {
        title: format!("Spectrum of {}", column.name),
        x_label: "f [Hz]".into(),
        y_label: format!("density [{unit}]"),
        series: vec![Series::new(&column.name, points)],
        ..LinePlot::default()
    };
    Ok(Some(plots && folder.draw(name, |path| plot.write(path), warn)))
}

/// The cycles of a record by rainflow counting.
fn cycles(folder: &RunFolder, name: &str, course: &Course<'_>) -> Result<(), OutputError> {
    let all = rainflow(&course.values);
    let unit = &course.column.unit;
    let column = |name: &str, unit: &str, of: fn(&Cycle) -> f64| Column {
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
    table.write(&folder.table_file(name)?)
}
