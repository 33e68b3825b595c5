//! The last part of a run: whether a column is steady there, and its mean, least and largest value.

use ropewalk_report::{Column, Table};
use ropewalk_scene::quantity::kind;

/// A last value is steady where its column ranges by no more than this share of its largest value over the last part.
pub(super) const STEADY: f64 = 0.01;
/// A column that is smaller than the largest of its unit by this factor is rounding.
const NOISE: f64 = 1e-9;

/// Which value of a column stands for a run in tables of results and in pictures over a parameter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Report {
    /// The last one
    #[default]
    Last,
    /// The mean over the last part of the run
    Mean,
    /// The least of the last part
    Least,
    /// The largest of the last part
    Largest,
}

impl Report {
    /// All of them.
    pub const ALL: [Report; 4] = [Report::Last, Report::Mean, Report::Least, Report::Largest];
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Report::Last => "last",
            Report::Mean => "mean",
            Report::Least => "least",
            Report::Largest => "largest",
        }
    }
    /// What it is, in a few words.
    pub fn about(self) -> &'static str {
        match self {
            Report::Last => "The last one",
            Report::Mean => "The mean over the last part of the run",
            Report::Least => "The least of the last part",
            Report::Largest => "The largest of the last part",
        }
    }
    /// What it is called in names of files.
    pub(super) fn ending(self) -> &'static str {
        match self {
            Report::Last => "final",
            Report::Mean => "mean",
            Report::Least => "least",
            Report::Largest => "largest",
        }
    }
    /// The value that it takes of a column's last one and its last part.
    pub(crate) fn of(self, last: f64, tail: &Tail) -> f64 {
        match self {
            Report::Last => last,
            Report::Mean => tail.mean,
            Report::Least => tail.least,
            Report::Largest => tail.largest,
        }
    }
    /// What it is called in titles and in the report: `at the end`.
    pub fn words(self) -> &'static str {
        match self {
            Report::Last => "at the end",
            Report::Mean => "mean at the end",
            Report::Least => "least at the end",
            Report::Largest => "largest at the end",
        }
    }
}

/// The last part of a run, as its share: `10 %`, `0.1`, and `1` for the whole run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Over(f64);

impl Default for Over {
    fn default() -> Self {
        Over(0.1)
    }
}

impl Over {
    /// The last part with this share of the run, above 0 and at most 1.
    pub(crate) fn share(share: f64) -> Option<Self> {
        (share > 0.0 && share <= 1.0).then_some(Over(share))
    }
}

impl std::str::FromStr for Over {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let share = kind::NUMBER.parse(text).ok().and_then(Over::share);
        share.ok_or_else(|| "expected a share of the run, like `10 %`, or `1` for the whole run".into())
    }
}

impl std::fmt::Display for Over {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            1.0 => write!(f, "the whole run"),
            share => write!(f, "the last {} % of the run", (1e4 * share).round() / 1e2),
        }
    }
}

/// What the last part of a run holds of a column; NaN where there is no value, or a NaN is among them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tail {
    pub mean: f64,
    pub least: f64,
    pub largest: f64,
    /// Its range over the largest size that the column has in the whole run; zero where that is rounding.
    pub unsteady: f64,
}

impl Tail {
    /// Whether the last value is one of many.
    pub(crate) fn is_unsteady(&self) -> bool {
        self.unsteady > STEADY
    }
}

impl Over {
    /// The last part of every column of a history. Equilibria have no time, and their last value is what counts.
    pub(crate) fn tails(self, history: &Table) -> Vec<Tail> {
        let Some(time) = history.columns.first() else { return Vec::new() };
        let size = |c: &Column| c.values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let of_unit =
            |unit: &str| history.columns.iter().filter(|c| c.unit == unit).map(size).fold(0.0, f64::max);
        let from = self.begins(&time.values);
        let tail = |c: &Column| {
            let (t, values) =
                (&time.values[from.min(c.values.len())..], &c.values[from.min(c.values.len())..]);
            let (least, largest) = extremes(values);
            let size = size(c);
            let counts = time.name == "t" && size > NOISE * of_unit(&c.unit);
            let unsteady = if counts { (largest - least) / size } else { 0.0 };
            Tail { mean: mean(t, values), least, largest, unsteady }
        };
        history.columns.iter().map(tail).collect()
    }

    /// The first row of the last part, two rows at least.
    fn begins(self, t: &[f64]) -> usize {
        let (Some(first), Some(last)) = (t.first(), t.last()) else { return 0 };
        let from = last - self.0 * (last - first);
        let rounding = 1e-9 * (last - first);
        t.partition_point(|x| *x < from - rounding).min(t.len().saturating_sub(2))
    }
}

/// The least and the largest; NaN if there is none, or a NaN among them.
pub(super) fn extremes(values: &[f64]) -> (f64, f64) {
    let fold = |pick: fn(f64, f64) -> f64| {
        let both = |a: f64, b: f64| if a.is_nan() || b.is_nan() { f64::NAN } else { pick(a, b) };
        values.iter().copied().reduce(both).unwrap_or(f64::NAN)
    };
    (fold(f64::min), fold(f64::max))
}

/// The mean over time, by the trapezoidal rule.
fn mean(t: &[f64], values: &[f64]) -> f64 {
    let (Some(first), Some(last)) = (t.first(), t.last()) else { return f64::NAN };
    if !(last > first) {
        return values.last().copied().unwrap_or(f64::NAN);
    }
    let pieces = t.windows(2).zip(values.windows(2));
    pieces.map(|(t, v)| 0.5 * (t[1] - t[0]) * (v[0] + v[1])).sum::<f64>() / (last - first)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history() -> Table {
        let t: Vec<f64> = (0..=100).map(|k| 0.1 * f64::from(k)).collect();
        let column = |name: &str, unit: &str, f: fn(f64) -> f64| Column {
            values: t.iter().map(|t| f(*t)).collect(),
            ..Column::new(name, unit)
        };
        let columns = vec![
            column("t", "s", |t| t),
            column("settled", "m", |t| 5.0 + 3.0 * (-2.0 * t).exp()),
            column("swings", "N", |t| 2.0 + (std::f64::consts::TAU * t).sin()),
            column("rounding", "m", |t| 1e-17 * (40.0 * t).sin()),
        ];
        Table { columns }
    }

    #[test]
    fn what_swings_is_unsteady_and_what_has_settled_is_not() {
        let tails = "10 %".parse::<Over>().unwrap().tails(&history());
        assert!(tails[1].unsteady < 1e-6 && tails[3].unsteady == 0.0, "{tails:?}");
        assert!((tails[2].unsteady - 2.0 / 3.0).abs() < 0.05, "{tails:?}");
        assert!((tails[2].mean - 2.0).abs() < 1e-12, "{tails:?}");
        assert!(tails[2].least < 1.06 && tails[2].largest > 2.94);
    }

    #[test]
    fn the_last_part_may_be_the_whole_run_and_equilibria_are_steady() {
        let mut table = history();
        let whole = "1".parse::<Over>().unwrap();
        assert_eq!(whole.tails(&table)[1].largest, 8.0);
        assert_eq!(whole.begins(&table.columns[0].values), 0);
        assert_eq!("1 %".parse::<Over>().unwrap().begins(&table.columns[0].values), 99);
        table.columns[0].name = "load factor".into();
        assert!(whole.tails(&table).iter().all(|tail| tail.unsteady == 0.0));
        for wrong in ["0", "-1", "120 %", "ten", "2 s"] {
            assert!(wrong.parse::<Over>().is_err(), "{wrong}");
        }
    }
}
