//! A quantity of a case: what is looked at in the results of a run, and what should come out.

use super::crossing::{Direction, crossings, interpolated};
use ropewalk_core::rotation::from_bryant;
use ropewalk_report::Table;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// One number or several.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
enum Numbers {
    One(f64),
    Many(Vec<f64>),
}

impl Numbers {
    fn list(&self) -> Vec<f64> {
        match self {
            Numbers::One(x) => vec![*x],
            Numbers::Many(all) => all.clone(),
        }
    }
}

/// A column, or several with their weights.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
enum Sum {
    Column(String),
    Weighted(BTreeMap<String, f64>),
}

/// What is made of the columns, row by row.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Function {
    /// The angle of the direction `[x, y]` [rad].
    Angle,
    /// The magnitude of a vector.
    Norm,
    /// The quaternion, scalar first, of three Bryant angles, with the sign of the reference.
    Quaternion,
    /// The first two, seen in axes that are turned by the third [rad].
    TurnedBack,
}

/// What is made of a history.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum Take {
    /// The value at a time [s].
    At(f64),
    /// The last value.
    Final,
    /// The largest value.
    Max,
    /// The largest distance from the value at this time, after it.
    Drift { from: f64 },
    /// The time of the so-many-th passage through zero.
    Crossing {
        number: usize,
        #[serde(default)]
        direction: Direction,
    },
    /// The time between two passages, as a share.
    Interval {
        from: usize,
        to: usize,
        #[serde(default)]
        direction: Direction,
        #[serde(default = "one")]
        divided_by: f64,
    },
    /// The value where something else passes zero.
    AtCrossing {
        of: String,
        number: usize,
        #[serde(default)]
        direction: Direction,
    },
    /// Of modes: the value of the so-many-th of those that move along a direction only.
    Mode {
        number: usize,
        #[serde(default)]
        along: Option<String>,
    },
}

fn one() -> f64 {
    1.0
}

/// What is looked at, and what should come out.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    /// What it is, in words.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    of: Vec<Sum>,
    #[serde(default)]
    function: Option<Function>,
    /// What is taken off each number.
    #[serde(default)]
    offset: Vec<f64>,
    take: Take,
    /// Angles that differ by whole turns are the same.
    #[serde(default)]
    modulo_turns: bool,
    value: Numbers,
    tolerance: Numbers,
    /// Whether the tolerance is a share of the value.
    #[serde(default)]
    relative: bool,
    /// More about the reference.
    #[serde(default)]
    pub note: Option<String>,
}

/// A quantity as a run has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// What it is.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// What came out.
    pub measured: Vec<f64>,
    /// What should have come out.
    pub reference: Vec<f64>,
    /// How far off each number may be.
    pub tolerance: Vec<f64>,
}

impl Measured {
    /// The error of the worst number in parts of its tolerance; infinite if something isn't a number.
    pub fn ratio(&self) -> f64 {
        let all = self.measured.iter().zip(&self.reference).zip(&self.tolerance);
        all.map(|((x, want), eps)| (x - want).abs() / eps)
            .fold(0.0, |worst: f64, r| if r.is_nan() { f64::INFINITY } else { worst.max(r) })
    }
}

impl Quantity {
    /// Looks at the results of a run, the first column of which is time, load factor or number of the mode.
    ///
    /// # Errors
    /// The results don't have what is asked for.
    pub fn measure(&self, results: &Table) -> Result<Measured, String> {
        let reference = self.value.list();
        let mut measured =
            self.measured(results, &reference).map_err(|e| format!("{}: {e}", self.quantity))?;
        if measured.len() != reference.len() {
            let counts = (measured.len(), reference.len());
            return Err(format!("{}: {} numbers, but {} references", self.quantity, counts.0, counts.1));
        }
        if self.modulo_turns {
            for (x, want) in measured.iter_mut().zip(&reference) {
                *x = want + (*x - want + PI).rem_euclid(TAU) - PI;
            }
        }
        let tolerance = self.tolerance.list();
        let each = |k: usize| tolerance[k.min(tolerance.len() - 1)];
        let scale = |want: f64| if self.relative { want.abs() } else { 1.0 };
        let tolerance = reference.iter().enumerate().map(|(k, want)| each(k) * scale(*want)).collect();
        Ok(Measured {
            quantity: self.quantity.clone(),
            unit: self.unit.clone(),
            measured,
            reference,
            tolerance,
        })
    }

    fn measured(&self, results: &Table, reference: &[f64]) -> Result<Vec<f64>, String> {
        let t = results.columns.first().map_or(&[][..], |c| &c.values);
        if t.is_empty() {
            return Err("the run has no results".into());
        }
        let mut histories: Vec<Vec<f64>> =
            self.of.iter().map(|s| sum(results, s)).collect::<Result<_, _>>()?;
        if let Some(function) = self.function {
            histories = applied(function, &histories, reference)?;
        }
        for (history, offset) in histories.iter_mut().zip(&self.offset) {
            history.iter_mut().for_each(|x| *x -= offset);
        }
        histories.iter().map(|x| self.taken(results, t, x)).collect()
    }

