//! Bending layers that a mesh misses.
//!
//! A cable under tension that is held in its direction takes the direction of its force only over a layer of the length
//! `√(EI/T)`. Where elements are longer than that, its curvature and moment there are too small, and nothing else in a
//! result tells. [`Layers`] looks at all such places now and then, and says afterwards what was missed.

use crate::model::Model;
use crate::model::line::Quantity;
use crate::model::part::Part;
use crate::model::state::At;

/// Elements in a layer with which the curvature is right to about a hundredth.
const FINE: f64 = 2.0;
/// Factor between neighbours of a mesh that is proposed.
const GROWTH: f64 = 1.3;
/// Angle between the direction that is held and that of the cable beside it below which there is no layer to speak of
/// [rad]: it changes the tension by less than a thousandth.
const STRAIGHT: f64 = 0.02;

/// A node of a cable whose direction a constraint holds.
struct Held {
    part: usize,
    node: usize,
    constraint: usize,
}

/// The worst that was seen at a place on one side of it.
struct Missed {
    part: String,
    by: String,
    /// Whether it lies before the node, and where that is: at the start, at the end, or between.
    before: bool,
    end: Option<usize>,
    s: f64,
    t: f64,
    layer: f64,
    element: f64,
    tension: f64,
    /// Length of the cable, and number of its elements.
    length: f64,
    elements: usize,
}

/// Watches the bending layers of a model while it runs.
pub struct Layers {
    held: Vec<Held>,
    missed: Vec<Missed>,
}

impl Layers {
    /// The places of a model where the direction of a cable that resists bending is held.
    pub fn new(model: &Model) -> Self {
        let mut layers = Layers { held: Vec::new(), missed: Vec::new() };
        layers.follow(model);
        layers
    }

    /// Goes on with another mesh of the same scene.
    pub fn follow(&mut self, model: &Model) {
        self.held.clear();
        let state = model.state();
        let bends = |p: &dyn Part| p.slender().is_some_and(|s| s.ei > 0.0);
        for (constraint, c) in model.constraints().iter().enumerate() {
            let nodes = c.nodes();
            if nodes.iter().all(|&n| !model.node(n).kind.has_slope()) {
                continue;
            }
            let (rows, columns) =
                (c.rows().len(), nodes.iter().map(|&n| model.node(n).kind.velocities()).sum::<usize>());
            let mut jacobian = vec![0.0; rows * columns];
            c.jacobian(model.nodes(), &state.at(), &mut vec![0.0; rows], &mut jacobian);
            let mut first = 0;
            for &n in nodes {
                let node = model.node(n);
                let slope = first + 3..first + 6;
                first += node.kind.velocities();
                let turns = |row: usize| slope.clone().any(|i| jacobian[row * columns + i] != 0.0);
                if !node.kind.has_slope() || !(0..rows).any(turns) {
                    continue;
                }
                for (part, p) in model.parts().iter().enumerate().filter(|(_, p)| bends(p.as_ref())) {
                    if let Some(k) = p.seats().iter().position(|&(q, _)| q == node.q) {
                        self.held.push(Held { part, node: k, constraint });
                    }
                }
            }
        }
    }

    /// Looks at the state of the model that it follows.
    pub fn look(&mut self, model: &Model, at: &At<'_>) {
        for k in 0..self.held.len() {
            let Held { part, node, constraint } = self.held[k];
            if model.holds(constraint, at.internal) {
                let (part, by) = (model.parts()[part].as_ref(), model.constraints()[constraint].name());
                self.beside(part, node, by, true, at);
                self.beside(part, node, by, false, at);
            }
        }
    }

