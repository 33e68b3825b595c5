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
    /// The columns of the history.
    pub columns: Range<usize>,
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
            let unit = recorder.table.columns.get(columns.start).map_or("", |c| c.unit.as_str()).to_string();
            Target { text: name.into(), name: name.into(), t: None, columns, unit }
        };
        let records = recorder.figures.iter().map(|f| of(&f.name, f.columns.clone()));
        let columns = recorder.table.columns.iter().enumerate().skip(1).map(|(k, c)| of(&c.name, k..k + 1));
        records.chain(columns).collect()
    }

    /// Time and the columns that are looked at, of a history with all columns.
    pub(crate) fn of(&self, history: &Table) -> Table {
        let columns = history.columns.get(self.columns.clone()).unwrap_or_default();
        Table { columns: history.columns.first().into_iter().chain(columns).cloned().collect() }
    }

    /// The size by which differences are divided: the largest magnitude of the record over the run.
    ///
    /// # Errors
    /// It is zero or no number all the time, or at the time that is asked for.
    pub(crate) fn size(&self, values: &Table) -> Result<f64, Fault> {
        let rows = 0..values.rows();
        let magnitude =
            |row: usize| values.columns.iter().skip(1).map(|c| c.values[row].powi(2)).sum::<f64>().sqrt();
        let size = rows.clone().map(magnitude).filter(|x| x.is_finite()).fold(0.0, f64::max);
        let last = rows.last().map_or(f64::NAN, magnitude);
        let name = quoted(&self.text);
        if size == 0.0 {
            return Err(self.nothing());
        }
        if self.t.is_some() && !last.is_finite() {
            return Err(
                Fault::new(format!("{name} has no value at that time")).with_help("choose another time")
            );
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

/// How far two histories of the same columns differ: the largest distance, or the one at the end if `last` is set. Rows
/// are those of the same times; what isn't a number in one of them only, or an end that comes at quite another time, makes
/// it NaN.
pub fn difference(a: &Table, b: &Table, last: bool) -> f64 {
    let (Some(ta), Some(tb)) = (a.columns.first(), b.columns.first()) else { return f64::NAN };
    let (ta, tb) = (&ta.values, &tb.values);
    let (Some(&ea), Some(&eb)) = (ta.last(), tb.last()) else { return f64::NAN };
    let same = |x: f64, y: f64| (x - y).abs() <= 1e-9 * ea.abs().max(eb.abs());
    let distance = |i: usize, j: usize| {
        let of = |(p, q): (f64, f64)| if p.is_nan() && q.is_nan() { 0.0 } else { (p - q).powi(2) };
        let pairs = a.columns.iter().zip(&b.columns).skip(1).map(|(p, q)| (p.values[i], q.values[j]));
        pairs.map(of).sum::<f64>().sqrt()
    };
    if last {
        return if same(ea, eb) { distance(ta.len() - 1, tb.len() - 1) } else { f64::NAN };
    }
    // an event may end the run a little earlier or later
    if (ea - eb).abs() > 0.02 * ea.abs().max(eb.abs()) {
        return f64::NAN;
    }
    let (mut i, mut j, mut largest, mut rows) = (0, 0, 0.0_f64, 0);
    while i < ta.len() && j < tb.len() {
        if same(ta[i], tb[j]) {
            let d = distance(i, j);
            largest = if d.is_nan() || largest.is_nan() { f64::NAN } else { largest.max(d) };
            (i, j, rows) = (i + 1, j + 1, rows + 1);
        } else if ta[i] < tb[j] {
            i += 1;
        } else {
            j += 1;
        }
    }
    if rows == 0 { f64::NAN } else { largest }
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
        assert_eq!((difference(&a, &b, false), difference(&b, &a, true)), (0.5, 0.25));
        let nan = table(&[(0.0, 0.0), (1.0, f64::NAN), (3.0, 3.0)]);
        assert!(difference(&a, &nan, false).is_nan() && difference(&nan, &nan, false) == 0.0);
        let short = table(&[(0.0, 0.0), (1.0, 1.0)]);
        assert!(difference(&a, &short, false).is_nan() && difference(&a, &short, true).is_nan());
    }
}
