//! The forces that act on the parts of a model, one for each arrow: reactions of constraints at their markers, and of every
//! load, contact or spring the resultant on each part.
//!
//! They are looked at for pictures: reactions have the multipliers of samples, which lie on lines between the steps unless
//! a record asks for more.

use ropewalk_core::rotation::{cross, matrix, times};
use ropewalk_core::{At, Marker, Model, NodeId, NodeKind, RowKind, Term, V3, dot};
use ropewalk_report::ForceRecord;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap};

/// More arrows than these aren't told apart: the largest stay.
const MOST: usize = 48;
/// What is less than this part of the largest force of a run is what rounding leaves of nothing.
const NOTHING: f64 = 1e-9;

/// A force at a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Acting {
    /// As [`ForceRecord::name`].
    pub name: String,
    pub x: V3<f64>,
    pub f: V3<f64>,
}

/// A constraint with the marker that it holds.
struct Reaction {
    name: String,
    constraint: usize,
    node: NodeId,
    marker: Marker,
}

/// A term of the model, or one of the effects that it applies together.
struct Source {
    name: String,
    term: usize,
    effect: Option<Box<dyn Term>>,
    /// Whether its name says already what it acts on.
    says_where: bool,
}

/// What exerts forces in a model.
#[derive(Default)]
pub(crate) struct Forces {
    reactions: Vec<Reaction>,
    sources: Vec<Source>,
    parts: Vec<String>,
    /// First coordinate of each node of a part, with the number of that part.
    part_of: HashMap<usize, usize>,
    /// How many nodes each part has.
    nodes: Vec<usize>,
    /// How far beside a body a force may act [m].
    sizes: Vec<f64>,
}

impl Forces {
    /// All that exerts forces.
    pub fn new(model: &Model) -> Self {
        let mut all = Forces::default();
        for (k, part) in model.parts().iter().enumerate() {
            let seats = part.seats();
            all.part_of.extend(seats.iter().map(|seat| (seat.0, k)));
            all.nodes.push(seats.len());
            all.sizes.push(part.length());
            all.parts.push(part.name().to_string());
        }
        for (k, constraint) in model.constraints().iter().enumerate() {
            let part = |marker: &Marker| all.part_of.get(&model.node(marker.on()?).q).copied();
            let markers = constraint.markers();
            // the joints of a chain are within it
            let within = match markers {
                [a, b] => part(a).is_some() && part(a) == part(b),
                _ => false,
            };
            let held = markers.iter().rev().find_map(|marker| Some((marker.on()?, *marker)));
            if let Some((node, marker)) =
                held.filter(|_| !within && constraint.rows().contains(&RowKind::Position))
                && model.node(node).kind.has_position()
            {
                let name = format!("reaction: {}", constraint.name());
                all.reactions.push(Reaction { name, constraint: k, node, marker });
            }
        }
        for (term, own) in model.terms().iter().enumerate() {
            let Some(word) = own.acts() else { continue };
            let effects = own.effects();
            let mut add = |label: String, effect: Option<Box<dyn Term>>| {
                let (name, says_where) = all.named(word, &label);
                all.sources.push(Source { name, term, effect, says_where });
            };
            if effects.is_empty() {
                add(own.label(), None);
            }
            effects.into_iter().for_each(|effect| add(effect.label(), Some(effect)));
        }
        all
    }

    /// `hose: drag` is `drag: hose`; what has a name of its own stands behind its kind.
    fn named(&self, word: &str, label: &str) -> (String, bool) {
        match label.split_once(": ") {
            Some((part, what)) if self.parts.iter().any(|p| p == part) => (format!("{what}: {part}"), true),
            _ => (format!("{word}: {}", label.strip_prefix("force at ").unwrap_or(label)), false),
        }
    }

    /// All forces at a state; `lambda` are the multipliers of its constraints.
    pub fn at(&self, model: &Model, at: &At<'_>, lambda: &[f64]) -> Vec<Acting> {
        let mut all = Vec::new();
        for Reaction { name, constraint, node, marker } in &self.reactions {
            if !model.holds(*constraint, at.internal) {
                continue;
            }
            if let [x, y, z, ..] = *model.reaction(*constraint, *node, at, lambda) {
                let place = marker.now(model.nodes(), at).x;
                all.push(Acting { name: name.clone(), x: place, f: [x, y, z] });
            }
        }
        for source in &self.sources {
            let own = model.terms().get(source.term);
            let Some(term) = source.effect.as_deref().or(own.map(AsRef::as_ref)) else { continue };
            self.resultants(model, at, &model.share_of(term, at), source, &mut all);
        }
        all.retain(|a| a.f != [0.0; 3]);
        all
    }

