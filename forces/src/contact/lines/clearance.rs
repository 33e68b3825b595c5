//! How near two lines are.

use super::curve::{Curve, size};
use ropewalk_core::{At, BuildError, Column, ContactSpan, Model, Record, Sample, SpanLine, V3};
use ropewalk_scene::records::{named, part};
use ropewalk_scene::{RecordSpec, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The least distance between the surfaces of two cables or bodies with a hull: columns `a-b.clearance` in m, below zero
/// where they are in each other, and `a-b.first`, `a-b.second`, how far along each that is in m. They need not be in
/// contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClearanceSpec {
    /// Both.
    pub between: [String; 2],
    /// Name in results. Default: both names, joined by a hyphen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}
register_spec!(Record, "clearance", ClearanceSpec);

impl ClearanceSpec {
    /// The clearance between two lines, under their names.
    pub fn new(one: &str, other: &str) -> Self {
        ClearanceSpec { between: [one.into(), other.into()], name: None }
    }
}

struct Clearance {
    lines: [Vec<ContactSpan>; 2],
    name: String,
    title: String,
}

/// A piece as it is now, with where it begins and how long it is.
fn now(span: &ContactSpan, at: &At<'_>) -> (Curve, [f64; 2]) {
    match (span.flow, span.line) {
        (Some(flow), SpanLine::Cubic { q, v, .. }) => {
            let [a, b] = flow.places(at.q);
            (Curve::of(&SpanLine::Cubic { q, v, l: b - a }, at), [a, b - a])
        }
        _ => (Curve::of(&span.line, at), [span.s, span.length]),
    }
}

/// A bound of the distance of two boxes.
fn gap(a: &Curve, b: &Curve) -> f64 {
    let gap: V3<f64> = std::array::from_fn(|i| (a.low[i] - b.high[i]).max(b.low[i] - a.high[i]).max(0.0));
    size(&gap)
}

impl Clearance {
    fn least(&self, at: &At<'_>) -> [f64; 3] {
        let [one, other] =
            [0, 1].map(|k| self.lines[k].iter().map(|s| (now(s, at), s.radius)).collect::<Vec<_>>());
        let mut pairs = Vec::with_capacity(one.len() * other.len());
        for (i, ((a, _), r)) in one.iter().enumerate() {
            for (j, ((b, _), s)) in other.iter().enumerate() {
                pairs.push((gap(a, b) - r - s, i, j));
            }
        }
        pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut best = [f64::INFINITY; 3];
        for (bound, i, j) in pairs {
            if bound >= best[0] {
                break;
            }
            let ((a, [s, l]), r) = &one[i];
            let ((b, [t, m]), p) = &other[j];
            let closest = a.closest(b);
            let clear = closest.distance - r - p;
            if clear < best[0] {
                best = [clear, s + closest.xi[0] * l, t + closest.xi[1] * m];
            }
        }
        best
    }
}

impl Record for Clearance {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        ["clearance", "first", "second"].map(|c| Column::new(format!("{}.{c}", self.name), "m")).to_vec()
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        out.extend(self.least(&s.at));
    }
}

#[typetag::serde(name = "clearance")]
impl RecordSpec for ClearanceSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let [a, b] = &self.between;
        if a.trim() == b.trim() {
            let message = "a clearance is between two parts: name another one";
            return Err(BuildError::at("between", message));
        }
        let spans = |name: &str| {
            let part = part(model, name.trim()).map_err(|e| BuildError::at("between", e.message))?;
            let spans = part.contact_spans();
            if spans.is_empty() {
                let message =
                    format!("`{}` is a {} without a line: give it a `hull`", part.name(), part.kind());
                return Err(BuildError::at("between", message));
            }
            Ok(spans)
        };
        let lines = [spans(a)?, spans(b)?];
        let name = named(&self.name, || format!("{}-{}", a.trim(), b.trim()));
        let title = format!("Clearance of {} and {}", a.trim(), b.trim());
        Ok(Box::new(Clearance { lines, name, title }))
    }
}