    fn taken(&self, results: &Table, t: &[f64], x: &[f64]) -> Result<f64, String> {
        let nth = |times: Vec<f64>, n: usize| {
            let missing = || format!("it passes zero {} times only, not {n}", times.len());
            n.checked_sub(1).and_then(|k| times.get(k)).copied().ok_or_else(missing)
        };
        let row = |time: f64| {
            let span = (t[t.len() - 1] - t[0]).abs();
            let near = |k: &usize| (t[*k] - time).abs() <= 1e-9 * span;
            (0..t.len()).find(near).ok_or_else(|| format!("there is no sample at {time}"))
        };
        match &self.take {
            Take::At(time) => Ok(x[row(*time)?]),
            Take::Final => Ok(x[x.len() - 1]),
            Take::Max => Ok(largest(x.iter().copied())),
            Take::Drift { from } => {
                let first = row(*from)?;
                Ok(largest(x[first..].iter().map(|y| (y - x[first]).abs())))
            }
            Take::Crossing { number, direction } => nth(crossings(t, x, *direction), *number),
            Take::Interval { from, to, direction, divided_by } => {
                let times = crossings(t, x, *direction);
                Ok((nth(times.clone(), *to)? - nth(times, *from)?) / divided_by)
            }
            Take::AtCrossing { of, number, direction } => {
                let time = nth(crossings(t, column(results, of)?, *direction), *number)?;
                Ok(interpolated(t, x, time))
            }
            Take::Mode { number, along } => {
                let share = along.as_ref().map(|of| column(results, of)).transpose()?;
                let mut chosen = (0..x.len()).filter(|&k| share.is_none_or(|s| s[k] > 0.9));
                let missing = || format!("fewer than {number} such modes were computed");
                chosen.nth(number.saturating_sub(1)).map(|k| x[k]).ok_or_else(missing)
            }
        }
    }
}

fn column<'t>(results: &'t Table, name: &str) -> Result<&'t [f64], String> {
    let found = results.columns.iter().find(|c| c.name == name).map(|c| c.values.as_slice());
    found.ok_or_else(|| {
        let names: Vec<&str> = results.columns.iter().map(|c| c.name.as_str()).collect();
        format!("there is no column `{name}`; there are {}", names.join(", "))
    })
}

fn sum(results: &Table, of: &Sum) -> Result<Vec<f64>, String> {
    match of {
        Sum::Column(name) => column(results, name).map(<[f64]>::to_vec),
        Sum::Weighted(all) => {
            let mut total = Vec::new();
            for (name, weight) in all {
                let values = column(results, name)?;
                total.resize(values.len(), 0.0);
                total.iter_mut().zip(values).for_each(|(sum, x)| *sum += weight * x);
            }
            Ok(total)
        }
    }
}

fn applied(function: Function, of: &[Vec<f64>], reference: &[f64]) -> Result<Vec<Vec<f64>>, String> {
    let wanted = match function {
        Function::Angle => Some(2),
        Function::Norm => None,
        Function::Quaternion | Function::TurnedBack => Some(3),
    };
    if wanted.is_some_and(|n| n != of.len()) {
        return Err(format!("{function:?} isn't made of {} columns", of.len()));
    }
    let rows = (0..of.first().map_or(0, Vec::len)).map(|k| of.iter().map(|c| c[k]).collect::<Vec<f64>>());
    let made: Vec<Vec<f64>> = rows
        .map(|r| match function {
            Function::Angle => vec![r[1].atan2(r[0])],
            Function::Norm => vec![r.iter().map(|x| x * x).sum::<f64>().sqrt()],
            Function::Quaternion => {
                let q = from_bryant([r[0], r[1], r[2]]);
                let sign = q.iter().zip(reference).map(|(a, b)| a * b).sum::<f64>().signum();
                q.map(|x| sign * x).to_vec()
            }
            Function::TurnedBack => {
                let (sin, cos) = r[2].sin_cos();
                vec![cos * r[0] + sin * r[1], cos * r[1] - sin * r[0]]
            }
        })
        .collect();
    let width = made.first().map_or(0, Vec::len);
    Ok((0..width).map(|c| made.iter().map(|r| r[c]).collect()).collect())
}

/// The largest; not a number is larger than all.
fn largest(x: impl Iterator<Item = f64>) -> f64 {
    x.fold(f64::NEG_INFINITY, |m, x| if x.is_nan() || m.is_nan() { f64::NAN } else { m.max(x) })
}
