//! What of a run is looked at, and how far two runs differ in it.

use crate::run::Recorder;
use ropewalk_report::Table;
use ropewalk_scene::{Analysis, Fault, Run, SceneFile, did_you_mean, quantity, quoted};
use std::ops::Range;

/// What is smaller than others of its unit by this is rounding.
const ROUNDING: f64 = 1e-12;

/// A record, or one of its columns, over the whole run or at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// As the user wrote it.
    pub text: String,
    /// Name of the record or column.
    pub name: String,
    /// When, if not all the time [s]; in statics a load factor.
    pub t: Option<f64>,
    /// The columns of the history …
    pub columns: Range<usize>,
    /// … and their names.
    pub names: Vec<String>,
    /// Their unit.
    pub unit: String,
}

impl Target {
    /// Reads `RECORD` or `RECORD@TIME`: the name of a record or of a column of the history.
    ///
    /// # Errors
    /// There is no such record, or no such time.
    pub fn parse(text: &str, file: &SceneFile) -> Result<Self, Fault> {
        Self::find(text, &Self::all(file)?, &file.scene().run)
    }

    /// The same among these, of a run.
    ///
    /// # Errors
    /// As [`parse`](Self::parse).
    pub(crate) fn find(text: &str, all: &[Self], run: &Run) -> Result<Self, Fault> {
        let named = |name: &str| all.iter().find(|t| t.name == name);
        if let Some(target) = named(text) {
            return Ok(Target { text: text.into(), ..target.clone() });
        }
        let (name, time) = match text.rsplit_once('@') {
            Some((name, time)) if named(name).is_some() || !text.is_empty() && named(text).is_none() => {
                (name.trim(), Some(time.trim()))
            }
            _ => (text, None),
        };
        let Some(target) = named(name) else {
            let names: Vec<&str> = all.iter().map(|t| t.name.as_str()).collect();
            let fault = Fault::new(format!("there is no record {}", quoted(name)));
            return Err(match (names.is_empty(), did_you_mean(name, &names)) {
                (true, _) => fault.with_help("the scene has no records: add one to `[[records]]`"),
                (false, Some(guess)) => {
                    fault.with_note(format!("there are {}", names.join(", "))).with_help(guess)
                }
                (false, None) => fault.with_help(format!("choose one of {}", names.join(", "))),
            });
        };
        let t = time.map(|time| Self::time(text, time, run)).transpose()?;
        Ok(Target { text: text.into(), t, ..target.clone() })
    }

    fn time(text: &str, time: &str, run: &Run) -> Result<f64, Fault> {
        let statics = run.analysis == Analysis::Statics;
        let (what, unit, example) =
            if statics { ("load factor", "", "0.5") } else { ("time", " s", "2.5 s") };
        let t: f64 = time.parse().or_else(|_| quantity::kind::TIME.parse(time)).map_err(|_| {
            Fault::new(format!("{} is no {what}, in {}", quoted(time), quoted(text)))
                .with_help(format!("write it behind the @, as in `record@{example}`"))
        })?;
        let end = run.duration;
        if !(t > 0.0 && t <= end * (1.0 + 1e-12)) {
            let message =
                format!("{what} {t}{unit} in {} is outside the run, which ends at {end}{unit}", quoted(text));
            return Err(
                Fault::new(message).with_help(format!("choose a {what} above 0 and up to {end}{unit}"))
            );
        }
        Ok(t.min(end))
    }

    /// All records of a scene, then their columns.
    ///
    /// # Errors
    /// The scene can't be built.
    pub fn all(file: &SceneFile) -> Result<Vec<Self>, Fault> {
        let model = file.build()?;
        Ok(Self::recorded(&Recorder::new(file.scene(), file.records(&model)?)))
    }

    /// All records of a recorder, then their columns.
    pub(crate) fn recorded(recorder: &Recorder<'_>) -> Vec<Self> {
        let of = |name: &str, columns: Range<usize>| {
            let own = &recorder.table.columns[columns.clone()];
            let unit = own.first().map_or("", |c| c.unit.as_str()).to_string();
            let names = own.iter().map(|c| c.name.clone()).collect();
            Target { text: name.into(), name: name.into(), t: None, columns, names, unit }
        };
        let records = recorder.figures.iter().map(|f| of(&f.name, f.columns.clone()));
        let columns = recorder.table.columns.iter().enumerate().skip(1).map(|(k, c)| of(&c.name, k..k + 1));
        records.chain(columns).collect()
    }

    /// Time and the columns that are looked at, of a history that has these and others.
    pub(crate) fn of(&self, history: &Table) -> Table {
        self.find_in(history).unwrap_or_default()
    }

    /// The same; none if the history lacks one of them.
    pub(crate) fn find_in(&self, history: &Table) -> Option<Table> {
        let mut columns = vec![history.columns.first()?.clone()];
        for name in &self.names {
            columns.push(history.column(name)?.clone());
        }
        Some(Table { columns })
    }

    /// The largest magnitude of the record over the run; 0 if it never has one.
    pub(crate) fn magnitude(&self, values: &Table) -> f64 {
        (0..values.rows()).map(|row| magnitude(values, row)).filter(|x| x.is_finite()).fold(0.0, f64::max)
    }

    /// The size by which differences are divided: the largest magnitude of the record over the run.
    ///
    /// # Errors
    /// It is zero or no number all the time, or at the time that is asked for.
    pub(crate) fn size(&self, values: &Table) -> Result<f64, Fault> {
        let size = self.magnitude(values);
        let last = values.rows().checked_sub(1).map_or(f64::NAN, |row| magnitude(values, row));
        if size == 0.0 {
            return Err(self.nothing());
        }
        if self.t.is_some() && !last.is_finite() {
            let fault = Fault::new(format!("{} has no value at that time", quoted(&self.text)));
            return Err(fault.with_help("choose another time"));
        }
        Ok(size)
    }

