//! What controllers see: the columns of the scene's records by their names, and time.

use crate::document::did_you_mean;
use ropewalk_core::error::positive;
use ropewalk_core::{BuildError, Column, Input, Model, Record, Sample};
use ropewalk_quantity::{Dimension, Expression, Formula};
use std::sync::Arc;

/// The name of time in a formula.
const TIME: &str = "t";

/// What a controller is made with.
pub struct Channels<'a> {
    model: &'a Model,
    records: Arc<Vec<Box<dyn Record>>>,
    /// Every column with its record, and its place there.
    columns: Vec<(Column, usize, usize)>,
    /// Length of the run [s].
    duration: f64,
}

/// More instants of a controller than these are surely a mistake.
const MOST_INSTANTS: f64 = 1e8;

/// Where the value of a name comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    Time,
    Column { record: usize, place: usize },
}

/// A formula whose names are columns of records, bound to a model.
#[derive(Clone)]
pub struct Bound {
    expression: Expression,
    sources: Vec<Source>,
    records: Arc<Vec<Box<dyn Record>>>,
    /// Of what dimension its value is.
    pub dimension: Dimension,
}

impl<'a> Channels<'a> {
    pub(super) fn new(model: &'a Model, records: Vec<Box<dyn Record>>, duration: f64) -> Self {
        let mut columns = Vec::new();
        for (record, r) in records.iter().enumerate() {
            columns.extend(r.columns().into_iter().enumerate().map(|(place, c)| (c, record, place)));
        }
        Channels { model, records: Arc::new(records), columns, duration }
    }

    /// The input that a controller sets, and its number.
    ///
    /// # Errors
    /// There is none of this name.
    pub fn input(&self, name: &str) -> Result<(usize, &Input), BuildError> {
        let inputs = self.model.inputs();
        let Some(k) = inputs.iter().position(|i| i.name() == name) else {
            let names: Vec<&str> = inputs.iter().map(|i| i.name()).collect();
            let guess = did_you_mean(name, &names).unwrap_or_else(|| "declare it in `[[inputs]]`".into());
            return Err(BuildError::at("input", format!("there is no input `{name}`; {guess}")));
        };
        Ok((k, &inputs[k]))
    }

    /// The interval of a controller [s].
    ///
    /// # Errors
    /// It isn't positive, or so short that a run would never end.
    pub fn interval(&self, every: f64) -> Result<f64, BuildError> {
        let instants = self.duration / positive("every", every)?;
        if instants <= MOST_INSTANTS {
            return Ok(every);
        }
        let message = format!(
            "every {every:e} s a controller would act {instants:.0e} times in {} s: take a longer interval",
            self.duration
        );
        Err(BuildError::at("every", message))
    }

    /// Binds a formula to the records; a bare number is of whatever `dimension` it has to be, if that is known.
    ///
    /// # Errors
    /// It is no formula, holds what is no column of a record, or its units don't fit.
    pub fn bind(
        &self,
        field: &'static str,
        formula: &Formula,
        dimension: Option<Dimension>,
    ) -> Result<Bound, BuildError> {
        let text = match formula {
            Formula::Text(text) => text.clone(),
            Formula::Number(x) => format!("{x:e}"),
        };
        let wrong = |what: String| BuildError::at(field, format!("`{field} = \"{text}\"`: {what}"));
        let expression = Expression::parse(&text, &|_| true).map_err(|e| wrong(e.message))?;
        let (mut sources, mut dimensions) = (Vec::new(), Vec::new());
        for name in expression.names() {
            let (source, of) = self.source(name).map_err(wrong)?;
            sources.push(source);
            dimensions.push(of);
        }
        let mut of = expression.dimension(&dimensions).map_err(|e| wrong(e.message))?;
        if let (Formula::Number(_), Some(wanted)) = (formula, dimension) {
            of = wanted;
        }
        if let Some(wanted) = dimension.filter(|wanted| *wanted != of) {
            let said = |d: Dimension| {
                if d.unit().is_empty() { "a plain number".into() } else { format!("in {}", d.unit()) }
            };
            return Err(wrong(format!("it is {}, and has to be {}", said(of), said(wanted))));
        }
        Ok(Bound { expression, sources, records: self.records.clone(), dimension: of })
    }

    fn source(&self, name: &str) -> Result<(Source, Dimension), String> {
        if name == TIME {
            return Ok((Source::Time, Dimension::new(0, 0, 1, 0)));
        }
        if name.starts_with('$') {
            return Err(format!(
                "`{name}` is a parameter of the scene, which has no value here: begin the text with it"
            ));
        }
        let Some((column, record, place)) = self.columns.iter().find(|(c, ..)| c.name == name) else {
            let names: Vec<&str> = self.columns.iter().map(|(c, ..)| c.name.as_str()).collect();
            let there: Vec<String> = names.iter().map(|n| format!("`{n}`")).collect();
            return Err(match (there.is_empty(), did_you_mean(name, &names)) {
                (true, _) => {
                    format!("there is no record `{name}`; the scene has none: ask for one in `[[records]]`")
                }
                (_, Some(guess)) => format!("no record has a column `{name}`; {guess}"),
                _ => format!("no record has a column `{name}`; there are `t`, {}", there.join(", ")),
            });
        };
        let unit = if column.unit == "1" { "" } else { &column.unit };
        let dimension = Dimension::of(unit).map_err(|what| format!("the record `{name}` {what}"))?;
        Ok((Source::Column { record: *record, place: *place }, dimension))
    }
}

impl Bound {
    /// Its value in SI units; NaN where it has none.
    pub fn value(&self, sample: &Sample<'_>) -> f64 {
        let mut row = Vec::new();
        let mut seen = None;
        let values: Vec<f64> = self
            .sources
            .iter()
            .map(|source| match *source {
                Source::Time => sample.at.t,
                Source::Column { record, place } => {
                    if seen != Some(record) {
                        row.clear();
                        self.records[record].sample(sample, &mut row);
                        seen = Some(record);
                    }
                    row.get(place).copied().unwrap_or(f64::NAN)
                }
            })
            .collect();
        self.expression.value(&values)
    }

    /// Whether it needs consistent accelerations and multipliers.
    pub fn needs_forces(&self) -> bool {
        self.sources
            .iter()
            .any(|s| matches!(s, Source::Column { record, .. } if self.records[*record].needs_forces()))
    }
}
