//! What a winch has paid out.

use super::{listed, named};
use crate::marker::split_marker;
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::{BuildError, Column, Model, MovingBoundary, Part, Record, Sample, Spot};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Payout at an end of a cable: columns `hose.start.payout`, the length paid out in m, `.payout_rate` in m/s, and,
/// where the speed is prescribed, `.pull`, the force of the winch in N.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PayoutSpec {
    /// The end of the cable: `hose.start` or `hose.end`.
    pub of: String,
    /// Name in results. Default: that of the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}
register_spec!(Record, "payout", PayoutSpec);

impl PayoutSpec {
    /// Payout at an end, under its own name.
    pub fn new(of: &str) -> Self {
        PayoutSpec { of: of.into(), name: None, title: None }
    }
}

struct Payout {
    boundary: MovingBoundary,
    /// First multiplier of what prescribes the speed.
    driven: Option<usize>,
    name: String,
    stem: String,
    title: String,
}

impl Record for Payout {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let column = |what: &str, unit| Column::new(format!("{}.{what}", self.stem), unit);
        let mut columns = vec![column("payout", "m"), column("payout_rate", "m/s")];
        columns.extend(self.driven.map(|_| column("pull", "N")));
        columns
    }
    fn needs_forces(&self) -> bool {
        self.driven.is_some()
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        out.extend([self.boundary.fed(&s.at), self.boundary.rate(&s.at)]);
        out.extend(self.driven.map(|row| s.lambda[row]));
    }
}

/// The boundary at an end of a part: of a cable with a route, of its first or last span.
fn boundary(part: &dyn Part, end: usize) -> Option<MovingBoundary> {
    let spans = part.spans();
    let span = if end == 0 { spans.first() } else { spans.last() };
    span.map_or(part, |span| span.as_ref()).boundary(end)
}

#[typetag::serde(name = "payout")]
impl RecordSpec for PayoutSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let (name, spot) = split_marker(&self.of).map_err(|e| BuildError::at("of", e))?;
        let part = super::place::part(model, name)?;
        let end = match &spot {
            Spot::Named(end) => ["start", "end"].iter().position(|e| e == end),
            _ => None,
        };
        let Some(boundary) = end.and_then(|end| boundary(part.as_ref(), end)) else {
            // spans of a cable with a route feed each other
            let whole = model.parts().iter().filter(|p| !p.name().contains('.'));
            let ends = whole.flat_map(|p| {
                let feeds = |&(k, _): &(usize, &str)| boundary(p.as_ref(), k).is_some();
                let ends = [(0, "start"), (1, "end")].into_iter().filter(feeds);
                ends.map(|(_, end)| format!("{}.{end}", p.name()))
            });
            let ends: Vec<String> = ends.collect();
            let ends = listed(ends.iter().map(String::as_str), "none");
            let message = format!("no winch is at `{}`; the ends with a winch are {ends}", self.of.trim());
            return Err(BuildError::at("of", message));
        };
        let all = model.constraints();
        let driven = all.iter().position(|c| c.nodes() == [boundary.node]).map(|c| model.rows_of(c).start);
        let of: String = self.of.chars().filter(|c| !c.is_whitespace()).collect();
        let stem = named(&self.name, || of.clone());
        let name = named(&self.name, || format!("{of}.payout"));
        let title = named(&self.title, || format!("Payout at {of}"));
        Ok(Box::new(Payout { boundary, driven, name, stem, title }))
    }
}