    /// The size in a history with all columns, where what is but rounding beside others of its unit is none.
    ///
    /// # Errors
    /// A record that has no size, or no value at the time asked for.
    pub fn size_in(&self, history: &Table) -> Result<f64, Fault> {
        let size = self.size(&self.of(history))?;
        let alike = history.columns.iter().skip(1).filter(|c| c.unit == self.unit);
        let largest =
            alike.flat_map(|c| &c.values).filter(|x| x.is_finite()).fold(0.0, |m: f64, x| m.max(x.abs()));
        if size > ROUNDING * largest { Ok(size) } else { Err(self.nothing()) }
    }

    fn nothing(&self) -> Fault {
        let message = "is zero or no number all the time: there is nothing that an error could be a part of";
        Fault::new(format!("{} {message}", quoted(&self.text)))
            .with_help("choose another record, or another time")
    }
}

/// The moments at which two histories are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum When {
    /// All that both have; they must end at about the same time.
    Whole,
    /// All that both have, whatever their ends.
    Common,
    /// The end, which must be the same.
    End,
    /// A time, between rows along a straight line.
    At(f64),
}

/// How far two histories of the same columns differ: the largest distance. It is NaN where one has a value and the other
/// none, and where there is nothing to compare.
pub(crate) fn difference(a: &Table, b: &Table, when: When) -> f64 {
    let times = |table: &Table| table.columns.first().map_or(Vec::new(), |c| c.values.clone());
    let (ta, tb) = (times(a), times(b));
    let (Some(&ea), Some(&eb)) = (ta.last(), tb.last()) else { return f64::NAN };
    let largest_time = ea.abs().max(eb.abs());
    let same = |x: f64, y: f64| (x - y).abs() <= 1e-9 * largest_time;
    match when {
        When::End if same(ea, eb) => distance(&row(a, ta.len() - 1), &row(b, tb.len() - 1)),
        When::End => f64::NAN,
        When::At(t) => match (row_at(a, &ta, t), row_at(b, &tb, t)) {
            (Some(x), Some(y)) => distance(&x, &y),
            _ => f64::NAN,
        },
        // an event may end the run a little earlier or later
        When::Whole if (ea - eb).abs() > 0.02 * largest_time => f64::NAN,
        When::Whole | When::Common => {
            let (mut i, mut j, mut largest) = (0, 0, None);
            while i < ta.len() && j < tb.len() {
                if same(ta[i], tb[j]) {
                    let d = distance(&row(a, i), &row(b, j));
                    largest = Some(largest.map_or(d, |m: f64| if d <= m || m.is_nan() { m } else { d }));
                    (i, j) = (i + 1, j + 1);
                } else if ta[i] < tb[j] {
                    i += 1;
                } else {
                    j += 1;
                }
            }
            largest.unwrap_or(f64::NAN)
        }
    }
}

/// The values in a row, without its time.
fn row(table: &Table, k: usize) -> Vec<f64> {
    table.columns.iter().skip(1).map(|c| c.values[k]).collect()
}

fn magnitude(table: &Table, k: usize) -> f64 {
    row(table, k).iter().map(|x| x.powi(2)).sum::<f64>().sqrt()
}

/// Two rows without any value are the same.
fn distance(x: &[f64], y: &[f64]) -> f64 {
    let square = |(p, q): (&f64, &f64)| if p.is_nan() && q.is_nan() { 0.0 } else { (p - q).powi(2) };
    x.iter().zip(y).map(square).sum::<f64>().sqrt()
}

/// The values at a time, between rows along a straight line; none after the last row.
fn row_at(table: &Table, times: &[f64], t: f64) -> Option<Vec<f64>> {
    let k = times.partition_point(|x| *x < t);
    let before = k.checked_sub(1);
    match (before, k < times.len()) {
        (None, true) => Some(row(table, k)),
        (Some(i), true) => {
            let u = (t - times[i]) / (times[k] - times[i]);
            Some(row(table, i).iter().zip(row(table, k)).map(|(a, b)| a + u * (b - a)).collect())
        }
        (Some(i), false) if t - times[i] <= 1e-9 * t.abs() => Some(row(table, i)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ropewalk_report::Column;

    fn table(rows: &[(f64, f64)]) -> Table {
        let mut table = Table::new([Column::new("x", "m")]);
        rows.iter().for_each(|(t, x)| table.push_row(&[*t, *x]).unwrap());
        table
    }

    #[test]
    fn histories_differ_by_their_largest_distance_at_common_times() {
        let a = table(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]);
        let b = table(&[(0.0, 0.0), (1.0, 1.5), (1.7, 99.0), (2.0, 2.0), (3.0, 3.25)]);
        assert_eq!((difference(&a, &b, When::Whole), difference(&b, &a, When::End)), (0.5, 0.25));
        let nan = table(&[(0.0, 0.0), (1.0, f64::NAN), (3.0, 3.0)]);
        assert!(difference(&a, &nan, When::Whole).is_nan() && difference(&nan, &nan, When::Whole) == 0.0);
        let short = table(&[(0.0, 0.0), (1.0, 1.0)]);
        assert!(difference(&a, &short, When::Whole).is_nan() && difference(&a, &short, When::End).is_nan());
        assert_eq!(difference(&a, &short, When::Common), 0.0);
        assert_eq!(difference(&a, &b, When::At(0.5)), 0.25);
        assert!(difference(&a, &short, When::At(1.5)).is_nan());
    }
}