    /// Looks at the element before or behind a node.
    fn beside(&mut self, part: &dyn Part, node: usize, by: &str, before: bool, at: &At<'_>) {
        let Some(line) = part.line() else { return };
        let (mesh, seats) = (line.mesh_now(at), part.seats());
        let last = mesh.len() - 1;
        let step =
            |i: usize| if before { node.checked_sub(i) } else { Some(node + i).filter(|k| *k <= last) };
        let Some(next) = step(1) else { return };
        let element = (mesh[next] - mesh[node]).abs();
        let ei = line.slender().ei;
        // where the cable is held itself the tension may be small: its force points across
        let places = [Some(node), step(1), step(2)];
        let tension = places
            .into_iter()
            .flatten()
            .filter_map(|k| line.observe(Quantity::Tension, mesh[k], at))
            .fold(0.0_f64, f64::max);
        let layer = (ei / tension).sqrt();
        if !(layer < element) {
            return;
        }
        let three = |i: usize| [at.q[i], at.q[i + 1], at.q[i + 2]];
        let (from, to) = step(2).map_or((node, next), |far| (next, far));
        let (a, b) = if before { (to, from) } else { (from, to) };
        let chord: [f64; 3] = std::array::from_fn(|i| at.q[seats[b].0 + i] - at.q[seats[a].0 + i]);
        let slope = three(seats[node].0 + 3);
        let dot = |x: &[f64; 3], y: &[f64; 3]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let cos = dot(&chord, &slope) / (dot(&chord, &chord) * dot(&slope, &slope)).sqrt();
        if !(cos < STRAIGHT.cos()) {
            return;
        }
        let end = [0, last].iter().position(|&e| e == node);
        let new = Missed {
            part: part.name().to_string(),
            by: by.to_string(),
            before,
            end,
            s: mesh[node],
            t: at.t,
            layer,
            element,
            tension,
            length: mesh[last],
            elements: last,
        };
        let same = |m: &&mut Missed| (&m.part, &m.by, m.before) == (&new.part, &new.by, before);
        match self.missed.iter_mut().find(same) {
            Some(m) if new.element / new.layer > m.element / m.layer => *m = new,
            Some(_) => {}
            None => self.missed.push(new),
        }
    }

    /// What was missed, cable by cable: where, by how much, and the mesh that would do.
    pub fn remarks(&self) -> Vec<String> {
        let mut parts: Vec<&str> = self.missed.iter().map(|m| m.part.as_str()).collect();
        parts.dedup();
        parts.sort_unstable();
        parts.dedup();
        parts.into_iter().map(|part| self.remark(part)).collect()
    }

    fn remark(&self, part: &str) -> String {
        let own: Vec<&Missed> = self.missed.iter().filter(|m| m.part == part).collect();
        let places: Vec<String> = own
            .iter()
            .map(|m| {
                let place = match m.end {
                    Some(0) => "at its start".into(),
                    Some(_) => "at its end".into(),
                    None => format!("{} {} m", if m.before { "before" } else { "behind" }, short(m.s)),
                };
                format!(
                    "{place}, held by `{}`, the layer is {} m long at {} N (t = {} s) and the element {} m",
                    m.by,
                    short(m.layer),
                    short(m.tension),
                    short(m.t),
                    short(m.element)
                )
            })
            .collect();
        format!(
            "`{part}` bends in layers of the length √(EI/T) that its mesh misses, so that its curvature and moment there \
             are too small: {}. `{}` resolves them",
            places.join("; "),
            mesh(&own)
        )
    }
}

/// Two digits.
pub(super) fn short(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

/// The mesh that resolves all layers of a cable.
fn mesh(missed: &[&Missed]) -> String {
    let (length, present) = (missed[0].length, missed[0].elements as f64);
    let finest = |of: &dyn Fn(&Missed) -> bool| {
        let own = missed.iter().filter(|m| of(m)).map(|m| m.layer / FINE);
        own.reduce(f64::min).map(short)
    };
    if let Some(l) = finest(&|m| m.end.is_none()) {
        return format!("elements = {}", (length / l).ceil());
    }
    let ends = [finest(&|m| m.end == Some(0)), finest(&|m| m.end.is_some_and(|e| e > 0))];
    // lengths grow from the ends up to those that there are now
    let coarse = length / present;
    let (mut count, mut left) = (0.0, length);
    for end in ends.into_iter().flatten() {
        let steps = (coarse / end).max(1.0).ln() / GROWTH.ln();
        count += steps.ceil();
        left -= end * (GROWTH.powf(steps.ceil()) - 1.0) / (GROWTH - 1.0);
    }
    count += (left / coarse).ceil().max(1.0);
    let given =
        ["first", "last"].into_iter().zip(ends).filter_map(|(name, l)| Some(format!(", {name} = {}", l?)));
    format!("mesh = {{ elements = {count}{} }}", given.collect::<String>())
}
