//! The record by which effects are judged, and how far it changes.

use crate::study::Target;
use ropewalk_report::Table;

/// A record, or a single column of one, over the whole run or at one time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Watched {
    /// As it was asked for.
    pub text: String,
    /// Its columns.
    pub columns: Vec<String>,
    /// The time at which it is looked at; none for the whole run.
    pub t: Option<f64>,
}

impl Watched {
    /// The columns of a target, by their names: what has other effects may have other columns beside them.
    pub fn of(target: &Target, table: &Table) -> Self {
        let columns = target.columns.clone().map(|k| table.columns[k].name.clone()).collect();
        Watched { text: target.text.clone(), columns, t: target.t }
    }

    /// Its rows: time and values.
    fn rows(&self, table: &Table) -> Option<Vec<(f64, Vec<f64>)>> {
        let columns: Option<Vec<&[f64]>> =
            self.columns.iter().map(|c| table.column(c).map(|c| c.values.as_slice())).collect();
        let (columns, times) = (columns?, &table.columns.first()?.values);
        Some((0..times.len()).map(|k| (times[k], columns.iter().map(|c| c[k]).collect())).collect())
    }

    /// The unit of its first column.
    pub fn unit<'t>(&self, table: &'t Table) -> &'t str {
        self.columns.first().and_then(|c| table.column(c)).map_or("", |c| &c.unit)
    }

    /// The largest size of the record in the run, which changes are relative to.
    pub fn scale(&self, table: &Table) -> f64 {
        let rows = self.rows(table).unwrap_or_default();
        rows.iter().map(|(_, x)| size(x)).filter(|x| x.is_finite()).fold(0.0, f64::max)
    }

    /// The largest difference between two runs, in the unit of the record; infinite where one has a value and the other
    /// none, and nothing if the other run has no such record or didn't come to the time.
    pub fn change(&self, base: &Table, other: &Table) -> Option<f64> {
        let (a, b) = (self.rows(base)?, self.rows(other)?);
        if let Some(t) = self.t {
            let (x, y) = (at(&a, t)?, at(&b, t)?);
            return Some(off(&x, &y));
        }
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
        // a run that an event has stopped has a row at that moment, which the other has not
        let pairs = a.iter().zip(&b).filter(|(x, y)| same(x.0, y.0));
        pairs.map(|(x, y)| off(&x.1, &y.1)).reduce(f64::max)
    }
}

fn size(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn off(x: &[f64], y: &[f64]) -> f64 {
    if x.iter().zip(y).all(|(x, y)| x.is_nan() && y.is_nan()) {
        return 0.0;
    }
    let d: Vec<f64> = x.iter().zip(y).map(|(x, y)| x - y).collect();
    if d.iter().any(|d| d.is_nan()) { f64::INFINITY } else { size(&d) }
}

/// The values at a time, between rows along a straight line.
fn at(rows: &[(f64, Vec<f64>)], t: f64) -> Option<Vec<f64>> {
    let k = rows.partition_point(|r| r.0 < t);
    let slack = 1e-9 * t.abs();
    match (k.checked_sub(1).and_then(|k| rows.get(k)), rows.get(k)) {
        (None, Some(b)) => Some(b.1.clone()),
        (Some(a), None) if t - a.0 <= slack => Some(a.1.clone()),
        (Some(a), Some(b)) => {
            let u = (t - a.0) / (b.0 - a.0);
            Some(a.1.iter().zip(&b.1).map(|(a, b)| a + u * (b - a)).collect())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ropewalk_report::Column;

    fn table(rows: &[[f64; 3]]) -> Table {
        let mut table = Table::new([Column::new("end.x", "m"), Column::new("end.z", "m")]);
        rows.iter().for_each(|r| table.push_row(r).unwrap());
        table
    }

    #[test]
    fn changes_are_largest_differences() {
        let base = table(&[[0.0, 0.0, 0.0], [1.0, 6.0, 8.0], [2.0, 6.0, 8.0]]);
        let other = table(&[[0.0, 0.0, 0.0], [1.0, 3.0, 4.0]]);
        let watched = |t| Watched { text: String::new(), columns: vec!["end.x".into(), "end.z".into()], t };
        assert_eq!(watched(None).scale(&base), 10.0);
        assert_eq!(watched(None).change(&base, &other), Some(5.0));
        assert_eq!(watched(Some(0.5)).change(&base, &other), Some(2.5));
        assert_eq!(watched(Some(1.5)).change(&base, &other), None);
        let broken = table(&[[0.0, 0.0, 0.0], [1.0, f64::NAN, 4.0]]);
        assert_eq!(watched(None).change(&base, &broken), Some(f64::INFINITY));
    }
}
