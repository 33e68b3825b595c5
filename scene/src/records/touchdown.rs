//! Where a line comes to lie.

use super::named;
use super::place::part;
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::{At, BuildError, Column, Model, Part, Record, Sample};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Places at which each element is looked at, and halvings of the interval in which a line leaves the ground.
const LOOKS: usize = 8;
const HALVINGS: u32 = 40;

/// Where a cable lies on a bed or another shape: columns `line.touchdown.s`, the unstretched arc length from its start at which it
/// leaves the ground towards its higher end, in m, with `.x`, `.y` and `.z`, its axis there; `.grounded`, the length that lies, in m;
/// `.uplift`, the angle in rad by which its lower end points up from the horizontal; and `.clearance`, its least distance
/// from the ground in m, negative where it is pressed in. A cable that doesn't lie anywhere has no place: those columns are NaN.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TouchdownSpec {
    /// The cable.
    pub of: String,
    /// The bed or the contact.
    pub on: String,
    /// Name in results. Default: that of the cable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

register_spec!(Record, "touchdown", TouchdownSpec);

struct Touchdown {
    part: Arc<dyn Part>,
    term: usize,
    name: String,
    of: String,
}

impl Touchdown {
    fn clearance(&self, s: f64, sample: &Sample<'_>) -> f64 {
        let shows = sample.model.terms()[self.term].shows();
        shows.and_then(|t| t.local("clearance", self.part.name(), s, &sample.at)).unwrap_or(f64::NAN)
    }

    /// Where the clearance changes its sign between two places.
    fn border(&self, mut low: f64, mut high: f64, sample: &Sample<'_>) -> f64 {
        let below = self.clearance(low, sample) < 0.0;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if (self.clearance(middle, sample) < 0.0) == below { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// The intervals that lie on the ground, and the least clearance.
    fn lies(&self, sample: &Sample<'_>) -> (Vec<[f64; 2]>, f64) {
        let mesh = self.part.mesh();
        let looks = mesh.windows(2).flat_map(|w| {
            let (a, l) = (w[0], w[1] - w[0]);
            (0..LOOKS).map(move |k| a + l * k as f64 / LOOKS as f64)
        });
        let (mut all, mut least) = (Vec::new(), f64::INFINITY);
        let mut since: Option<f64> = None;
        let mut before: Option<f64> = None;
        for s in looks.chain(mesh.last().copied()) {
            let here = self.clearance(s, sample);
            least = least.min(here);
            match (here < 0.0, since) {
                (true, None) => since = Some(before.map_or(s, |b| self.border(b, s, sample))),
                (false, Some(from)) => {
                    all.push([from, before.map_or(s, |b| self.border(b, s, sample))]);
                    since = None;
                }
                _ => {}
            }
            before = Some(s);
        }
        all.extend(since.zip(before).map(|(from, to)| [from, to]));
        (all, least)
    }

    /// By what angle an end of the line points up.
    fn uplift(&self, end: usize, at: &At<'_>) -> f64 {
        let mesh = self.part.mesh();
        let (s, inner) =
            if end == 0 { (mesh[0], mesh[1]) } else { (mesh[mesh.len() - 1], mesh[mesh.len() - 2]) };
        // a difference over a thousandth of an element stands for the tangent
        let near = s + 1e-3 * (inner - s);
        let (Some((a, _)), Some((b, _))) = (self.part.point(s, at), self.part.point(near, at)) else {
            return f64::NAN;
        };
        (b[2] - a[2]).atan2((b[0] - a[0]).hypot(b[1] - a[1]))
    }
}

impl Record for Touchdown {
    fn title(&self) -> String {
        format!("Touchdown of {} on {}", self.part.name(), self.of)
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let of = |(what, unit): (&str, &str)| Column::new(format!("{}.{what}", self.name), unit);
        let all = [
            ("s", "m"),
            ("x", "m"),
            ("y", "m"),
            ("z", "m"),
            ("grounded", "m"),
            ("uplift", "rad"),
            ("clearance", "m"),
        ];
        all.into_iter().map(of).collect()
    }
    fn sample(&self, sample: &Sample<'_>, out: &mut Vec<f64>) {
        let (lies, least) = self.lies(sample);
        let mesh = self.part.mesh();
        let (start, end) = (mesh[0], mesh[mesh.len() - 1]);
        let rises = self.clearance(end, sample) >= self.clearance(start, sample);
        let place = match rises {
            true => lies.last().map(|[_, to]| *to),
            false => lies.first().map(|[from, _]| *from),
        };
        let x = place.and_then(|s| self.part.point(s, &sample.at)).map_or([f64::NAN; 3], |(x, _)| x);
        out.push(place.unwrap_or(f64::NAN));
        out.extend(x);
        out.push(lies.iter().map(|[from, to]| to - from).sum());
        out.push(self.uplift(usize::from(!rises), &sample.at));
        out.push(least);
    }
}

#[typetag::serde(name = "touchdown")]
impl RecordSpec for TouchdownSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let part = part(model, self.of.trim())?;
        let on = self.on.trim();
        let state = model.state();
        let tells = |k: &usize| {
            let shows = model.terms()[*k].shows();
            shows.is_some_and(|t| t.local("clearance", part.name(), 0.0, &state.at()).is_some())
        };
        let named_so: Vec<usize> =
            (0..model.terms().len()).filter(|k| model.terms()[*k].label() == on).collect();
        let Some(term) = named_so.iter().copied().find(tells) else {
            let message = match named_so.is_empty() {
                true => format!("there is no bed or contact `{on}`"),
                false => format!("`{}` is no cable that can lie on `{on}`", part.name()),
            };
            return Err(BuildError::at("on", message));
        };
        if part.mesh().len() < 2 {
            return Err(BuildError::at("of", format!("`{}` is a {}, not a line", part.name(), part.kind())));
        }
        let name = named(&self.name, || format!("{}.touchdown", part.name()));
        Ok(Box::new(Touchdown { part, term, name, of: on.to_string() }))
    }
}