    /// The resultant of a term's residual on each part, in the middle of what makes it up.
    fn resultants(
        &self,
        model: &Model,
        at: &At<'_>,
        residual: &[f64],
        source: &Source,
        all: &mut Vec<Acting>,
    ) {
        let mut found: BTreeMap<usize, (V3<f64>, V3<f64>, f64)> = BTreeMap::new();
        for node in model.nodes().iter().filter(|n| n.kind.has_position()) {
            let Some(&part) = self.part_of.get(&node.q) else { continue };
            let f: V3<f64> = std::array::from_fn(|i| -residual[node.v + i]);
            let size = dot(&f, &f).sqrt();
            if !(size > 0.0) {
                continue;
            }
            let mut x: V3<f64> = std::array::from_fn(|i| at.q[node.q + i]);
            if node.kind == NodeKind::Frame && self.nodes[part] == 1 {
                let beside = beside(node.q, node.v, at, residual, &f);
                if dot(&beside, &beside).sqrt() <= self.sizes[part] {
                    (0..3).for_each(|i| x[i] += beside[i]);
                }
            }
            let (sum, middle, weight) = found.entry(part).or_default();
            for i in 0..3 {
                sum[i] += f[i];
                middle[i] += size * x[i];
            }
            *weight += size;
        }
        for (part, (f, middle, weight)) in found {
            let name = match source.says_where {
                true => source.name.clone(),
                false => format!("{} on {}", source.name, self.parts[part]),
            };
            all.push(Acting { name, x: middle.map(|x| x / weight), f });
        }
    }
}

/// From the node of a body to the line along which a force acts on it, by the moment about the node.
fn beside(q: usize, v: usize, at: &At<'_>, residual: &[f64], f: &V3<f64>) -> V3<f64> {
    let turn = matrix(&[at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]]);
    let moment = times(&turn, &std::array::from_fn(|i| -residual[v + 3 + i]));
    cross(f, &moment).map(|x| x / dot(f, f))
}

/// The forces of several times as records, one for each name that comes up: the largest of them.
pub(crate) fn records<'a>(times: impl Iterator<Item = &'a [Acting]> + Clone) -> Vec<ForceRecord> {
    let count = times.clone().count();
    let mut found: Vec<ForceRecord> = Vec::new();
    let mut number: HashMap<&str, usize> = HashMap::new();
    let mut peaks: Vec<f64> = Vec::new();
    for (k, forces) in times.enumerate() {
        for acting in forces {
            let i = *number.entry(&acting.name).or_insert_with(|| {
                let nowhere = vec![[f64::NAN; 3]; count];
                let (points, forces) = (nowhere.clone(), nowhere);
                found.push(ForceRecord { name: acting.name.clone(), points, forces });
                peaks.push(0.0);
                found.len() - 1
            });
            found[i].points[k] = acting.x;
            found[i].forces[k] = acting.f;
            peaks[i] = peaks[i].max(dot(&acting.f, &acting.f).sqrt());
        }
    }
    let mut sorted = peaks.clone();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let least = sorted.first().map_or(0.0, |most| NOTHING * most);
    let least = sorted.get(MOST).map_or(least, |next| least.max(*next));
    let mut peaks = peaks.into_iter();
    found.retain(|_| peaks.next().is_some_and(|peak| peak > least));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn acting(name: &str, size: f64) -> Acting {
        Acting { name: name.into(), x: [1.0, 0.0, 0.0], f: [0.0, size, 0.0] }
    }

    #[test]
    fn forces_that_come_and_go_have_gaps_and_nothing_is_left_out() {
        let times = [vec![acting("a", 1.0), acting("rounding", 1e-12)], vec![acting("b", 2.0)]];
        let found = records(times.iter().map(Vec::as_slice));
        assert_eq!(found.iter().map(|f| f.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
        assert_eq!((found[0].forces[0], found[1].points[1]), ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]));
        assert!(found[0].points[1][0].is_nan() && found[1].forces[0][0].is_nan());
    }

    #[test]
    fn of_very_many_forces_the_largest_stay() {
        let many: Vec<Acting> = (0..100).map(|k| acting(&format!("f{k}"), f64::from(k))).collect();
        let found = records([many.as_slice()].into_iter());
        assert_eq!((found.len(), found[0].name.as_str()), (MOST, "f52"));
    }
}
